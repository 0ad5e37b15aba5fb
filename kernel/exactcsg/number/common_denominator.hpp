// SPDX-License-Identifier: Apache-2.0
#pragma once

// Rational coordinates as integers over one denominator. [Exact]

#include <cstddef>
#include <optional>
#include <span>

#include "exactcsg/number/exact_points.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg {

// Makes `common` the least common multiple of itself and `denominator`; both > 0.
void make_multiple(Integer& common, const Integer& denominator);

// value * denominator. REQUIRES that this is an integer
void set_scaled(Integer& result, const Rational& value, const Integer& denominator);

// Beyond this length integers over one denominator cost more than rationals of their own.
inline constexpr std::size_t common_denominator_bits = 512;

// The least common denominator of all coordinates, unless it has more than
// common_denominator_bits. COST: O(points) divisions
std::optional<Integer> short_common_denominator(std::span<const Point3> points);
std::optional<Integer> short_common_denominator(const ExactPoints& points);

}  // namespace exactcsg
