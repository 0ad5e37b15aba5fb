// SPDX-License-Identifier: Apache-2.0
#pragma once

// The square root of a real number known up to an error. [Certified]

#include <cmath>

#include "exactcsg/number/certified_double.hpp"

namespace exactcsg {

// Of what is below 0, if the error allows that, the root is taken as 0. REQUIRES x >= 0, the number
// meant.
inline CertifiedDouble square_root(CertifiedDouble x) {
  if (!(x.value > 0) || !(x.error < x.value)) {
    const double bound = std::sqrt(std::abs(x.value) + x.error) * (1 + 0x1p-50);
    return {0, bound};
  }
  const double root = std::sqrt(x.value);
  // |sqrt(v + e) - sqrt(v)| <= |e| / sqrt(v) for |e| <= v
  return {root, (x.error / root) * (1 + 0x1p-50) + 0x1p-52 * root + 0x1p-1000};
}

}  // namespace exactcsg
