// SPDX-License-Identifier: GPL-3.0-or-later
// Proofs about regions. Expected verdicts: the geometry, said at each case; witnesses are
// classified by domain/classify.hpp, which shares no code with the search; random cases against
// certified volumes of intersections.

#include "exactcsg/measure/region_proof.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "exactcsg/domain/classify.hpp"
#include "measure/curved_solids.hpp"
#include "measure/opaque_domain.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

using Regions = std::vector<Solid3>;

Proof disjoint(const Regions& regions, const Box<3>& box, const ProofLimits& limits = {}) {
  return prove_disjoint(std::span<const Solid3>(regions), box, limits);
}
Proof cover(const Regions& regions, const Box<3>& box, const ProofLimits& limits = {}) {
  return prove_cover(std::span<const Solid3>(regions), box, limits);
}
bool is_proved(const Proof& proof) { return std::holds_alternative<Proved>(proof); }

bool is_inner_point(const Point<3>& p, const Box<3>& box) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (p[i] <= box.lower()[i] || p[i] >= box.upper()[i]) return false;
  }
  return true;
}

// LAW region_proof.2
void check_witnesses(const Proof& proof, const Regions& regions, const Box<3>& box,
                     bool of_overlap) {
  const auto* refuted = std::get_if<Refuted>(&proof);
  ASSERT_NE(refuted, nullptr);
  ASSERT_FALSE(refuted->witnesses.empty());
  for (const Witness& witness : refuted->witnesses) {
    EXPECT_TRUE(is_inner_point(witness.point, box));
    EXPECT_EQ(witness.regions.size() >= 2, of_overlap);
    EXPECT_EQ(witness.regions.empty(), !of_overlap);
    for (const std::size_t region : witness.regions) {
      EXPECT_EQ(classify(regions[region], witness.point), PointClass::In);
    }
    for (const Solid3& region : regions) {
      if (!of_overlap) {
        EXPECT_EQ(classify(region, witness.point), PointClass::Out);
      }
    }
  }
}

// A grid of balls of different radii in a block, and the background: as many cells as balls are
// left once each is alone with the background, and those decide without rational arithmetic.
TEST(RegionProof, ManyBallsAndTheirBackgroundArePartitioned) {
  constexpr int n = 8;
  Regions regions;
  std::vector<Solid3> background{domain::make_block(Box<3>(point(0, 0, 0), point(n, n, n)))};
  for (int i = 0; i < n * n * n; ++i) {
    const Rational radius = Rational(200 + 37 * i % 250, 1000);  // below 1/2: they do not touch
    const HalfSpace<3> sphere =
        domain::make_sphere(point(Rational(2 * (i / n / n) + 1, 2),
                                  Rational(2 * (i / n % n) + 1, 2), Rational(2 * (i % n) + 1, 2)),
                            Rational(radius * radius));
    regions.push_back(solid(sphere));
    background.push_back(solid(complement(sphere)));
  }
  const Solid3 block = background.front();
  regions.push_back(Solid3::compose(csg::BooleanOperator::Intersection, std::move(background)));
  ProofLimits limits;
  limits.cells = 20 * n * n * n;
  const Proof proof = prove_partition(std::span<const Solid3>(regions), block,
                                      Box<3>(point(0, 0, 0), point(n, n, n)), limits);
  EXPECT_TRUE(is_proved(proof));
}

// Concentric balls and the shells between them, up to the outside.
Regions shells(int count) {
  Regions regions{ball({}, 1)};
  for (int i = 2; i <= count; ++i) {
    regions.push_back(csg::subtract(ball({}, i * i), ball({}, (i - 1) * (i - 1))));
  }
  regions.push_back(csg::complement(ball({}, count * count)));
  return regions;
}

TEST(RegionProof, ShellsAreDisjointAndCoverTheBox) {
  const Regions regions = shells(5);
  EXPECT_TRUE(is_proved(disjoint(regions, cube(6))));
  EXPECT_TRUE(is_proved(cover(regions, cube(6))));
}

// The same surfaces under other factors and senses, which do not matter to the sets.
TEST(RegionProof, SharedSurfacesAreRecognisedHoweverTheyAreWritten) {
  const domain::Quadric<3> f = domain::make_sphere(point(0, 0, 0), 2).polynomial();
  const Solid3 inside = solid(HalfSpace<3>(Rational(2, 3) * f));
  const Solid3 outside = solid(HalfSpace<3>(Rational(-5) * f));
  EXPECT_TRUE(is_proved(disjoint({inside, outside}, cube(2))));
  EXPECT_TRUE(is_proved(cover({inside, outside}, cube(2))));
}

