// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// CGAL's lazy exact kernel for the algorithms of this folder, and the way into it and back. [Exact]
//
// Not for headers that others include: CGAL is expensive to compile.

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactNumber = ExactKernel::FT;
using ExactPoint2 = ExactKernel::Point_2;
using ExactPoint3 = ExactKernel::Point_3;

// A rational that is a double enters as a double: CGAL's static filters then answer without
// interval arithmetic, and no second copy of the rational is made.
inline ExactNumber exact_number(const Rational& value) {
  const mpz_srcptr numerator = value.get_num_mpz_t();
  const mpz_srcptr denominator = value.get_den_mpz_t();
  constexpr std::size_t mantissa_bits = 53;
  constexpr std::size_t safe_exponent = 900;
  const std::size_t denominator_bits = mpz_sizeinbase(denominator, 2);
  if (mpz_sizeinbase(numerator, 2) <= mantissa_bits && denominator_bits <= safe_exponent &&
      mpz_scan1(denominator, 0) == denominator_bits - 1) {
    return {value.get_d()};
  }
  using ExactType = ExactKernel::Exact_kernel::FT;
  return ExactNumber(ExactType(value.get_mpq_t()));
}

// CGAL's exact type is whichever rational its configuration prefers: mpq_class, Gmpq or Boost's.
template <class ExactType>
Rational rational_of_exact(const ExactType& exact) {
  if constexpr (requires { Rational(exact); }) {
    return Rational(exact);
  } else if constexpr (requires { exact.mpq(); }) {
    return Rational(exact.mpq());
  } else {
    return Rational(exact.backend().data());
  }
}
inline Rational rational_of(const ExactNumber& value) {
  return rational_of_exact(CGAL::exact(value));
}

inline ExactPoint2 exact_point(const Point2& p) { return {exact_number(p.x), exact_number(p.y)}; }
inline ExactPoint3 exact_point(const Point3& p) {
  return {exact_number(p.x), exact_number(p.y), exact_number(p.z)};
}
inline Point2 point_of(const ExactPoint2& p) { return {rational_of(p.x()), rational_of(p.y())}; }

}  // namespace exactcsg::io
