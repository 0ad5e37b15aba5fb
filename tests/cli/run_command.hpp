// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Runs the command that was built, as a user would.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "temporary_folder.hpp"

namespace exactcsg::cli_test {

struct Finished {
  int exit_code = -1;  // 128 + signal if it was killed
  std::string out;
  std::string err;
};

// The command that was built.
std::string program();
// Arguments without the program's name.
Finished run_command(const std::vector<std::string>& arguments, std::string_view input = {});
// Any program, by its path.
Finished run_program(std::vector<std::string> words, std::string_view input = {});

using test::Folder;

std::string read_text(const std::filesystem::path& file);
// A model of data/openscad.
std::string model(const std::string& name);

}  // namespace exactcsg::cli_test
