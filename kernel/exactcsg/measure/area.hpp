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
// REQUIRES domain::HalfSpace<3>, or primitives with overloads of what is called here. Trees with
// tori have none and do not compile: what a plane across the axes cuts of a torus is no quadric.
// COST: as volume (certified_measure.hpp). The width falls, in the number n of cells, as n^-2: that
// is what edges cost, where two surfaces cross or one leaves a column; as n^-3.5 within a graph.
// Surfaces that share a piece and have other polynomials leave bounds apart by the area of that
// piece.
//
// Over a rectangle of a column the area of a graph is an integral of the root of a polynomial in
// its slopes. In other cells a line crosses a surface a few times only, so that its area is at most
// those times the sum of the areas of the cell's shadows along the three axes. Boundary on planes
// across the axes, at which cells are divided, is a set in the plane: where the trees of what is
// just below and just above differ.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/measure/certified_measure.hpp"
#include "exactcsg/measure/substitution.hpp"

namespace exactcsg::measure {

namespace detail {

// How often a line that does not lie in the surface crosses it at most.
inline unsigned most_crossings(const domain::HalfSpace<3>& half_space) {
  return half_space.polynomial().is_linear() ? 1 : 2;
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

// Where the boundary is in the plane, as a set that does not depend on the coordinate along the
// axis.
template <SpatialDomain P>
domain::Solid3 boundary_in(const AxisPlane& plane, const csg::BooleanTree<P>& tree) {
  const auto side = [&](bool is_above) {
    return substituted(tree,
                       [&](const P& primitive) { return restricted(primitive, plane, is_above); });
  };
  return csg::simplify(csg::symmetric_difference(side(false), side(true)));
}

// The area of graphs in a column.
class GraphArea {
 public:
  // Of the heights' scale in relation to the scales along the rectangle's sides, squared.
  GraphArea(const CertifiedDouble& along_s, const CertifiedDouble& along_t)
      : along_s_(along_s), along_t_(along_t) {}

  CertifiedDouble operator()(const Graph& graph, const Rectangle& r) const {
    constexpr std::size_t degree = series_order - 1;
    return detail::integral(r, density(graph.series_at_centre(degree), degree - 1),
                            density(graph.series_anywhere(), degree), degree);
  }
  // Encloses the area over the rectangle's, at every point of the graph.
  CertifiedDouble density(const UnitSurface& f, const Graph& graph, const Rectangle& r) const {
    return density(f, {CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b},
                       between(graph.lower(), graph.upper())});
  }
  double bound(const UnitSurface& f, const Rectangle& r) const {
    const CertifiedDouble greatest =
        density(f, {CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b}, CertifiedDouble{0, 1}});
    return magnitude(greatest) * r.area() * (1 + 0x1p-48);
  }

 private:
  CertifiedDouble density(const UnitSurface& f, const UnitSurface::Vector& at) const {
    const CertifiedDouble slope = f.derivative(2, at);
    const CertifiedDouble s = f.derivative(0, at) / slope;
    const CertifiedDouble t = f.derivative(1, at) / slope;
    return root_of_at_least_one(exactly(1) + along_s_ * s * s + along_t_ * t * t);
  }
  Series density(const Series& height, std::size_t degree) const {
    const Series s = derivative(height, 0, degree);
    const Series t = derivative(height, 1, degree);
    const Series square = sum(scaled(along_s_, product(s, s, degree), degree),
                              scaled(along_t_, product(t, t, degree), degree), degree);
    return root(sum(constant_series(exactly(1)), square, degree), degree);
  }

  CertifiedDouble along_s_;
  CertifiedDouble along_t_;
};

// What IntegralMeter measures: the area of the boundary but for planes across the axes.
class AreaMeasure {
 public:
  static constexpr bool is_never_negative = true;
  static constexpr bool divides_by_trial = true;

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

  class InColumn {
   public:
    InColumn(const std::array<CertifiedDouble, 3>& half)
        : metric_(squared(half[2] / half[0]), squared(half[2] / half[1])),
          scale_(half[0] * half[1]) {}
    CertifiedDouble of_any_part(const Column& column, const Rectangle& r) const {
      return up_to(exactly(column.boundary_bound(r, metric_)) * scale_);
    }
    CertifiedDouble operator()(const Column& column, const Rectangle& r) const {
      const CertifiedDouble area = column.boundary(r, metric_);
      return is_zero(area) ? area : area * scale_;  // a product is never without rounding
    }

   private:
    static CertifiedDouble squared(const CertifiedDouble& x) { return x * x; }
    GraphArea metric_;
    CertifiedDouble scale_;
  };
  InColumn in_column(const Box3& box, const Column& column) const {
    return InColumn(half_lengths(box, (column.axis() + 1) % 3));
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
