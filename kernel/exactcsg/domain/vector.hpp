// SPDX-License-Identifier: Apache-2.0
#pragma once

// Vectors with rational components. [Exact]

#include <cstddef>

#include "exactcsg/domain/point.hpp"

namespace exactcsg::domain::detail {

template <std::size_t D>
Rational scalar_product(const Coordinates<D>& u, const Coordinates<D>& v) {
  Rational sum;
  for (std::size_t i = 0; i < D; ++i) sum += u[i] * v[i];
  return sum;
}
template <std::size_t D>
Coordinates<D> scaled(const Rational& factor, const Coordinates<D>& v) {
  Coordinates<D> result;
  for (std::size_t i = 0; i < D; ++i) result[i] = factor * v[i];
  return result;
}
template <std::size_t D>
Coordinates<D> sum(const Coordinates<D>& u, const Coordinates<D>& v) {
  Coordinates<D> result;
  for (std::size_t i = 0; i < D; ++i) result[i] = u[i] + v[i];
  return result;
}
template <std::size_t D>
bool is_zero(const Coordinates<D>& v) {
  return v == Coordinates<D>{};
}

inline Coordinates<3> vector_product(const Coordinates<3>& u, const Coordinates<3>& v) {
  Coordinates<3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    result[i] = u[j] * v[k] - u[k] * v[j];
  }
  return result;
}

}  // namespace exactcsg::domain::detail
