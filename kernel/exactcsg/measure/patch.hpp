// SPDX-License-Identifier: Apache-2.0
#pragma once

// The part of one surface in a cell, as the graph of a function over a face of the cell, and how
// much of its area is boundary of a set. [Certified]
//
// Above each point of the face the surface is passed at one height at most. It is boundary there if
// the tree differs on its two sides, which the signs of the other surfaces' functions on the graph
// tell, and those of Z + 1 and 1 - Z for the bottom and the top of the cell. Over a rectangle of
// the face, where such a sign changes it does so along a curve, mostly: what is boundary are strips
// between curves (strip_integral.hpp).
//
// LAW patch.1  patch(rectangle) encloses the area of what is boundary over the rectangle and
//              between bottom and top. Its error falls as the rectangle's size to the power 7,
//              where no two curves touch, none has a tip, and no two surfaces touch along a curve.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/membership.hpp"
#include "exactcsg/measure/strip_integral.hpp"
#include "exactcsg/measure/surface_table.hpp"
#include "exactcsg/measure/unit_quadric.hpp"

namespace exactcsg::measure::detail {

// The area of graphs over rectangles, in the rectangles' unit.
class GraphArea {
 public:
  // Of the heights' scale in relation to the scales along the rectangle's sides, squared.
  GraphArea(const CertifiedDouble& along_s, const CertifiedDouble& along_t)
      : along_s_(along_s), along_t_(along_t) {}

  // Of the area over the face's.
  Series density(const Series& height, std::size_t degree) const {
    const Series s = derivative(height, 0, degree);
    const Series t = derivative(height, 1, degree);
    const Series square = sum(scaled(along_s_, product(s, s, degree), degree),
                              scaled(along_t_, product(t, t, degree), degree), degree);
    const Series radicand = sum(constant_series(exactly(1)), square, degree);
    return root(radicand, root_of_at_least_one(radicand[0][0]), degree);
  }
  // No part of the surface over the rectangle has a greater area.
  double bound(const UnitSurface& f, const Rectangle& r) const {
    const UnitSurface::Vector anywhere{CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b},
                                       CertifiedDouble{0, 1}};
    const CertifiedDouble slope = f.derivative(2, anywhere);
    const CertifiedDouble s = f.derivative(0, anywhere) / slope;
    const CertifiedDouble t = f.derivative(1, anywhere) / slope;
    const CertifiedDouble greatest =
        root_of_at_least_one(exactly(1) + along_s_ * s * s + along_t_ * t * t);
    return magnitude(greatest) * r.area() * (1 + 0x1p-48);
  }
  // How much the slopes change along each side of a rectangle by the terms of degree two, roughly.
  std::array<double, 2> bending(const Series& height, const Rectangle& r) const {
    const double s = std::sqrt(along_s_.value);
    const double t = std::sqrt(along_t_.value);
    const double mixed = std::abs(height[1][1].value);
    return {r.a * (2 * s * std::abs(height[2][0].value) + t * mixed),
            r.b * (2 * t * std::abs(height[0][2].value) + s * mixed)};
  }

 private:
  CertifiedDouble along_s_;
  CertifiedDouble along_t_;
};

using LiteralFlatTree = csg::FlatTree<Literal, csg::BooleanOperator>;

class Patch {
 public:
  // What all patches of a cell share.
  struct Cell {
    std::vector<std::uint32_t> numbers;  // of the surfaces, ascending
    std::vector<UnitSurface> surfaces;   // negative inside
    LiteralFlatTree tree;                // its literals are places in these lists
  };
  // Nothing of the surface is within a cell's height beyond the top, or below the bottom.
  struct Stays {
    bool above_bottom = false;
    bool below_top = false;
  };

  // axis: across which the surface is a graph in the cell. half: of the cell's sides, from axis + 1
  // on in cyclic order.
  Patch(const std::shared_ptr<const Cell>& cell, std::size_t own, std::size_t axis,
        const Stays& stays, const std::array<CertifiedDouble, 3>& half)
      : cell_(cell),
        own_(own),
        stays_(stays),
        metric_(squared(half[2] / half[0]), squared(half[2] / half[1])),
        scale_(half[0] * half[1]) {
    for (const UnitSurface& f : cell->surfaces) surfaces_.push_back(f.with_height(axis));
    if (surfaces_[own].derivative_in_cell(2).value < 0) surfaces_[own] = -surfaces_[own];
  }

