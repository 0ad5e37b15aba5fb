// SPDX-License-Identifier: Apache-2.0
#pragma once

// The CSG skeleton: an evaluation that says what intersection and union do and what their
// identities are, and can therefore be run in parallel on a tree of any shape, a chain too. [Exact]
//
//   set_skeleton(tree, solve, SetAlgebra{...} [, executor [, grain]]) -> R
//   set_skeleton(tree, query, solve, SetAlgebra{...} [, executor [, grain]]) -> R
//
// SetAlgebra{intersect, unite, identity_of_intersection, identity_of_union [, complement]}:
// intersect(R, R) -> R, unite(R, R) -> R, complement(R) -> R. For the class of a point the
// identities are In and Out. They are also the results of Full and Empty.
//
// LAW skeleton.1  the result is that of traverse with
//                   a u b   unite(a, b)                       a - b    intersect(a, complement(b))
//                   a n b   intersect(a, b)                   a xor b  unite(a - b, b - a)
//                 and the identities for Full and Empty: on every executor, for every grain.
// REQUIRES R with these operations is a distributive lattice between the identities, and complement
// obeys De Morgan's laws and undoes itself (truth values, sets of bits, of points, of intervals;
// the three values Out < On < In with minimum and maximum). R copyable. THROWS Error(BadArgument)
// at a difference if there is no complement. COST: sequentially that of traverse. Otherwise O(n log
// n) steps, of which O(n) are operations on R, and for a tree of any shape a span of O(log^2 n) of
// these above grains of `grain` nodes.
//
// Why the identities: on the way up from a node to an ancestor, x becomes x n a or x u a, again and
// again. Such steps compose: each is (x n a) u b, where the identities fill in what a step has not,
// and
// (((x n a) u b) n c) u d = (x n (a n c)) u ((b n c) u d). So half of a long way can be computed
// before the other half is known. The way that is cut in half is the heavy one, from child to
// largest child; what leaves it is at most half as large.
//
// Source: the CSG skeleton of Deldarie, Davy and Dew (solve, intersect, union and the two
// identities), after Tilove; composition of steps: tree contraction of Miller and Reif; the heavy
// paths are ours.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/skeleton/divacon.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::csg {

struct NoComplement {
  template <class R>
  R operator()(const R&) const {
    throw Error(ErrorId::BadArgument, {"a difference", "a complement to evaluate it with"});
  }
};

template <class R, class Intersect, class Unite, class Complement = NoComplement>
struct SetAlgebra {
  Intersect intersect;
  Unite unite;
  R identity_of_intersection;
  R identity_of_union;
  Complement complement{};
};
template <class R, class Intersect, class Unite>
SetAlgebra(Intersect, Unite, R, R) -> SetAlgebra<R, Intersect, Unite>;
template <class R, class Intersect, class Unite, class Complement>
SetAlgebra(Intersect, Unite, R, R, Complement) -> SetAlgebra<R, Intersect, Unite, Complement>;

template <class S, class R>
concept CombinesSets = std::copyable<R> && requires(const S& algebra, const R& r) {
  { algebra.intersect(r, r) } -> std::convertible_to<R>;
  { algebra.unite(r, r) } -> std::convertible_to<R>;
  { algebra.complement(r) } -> std::convertible_to<R>;
  { algebra.identity_of_intersection } -> std::convertible_to<R>;
  { algebra.identity_of_union } -> std::convertible_to<R>;
};

namespace detail {

template <class R, class Algebra>
R combine_sets(const Algebra& algebra, const R& a, BooleanOperator op, const R& b) {
  switch (op) {
    case BooleanOperator::Union:
      return algebra.unite(a, b);
    case BooleanOperator::Intersection:
      return algebra.intersect(a, b);
    case BooleanOperator::Difference:
      return algebra.intersect(a, algebra.complement(b));
    case BooleanOperator::SymmetricDifference:
      return algebra.unite(algebra.intersect(a, algebra.complement(b)),
                           algebra.intersect(b, algebra.complement(a)));
  }
  return a;
}

template <class R, class T, class Solve, class Algebra>
R traverse_sets(const T& tree, Solve& solve, const Algebra& algebra) {
  return traverse(
      tree, [&](const typename T::Primitive& primitive) -> R { return solve(primitive); },
      [&](const R& a, BooleanOperator op, const R& b) { return combine_sets(algebra, a, op, b); },
      FullEmptyResult{[&]() -> R { return algebra.identity_of_intersection; },
                      [&]() -> R { return algebra.identity_of_union; }});
}

template <class P, class O, class R, class Solve, class Algebra>
class SetSkeleton {
 public:
  using T = Tree<P, O>;

