// SPDX-License-Identifier: Apache-2.0
#pragma once

// Rationals rounded to doubles, with the word whether anything was lost. Private to the kernel.
// [Exact]

#include "exactcsg/number/exact.hpp"
#include "exactcsg/number/rational_view.hpp"

namespace exactcsg {

struct NearestDouble {
  double value = 0;
  bool is_exact = false;  // value is the number; false also where that was not worth finding out
};

// LAW rounding.1  value == nearest_double(number). LAW rounding.2  is_exact means value == number;
// of doubles from 2^-900 to 2^900 in magnitude, and of 0, it is always said.
// COST: O(1) if the denominator is a power of two and the numerator has at most 128 bits
NearestDouble round_to_nearest(const RationalView& number);
NearestDouble round_to_nearest(const Rational& number);

}  // namespace exactcsg
