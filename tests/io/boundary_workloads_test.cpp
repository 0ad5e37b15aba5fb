// SPDX-License-Identifier: GPL-3.0-or-later
// The workloads that boundary evaluators are compared on: as text and as a solid the same model,
// with the figures that closed forms give.

#include "bench/boundary/workloads.hpp"

#include <gtest/gtest.h>

#include "exactcsg/io/mesh/solid_of_boundary.hpp"
#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"

namespace exactcsg::bench {
namespace {

struct Case {
  const char* name;
  std::size_t size;
};

class BoundaryWorkload : public testing::TestWithParam<Case> {
 protected:
  Workload workload() const { return make_workload(GetParam().name, GetParam().size); }
};

TEST_P(BoundaryWorkload, TextAndSolidAreTheSameModel) {
  const Model model = workload().model;
  const io::Model read = io::read_openscad_csg(csg_of(model), "workload.csg");
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_EQ(digest(evaluate(read.solid)), digest(evaluate(solid_of(model))));
}

// The closed forms are derived where the workloads are made.
TEST_P(BoundaryWorkload, HasTheFiguresOfItsClosedForm) {
  const Workload made = workload();
  const Boundary boundary = evaluate(solid_of(made.model));
  if (boundary.empty()) {
    EXPECT_EQ(made.expected.volume, Rational(0));
    return;
  }
  if (made.expected.volume) {
    EXPECT_EQ(exact_volume(boundary), made.expected.volume);
  }
  if (made.expected.area) {
    EXPECT_EQ(exact_area(boundary), made.expected.area);
  }
  if (made.expected.genus) {
    EXPECT_EQ(topology(boundary).genus, *made.expected.genus);
  }
  if (made.expected.counts) {
    const std::array<std::uint64_t, 3> counts{boundary.vertices.size(), boundary.edges.size(),
                                              boundary.faces.size()};
    EXPECT_EQ(counts, *made.expected.counts);
  }
}

// LAW leaf.1
TEST_P(BoundaryWorkload, IsTheSameSolidAsALeafAgain) {
  const Boundary boundary = evaluate(solid_of(workload().model));
  EXPECT_EQ(digest(evaluate(io::solid_of_boundary(boundary))), digest(boundary));
}

INSTANTIATE_TEST_SUITE_P(
    Small, BoundaryWorkload,
    testing::Values(Case{"spheres", 5}, Case{"menger", 2}, Case{"drilled_block", 3},
                    Case{"capsules", 10}, Case{"meshes", 8}, Case{"turned_cubes", 1},
                    Case{"turned_cubes", 15}, Case{"cube_sequence", 2}, Case{"shuffled_cubes", 2}),
    [](const auto& tested) {
      return std::string(tested.param.name) + "_" + std::to_string(tested.param.size);
    });

// Every intermediate result is a leaf of the next operation. Volume and area are counted on the
// grid; in a random order the cubes touch at edges and vertices alone.
TEST(CubeSequence, EveryIntermediateResultIsRight) {
  constexpr std::size_t side = 3;
  const CubeSequence sequence = shuffled_cubes(side);
  const std::vector<GridFigures> expected = expected_figures(sequence, side);
  PrimitiveMaker primitive_of;
  Solid solid;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool unites = i < sequence.united.size();
    const auto& place =
        unites ? sequence.united[i] : sequence.subtracted[i - sequence.united.size()];
    const Solid cube = Solid::primitive(primitive_of(cube_at(place).primitive()));
    const Boundary boundary =
        evaluate(unites ? csg::unite(solid, cube) : csg::subtract(solid, cube));
    if (!boundary.empty()) {
      ASSERT_EQ(exact_volume(boundary), Rational(expected[i].volume)) << "operation " << i;
      ASSERT_EQ(exact_area(boundary), Rational(expected[i].area)) << "operation " << i;
    }
    ASSERT_EQ(boundary.empty(), expected[i].volume == 0);
    solid = io::solid_of_boundary(boundary);
  }
  EXPECT_TRUE(solid.is_empty());
}

TEST(DecimalText, IsTheNumberWithAllItsDigits) {
  EXPECT_EQ(decimal_text(Rational(-3, 8)), "-0.375");
  EXPECT_EQ(decimal_text(Rational(12)), "12");
  EXPECT_EQ(decimal_text(Rational(1, 50)), "0.02");
  EXPECT_EQ(decimal_text(Rational(0)), "0");
  EXPECT_THROW(decimal_text(Rational(1, 3)), std::logic_error);
}

}  // namespace
}  // namespace exactcsg::bench
