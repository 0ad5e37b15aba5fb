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
// T10 the truth when only the first has been passed (positive_part.hpp). For more than two,
// or surfaces that are no proved graphs, the truth is bounded on the slabs between the ranges'
// ends.
//
// Integrals of a function over the set go the same way, with the function's antiderivative along
// the height in the place of the height, and its mean between the two heights as a factor of max(0,
// D).
//
// LAW column.1  integral(rectangle, quantity) encloses the quantity over the rectangle, in the unit
//               of the cell's coordinates, which run from -1 to 1.

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
#include "exactcsg/measure/positive_part.hpp"
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

// A height over a rectangle: that of a surface, or a constant.
struct Height {
  double lower;
  double upper;
  std::optional<Graph> graph;

  NearbyPolynomial polynomial() const {
    if (graph) return graph->polynomial();
    return {lower, nullptr, 0};
  }
  CertifiedDouble range() const { return between(lower, upper); }
};

// The volume, as a quantity of Column::integral.
struct VolumeQuantity {
  // Of everything below a height, in relation to the height 0.
  CertifiedDouble below(const Height& height, const Rectangle& r) const {
    if (height.graph) return height.graph->integral();
    return exactly(height.lower * 4 * r.a) * exactly(r.b);
  }
  // The factor of the integral of (one - two), where that is positive.
  CertifiedDouble mean_between(const Height&, const Height&, const Rectangle&) const {
    return exactly(1);
  }
  CertifiedDouble between_heights(double from, double to, const Rectangle& r) const {
    return (exactly(to) - exactly(from)) * exactly(4) * exactly(r.a) * exactly(r.b);
  }
  // Of any part of what is between the heights.
  CertifiedDouble part_between_heights(double from, double to, const Rectangle& r) const {
    return up_to(between_heights(from, to, r));
  }
};

class Column {
 public:
  // REQUIRES each surface's derivative by the height, the last coordinate, is positive in the cell.
  // `axis`: of the box, along which the height is; the others follow it in cyclic order.
  Column(std::size_t axis, std::vector<UnitSurface> surfaces, PassedTree tree)
      : axis_(axis), surfaces_(std::move(surfaces)), tree_(std::move(tree)) {}

  std::size_t axis() const { return axis_; }

