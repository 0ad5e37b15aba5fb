// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "exactcsg/number/exact.hpp"

namespace exactcsg {

// sum += a * b, quickly if a factor is 0 or 1, as most entries of matrices are: every operation on
// rationals takes common divisors out.
void add_product(Rational& sum, const Rational& a, const Rational& b);

}  // namespace exactcsg
