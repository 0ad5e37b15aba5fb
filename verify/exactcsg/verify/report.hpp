// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What a verification found: one check a line, each with our value, the oracle's value, the
// difference, the bound it was held against, and where the two differ.

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exactcsg::verify {

// Skipped: the oracle could not answer (not installed, over budget, reported a fault of its own). A
// check that was skipped has confirmed nothing.
enum class Verdict { Passed, Failed, Skipped };

// "passed", "failed", "skipped"
std::string_view name_of(Verdict verdict);

// A place where the two sides differ: a point, or an edge of two points, or a polygon. Coordinates
// are doubles nearest to the exact ones; `text` says what is wrong there and names exact values.
struct Mismatch {
  std::string text;
  std::vector<std::array<double, 3>> where;
};

struct Check {
  std::string oracle;      // "boundary", "nef", "openscad", "against", "sampling", "laws", "golden"
  std::string name;        // "nef: volume"
  std::string ours;        // our value, printable
  std::string theirs;      // the oracle's value
  std::string difference;  // empty where there is none to speak of
  std::string bound;       // "0 (equal rationals)", "3.1e-06"; empty if not applicable
  Verdict verdict = Verdict::Passed;
  std::string explanation;  // why it failed or was skipped; what the bound is made of
  // The first `listed_mismatches` of them; `mismatch_count` counts all.
  std::vector<Mismatch> mismatches;
  std::size_t mismatch_count = 0;
};

inline constexpr std::size_t listed_mismatches = 20;

// Counts the mismatch and keeps it if the list is not full yet. Sets the verdict to Failed.
void add_mismatch(Check& check, Mismatch mismatch);

struct Report {
  std::string model;    // the model's name
  std::string digest;   // of our boundary; empty if it could not be computed
  std::string library;  // our version
  double seconds = 0;
  std::vector<Check> checks;
  std::vector<std::string> notes;  // warnings of the reader, membranes, ...
  // Edges of our boundary, projected by pictures; at most some ten thousand.
  std::vector<std::array<std::array<double, 3>, 2>> edges;

  // Failed if any check failed; Skipped if no check passed; otherwise Passed.
  Verdict overall() const;
  std::size_t count(Verdict verdict) const;
};

// LAW report.1  every skipped check of a required oracle, and every required oracle without any
// check at all, becomes a failure.
void require_oracles(Report& report, std::span<const std::string> oracles);

// A table a person reads at a glance, and below it the mismatches of the checks that failed.
struct TextStyle {
  bool colour = false;
  std::size_t width = 100;  // columns of the terminal
};
std::string render_text(const Report& report, const TextStyle& style = {});

// The report as text of a format. JSON: one object, "schema": "exactcsg.verify/1". JUnit XML: one
// <testcase> a check. HTML: one page with pictures of the edges that did not match.
std::string render_json(const Report& report);
std::string render_junit(const Report& report);
std::string render_html(const Report& report);

// Writes it by the file's ending: .json, .xml (JUnit), .html, .txt.
// THROWS Error(UnknownFormat | FileNotWritable)
void write_report(const Report& report, const std::filesystem::path& file);

}  // namespace exactcsg::verify