TEST(RegionProof, AnOverlapOfAMillionthIsFound) {
  const Rational distance = 2 - Rational(1, 1'000'000);
  const Regions regions{cylinder(2, 1), cylinder(2, 1, point(distance, 0, 0))};
  const Proof proof = disjoint(regions, cube(4));
  check_witnesses(proof, regions, cube(4), true);
  EXPECT_EQ(std::get<Refuted>(proof).witnesses.front().regions, (std::vector<std::size_t>{0, 1}));
}

TEST(RegionProof, AGapOfAMillionthIsFound) {
  const Rational radius = 1 + Rational(1, 1'000'000);
  const Regions regions{ball({}, 1), csg::complement(ball({}, Rational(radius * radius)))};
  EXPECT_TRUE(is_proved(disjoint(regions, cube(2))));
  check_witnesses(cover(regions, cube(2)), regions, cube(2), false);
}

// The corner that is left where a rounded edge was meant to be filled.
TEST(RegionProof, AGapAtARoundedCornerIsFound) {
  const Box<3> box(point(0, 0, 0), point(1, 1, 1));
  const Solid3 rounded = cylinder(2, Rational(1, 100), point(Rational(9, 10), Rational(9, 10), 0));
  const Solid3 corner =
      csg::intersect(below({-1, 0, 0}, Rational(-9, 10)), below({0, -1, 0}, Rational(-9, 10)));
  const Regions with_gap{csg::complement(corner), rounded};
  check_witnesses(cover(with_gap, box), with_gap, box, false);
  const Regions without{csg::complement(corner), rounded, csg::subtract(corner, rounded)};
  EXPECT_TRUE(is_proved(cover(without, box)));
}

// Exact decimals: 0.1 + 0.2 = 0.3, which the doubles of these numbers miss.
TEST(RegionProof, TouchingIsNotOverlapping) {
  const Rational tenth(1, 10);
  const Solid3 small = ball(point(tenth, 0, 0), Rational(1, 25));
  const Regions cases[] = {
      {ball({}, Rational(1, 100)), ball(point(Rational(3, 10), 0, 0), Rational(1, 25))},
      {small, below({-1, 0, 0}, Rational(-3, 10))},
      {cylinder(2, 1), cylinder(2, 1, point(2, 0, 0))},
      {cylinder(2, 1), below({-3, -4, 0}, -5)},
      // one inside the other, touching it from inside
      {csg::complement(ball({}, 4)), ball(point(1, 0, 0), 1)},
      {csg::complement(cylinder(0, 4)), cylinder(0, 1, point(0, 1, 0))},
  };
  for (const Regions& regions : cases) EXPECT_TRUE(is_proved(disjoint(regions, cube(4))));
}

Proof partition(const Regions& regions, const Solid3& within, const Box<3>& box) {
  ProofLimits limits;
  limits.witnesses = 100;
  return prove_partition(std::span<const Solid3>(regions), within, box, limits);
}
std::vector<std::vector<std::size_t>> named_in(const Proof& proof) {
  std::vector<std::vector<std::size_t>> named;
  for (const Witness& witness : std::get<Refuted>(proof).witnesses)
    named.push_back(witness.regions);
  std::sort(named.begin(), named.end());
  return named;
}

// Of shells, and of all but one of them, within sets in which the missing one has a part or none.
TEST(RegionProof, APartitionHasNeitherOverlapNorGapWhereItIsAsked) {
  Regions regions = shells(4);
  const Box<3> box = cube(5);
  EXPECT_TRUE(is_proved(partition(regions, Solid3::full(), box)));
  regions.erase(regions.begin() + 2);  // between radii 2 and 3
  const Proof with_gap = partition(regions, Solid3::full(), box);
  EXPECT_EQ(named_in(with_gap), (std::vector<std::vector<std::size_t>>{{}}));
  EXPECT_TRUE(std::get<Refuted>(with_gap).is_complete);
  EXPECT_TRUE(std::get<Refuted>(with_gap).rest.cells.empty());
  EXPECT_TRUE(is_proved(partition(regions, ball({}, 4), box)));
  EXPECT_TRUE(is_proved(partition(regions, csg::complement(ball({}, 9)), box)));
  const Solid3 within = ball({}, Rational(401, 100));  // a little more than the radius 2
  const Proof in_part = partition(regions, within, box);
  EXPECT_EQ(named_in(in_part), (std::vector<std::vector<std::size_t>>{{}}));
  EXPECT_EQ(classify(within, std::get<Refuted>(in_part).witnesses.front().point), PointClass::In);
  regions.push_back(ball(point(4, 0, 0), 1));  // overlaps the shell from 3 to 4, and the outside
  EXPECT_EQ(named_in(partition(regions, csg::complement(ball({}, 9)), box)),
            (std::vector<std::vector<std::size_t>>{{2, 4}, {3, 4}}));
}

