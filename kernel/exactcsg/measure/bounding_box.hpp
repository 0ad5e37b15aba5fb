// SPDX-License-Identifier: Apache-2.0
#pragma once

// A box that holds a set, if one is found. [Certified]
//
//   bounding_box(tree) -> Extent
//   tightened(tree, box) -> optional<Box>   a smaller box that still has all that the box has
//
// LAW bounding_box.1  Bounded: the set lies in the box; nothing is outside but, perhaps, a set
//                     without interior.
// LAW bounding_box.2  Empty: the set has no interior point. Not every such set is recognised.
// LAW bounding_box.3  NotBounded: no box was found: the set is unbounded; or is bounded by surfaces
//                     that part from each other only far beyond the size of their coefficients, or
//                     so slowly that it is not proved.
// LAW bounding_box.4  sides that are bounded by planes across an axis, and by nothing else, are
//                     those planes.
// REQUIRES half-spaces of degree two or of tori, or primitives with an overload of beyond().
//
// Method: beyond the cube of half side R a point is seen from the origin: where |x_axis| = m is its
// greatest coordinate, at (u, v, w) = (x_j / m, x_k / m, 1 / m), in a box with 0 < w < 1 / R. There
// f(x) / m^2 is a polynomial of degree two again, so that a proof about regions in that box says
// whether anything of the set is out there.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/measure/region_proof.hpp"
#include "exactcsg/measure/substitution.hpp"

namespace exactcsg::measure {

enum class ExtentKind : unsigned char { Empty, Bounded, NotBounded };

struct Extent {
  ExtentKind kind = ExtentKind::NotBounded;
  std::optional<domain::Box<3>> box;  // if Bounded
};

namespace detail {

// Where the coordinate of one axis is greatest in magnitude, and of one sign.
struct Outlook {
  std::size_t axis = 0;
  bool is_negative = false;
};

inline domain::Quadric<3> seen_from(const Outlook& outlook, const domain::Quadric<3>& f) {
  const std::size_t a = outlook.axis;
  const std::size_t j = (a + 1) % 3;
  const std::size_t k = (a + 2) % 3;
  const Rational sign = outlook.is_negative ? -1 : 1;
  const auto& normal = f.linear().normal;
  const Rational& constant = f.linear().constant;
  // f / m of a linear one: f / m^2 would be 0 wherever w is.
  if (f.is_linear()) {
    return domain::LinearForm<3>{{normal[j], normal[k], constant}, Rational(sign * normal[a])};
  }
  const auto& square = f.square();
  const domain::Quadric<3>::Matrix seen{
      {{square[j][j], square[j][k], Rational(normal[j] / 2)},
       {square[j][k], square[k][k], Rational(normal[k] / 2)},
       {Rational(normal[j] / 2), Rational(normal[k] / 2), constant}}};
  return {seen,
          {{Rational(2 * sign * square[a][j]), Rational(2 * sign * square[a][k]),
            Rational(sign * normal[a])},
           square[a][a]}};
}

inline domain::Solid3 seen_from(const Outlook& outlook, const domain::HalfSpace<3>& half_space) {
  auto seen =
      domain::Solid3::primitive(domain::HalfSpace<3>(seen_from(outlook, half_space.polynomial())));
  if (half_space.nappe()) {
    seen = csg::intersect(
        std::move(seen),
        domain::Solid3::primitive(domain::HalfSpace<3>(seen_from(outlook, *half_space.nappe()))));
  }
  return half_space.is_complement() ? csg::complement(std::move(seen)) : seen;
}

// REQUIRES is_seen_from_afar(half_space)
inline domain::Solid3 seen_from(const Outlook& outlook,
                                const domain::SurfaceHalfSpace& half_space) {
  return seen_from(outlook, *half_space.quadric());
}

inline bool is_seen_from_afar(const domain::HalfSpace<3>&) { return true; }
inline bool is_seen_from_afar(const domain::SurfaceHalfSpace& half_space) {
  return half_space.quadric() != nullptr;
}

template <SpatialDomain P>
domain::Solid3 seen_from(const Outlook& outlook, const csg::BooleanTree<P>& tree) {
  return substituted(tree, [&](const P& primitive) { return seen_from(outlook, primitive); });
}

// About how far from the origin the surface's own features are. [Approximate]
inline double size_of_coefficients(const domain::Quadric<3>& f) {
  double square = 0;
  double linear = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    linear = std::max(linear, std::abs(nearest_double(f.linear().normal[i])));
    for (const Rational& x : f.square()[i]) square = std::max(square, std::abs(nearest_double(x)));
  }
  const double constant = std::abs(nearest_double(f.linear().constant));
  if (square == 0) return linear > 0 ? constant / linear : 0;
  return std::max(linear / square, std::sqrt(constant / square));
}
inline double size_of_coefficients(const domain::HalfSpace<3>& half_space) {
  return size_of_coefficients(half_space.polynomial());
}
inline double size_of_coefficients(const domain::Torus& torus) {
  return size_of_coefficients(torus.base());
}
inline double size_of_coefficients(const domain::SurfaceHalfSpace& half_space) {
  return half_space.visit([](const auto& kind) { return size_of_coefficients(kind); });
}

template <SpatialDomain P>
double size_of_coefficients(const csg::BooleanTree<P>& tree) {
  double size = 0;
  csg::for_each_primitive(
      tree, [&](const P& primitive) { size = std::max(size, size_of_coefficients(primitive)); });
  return size;
}

// Primitives that are all In or all Out beyond the cube of this half side, where they are known to
// be: an overload for bounded ones.
inline csg::Membership beyond(const Rational&, const domain::HalfSpace<3>&) {
  return csg::Membership::Unknown;
}

// Is the ellipsoid where f is not positive inside the cube of half side `reach` round the origin?
// REQUIRES f's terms of degree two are a positive definite form
inline bool is_ellipsoid_within(const Rational& reach, const domain::Quadric<3>& f) {
  AffineMap half_gradient = AffineMap::identity();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) half_gradient.m[i][j] = f.square()[i][j];
    half_gradient.m[i][3] = f.linear().normal[i] / 2;
  }
  const AffineMap to_zero = inverse(half_gradient);
  const domain::Point<3> centre(to_zero.m[0][3], to_zero.m[1][3], to_zero.m[2][3]);
  const Rational depth = -f(centre.coordinates());
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational space = reach - abs(centre[i]);
    if (space < 0 || space * space < depth * to_zero.m[i][i]) return false;
  }
  return true;
}

