// SPDX-License-Identifier: Apache-2.0
#pragma once

// A solid that is changed again and again, and its canonical boundary after every change. [Exact]
//
//   IncrementalEvaluation design(solid);
//   design.subtract(drill);                           // one more primitive at the root
//   const Occurrence hole = design.last_occurrence();
//   design.replace(hole, wider_drill);                // one primitive of the tree by another
//   design.boundary();                                // of design.solid()
//
// The value keeps the cells of the evaluator's decomposition, each with the facets in it, the tree
// pruned to it and its pieces of boundary. A change evaluates anew the cells that the box of the
// old or of the new primitive touches; the others keep their pieces. A cell that has become Full or
// Empty forgets its facets, so that long sequences of operations carry no dead ones along. Copies
// share the cells that they have in common: a variant of a design costs what it differs in.
//
// LAW incremental.1  after any sequence of changes boundary() is evaluate(solid()): equal vertices,
// edges and faces, equal digests. LAW incremental.2  solid() is the solid that the value was made
// of with the same changes made to its tree. LAW incremental.3  a copy does not change when the
// original does. LAW incremental.4  replacing a primitive by one of the same handle evaluates
// nothing.
//
// Source: DESIGN section 4 (docs/architecture.md, "Changes").

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/solid.hpp"

namespace exactcsg {

// A place in the tree where a primitive occurs. Those of the first solid are numbered from 0, from
// left to right, every occurrence of a shared subtree counting; then come those added, in order.
enum class Occurrence : std::uint32_t {};

struct UpdateStatistics {
  TierStatistics tiers;               // of the cells evaluated anew
  std::uint64_t cells = 0;            // leaves of the decomposition after the change
  std::uint64_t renewed_cells = 0;    // of these, cells made or looked at anew
  std::uint64_t evaluated_cells = 0;  // of these, cells that needed two-sided classification
  bool everything = false;            // all cells were made anew: see COST
};

// Different threads may read different copies, also while one of them is changed.
class IncrementalEvaluation {
 public:
  // COST: that of evaluate without merging.
  // THROWS as evaluate does, but for UnboundedSolid. Asks the progress, which outlives the value
  // and its copies, for cancellation.
  explicit IncrementalEvaluation(const Solid& solid = {}, const EvaluateOptions& options = {});
  IncrementalEvaluation(const IncrementalEvaluation& other);
  IncrementalEvaluation(IncrementalEvaluation&& other) noexcept;
  IncrementalEvaluation& operator=(IncrementalEvaluation other) noexcept;
  ~IncrementalEvaluation();

  // Tells of primitives that changes will bring. That changes no result; numbers and planes are
  // then prepared for all of them at once.
  void announce(std::span<const Primitive> primitives);

  // Changes. COST: of the cells touched, one pass over the tree (replace) or over the new
  // primitive's facets, and for a primitive whose handle was neither met nor announced one pass
  // over the facets of all primitives. If it reaches out of all bounds so far, or if more than half
  // of the primitives met are no longer in the tree, all cells are made anew, which happens ever
  // more rarely as the solid grows.
  // THROWS Error(NumberOutOfRange) and then changes nothing; what Progress throws: the change is
  // then made, and what is missing is evaluated with the next change or boundary.
  //
  // REQUIRES the occurrence exists: THROWS Error(BadArgument) otherwise.
  UpdateStatistics replace(Occurrence occurrence, const Primitive& primitive);
  // The solid becomes (solid op primitive). The new occurrence is the last one.
  UpdateStatistics apply(csg::BooleanOperator operation, const Primitive& primitive);
  UpdateStatistics unite(const Primitive& primitive);
  UpdateStatistics subtract(const Primitive& primitive);
  UpdateStatistics intersect(const Primitive& primitive);

  std::uint32_t occurrence_count() const;
  // REQUIRES the occurrence exists: THROWS Error(BadArgument) otherwise, these two.
  const Primitive& primitive(Occurrence occurrence) const;
  Occurrence last_occurrence() const;
  // All places of a handle; of a half-space, of an equal one. COST: O(occurrences)
  std::vector<Occurrence> occurrences_of(const Primitive& primitive) const;

  // COST: O(nodes)
  Solid solid() const;

  // The statistics are of the last change and of merging. COST: O(pieces log pieces): all pieces
  // are merged. THROWS Error(UnboundedSolid), and what Progress throws.
  Boundary boundary();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace exactcsg
