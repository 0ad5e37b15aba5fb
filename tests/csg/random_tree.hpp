// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Random trees over numbered primitives, and what they mean, computed in the plainest way; and the
// functions that the tests hand to the operators on them.

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "exactcsg/csg/text.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"

namespace exactcsg::csg::test {

using TestTree = Tree<int, BooleanOperator>;

inline TestTree leaf(int i) { return TestTree::primitive(i); }
inline constexpr auto same = [](int i) { return i; };

// A tree as a text, with parentheses round every pair of operands.
inline constexpr auto text = [](int i) { return std::to_string(i); };
inline std::string name(BooleanOperator op) { return {BooleanCodes{}(op)}; }
inline constexpr auto combine_texts = [](std::string a, BooleanOperator op, std::string b) {
  return "(" + a + " " + name(op) + " " + b + ")";
};
inline const FullEmptyResult constant_texts{std::string("full"), std::string("empty")};

inline constexpr auto absorbing = [](Membership m, BooleanOperator op) { return absorbs(m, op); };
inline constexpr FullEmptyResult constants{Membership::In, Membership::Out};

constexpr BooleanOperator all_operators[] = {BooleanOperator::Union, BooleanOperator::Intersection,
                                             BooleanOperator::Difference,
                                             BooleanOperator::SymmetricDifference};

inline std::uint32_t below(std::mt19937& random, std::uint32_t n) {
  return static_cast<std::uint32_t>(random() % n);
}

// A tree of at most `depth` levels over the primitives 0 .. primitives - 1; about one leaf in
// six is Empty or Full, and now and then a subtree is used twice.
inline TestTree random_tree(std::mt19937& random, int depth, std::uint32_t primitives) {
  if (depth == 0 || below(random, 4) == 0) {
    switch (below(random, 12)) {
      case 0:
        return TestTree::empty();
      case 1:
        return TestTree::full();
      default:
        return TestTree::primitive(static_cast<int>(below(random, primitives)));
    }
  }
  std::vector<TestTree> children;
  const auto degree = 1 + below(random, 4);
  for (std::uint32_t i = 0; i < degree; ++i) {
    const bool again = !children.empty() && below(random, 8) == 0;
    children.push_back(again ? children.back() : random_tree(random, depth - 1, primitives));
  }
  return TestTree::compose(all_operators[below(random, 4)], std::move(children));
}

// Set operations on bit sets: bit b of the result is the membership of the b-th assignment of
// truth values to the primitives. Independent of combine, traverse and prune.
using Bits = std::uint64_t;

inline Bits meaning(const TestTree& tree, const std::vector<Bits>& primitives) {
  switch (tree.kind()) {
    case NodeKind::Empty:
      return 0;
    case NodeKind::Full:
      return ~Bits{0};
    case NodeKind::Primitive:
      return primitives[static_cast<std::size_t>(tree.primitive())];
    case NodeKind::Compose:
      break;
  }
  Bits result = meaning(tree.children()[0], primitives);
  for (const TestTree& child : tree.children().subspan(1)) {
    const Bits operand = meaning(child, primitives);
    switch (tree.operation()) {
      case BooleanOperator::Union:
        result |= operand;
        break;
      case BooleanOperator::Intersection:
        result &= operand;
        break;
      case BooleanOperator::Difference:
        result &= ~operand;
        break;
      case BooleanOperator::SymmetricDifference:
        result ^= operand;
        break;
    }
  }
  return result;
}

// Six primitives have 64 assignments: bit b of primitive i is bit i of b.
inline std::vector<Bits> all_assignments() {
  std::vector<Bits> bits(6);
  for (unsigned b = 0; b < 64; ++b) {
    for (unsigned i = 0; i < 6; ++i) bits[i] |= Bits{(b >> i) & 1U} << b;
  }
  return bits;
}

}  // namespace exactcsg::csg::test
