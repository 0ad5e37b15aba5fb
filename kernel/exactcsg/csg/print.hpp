// SPDX-License-Identifier: Apache-2.0
#pragma once

// A CSG tree as text: "union(difference(full, a), b)". [Exact]
//
// The primitives' text is the user's; the operators' is operator_name(op), found by
// argument-dependent look-up. No recursion. COST: O(length of the text).

#include <concepts>
#include <string>
#include <string_view>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/tree_concept.hpp"
#include "exactcsg/csg/walk.hpp"

namespace exactcsg::csg {

constexpr std::string_view operator_name(BooleanOperator op) noexcept {
  constexpr std::string_view names[] = {"union", "intersection", "difference",
                                        "symmetric_difference"};
  return names[static_cast<std::size_t>(op)];
}

// primitive_text(primitive) -> something that can be appended to a string.
template <ReadableTree T, std::invocable<const typename T::Primitive&> PrimitiveText>
std::string to_text(const T& tree, PrimitiveText&& primitive_text) {
  std::string text;
  const auto separate = [&] {
    if (!text.empty() && text.back() != '(') text += ", ";
  };
  walk(
      tree.root(),
      [&](auto node) {
        separate();
        text += operator_name(node.operation());
        text += '(';
        return true;
      },
      [&](auto node) {
        separate();
        switch (node.kind()) {
          case NodeKind::Full:
            text += "full";
            break;
          case NodeKind::Primitive:
            text += primitive_text(node.primitive());
            break;
          default:
            text += "empty";
        }
      },
      [&](auto) { text += ')'; });
  return text;
}

}  // namespace exactcsg::csg
