// SPDX-License-Identifier: Apache-2.0
#pragma once

// A cell in which every surface left is the graph of a function over the same face of the cell: the
// volume of a set there is an integral over that face, which is divided instead of the cell.
// [Certified]
//
// Over a rectangle of the face, a vertical line passes the bottom, surfaces, and the top. Whether
// it is in the set is a truth function of what it has passed, so that the volume is the integral of
// the sum of (truth before - truth after) * height over all that is passed. Surfaces whose ranges
// of height over the rectangle are disjoint are passed in a known order: their heights are
// integrated (graph.hpp). Two whose ranges overlap are passed in the order of the sign of the
// difference D of their heights:
//   (T00 - T11) Z1 + (T11 - T10) D + (T10 + T01 - T00 - T11) max(0, D),  D = Z1 - Z2,
// T10 the truth when only the first has been passed; D has a linear model. For more than two,
// or surfaces that are no proved graphs, the truth is bounded on the slabs between the ranges'
// ends.
//
// LAW column.1  volume(rectangle) encloses the volume over the rectangle, in the unit of the cell's
//               coordinates, which run from -1 to 1.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/membership.hpp"
#include "exactcsg/measure/unit_quadric.hpp"

namespace exactcsg::measure::detail {

// In the set where the surface has been passed, or where it has not.
struct PassedLiteral {
  std::uint32_t surface = 0;
  bool is_in_when_passed = false;
};
using PassedTree = csg::FlatTree<PassedLiteral, csg::BooleanOperator>;

struct Bounds {
  double lower = 0;
  double upper = 0;
};

// The mean of max(0, d + p u + q v) over -1 <= u, v <= 1. REQUIRES p, q >= 0. Its error is below
// 2^-44 (|d| + p + q): all terms are positive, and errors in where the pieces meet are squared.
inline double mean_of_positive_part(double d, double p, double q) {
  if (p < q) std::swap(p, q);
  if (d >= p + q) return d;
  if (d <= -p - q) return 0;
  // Half the integral over u at one v.
  const auto inner = [&](double v) {
    const double m = d + q * v;
    if (m >= p) return m;
    return m <= -p ? 0.0 : (m + p) * (m + p) / (4 * p);
  };
  // It is a polynomial of degree at most two between these: Simpson's rule is exact.
  const double first = q > 0 ? std::clamp((-p - d) / q, -1.0, 1.0) : -1.0;
  const double second = q > 0 ? std::clamp((p - d) / q, -1.0, 1.0) : 1.0;
  const std::array<double, 4> ends{-1.0, first, second, 1.0};
  double integral = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = ends[i];
    const double to = ends[i + 1];
    if (!(from < to)) continue;
    integral += (to - from) / 6 * (inner(from) + 4 * inner(from / 2 + to / 2) + inner(to));
  }
  return integral / 2;
}

class Column {
 public:
  // REQUIRES each surface's derivative by the height is positive in the cell.
  Column(std::vector<UnitQuadric> surfaces, PassedTree tree)
      : surfaces_(std::move(surfaces)), tree_(std::move(tree)) {}