  // A node, or its complement, in a tree of unions and intersections only (De Morgan).
  struct Signed {
    const T* node;
    bool is_complemented;
  };
  // x becomes x u operand, or x n operand.
  struct Step {
    Signed operand;
    bool unites;
  };
  // Steps first .. last - 1 of a way upwards.
  struct Way {
    std::shared_ptr<const std::vector<Step>> steps;
    std::size_t first;
    std::size_t last;
  };
  // Only a SymmetricDifference: it is no such step of any of its operands.
  struct Toggles {
    Signed node;
  };
  using Problem = std::variant<Signed, Way, Toggles>;
  // x -> (x n factor) u term. A value is such a function that forgets x.
  struct Function {
    R factor;
    R term;
  };
  using Result = Function;

  SetSkeleton(Solve& solve, const Algebra& algebra, std::uint64_t grain)
      : solve_(solve), algebra_(algebra), grain_(grain) {}

  skeleton::Expansion<Function, std::vector<Problem>> expand(Problem& problem) const {
    if (const auto* node = std::get_if<Signed>(&problem)) return expand_node(*node);
    if (const auto* way = std::get_if<Way>(&problem)) return expand_way(*way);
    std::vector<Problem> operands;
    for (const T& child : std::get_if<Toggles>(&problem)->node.node->children()) {
      operands.push_back(Signed{&child, false});
    }
    return skeleton::Divided{std::move(operands)};
  }

  Function combine(std::span<Function> results, const Problem& problem) const {
    if (const auto* toggles = std::get_if<Toggles>(&problem)) {
      R value = std::move(results[0].term);
      for (Function& operand : results.subspan(1)) {
        value = combine_sets(algebra_, value, BooleanOperator::SymmetricDifference, operand.term);
      }
      return constant(with_sign(std::move(value), toggles->node.is_complemented));
    }
    if (results.size() == 2) return compose(results[0], results[1]);
    const auto* way = std::get_if<Way>(&problem);
    if (way == nullptr) return std::move(results[0]);
    return step_function((*way->steps)[way->first].unites, std::move(results[0].term));
  }

 private:
  Function constant(R value) const { return {algebra_.identity_of_union, std::move(value)}; }
  Function step_function(bool unites, R operand) const {
    if (unites) return {algebra_.identity_of_intersection, std::move(operand)};
    return {std::move(operand), algebra_.identity_of_union};
  }
  Function compose(const Function& first, const Function& then) const {
    return {algebra_.intersect(first.factor, then.factor),
            algebra_.unite(algebra_.intersect(first.term, then.factor), then.term)};
  }
  R with_sign(R value, bool is_complemented) const {
    if (!is_complemented) return value;
    return algebra_.complement(value);
  }
  R value_of(const Signed& of) const {
    return with_sign(traverse_sets<R>(*of.node, solve_, algebra_), of.is_complemented);
  }

  static BooleanOperator operation_of(const T& node) {
    const O& operation = node.operation();
    return operation;
  }
  bool is_small(const T& node) const { return !node.is_compose() || node.node_count() <= grain_; }

  skeleton::Expansion<Function, std::vector<Problem>> expand_node(Signed node) const {
    if (is_small(*node.node)) return skeleton::Solved{constant(value_of(node))};
    std::vector<Step> downwards;
    while (!is_small(*node.node) &&
           operation_of(*node.node) != BooleanOperator::SymmetricDifference) {
      node = step_down(node, downwards);
    }
    std::vector<Problem> parts;
    if (is_small(*node.node)) {
      parts.push_back(node);
    } else {
      parts.push_back(Toggles{node});
    }
    const std::size_t count = downwards.size();
    if (count == 0) return skeleton::Divided{std::move(parts)};
    parts.push_back(Way{
        std::make_shared<const std::vector<Step>>(downwards.rbegin(), downwards.rend()), 0, count});
    return skeleton::Divided{std::move(parts)};
  }

