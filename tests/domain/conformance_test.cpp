// SPDX-License-Identifier: GPL-3.0-or-later
// The conformance suite: every row of rows.hpp against the laws of half_space.hpp. Expected values
// are the rows' definitions in plain rational arithmetic.

#include <gtest/gtest.h>

#include "domain/laws.hpp"

namespace exactcsg::domain::test {
namespace {

template <class Row>
class Conformance : public testing::Test {};

template <class Tuple>
struct TypesOf;
template <class... Row>
struct TypesOf<std::tuple<Row...>> {
  using type = testing::Types<Row...>;
};
struct NameOfRow {
  template <class Row>
  static std::string GetName(int) {
    return Row::name;
  }
};
TYPED_TEST_SUITE(Conformance, TypesOf<Rows>::type, NameOfRow);

TYPED_TEST(Conformance, PointsEqualPureRationalEvaluation) {
  Random random(1);
  int on = 0;
  for (int i = 0; i < 100; ++i) {
    const auto sample = TypeParam::sample(random);
    for (int k = 0; k < 10; ++k) {
      const auto point = nearby(TypeParam::degenerate_point(sample, random), random);
      if (sample.reference(point) == PointClass::On) ++on;
      ASSERT_NO_FATAL_FAILURE(expect_equals_reference(sample, point));
      ASSERT_NO_FATAL_FAILURE(
          expect_equals_reference(sample, random.template coordinates<TypeParam::dimension>()));
    }
  }
  EXPECT_GT(on, 100) << "the points were meant to be degenerate";
}

TYPED_TEST(Conformance, MapsCommuteWithClassification) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const auto sample = TypeParam::sample(random);
    const AffineMap map = random_map(random, TypeParam::dimension);
    const auto image = apply(map, sample.set);
    for (int k = 0; k < 5; ++k) {
      const Point<TypeParam::dimension> point(
          nearby(TypeParam::degenerate_point(sample, random), random));
      ASSERT_EQ(classify(image, apply(map, point)), sample.reference(point.coordinates()));
    }
  }
}

TYPED_TEST(Conformance, BoxesTellOfTheirPoints) {
  Random random(3);
  int known = 0;
  for (int i = 0; i < 300; ++i) {
    const auto sample = TypeParam::sample(random);
    const auto box = random.template box<TypeParam::dimension>();
    if (classify(sample.set, box) != csg::Membership::Unknown) ++known;
    ASSERT_NO_FATAL_FAILURE(expect_box_tells_of_points(sample, box, random));
  }
  EXPECT_GT(known, 30);
}

TYPED_TEST(Conformance, MixedBoxesAreMixed) {
  Random random(4);
  int mixed = 0;
  if (!TypeParam::is_exact_for_boxes) return;
  for (int i = 0; i < 80; ++i) {
    const auto sample = TypeParam::sample(random);
    const auto box = random.template box<TypeParam::dimension>();
    if (classify(sample.set, box) != csg::Membership::Unknown) continue;
    ++mixed;
    ASSERT_EQ(class_by_search(sample, box, random, std::less<>{}), PointClass::In) << i;
    ASSERT_EQ(class_by_search(sample, box, random, std::greater<>{}), PointClass::Out) << i;
  }
  EXPECT_GT(mixed, 4);
}

TYPED_TEST(Conformance, CrossingsSeparateTheClasses) {
  Random random(5);
  std::size_t crossings = 0;
  for (int i = 0; i < 150; ++i) {
    const auto sample = TypeParam::sample(random);
    const auto line = random_line(sample.boundary_point, random);
    crossings += section(sample.set, line).crossings.size();
    ASSERT_NO_FATAL_FAILURE(expect_section_separates(sample, line));
  }
  EXPECT_GT(crossings, 30U);
}

}  // namespace
}  // namespace exactcsg::domain::test
