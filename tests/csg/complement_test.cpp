// SPDX-License-Identifier: GPL-3.0-or-later
// Complements, Full - a, at any place of a tree, through every operator on trees. Expected values
// are set operations on bit sets (random_tree.hpp), and the laws of complements.

#include <gtest/gtest.h>

#include <random>

#include "csg/random_tree.hpp"
#include "exactcsg/csg/attributed.hpp"
#include "exactcsg/csg/batch.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/maintained_traverse.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/reduce.hpp"
#include "exactcsg/csg/set_skeleton.hpp"
#include "exactcsg/csg/text.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/views.hpp"

namespace exactcsg::csg::test {
namespace {

// About every second node is a complement, some of a complement.
TestTree random_complements(std::mt19937& random, int depth) {
  if (below(random, 2) == 0) return complement(random_complements(random, depth));
  if (depth == 0) return random_tree(random, 0, 6);
  std::vector<TestTree> children;
  for (std::uint32_t i = 1 + below(random, 3); i > 0; --i) {
    children.push_back(random_complements(random, depth - 1));
  }
  return TestTree::compose(all_operators[below(random, 4)], std::move(children));
}

Bits combine_bits(Bits a, BooleanOperator op, Bits b) {
  return meaning(TestTree::compose(op, {TestTree::primitive(0), TestTree::primitive(1)}), {a, b});
}
const FullEmptyResult full_and_empty{~Bits{0}, Bits{0}};

class Complements : public testing::Test {
 protected:
  Bits bits(const TestTree& tree) const { return meaning(tree, assignments); }
  Bits traversed(const auto& tree) const {
    return traverse(
        tree, [&](int p) { return assignments[static_cast<std::size_t>(p)]; }, combine_bits,
        full_and_empty);
  }
  // Calls check(tree) for many trees.
  void for_many(const auto& check) {
    for (int i = 0; i < 500; ++i) {
      check(random_complements(random, 3));
      if (HasFatalFailure()) return;
    }
  }
  std::vector<Bits> assignments = all_assignments();
  std::mt19937 random{29};
};

TEST_F(Complements, MeanWhatIsOutside) {
  for_many([&](const TestTree& tree) { ASSERT_EQ(bits(complement(tree)), ~bits(tree)); });
}

TEST_F(Complements, AreTraversedInEveryForm) {
  for_many([&](const TestTree& tree) {
    ASSERT_EQ(traversed(tree), bits(tree));
    ASSERT_EQ(traversed(BinaryView(tree)), bits(tree));
    ASSERT_EQ(traversed(to_tree(BinaryView(tree))), bits(tree));
    ASSERT_EQ(traversed(merge_nested(tree)), bits(tree));
    ASSERT_EQ(traversed(flatten(tree, [](int p) { return p; })), bits(tree));
    ASSERT_EQ(traversed(map(tree, [](int p) { return p; })), bits(tree));
  });
}

TEST_F(Complements, AreTraversedInBatchesAndByTheSkeleton) {
  std::vector<unsigned> queries(64);
  for (unsigned b = 0; b < 64; ++b) queries[b] = b;
  const auto contains = [&](int p, unsigned b) {
    return (assignments[static_cast<std::size_t>(p)] >> b & 1U) != 0 ? Membership::In
                                                                     : Membership::Out;
  };
  const SetAlgebra algebra{[](Bits a, Bits b) { return a & b; },
                           [](Bits a, Bits b) { return a | b; }, ~Bits{0}, Bits{0},
                           [](Bits a) { return ~a; }};
  for_many([&](const TestTree& tree) {
    const auto classes = traverse_batch(tree, queries, contains, combine,
                                        FullEmptyResult{Membership::In, Membership::Out}, absorbs);
    Bits together = 0;
    for (unsigned b = 0; b < 64; ++b) {
      together |= Bits{classes[b] == Membership::In ? 1U : 0U} << b;
    }
    ASSERT_EQ(together, bits(tree));
    const auto solve = [&](int p) { return assignments[static_cast<std::size_t>(p)]; };
    ASSERT_EQ(set_skeleton(tree, solve, algebra), bits(tree));
    ASSERT_EQ(set_skeleton(tree, solve, algebra, skeleton::ParallelExecutor<>(2), 2), bits(tree));
  });
}

// Primitives 0 and 1 are Full and Empty in a region: there the pruned tree is the tree.
TEST_F(Complements, ArePrunedAndSimplified) {
  const auto classify = [](int p) {
    return p == 0 ? Membership::In : p == 1 ? Membership::Out : Membership::Unknown;
  };
  const Bits region = assignments[0] & ~assignments[1];
  FlatTree<int, BooleanOperator> local;
  PruneScratch<TestTree> scratch;
  for_many([&](const TestTree& tree) {
    ASSERT_EQ(traversed(prune(tree, classify)) & region, bits(tree) & region);
    ASSERT_EQ(traversed(simplify(tree)), bits(tree));
    prune_into(tree, classify, local, scratch);
    ASSERT_EQ(traversed(local) & region, bits(tree) & region);
    const TestTree outside = prune(complement(tree), classify);
    ASSERT_EQ(traversed(outside) & region, ~bits(tree) & region);
  });
}

// A double complement is what it was, in its simplest form.
TEST_F(Complements, OfConstantsSimplifyToConstants) {
  EXPECT_TRUE(simplify(complement(TestTree::full())).is_empty());
  EXPECT_TRUE(simplify(complement(TestTree::empty())).is_full());
  EXPECT_TRUE(simplify(complement(complement(TestTree::full()))).is_full());
}

TEST_F(Complements, AreMaintained) {
  const auto combining = [](Membership a, BooleanOperator op, Membership b) {
    return combine(a, op, b);
  };
  const auto absorbing = [](Membership a, BooleanOperator op) { return absorbs(a, op); };
  MaintainedTraverse<std::uint32_t, BooleanOperator, Membership, decltype(combining),
                     decltype(absorbing)>
      maintained(6, combining, absorbing, FullEmptyResult{Membership::In, Membership::Out});
  for_many([&](const TestTree& tree) {
    maintained.assign(flatten(tree, [](int p) { return static_cast<std::uint32_t>(p); }),
                      Membership::Out);
    for (unsigned b = 0; b < 64; ++b) {
      for (std::uint32_t p = 0; p < 6; ++p) {
        maintained.change(p, (b >> p & 1U) != 0 ? Membership::In : Membership::Out);
      }
      const bool is_in = (bits(tree) >> b & 1U) != 0;
      ASSERT_EQ(maintained.value(), is_in ? Membership::In : Membership::Out);
    }
  });
}

TEST_F(Complements, AreAttributedWrittenAndRead) {
  const auto put = [](TextWriter& out, int p) { out.write(p); };
  const auto get = [](TextReader& in) { return in.number<int>(); };
  for_many([&](const TestTree& tree) {
    const auto attributed = attribute(
        tree, [&](int p) { return assignments[static_cast<std::size_t>(p)]; }, combine_bits,
        full_and_empty);
    if (tree.is_compose()) {
      ASSERT_EQ(attribute_of(attributed), bits(tree));
    }
    ASSERT_TRUE(from_text(to_text(tree, put), get) == tree);
  });
}

}  // namespace
}  // namespace exactcsg::csg::test
