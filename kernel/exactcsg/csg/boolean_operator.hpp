// SPDX-License-Identifier: Apache-2.0
#pragma once

// The regularised set operators, and what they do to truth values. [Exact]

#include <cstdint>

namespace exactcsg::csg {

// n-ary operators fold from the left: Difference(a, b, c) is (a - b) - c.
enum class BooleanOperator : std::uint8_t { Union, Intersection, Difference, SymmetricDifference };

// What is known of a point (or of a whole cell) with respect to a set. Unknown: not decided yet, or
// both occur.
enum class Membership : std::uint8_t { Out, In, Unknown };

// LAW combine.1  if neither argument is Unknown, the result is that of the set operator.
// LAW combine.2  the result is not Unknown as soon as every replacement of the Unknown arguments by
// In or Out gives the same answer (Kleene's three-valued logic).
constexpr Membership combine(Membership a, BooleanOperator op, Membership b) {
  using enum Membership;
  switch (op) {
    case BooleanOperator::Union:
      if (a == In || b == In) return In;
      return a == Out && b == Out ? Out : Unknown;
    case BooleanOperator::Intersection:
      if (a == Out || b == Out) return Out;
      return a == In && b == In ? In : Unknown;
    case BooleanOperator::Difference:
      if (a == Out || b == In) return Out;
      return a == In && b == Out ? In : Unknown;
    case BooleanOperator::SymmetricDifference:
      if (a == Unknown || b == Unknown) return Unknown;
      return a == b ? Out : In;
  }
  return Unknown;
}

// True if no right-hand argument can change combine(a, op, .).
constexpr bool absorbs(Membership a, BooleanOperator op) {
  switch (op) {
    case BooleanOperator::Union:
      return a == Membership::In;
    case BooleanOperator::Intersection:
    case BooleanOperator::Difference:
      return a == Membership::Out;
    case BooleanOperator::SymmetricDifference:
      return false;
  }
  return false;
}

}  // namespace exactcsg::csg
