// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// stdout and stderr: data goes to the one, everything else to the other.

#include <cstddef>
#include <string_view>

namespace exactcsg::cli {

// A terminal, and the user has not asked for none by NO_COLOR or TERM=dumb.
bool colour_wanted(int file_descriptor);
bool is_terminal(int file_descriptor);
std::size_t terminal_width(int file_descriptor);

// THROWS Error(FileNotWritable) if stdout takes no more.
void print_data(std::string_view text);
// A whole line to stderr; takes the progress line away first.
void print_message(std::string_view text);
// "error[E0102]" in red where colour is wanted.
void print_error(std::string_view text);

// One line on stderr that is drawn over; nothing if stderr is no terminal.
void show_progress_line(std::string_view text);
void clear_progress_line();

}  // namespace exactcsg::cli