  // How much the heights vary over the rectangle along its first and its second side, roughly.
  std::array<double, 2> variations(const Rectangle& r) const {
    const UnitQuadric::Vector anywhere{CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b},
                                       CertifiedDouble{0, 1}};
    std::array<double, 2> result{};
    for (const UnitQuadric& f : surfaces_) {
      const double slope = magnitude(f.derivative(2, anywhere));
      result[0] += magnitude(f.derivative(0, anywhere)) / slope * r.a;
      result[1] += magnitude(f.derivative(1, anywhere)) / slope * r.b;
    }
    return result;
  }

  CertifiedDouble volume(const Rectangle& r) const {
    std::vector<Item> items{Item{bottom, -1, -1, {}}, Item{top, 1, 1, {}}};
    std::vector<State> states(surfaces_.size(), State::Unpassed);
    for (std::size_t i = 0; i < surfaces_.size(); ++i) add_item(i, r, items, states);
    std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
      return a.lower < b.lower || (a.lower == b.lower && a.upper < b.upper);
    });
    Situation situation{std::move(states), State::Unpassed, State::Unpassed};
    CertifiedDouble sum;
    for (std::size_t begin = 0; begin < items.size();) {
      std::size_t end = begin + 1;
      double upper = items[begin].upper;
      while (end < items.size() && items[end].lower < upper) {
        upper = std::max(upper, items[end++].upper);
      }
      sum = sum + cluster(&items[begin], end - begin, r, situation);
      begin = end;
    }
    return sum;
  }

 private:
  enum class State : unsigned char { Unpassed, Passed, Uncertain };
  static constexpr std::uint32_t bottom = 0xFFFFFFFE;
  static constexpr std::uint32_t top = 0xFFFFFFFF;

  struct Item {
    std::uint32_t surface;
    double lower;
    double upper;
    std::optional<Graph> graph;  // none of the bottom and the top, which are constant
    bool is_known() const { return graph || surface >= bottom; }
  };
  struct Situation {
    std::vector<State> surfaces;
    State bottom_state;
    State top_state;
    State& of(std::uint32_t surface) {
      return surface == bottom ? bottom_state : surface == top ? top_state : surfaces[surface];
    }
  };

  void add_item(std::size_t i, const Rectangle& r, std::vector<Item>& items,
                std::vector<State>& states) const {
    const UnitQuadric& f = surfaces_[i];
    if (is_positive(f.range_at(r, -1))) {
      states[i] = State::Passed;
      return;
    }
    if (is_negative(f.range_at(r, 1))) return;
    const auto surface = static_cast<std::uint32_t>(i);
    if (std::optional<Graph> graph = Graph::find(f, r)) {
      const double lower = graph->lower();
      const double upper = graph->upper();
      // The graph found is the surface of the cell only if one interval of heights where the
      // derivative is positive has both.
      if (lower <= 1 && upper >= -1) {
        items.push_back({surface, lower, upper, std::move(graph)});
        return;
      }
    }
    items.push_back({surface, lowest(f, r), highest(f, r), std::nullopt});
  }
  // Bounds of where the surface is in the cell, if it is.
  static double lowest(const UnitQuadric& f, const Rectangle& r) {
    double low = -1;
    double step = 1;
    for (int i = 0; i < 6; ++i, step /= 2) {
      if (is_negative(f.range_at(r, low + step))) low += step;
    }
    return low;
  }
  static double highest(const UnitQuadric& f, const Rectangle& r) {
    double high = 1;
    double step = 1;
    for (int i = 0; i < 6; ++i, step /= 2) {
      if (is_positive(f.range_at(r, high - step))) high -= step;
    }
    return high;
  }

  csg::Membership truth(const Situation& situation) const {
    using enum csg::Membership;
    if (situation.bottom_state == State::Unpassed || situation.top_state == State::Passed) {
      return Out;
    }
    const csg::Membership inside = csg::membership_of(tree_, [&](const PassedLiteral& literal) {
      const State state = situation.surfaces[literal.surface];
      if (state == State::Uncertain) return Unknown;
      return (state == State::Passed) == literal.is_in_when_passed ? In : Out;
    });
    const bool is_between =
        situation.bottom_state == State::Passed && situation.top_state == State::Unpassed;
    return is_between || inside == Out ? inside : Unknown;
  }
  int definite_truth(const Situation& situation) const {
    return truth(situation) == csg::Membership::In ? 1 : 0;
  }

  // The sum over items [first, first + count), which are then passed.
  CertifiedDouble cluster(const Item* first, std::size_t count, const Rectangle& r,
                          Situation& situation) const {
    if (count == 1 && first->is_known()) return single(*first, r, situation);
    if (count == 2 && first[0].is_known() && first[1].is_known()) {
      return pair(first[0], first[1], r, situation);
    }
    return slabs(first, count, r, situation);
  }

  CertifiedDouble single(const Item& item, const Rectangle& r, Situation& situation) const {
    const int before = definite_truth(situation);
    situation.of(item.surface) = State::Passed;
    const int after = definite_truth(situation);
    return weighted(before - after, item, r);
  }

  CertifiedDouble pair(const Item& one, const Item& two, const Rectangle& r,
                       Situation& situation) const {
    const int none = definite_truth(situation);
    situation.of(one.surface) = State::Passed;
    const int only_one = definite_truth(situation);
    situation.of(two.surface) = State::Passed;
    const int both = definite_truth(situation);
    situation.of(one.surface) = State::Unpassed;
    const int only_two = definite_truth(situation);
    situation.of(one.surface) = State::Passed;
    CertifiedDouble sum = weighted(none - only_one, one, r) + weighted(only_one - both, two, r);
    const int excess = only_one + only_two - none - both;
    if (excess == 0) return sum;
    return sum + exactly(excess) * positive_part(one, two, r);
  }

  static CertifiedDouble weighted(int factor, const Item& item, const Rectangle& r) {
    if (factor == 0) return {};
    if (item.graph) return exactly(factor) * item.graph->integral();
    return exactly(factor * item.lower * 4 * r.a) * exactly(r.b);
  }

  static LinearModel model(const Item& item) {
    if (item.graph) return item.graph->linear_model();
    return {exactly(item.lower), {}, {}, 0};
  }
  // The integral of max(0, Z1 - Z2).
  static CertifiedDouble positive_part(const Item& one, const Item& two, const Rectangle& r) {
    const LinearModel m1 = model(one);
    const LinearModel m2 = model(two);
    const CertifiedDouble d = m1.constant - m2.constant;
    const CertifiedDouble p = (m1.along_s - m2.along_s) * exactly(r.a);
    const CertifiedDouble q = (m1.along_t - m2.along_t) * exactly(r.b);
    // The mean grows at most as fast as d, and half as fast as p and as q.
    const double error = d.error + p.error + q.error + m1.remainder + m2.remainder;
    const double p_size = std::abs(p.value);
    const double q_size = std::abs(q.value);
    const double rounding = 0x1p-44 * (std::abs(d.value) + error + p_size + q_size) + 0x1p-1000;
    const double low = mean_of_positive_part(d.value - error, p_size, q_size) - rounding;
    const double high = mean_of_positive_part(d.value + error, p_size, q_size) + rounding;
    const double middle = low / 2 + high / 2;
    const CertifiedDouble mean{middle, std::max(high - middle, middle - low) * (1 + 0x1p-50)};
    return mean * exactly(4) * exactly(r.a) * exactly(r.b);
  }

  CertifiedDouble slabs(const Item* first, std::size_t count, const Rectangle& r,
                        Situation& situation) const {
    std::vector<double> heights;
    for (const Item* item = first; item != first + count; ++item) {
      heights.push_back(item->lower);
      heights.push_back(item->upper);
    }
    std::sort(heights.begin(), heights.end());
    const auto sum_of = [&](double height, int factor) {
      return exactly(factor) * exactly(height);
    };
    // As if the lowest height were passed into nothing, and the highest out of it.
    CertifiedDouble sum = sum_of(heights.front(), definite_truth(situation));
    for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
      const double from = heights[i];
      const double to = heights[i + 1];
      if (from == to) continue;
      for (const Item* item = first; item != first + count; ++item) {
        situation.of(item->surface) = item->upper <= from ? State::Passed
                                      : item->lower >= to ? State::Unpassed
                                                          : State::Uncertain;
      }
      const csg::Membership value = truth(situation);
      if (value == csg::Membership::Out) continue;
      const CertifiedDouble thickness = exactly(to) - exactly(from);
      if (value == csg::Membership::In) {
        sum = sum + thickness;
      } else {
        const CertifiedDouble half = exactly(0.5) * thickness;
        sum = sum + widened(half, magnitude(half));
      }
    }
    for (const Item* item = first; item != first + count; ++item) {
      situation.of(item->surface) = State::Passed;
    }
    sum = sum + sum_of(heights.back(), -definite_truth(situation));
    return sum * exactly(4) * exactly(r.a) * exactly(r.b);
  }

  std::vector<UnitQuadric> surfaces_;
  PassedTree tree_;
};

}  // namespace exactcsg::measure::detail
