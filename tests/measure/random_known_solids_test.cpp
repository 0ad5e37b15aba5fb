// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes and areas of random solids. Expected values: inclusion and exclusion of balls with the
// closed form of lenses, caps and zones, and random points.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <random>

#include "exactcsg/domain/classify.hpp"
#include "exactcsg/measure/area.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

using std::numbers::pi;

struct Ball {
  std::array<double, 3> centre{};
  double radius = 0;
  Solid3 set = Solid3::empty();
};
// Of a radius between 1/4 and 1; coordinates are twelfths.
Ball random_ball(int reach) {
  Ball ball;
  Coordinates<3> centre;
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = random_rational(-reach, reach);
    ball.centre[i] = nearest_double(centre[i]);
  }
  const Rational radius = Rational(*rc::gen::inRange(3, 13)) / 12;
  ball.radius = nearest_double(radius);
  ball.set = test::ball(centre, Rational(radius * radius));
  return ball;
}
double volume_of(const Ball& ball) { return 4 * pi / 3 * ball.radius * ball.radius * ball.radius; }
double area_of(const Ball& ball) { return 4 * pi * ball.radius * ball.radius; }

// What two balls have in common.
struct Lens {
  double volume = 0;
  double area_of_first = 0;  // of the first one's sphere, in the second
  double area_of_second = 0;
};
Lens lens(const Ball& a, const Ball& b) {
  const double d =
      std::hypot(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1], a.centre[2] - b.centre[2]);
  if (d >= a.radius + b.radius) return {};
  if (d + a.radius <= b.radius) return {volume_of(a), area_of(a), 0};
  if (d + b.radius <= a.radius) return {volume_of(b), 0, area_of(b)};
  // The plane of the common circle is at (d^2 + a^2 - b^2) / 2d from the first centre; a cap of
  // height h has the volume pi h^2 (3 r - h) / 3 and the area 2 pi r h.
  const double difference = (a.radius - b.radius) * (a.radius + b.radius);
  const double h_a = a.radius - (d * d + difference) / (2 * d);
  const double h_b = b.radius - (d * d - difference) / (2 * d);
  const auto cap = [](double r, double h) { return pi * h * h * (3 * r - h) / 3; };
  return {cap(a.radius, h_a) + cap(b.radius, h_b), 2 * pi * a.radius * h_a,
          2 * pi * b.radius * h_b};
}

constexpr double width = 1e-4;

// Lenses that are thin, or nearly a ball, have fewer good digits in doubles.
::testing::AssertionResult about(const Enclosure& value, double expected, double scale) {
  const Rational slack = rational_of(1e-13 * scale);
  const Rational middle = rational_of(expected);
  if (value.lower <= middle + slack && middle - slack <= value.upper) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << to_decimal(value.lower, 17) << " to "
                                       << to_decimal(value.upper, 17) << " misses " << expected;
}
MeasureLimits relative_to(double scale) {
  MeasureLimits limits;
  limits.relative_width = 0;
  limits.absolute_width = width * scale;
  return limits;
}

RC_GTEST_PROP(RandomKnownSolids, PairsOfBallsHaveLensesInCommon, ()) {
  const Ball a = random_ball(1);
  const Ball b = random_ball(1);
  RC_PRE(!(a.centre == b.centre));
  const Lens common = lens(a, b);
  const double volumes = volume_of(a) + volume_of(b);
  const double areas = area_of(a) + area_of(b);
  const auto has = [&](const Solid3& set, double expected_volume, double expected_area) {
    RC_ASSERT(about(volume(set, cube(3), relative_to(volumes)).value, expected_volume, volumes));
    RC_ASSERT(about(area(set, cube(3), relative_to(areas)).value, expected_area, areas));
  };
  switch (*rc::gen::inRange(0, 3)) {
    case 0:
      return has(csg::unite(a.set, b.set), volumes - common.volume,
                 areas - common.area_of_first - common.area_of_second);
    case 1:
      return has(csg::intersect(a.set, b.set), common.volume,
                 common.area_of_first + common.area_of_second);
    default:
      return has(csg::subtract(a.set, b.set), volume_of(a) - common.volume,
                 area_of(a) - common.area_of_first + common.area_of_second);
  }
}

// Of balls of which no three meet, the union's measures are the sums, less those of the lenses.
RC_GTEST_PROP(RandomKnownSolids, UnionsOfBallsByInclusionAndExclusion, ()) {
  std::vector<Ball> balls;
  const int count = *rc::gen::inRange(3, 7);
  for (int i = 0; i < count; ++i) balls.push_back(random_ball(3));
  Solid3 set = Solid3::empty();
  double expected_volume = 0;
  double expected_area = 0;
  double scale = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    set = csg::unite(set, balls[i].set);
    expected_volume += volume_of(balls[i]);
    expected_area += area_of(balls[i]);
    scale += volume_of(balls[i]) + area_of(balls[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const Lens common = lens(balls[i], balls[j]);
      expected_volume -= common.volume;
      expected_area -= common.area_of_first + common.area_of_second;
      for (std::size_t k = 0; k < j && common.volume > 0; ++k) {
        RC_PRE(lens(balls[i], balls[k]).volume == 0 || lens(balls[j], balls[k]).volume == 0);
      }
    }
  }
  RC_ASSERT(about(volume(set, cube(5), relative_to(scale)).value, expected_volume, scale));
  RC_ASSERT(about(area(set, cube(5), relative_to(scale)).value, expected_area, scale));
}

