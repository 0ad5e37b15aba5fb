// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What the commands that compare two models have in common.

#include <string>

#include "cli/command.hpp"

namespace exactcsg::cli {

struct TwoModels {
  std::string first;
  std::string second;
  double tolerance = 0;  // a volume; of commands that take it
};

// The arguments of a command, and what --help says of them.
struct TwoModelsHelp {
  const char* name;
  const char* command;
  const char* first;
  const char* second;
  bool has_tolerance = false;
};

Command add_command_on_two_models(CLI::App& app, const TwoModelsHelp& help,
                                  Answer (*answer)(Context&, const TwoModels&));

// Two lines, one with the exact coordinates and one with decimals.
std::string witness_lines(const Point3& point);

}  // namespace exactcsg::cli