// With c^2 the squared ratio, a torus lies where rho^2 + z^2 <= (1 + c)^2; 2 c <= 1 + c^2.
inline csg::Membership beyond(const Rational& reach, const domain::Torus& torus) {
  domain::LinearForm<3> linear = torus.base().linear();
  linear.constant -= 3 + torus.squared_ratio();
  if (!is_ellipsoid_within(reach, {torus.base().square(), std::move(linear)})) {
    return csg::Membership::Unknown;
  }
  return torus.is_complement() ? csg::Membership::In : csg::Membership::Out;
}
inline csg::Membership beyond(const Rational& reach, const domain::SurfaceHalfSpace& half_space) {
  return half_space.visit([&](const auto& kind) { return beyond(reach, kind); });
}

template <SpatialDomain P>
bool is_empty_beyond(const Rational& reach, const csg::BooleanTree<P>& tree) {
  const csg::BooleanTree<P> far =
      csg::prune(tree, [&](const P& primitive) { return beyond(reach, primitive); });
  bool is_seen = true;
  csg::for_each_primitive(
      far, [&](const P& primitive) { is_seen = is_seen && is_seen_from_afar(primitive); });
  if (!is_seen) return false;
  const domain::Box<3> view(domain::Point<3>(-1, -1, 0), domain::Point<3>(1, 1, 1 / reach));
  ProofLimits limits;
  limits.cells = 2000;
  limits.negligible_share = 0;
  for (std::size_t side = 0; side < 6; ++side) {
    const domain::Solid3 seen = seen_from(Outlook{side / 2, side % 2 == 1}, far);
    const Proof proof = prove_disjoint(seen, domain::Solid3::full(), view, limits);
    if (!std::holds_alternative<Proved>(proof)) return false;
  }
  return true;
}