// LAW region_proof.5: three half-spaces through the origin have points of all eight combinations;
// in a ball beside them, of those that the geometry leaves.
TEST(RegionProof, CombinationsAreAllFound) {
  const Regions sides{below({1, 0, 0}, 0), below({0, 1, 0}, 0), below({0, 0, 1}, 0)};
  ProofLimits limits;
  limits.witnesses = 100;
  const auto combinations = [&](const Solid3& within) {
    return find_combinations(std::span<const Solid3>(sides), within, cube(4), limits);
  };
  EXPECT_EQ(named_in(combinations(ball({}, 1))).size(), 8U);
  // Crosses the plane z = 0 only, where x < 0 and y > 0.
  const Proof beside = combinations(ball(point(-2, 2, 0), 1));
  EXPECT_EQ(named_in(beside), (std::vector<std::vector<std::size_t>>{{0}, {0, 2}}));
  EXPECT_TRUE(std::get<Refuted>(beside).is_complete);
  EXPECT_TRUE(is_proved(combinations(Solid3::empty())));
}

// Three that are pairwise disjoint but for one pair, and one pair more: all are named.
TEST(RegionProof, EveryPairThatOverlapsIsNamed) {
  const Regions regions{ball({}, 1), ball(point(3, 0, 0), 1), ball(point(1, 0, 0), 1),
                        ball(point(3, 1, 0), Rational(1, 2))};
  ProofLimits limits;
  limits.witnesses = 10;
  const Proof proof = disjoint(regions, cube(5), limits);
  check_witnesses(proof, regions, cube(5), true);
  const auto& refuted = std::get<Refuted>(proof);
  EXPECT_TRUE(refuted.is_complete);
  std::vector<std::vector<std::size_t>> named;
  for (const Witness& witness : refuted.witnesses) named.push_back(witness.regions);
  std::sort(named.begin(), named.end());
  EXPECT_EQ(named, (std::vector<std::vector<std::size_t>>{{0, 2}, {1, 3}}));
}

TEST(RegionProof, ContainsAndInterferes) {
  const Solid3 large = ball({}, 4);
  const Solid3 small = ball(point(1, 0, 0), 1);  // touches it from inside
  const Solid3 crossing = ball(point(Rational(11, 10), 0, 0), 1);
  const Box<3> box = cube(3);
  EXPECT_TRUE(is_proved(prove_contains(large, small, box)));
  EXPECT_TRUE(is_proved(prove_contains(large, large, box)));
  const Proof proof = prove_contains(large, crossing, box);
  const auto* refuted = std::get_if<Refuted>(&proof);
  ASSERT_NE(refuted, nullptr);
  EXPECT_EQ(classify(large, refuted->witnesses.front().point), PointClass::Out);
  EXPECT_EQ(classify(crossing, refuted->witnesses.front().point), PointClass::In);
  EXPECT_TRUE(std::holds_alternative<Refuted>(prove_disjoint(large, small, box)));
  EXPECT_TRUE(is_proved(prove_disjoint(large, csg::complement(large), box)));
}

TEST(RegionProof, EmptyAndFullRegions) {
  const Box<3> box = cube(1);
  EXPECT_TRUE(is_proved(disjoint({}, box)));
  EXPECT_TRUE(is_proved(disjoint({Solid3::full(), Solid3::empty()}, box)));
  EXPECT_TRUE(is_proved(cover({Solid3::full(), Solid3::empty()}, box)));
  const Regions twice{Solid3::full(), Solid3::full()};
  check_witnesses(disjoint(twice, box), twice, box, true);
  check_witnesses(cover({}, box), {}, box, false);
  check_witnesses(cover({Solid3::empty()}, box), {Solid3::empty()}, box, false);
}

