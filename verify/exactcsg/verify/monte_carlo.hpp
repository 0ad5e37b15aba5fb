// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Volumes of an OpenMC model's cells from random points in plain doubles: an oracle that shares
// nothing with the certified measures but the model that was read. [Approximate]
//
// LAW monte_carlo.1  the same seed gives the same estimate.
// LAW monte_carlo.2  estimates are unbiased but for points within rounding of a surface; the
//                    standard deviation is that of a binomial distribution, with at least one hit
//                    and one miss counted.
// A point counts for every cell of each universe on the way that has it inside, as measure counts;
// of several, the first one's fill is followed, as transport codes do.
// Coefficients and regions are evaluated as the format defines them, surface type by surface type.

#include <array>
#include <cstdint>
#include <vector>

#include "exactcsg/io/openmc/model.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg::verify {

struct SampledVolume {
  double estimate = 0;
  double deviation = 0;  // one standard deviation
  std::uint64_t hits = 0;
};

struct SamplingBox {
  std::array<double, 3> lower;
  std::array<double, 3> upper;
};

// In the order of the model's cells. THROWS what Progress throws.
std::vector<SampledVolume> sample_volumes(const io::openmc::Model& model, const SamplingBox& box,
                                          std::uint64_t points, std::uint64_t seed,
                                          Progress* progress = nullptr);

}  // namespace exactcsg::verify
