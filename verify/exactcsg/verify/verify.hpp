// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The verification of a model: its exact evaluation held against oracles that share none of the
// evaluator's code.
//
// LAW verify.1  a report whose overall verdict is Passed has no failed check, and every required
// oracle has answered.
// LAW verify.2  an oracle that cannot answer is Skipped with its reason, never Passed.
// NOT promised: that Passed proves the model right. Each check says what it compared and how
// exactly.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/support/progress.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct VerifyOptions {
  // The file the model was read from: the OpenSCAD oracle runs on it (.csg or .scad). Without it
  // that oracle is skipped.
  std::filesystem::path source;
  std::vector<std::filesystem::path> against;   // mesh files that should be this model
  std::optional<std::filesystem::path> golden;  // golden file to check against
  std::string golden_name;                      // entry in it; empty: the stem of the model's name
  std::vector<std::string> required;            // oracles whose skip is a failure
  std::vector<std::string> disabled;            // oracles not to be run at all
  double budget_seconds = 60;                   // for each slow oracle (Nef, OpenSCAD)
  std::size_t memory_limit = std::size_t{6} << 30U;  // bytes, of each oracle's process
  unsigned threads = 1;
  std::uint64_t seed = 1;           // of the sampling
  std::size_t sample_points = 400;  // classified by kernel and Nef
  std::size_t law_samples = 6;      // pairs of subtrees on which laws are tried
  std::string openscad = "openscad";
  Progress* progress = nullptr;
};

// Names that `required` and `disabled` may hold, in the order in which they run.
// "boundary", "nef", "openscad", "against", "sampling", "laws", "golden"
std::vector<std::string> oracle_names();

// THROWS what evaluate throws, Error(BadArgument) for an unknown oracle name, and what Progress
// throws. Faults of oracles and unreadable files to compare with are checks of the report, not
// exceptions.
Report verify_model(const io::Model& model, const VerifyOptions& options = {});

// The same for a boundary that somebody else evaluated (or that a test has tampered with).
Report verify_boundary(const io::Model& model, const Boundary& boundary,
                       const VerifyOptions& options = {});

}  // namespace exactcsg::verify
