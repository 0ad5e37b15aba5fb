// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/report.hpp"

#include <algorithm>
#include <utility>

namespace exactcsg::verify {

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Passed:
      return "passed";
    case Verdict::Failed:
      return "failed";
    case Verdict::Skipped:
      return "skipped";
  }
  return "failed";
}

void add_mismatch(Check& check, Mismatch mismatch) {
  check.verdict = Verdict::Failed;
  ++check.mismatch_count;
  if (check.mismatches.size() < listed_mismatches) check.mismatches.push_back(std::move(mismatch));
}

std::size_t Report::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::count_if(
      checks.begin(), checks.end(), [&](const Check& check) { return check.verdict == verdict; }));
}

Verdict Report::overall() const {
  if (count(Verdict::Failed) > 0) return Verdict::Failed;
  return count(Verdict::Passed) > 0 ? Verdict::Passed : Verdict::Skipped;
}

void require_oracles(Report& report, std::span<const std::string> oracles) {
  for (const std::string& oracle : oracles) {
    bool seen = false;
    for (Check& check : report.checks) {
      if (check.oracle != oracle) continue;
      seen = true;
      if (check.verdict != Verdict::Skipped) continue;
      check.verdict = Verdict::Failed;
      check.explanation = "required, but skipped: " + check.explanation;
    }
    if (seen) continue;
    Check missing;
    missing.oracle = oracle;
    missing.name = oracle + ": required";
    missing.verdict = Verdict::Failed;
    missing.explanation = "required, but not run";
    report.checks.push_back(std::move(missing));
  }
}

}  // namespace exactcsg::verify
