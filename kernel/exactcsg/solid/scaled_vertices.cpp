// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/scaled_vertices.hpp"

#include <algorithm>
#include <optional>

#include "exactcsg/number/common_denominator.hpp"

namespace exactcsg {

namespace {

// An exponent e with every extent of the vertices below 2^e, and not much more.
long extent_exponent(const Boundary& boundary) {
  long exponent = -1000000;
  for (std::size_t i = 0; i < 3; ++i) {
    const CoordinateRange range = coordinate_range(boundary, i);
    const Rational extent = range.highest - range.lowest;
    if (extent == 0) continue;
    exponent =
        std::max(exponent, static_cast<long>(mpz_sizeinbase(extent.get_num_mpz_t(), 2)) -
                               static_cast<long>(mpz_sizeinbase(extent.get_den_mpz_t(), 2)) + 1);
  }
  return exponent;
}

Rational power_of_two(long exponent) {
  Rational power = 1;
  if (exponent >= 0) {
    mpq_mul_2exp(power.get_mpq_t(), power.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(power.get_mpq_t(), power.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return power;
}

// floor(value * 2^shift)
void floor_shifted(Integer& result, Integer& scratch, const Rational& value, long shift) {
  if (shift >= 0) {
    mpz_mul_2exp(result.get_mpz_t(), value.get_num_mpz_t(), static_cast<mp_bitcnt_t>(shift));
    mpz_fdiv_q(result.get_mpz_t(), result.get_mpz_t(), value.get_den_mpz_t());
  } else {
    mpz_mul_2exp(scratch.get_mpz_t(), value.get_den_mpz_t(), static_cast<mp_bitcnt_t>(-shift));
    mpz_fdiv_q(result.get_mpz_t(), value.get_num_mpz_t(), scratch.get_mpz_t());
  }
}

// Moves the smallest coordinates to 0.
void move_to_origin(ScaledVertices& s) {
  std::array<Integer, 3> lowest = s.coordinates.front();
  for (const auto& c : s.coordinates) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (c[i] < lowest[i]) lowest[i] = c[i];
    }
  }
  for (auto& c : s.coordinates) {
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] -= lowest[i];
      if (c[i] > s.largest) s.largest = c[i];
    }
  }
  s.origin = {lowest[0] * s.unit, lowest[1] * s.unit, lowest[2] * s.unit};
}

}  // namespace

CoordinateRange coordinate_range(const Boundary& boundary, std::size_t axis) {
  // Rounding to nearest is monotone: only equal doubles leave the order open.
  const bool has_doubles = boundary.approximate.size() == boundary.vertices.size();
  const auto less = [&](std::size_t v, std::size_t w) {
    if (has_doubles && boundary.approximate[v][axis] != boundary.approximate[w][axis]) {
      return boundary.approximate[v][axis] < boundary.approximate[w][axis];
    }
    return coordinate(boundary.vertices[v], axis) < coordinate(boundary.vertices[w], axis);
  };
  std::size_t lowest = 0;
  std::size_t highest = 0;
  for (std::size_t v = 1; v < boundary.vertices.size(); ++v) {
    if (less(v, lowest)) lowest = v;
    if (less(highest, v)) highest = v;
  }
  return {coordinate(boundary.vertices[lowest], axis),
          coordinate(boundary.vertices[highest], axis)};
}

bool has_short_common_denominator(const Boundary& boundary) {
  return short_common_denominator(boundary.vertices).has_value();
}

ScaledVertices scale_vertices(const Boundary& boundary, int bits) {
  ScaledVertices s;
  if (boundary.vertices.empty()) {
    s.unit = 1;
    s.exact = true;
    return s;
  }
  s.coordinates.resize(boundary.vertices.size());
  if (const std::optional<Integer> common = short_common_denominator(boundary.vertices)) {
    s.exact = true;
    s.unit = Rational(Integer(1), *common);
    for (std::size_t v = 0; v < s.coordinates.size(); ++v) {
      for (std::size_t i = 0; i < 3; ++i) {
        set_scaled(s.coordinates[v][i], coordinate(boundary.vertices[v], i), *common);
      }
    }
  } else {
    const long shift = bits - extent_exponent(boundary);
    s.unit = power_of_two(-shift);
    Integer scratch;
    for (std::size_t v = 0; v < s.coordinates.size(); ++v) {
      for (std::size_t i = 0; i < 3; ++i) {
        floor_shifted(s.coordinates[v][i], scratch, coordinate(boundary.vertices[v], i), shift);
      }
    }
  }
  move_to_origin(s);
  return s;
}

}  // namespace exactcsg
