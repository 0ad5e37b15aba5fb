// SPDX-License-Identifier: GPL-3.0-or-later
// Decomposition trees as text. Expected values: the grammar of docs/format.md by hand, and the law
// that reading undoes writing.
#include "exactcsg/gdt/text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "csg/random_tree.hpp"
#include "exactcsg/csg/text.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/multi_resolution.hpp"
#include "exactcsg/gdt/traverse.hpp"
#include "gdt/random_divisions.hpp"

namespace exactcsg::gdt {
namespace {

using test::below;
using test::cube;
using test::random_cuts;
using test::random_orthants;

const auto put_int = [](TextWriter& out, int i) { out.write(i); };
const auto get_int = [](TextReader& in) { return in.number<int>(); };
const auto put_cut = [](TextWriter& out, const Cut<int>& cut) {
  out.write(cut.axis);
  out.separate();
  out.write(cut.at);
};
const auto get_cut = [](TextReader& in) {
  const auto axis = in.number<std::size_t>("an axis");
  return Cut<int>{axis, in.number<int>()};
};

// The least that terminals and the user's functions may be.
using MoveOnly = std::unique_ptr<int>;
struct PutMoveOnly {
  std::string operator()(const MoveOnly& value) { return std::to_string(*value); }
};
struct GetMoveOnly {
  MoveOnly operator()(TextReader& in) { return std::make_unique<int>(in.number<int>()); }
};
static_assert(PutsText<PutMoveOnly, MoveOnly> && GetsText<GetMoveOnly>);
static_assert(std::same_as<decltype(from_text("", GetMoveOnly{})), Tree<MoveOnly>>);
static_assert(std::same_as<decltype(from_text("", get_int, SameForLabels{})), Tree<int, int>>);
static_assert(std::same_as<decltype(from_text("", get_int, get_cut)), Tree<int, Cut<int>>>);

TEST(GdtText, OfAnyDegree) {
  using T = Tree<int>;
  const auto t = T::terminal;
  const T tree =
      T::interior({t(1), T::interior({}), T::interior({t(2), T::interior({t(3)})}), t(-4)});
  EXPECT_EQ(to_text(tree, put_int), "[1 [] [2 [3]] -4]");
  EXPECT_EQ(from_text("[1 [] [2 [3]] -4]", get_int), tree);
  EXPECT_EQ(from_text(" [ 1[ ]\n[2[3]]# a comment [\n-4 ] ", get_int), tree);
  EXPECT_EQ(from_text("7", get_int), t(7));
  EXPECT_EQ(to_text(from_text("[5 [6]]", GetMoveOnly{}), PutMoveOnly{}), "[5 [6]]");
}

TEST(GdtText, LabelsComeFirst) {
  using T = Tree<int, Cut<int>>;
  const auto t = T::terminal;
  const T tree = T::interior({t(1), T::interior({t(2), t(3)}, {1, 5})}, {0, 9});
  EXPECT_EQ(to_text(tree, put_int, put_cut), "[0 9 1 [1 5 2 3]]");
  EXPECT_EQ(from_text("[0 9 1 [1 5 2 3]]", get_int, get_cut), tree);
}

std::string error_of(std::string_view text) {
  try {
    from_text(text, get_int);
  } catch (const Error& error) {
    const auto& position = error.details().position;
    return std::string(describe(error.id()).code) + " " + std::to_string(position->line) + ":" +
           std::to_string(position->column) + " " + error.details().found;
  }
  return "";
}

// Line and column counted by hand.
TEST(GdtText, ErrorsSayWhere) {
  EXPECT_EQ(error_of(""), "E0102 1:1 the end of the text");
  EXPECT_EQ(error_of("[1\n 2"), "E0102 2:3 the end of the text");
  EXPECT_EQ(error_of("]"), "E0101 1:1 ']'");
  EXPECT_EQ(error_of("[1 2]\n]"), "E0101 2:1 ']'");
  EXPECT_EQ(error_of("[1\n[2 x]]"), "E0101 2:4 'x'");
  EXPECT_EQ(error_of("[1 (2)]"), "E0101 1:4 '('");
  EXPECT_EQ(error_of("[1 2)"), "E0101 1:5 ')'");
}

TEST(GdtText, RefusesAmbiguousText) {
  for (const char* text : {"", " a", "[a", "]", ")", "#"}) {
    EXPECT_THROW(to_text(Tree<int>::terminal(1), [&](int) { return text; }), Error) << text;
  }
}

// LAW gdt.text.1: octrees, k-d trees with labels.
RC_GTEST_PROP(GdtTextProperty, ReadingUndoesWriting, ()) {
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  const auto octree = random_orthants<3>(random, *rc::gen::inRange(0, 5), 1000);
  RC_ASSERT(from_text(to_text(octree, put_int), get_int) == octree);
  const auto cuts = random_cuts(random, cube<3>(64), *rc::gen::inRange(0, 10), 1000);
  RC_ASSERT(from_text(to_text(cuts, put_int, put_cut), get_int, get_cut) == cuts);
}

// LAW gdt.text.1: nodes of any degree, 0 too, with geometry everywhere.
Tree<int, int> random_multi_resolution(std::mt19937& random, int depth) {
  using T = Tree<int, int>;
  if (depth == 0 || below(random, 4) == 0) return T::terminal(below(random, 100));
  std::vector<T> children;
  for (int i = below(random, 5); i > 0; --i) {
    children.push_back(random_multi_resolution(random, depth - 1));
  }
  return T::interior(std::move(children), -below(random, 100));
}
RC_GTEST_PROP(GdtTextProperty, MultiResolutionTrees, ()) {
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  const auto tree = random_multi_resolution(random, *rc::gen::inRange(0, 8));
  RC_ASSERT(from_text(to_text(tree, put_int), get_int, SameForLabels{}) == tree);
}

// Nested, as the models of section 3.4 of the source: cells that hold CSG trees.
RC_GTEST_PROP(GdtTextProperty, CellsThatHoldCsgTrees, ()) {
  using csg::test::TestTree;
  using Model = Tree<std::pair<int, TestTree>>;
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  const auto places = random_orthants<2>(random, 3, 100);
  const Model model =
      map(places, [&](int i) { return std::pair(i, csg::test::random_tree(random, 4, 50)); });
  const auto put_cell = [](TextWriter& out, const auto& cell) {
    out.write(cell.first);
    csg::put(out, cell.second, put_int);
  };
  const auto get_cell = [](TextReader& in) {
    const int place = in.number<int>();
    return std::pair(place, csg::get(in, get_int));
  };
  RC_ASSERT(from_text(to_text(model, put_cell), get_cell) == model);
  const auto solids = map(model, [](const auto& cell) { return cell.second; });
  const auto text =
      to_text(solids, [](TextWriter& out, const TestTree& s) { csg::put(out, s, put_int); });
  RC_ASSERT(from_text(text, [](TextReader& in) { return csg::get(in, get_int); }) == solids);
}

// And the other way round: primitives that are decomposition trees, in brackets of the user's own.
TEST(GdtText, PrimitivesThatHoldDecompositionTrees) {
  using Solid = csg::BooleanTree<Tree<int>>;
  const auto quadtree = from_text("[1 0 [0 0 1 1] 1]", get_int);
  const Solid solid = csg::subtract(Solid::primitive(quadtree), Solid::full());
  const auto text = csg::to_text(solid, [](TextWriter& out, const Tree<int>& tree) {
    out.write("grid");
    put(out, tree, put_int);
  });
  EXPECT_EQ(text, "(- grid [1 0 [0 0 1 1] 1] full)");
  const auto read = csg::from_text(text, [](TextReader& in) {
    if (!in.take("grid")) in.unexpected("a grid");
    return get(in, get_int);
  });
  EXPECT_EQ(read, solid);
}

TEST(GdtText, TheExamplesOfTheFormat) {
  const auto get_plane = [](TextReader& in) {
    std::array<int, 4> plane;
    for (int& coefficient : plane) coefficient = in.number<int>();
    return plane;
  };
  const auto solid = csg::from_text("(- full (+ 0 0 1 5  1 0 0 3)) # a comment", get_plane);
  EXPECT_EQ(solid.children()[1].children()[1].primitive(), (std::array{1, 0, 0, 3}));
  EXPECT_EQ(from_text("[1 [0 0 1 1] 0 1]", get_int).terminals().size(), 7U);
  const auto tree = from_text("[0 2 7 [1 5 8 9]]", get_int, get_cut);
  EXPECT_EQ(tree.root().child(1).label(), (Cut<int>{1, 5}));
  const auto cells = from_text("[full (- full 3) [3 (& 3 4) empty 4]]",
                               [](TextReader& in) { return csg::get(in, get_int); });
  EXPECT_TRUE(cells.root().child(2).child(2).terminal().is_empty());
}

// A thousand levels as the source's section 3.3 would have them, and a million.
TEST(GdtText, DeepTrees) {
  for (const int n : {1000, 1'000'000}) {
    const auto tree = create(
        std::pair(0, n), [](const auto& p) { return p.second - p.first == 1; },
        [](const auto& p) {
          return std::array{std::pair(p.first, p.first + 1), std::pair(p.first + 1, p.second)};
        },
        [](const auto& p) { return p.first; });
    ASSERT_EQ(tree.terminals().size(), static_cast<std::size_t>(n));
    EXPECT_EQ(
        traverse(
            tree, [](int) { return 1; }, [](std::span<int> parts) { return parts[0] + parts[1]; }),
        n);
    EXPECT_TRUE(from_text(to_text(tree, put_int), get_int) == tree);
  }
}

}  // namespace
}  // namespace exactcsg::gdt
