// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Output files appear whole or not at all: written under another name beside the target, renamed
// when complete.

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace exactcsg::cli {

// write(temporary) makes the file; its name ends as the target's does, because writers choose the
// format by the ending. A device or pipe (/dev/stdout) is written directly.
// THROWS Error(FileNotWritable), and what write throws
void write_file(const std::filesystem::path& target,
                const std::function<void(const std::filesystem::path&)>& write);

void write_file(const std::filesystem::path& target, std::string_view text);

// A slip in a name must not wait for the end of long work.
// THROWS Error(UnknownFormat) if the name ends in none of these. REQUIRES two or more
void expect_ending(const std::filesystem::path& target,
                   const std::vector<std::string_view>& endings);

}  // namespace exactcsg::cli
