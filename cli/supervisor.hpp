// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Runs a command's work on a thread, while the main thread shows its progress, keeps the time limit
// and listens for Ctrl-C.

#include "cli/command.hpp"

namespace exactcsg::cli {

// The exit code: the answer's, or 2 or 3 by the catalogue after printing the error.
// The time limit has two steps. When it is over, the work is asked to stop through Progress and the
// error says so. Work that does not look at Progress (a library's) for `grace_seconds` more is
// ended together with the process: a command of a pipeline must not hang.
int supervise(const Command& command, Context& context);

inline constexpr double grace_seconds = 3;

}  // namespace exactcsg::cli