// Two cones with one apex, each in the other's outside, touch in a point that no pair of
// polynomials shows: either answer but a refutation is right, and what is left is little.
TEST(RegionProof, WhatIsNotDecidedIsBounded) {
  const Regions cones{solid(domain::make_cone({point(0, 0, 0), {0, 0, 1}}, Rational(1, 2))),
                      solid(domain::make_cone({point(0, 0, 0), {1, 0, 0}}, Rational(1, 2)))};
  ProofLimits limits;
  limits.negligible_share = 1e-6;
  const Proof proof = disjoint(cones, cube(1), limits);
  ASSERT_FALSE(std::holds_alternative<Refuted>(proof));
  if (const auto* undecided = std::get_if<Undecided>(&proof)) {
    EXPECT_LE(undecided->volume, rational_of(8e-6));
    Rational sum;
    for (const Box<3>& cell : undecided->cells) sum += detail::volume_of(cell);
    EXPECT_EQ(sum, undecided->volume);
  }
}

// So many surfaces that the box is not decided as a whole.
TEST(RegionProof, LimitsEndTheWork) {
  const Regions regions = shells(12);
  const Box<3> box = cube(13);
  ProofLimits limits;
  limits.cells = 1;
  const auto stop_of = [&] {
    const Proof proof = disjoint(regions, box, limits);
    EXPECT_EQ(std::get<Undecided>(proof).volume, 26 * 26 * 26);
    EXPECT_EQ(std::get<Undecided>(proof).cells, std::vector{box});
    return std::get<Undecided>(proof).stop;
  };
  EXPECT_EQ(stop_of(), StopReason::Cells);
  Progress progress;
  progress.cancel();
  limits = {};
  limits.progress = &progress;
  EXPECT_EQ(stop_of(), StopReason::Cancelled);
  EXPECT_EQ(progress.done(), 1U);
  limits.progress = nullptr;
  EXPECT_TRUE(is_proved(disjoint(regions, box, limits)));
}

// Of a domain that has no polynomials, nothing is known but classes of points and boxes.
TEST(RegionProof, AnyDomainOfSpaceIsProved) {
  using Set = csg::BooleanTree<Opaque>;
  const auto sphere = [](int x) {
    return Set::primitive({domain::make_sphere(point(x, 0, 0), 1)});
  };
  const Box<3> box = cube(5);
  EXPECT_TRUE(std::holds_alternative<Proved>(prove_disjoint(sphere(-2), sphere(2), box)));
  const Proof proof = prove_disjoint(sphere(0), sphere(1), box);
  ASSERT_TRUE(std::holds_alternative<Refuted>(proof));
  const Point<3>& witness = std::get<Refuted>(proof).witnesses.front().point;
  EXPECT_EQ(classify(sphere(0), witness), PointClass::In);
  EXPECT_EQ(classify(sphere(1), witness), PointClass::In);
}

// LAW region_proof.1 to 3 against certified volumes: of the intersection, and of what is left of
// the box.
RC_GTEST_PROP(RegionProof, AgreesWithVolumes, ()) {
  const Regions regions{random_solid(), random_solid()};
  const Box<3> box = cube(1);
  ProofLimits limits;
  limits.negligible_share = 1e-3;
  limits.cells = 3000;
  MeasureLimits measure_limits;
  measure_limits.absolute_width = 1e-4;
  measure_limits.cells = 500;
  const auto check = [&](const Proof& proof, const Solid3& violation, bool of_overlap) {
    const Enclosure v = volume(violation, box, measure_limits).value;
    if (is_proved(proof)) RC_ASSERT(v.lower == 0);
    if (std::holds_alternative<Refuted>(proof)) {
      RC_ASSERT(v.upper > 0);
      check_witnesses(proof, regions, box, of_overlap);
    }
    if (const auto* undecided = std::get_if<Undecided>(&proof)) {
      RC_ASSERT(v.lower <= undecided->volume);
    }
  };
  check(disjoint(regions, box, limits), csg::intersect(regions[0], regions[1]), true);
  check(cover(regions, box, limits), csg::complement(csg::unite(regions[0], regions[1])), false);
}

// A set, and its complement cut into two by another: disjoint, and a cover.
RC_GTEST_PROP(RegionProof, PartitionsAreNeverRefuted, ()) {
  const Solid3 a = random_solid();
  const Solid3 b = random_solid();
  const Regions regions{a, csg::subtract(b, a), csg::complement(csg::unite(a, b))};
  ProofLimits limits;
  limits.negligible_share = 1e-3;
  limits.cells = 3000;
  RC_ASSERT(is_proved(disjoint(regions, cube(1), limits)));
  RC_ASSERT(is_proved(cover(regions, cube(1), limits)));
}

}  // namespace
}  // namespace exactcsg::measure::test
