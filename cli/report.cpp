// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report.hpp"

#include <unistd.h>

#include "cli/output_file.hpp"
#include "cli/terminal.hpp"

namespace exactcsg::cli {

void expect_report_ending(const std::filesystem::path& file) {
  expect_ending(file, {".json", ".xml", ".html", ".txt"});
}

Answer print_report(Context& context, const verify::Report& report) {
  verify::TextStyle style;
  style.colour = colour_wanted(STDOUT_FILENO);
  style.width = terminal_width(STDOUT_FILENO);
  context.print(verify::render_text(report, style));
  return report.overall() == verify::Verdict::Passed ? Answer::Yes : Answer::No;
}

}  // namespace exactcsg::cli
