// SPDX-License-Identifier: GPL-3.0-or-later
// Integrals over what curves leave of a square. Expected values: polygons clipped exactly, and
// closed forms of what parabolas leave.

#include "exactcsg/measure/strip_integral.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <utility>

namespace exactcsg::measure::detail {
namespace {

using csg::Membership;
using Corner = std::pair<Rational, Rational>;

// c + p x + q y
struct Line {
  Rational c;
  Rational p;
  Rational q;
  Rational operator()(const Corner& at) const { return c + p * at.first + q * at.second; }
};

// What is left of a convex polygon where the line is positive.
std::vector<Corner> clipped(const std::vector<Corner>& polygon, const Line& line) {
  std::vector<Corner> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& from = polygon[i];
    const Corner& to = polygon[(i + 1) % polygon.size()];
    const Rational at_from = line(from);
    const Rational at_to = line(to);
    if (at_from >= 0) result.push_back(from);
    if (at_from * at_to < 0) {
      const Rational share = at_from / (at_from - at_to);
      result.emplace_back(from.first + share * (to.first - from.first),
                          from.second + share * (to.second - from.second));
    }
  }
  return result;
}
Rational twice_area(const std::vector<Corner>& polygon) {
  Rational sum;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    sum += a.first * b.second - a.second * b.first;
  }
  return sum;
}

SquareModel model(std::initializer_list<std::pair<std::pair<int, int>, double>> terms) {
  Series c{};
  for (const auto& term : terms) {
    c[static_cast<std::size_t>(term.first.first)][static_cast<std::size_t>(term.first.second)] =
        exactly(term.second);
  }
  return SquareModel(c);
}
SquareModel model(const Line& line) {
  Series c{};
  c[0][0] = certified_double_of(line.c);
  c[1][0] = certified_double_of(line.p);
  c[0][1] = certified_double_of(line.q);
  return SquareModel(c);
}

bool encloses(const CertifiedDouble& x, const Rational& expected) {
  return abs(Rational(rational_of(x.value) - expected)) <= rational_of(x.error);
}

Line random_line() {
  const auto number = [](int low, int high) -> Rational {
    return Rational(*rc::gen::inRange(low, high + 1)) / 8;
  };
  Line line{number(-12, 12), number(-8, 8), number(-16, 16)};
  if (abs(line.q) < abs(line.p) || line.q == 0) line.q = 2;
  return line;
}

// What lines leave of the square, where all of them are positive.
struct LeftOfSquare {
  Rational area;  // by clipping
  std::optional<CertifiedDouble> integral;
};
std::optional<LeftOfSquare> left_of_square(const std::vector<Line>& lines) {
  std::vector<Corner> polygon{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  std::vector<Curve> curves;
  for (const Line& line : lines) {
    polygon = clipped(polygon, line);
    const SquareModel d = model(line);
    const std::optional<Curve> curve = curve_of(d, d.c[0][1]);
    if (!curve) return std::nullopt;
    curves.push_back(*curve);
  }
  const auto all_positive = [&](const std::vector<bool>& above) {
    for (std::size_t k = 0; k < curves.size(); ++k) {
      if (above[k] != curves[k].is_rising) return Membership::Out;
    }
    return Membership::In;
  };
  const SquareModel one = model({{{0, 0}, 1.0}});
  return LeftOfSquare{twice_area(polygon) / 2, integral_over_strips(one, curves, all_positive)};
}

RC_GTEST_PROP(StripIntegral, LinesLeaveConvexPolygons, ()) {
  std::vector<Line> lines;
  const int count = *rc::gen::inRange(1, 5);
  for (int i = 0; i < count; ++i) lines.push_back(random_line());
  const std::optional<LeftOfSquare> left = left_of_square(lines);
  RC_PRE(left.has_value());
  RC_ASSERT(left->integral.has_value());
  RC_ASSERT(encloses(*left->integral, left->area));
  RC_ASSERT(left->integral->error < 1e-12);
}

// The zero of the chord, rounded, is an end of the interval in which these lines cross.
TEST(StripIntegral, CrossingsAreFoundWhereTheirGuessIsRounded) {
  const auto eighths = [](int c, int p, int q) {
    return Line{Rational(c, 8), Rational(p, 8), Rational(q, 8)};
  };
  for (const auto& lines : {std::vector{eighths(-7, -1, -12), eighths(1, 2, 2)},
                            std::vector{eighths(3, -7, -11), eighths(-5, -8, -7)}}) {
    const std::optional<LeftOfSquare> left = left_of_square(lines);
    ASSERT_TRUE(left.has_value());
    ASSERT_TRUE(left->integral.has_value());
    EXPECT_TRUE(encloses(*left->integral, left->area));
    EXPECT_LT(left->integral->error, 1e-12);
  }
}

// Above y = x^2 - 1/4, the integral of 1 + y: 5/2 - 2/3 of the one; of the other that of
// (1 - (x^2 - 1/4)^2) / 2, which is 1 - 1/5 + 1/6 - 1/16.
TEST(StripIntegral, AParabolaWithADensity) {
  const SquareModel d = model({{{0, 1}, 1.0}, {{2, 0}, -1.0}, {{0, 0}, 0.25}});
  const std::optional<Curve> curve = curve_of(d, exactly(1));
  ASSERT_TRUE(curve.has_value());
  const SquareModel density = model({{{0, 0}, 1.0}, {{0, 1}, 1.0}});
  const auto integral = integral_over_strips(density, {*curve}, [](const std::vector<bool>& above) {
    return above[0] ? Membership::In : Membership::Out;
  });
  ASSERT_TRUE(integral.has_value());
  EXPECT_TRUE(encloses(*integral, Rational(5, 2) - Rational(2, 3) + 1 - Rational(1, 5) +
                                      Rational(1, 6) - Rational(1, 16)));
  EXPECT_LT(integral->error, 1e-13);
}

// y = x^2 leaves the square at neither side; where nothing is known, any part of it may count.
TEST(StripIntegral, UnknownStripsCountFromNoneToAll) {
  const SquareModel d = model({{{0, 1}, 1.0}, {{2, 0}, -1.0}});
  const std::optional<Curve> curve = curve_of(d, exactly(1));
  ASSERT_TRUE(curve.has_value());
  const auto integral =
      integral_over_strips(model({{{0, 0}, 1.0}}), {*curve}, [](const std::vector<bool>& above) {
        return above[0] ? Membership::Unknown : Membership::Out;
      });
  ASSERT_TRUE(integral.has_value());
  EXPECT_TRUE(encloses(*integral, 0));
  EXPECT_TRUE(encloses(*integral, Rational(4, 3)));
  EXPECT_FALSE(encloses(*integral, Rational(7, 5)));
}

// The curve is known as well as the function, divided by its slope.
TEST(StripIntegral, ARemainderOfTheFunctionIsOneOfTheCurve) {
  SquareModel d = model({{{0, 1}, -2.0}, {{1, 0}, 1.0}});
  d.remainder = 1e-3;
  const std::optional<Curve> curve = curve_of(d, exactly(-2));
  ASSERT_TRUE(curve.has_value());
  EXPECT_FALSE(curve->is_rising);
  EXPECT_GE(curve->reach, 5e-4);
  EXPECT_LT(curve->reach, 6e-4);
  EXPECT_FALSE(curve_of(d, CertifiedDouble{-1, 2}).has_value());
}

}  // namespace
}  // namespace exactcsg::measure::detail
