// SPDX-License-Identifier: Apache-2.0
#pragma once

// Takes half-spaces out of a tree that the others make irrelevant in a box: a ball that another one
// covers there, a plane beyond all that the rest leaves. [Certified]
//
//   without_redundant(tree, box, limits) -> Tree
//
// csg::prune takes out what the box alone decides; this asks, of each surface that is left, whether
// the tree with that surface's half-space as Full or as Empty is the same set in the box, by a
// proof (region_proof.hpp).
//
// LAW redundancy.1  in the open box the result has the tree's points, but for a set without
//                   interior.
// LAW redundancy.2  the result's surfaces are surfaces of the tree, each of which was not proved to
//                   be irrelevant within the limits, given the others.
// LAW redundancy.3  a tree that is empty in the box, or full, is Empty, or Full, if each step
//                   towards that is proved.
// The result depends on the order of surfaces where several make each other irrelevant: the one
// that occurs first goes first.
// COST: at most two proofs for each distinct surface that reaches the box, each within the limits.

#include <span>
#include <variant>

#include "exactcsg/measure/region_proof.hpp"

namespace exactcsg::measure {

namespace detail {

// No inner point of the box is in one of them alone.
template <SpatialDomain P>
bool are_equal_in(const csg::BooleanTree<P>& a, const csg::BooleanTree<P>& b, const Box3& box,
                  const ProofLimits& limits) {
  return std::holds_alternative<Proved>(find_combinations<P>(
      std::span<const csg::BooleanTree<P>>(), csg::symmetric_difference(a, b), box, limits));
}

}  // namespace detail

template <SpatialDomain P>
csg::BooleanTree<P> without_redundant(const csg::BooleanTree<P>& tree, const domain::Box<3>& box,
                                      const ProofLimits& limits = {}) {
  SurfaceTable<P> table;
  LiteralTree left = table.add(tree);
  LocalMemberships<P> memberships(table);
  memberships.enter(box);
  left = csg::prune(left, memberships);
  const auto of_primitives = [&](const LiteralTree& literals) {
    return csg::map(literals, [&](const Literal& literal) {
      const P& primitive = table[literal.surface];
      return literal.is_complemented ? complement(primitive) : primitive;
    });
  };
  for (std::uint32_t surface = 0; surface < table.size(); ++surface) {
    for (const csg::Membership side : {csg::Membership::Out, csg::Membership::In}) {
      const LiteralTree candidate = csg::prune(left, [&](const Literal& literal) {
        return literal.surface == surface
                   ? domain::detail::complement_if(literal.is_complemented, side)
                   : csg::Membership::Unknown;
      });
      if (same_handle(candidate, left)) break;  // it does not occur
      if (!detail::are_equal_in(of_primitives(left), of_primitives(candidate), box, limits)) {
        continue;
      }
      left = candidate;
      break;
    }
  }
  return of_primitives(left);
}

}  // namespace exactcsg::measure
