// SPDX-License-Identifier: GPL-3.0-or-later
// A user's own domain, intervals of the real line, in the algorithms on trees; and half-spaces of a
// dimension that the library has no primitives for. Expected values: the definition of the sets.

#include <gtest/gtest.h>

#include "exactcsg/domain/ball.hpp"
#include "exactcsg/domain/classify.hpp"

namespace exactcsg::domain {

// [low, high] or the closure of its complement
struct Interval {
  static constexpr std::size_t dimension = 1;
  Rational low;
  Rational high;
  bool is_complement = false;
};

PointClass classify(const Interval& i, const Point<1>& x) {
  const PointClass inside = x[0] < i.low || i.high < x[0]     ? PointClass::Out
                            : x[0] == i.low || x[0] == i.high ? PointClass::On
                                                              : PointClass::In;
  return i.is_complement ? complement(inside) : inside;
}
csg::Membership classify(const Interval& i, const Box<1>& box) {
  using enum csg::Membership;
  if (box.upper()[0] <= i.low || i.high <= box.lower()[0]) return i.is_complement ? In : Out;
  if (i.low <= box.lower()[0] && box.upper()[0] <= i.high) return i.is_complement ? Out : In;
  return Unknown;
}
Interval complement(Interval i) {
  i.is_complement = !i.is_complement;
  return i;
}
Section section(const Interval& i, const LineSection<1>& line) {
  std::vector<Rational> bounds{(i.low - line.origin[0]) / line.direction[0],
                               (i.high - line.origin[0]) / line.direction[0]};
  std::sort(bounds.begin(), bounds.end());
  Section result;
  for (const Rational& t : bounds) {
    if ((line.begin && t <= *line.begin) || (line.end && t >= *line.end)) continue;
    result.crossings.push_back({QuadraticNumber(t), 1});
  }
  for (std::size_t k = 0; k <= result.crossings.size(); ++k) {
    result.between.push_back(
        classify(i, line.at(detail::parameter_between(result.crossings, k, line.begin, line.end))));
  }
  return result;
}
static_assert(Domain<Interval>);

namespace {

using Intervals = csg::BooleanTree<Interval>;
using csg::Membership;

Intervals interval(int low, int high) { return Intervals::primitive({low, high}); }
Point<1> number(const Rational& x) { return Point<1>(Coordinates<1>{x}); }

TEST(UserDomains, IntervalsAreClassifiedInTrees) {
  const Intervals set = csg::subtract(interval(0, 10), interval(3, 4));
  EXPECT_EQ(classify(set, number(1)), PointClass::In);
  EXPECT_EQ(classify(set, number(3)), PointClass::On);
  EXPECT_EQ(classify(set, number(Rational(7, 2))), PointClass::Out);
  EXPECT_EQ(classify(set, Box<1>(number(4), number(10))), Membership::In);
  EXPECT_EQ(classify(set, Box<1>(number(3), number(4))), Membership::Out);
  EXPECT_EQ(classify(set, Box<1>(number(3), number(5))), Membership::Unknown);
  const Section found = section(set, whole_line<1>(number(0), {2}));
  ASSERT_EQ(found.crossings.size(), 4U);
  EXPECT_EQ(found.crossings[1].parameter, QuadraticNumber(Rational(3, 2)));
  EXPECT_EQ(found.between, (std::vector{PointClass::Out, PointClass::In, PointClass::Out,
                                        PointClass::In, PointClass::Out}));
}

TEST(UserDomains, CommonBoundariesAreRefusedByName) {
  const Intervals touching = csg::unite(interval(0, 1), interval(1, 2));
  EXPECT_EQ(classify(touching, number(2)), PointClass::On);
  try {
    classify(touching, number(1));
    FAIL() << "the library knows no neighbourhoods of intervals";
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::UndecidedNeighbourhood);
  }
}

TEST(UserDomains, BallsOfFourDimensions) {
  using Solid4 = csg::BooleanTree<HalfSpace<4>>;
  const HalfSpace<4> ball = make_ball<4>({0, 0, 0, 0}, 4);
  const Solid4 shell =
      csg::subtract(Solid4::primitive(ball), Solid4::primitive(make_ball<4>({0, 0, 0, 0}, 1)));
  EXPECT_EQ(classify(shell, Point<4>(1, 1, 1, 1)), PointClass::On);
  EXPECT_EQ(classify(shell, Point<4>(1, 1, 1, 0)), PointClass::In);
  EXPECT_EQ(classify(shell, Point<4>(0, 0, 0, 0)), PointClass::Out);
  EXPECT_EQ(classify(ball, Box<4>({-1, -1, -1, -1}, {1, 1, 1, 1})), Membership::In);
  EXPECT_EQ(classify(ball, Box<4>({1, 1, 1, 1}, {2, 2, 2, 2})), Membership::Out);
  EXPECT_EQ(section(shell, ray<4>({0, 0, 0, 0}, {1, 1, 1, 1})).crossings.size(), 2U);
}

}  // namespace
}  // namespace exactcsg::domain
