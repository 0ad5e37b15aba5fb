// SPDX-License-Identifier: Apache-2.0
#pragma once

// What is left of a tree in a box, how such a cell is divided, and the column it is if it is one.
// [Exact], columns [Certified]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/measure/column.hpp"
#include "exactcsg/measure/surface_table.hpp"

namespace exactcsg::measure::detail {

using Box3 = domain::Box<3>;

inline Rational volume_of(const Box3& box) {
  Rational volume = 1;
  for (std::size_t i = 0; i < 3; ++i) volume *= box.upper()[i] - box.lower()[i];
  return volume;
}

// The surfaces that occur in the tree, each once; nullopt if they are more than `limit`.
inline std::optional<std::vector<std::uint32_t>> surfaces_of(const LiteralTree& tree,
                                                             std::size_t limit) {
  // Occurrences may be many where surfaces are few.
  constexpr std::uint64_t occurrences_limit = 256;
  if (tree.primitive_count() > occurrences_limit) return std::nullopt;
  std::vector<std::uint32_t> surfaces;
  csg::for_each_primitive(tree,
                          [&](const Literal& literal) { surfaces.push_back(literal.surface); });
  std::sort(surfaces.begin(), surfaces.end());
  surfaces.erase(std::unique(surfaces.begin(), surfaces.end()), surfaces.end());
  if (surfaces.size() > limit) return std::nullopt;
  return surfaces;
}

// A plane x_axis = coordinate.
struct AxisPlane {
  std::size_t axis = 0;
  Rational coordinate;
};

inline std::optional<AxisPlane> axis_plane(const domain::HalfSpace<3>& half_space) {
  const domain::Quadric<3>& f = half_space.polynomial();
  if (!f.is_linear() || half_space.nappe()) return std::nullopt;
  std::optional<AxisPlane> result;
  for (std::size_t i = 0; i < 3; ++i) {
    if (f.linear().normal[i] == 0) continue;
    if (result) return std::nullopt;
    result = AxisPlane{i, Rational(-f.linear().constant / f.linear().normal[i])};
  }
  return result;
}

inline std::optional<AxisPlane> axis_plane(const domain::SurfaceHalfSpace& half_space) {
  return half_space.quadric() != nullptr ? axis_plane(*half_space.quadric()) : std::nullopt;
}

// The planes x_axis = c that are the surface, or a part of it; of two that are not rational, none.
inline std::vector<AxisPlane> axis_planes(const domain::HalfSpace<3>& half_space) {
  if (const auto plane = axis_plane(half_space)) return {*plane};
  const domain::Quadric<3>& f = half_space.polynomial();
  std::vector<AxisPlane> result;
  if (f.is_linear()) return result;
  const auto& square = f.square();
  const auto& normal = f.linear().normal;
  const Rational& constant = f.linear().constant;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t j = (a + 1) % 3;
    const std::size_t k = (a + 2) % 3;
    // f = (x_a - c) g, g linear: nothing of degree two in the others is left at c.
    if (square[j][j] != 0 || square[k][k] != 0 || square[j][k] != 0) continue;
    if (square[a][j] != 0 || square[a][k] != 0) {
      const std::size_t other = square[a][j] != 0 ? j : k;
      const Rational c = -normal[other] / (2 * square[a][other]);
      const bool is_zero_there = 2 * square[a][j] * c + normal[j] == 0 &&
                                 2 * square[a][k] * c + normal[k] == 0 &&
                                 (square[a][a] * c + normal[a]) * c + constant == 0;
      if (is_zero_there) result.push_back({a, c});
    } else if (normal[j] == 0 && normal[k] == 0) {
      for (const RealRoot& root : real_roots({square[a][a], normal[a], constant})) {
        if (root.value.factor() == 0) result.push_back({a, root.value.rational_part()});
      }
    }
  }
  return result;
}

inline std::vector<AxisPlane> axis_planes(const domain::SurfaceHalfSpace& half_space) {
  return half_space.quadric() != nullptr ? axis_planes(*half_space.quadric())
                                         : std::vector<AxisPlane>();
}

