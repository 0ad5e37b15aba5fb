// SPDX-License-Identifier: GPL-3.0-or-later
// Solids that are changed again and again. Every expected boundary is that of a full evaluation of
// the tree with the same changes made (LAW incremental.1), or counted out on a grid.
#include <gtest/gtest.h>

#include <random>

#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/incremental_evaluation.hpp"
#include "exactcsg/solid/measures.hpp"
#include "solid/boundary_builder.hpp"

namespace exactcsg {
namespace {

using csg::BooleanOperator;

Primitive box(const Point3& lower, const Point3& upper) { return {make_box(lower, upper)}; }

Primitive unit_cube(int x, int y, int z) { return box({x, y, z}, {x + 1, y + 1, z + 1}); }

// A body of 14 faces round the origin: a cube without its corners.
const Primitive& unit_ball() {
  static const Primitive made = [] {
    std::vector<HalfSpace> sides;
    for (const int s : {-1, 1}) {
      sides.push_back(make_half_space(s, 0, 0, -1));
      sides.push_back(make_half_space(0, s, 0, -1));
      sides.push_back(make_half_space(0, 0, s, -1));
      for (const int t : {-1, 1}) {
        for (const int u : {-1, 1}) sides.push_back(make_half_space(s, t, u, -2));
      }
    }
    return Primitive{make_convex_polytope(sides)};
  }();
  return made;
}

Primitive ball(const Point3& centre, const Rational& radius) {
  AffineMap map = AffineMap::identity();
  map.m[0] = {radius, 0, 0, centre.x};
  map.m[1] = {0, radius, 0, centre.y};
  map.m[2] = {0, 0, radius, centre.z};
  return exactcsg::apply(map, unit_ball());
}

class RandomPrimitives {
 public:
  explicit RandomPrimitives(unsigned seed) : random_(seed) {}

  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  // On a grid, so that faces are flush and edges touch, or turned, so that they are not.
  Primitive operator()() {
    const Point3 at{below(8), below(8), below(8)};
    switch (below(4)) {
      case 0:
        return ball(at, Rational(1 + below(4)) / 2);
      case 1: {
        const Primitive bar = box({0, 0, 0}, {1 + below(4), 1 + below(3), 1 + below(2)});
        AffineMap map = AffineMap::identity();
        map.m[0] = {Rational(3, 5), Rational(-4, 5), 0, at.x};
        map.m[1] = {Rational(4, 5), Rational(3, 5), 0, at.y};
        map.m[2] = {0, 0, 1, at.z};
        return exactcsg::apply(map, bar);
      }
      default:
        return box(at, {at.x + 1 + below(4), at.y + 1 + below(4), at.z + 1 + below(4)});
    }
  }

  BooleanOperator operation() {
    constexpr std::array likely{BooleanOperator::Union,        BooleanOperator::Union,
                                BooleanOperator::Union,        BooleanOperator::Difference,
                                BooleanOperator::Difference,   BooleanOperator::SymmetricDifference,
                                BooleanOperator::Intersection, BooleanOperator::Union};
    return likely[static_cast<std::size_t>(below(static_cast<int>(likely.size())))];
  }

  Solid tree(int depth) {
    if (depth == 0) return Solid::primitive((*this)());
    std::vector<Solid> children;
    const int count = 1 + below(3);
    for (int i = 0; i < count; ++i) children.push_back(tree(depth - 1));
    return Solid::compose(operation(), std::move(children));
  }