  // To the largest child; what the others do to it is written down.
  static Signed step_down(const Signed& above, std::vector<Step>& steps) {
    const BooleanOperator op = operation_of(*above.node);
    const auto children = above.node->children();
    std::size_t heavy = 0;
    for (std::size_t i = 1; i < children.size(); ++i) {
      if (children[i].node_count() > children[heavy].node_count()) heavy = i;
    }
    const bool unites = (op == BooleanOperator::Union) != above.is_complemented;
    const auto child = [&](std::size_t i) {
      const bool is_subtracted = op == BooleanOperator::Difference && i > 0;
      return Signed{&children[i], is_subtracted != above.is_complemented};
    };
    for (std::size_t i = children.size(); i-- > 0;) {
      if (i != heavy) steps.push_back({child(i), unites});
    }
    return child(heavy);
  }

  skeleton::Expansion<Function, std::vector<Problem>> expand_way(const Way& way) const {
    const auto steps = std::span(*way.steps).subspan(way.first, way.last - way.first);
    std::uint64_t weight = 0;
    for (const Step& step : steps) weight += step.operand.node->node_count();
    if (weight <= grain_) return skeleton::Solved{along(steps)};
    if (steps.size() == 1) return skeleton::Divided{std::vector<Problem>{steps[0].operand}};
    std::size_t middle = 0;
    for (std::uint64_t half = 0; 2 * half < weight; ++middle) {
      half += steps[middle].operand.node->node_count();
    }
    middle = std::clamp<std::size_t>(middle, 1, steps.size() - 1);
    return skeleton::Divided{std::vector<Problem>{Way{way.steps, way.first, way.first + middle},
                                                  Way{way.steps, way.first + middle, way.last}}};
  }

  Function along(std::span<const Step> steps) const {
    Function sum{algebra_.identity_of_intersection, algebra_.identity_of_union};
    for (const Step& step : steps) {
      const R operand = value_of(step.operand);
      if (step.unites) {
        sum.term = algebra_.unite(sum.term, operand);
      } else {
        sum.factor = algebra_.intersect(sum.factor, operand);
        sum.term = algebra_.intersect(sum.term, operand);
      }
    }
    return sum;
  }

  Solve& solve_;
  const Algebra& algebra_;
  std::uint64_t grain_;
};

}  // namespace detail

constexpr std::uint64_t default_skeleton_grain = 2048;

template <class P, std::convertible_to<BooleanOperator> O, std::invocable<const P&> Solve, class R,
          class Intersect, class Unite, class Complement, class E = skeleton::SequentialExecutor>
requires CombinesSets<SetAlgebra<R, Intersect, Unite, Complement>, R> R
set_skeleton(const Tree<P, O>& tree, Solve&& solve,
             const SetAlgebra<R, Intersect, Unite, Complement>& algebra, const E& executor = {},
             std::uint64_t grain = default_skeleton_grain) {
  using Algebra = SetAlgebra<R, Intersect, Unite, Complement>;
  if constexpr (std::same_as<E, skeleton::SequentialExecutor>) {
    return detail::traverse_sets<R>(tree, solve, algebra);
  } else {
    using Skeleton = detail::SetSkeleton<P, O, R, std::remove_reference_t<Solve>, Algebra>;
    using Problem = typename Skeleton::Problem;
    using Function = typename Skeleton::Function;
    const Skeleton run(solve, algebra, grain);
    return skeleton::divacon(
               Problem(typename Skeleton::Signed{&tree, false}),
               [&](Problem& problem) { return run.expand(problem); },
               [&](std::span<Function> results, const Problem& problem) {
                 return run.combine(results, problem);
               },
               executor)
        .term;
  }
}

template <class P, std::convertible_to<BooleanOperator> O, class Query,
          std::invocable<const P&, const Query&> Solve, class R, class Intersect, class Unite,
          class Complement, class E = skeleton::SequentialExecutor>
R set_skeleton(const Tree<P, O>& tree, const Query& query, Solve&& solve,
               const SetAlgebra<R, Intersect, Unite, Complement>& algebra, const E& executor = {},
               std::uint64_t grain = default_skeleton_grain) {
  return set_skeleton(
      tree, [&](const P& primitive) -> R { return solve(primitive, query); }, algebra, executor,
      grain);
}

}  // namespace exactcsg::csg
