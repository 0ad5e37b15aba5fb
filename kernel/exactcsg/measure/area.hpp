// SPDX-License-Identifier: Apache-2.0
#pragma once

// The area of a set's boundary inside an open box, between two bounds that are proved. [Certified]
//
//   area(tree, box, limits) -> CertifiedMeasure
//
// The set is regular: what counts is where one side is in the set and the other is not. Surfaces
// that the tree makes irrelevant do not count, nor those with the set on both sides, nor the sides
// of the box.
//
// LAW area.1  the area lies in value.
// LAW area.2  as LAW certified_measure.2 and certified_measure.3.
// LAW area.3  area(complement(tree), box) is the same.
// REQUIRES half-spaces of quadrics or of tori, or primitives with overloads of what is called here.
// COST: the box is divided into cells as for volumes, until in each every surface is a graph across
// some axis; what of each is boundary is an integral over a face (patch.hpp), which is divided
// further. The width falls, in the number n of cells, as n^-3 at least, also along edges, and where
// three surfaces meet in one. Where two surfaces touch along a curve, areas are known to about the
// root of the rounding errors, a relative 1e-8 of the cells there, unless one is a plane across an
// axis. Surfaces that share a piece and have other polynomials leave bounds apart by the area of
// that piece.
//
// In other cells a line crosses a surface a few times only, so that its area is at most those times
// the sum of the areas of the cell's shadows along the three axes. Boundary on planes across the
// axes, at which cells are divided, is a set in the plane: where the trees of what is just below
// and just above differ.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/measure/certified_measure.hpp"
#include "exactcsg/measure/patch.hpp"
#include "exactcsg/measure/substitution.hpp"

namespace exactcsg::measure {

namespace detail {

// How often a line that does not lie in the surface crosses it at most.
inline unsigned most_crossings(const domain::HalfSpace<3>& half_space) {
  return half_space.polynomial().is_linear() ? 1 : 2;
}
inline unsigned most_crossings(const domain::SurfaceHalfSpace& half_space) {
  return half_space.quadric() != nullptr ? most_crossings(*half_space.quadric()) : 4;
}

// What the form is where one coordinate is a constant.
inline domain::LinearForm<3> restricted(const domain::LinearForm<3>& f, const AxisPlane& plane) {
  domain::LinearForm<3> result = f;
  result.constant += f.normal[plane.axis] * plane.coordinate;
  result.normal[plane.axis] = 0;
  return result;
}
inline domain::Quadric<3> restricted(const domain::Quadric<3>& f, const AxisPlane& plane) {
  const auto [axis, c] = plane;
  auto square = f.square();
  domain::LinearForm<3> linear = restricted(f.linear(), plane);
  linear.constant += square[axis][axis] * c * c;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i != axis) linear.normal[i] += 2 * square[axis][i] * c;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    square[axis][i] = 0;
    square[i][axis] = 0;
  }
  return {std::move(square), std::move(linear)};
}
inline bool is_constant(const domain::Quadric<3>& f) {
  return f.is_linear() && f.linear().is_constant();
}

// {f <= 0}, whatever f is.
inline domain::Solid3 where_negative(domain::Quadric<3> f) {
  if (!is_constant(f)) return domain::Solid3::primitive(domain::HalfSpace<3>(std::move(f)));
  return f.linear().constant < 0 ? domain::Solid3::full() : domain::Solid3::empty();
}

// The part of the half-space in the plane, as seen just above it or just below, as a set that does
// not depend on the coordinate along the axis.
inline domain::Solid3 restricted(const domain::HalfSpace<3>& half_space, const AxisPlane& plane,
                                 bool is_above) {
  const domain::Quadric<3>& f = half_space.polynomial();
  domain::Quadric<3> in_plane = restricted(f, plane);
  if (is_constant(in_plane) && in_plane.linear().constant == 0) {
    // f = (x_axis - c) g: the derivative along the axis is g there.
    const std::size_t axis = plane.axis;
    domain::LinearForm<3> g{{}, f.linear().normal[axis]};
    for (std::size_t i = 0; i < 3; ++i) g.normal[i] = 2 * f.square()[axis][i];
    in_plane = Rational(is_above ? 1 : -1) * domain::Quadric<3>(restricted(g, plane));
  }
  domain::Solid3 result = where_negative(std::move(in_plane));
  if (half_space.nappe()) {
    result =
        csg::intersect(std::move(result), where_negative(restricted(*half_space.nappe(), plane)));
  }
  return half_space.is_complement() ? csg::complement(std::move(result)) : result;
}
// No plane is a part of a torus: what is just above is what is just below.
inline domain::Torus restricted(const domain::Torus& torus, const AxisPlane& plane) {
  const domain::Torus result(restricted(torus.base(), plane), restricted(torus.radicand(), plane),
                             torus.squared_ratio());
  return torus.is_complement() ? complement(result) : result;
}
inline csg::BooleanTree<domain::SurfaceHalfSpace> restricted(
    const domain::SurfaceHalfSpace& half_space, const AxisPlane& plane, bool is_above) {
  using Tree = csg::BooleanTree<domain::SurfaceHalfSpace>;
  if (const domain::Torus* torus = half_space.torus()) {
    return Tree::primitive(restricted(*torus, plane));
  }
  return csg::map(restricted(*half_space.quadric(), plane, is_above),
                  [](const domain::HalfSpace<3>& h) { return domain::SurfaceHalfSpace(h); });
}

