// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The rules that the tests of this folder hold every source file against.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace exactcsg::house {

struct Violation {
  std::string file;
  std::size_t line = 0;
  std::string what;
};

// The text without comments; with `keep_strings` false, also without the contents of string and
// character literals. Line breaks stay, so that line numbers do.
std::string without_comments(std::string_view text, bool keep_strings);

// "kernel/exactcsg/csg/tree.hpp" -> "csg", "io/..." -> "io"; empty if it belongs to no layer.
std::string layer_of(const std::filesystem::path& relative_path);

// Includes against the order of layers; in the kernel, headers of CGAL that are under the GPL and
// headers of the readers' libraries; outside cli, printing, aborting and exiting.
std::vector<Violation> layer_violations(const std::filesystem::path& relative_path,
                                        std::string_view text);

// The SPDX line that must come first (after #! if there is one).
std::vector<Violation> licence_violations(const std::filesystem::path& relative_path,
                                          std::string_view text);

// Every file of ours below the root of the sources, relative to it.
std::vector<std::filesystem::path> our_files(const std::filesystem::path& root);

std::string read_text(const std::filesystem::path& file);

}  // namespace exactcsg::house
