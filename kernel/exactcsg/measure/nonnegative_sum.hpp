// SPDX-License-Identifier: Apache-2.0
#pragma once

// Whether f + mu g is nowhere negative in a box for some mu > 0, so that f < 0 and g < 0 exclude
// each other there. [Exact]
//
// LAW nonnegative_sum.1  true only if it is: factors are guessed in doubles (witness_search.hpp),
//                        sums are checked exactly. False says nothing.

#include <cstddef>
#include <optional>

#include "exactcsg/measure/witness_search.hpp"

namespace exactcsg::measure::detail {

// What f and g are about, in any coordinates that both have in common.
struct ApproximatePair {
  ApproximateQuadric f;
  ApproximateQuadric g;
};

template <std::size_t D>
bool have_nonnegative_sum(const domain::Quadric<D>& f, const domain::Quadric<D>& g,
                          const ApproximatePair& approximate, const domain::Box<D>& box) {
  const auto holds = [&](const Rational& factor) {
    return domain::is_nowhere_negative(f + factor * g, box);
  };
  if (const auto factor = cancelling_factor(approximate.f, approximate.g)) {
    if (holds(simple_fraction(*factor))) return true;
  }
  const std::optional<Balance> middle = balance(approximate.f, approximate.g);
  if (middle && middle->factor > 0x1p-60 && middle->factor < 0x1p60) {
    if (holds(simple_fraction(middle->factor)) || holds(rational_of(middle->factor))) return true;
  }
  // Sets that touch in a line: a square cancels, and its factor need not be simple.
  for (std::size_t i = 0; i < D; ++i) {
    if (f.square()[i][i] == 0 || g.square()[i][i] == 0) continue;
    const Rational factor = -f.square()[i][i] / g.square()[i][i];
    if (factor > 0 && holds(factor)) return true;
  }
  return false;
}

}  // namespace exactcsg::measure::detail
