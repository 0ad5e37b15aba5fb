// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluator against boundaries of sets of unit cubes that are counted out on the grid, without
// any geometry: every degeneracy of flush, touching and pinched faces occurs. LAW boundary.1
#include <gtest/gtest.h>

#include <random>

#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "solid/boundary_builder.hpp"

namespace exactcsg {
namespace {

using namespace test;

Solid cube_at(const Cell& c) {
  return Solid::primitive({make_box({c[0], c[1], c[2]}, {c[0] + 1, c[1] + 1, c[2] + 1})});
}

Solid union_of(const std::set<Cell>& cells) {
  std::vector<Solid> cubes;
  for (const Cell& c : cells) cubes.push_back(cube_at(c));
  return Solid::compose(csg::BooleanOperator::Union, std::move(cubes));
}

void expect_same(const Boundary& found, const Boundary& expected, const std::string& what) {
  EXPECT_EQ(found.vertices, expected.vertices) << what;
  EXPECT_EQ(found.edges, expected.edges) << what;
  EXPECT_EQ(sorted_planes(found), sorted_planes(expected)) << what;
  EXPECT_EQ(digest(found), digest(expected)) << what;
  const Topology a = topology(found);
  const Topology b = topology(expected);
  EXPECT_TRUE(a == b) << what << ": components " << a.components << " " << b.components
                      << ", cavities " << a.cavities << " " << b.cavities << ", genus " << a.genus
                      << " " << b.genus << ", faces " << a.faces << " " << b.faces;
}

TEST(EvaluateCells, RandomUnionsAndDifferences) {
  std::mt19937 random(2026);
  const std::set<Cell> all = block({0, 0, 0}, {4, 4, 4});
  for (int round = 0; round < 120; ++round) {
    const unsigned density = 1 + static_cast<unsigned>(round) % 7;
    std::set<Cell> kept;
    for (const Cell& c : all) {
      if (random() % 8 < density) kept.insert(c);
    }
    if (kept.empty() || kept.size() == all.size()) continue;
    const Boundary expected = boundary_of_cells(kept);
    const std::string what = "round " + std::to_string(round);
    const Boundary united = evaluate(union_of(kept));
    expect_same(united, expected, what + ", as a union");
    EXPECT_EQ(exact_volume(united), Rational(static_cast<long>(kept.size())));
    // The same solid as what is left of the block.
    const Solid rest = csg::subtract(Solid::primitive({make_box({0, 0, 0}, {4, 4, 4})}),
                                     union_of(without(all, kept)));
    expect_same(evaluate(rest), expected, what + ", as a difference");
  }
}

TEST(EvaluateCells, HollowAndFilledPlusDiffer) {
  const std::set<Cell> arms{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  expect_same(evaluate(union_of(arms)), boundary_of_cells(arms), "hollow");
  const auto filled = with(arms, {{0, 0, 0}});
  expect_same(evaluate(union_of(filled)), boundary_of_cells(filled), "filled");
}

}  // namespace
}  // namespace exactcsg
