// SPDX-License-Identifier: GPL-3.0-or-later
// The examples of docs/operators.md for CSG trees and skeletons. Expected values follow from the
// definitions of the sets.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exactcsg/csg/attributed.hpp"
#include "exactcsg/csg/batch.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/reduce.hpp"
#include "exactcsg/csg/set_skeleton.hpp"
#include "exactcsg/csg/views.hpp"
#include "exactcsg/skeleton/progress_executor.hpp"
#include "exactcsg/skeleton/simulated_executor.hpp"

namespace exactcsg {
namespace {

struct Interval {
  double from, to;
};
using Solid = csg::Tree<Interval, csg::BooleanOperator>;
const Solid solid = csg::subtract(Solid::primitive({0, 10}), Solid::primitive({3, 4}));
constexpr auto inside = [](const Interval& i, double x) {
  return i.from <= x && x <= i.to ? csg::Membership::In : csg::Membership::Out;
};
const csg::FullEmptyResult constants{csg::Membership::In, csg::Membership::Out};

// The six signatures of figure 1 of the source, by one operator.
TEST(Examples, TheSixSignatures) {
  const auto size = [](const Interval& i) { return i.to - i.from; };
  const auto far = [](const Interval& i, double x) { return x - i.to; };
  const auto add = [](double a, csg::BooleanOperator, double b) { return a + b; };
  EXPECT_EQ(csg::traverse(solid, size, add), 11);
  EXPECT_EQ(csg::traverse(csg::complement(solid), size, add, csg::FullResult{100.0}), 111);
  EXPECT_EQ(
      csg::traverse(csg::unite(solid, Solid::empty()), size, add, csg::FullEmptyResult{100.0, 5.0}),
      16);
  EXPECT_EQ(csg::traverse(solid, 20.0, far, add), 26);
  EXPECT_EQ(csg::traverse(csg::complement(solid), 20.0, far, add, csg::FullResult{100.0}), 126);
  EXPECT_EQ(csg::traverse(csg::unite(solid, Solid::empty()), 20.0, far, add,
                          csg::FullEmptyResult{100.0, 5.0}),
            31);
}

TEST(Examples, ClassifyManyPoints) {
  const std::vector points{3.5, 5.0, 11.0};
  const auto classes =
      csg::traverse_batch(solid, points, inside, csg::combine, constants, csg::absorbs);
  EXPECT_EQ(classes,
            (std::vector{csg::Membership::Out, csg::Membership::In, csg::Membership::Out}));
}

TEST(Examples, BoundingBoxes) {
  const auto bound = [](const Interval& a, csg::BooleanOperator op, const Interval& b) {
    switch (op) {
      case csg::BooleanOperator::Intersection:
        return Interval{std::max(a.from, b.from), std::min(a.to, b.to)};
      case csg::BooleanOperator::Difference:
        return a;
      default:
        return Interval{std::min(a.from, b.from), std::max(a.to, b.to)};
    }
  };
  const auto boxes = csg::attribute(solid, std::identity{}, bound);
  EXPECT_EQ(csg::attribute_of(boxes).to, 10);
  const auto outside_box = [](const Interval& box, double x) {
    return x < box.from || box.to < x ? std::optional(csg::Membership::Out) : std::nullopt;
  };
  EXPECT_EQ(csg::traverse(boxes, 11.0, csg::CutOff{inside, outside_box}, csg::combine),
            csg::Membership::Out);
}

TEST(Examples, TheSkeletonInParallel) {
  const csg::SetAlgebra sets{std::logical_and<bool>(), std::logical_or<bool>(), true, false,
                             std::logical_not<bool>()};
  const auto contains = [](const Interval& i, double x) { return i.from <= x && x <= i.to; };
  EXPECT_TRUE(csg::set_skeleton(solid, 5.0, contains, sets, skeleton::ParallelExecutor<>(2)));
}

TEST(Examples, ReduceToTheDepth) {
  const auto depth = csg::reduce(
      solid, [](const Interval&) { return 0; },
      [](csg::BooleanOperator, std::span<int> below) { return 1 + std::ranges::max(below); });
  EXPECT_EQ(depth, 1);
}

TEST(Examples, BinaryAndWide) {
  const Solid a = Solid::primitive({0, 1});
  const Solid chain = csg::unite(csg::unite(csg::unite(a, a), a), a);
  const Solid wide = csg::merge_nested(csg::to_tree(chain));
  EXPECT_EQ(wide.children().size(), 4U);
  EXPECT_EQ(csg::to_tree(csg::BinaryView(wide)).children().size(), 2U);
  EXPECT_TRUE(csg::simplify(csg::subtract(Solid::full(), Solid::empty())).is_full());
}

struct Range {
  int from, to;
};

// The sum of 0 .. 63: 127 problems, 63 of them combined; six divisions, a leaf and six sums in a
// row.
TEST(Examples, ExpandEndsTheLeafSolveProblem) {
  using Step = skeleton::Expansion<int, std::array<Range, 2>>;
  const auto expand = [](const Range& r) -> Step {
    const int middle = (r.from + r.to) / 2;
    if (middle == r.from) return skeleton::Solved{middle};
    return skeleton::Divided{std::array{Range{r.from, middle}, Range{middle, r.to}}};
  };
  const auto sum = [](std::span<int> halves) { return halves[0] + halves[1]; };
  EXPECT_EQ(skeleton::divacon(Range{0, 64}, expand, sum), 64 * 63 / 2);

  skeleton::TaskGraph graph;
  skeleton::divacon(Range{0, 64}, expand, sum,
                    skeleton::SimulatedExecutor(graph, skeleton::CallCount{}));
  EXPECT_EQ(graph.work(), 190U);
  EXPECT_EQ(graph.span(), 13U);
  EXPECT_GT(skeleton::schedule(graph, 4).speed_up(), 3.0);

  Progress progress;  // another thread may read it, and cancel
  skeleton::divacon(Range{0, 64}, expand, sum,
                    skeleton::ProgressExecutor(skeleton::ParallelExecutor<>(2), progress, "sum"));
  EXPECT_EQ(progress.done(), progress.total());
}

TEST(Examples, AnEarlyOut) {
  const std::vector<int> numbers{4, 8, 15, 16, 23, 42};
  int asked = 0;
  const bool any_odd = skeleton::divacon(
      std::span(numbers), [](const auto& n) { return n.size() == 1; },
      [](const auto& n) {
        return std::array{n.first(n.size() / 2), n.subspan(n.size() / 2)};
      },
      [&](const auto& n) {
        ++asked;
        return n[0] % 2 == 1;
      },
      skeleton::EarlyOut{[](std::span<bool> found) { return found.back(); }, std::identity{}});
  EXPECT_TRUE(any_odd);
  EXPECT_EQ(asked, 3);  // 4, 8, 15
}

}  // namespace
}  // namespace exactcsg