// A slanted plane cuts a cap of height r - t off a ball, t its distance from the centre. The normal
// is one of whole length.
RC_GTEST_PROP(RandomKnownSolids, PlanesCutCapsOffBalls, ()) {
  const Ball a = random_ball(1);
  struct Normal {
    Coordinates<3> n;
    int length;
  };
  const Normal normal = *rc::gen::elementOf(std::vector<Normal>{
      {{1, 2, 2}, 3}, {{-2, 3, 6}, 7}, {{0, 3, -4}, 5}, {{0, 0, -1}, 1}, {{4, -4, 7}, 9}});
  // At t / r = -11/12 to 11/12.
  const Rational share = Rational(*rc::gen::inRange(-11, 12)) / 12;
  Rational bound = rational_of(a.radius) * share * normal.length;
  for (std::size_t i = 0; i < 3; ++i) bound += rational_of(a.centre[i]) * normal.n[i];
  // Of the very ball whose centre and radius are the doubles.
  const Point<3> centre =
      point(rational_of(a.centre[0]), rational_of(a.centre[1]), rational_of(a.centre[2]));
  const Rational radius = rational_of(a.radius);
  const Solid3 kept =
      csg::intersect(ball(centre, Rational(radius * radius)), below(normal.n, bound));
  const double h = a.radius * (1 + nearest_double(share));
  const double volume_kept = pi * h * h * (3 * a.radius - h) / 3;
  const double area_kept = 2 * pi * a.radius * h + pi * h * (2 * a.radius - h);
  RC_ASSERT(
      about(volume(kept, cube(3), relative_to(volume_of(a))).value, volume_kept, volume_of(a)));
  RC_ASSERT(about(area(kept, cube(3), relative_to(area_of(a))).value, area_kept, area_of(a)));
}

// Rods with coaxial holes, which may be deeper or less deep than the rod is high.
RC_GTEST_PROP(RandomKnownSolids, RodsWithHoles, ()) {
  const std::size_t axis = *rc::gen::inRange<std::size_t>(0, 3);
  const auto twelfths = [](int low, int high) -> Rational {
    return Rational(*rc::gen::inRange(low, high)) / 12;
  };
  const Rational outer = twelfths(7, 13);
  const Rational inner = twelfths(2, 7);
  const Rational height = twelfths(2, 13);
  const Rational depth = twelfths(2, 13);
  const auto rod = [&](const Rational& r, const Rational& low, const Rational& high) {
    Coordinates<3> up;
    Coordinates<3> down;
    up[axis] = 1;
    down[axis] = -1;
    return csg::intersect(cylinder(axis, Rational(r * r)),
                          csg::intersect(below(up, high), below(down, Rational(-low))));
  };
  const Solid3 set = csg::subtract(rod(outer, 0, height), rod(inner, Rational(height - depth), 2));
  const double r = nearest_double(outer);
  const double q = nearest_double(inner);
  const double h = nearest_double(height);
  const bool is_through = depth >= height;
  const double d = is_through ? h : nearest_double(depth);
  const double faces = 2 * r * r - (is_through ? 2 : 0) * q * q;
  const double scale = 2 * pi * r * (r + h);
  RC_ASSERT(
      about(volume(set, cube(3), relative_to(scale)).value, pi * (r * r * h - q * q * d), scale));
  RC_ASSERT(about(area(set, cube(3), relative_to(scale)).value,
                  pi * (faces + 2 * r * h + 2 * q * d), scale));
}

// Random points, classified by polynomials in doubles.
RC_GTEST_PROP(RandomKnownSolids, RandomPointsAgree, ()) {
  const Solid3 set = random_solid();
  constexpr int points = 4000;
  std::mt19937_64 engine(*rc::gen::arbitrary<std::uint64_t>());
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto value = [](const domain::Quadric<3>& f, const std::array<double, 3>& x) {
    double sum = nearest_double(f.linear().constant);
    for (std::size_t i = 0; i < 3; ++i) {
      double factor = nearest_double(f.linear().normal[i]);
      for (std::size_t j = 0; j < 3; ++j) factor += nearest_double(f.square()[i][j]) * x[j];
      sum += factor * x[i];
    }
    return sum;
  };
  int hits = 0;
  for (int i = 0; i < points; ++i) {
    const std::array<double, 3> x{coordinate(engine), coordinate(engine), coordinate(engine)};
    const csg::Membership at = csg::membership_of(set, [&](const HalfSpace<3>& h) {
      bool is_in = value(h.polynomial(), x) <= 0;
      if (h.nappe()) is_in = is_in && value(domain::Quadric<3>(*h.nappe()), x) <= 0;
      return is_in != h.is_complement() ? csg::Membership::In : csg::Membership::Out;
    });
    if (at == csg::Membership::In) ++hits;
  }
  MeasureLimits limits;
  limits.relative_width = 0;
  limits.absolute_width = 1e-2;
  const Enclosure proved = volume(set, cube(1), limits).value;
  // Six deviations of a binomial distribution with the share proved, and a dozen for small shares.
  const auto expected = [&](const Rational& volume_of_set, double sign) {
    const double share = std::clamp(nearest_double(Rational(volume_of_set / 8)), 0.0, 1.0);
    return points * share + sign * (6 * std::sqrt(points * share * (1 - share)) + 12);
  };
  RC_ASSERT(hits >= expected(proved.lower, -1));
  RC_ASSERT(hits <= expected(proved.upper, 1));
}

}  // namespace
}  // namespace exactcsg::measure::test
