// SPDX-License-Identifier: Apache-2.0
#pragma once

// What an operator does with an operand that is Empty or Full: all that prune must know of it, so
// that trees over other operators can be pruned as well. [Exact]
//
// An operator type is Prunable if these are found by argument-dependent look-up:
//   react(op, position, operand) -> Reaction     an operand that turned out Empty or Full
//   neutral(op) -> Constant                      the value when every operand was dropped
//   splices(op, position, inner) -> bool         op(.., inner(xs), ..) == op(.., xs, ..)
//
// LAW react.1  replacing the operand as the reaction says changes no point's membership.
// LAW react.2  Keep is the answer at most at position First; Complement only if op does not care
//              for the order of its operands.

#include <concepts>
#include <cstdint>

#include "exactcsg/csg/boolean_operator.hpp"

namespace exactcsg::csg {

enum class Constant : std::uint8_t { Empty, Full };
enum class Position : std::uint8_t { First, Later };

enum class Reaction : std::uint8_t {
  Drop,         // the other operands alone give the result
  BecomeEmpty,  // the result is Empty whatever the others are
  BecomeFull,   // the result is Full whatever the others are
  Keep,         // the operand must stay
  Complement    // the result is the complement of what the other operands give
};

constexpr Reaction react(BooleanOperator op, Position position, Constant operand) noexcept {
  const bool full = operand == Constant::Full;
  switch (op) {
    case BooleanOperator::Union:
      return full ? Reaction::BecomeFull : Reaction::Drop;
    case BooleanOperator::Intersection:
      return full ? Reaction::Drop : Reaction::BecomeEmpty;
    case BooleanOperator::Difference:
      if (position == Position::First) return full ? Reaction::Keep : Reaction::BecomeEmpty;
      return full ? Reaction::BecomeEmpty : Reaction::Drop;
    case BooleanOperator::SymmetricDifference:
      return full ? Reaction::Complement : Reaction::Drop;
  }
  return Reaction::Keep;
}

constexpr Constant neutral(BooleanOperator op) noexcept {
  return op == BooleanOperator::Intersection ? Constant::Full : Constant::Empty;
}

// (a - b) - c == a - b - c and a - (b u c) == a - b - c; the others are associative.
constexpr bool splices(BooleanOperator op, Position position, BooleanOperator inner) noexcept {
  if (op == BooleanOperator::Difference) {
    return inner ==
           (position == Position::First ? BooleanOperator::Difference : BooleanOperator::Union);
  }
  return op == inner;
}

template <class O>
concept PrunableOperator = std::copyable<O> &&
    requires(O op, Position position, Constant constant) {
  { react(op, position, constant) } -> std::same_as<Reaction>;
  { neutral(op) } -> std::same_as<Constant>;
  { splices(op, position, op) } -> std::same_as<bool>;
};

}  // namespace exactcsg::csg
