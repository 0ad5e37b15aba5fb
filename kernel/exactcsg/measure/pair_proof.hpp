// SPDX-License-Identifier: Apache-2.0
#pragma once

// Do two regions of space interfere, does one contain the other? [Certified]
//
// LAW pair_proof.1  proof is that of prove_disjoint(a, b), or prove_contains(a, b), in a box
// outside
//                   of which there is no violation.
// LAW pair_proof.2  if refuted, the volume of what a and b have in common, or of what b has outside
//                   a, lies in volume, whose width is as small as the limits allow.
// THROWS Error(UnboundedSolid) if no such box is found (bounding_box.hpp).

#include <optional>
#include <utility>
#include <variant>

#include "exactcsg/measure/bounding_box.hpp"
#include "exactcsg/measure/region_proof.hpp"

namespace exactcsg::measure {

struct PairProof {
  Proof proof;
  std::optional<Enclosure> volume;  // if refuted
};

namespace detail {

// Of the violation; nullopt: there is none.
template <SpatialDomain P>
std::optional<Box3> box_of_violation(const csg::BooleanTree<P>& violation,
                                     std::span<const csg::BooleanTree<P>> supersets) {
  Extent extent = bounding_box(violation);
  for (const csg::BooleanTree<P>& set : supersets) {
    if (extent.kind == ExtentKind::NotBounded) extent = bounding_box(set);
  }
  if (extent.kind == ExtentKind::NotBounded) {
    throw Error(ErrorId::UnboundedSolid,
                {"no box that holds what the question is about", "a bounded model"});
  }
  return extent.box;
}

template <SpatialDomain P, class Prove>
PairProof proof_about(const csg::BooleanTree<P>& violation,
                      std::span<const csg::BooleanTree<P>> supersets, const ProofLimits& limits,
                      Prove&& prove) {
  const std::optional<Box3> box = box_of_violation(violation, supersets);
  if (!box) return {Proved{}, std::nullopt};
  PairProof result{prove(*box), std::nullopt};
  if (!std::holds_alternative<Refuted>(result.proof)) return result;
  MeasureLimits of_volume;
  of_volume.relative_width = 1e-3;
  of_volume.cells = 100'000;
  of_volume.deadline = limits.deadline;
  of_volume.progress = limits.progress;
  result.volume = volume(violation, *box, of_volume).value;
  return result;
}

}  // namespace detail

// Is nothing inside both?
template <SpatialDomain P>
PairProof prove_no_interference(const csg::BooleanTree<P>& a, const csg::BooleanTree<P>& b,
                                const ProofLimits& limits = {}) {
  const std::array supersets{a, b};
  return detail::proof_about<P>(csg::intersect(a, b), supersets, limits,
                                [&](const auto& box) { return prove_disjoint(a, b, box, limits); });
}

// Is b a subset of a?
template <SpatialDomain P>
PairProof prove_containment(const csg::BooleanTree<P>& a, const csg::BooleanTree<P>& b,
                            const ProofLimits& limits = {}) {
  const std::array supersets{b};
  return detail::proof_about<P>(csg::subtract(b, a), supersets, limits,
                                [&](const auto& box) { return prove_contains(a, b, box, limits); });
}

}  // namespace exactcsg::measure
