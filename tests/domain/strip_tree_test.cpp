// SPDX-License-Identifier: GPL-3.0-or-later
// Strip trees. Expected values: closed forms, GMP's floats of 400 bits, and comparison of every
// segment with every other in rational arithmetic.

#include "exactcsg/domain/strip_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace exactcsg::domain {
namespace {

constexpr std::size_t many = 100'000;

// A circle with waves, digitised to multiples of 2^-20.
std::vector<CurvePoint> digitised(std::size_t count, double radius, double wave, double centre_x) {
  const auto rounded = [](double value) { return std::round(value * 0x1p20) * 0x1p-20; };
  std::vector<CurvePoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double r = radius + wave * std::sin(40 * angle);
    points.push_back({rounded(centre_x + r * std::cos(angle)), rounded(r * std::sin(angle))});
  }
  points.push_back(points.front());
  return points;
}

mpf_class length_in_floats(const std::vector<CurvePoint>& points) {
  mpf_class sum(0, 400);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const mpf_class x(mpf_class(points[i].x, 400) - mpf_class(points[i - 1].x, 400), 400);
    const mpf_class y(mpf_class(points[i].y, 400) - mpf_class(points[i - 1].y, 400), 400);
    sum += sqrt(mpf_class(x * x + y * y, 400));
  }
  return sum;
}

TEST(StripTrees, LengthIsEnclosed) {
  const std::vector<CurvePoint> square{{0, 0}, {3, 0}, {3, 4}, {0, 4}, {0, 0}};
  const Enclosure fourteen = length(make_strip_tree(square), 10);
  EXPECT_EQ(fourteen.lower, 14);
  EXPECT_EQ(fourteen.upper, 14);

  const auto points = digitised(many, 100, 3, 0);
  const StripTree tree = make_strip_tree(points);
  EXPECT_EQ(tree.terminals().size(), many);
  for (const int bits : {20, 100}) {
    const Enclosure enclosure = length(tree, bits);
    EXPECT_LE(enclosure.upper - enclosure.lower,
              Rational(Integer(1), Integer(1) << static_cast<unsigned long>(bits)));
    // Rounding of the floats is below 2^-350.
    const mpf_class expected = length_in_floats(points);
    const mpf_class slack(mpf_class(1, 400) >> 300);
    EXPECT_LE(mpf_class(enclosure.lower, 400), expected + slack);
    EXPECT_GE(mpf_class(enclosure.upper, 400), expected - slack);
  }
}

TEST(StripTrees, StripsHoldTheirPartsAndDepthIsLogarithmic) {
  const auto points = digitised(many, 100, 3, 0);
  const StripTree tree = make_strip_tree(points);
  const auto expect_holds = [&](const Strip& strip) {
    ASSERT_EQ(strip.begin, points[strip.first]);
    ASSERT_EQ(strip.end, points[strip.last]);
    const std::uint32_t step = std::max<std::uint32_t>(1, (strip.last - strip.first) / 7);
    for (std::uint32_t i = strip.first; i <= strip.last; i += step) {
      const Rational x = rational_of(points[i].x) - rational_of(strip.begin.x);
      const Rational y = rational_of(points[i].y) - rational_of(strip.begin.y);
      const Rational dx(strip.direction.x);
      const Rational dy(strip.direction.y);
      const Rational along = dx * x + dy * y;
      const Rational across = dx * y - dy * x;
      ASSERT_LE(strip.along_low, along);
      ASSERT_LE(along, strip.along_high);
      ASSERT_LE(strip.across_low, across);
      ASSERT_LE(across, strip.across_high);
      ASSERT_LE(strip.lower.x, points[i].x);
      ASSERT_LE(points[i].y, strip.upper.y);
    }
  };
  struct Open {
    StripTree::Node node;
    int depth;
  };
  std::vector<Open> pending{{tree.root(), 0}};
  while (!pending.empty()) {
    const Open open = pending.back();
    pending.pop_back();
    ASSERT_LE(open.depth, 17);  // 2^17 > 100 000
    if (open.node.is_terminal()) {
      expect_holds(open.node.terminal());
      continue;
    }
    expect_holds(open.node.label());
    for (std::size_t i = 0; i < 2; ++i) pending.push_back({open.node.child(i), open.depth + 1});
  }
}

