// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/lattice_filter.hpp"

#include <cmath>

#include "exactcsg/io/openmc/lattices.hpp"

namespace exactcsg::io::openmc {

namespace {

CertifiedDouble exactly(double value) { return {value, 0}; }

// Doubles count so far without gaps, and more.
constexpr double most_elements_in_a_row = 0x1p40;

bool is_certainly_below(const CertifiedDouble& x, double bound) {
  return bound - x.value > x.error * (1 + 0x1p-40);
}
bool is_certainly_above(const CertifiedDouble& x, double bound) {
  return x.value - bound > x.error * (1 + 0x1p-40);
}

}  // namespace

LatticeFilter::LatticeFilter(const Lattice& lattice) : lattice_(&lattice) {
  for (std::size_t i = 0; i < 3; ++i) {
    origin_[i] = certified_double_of(lattice.origin[i]);
    pitch_[i] = certified_double_of(lattice.pitch[i]);
  }
  if (!lattice.is_hexagonal()) return;
  origin_[2] = certified_double_of(
      Rational(lattice.origin[2] - lattice.pitch[2] * static_cast<long>(lattice.layers) / 2));
  // The extent of a hexagon to its corner is two thirds of the step.
  const std::size_t across = lattice.kind == LatticeKind::HexagonalY ? 0 : 1;
  step_ = certified_double_of(Rational(element_shape(lattice).half_extent[across] * 3 / 2));
}

std::optional<LatticeFilter::Interval> LatticeFilter::interval(CertifiedDouble x,
                                                               std::size_t axis) const {
  const CertifiedDouble offset = x - origin_[axis];
  const CertifiedDouble place = offset / pitch_[axis];
  const double below = std::floor(place.value);
  if (!(std::abs(below) < most_elements_in_a_row) || !is_certainly_above(place, below) ||
      !is_certainly_below(place, below + 1)) {
    return std::nullopt;
  }
  return Interval{static_cast<std::int64_t>(below), offset - pitch_[axis] * exactly(below + 0.5)};
}

// As place_in: coordinates along the two rows, of which the hexagon's are the nearest whole ones.
std::optional<std::array<LatticeFilter::Interval, 2>> LatticeFilter::hexagon(
    const CertifiedPoint& point) const {
  const bool is_y = lattice_->kind == LatticeKind::HexagonalY;
  const std::size_t across = is_y ? 0 : 1;
  const std::size_t straight = 1 - across;
  const CertifiedDouble x = point[across] - origin_[across];
  const CertifiedDouble y = point[straight] - origin_[straight];
  const CertifiedDouble row = x / step_;
  const CertifiedDouble along = y / pitch_[0] - row * exactly(0.5);
  const double low_row = std::floor(row.value);
  const double low_along = std::floor(along.value);
  if (!(std::abs(low_row) < most_elements_in_a_row &&
        std::abs(low_along) < most_elements_in_a_row)) {
    return std::nullopt;
  }
  const auto is_within_one = [](const CertifiedDouble& form) {
    return is_certainly_below(form, 1) && is_certainly_above(form, -1);
  };
  for (unsigned corner = 0; corner < 4; ++corner) {
    const double r = low_row + (corner & 1U);
    const double a = low_along + (corner >> 1U);
    const CertifiedDouble dr = row - exactly(r);
    const CertifiedDouble da = along - exactly(a);
    if (!is_within_one(exactly(2) * dr + da) || !is_within_one(dr + exactly(2) * da) ||
        !is_within_one(dr - da)) {
      continue;
    }
    std::array<Interval, 2> result;
    // Of orientation y the rows are the first number; of x the second.
    result[is_y ? 0 : 1].index = static_cast<std::int64_t>(r);
    result[is_y ? 1 : 0].index = static_cast<std::int64_t>(a);
    result[across].local = x - step_ * exactly(r);
    result[straight].local = y - pitch_[0] * exactly(a + r / 2);
    return result;
  }
  return std::nullopt;
}

std::optional<FilteredPlace> LatticeFilter::place(const CertifiedPoint& point) const {
  std::optional<std::array<Interval, 2>> found;
  if (lattice_->is_hexagonal()) {
    found = hexagon(point);
  } else {
    const auto first = interval(point[0], 0);
    const auto second = interval(point[1], 1);
    if (first && second) found = {*first, *second};
  }
  std::optional<Interval> layer = Interval{0, point[2]};
  if (lattice_->has_layers) layer = interval(point[2], 2);
  if (!found || !layer) return std::nullopt;
  FilteredPlace place{{}, lattice_->outer, {(*found)[0].local, (*found)[1].local, layer->local}};
  const std::array<std::int64_t, 3> element{(*found)[0].index, (*found)[1].index, layer->index};
  if (is_element_of(*lattice_, element)) {
    place.element = element;
    place.universe = lattice_->elements[element_index(*lattice_, element)];
  }
  return place;
}

}  // namespace exactcsg::io::openmc
