// SPDX-License-Identifier: GPL-3.0-or-later
// One solid kept in every kind of division: quadtree and octree, bintree that halves the axes in
// turn, bintree that chooses the axis, and cuts in places of its own choice. The expected class of
// a point is that of the CSG tree, traversed for the point; the expected measure is the number of
// unit cells inside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <random>
#include <span>
#include <tuple>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/overlay.hpp"
#include "exactcsg/gdt/path.hpp"
#include "exactcsg/gdt/traverse.hpp"
#include "gdt/random_divisions.hpp"

namespace exactcsg::gdt {
namespace {

using csg::Membership;
using test::below;
using test::cube;
using test::for_each_point;

template <std::size_t d>
using Solid = csg::BooleanTree<Cell<int, d>>;

template <std::size_t d>
Solid<d> random_solid(std::mt19937& random, int size, int boxes) {
  Cell<int, d> box;
  for (std::size_t axis = 0; axis < d; ++axis) {
    const auto [from, to] = std::minmax({below(random, size + 1), below(random, size + 1)});
    box.lower[axis] = from;
    box.upper[axis] = to;
  }
  const auto solid = Solid<d>::primitive(box);
  if (boxes == 1) return solid;
  const auto op = static_cast<csg::BooleanOperator>(below(random, 4));
  return Solid<d>::compose(op, {random_solid<d>(random, size, boxes - 1), solid});
}

template <std::size_t d>
bool is_inside(const Solid<d>& solid, const Coordinates<int, d>& point) {
  const auto inside = [&](const Cell<int, d>& box) {
    return contains(box, point) ? Membership::In : Membership::Out;
  };
  return csg::traverse(solid, inside, csg::combine) == Membership::In;
}

template <std::size_t d>
Solid<d> localised(const Solid<d>& solid, const Cell<int, d>& cell) {
  return csg::prune(solid, [&](const Cell<int, d>& box) {
    bool covers = true;
    for (std::size_t axis = 0; axis < d; ++axis) {
      const int lower = std::max(box.lower[axis], cell.lower[axis]);
      const int upper = std::min(box.upper[axis], cell.upper[axis]);
      if (lower >= upper) return Membership::Out;
      covers = covers && lower == cell.lower[axis] && upper == cell.upper[axis];
    }
    return covers ? Membership::In : Membership::Unknown;
  });
}

// The data of create: the cell, and the solid as far as it matters there.
template <class C, std::size_t d, class N>
struct Task {
  C cell;
  Solid<d> solid;
  N label{};
};

// What is the same for all: choose_label(cell, solid) -> N, then the division makes the parts.
template <std::size_t d, class C, class Division, class ChooseLabel>
auto create_from(const Solid<d>& solid, const C& cell, const Division& division, std::size_t degree,
                 ChooseLabel&& choose_label) {
  using N = std::invoke_result_t<ChooseLabel&, const C&, const Solid<d>&>;
  using Data = Task<C, d, N>;
  return create(
      Data{cell, localised<d>(solid, cell)},
      [](const Data& t) { return t.solid.is_empty() || t.solid.is_full(); },
      [&](Data& t) {
        t.label = choose_label(t.cell, t.solid);
        std::vector<Data> parts;
        for (std::size_t i = 0; i < degree; ++i) {
          const C part = division(t.cell, t.label, i);
          parts.push_back({part, localised<d>(t.solid, part)});
        }
        return parts;
      },
      [](const Data& t) { return t.solid.is_full(); }, unlimited_depth,
      skeleton::SequentialExecutor{}, [](const Data& t) { return t.label; });
}

template <class T, class N, class C, class Division>
void expect_the_solid(const Tree<T, N>& tree, const C& cell, const Division& division,
                      const Solid<std::tuple_size_v<decltype(C::lower)>>& solid) {
  constexpr std::size_t d = std::tuple_size_v<decltype(C::lower)>;
  int expected_measure = 0;
  for_each_point<d>(cell.upper[0], [&](const Coordinates<int, d>& point) {
    const bool expected = is_inside<d>(solid, point);
    expected_measure += expected ? 1 : 0;
    ASSERT_EQ(locate(tree, cell, division, point).node().terminal(), expected);
  });
  int measure = 0;
  const auto all = [&](const C& from, const auto& node, auto&& receive) {
    for (std::size_t i = 0; i < node.degree(); ++i) {
      receive(i, division(from, node.label(), i));
    }
  };
  follow(tree, cell, all, [&](bool full, const C& c) {
    int volume = full ? 1 : 0;
    for (std::size_t axis = 0; axis < d; ++axis) volume *= c.upper[axis] - c.lower[axis];
    measure += volume;
  });
  EXPECT_EQ(measure, expected_measure);
}

template <std::size_t d>
struct TurningCell : Cell<int, d> {
  std::size_t axis = 0;
};
struct HalvesInTurn {
  template <std::size_t d>
  TurningCell<d> operator()(const TurningCell<d>& cell, NoLabel, std::size_t index) const {
    TurningCell<d> half = cell;
    const int middle = (cell.lower[cell.axis] + cell.upper[cell.axis]) / 2;
    (index == 0 ? half.upper : half.lower)[cell.axis] = middle;
    half.axis = (cell.axis + 1) % d;
    return half;
  }
};

const auto no_label = [](const auto&, const auto&) { return NoLabel{}; };

// Half of the longest side.
const auto longest_side = [](const auto& cell, const auto&) {
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < cell.lower.size(); ++axis) {
    const auto size = [&](std::size_t a) { return cell.upper[a] - cell.lower[a]; };
    if (size(axis) > size(longest)) longest = axis;
  }
  return Cut<int>{longest, (cell.lower[longest] + cell.upper[longest]) / 2};
};

// Where the first box that matters has a face inside the cell: no cut is wasted.
const auto along_a_face = [](const auto& cell, const auto& solid) {
  Cut<int> cut{0, 0};
  bool found = false;
  csg::for_each_primitive(solid, [&](const auto& box) {
    for (std::size_t axis = 0; axis < cell.lower.size(); ++axis) {
      for (const int at : {box.lower[axis], box.upper[axis]}) {
        if (found || at <= cell.lower[axis] || at >= cell.upper[axis]) continue;
        cut = {axis, at};
        found = true;
      }
    }
  });
  EXPECT_TRUE(found);
  return cut;
};

template <std::size_t d>
void expect_every_division(int size, int rounds) {
  std::mt19937 random(d);
  const auto cell = cube<d>(size);
  const TurningCell<d> turning{cell};
  for (int round = 0; round < rounds; ++round) {
    const auto solid = random_solid<d>(random, size, 6);
    const auto orthants = create_from<d>(solid, cell, Orthants{}, std::size_t{1} << d, no_label);
    expect_the_solid(orthants, cell, Orthants{}, solid);
    const auto in_turn = create_from<d>(solid, turning, HalvesInTurn{}, 2, no_label);
    expect_the_solid(in_turn, turning, HalvesInTurn{}, solid);
    const auto longest = create_from<d>(solid, cell, Cuts{}, 2, longest_side);
    expect_the_solid(longest, cell, Cuts{}, solid);
    const auto faces = create_from<d>(solid, cell, Cuts{}, 2, along_a_face);
    expect_the_solid(faces, cell, Cuts{}, solid);
    // However it is divided, it is the same solid.
    const auto differs = overlay_cuts(to_cuts(orthants, cell), faces, cell, std::not_equal_to<>());
    EXPECT_EQ(merge_equal(differs).node_count(), 1U);
    EXPECT_FALSE(differs.terminals()[0]);
    // And the Boolean operations of the divisions are those of the solids.
    const auto other = random_solid<d>(random, size, 4);
    const auto unequal = create_from<d>(other, cell, Cuts{}, 2, along_a_face);
    const auto both = [](bool a, bool b) { return a && !b; };
    expect_the_solid(overlay_cuts(longest, unequal, cell, both), cell, Cuts{},
                     csg::subtract(solid, other));
    const auto alike = create_from<d>(other, cell, Orthants{}, std::size_t{1} << d, no_label);
    expect_the_solid(overlay(orthants, alike, both), cell, Orthants{}, csg::subtract(solid, other));
  }
}

TEST(Divisions, OfTheLine) { expect_every_division<1>(64, 20); }
TEST(Divisions, OfThePlane) { expect_every_division<2>(32, 12); }
TEST(Divisions, OfSpace) { expect_every_division<3>(8, 12); }
TEST(Divisions, OfFourDimensions) { expect_every_division<4>(4, 6); }

}  // namespace
}  // namespace exactcsg::gdt
