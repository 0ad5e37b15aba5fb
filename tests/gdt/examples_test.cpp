// SPDX-License-Identifier: GPL-3.0-or-later
// The examples of docs/operators.md. Expected values follow from the definitions of the sets.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/text.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/overlay.hpp"
#include "exactcsg/gdt/path.hpp"
#include "exactcsg/gdt/ray_walk.hpp"
#include "exactcsg/gdt/text.hpp"
#include "exactcsg/gdt/traverse.hpp"
#include "exactcsg/number/exact.hpp"

namespace exactcsg {
namespace {

struct Interval {
  double from, to;
  friend bool operator==(const Interval&, const Interval&) = default;
};
using Solid = csg::Tree<Interval, csg::BooleanOperator>;
const Solid solid = csg::subtract(Solid::primitive({0, 10}), Solid::primitive({3, 4}));

TEST(Examples, ClassifyAPoint) {
  const auto inside = [](const Interval& i, double x) {
    return i.from <= x && x <= i.to ? csg::Membership::In : csg::Membership::Out;
  };
  const auto class_of = [&](double x) {
    return csg::traverse(solid, x, inside, csg::combine,
                         csg::FullEmptyResult{csg::Membership::In, csg::Membership::Out},
                         csg::absorbs);
  };
  EXPECT_EQ(class_of(3.5), csg::Membership::Out);
  EXPECT_EQ(class_of(5), csg::Membership::In);
  EXPECT_EQ(class_of(11), csg::Membership::Out);
}

TEST(Examples, LocaliseASolid) {
  const auto in_region = [](const Interval& i) {  // the region [5, 6]
    if (i.to < 5 || 6 < i.from) return csg::Membership::Out;
    return i.from <= 5 && 6 <= i.to ? csg::Membership::In : csg::Membership::Unknown;
  };
  EXPECT_TRUE(csg::prune(solid, in_region).is_full());
}

TEST(Examples, PruneInAnInnerLoop) {
  using Flat = csg::FlatTree<std::uint32_t, csg::BooleanOperator>;
  std::uint32_t count = 0;
  const Flat flat = csg::flatten(solid, [&](const Interval&) { return count++; });
  std::vector<csg::Membership> known(count, csg::Membership::Unknown);
  known[1] = csg::Membership::Out;
  Flat local;
  csg::PruneScratch<Flat> scratch;
  csg::prune_into(
      flat, [&](std::uint32_t p) { return known[p]; }, local, scratch);
  ASSERT_TRUE(local.is_primitive());
  EXPECT_EQ(local.primitive(), 0U);
}

TEST(Examples, DivideAndConquer) {
  using Numbers = std::vector<int>;
  const auto sorted = skeleton::divacon(
      Numbers{3, 1, 2}, [](const Numbers& n) { return n.size() <= 1; },
      [](const Numbers& n) {
        const auto middle = n.begin() + static_cast<std::ptrdiff_t>(n.size() / 2);
        return std::array{Numbers(n.begin(), middle), Numbers(middle, n.end())};
      },
      [](Numbers&& n) { return std::move(n); },
      [](std::span<Numbers> halves) {
        Numbers all(halves[0].size() + halves[1].size());
        std::ranges::merge(halves[0], halves[1], all.begin());
        return all;
      },
      skeleton::ParallelExecutor<>(2));
  EXPECT_EQ(sorted, (Numbers{1, 2, 3}));
}

TEST(Examples, KeepADivision) {
  struct Cell {
    int from, to, cut = 0;
  };
  const auto tree = gdt::create(
      Cell{0, 100}, [](const Cell& c) { return c.to - c.from == 1; },
      [](Cell& c) {
        c.cut = (c.from + c.to) / 2;
        return std::array{Cell{c.from, c.cut}, Cell{c.cut, c.to}};
      },
      [](const Cell& c) { return c.from; }, gdt::unlimited_depth, skeleton::SequentialExecutor{},
      [](const Cell& c) { return c.cut; });
  EXPECT_EQ(gdt::descend(tree, [](int cut) { return 42 < cut ? 0 : 1; }), 42);
}

TEST(Examples, FollowAPathAndCombineTwoDivisions) {
  using Quadtree = gdt::Tree<int>;  // 1: full, 0: empty
  const auto t = Quadtree::terminal;
  const Quadtree left = Quadtree::interior({t(1), t(0), t(1), t(0)});
  const Quadtree right =
      Quadtree::interior({t(0), Quadtree::interior({t(1), t(1), t(1), t(1)}), t(0), t(1)});

  const gdt::Cell<int, 2> square{{0, 0}, {4, 4}};
  const auto path = gdt::locate(right, square, gdt::Orthants{}, std::array{3, 1});
  EXPECT_EQ(path.cell(), (gdt::Cell<int, 2>{{3, 1}, {4, 2}}));
  EXPECT_EQ(path.depth(), 2U);
  int found = 0;
  gdt::neighbours(path, 1, gdt::Side::Upper, [&](int, const gdt::Cell<int, 2>& cell) {
    ++found;
    EXPECT_EQ(cell, (gdt::Cell<int, 2>{{2, 2}, {4, 4}}));
  });
  EXPECT_EQ(found, 1);
  const gdt::Ray<Rational, 2> diagonal{{-1, -1}, {1, 1}};
  Rational entry;
  EXPECT_TRUE(gdt::walk_ray(right, square, gdt::Orthants{}, diagonal,
                            [&](int full, const auto&, const gdt::RayPart<Rational>& part) {
                              entry = part.begin;
                              return full == 1;
                            }));
  EXPECT_EQ(entry, 3);

  const auto full_early = [](const int* a, const int* b) {
    return (a && *a) || (b && *b) ? std::optional(1) : std::nullopt;
  };
  const auto united = gdt::merge_equal(gdt::overlay(left, right, std::bit_or<int>(), full_early));
  EXPECT_EQ(united, t(1));

  const gdt::Cell<int, 2> space{{0, 0}, {4, 4}};
  using KdTree = gdt::Tree<int, gdt::Cut<int>>;
  const KdTree band = KdTree::interior({KdTree::terminal(5), KdTree::terminal(7)}, {1, 3});
  const auto sum = gdt::overlay_cuts(gdt::to_cuts(left, space), band, space, std::plus<int>());
  const auto values = std::vector(sum.terminals().begin(), sum.terminals().end());
  // Below y = 2 only the 5; above, both parts of each half.
  EXPECT_EQ(values, (std::vector{6, 5, 6, 8, 5, 7}));
}

TEST(Examples, WriteAndRead) {
  const auto put = [](TextWriter& out, const Interval& i) {
    out.write(i.from);
    out.separate();
    out.write(i.to);
  };
  const auto get = [](TextReader& in) {
    const auto from = in.number<double>();
    return Interval{from, in.number<double>()};
  };
  EXPECT_EQ(csg::to_text(solid, put), "(- 0 10 3 4)");
  EXPECT_TRUE(csg::from_text("(- 0 10 3 4)", get) == solid);
  const auto cells = gdt::from_text("[full [(- 0 10 3 4) empty]]",
                                    [&](TextReader& in) { return csg::get(in, get); });
  EXPECT_EQ(gdt::to_text(cells, [&](TextWriter& out, const Solid& s) { csg::put(out, s, put); }),
            "[full [(- 0 10 3 4) empty]]");
}

}  // namespace
}  // namespace exactcsg
