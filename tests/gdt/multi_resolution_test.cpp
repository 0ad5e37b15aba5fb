// SPDX-License-Identifier: GPL-3.0-or-later
// Maps and multi-resolution trees. Expected values by hand, or by the laws against create and
// traverse.
#include "exactcsg/gdt/multi_resolution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace exactcsg::gdt {
namespace {

using skeleton::ParallelExecutor;
using skeleton::SequentialExecutor;

using Labelled = Tree<int, std::string>;

// LAW gdt.3
TEST(Map, KeepsTheShapeAndCallsFromLeftToRight) {
  const Labelled tree = Labelled::interior(
      {Labelled::terminal(1),
       Labelled::interior({Labelled::terminal(2), Labelled::interior({}, "c")}, "b"),
       Labelled::terminal(3)},
      "a");
  std::vector<int> order;
  const auto mapped = map(
      tree,
      [&](int i) {
        order.push_back(i);
        return std::make_unique<int>(10 * i);
      },
      [](const std::string& s) { return s + s; });
  EXPECT_EQ(order, (std::vector{1, 2, 3}));
  EXPECT_EQ(mapped.root().label(), "aa");
  EXPECT_EQ(*mapped.root().child(1).child(0).terminal(), 20);
  EXPECT_EQ(mapped.root().child(1).child(1).label(), "cc");
  EXPECT_EQ(map(tree, [](int i) { return i; }), tree);
  // Labels kept, and labels forgotten.
  EXPECT_EQ(map(tree, [](int i) { return i; }).root().child(1).label(), "b");
  const Tree<int> bare = map(
      tree, [](int i) { return i; }, [](const std::string&) { return NoLabel{}; });
  EXPECT_EQ(bare.node_count(), tree.node_count());
  EXPECT_EQ(map(bare, [](int i) { return i; }), bare);
}

// A digitised curve: heights at 0 .. 2^k; a node knows the band that its part lies in.
struct Band {
  int from, to, lowest, highest;
  int width() const { return highest - lowest; }
  friend bool operator==(const Band&, const Band&) = default;
};
int height(int x) { return (x * x) % 37 + x / 3; }

struct Stretch {
  int from, to;
};
Band band(const Stretch& s) {
  Band b{s.from, s.to, height(s.from), height(s.from)};
  for (int x = s.from; x <= s.to; ++x) {
    b.lowest = std::min(b.lowest, height(x));
    b.highest = std::max(b.highest, height(x));
  }
  return b;
}
bool short_enough(const Stretch& s) { return s.to - s.from <= 1; }
std::vector<Stretch> thirds(const Stretch& s) {
  const int third = (s.to - s.from + 2) / 3;
  std::vector<Stretch> parts;
  for (int from = s.from; from < s.to; from += third) {
    parts.push_back({from, std::min(from + third, s.to)});
  }
  return parts;
}
MultiResolutionTree<Band> bands() {
  return create_multi_resolution(Stretch{0, 100}, short_enough, thirds, band);
}

std::vector<Band> joined(std::span<std::vector<Band>> parts) {
  std::vector<Band> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}
std::vector<Band> one(const Band& b) { return {b}; }

// LAW multi.1
TEST(MultiResolution, GeometryAtEveryNode) {
  const auto tree = bands();
  EXPECT_EQ(map(
                tree, [](const Band& b) { return b; }, [](const Band&) { return NoLabel{}; }),
            create(Stretch{0, 100}, short_enough, thirds, band));
  std::vector<Tree<Band, Band>::Node> pending{tree.root()};
  std::size_t nodes = 0;
  while (!pending.empty()) {
    const auto node = pending.back();
    pending.pop_back();
    ++nodes;
    EXPECT_EQ(node.geometry(), band({node.geometry().from, node.geometry().to}));
    if (node.is_terminal()) continue;
    for (const auto child : node.children()) pending.push_back(child);
  }
  EXPECT_EQ(nodes, tree.node_count());
  EXPECT_EQ(
      create_multi_resolution(Stretch{0, 100}, short_enough, thirds, band, 2, ParallelExecutor<>(2))
          .terminals()
          .size(),
      9U);
}

// LAW multi.2: the bands cover the curve without gaps; each is thin enough or cannot be divided,
// and the one above it was not thin enough.
TEST(MultiResolution, TraversedToAnAccuracy) {
  const auto tree = bands();
  std::size_t before = 0;
  for (const int accuracy : {1000, 40, 20, 5, 0}) {
    const auto thin = [&](const Band& b) { return b.width() <= accuracy; };
    const auto found = traverse(tree, LeafTest{thin}, one, joined);
    int at = 0;
    for (const Band& b : found) {
      EXPECT_EQ(b.from, at);
      at = b.to;
      EXPECT_TRUE(b.width() <= accuracy || b.to - b.from == 1);
    }
    EXPECT_EQ(at, 100);
    EXPECT_GE(found.size(), before);
    before = found.size();
    const auto with_query = traverse(
        tree, accuracy, LeafTest{[](const Band& b, int a) { return b.width() <= a; }},
        [](const Band& b, int) { return one(b); }, joined, ParallelExecutor<>(2));
    EXPECT_EQ(with_query, found);
  }
  EXPECT_EQ(traverse(tree, LeafTest{[](const Band&) { return true; }}, one, joined).size(), 1U);
}

// LAW multi.3
TEST(MultiResolution, WithoutALeafItIsTheTraversal) {
  const auto tree = bands();
  const auto never = LeafTest{[](const Band&) { return false; }};
  EXPECT_EQ(traverse(tree, never, one, joined), traverse(tree, one, joined));
  const auto lowest = [](std::span<int> values, const Band& b) {
    const int low = *std::min_element(values.begin(), values.end());
    EXPECT_EQ(low, b.lowest);
    return low;
  };
  EXPECT_EQ(traverse(
                tree, never, [](const Band& b) { return b.lowest; }, lowest),
            tree.root().label().lowest);
}

}  // namespace
}  // namespace exactcsg::gdt