  CertifiedDouble of_any_part(const Rectangle& r) const {
    return up_to(exactly(metric_.bound(surfaces_[own_], r)) * scale_);
  }
  CertifiedDouble operator()(const Rectangle& r) const {
    const UnitSurface& f = surfaces_[own_];
    if (is_positive(f.range_at(r, -1)) || is_negative(f.range_at(r, 1))) return {};
    const std::optional<Graph> graph = graph_over(r);
    if (!graph) return of_any_part(r);
    const CertifiedDouble area = boundary(*graph, r);
    return is_zero(area) ? area : area * scale_;  // a product is never without rounding
  }

  // Into how many parts a rectangle is divided along each side: one where graph and curves hardly
  // bend.
  std::array<int, 2> parts(const Rectangle& r) const {
    constexpr double hardly = 0.25;
    const std::optional<Graph> graph = graph_over(r);
    if (!graph) return {2, 2};
    const Series height = graph->series_at_centre(2);
    std::array<double, 2> bending = metric_.bending(height, r);
    const States states = states_near(*graph, r);
    for (std::size_t k = 0; k < states.size(); ++k) {
      if (states[k] != csg::Membership::Unknown) continue;
      const Series d = condition(k, {exactly(r.s), exactly(r.t)}, height, nullptr, 2);
      const double first =
          std::abs(d[1][0].value) * r.a + std::abs(d[0][1].value) * r.b + 0x1p-1000;
      const double mixed = std::abs(d[1][1].value) * r.a * r.b / 2;
      bending[0] += std::min(1.0, (std::abs(d[2][0].value) * r.a * r.a + mixed) / first);
      bending[1] += std::min(1.0, (std::abs(d[0][2].value) * r.b * r.b + mixed) / first);
    }
    return {bending[0] < hardly * bending[1] ? 1 : 2, bending[1] < hardly * bending[0] ? 1 : 2};
  }

 private:
  // In where the other surface's function is negative, where the graph is above the bottom, and
  // where it is below the top.
  using States = std::vector<csg::Membership>;
  std::size_t bottom() const { return surfaces_.size(); }
  std::size_t top() const { return surfaces_.size() + 1; }

  static CertifiedDouble squared(const CertifiedDouble& x) { return x * x; }

  // The graph found is the surface of the cell only if one interval of heights where the derivative
  // is positive has both.
  std::optional<Graph> graph_over(const Rectangle& r) const {
    std::optional<Graph> graph = Graph::find(surfaces_[own_], r);
    if (graph && (graph->lower() > 1 || graph->upper() < -1)) graph.reset();
    return graph;
  }

