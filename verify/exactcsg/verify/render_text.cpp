// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {
namespace {

std::string_view colour_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Passed:
      return "\033[32m";
    case Verdict::Failed:
      return "\033[31m";
    case Verdict::Skipped:
      return "\033[33m";
  }
  return "";
}

// At most `width` columns; what is cut is marked.
std::string fit(const std::string& text, std::size_t width) {
  if (text.size() <= width) return text;
  return width <= 2 ? text.substr(0, width) : text.substr(0, width - 2) + "..";
}

std::size_t column_width(const Report& report, std::string Check::*field, std::size_t least,
                         std::size_t most) {
  std::size_t width = least;
  for (const Check& check : report.checks) width = std::max(width, (check.*field).size());
  return std::min(width, most);
}

std::string verdict_word(Verdict verdict, const TextStyle& style) {
  const std::string word = fmt::format("{:<7}", name_of(verdict));
  return style.colour ? fmt::format("{}{}\033[0m", colour_of(verdict), word) : word;
}

std::string point_text(const std::array<double, 3>& p) {
  return fmt::format("({:.17g}, {:.17g}, {:.17g})", p[0], p[1], p[2]);
}

std::string place_text(const Mismatch& mismatch) {
  std::string text;
  for (const auto& p : mismatch.where) {
    text += text.empty() ? "" : " - ";
    text += point_text(p);
  }
  return text;
}

std::string details(const Check& check) {
  std::string text = fmt::format("\n{}: {}\n", check.name, name_of(check.verdict));
  if (!check.explanation.empty()) text += fmt::format("  {}\n", check.explanation);
  for (const Mismatch& mismatch : check.mismatches) {
    text += fmt::format("  - {}", mismatch.text);
    const std::string place = place_text(mismatch);
    if (mismatch.text.find(place) == std::string::npos) text += fmt::format("  at {}", place);
    text += "\n";
  }
  if (check.mismatch_count > check.mismatches.size()) {
    text += fmt::format("  ... and {} more\n", check.mismatch_count - check.mismatches.size());
  }
  return text;
}

}  // namespace

std::string render_text(const Report& report, const TextStyle& style) {
  const std::size_t name = column_width(report, &Check::name, 5, 40);
  const std::size_t rest = style.width > name + 12 ? style.width - name - 12 : 40;
  const std::size_t value = std::clamp<std::size_t>(rest / 4, 12, 24);
  const std::size_t ours = column_width(report, &Check::ours, 4, value);
  const std::size_t theirs = column_width(report, &Check::theirs, 6, value);
  const std::size_t difference = column_width(report, &Check::difference, 10, value);
  const std::size_t bound = column_width(report, &Check::bound, 5, value);

  std::string text = fmt::format("{}\n", report.model);
  if (!report.digest.empty()) text += fmt::format("digest {}\n", report.digest);
  text += fmt::format("\n{:<7}  {:<{}}  {:>{}}  {:>{}}  {:>{}}  {:>{}}\n", "verdict", "check", name,
                      "ours", ours, "oracle", theirs, "difference", difference, "bound", bound);
  for (const Check& check : report.checks) {
    text += fmt::format(
        "{}  {:<{}}  {:>{}}  {:>{}}  {:>{}}  {:>{}}\n", verdict_word(check.verdict, style),
        fit(check.name, name), name, fit(check.ours, ours), ours, fit(check.theirs, theirs), theirs,
        fit(check.difference, difference), difference, fit(check.bound, bound), bound);
  }
  for (const Check& check : report.checks) {
    if (check.verdict != Verdict::Passed) text += details(check);
  }
  if (!report.notes.empty()) text += "\n";
  for (const std::string& note : report.notes) text += fmt::format("note: {}\n", note);
  text +=
      fmt::format("\n{}: {} passed, {} failed, {} skipped, {:.2f} s\n", name_of(report.overall()),
                  report.count(Verdict::Passed), report.count(Verdict::Failed),
                  report.count(Verdict::Skipped), report.seconds);
  return text;
}

}  // namespace exactcsg::verify