  // How much the heights vary over the rectangle along its first and its second side, roughly.
  std::array<double, 2> variations(const Rectangle& r) const {
    const UnitSurface::Vector anywhere{CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b},
                                       CertifiedDouble{0, 1}};
    std::array<double, 2> result{};
    for (const UnitSurface& f : surfaces_) {
      const double slope = magnitude(f.derivative(2, anywhere));
      result[0] += magnitude(f.derivative(0, anywhere)) / slope * r.a;
      result[1] += magnitude(f.derivative(1, anywhere)) / slope * r.b;
    }
    return result;
  }

  CertifiedDouble volume(const Rectangle& r) const { return integral(r, VolumeQuantity()); }

  template <class Quantity>
  CertifiedDouble integral(const Rectangle& r, const Quantity& quantity) const {
    return sum_over_clusters(r, [&](const Item* first, std::size_t count, Situation& situation) {
      return cluster(first, count, r, situation, quantity);
    });
  }

 private:
  enum class State : unsigned char { Unpassed, Passed, Uncertain };
  static constexpr std::uint32_t bottom = 0xFFFFFFFE;
  static constexpr std::uint32_t top = 0xFFFFFFFF;

  struct Item {
    std::uint32_t surface;
    Height height;  // without graph of the bottom and the top, or where none is known
    bool is_known() const { return height.graph || surface >= bottom; }
  };
  struct Situation {
    std::vector<State> surfaces;
    State bottom_state;
    State top_state;
    State& of(std::uint32_t surface) {
      return surface == bottom ? bottom_state : surface == top ? top_state : surfaces[surface];
    }
  };

  // visit(first item, count, situation) -> a term, for items whose ranges of height overlap; they
  // are passed then.
  template <class Visit>
  CertifiedDouble sum_over_clusters(const Rectangle& r, Visit&& visit) const {
    std::vector<Item> items{Item{bottom, {-1, -1, {}}}, Item{top, {1, 1, {}}}};
    std::vector<State> states(surfaces_.size(), State::Unpassed);
    for (std::size_t i = 0; i < surfaces_.size(); ++i) add_item(i, r, items, states);
    std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
      return a.height.lower < b.height.lower ||
             (a.height.lower == b.height.lower && a.height.upper < b.height.upper);
    });
    Situation situation{std::move(states), State::Unpassed, State::Unpassed};
    CertifiedDouble sum;
    for (std::size_t begin = 0; begin < items.size();) {
      std::size_t end = begin + 1;
      double upper = items[begin].height.upper;
      while (end < items.size() && items[end].height.lower < upper) {
        upper = std::max(upper, items[end++].height.upper);
      }
      sum = sum + visit(&items[begin], end - begin, situation);
      begin = end;
    }
    return sum;
  }

  void add_item(std::size_t i, const Rectangle& r, std::vector<Item>& items,
                std::vector<State>& states) const {
    const UnitSurface& f = surfaces_[i];
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
        items.push_back({surface, {lower, upper, std::move(graph)}});
        return;
      }
    }
    items.push_back({surface, {lowest(f, r), highest(f, r), std::nullopt}});
  }
  // Bounds of where the surface is in the cell, if it is.
  static double lowest(const UnitSurface& f, const Rectangle& r) {
    double low = -1;
    double step = 1;
    for (int i = 0; i < 6; ++i, step /= 2) {
      if (is_negative(f.range_at(r, low + step))) low += step;
    }
    return low;
  }
  static double highest(const UnitSurface& f, const Rectangle& r) {
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

  // The truth when neither of two has been passed, one of them, or both; both are passed then.
  struct PairTruth {
    int none;
    int only_one;
    int only_two;
    int both;
  };
  PairTruth pass(const Item& one, const Item& two, Situation& situation) const {
    PairTruth result{};
    result.none = definite_truth(situation);
    situation.of(one.surface) = State::Passed;
    result.only_one = definite_truth(situation);
    situation.of(two.surface) = State::Passed;
    result.both = definite_truth(situation);
    situation.of(one.surface) = State::Unpassed;
    result.only_two = definite_truth(situation);
    situation.of(one.surface) = State::Passed;
    return result;
  }

  // The sum over items [first, first + count), which are then passed.
  template <class Quantity>
  CertifiedDouble cluster(const Item* first, std::size_t count, const Rectangle& r,
                          Situation& situation, const Quantity& quantity) const {
    const auto below = [&](int factor, const Item& item) {
      return factor == 0 ? CertifiedDouble{} : exactly(factor) * quantity.below(item.height, r);
    };
    if (count == 1 && first->is_known()) {
      const int before = definite_truth(situation);
      situation.of(first->surface) = State::Passed;
      return below(before - definite_truth(situation), *first);
    }
    if (count == 2 && first[0].is_known() && first[1].is_known()) {
      const PairTruth truth = pass(first[0], first[1], situation);
      const CertifiedDouble sum = below(truth.none - truth.only_one, first[0]) +
                                  below(truth.only_one - truth.both, first[1]);
      const int excess = truth.only_one + truth.only_two - truth.none - truth.both;
      if (excess == 0) return sum;
      return sum + exactly(excess) * quantity.mean_between(first[0].height, first[1].height, r) *
                       positive_part(first[0].height, first[1].height, r);
    }
    return slabs(first, count, r, situation, quantity);
  }

  // The integral of max(0, one - two).
  static CertifiedDouble positive_part(const Height& one, const Height& two, const Rectangle& r) {
    const NearbyPolynomial p = one.polynomial();
    const NearbyPolynomial q = two.polynomial();
    Graph::Polynomial difference;
    if (p.terms != nullptr) difference = *p.terms;
    if (q.terms != nullptr) difference.subtract(*q.terms);
    const double d = p.constant - q.constant;
    const double norms = difference.norm() + (q.terms != nullptr ? 2 * q.terms->norm() : 0);
    const double error = (p.error + q.error + 0x1p-52 * (std::abs(d) + norms)) * (1 + 0x1p-48);
    return mean_of_positive_part(d, difference, error) * exactly(4) * exactly(r.a) * exactly(r.b);
  }

  template <class Quantity>
  CertifiedDouble slabs(const Item* first, std::size_t count, const Rectangle& r,
                        Situation& situation, const Quantity& quantity) const {
    std::vector<double> heights;
    for (const Item* item = first; item != first + count; ++item) {
      heights.push_back(item->height.lower);
      heights.push_back(item->height.upper);
    }
    std::sort(heights.begin(), heights.end());
    const auto below = [&](double height, int factor) {
      return factor == 0 ? CertifiedDouble{}
                         : exactly(factor) * quantity.below({height, height, {}}, r);
    };
    // As if the lowest height were passed into nothing, and the highest out of it.
    CertifiedDouble sum = below(heights.front(), definite_truth(situation));
    for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
      const double from = heights[i];
      const double to = heights[i + 1];
      if (from == to) continue;
      for (const Item* item = first; item != first + count; ++item) {
        situation.of(item->surface) = item->height.upper <= from ? State::Passed
                                      : item->height.lower >= to ? State::Unpassed
                                                                 : State::Uncertain;
      }
      const csg::Membership value = truth(situation);
      if (value == csg::Membership::In) {
        sum = sum + quantity.between_heights(from, to, r);
      } else if (value == csg::Membership::Unknown) {
        sum = sum + quantity.part_between_heights(from, to, r);
      }
    }
    pass_all(first, count, situation);
    return sum + below(heights.back(), -definite_truth(situation));
  }

  static void pass_all(const Item* first, std::size_t count, Situation& situation) {
    for (const Item* item = first; item != first + count; ++item) {
      situation.of(item->surface) = State::Passed;
    }
  }

  std::size_t axis_;
  std::vector<UnitSurface> surfaces_;
  PassedTree tree_;
};

}  // namespace exactcsg::measure::detail