// A function in the box's own coordinates that is negative inside the half-space, positive
// outside.
inline std::optional<UnitSurface> local_polynomial(const domain::HalfSpace<3>& half_space,
                                                   const Box3& box) {
  if (half_space.nappe() && domain::range(*half_space.nappe(), box).maximum > 0) {
    return std::nullopt;
  }
  const UnitSurface f(unit_quadric(half_space.polynomial(), box));
  return half_space.is_complement() ? -f : f;
}

// None if the box meets the axis.
inline std::optional<UnitSurface> local_polynomial(const domain::Torus& torus, const Box3& box) {
  const std::optional<UnitSurface> f =
      UnitSurface::difference(unit_quadric(torus.base(), box), unit_quadric(torus.radicand(), box));
  return f && torus.is_complement() ? -*f : f;
}
inline std::optional<UnitSurface> local_polynomial(const domain::SurfaceHalfSpace& half_space,
                                                   const Box3& box) {
  return half_space.visit([&](const auto& kind) { return local_polynomial(kind, box); });
}

inline std::pair<Box3, Box3> divided(const Box3& box, const AxisPlane& cut) {
  domain::Coordinates<3> upper_of_first = box.upper().coordinates();
  domain::Coordinates<3> lower_of_second = box.lower().coordinates();
  upper_of_first[cut.axis] = cut.coordinate;
  lower_of_second[cut.axis] = cut.coordinate;
  return {Box3(box.lower(), upper_of_first), Box3(lower_of_second, box.upper())};
}

// The middle of a box and half its sides. [Approximate]
struct MiddleOfBox {
  std::array<CertifiedDouble, 3> middle;
  std::array<double, 3> half{};

  explicit MiddleOfBox(const Box3& box) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double low = box.lower().approximate()[i].value;
      const double high = box.upper().approximate()[i].value;
      middle[i] = exactly(low / 2 + high / 2);
      half[i] = high / 2 - low / 2;
    }
  }
};

// By how much the function may differ along each axis from what it is in the middle of the box,
// roughly.
inline std::array<double, 3> variations(const domain::HalfSpace<3>& half_space, const Box3& box) {
  const MiddleOfBox at(box);
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 3> along{};
    along[i] = at.half[i];
    result[i] = half_space.polynomial().variation(at.middle, along);
  }
  return result;
}
inline std::array<double, 3> variations(const domain::Torus& torus, const Box3& box) {
  const MiddleOfBox at(box);
  const double root = square_root(torus.radicand().approximate(at.middle)).value;
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 3> along{};
    along[i] = at.half[i];
    const double of_root =
        root > 0 ? torus.radicand().approximate_slope(i, at.middle).value / (2 * root) : 0;
    const double slope = torus.base().approximate_slope(i, at.middle).value - of_root;
    result[i] = std::abs(slope) * at.half[i] + torus.base().curvature(along);
  }
  return result;
}
inline std::array<double, 3> variations(const domain::SurfaceHalfSpace& half_space,
                                        const Box3& box) {
  return half_space.visit([&](const auto& kind) { return variations(kind, box); });
}

// The axis along which the surfaces vary most, or, of other primitives, the longest of the box.
class DividingAxis {
 public:
  explicit DividingAxis(const Box3& box) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double length = box.upper().approximate()[i].value - box.lower().approximate()[i].value;
      weights_[i] = 0x1p-20 * length;
    }
  }
  template <SpatialDomain P>
  void add(const SurfaceTable<P>& table, const LiteralTree& tree, const Box3& box) {
    if constexpr (requires(const P& p) { variations(p, box); }) {
      csg::for_each_primitive(tree, [&](const Literal& literal) {
        if (count_ == enough) return;
        ++count_;
        const std::array<double, 3> v = variations(table[literal.surface], box);
        const double sum = v[0] + v[1] + v[2];
        for (std::size_t i = 0; i < 3 && sum > 0; ++i) weights_[i] += v[i] / sum;
      });
    }
  }
  AxisPlane bisector(const Box3& box) const {
    const auto axis = static_cast<std::size_t>(std::max_element(weights_.begin(), weights_.end()) -
                                               weights_.begin());
    return {axis, Rational((box.lower()[axis] + box.upper()[axis]) / 2)};
  }

 private:
  static constexpr std::size_t enough = 32;
  std::array<double, 3> weights_{};
  std::size_t count_ = 0;
};

