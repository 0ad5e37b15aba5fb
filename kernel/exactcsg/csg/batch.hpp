// SPDX-License-Identifier: Apache-2.0
#pragma once

// Many queries in one traversal of a CSG tree: every node is fetched once for all of them. [Exact]
//
//   traverse_batch(tree, queries, solve, combine [, special [, absorbs]]) -> one R for every query
//
// The callbacks are those of traverse with a query.
//
// LAW batch.1  the i-th result is traverse(tree, queries[i], solve, combine, special, absorbs).
// LAW batch.2  solve is called for the pairs of primitive and query for which those traversals call
//              it, primitive by primitive from left to right, within one in the order of the
//              queries.
// LAW batch.3  a node is visited once, and only if some query still needs it.
// R needs only be movable. No recursion.
// THROWS as traverse does.
// COST: O(nodes visited) steps besides the calls; memory O(queries) for every operator that waits
// for its second operand or a later one, and O(depth).

#include <concepts>
#include <cstddef>
#include <numeric>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree_concept.hpp"
#include "exactcsg/skeleton/executor.hpp"

namespace exactcsg::csg {

namespace detail {

template <ReadableTree T, class Query, class Solve, class Combine, class Special, class Absorbs,
          class R>
class BatchTraversal {
 public:
  using Cursor = typename T::Cursor;
  using O = typename T::Operator;
  using Results = skeleton::detail::Array<R>;

  BatchTraversal(std::span<const Query> queries, Solve& solve, Combine& combine,
                 const Special& special, Absorbs& absorbs)
      : queries_(queries), solve_(solve), combine_(combine), special_(special), absorbs_(absorbs) {}

  Results run(Cursor node) {
    wanted_.resize(queries_.size());
    std::iota(wanted_.begin(), wanted_.end(), std::size_t{0});
    for (;;) {
      while (node.kind() == NodeKind::Compose) {
        frames_.push_back({node.first_child(), node.children_end(), node.operation()});
        node = node.first_child();
      }
      solve_wanted(node);
      for (;;) {
        if (frames_.empty()) return std::move(values_);
        Frame& top = frames_.back();
        receive(top);
        top.child = top.child.next_sibling();
        if (!(top.child == top.end) && wants_more(top)) {
          node = top.child;
          break;
        }
        finish(top);
        frames_.pop_back();
      }
    }
  }

 private:
  struct Frame {
    Cursor child;
    Cursor end;
    KeptOperation<Cursor, O> operation;
    // Only from the second operand on: the results so far of the queries that reached this node,
    // and which of them the present operand is asked for.
    std::vector<std::size_t> queries{};
    Results partial{};
    std::vector<std::size_t> asked{};  // indices of `queries`
    const O& op() const noexcept { return operation; }
  };

  // values_ become the results of wanted_ at a leaf.
  void solve_wanted(Cursor node) {
    values_.clear();
    values_.reserve(wanted_.size());
    const auto about = [&](std::size_t query) {
      const auto solve = [&](const typename T::Primitive& primitive) {
        return solve_(primitive, queries_[query]);
      };
      return leaf_result<R>(node, solve, special_);
    };
    for (const std::size_t query : wanted_) values_.push_back(about(query));
  }

  // values_ are the results of an operand.
  void receive(Frame& frame) {
    if (frame.partial.empty()) return;
    for (std::size_t i = 0; i < frame.asked.size(); ++i) {
      R& partial = frame.partial[frame.asked[i]];
      partial = combine_(std::move(partial), frame.op(), std::move(values_[i]));
    }
  }

  // Chooses the queries to ask the next operand for: those of wanted_ (after the first operand) or
  // of frame.asked that are not absorbed.
  bool wants_more(Frame& frame) {
    if (frame.partial.empty()) {
      frame.partial = std::move(values_);
      frame.queries = wanted_;
      frame.asked.resize(wanted_.size());
      std::iota(frame.asked.begin(), frame.asked.end(), std::size_t{0});
    }
    std::erase_if(frame.asked, [&](std::size_t i) {
      return static_cast<bool>(absorbs_(std::as_const(frame.partial[i]), frame.op()));
    });
    wanted_.clear();
    for (const std::size_t i : frame.asked) wanted_.push_back(frame.queries[i]);
    return !wanted_.empty();
  }

  // values_ and wanted_ become those of the whole node.
  void finish(Frame& frame) {
    if (frame.partial.empty()) return;
    values_ = std::move(frame.partial);
    wanted_ = std::move(frame.queries);
  }

  std::span<const Query> queries_;
  Solve& solve_;
  Combine& combine_;
  const Special& special_;
  Absorbs& absorbs_;
  std::vector<Frame> frames_;
  std::vector<std::size_t> wanted_;  // the queries that the present node is asked for
  Results values_;                   // their results
};

}  // namespace detail

template <ReadableTree T, std::ranges::contiguous_range Queries, class Solve, class Combine,
          class Special = NoSpecial, class Absorbs = NeverAbsorbs,
          class Query = std::ranges::range_value_t<Queries>,
          class R = std::remove_cvref_t<
              std::invoke_result_t<Solve&, const typename T::Primitive&, const Query&>>>
requires CombinesResults<Combine, R, typename T::Operator> &&
    std::predicate<Absorbs&, const R&, const typename T::Operator&>
auto traverse_batch(const T& tree, const Queries& queries, Solve&& solve, Combine&& combine,
                    const Special& special = {}, Absorbs&& absorbs = {})
    -> skeleton::detail::Array<R> {
  if (std::ranges::empty(queries)) return {};
  detail::BatchTraversal<T, Query, std::remove_reference_t<Solve>, std::remove_reference_t<Combine>,
                         Special, std::remove_reference_t<Absorbs>, R>
      traversal(std::span<const Query>(queries), solve, combine, special, absorbs);
  return traversal.run(tree.root());
}

}  // namespace exactcsg::csg
