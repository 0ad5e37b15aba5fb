// SPDX-License-Identifier: Apache-2.0
#pragma once

// The figures of a solid as text for people and programs: correctly rounded decimals. [Exact]

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/solid/measures.hpp"

namespace exactcsg {

struct MeasuredFigures {
  std::string volume_decimal;
  std::optional<Rational> exact_volume;  // nullopt: longer than asked for
  std::string area_decimal;
  // nullopt: the solid is empty, or it was not wanted
  std::optional<std::array<std::string, 3>> centroid_decimals;
  std::optional<BoundingBox> bounding_box;  // nullopt: the solid is empty
  // Figures whose last digit could not be proved, each with what is known; empty but for solids
  // whose exact figures are beyond all limits and happen to lie on the edge between two decimals.
  std::vector<std::string> unproved;
};

// LAW figures.1  every decimal not named in `unproved` is the exact value correctly rounded to
// `digits` significant digits (ties to even; trailing zeros dropped).
// The exact volume is given if its numerator and denominator have at most exact_bits bits; 0: it
// is not looked for.
// REQUIRES digits >= 1
MeasuredFigures measure(const Boundary& boundary, int digits = 17, std::size_t exact_bits = 4096,
                        Wanted wanted = Wanted::Everything);

}  // namespace exactcsg