// Of the planes across an axis that surfaces have and that cross the box, the nearest to its
// middle.
template <SpatialDomain P>
std::optional<AxisPlane> axis_cut(const SurfaceTable<P>& table, const LiteralTree& tree,
                                  const Box3& box) {
  std::optional<AxisPlane> best;
  double least = 2;
  if constexpr (requires(const P& p) { axis_planes(p); }) {
    csg::for_each_primitive(tree, [&](const Literal& literal) {
      for (const AxisPlane& plane : axis_planes(table[literal.surface])) {
        const Rational& low = box.lower()[plane.axis];
        const Rational& high = box.upper()[plane.axis];
        if (plane.coordinate <= low || plane.coordinate >= high) continue;
        const double share = nearest_double(Rational((plane.coordinate - low) / (high - low)));
        if (std::abs(share - 0.5) < least) {
          least = std::abs(share - 0.5);
          best = plane;
        }
      }
    });
  }
  return best;
}

// How well the surfaces are graphs over the face across an axis: the least ratio of the derivative
// along the axis to those across it; 0 if it may vanish in the cell.
inline double graph_quality(const std::vector<UnitSurface>& surfaces, std::size_t axis) {
  double quality = HUGE_VAL;
  for (const UnitSurface& f : surfaces) {
    const CertifiedDouble along = f.derivative_in_cell(axis);
    const double least = std::abs(along.value) * (1 - 0x1p-40) - along.error;
    if (!(least > 0)) return 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (i != axis) quality = std::min(quality, least / magnitude(f.derivative_in_cell(i)));
    }
  }
  return quality;
}

// REQUIRES a tree of few nodes, that is neither Empty nor Full.
template <SpatialDomain P>
std::optional<Column> column_of(const SurfaceTable<P>& table, const LiteralTree& tree,
                                const Box3& box) {
  constexpr std::size_t most_surfaces = 12;
  // Where tori are, larger cells with steeper graphs leave less to do in all (measured).
  constexpr double least_quality = 0.25;
  constexpr double least_quality_of_tori = 0.0625;
  if constexpr (requires(const P& p) { local_polynomial(p, box); }) {
    const auto numbers = surfaces_of(tree, most_surfaces);
    if (!numbers) return std::nullopt;
    std::vector<UnitSurface> surfaces;
    for (const std::uint32_t number : *numbers) {
      const auto f = local_polynomial(table[number], box);
      if (!f) return std::nullopt;
      surfaces.push_back(*f);
    }
    std::size_t axis = 0;
    double best = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double quality = graph_quality(surfaces, i);
      if (quality > best) {
        best = quality;
        axis = i;
      }
    }
    const bool has_torus = std::any_of(surfaces.begin(), surfaces.end(), [](const UnitSurface& f) {
      return f.radicand().has_value();
    });
    if (best < (has_torus ? least_quality_of_tori : least_quality)) return std::nullopt;
    std::vector<bool> is_falling;
    for (UnitSurface& f : surfaces) {
      is_falling.push_back(f.derivative_in_cell(axis).value < 0);
      f = (is_falling.back() ? -f : f).with_height(axis);
    }
    PassedTree passed = csg::flatten(tree, [&](const Literal& literal) {
      const auto index = static_cast<std::size_t>(
          std::lower_bound(numbers->begin(), numbers->end(), literal.surface) - numbers->begin());
      return PassedLiteral{static_cast<std::uint32_t>(index),
                           is_falling[index] != literal.is_complemented};
    });
    return Column(axis, std::move(surfaces), std::move(passed));
  } else {
    return std::nullopt;
  }
}

}  // namespace exactcsg::measure::detail