// Where the boundary is in the plane, as a set that does not depend on the coordinate along the
// axis.
template <SpatialDomain P>
csg::BooleanTree<P> boundary_in(const AxisPlane& plane, const csg::BooleanTree<P>& tree) {
  const auto side = [&](bool is_above) {
    return substituted<csg::BooleanTree<P>>(
        tree, [&](const P& primitive) { return restricted(primitive, plane, is_above); });
  };
  return csg::simplify(csg::symmetric_difference(side(false), side(true)));
}

// All of the zeros of the polynomial: both nappes of a cone.
inline domain::HalfSpace<3> whole_surface(const domain::HalfSpace<3>& half_space) {
  return half_space.nappe() ? domain::HalfSpace<3>(half_space.polynomial()) : half_space;
}
inline domain::SurfaceHalfSpace whole_surface(const domain::SurfaceHalfSpace& half_space) {
  if (half_space.quadric() == nullptr) return half_space;
  return whole_surface(*half_space.quadric());
}

// Whether nothing of the surface is in the cells of the same size beyond the top and below the
// bottom: then a surface that touches the plane of one does not pass it.
template <SpatialDomain P>
Patch::Stays stays_in(const P& surface, const UnitSurface& f, const Box3& box, std::size_t axis) {
  const Rational height = box.upper()[axis] - box.lower()[axis];
  const auto has_nothing = [&](bool is_above) {
    const Rectangle whole;
    const CertifiedDouble range = f.with_height(axis).range_at(whole, is_above ? 1 : -1);
    if (is_positive(range) || is_negative(range)) return false;
    domain::Coordinates<3> lower = box.lower().coordinates();
    domain::Coordinates<3> upper = box.upper().coordinates();
    lower[axis] += is_above ? height : Rational(-height);
    upper[axis] += is_above ? height : Rational(-height);
    return classify(whole_surface(surface), Box3(lower, upper)) != csg::Membership::Unknown;
  };
  return {has_nothing(false), has_nothing(true)};
}

// The axis across which the surface is a graph in the cell, and not a steep one.
inline std::optional<std::size_t> axis_of_graph(const UnitSurface& f) {
  constexpr double least_quality = 0.5;
  std::optional<std::size_t> result;
  double best = least_quality;
  for (std::size_t i = 0; i < 3; ++i) {
    const double quality = graph_quality({f}, i);
    if (quality < best) continue;
    best = quality;
    result = i;
  }
  return result;
}

// Of a cell in which each surface is a graph across some axis.
template <SpatialDomain P>
std::vector<Patch> patches_of(const SurfaceTable<P>& table, const LiteralTree& tree,
                              const Box3& box) {
  constexpr std::size_t most_surfaces = 12;
  std::vector<Patch> result;
  if constexpr (requires(const P& p) { local_polynomial(p, box); }) {
    const auto numbers = surfaces_of(tree, most_surfaces);
    if (!numbers) return result;
    std::vector<UnitSurface> surfaces;
    std::vector<std::size_t> axes;
    for (const std::uint32_t number : *numbers) {
      const auto f = local_polynomial(table[number], box);
      const auto axis = f ? axis_of_graph(*f) : std::nullopt;
      if (!axis) return result;
      surfaces.push_back(*f);
      axes.push_back(*axis);
    }
    const auto cell = std::make_shared<Patch::Cell>();
    cell->surfaces = std::move(surfaces);
    cell->tree = csg::flatten(tree, [&](const Literal& literal) {
      const auto place = std::lower_bound(numbers->begin(), numbers->end(), literal.surface);
      return Literal{static_cast<std::uint32_t>(place - numbers->begin()), literal.is_complemented};
    });
    for (std::size_t k = 0; k < axes.size(); ++k) {
      result.emplace_back(cell, k, axes[k],
                          stays_in(table[(*numbers)[k]], cell->surfaces[k], box, axes[k]),
                          half_lengths(box, (axes[k] + 1) % 3));
    }
  }
  return result;
}

