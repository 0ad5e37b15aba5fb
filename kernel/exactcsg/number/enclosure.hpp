// SPDX-License-Identifier: Apache-2.0
#pragma once

// Real numbers known between two rational bounds, and their correctly rounded decimals. [Certified]

#include <functional>
#include <string>

#include "exactcsg/number/exact.hpp"

namespace exactcsg {

// LAW enclosure.1  lower <= upper, and the number meant lies in [lower, upper].
struct Enclosure {
  Rational lower;
  Rational upper;
};

// The decimal with `digits` significant digits nearest to the exact value (ties to even), as
// "1.2345e-07", "12.5", "0". Trailing zeros are dropped. REQUIRES digits >= 1
std::string to_decimal(const Rational& value, int digits);

// The same for a number that `enclose(bits)` encloses ever more tightly as bits grows (bits is
// the working precision; the width need not be 2^-bits exactly). The enclosure is refined until
// both bounds round to the same decimal: the result is the correctly rounded decimal.
// A number that lies exactly on a rounding boundary, or is zero, is recognised only if the
// enclosure becomes a single point; THROWS Error(InternalError) after bits exceeds 20 000.
std::string to_decimal(const std::function<Enclosure(int bits)>& enclose, int digits);

}  // namespace exactcsg