// Moves the sides of a box inwards.
template <SpatialDomain P>
class BoxTightener {
 public:
  BoxTightener(const csg::BooleanTree<P>& tree, const Box3& box)
      : tree_(pruned(tree, box)), box_(box) {}

  std::optional<Box3> run() {
    for (int sweep = 0; sweep < 2; ++sweep) {
      for (std::size_t side = 0; side < 6; ++side) {
        if (tree_.is_empty()) return std::nullopt;
        if (tree_.is_full()) return box_;
        move_to_planes(side / 2, side % 2 == 1);
        move_by_halves(side / 2, side % 2 == 1);
        tree_ = pruned(tree_, box_);
      }
    }
    return tree_.is_empty() ? std::nullopt : std::optional(box_);
  }

 private:
  static csg::BooleanTree<P> pruned(const csg::BooleanTree<P>& tree, const Box3& box) {
    return csg::prune(tree, [&](const P& primitive) { return classify(primitive, box); });
  }

  // True if the side was moved, because nothing is between it and the coordinate.
  // REQUIRES the coordinate is strictly between the sides.
  bool move(std::size_t axis, bool is_upper, const Rational& coordinate) {
    const auto parts = divided(box_, {axis, coordinate});
    if (!pruned(tree_, is_upper ? parts.second : parts.first).is_empty()) return false;
    box_ = is_upper ? parts.first : parts.second;
    return true;
  }

  void move_to_planes(std::size_t axis, bool is_upper) {
    std::vector<Rational> planes;
    csg::for_each_primitive(tree_, [&](const P& primitive) {
      const std::optional<AxisPlane> plane = axis_plane(primitive);
      if (!plane || plane->axis != axis) return;
      if (box_.lower()[axis] < plane->coordinate && plane->coordinate < box_.upper()[axis]) {
        planes.push_back(plane->coordinate);
      }
    });
    std::sort(planes.begin(), planes.end());
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
    if (is_upper) std::reverse(planes.begin(), planes.end());
    // The farthest that can be moved to: if one cannot, those behind it cannot.
    std::size_t low = 0;
    std::size_t high = planes.size();
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      if (move(axis, is_upper, planes[middle])) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
  }

  void move_by_halves(std::size_t axis, bool is_upper) {
    Rational share(1, 2);
    for (int step = 0; step < 40 && share >= Rational(1, 8); ++step) {
      const Rational depth = (box_.upper()[axis] - box_.lower()[axis]) * share;
      const Rational coordinate =
          is_upper ? Rational(box_.upper()[axis] - depth) : Rational(box_.lower()[axis] + depth);
      if (!move(axis, is_upper, coordinate)) share /= 2;
    }
  }

  csg::BooleanTree<P> tree_;
  Box3 box_;
};

}  // namespace detail

// nullopt: the set has no interior point in the box.
template <SpatialDomain P>
std::optional<domain::Box<3>> tightened(const csg::BooleanTree<P>& tree,
                                        const domain::Box<3>& box) {
  return detail::BoxTightener<P>(tree, box).run();
}

template <SpatialDomain P>
Extent bounding_box(const csg::BooleanTree<P>& tree) {
  const csg::BooleanTree<P> simple = csg::simplify(tree);
  if (simple.is_empty()) return {ExtentKind::Empty, std::nullopt};
  if (simple.is_full()) return {ExtentKind::NotBounded, std::nullopt};
  const double size = detail::size_of_coefficients(simple);
  if (!(size < HUGE_VAL)) return {ExtentKind::NotBounded, std::nullopt};
  for (const int steps : {2, 10, 20}) {
    const int exponent = std::ilogb(size > 0 ? size : 1.0) + 1 + steps;
    const Rational reach = rational_of(std::ldexp(1.0, std::min(exponent, 1023)));
    if (!detail::is_empty_beyond(reach, simple)) continue;
    const Rational low = -reach;
    auto box =
        tightened(simple, {domain::Point<3>(low, low, low), domain::Point<3>(reach, reach, reach)});
    return {box ? ExtentKind::Bounded : ExtentKind::Empty, std::move(box)};
  }
  return {ExtentKind::NotBounded, std::nullopt};
}

}  // namespace exactcsg::measure