// By comparing with every segment, in rationals: even-odd along a ray upwards (the library's goes
// to the right), shifted by an infinitesimal to the right.
PointClass class_by_all_segments(const std::vector<CurvePoint>& points, const Coordinates<2>& p) {
  bool odd = false;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Rational ax(points[i - 1].x);
    const Rational ay(points[i - 1].y);
    const Rational bx(points[i].x);
    const Rational by(points[i].y);
    if (ax == bx) {
      if (p[0] == ax && std::min(ay, by) <= p[1] && p[1] <= std::max(ay, by)) {
        return PointClass::On;
      }
      continue;
    }
    if (p[0] < std::min(ax, bx) || std::max(ax, bx) < p[0]) continue;
    const Rational y = ay + (by - ay) * (p[0] - ax) / (bx - ax);
    if (y == p[1]) return PointClass::On;
    if (p[0] < std::max(ax, bx) && y > p[1]) odd = !odd;
  }
  return odd ? PointClass::In : PointClass::Out;
}

TEST(StripTrees, PointsAgreeWithAllSegmentsOnWildCurves) {
  std::mt19937 random(4);
  const auto pick = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  int on = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<CurvePoint> points;
    const int count = pick(3, 40);
    while (static_cast<int>(points.size()) < count) {
      const CurvePoint p{static_cast<double>(pick(-4, 4)), static_cast<double>(pick(-4, 4))};
      if (points.empty() || !(p == points.back())) points.push_back(p);
    }
    if (!(points.back() == points.front())) points.push_back(points.front());
    const StripTree tree = make_strip_tree(points);
    for (int k = 0; k < 100; ++k) {
      Coordinates<2> p{Rational(pick(-10, 10), 2), Rational(pick(-10, 10), 2)};
      for (Rational& value : p) value.canonicalize();
      if (k % 3 == 0) p[0] += Rational(1, Integer(1) << 100);
      const PointClass expected = class_by_all_segments(points, p);
      ASSERT_EQ(classify(tree, Point<2>(p)), expected) << "round " << round;
      ASSERT_EQ(contains(tree, Point<2>(p)), expected == PointClass::On);
      if (expected == PointClass::On) ++on;
    }
  }
  EXPECT_GT(on, 500);
}

TEST(StripTrees, PointsOfALongCurve) {
  const auto points = digitised(many, 100, 3, 0);
  const StripTree tree = make_strip_tree(points);
  EXPECT_EQ(classify(tree, Point<2>(0, 0)), PointClass::In);
  EXPECT_EQ(classify(tree, Point<2>(200, 0)), PointClass::Out);
  const Rational tiny(Integer(1), Integer(1) << 200);
  for (std::size_t i = 0; i < many; i += 997) {
    // The middle of a segment, and next to it: a star round the origin, so inwards is In.
    const Rational x = (Rational(points[i].x) + Rational(points[i + 1].x)) / 2;
    const Rational y = (Rational(points[i].y) + Rational(points[i + 1].y)) / 2;
    ASSERT_EQ(classify(tree, Point<2>(x, y)), PointClass::On);
    const Rational in = 1 - tiny;
    const Rational out = 1 + tiny;
    ASSERT_EQ(classify(tree, Point<2>(Rational(x * in), Rational(y * in))), PointClass::In);
    ASSERT_EQ(classify(tree, Point<2>(Rational(x * out), Rational(y * out))), PointClass::Out);
  }
}

// Whether two segments meet, and where, from the orientations of their ends; written for the test.
bool meet(const CurvePoint& a, const CurvePoint& b, const CurvePoint& c, const CurvePoint& d) {
  const auto side = [](const CurvePoint& p, const CurvePoint& q, const CurvePoint& r) {
    const double value = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);  // small integers
    return value > 0 ? 1 : value < 0 ? -1 : 0;
  };
  const auto in_box = [](const CurvePoint& p, const CurvePoint& q, const CurvePoint& r) {
    return std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= r.y &&
           r.y <= std::max(p.y, q.y);
  };
  const int abc = side(a, b, c);
  const int abd = side(a, b, d);
  const int cda = side(c, d, a);
  const int cdb = side(c, d, b);
  if (abc != abd && cda != cdb && abc * abd <= 0 && cda * cdb <= 0) return true;
  return (abc == 0 && in_box(a, b, c)) || (abd == 0 && in_box(a, b, d)) ||
         (cda == 0 && in_box(c, d, a)) || (cdb == 0 && in_box(c, d, b));
}