// What IntegralMeter measures: the area of the boundary but for planes across the axes.
class AreaMeasure {
 public:
  static constexpr bool is_never_negative = true;

  Rational in_full_cell(const Box3&) const { return 0; }

  template <SpatialDomain P>
  CertifiedDouble in_mixed_cell(const SurfaceTable<P>& table, const LiteralTree& tree,
                                const Box3& box) const {
    constexpr std::size_t many = 64;
    double crossings = 0;
    const auto count = [&](std::uint32_t surface) {
      if (!axis_plane(table[surface])) crossings += most_crossings(table[surface]);
    };
    if (const auto surfaces = surfaces_of(tree, many)) {
      for (const std::uint32_t surface : *surfaces) count(surface);
    } else {
      csg::for_each_primitive(tree, [&](const Literal& literal) { count(literal.surface); });
    }
    const std::array<CertifiedDouble, 3> half = half_lengths(box, 0);
    const CertifiedDouble shadows = half[0] * half[1] + half[1] * half[2] + half[2] * half[0];
    return up_to(exactly(4 * crossings) * shadows);
  }

  using Part = Patch;
  template <SpatialDomain P>
  std::vector<Patch> parts(const SurfaceTable<P>& table, const LiteralTree& tree,
                           const Box3& box) const {
    return patches_of(table, tree, box);
  }
};

// The planes across the axes that are part of a surface and cross the box, each once.
template <SpatialDomain P>
std::vector<AxisPlane> planes_across_axes(const csg::BooleanTree<P>& tree, const Box3& box) {
  std::vector<AxisPlane> result;
  csg::for_each_primitive(tree, [&](const P& primitive) {
    for (const AxisPlane& plane : axis_planes(primitive)) {
      if (box.lower()[plane.axis] < plane.coordinate &&
          plane.coordinate < box.upper()[plane.axis]) {
        result.push_back(plane);
      }
    }
  });
  const auto is_before = [](const AxisPlane& a, const AxisPlane& b) {
    return a.axis != b.axis ? a.axis < b.axis : a.coordinate < b.coordinate;
  };
  const auto is_same = [](const AxisPlane& a, const AxisPlane& b) {
    return a.axis == b.axis && a.coordinate == b.coordinate;
  };
  std::sort(result.begin(), result.end(), is_before);
  result.erase(std::unique(result.begin(), result.end(), is_same), result.end());
  return result;
}

}  // namespace detail

template <SpatialDomain P>
CertifiedMeasure area(const csg::BooleanTree<P>& tree, const domain::Box<3>& box,
                      const MeasureLimits& limits = {}) {
  const std::vector<detail::AxisPlane> planes = detail::planes_across_axes(tree, box);
  // Half the width for what is not in these planes, half for them together.
  MeasureLimits of_rest = limits;
  of_rest.relative_width /= 2;
  of_rest.absolute_width /= 2;
  CertifiedMeasure result = detail::IntegralMeter<P, detail::AreaMeasure>(tree, box, of_rest).run();
  MeasureLimits of_plane = of_rest;
  of_plane.absolute_width =
      std::max(limits.absolute_width,
               nearest_double(Rational(rational_of(limits.relative_width) * result.value.lower))) /
      2 / static_cast<double>(std::max<std::size_t>(planes.size(), 1)) * (1 - 0x1p-40);
  for (const detail::AxisPlane& plane : planes) {
    domain::Coordinates<3> lower = box.lower().coordinates();
    domain::Coordinates<3> upper = box.upper().coordinates();
    lower[plane.axis] = 0;
    upper[plane.axis] = 1;
    const CertifiedMeasure part =
        volume(detail::boundary_in(plane, tree), domain::Box<3>(lower, upper), of_plane);
    result.value.lower += part.value.lower;
    result.value.upper += part.value.upper;
    result.cells += part.cells;
    if (result.stop == StopReason::Width) result.stop = part.stop;
  }
  return result;
}

}  // namespace exactcsg::measure
