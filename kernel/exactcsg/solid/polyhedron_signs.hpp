// SPDX-License-Identifier: Apache-2.0
#pragma once

// Exact signs over the vertices of one polyhedron: a double filter first, then machine
// integers where the coordinates are short, then integers on the stack, then unbounded ones.
// [Exact]
//
// For what looks at one polyhedron at a time, as the checks of primitive.hpp and hulls do; the
// evaluator has the richer number/geometry.hpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/number/point.hpp"

namespace exactcsg {

// 0, 1, 2: x, y, z.
using CoordinateIndex = unsigned;

class PolyhedronSigns {
 public:
  using Index = std::uint32_t;

  explicit PolyhedronSigns(std::span<const Point3> points);

  // Adds the weighted mean of given points and returns its index.
  // REQUIRES every weight > 0 and no index of an added mean
  Index add_mean(std::span<const std::pair<Index, unsigned>> weighted);

  // The sign of ((b - a) x (c - a)) . (d - a): Positive if d lies on the side of the plane a, b, c
  // from which these are seen counter-clockwise.
  Sign orientation(Index a, Index b, Index c, Index d) const {
    return d == a || d == b || d == c ? Sign::Zero : along_normal(a, b, c, a, d);
  }
  // The sign of ((b - a) x (c - a)) . (q - p): Positive if q is farther than p along the normal.
  Sign along_normal(Index a, Index b, Index c, Index p, Index q) const;

  // The plane of three points in doubles, for asking about many points.
  struct NearPlane {
    std::array<double, 3> corner{};
    std::array<double, 3> normal{};
    // A point whose coordinates differ from the corner's by at most w is placed wrongly only if its
    // product with the normal is at most slope * w + offset.
    double slope = 0;
    double offset = 0;
  };
  NearPlane near_plane(Index a, Index b, Index c) const;
  // orientation(a, b, c, d) for the plane of a, b and c, or Zero where doubles do not tell.
  Sign certain_side(const NearPlane& plane, Index d) const {
    const std::array<double, 3>& point = approximate_[d];
    double value = 0;
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double difference = point[i] - plane.corner[i];
      value += plane.normal[i] * difference;
      largest = std::max(largest, std::abs(difference));
    }
    const double bound = plane.slope * largest + plane.offset;
    return value > bound ? Sign::Positive : value < -bound ? Sign::Negative : Sign::Zero;
  }

  // The sign of one component of (b - a) x (c - a): the turn a, b, c in the projection along it.
  Sign turn(CoordinateIndex dropped, Index a, Index b, Index c) const;
  bool collinear(Index a, Index b, Index c) const;
  // The sign of b's coordinate minus a's.
  Sign compare(CoordinateIndex coordinate, Index a, Index b) const;
  // The sign of the sum of det(a, b, c) over triangles: six times the signed volume if the
  // triangles close up.
  Sign volume(std::span<const std::array<Index, 3>> triangles) const;

  // Nearest doubles; the true coordinates differ by at most coordinate_error().
  const std::array<double, 3>& approximate(Index i) const { return approximate_[i]; }
  double coordinate_error() const { return coordinate_error_; }

 private:
  using Exact = std::array<Integer, 3>;
  template <class Integral>
  std::array<Integral, 3> difference(Index from, Index to) const;
  // Whether a sum of six products of `factors` differences fits the integers on the stack.
  bool fits_stack(std::size_t factors) const;
  void append(const Exact& numerators, const Integer& weight);
  // The points as machine integers over their common denominator; false if these do not fit.
  bool set_small(std::span<const Point3> points, const Integer& common);
  void set_long(std::span<const Point3> points, const std::optional<Integer>& common);
  template <class Integral>
  Integral numerator(Index point, CoordinateIndex i) const;
  template <class Integral>
  Integral weight(Index point) const;
  bool have_equal_weights(Index p, Index q) const;

  std::vector<std::array<double, 3>> approximate_;
  double point_error_ = 0;       // of the points given
  double coordinate_error_ = 0;  // of these and of the means
  // Coordinates of all points times one common positive factor (a sign does not feel it) are
  // machine integers below 2^40 in magnitude, if they all fit; those of the other points, which
  // follow, are to be divided by the point's own positive weight.
  std::vector<std::array<std::int64_t, 3>> small_;
  std::vector<Exact> exact_;
  std::vector<Integer> weight_;
  bool unit_weights_ = true;
  std::size_t numerator_bits_ = 0;
  std::size_t weight_bits_ = 0;
};

}  // namespace exactcsg
