// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/products.hpp"

namespace exactcsg {

void add_product(Rational& sum, const Rational& a, const Rational& b) {
  if (sgn(a) == 0 || sgn(b) == 0) return;
  if (sgn(sum) == 0) {
    sum = a == 1 ? b : b == 1 ? a : Rational(a * b);
  } else if (a == 1 || b == 1) {
    sum += a == 1 ? b : a;
  } else {
    sum += a * b;
  }
}

}  // namespace exactcsg
