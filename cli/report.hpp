// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What the commands that hold a model against others have in common.

#include "cli/command.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::cli {

// THROWS Error(UnknownFormat) if no report is written to files of this ending.
void expect_report_ending(const std::filesystem::path& file);

// As a table, as wide as the terminal. A verification in which no oracle answered has confirmed
// nothing: that is no yes.
Answer print_report(Context& context, const verify::Report& report);

}  // namespace exactcsg::cli
