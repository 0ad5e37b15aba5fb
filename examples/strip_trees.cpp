// SPDX-License-Identifier: GPL-3.0-or-later
// Strip trees (Ballard; Davy and Dew, section 3.7) of two digitised circles of 100 000 points:
// their length, what they enclose, where they meet, and how few points are enough for a tolerance.
//
// Radius 100, centres 120 apart: a length of 200 pi = 628.3185307 less 1.0e-7 for the polygon, and
// meetings at x = 60, y = +-80. An arc of half angle a deviates by 100 (1 - cos a) from its chord:
// halving the 100 000 steps k times until that is at most 1/100 leaves 2^8 = 256 parts.

#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <vector>

#include "exactcsg/domain/strip_tree.hpp"

namespace {

using namespace exactcsg;

std::vector<domain::CurvePoint> circle(double radius, double centre_x) {
  constexpr int count = 100'000;
  std::vector<domain::CurvePoint> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    points.push_back({centre_x + radius * std::cos(angle), radius * std::sin(angle)});
  }
  points.push_back(points.front());
  return points;
}

}  // namespace

int main() {
  const domain::StripTree first = domain::make_strip_tree(circle(100, 0));
  const domain::StripTree second = domain::make_strip_tree(circle(100, 120));

  std::cout << "length " << to_decimal([&](int bits) { return length(first, bits); }, 10) << '\n';
  for (const int x : {0, 99, 101}) {
    const bool inside = classify(first, domain::Point<2>(x, 0)) == PointClass::In;
    std::cout << "(" << x << ", 0) is " << (inside ? "in" : "out") << '\n';
  }
  for (const domain::CurveMeeting& meeting : intersection(first, second)) {
    std::cout << "they meet at (" << std::fixed << std::setprecision(4) << meeting.from[0].get_d()
              << ", " << meeting.from[1].get_d() << ")\n";
  }
  std::cout << simplified(first, 0.01).size() - 1
            << " segments are enough for a tolerance of 0.01\n";
}