TEST(StripTrees, IntersectionsAgreeWithAllPairs) {
  std::mt19937 random(6);
  const auto curve = [&] {
    std::vector<CurvePoint> points;
    while (points.size() < 30) {
      const CurvePoint p{double(std::uniform_int_distribution<int>(-9, 9)(random)),
                         double(std::uniform_int_distribution<int>(-9, 9)(random))};
      if (points.empty() || !(p == points.back())) points.push_back(p);
    }
    return points;
  };
  const auto on = [](const std::vector<CurvePoint>& points, std::uint32_t segment,
                     const Point<2>& p) {
    const std::vector<CurvePoint> one{points[segment], points[segment + 1]};
    return class_by_all_segments(one, p.coordinates()) == PointClass::On;
  };
  for (int round = 0; round < 50; ++round) {
    const auto first = curve();
    const auto second = curve();
    const auto found = intersection(make_strip_tree(first), make_strip_tree(second));
    auto next = found.begin();
    for (std::uint32_t i = 0; i + 1 < first.size(); ++i) {
      for (std::uint32_t k = 0; k + 1 < second.size(); ++k) {
        if (!meet(first[i], first[i + 1], second[k], second[k + 1])) continue;
        ASSERT_NE(next, found.end());
        ASSERT_EQ(next->first, i);
        ASSERT_EQ(next->second, k);
        for (const Point<2>& p : {next->from, next->to}) {
          ASSERT_TRUE(on(first, i, p));
          ASSERT_TRUE(on(second, k, p));
        }
        ++next;
      }
    }
    ASSERT_EQ(next, found.end());
  }
}

TEST(StripTrees, OverlapsAreReportedWhole) {
  const std::vector<CurvePoint> first{{0, 0}, {4, 4}};
  const std::vector<CurvePoint> second{{6, 6}, {1, 1}};
  const auto found = intersection(make_strip_tree(first), make_strip_tree(second));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].from, Point<2>(1, 1));
  EXPECT_EQ(found[0].to, Point<2>(4, 4));
}

TEST(StripTrees, IntersectionOfLongCurves) {
  // Circles of radius 100 at the distance 120 meet at x = 60, y = +-80, up to their digits.
  const auto first = digitised(many, 100, 0, 0);
  const auto second = digitised(many, 100, 0, 120);
  const auto found = intersection(make_strip_tree(first), make_strip_tree(second));
  ASSERT_EQ(found.size(), 2U);
  for (const CurveMeeting& meeting : found) {
    EXPECT_NEAR(meeting.from[0].get_d(), 60, 1e-4);
    EXPECT_NEAR(std::abs(meeting.from[1].get_d()), 80, 1e-4);
  }
}

TEST(StripTrees, SimplifiedLinesAreWithinTheTolerance) {
  const auto points = digitised(many, 100, 3, 0);
  const StripTree tree = make_strip_tree(points);
  std::size_t before = points.size();
  for (const double tolerance : {1e-6, 1e-3, 1e-1, 10.0}) {
    const auto kept = simplified(tree, tolerance);
    EXPECT_EQ(kept.front(), 0U);
    EXPECT_EQ(kept.back(), many);
    EXPECT_LT(kept.size(), before);
    before = kept.size();
    for (std::size_t i = 1; i < kept.size(); ++i) {
      const CurvePoint a = points[kept[i - 1]];
      const CurvePoint b = points[kept[i]];
      for (std::uint32_t k = kept[i - 1]; k <= kept[i]; k += 3) {
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        const CurvePoint offset{points[k].x - a.x, points[k].y - a.y};
        const double along =
            std::clamp((offset.x * (b.x - a.x) + offset.y * (b.y - a.y)) / length, 0.0, length);
        const double distance = std::hypot(offset.x - along * (b.x - a.x) / length,
                                           offset.y - along * (b.y - a.y) / length);
        ASSERT_LE(distance, tolerance * (1 + 1e-9) + 1e-12);
      }
    }
  }
  EXPECT_EQ(simplified(tree, 0).size(), points.size());
}

TEST(StripTrees, BadCurvesAreRefused) {
  const auto refused = [](const std::vector<CurvePoint>& points) {
    try {
      make_strip_tree(points);
    } catch (const Error& error) {
      return error.id() == ErrorId::BadArgument;
    }
    return false;
  };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused({{1, 1}}));
  EXPECT_TRUE(refused({{1, 1}, {1, 1}}));
  EXPECT_TRUE(refused({{1, 1}, {std::nan(""), 1}}));
  const StripTree open = make_strip_tree(std::vector<CurvePoint>{{0, 0}, {1, 1}});
  EXPECT_THROW(classify(open, Point<2>(0, 0)), Error);
  EXPECT_TRUE(contains(open, Point<2>(Rational(1, 2), Rational(1, 2))));
}

}  // namespace
}  // namespace exactcsg::domain
