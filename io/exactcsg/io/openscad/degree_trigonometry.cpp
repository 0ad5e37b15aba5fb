// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/degree_trigonometry.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace exactcsg::io::openscad {

namespace {

constexpr double largest_angle = 360.0 * 4503599627370496.0;  // beyond, no digit means anything
constexpr double square_root_of_half = 0.70710678118654752440;
constexpr double square_root_of_three_quarters = 0.86602540378443864676;

// The order of the operations is OpenSCAD's: first times pi, then divided.
double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

// [0, 360)
double reduced(double x) {
  if (x < 360.0 && x >= 0.0) return x;
  if (!(x < largest_angle && x > -largest_angle)) return std::numeric_limits<double>::quiet_NaN();
  return x - 360.0 * std::floor(x / 360.0);
}

}  // namespace

double sine_of_degrees(double x) {
  x = reduced(x);
  const bool opposite = x >= 180.0;
  if (opposite) x -= 180.0;
  if (x > 90.0) x = 180.0 - x;
  double value = 0;
  if (x < 45.0) {
    value = x == 30.0 ? 0.5 : std::sin(radians(x));
  } else if (x == 45.0) {
    value = square_root_of_half;
  } else if (x == 60.0) {
    value = square_root_of_three_quarters;
  } else {
    value = std::cos(radians(90.0 - x));
  }
  return opposite ? -value : value;
}

double cosine_of_degrees(double x) {
  x = reduced(x);
  bool opposite = x >= 180.0;
  if (opposite) x -= 180.0;
  if (x > 90.0) {
    x = 180.0 - x;
    opposite = !opposite;
  }
  double value = 0;
  if (x > 45.0) {
    value = x == 60.0 ? 0.5 : std::sin(radians(90.0 - x));
  } else if (x == 45.0) {
    value = square_root_of_half;
  } else if (x == 30.0) {
    value = square_root_of_three_quarters;
  } else {
    value = std::cos(radians(x));
  }
  return opposite ? -value : value;
}

}  // namespace exactcsg::io::openscad