 private:
  std::mt19937 random_;
};

void expect_as_evaluated(IncrementalEvaluation& design, const std::string& what) {
  SCOPED_TRACE(what);
  const Boundary expected = evaluate(design.solid());
  const Boundary found = design.boundary();
  ASSERT_TRUE(found.vertices == expected.vertices);
  ASSERT_TRUE(found.edges == expected.edges);
  ASSERT_EQ(digest(found), digest(expected));
}

// LAW incremental.1, .2
void change_at_random(unsigned seed, const EvaluateOptions& options, int changes) {
  RandomPrimitives random(seed);
  IncrementalEvaluation design(random.tree(3), options);
  for (int i = 0; i < changes; ++i) {
    const bool replaces = design.occurrence_count() > 0 && random.below(2) == 0;
    const auto any = [&] {
      return Occurrence{
          static_cast<std::uint32_t>(random.below(static_cast<int>(design.occurrence_count())))};
    };
    // Now and then one that occurs already.
    const bool known = design.occurrence_count() > 0 && random.below(4) == 0;
    const Primitive primitive = known ? design.primitive(any()) : random();
    if (replaces) {
      design.replace(any(), primitive);
    } else {
      design.apply(random.operation(), primitive);
    }
    expect_as_evaluated(design, "seed " + std::to_string(seed) + ", change " + std::to_string(i));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Incremental, RandomChanges) {
  for (unsigned seed = 0; seed < 30 && !HasFatalFailure(); ++seed) change_at_random(seed, {}, 12);
}

TEST(Incremental, RandomChangesInSmallCells) {
  EvaluateOptions options;
  options.facets_per_cell = 4;
  for (unsigned seed = 100; seed < 115 && !HasFatalFailure(); ++seed) {
    change_at_random(seed, options, 12);
  }
}

TEST(Incremental, LongSequences) {
  for (unsigned seed = 200; seed < 203 && !HasFatalFailure(); ++seed) {
    change_at_random(seed, {}, 80);
  }
}

// Every step against the boundary counted out on the grid.
TEST(Incremental, CubesUnitedAndSubtracted) {
  std::vector<std::array<int, 3>> places;
  for (int i = 0; i < 27; ++i) places.push_back({i % 3, i / 3 % 3, i / 9});
  std::mt19937 random(7);
  IncrementalEvaluation design;
  std::set<test::Cell> filled;
  const auto expect_as_counted = [&](const std::string& what) {
    const Boundary found = design.boundary();
    if (filled.empty()) {
      EXPECT_TRUE(found.empty()) << what;
      EXPECT_EQ(digest(found), digest(evaluate(Solid::empty()))) << what;
      return;
    }
    EXPECT_EQ(digest(found), digest(test::boundary_of_cells(filled))) << what;
    EXPECT_EQ(exact_volume(found), Rational(static_cast<long>(filled.size()))) << what;
  };
  for (const bool unites : {true, false}) {
    std::shuffle(places.begin(), places.end(), random);
    for (const auto& [x, y, z] : places) {
      if (unites) {
        design.unite(unit_cube(x, y, z));
        filled.insert({x, y, z});
      } else {
        design.subtract(unit_cube(x, y, z));
        filled.erase({x, y, z});
      }
      expect_as_counted((unites ? "with " : "without ") + std::to_string(filled.size()));
    }
  }
}

Solid row_of_balls(int count) {
  std::vector<Solid> balls;
  for (int i = 0; i < count; ++i) balls.push_back(Solid::primitive(ball({4 * i, 0, 0}, 1)));
  return Solid::compose(BooleanOperator::Union, std::move(balls));
}

// A change is felt where it is, not elsewhere.
TEST(Incremental, FarCellsAreLeftAlone) {
  for (const int count : {64, 256}) {
    IncrementalEvaluation design(row_of_balls(count));
    const UpdateStatistics moved = design.replace(Occurrence{1}, ball({4, 1, 0}, 1));
    EXPECT_FALSE(moved.everything);
    EXPECT_GE(moved.cells, static_cast<std::uint64_t>(count));
    EXPECT_GE(moved.renewed_cells, 1U);
    EXPECT_LE(moved.renewed_cells, 24U);
    expect_as_evaluated(design, "moved");
    const UpdateStatistics drilled = design.subtract(ball({40, 1, 1}, 1));
    EXPECT_FALSE(drilled.everything);
    EXPECT_GE(drilled.evaluated_cells, 1U);
    EXPECT_LE(drilled.renewed_cells, 24U);
    expect_as_evaluated(design, "drilled");
  }
}

// Moved to and fro, a primitive leaves no trace: a bounded number of cells and of
// facets that are evaluated anew.
TEST(Incremental, NothingPilesUp) {
  IncrementalEvaluation design(row_of_balls(16));
  std::uint64_t most = 0;
  for (int i = 0; i < 120; ++i) {
    most = std::max(most, design.replace(Occurrence{5}, ball({i % 60, i % 3, 1}, 1)).cells);
  }
  EXPECT_LE(most, 400U);
  expect_as_evaluated(design, "after 120 moves");
  // A pit that is dug and filled again and again.
  for (int i = 0; i < 60; ++i) {
    const Primitive pit = box({-1, -1, -1}, {Rational(1 + i % 7) / 3, 1, 1});
    const UpdateStatistics dug = design.subtract(pit);
    const UpdateStatistics filled = design.unite(pit);
    EXPECT_LE(dug.cells, 400U) << i;
    EXPECT_LE(filled.renewed_cells, 60U) << i;
  }
  expect_as_evaluated(design, "after 60 pits");
}

// LAW incremental.3
TEST(Incremental, CopiesAreVariants) {
  IncrementalEvaluation design(row_of_balls(8));
  const std::string before = digest(design.boundary());
  IncrementalEvaluation variant = design;
  variant.subtract(box({0, 0, 0}, {20, 1, 1}));
  EXPECT_EQ(digest(design.boundary()), before);
  expect_as_evaluated(variant, "variant");
  design.replace(Occurrence{2}, unit_cube(0, 0, 0));
  expect_as_evaluated(variant, "variant after a change of the original");
  expect_as_evaluated(design, "original");
  variant = design;
  EXPECT_EQ(digest(variant.boundary()), digest(design.boundary()));
}

// LAW incremental.4
TEST(Incremental, ReplacedByItself) {
  IncrementalEvaluation design(row_of_balls(8));
  const std::string before = digest(design.boundary());
  const UpdateStatistics update =
      design.replace(Occurrence{3}, Primitive(design.primitive(Occurrence{3})));
  EXPECT_EQ(update.renewed_cells, 0U);
  EXPECT_EQ(digest(design.boundary()), before);
}

TEST(Incremental, OccurrencesAreCountedFromLeftToRight) {
  const Primitive a = unit_cube(0, 0, 0);
  const Primitive b = unit_cube(2, 0, 0);
  const Solid shared = csg::unite(Solid::primitive(a), Solid::primitive(b));
  IncrementalEvaluation design(csg::subtract(shared, csg::intersect(shared, Solid::primitive(b))));
  EXPECT_EQ(design.occurrence_count(), 5U);
  EXPECT_EQ(design.occurrences_of(a), (std::vector{Occurrence{0}, Occurrence{2}}));
  EXPECT_EQ(design.occurrences_of(b), (std::vector{Occurrence{1}, Occurrence{3}, Occurrence{4}}));
  design.unite(a);
  EXPECT_EQ(design.last_occurrence(), Occurrence{5});
  // One occurrence of a shared subtree changes alone: (a u b) - ((c u b) n b) u a = a.
  design.replace(Occurrence{2}, unit_cube(9, 9, 9));
  EXPECT_EQ(exact_volume(design.boundary()), 1);
  expect_as_evaluated(design, "one occurrence");
  EXPECT_THROW(design.replace(Occurrence{6}, a), Error);
  EXPECT_THROW(design.primitive(Occurrence{6}), Error);
}

// Cells' walls were placed without regard to faces that come later.
TEST(Incremental, FacesThatComeToLieInWalls) {
  IncrementalEvaluation design(row_of_balls(12));
  const int steps = 1 << 10;
  // The walls lie between faces at dyadic fractions: many positions meet some of them.
  for (int i = 0; i < steps; i += 7) {
    const Rational x = Rational(i) / 64;
    const Primitive slab = box({x, -2, -2}, {x + Rational(1, 2), 2, 2});
    if (i % 2 == 0) {
      design.replace(Occurrence{0}, slab);
    } else {
      design.subtract(slab);
    }
  }
  expect_as_evaluated(design, "slabs");
}

ErrorId error_of(IncrementalEvaluation& design) {
  try {
    design.boundary();
  } catch (const Error& error) {
    return error.id();
  }
  return ErrorId::Usage;
}

TEST(Incremental, UnboundedSolidsHaveNoBoundary) {
  const Primitive half_space{make_half_space(0, 0, 1, 0)};
  IncrementalEvaluation design(Solid::primitive(unit_cube(0, 0, -1)));
  design.unite(half_space);
  EXPECT_EQ(error_of(design), ErrorId::UnboundedSolid);
  const Occurrence ground = design.last_occurrence();
  design.intersect(box({-3, -3, -3}, {3, 3, 3}));
  EXPECT_EQ(exact_volume(design.boundary()), 108);  // half of the box; the cube is below ground
  expect_as_evaluated(design, "ground");
  design.replace(ground, {make_half_space(0, 3, 4, -7)});
  expect_as_evaluated(design, "slope");
  IncrementalEvaluation outside(Solid::full());
  outside.subtract(unit_cube(0, 0, 0));
  EXPECT_EQ(error_of(outside), ErrorId::UnboundedSolid);
  IncrementalEvaluation full(Solid::full());
  EXPECT_EQ(error_of(full), ErrorId::UnboundedSolid);
  full.subtract(half_space);
  EXPECT_EQ(error_of(full), ErrorId::UnboundedSolid);
  full.intersect(unit_cube(0, 0, 0));
  EXPECT_EQ(exact_volume(full.boundary()), 1);
}

TEST(Incremental, MeshesAreChangedAsConvexPolytopesAre) {
  const auto as_mesh = [](const Primitive& primitive) {
    return Primitive{make_mesh(to_polyhedron(*polyhedron_of(primitive)))};
  };
  IncrementalEvaluation design(row_of_balls(4));
  design.subtract(as_mesh(ball({0, 1, 0}, 1)));
  expect_as_evaluated(design, "a mesh subtracted");
  design.replace(design.last_occurrence(), as_mesh(ball({6, 1, 0}, 2)));
  expect_as_evaluated(design, "a mesh moved");
  design.unite(as_mesh(box({-5, 0, 0}, {20, 1, 1})));
  expect_as_evaluated(design, "a mesh united");
}

// Interrupted in the middle, the change is made all the same.
TEST(Incremental, AnInterruptedChangeIsMadeLater) {
  std::optional<Progress> progress(std::in_place);
  EvaluateOptions options;
  options.progress = &*progress;
  IncrementalEvaluation design(row_of_balls(8), options);
  progress->cancel();
  EXPECT_THROW(design.subtract(box({0, 0, 0}, {20, 1, 1})), Error);
  EXPECT_EQ(design.occurrence_count(), 9U);
  EXPECT_THROW(design.boundary(), Error);
  progress.emplace();  // in the same place
  expect_as_evaluated(design, "later");
}

// What was told of beforehand takes part as if it had not been.
TEST(Incremental, AnnouncedPrimitives) {
  IncrementalEvaluation design(row_of_balls(8));
  const std::string before = digest(design.boundary());
  const std::vector near{ball({4, 1, 0}, 1), ball({12, 1, 1}, 1)};
  design.announce(near);
  EXPECT_EQ(digest(design.boundary()), before);
  EXPECT_FALSE(design.replace(Occurrence{1}, near[0]).everything);
  expect_as_evaluated(design, "announced");
  const std::vector far{ball({1000, 1, 0}, 1), near[1]};
  design.announce(far);
  expect_as_evaluated(design, "announced far away");
  EXPECT_FALSE(design.subtract(near[1]).everything);
  EXPECT_FALSE(design.unite(far[0]).everything);
  expect_as_evaluated(design, "all of them");
}

TEST(Incremental, RefusedPrimitivesChangeNothing) {
  IncrementalEvaluation design(row_of_balls(3));
  const std::string before = digest(design.boundary());
  Integer huge;
  mpz_ui_pow_ui(huge.get_mpz_t(), 10, 300);
  EXPECT_THROW(design.unite(box({0, 0, 0}, {Rational(huge), 1, 1})), Error);
  EXPECT_EQ(design.occurrence_count(), 3U);
  EXPECT_EQ(digest(design.boundary()), before);
  design.unite(unit_cube(0, 0, 0));
  expect_as_evaluated(design, "afterwards");
}

TEST(Incremental, OnSeveralThreads) {
  EvaluateOptions options;
  options.threads = 2;
  change_at_random(400, options, 10);
  IncrementalEvaluation design(row_of_balls(300), options);  // beyond the least for threads
  expect_as_evaluated(design, "many balls");
}

}  // namespace
}  // namespace exactcsg
