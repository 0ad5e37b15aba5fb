// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Has OpenSCAD itself turn a source (.scad) into the .csg text of its model, without a shell.

#include <filesystem>
#include <string>

#include "exactcsg/support/progress.hpp"

namespace exactcsg::io::openscad {

struct FrontEndResult {
  std::string csg;
  std::string messages;  // what OpenSCAD printed on standard error
};

// Runs `openscad --render -o FILE.csg SOURCE`, the first `openscad` on the PATH, in a new private
// folder that is removed afterwards. Stops the program when `progress` is cancelled.
// OpenSCAD exits with 0 although it printed errors and cut the model short, so every line that
// begins with "ERROR" counts as a failure. THROWS Error(OracleUnavailable) if there is no such
// program; Error(OracleFailed) with its message if it failed; Error(FileNotReadable) if the
// temporary folder cannot be used.
FrontEndResult run_openscad(const std::filesystem::path& source, Progress* progress);

}  // namespace exactcsg::io::openscad
