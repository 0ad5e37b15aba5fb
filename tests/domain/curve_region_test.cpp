// SPDX-License-Identifier: GPL-3.0-or-later
// What the conformance suite cannot ask of every domain: boxes, and curves in CSG trees.

#include "exactcsg/domain/curve_region.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "domain/rows.hpp"
#include "exactcsg/domain/classify.hpp"

namespace exactcsg::domain {
namespace {

// The square from 0 to 4 with a notch that is 1 wide and 3 deep.
CurveRegion notched_square() {
  return CurveRegion(make_strip_tree(std::vector<CurvePoint>{
      {0, 0}, {4, 0}, {4, 4}, {2.5, 4}, {2.5, 1}, {1.5, 1}, {1.5, 4}, {0, 4}, {0, 0}}));
}

Box<2> box_of(const Rational& x0, const Rational& y0, const Rational& x1, const Rational& y1) {
  return {Point<2>(x0, y0), Point<2>(x1, y1)};
}

// By the geometry of the notched square.
TEST(CurveRegion, BoxesTouchWithoutBeingMixed) {
  const CurveRegion square = notched_square();
  using enum csg::Membership;
  EXPECT_EQ(classify(square, box_of(0, 0, 4, 1)), In);
  EXPECT_EQ(classify(square, box_of({3, 2}, 1, {5, 2}, 4)), Out);
  EXPECT_EQ(classify(square, box_of(4, 0, 5, 4)), Out);
  EXPECT_EQ(classify(square, box_of(1, 3, 2, 5)), Unknown);
  EXPECT_EQ(classify(square, box_of(0, 0, 4, {1001, 1000})), Unknown);
  EXPECT_EQ(classify(square, box_of(-1, -1, 5, 5)), Unknown);
  EXPECT_EQ(classify(complement(square), box_of(0, 0, 4, 1)), Out);
}

// A box is mixed iff one of a fine grid of inner points differs from another: the corners of the
// polygons lie on quarters, so that of a mixed box with bounds on quarters some point of the
// sixteenths shows it, or is On.
TEST(CurveRegion, BoxesAreExact) {
  test::Random random(11);
  int mixed = 0;
  for (int i = 0; i < 60; ++i) {
    const auto sample = test::StripTreeRow::sample(random);
    const Rational x = Rational(random.integer(-12, 12)) / 4;
    const Rational y = Rational(random.integer(-12, 12)) / 4;
    const Box<2> box = box_of(x, y, x + Rational(random.integer(1, 4)) / 4,
                              y + Rational(random.integer(1, 4)) / 4);
    std::array<int, 3> counts{};
    for (int a = 1; a < 32; ++a) {
      for (int b = 1; b < 32; ++b) {
        const Coordinates<2> at{
            Rational(box.lower()[0] + Rational(a, 32) * (box.upper()[0] - box.lower()[0])),
            Rational(box.lower()[1] + Rational(b, 32) * (box.upper()[1] - box.lower()[1]))};
        ++counts[static_cast<std::size_t>(sample.reference(at))];
      }
    }
    const csg::Membership found = classify(sample.set, box);
    const bool shows_both = counts[1] > 0 || (counts[0] > 0 && counts[2] > 0);
    if (shows_both) {
      ++mixed;
      EXPECT_EQ(found, csg::Membership::Unknown) << i;
    }
    if (found == csg::Membership::In) {
      EXPECT_EQ(counts[2], 31 * 31) << i;
    }
    if (found == csg::Membership::Out) {
      EXPECT_EQ(counts[0], 31 * 31) << i;
    }
  }
  EXPECT_GT(mixed, 5);
}

// The line y = 2 passes 0, 1.5, 2.5 and 4; the line y = 1 runs along the bottom of the notch.
TEST(CurveRegion, LinesThroughTheNotch) {
  const CurveRegion square = notched_square();
  using enum PointClass;
  const Section through = section(square, whole_line(Point<2>(0, 2), {Rational(1), Rational(0)}));
  ASSERT_EQ(through.crossings.size(), 4U);
  const std::array<Rational, 4> expected{Rational(0), Rational(3, 2), Rational(5, 2), Rational(4)};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(through.crossings[i].parameter == QuadraticNumber(expected[i]));
    EXPECT_EQ(through.crossings[i].multiplicity, 1);
  }
  EXPECT_EQ(through.between, (std::vector<PointClass>{Out, In, Out, In, Out}));
  const Section along = section(square, whole_line(Point<2>(0, 1), {Rational(1), Rational(0)}));
  EXPECT_EQ(along.between, (std::vector<PointClass>{Out, In, On, In, Out}));
}

TEST(CurveRegion, OpenCurvesAndSingularMapsAreRefused) {
  const auto id_of = [](const auto& work) {
    try {
      work();
    } catch (const Error& error) {
      return error.id();
    }
    return ErrorId::InternalError;
  };
  EXPECT_EQ(id_of([] {
              CurveRegion(make_strip_tree(std::vector<CurvePoint>{{0, 0}, {1, 0}}));
            }),
            ErrorId::BadArgument);
  AffineMap flat = AffineMap::identity();
  flat.m[0][0] = 0;
  EXPECT_EQ(id_of([&] { apply(flat, notched_square()); }), ErrorId::SingularMap);
}

}  // namespace
}  // namespace exactcsg::domain