  static UnitSurface::Vector points_near(const Graph& graph, const Rectangle& r) {
    return {CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b},
            between(graph.lower(), graph.upper())};
  }

  States states_near(const Graph& graph, const Rectangle& r) const {
    using enum csg::Membership;
    const UnitSurface::Vector near = points_near(graph, r);
    States states(surfaces_.size() + 2, Unknown);
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
      if (k == own_) {
        states[k] = In;
        continue;
      }
      const CertifiedDouble range = surfaces_[k].range_near(near);
      states[k] = is_positive(range) ? Out : is_negative(range) ? In : Unknown;
    }
    if (graph.lower() >= -1 || (stays_.above_bottom && graph.lower() > -3)) states[bottom()] = In;
    if (graph.upper() <= 1 || (stays_.below_top && graph.upper() < 3)) states[top()] = In;
    return states;
  }

  csg::Membership truth(const States& states, csg::Membership own) const {
    return csg::membership_of(cell_->tree, [&](const Literal& literal) {
      const csg::Membership state = literal.surface == own_ ? own : states[literal.surface];
      return domain::detail::complement_if(literal.is_complemented, state);
    });
  }
  // Is the graph boundary?
  csg::Membership is_boundary(const States& states) const {
    using enum csg::Membership;
    if (states[bottom()] == Out || states[top()] == Out) return Out;
    const csg::Membership inside = truth(states, In);
    const csg::Membership outside = truth(states, Out);
    if (inside == Unknown || outside == Unknown) return Unknown;
    if (inside == outside) return Out;
    return states[bottom()] == In && states[top()] == In ? In : Unknown;
  }

  // The function whose sign is a state: negative where it is In. Coefficients at the points given;
  // `near`: those of the whole graph, if these are meant.
  Series condition(std::size_t k, const std::array<CertifiedDouble, 2>& at, const Series& height,
                   const UnitSurface::Vector* near, std::size_t degree) const {
    if (k >= bottom()) {
      const CertifiedDouble sign = exactly(k == bottom() ? -1 : 1);
      Series result = scaled(sign, height, degree);
      result[0][0] = result[0][0] + exactly(-1);
      return result;
    }
    return surfaces_[k].on_graph(at, height, near, degree);
  }

  CertifiedDouble boundary(const Graph& graph, const Rectangle& r) const {
    States states = states_near(graph, r);
    csg::Membership all = is_boundary(states);
    if (all == csg::Membership::Out) return {};
    constexpr std::size_t n = series_order;
    const Series height = graph.series_at_centre(n - 1);
    const Series height_anywhere = graph.series_anywhere(n);
    std::vector<Condition> conditions;
    if (all == csg::Membership::Unknown) {
      conditions = open_conditions(graph, r, height, height_anywhere, states);
      all = is_boundary(states);
      if (all == csg::Membership::Out) return {};
    }
    const Series density = metric_.density(height, n - 2);
    const Series density_anywhere = metric_.density(height_anywhere, n - 1);
    if (all == csg::Membership::Unknown) {
      const auto part = of_strips(SquareModel(density, density_anywhere, n - 1, r),
                                  std::move(conditions), states);
      if (part) return *part * exactly(r.a) * exactly(r.b);
    }
    const CertifiedDouble whole = detail::integral(r, density, density_anywhere, n - 1);
    return all == csg::Membership::In ? whole : up_to(whole);
  }

  // A condition that is not the same in all of the rectangle.
  struct Condition {
    std::size_t index;
    SquareModel d;
    CertifiedDouble along_s;  // the derivatives, anywhere
    CertifiedDouble along_t;
  };

  // The states of the others are set.
  std::vector<Condition> open_conditions(const Graph& graph, const Rectangle& r,
                                         const Series& height, const Series& height_anywhere,
                                         States& states) const {
    constexpr std::size_t n = series_order;
    const UnitSurface::Vector near = points_near(graph, r);
    std::vector<Condition> result;
    for (std::size_t k = 0; k < states.size(); ++k) {
      if (states[k] != csg::Membership::Unknown) continue;
      const Series at_centre = condition(k, {exactly(r.s), exactly(r.t)}, height, nullptr, n - 1);
      const Series anywhere = condition(k, {near[0], near[1]}, height_anywhere, &near, n);
      SquareModel d(at_centre, anywhere, n, r);
      states[k] = d.membership();
      if (states[k] != csg::Membership::Unknown) continue;
      result.push_back(
          {k, std::move(d), anywhere[1][0] * exactly(r.a), anywhere[0][1] * exactly(r.b)});
    }
    return result;
  }

  // nullopt: no curve is known.
  std::optional<CertifiedDouble> of_strips(const SquareModel& density,
                                           std::vector<Condition> conditions,
                                           States& states) const {
    double steepness_s = HUGE_VAL;
    double steepness_t = HUGE_VAL;
    for (const Condition& c : conditions) {
      const double sum = magnitude(c.along_s) + magnitude(c.along_t);
      steepness_s = std::min(steepness_s, (std::abs(c.along_s.value) - c.along_s.error) / sum);
      steepness_t = std::min(steepness_t, (std::abs(c.along_t.value) - c.along_t.error) / sum);
    }
    const bool is_transposed = steepness_s > steepness_t;
    std::vector<Curve> curves;
    std::vector<std::size_t> indices;
    for (const Condition& c : conditions) {
      const auto curve =
          is_transposed ? curve_of(c.d.transposed(), c.along_s) : curve_of(c.d, c.along_t);
      if (!curve) continue;  // stays unknown
      curves.push_back(*curve);
      indices.push_back(c.index);
    }
    if (curves.empty()) return std::nullopt;
    const SquareModel density_in_order = is_transposed ? density.transposed() : density;
    return integral_over_strips(density_in_order, curves, [&](const std::vector<bool>& above) {
      for (std::size_t k = 0; k < curves.size(); ++k) {
        const bool is_positive_there = above[k] == curves[k].is_rising;
        states[indices[k]] = is_positive_there ? csg::Membership::Out : csg::Membership::In;
      }
      return is_boundary(states);
    });
  }

  std::shared_ptr<const Cell> cell_;
  std::size_t own_;
  std::vector<UnitSurface> surfaces_;  // the last coordinate is the height, along which own_ rises
  Stays stays_;
  GraphArea metric_;
  CertifiedDouble scale_;
};

}  // namespace exactcsg::measure::detail
