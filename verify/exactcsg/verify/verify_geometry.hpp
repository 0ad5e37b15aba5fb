// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The certified volumes of an OpenMC model held against random points, and against polyhedra within
// what is visible of the cells and round it (nef_volume.hpp): once for all places at which a cell
// is visible in the same way; and against golden values (golden_geometry.hpp), if there are any.
//
// LAW verify_geometry.1  a check has passed only if the proved bounds and the oracle's have a
// number
//                        in common: the estimate's interval of so many standard deviations, or the
//                        volumes of the two polyhedra.
// LAW verify_geometry.2  what no oracle can answer is Skipped with its reason, never Passed.
// Points estimate volumes, so that a fault below their deviation is not seen; `bound` says how
// large that is. Beyond six deviations lie two of a thousand million estimates.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/model.hpp"
#include "exactcsg/support/progress.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct VerifyGeometryOptions {
  double relative_width = 1e-6;
  std::uint64_t points = 1'000'000;
  double deviations = 6;
  std::uint64_t seed = 1;
  double nef_seconds = 60;                      // for all cells
  std::uint32_t nef_segments = 24;              // faceted_region.hpp
  std::optional<std::filesystem::path> golden;  // golden_geometry.hpp
  std::string golden_name;                      // entry in it; empty: the stem of the model's name
  std::vector<std::string> disabled;  // of "sampling", "nef", "golden", not to be run at all
  Progress* progress = nullptr;
};

// THROWS what Progress throws; Error(FileNotReadable | GoldenFile) of a golden file
Report verify_geometry(const io::openmc::Model& model, const VerifyGeometryOptions& options = {});

}  // namespace exactcsg::verify
