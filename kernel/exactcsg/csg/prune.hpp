// SPDX-License-Identifier: Apache-2.0
#pragma once

// Localises a CSG tree: primitives that are known to be Full or Empty in some region are replaced
// by that, and the operators above them simplify. [Exact]
//
//   prune(tree, classify) -> Tree                          shares what did not change
//   prune_into(tree, classify, flat destination, scratch)  allocates nothing at need
//
// classify(primitive) -> Membership: Out puts Empty in its place, In puts Full, Unknown keeps it.
//
// LAW prune.1  for every assignment of In and Out to the primitives that agrees with classify where
//              that is not Unknown, the result has the membership of the original tree.
// LAW prune.2  prune hands back the same handle where nothing changed.
// LAW prune.3  the result is Empty, or Full, or has neither in it except as the first operand of a
//              Difference (the complement Full - P) or the last of a SymmetricDifference (the
//              complement of the others); no operator has a single operand. So Empty, Full and a
//              single primitive are recognised in O(1).
// LAW prune.4  pruning again by the same classification hands back the same handle (prune), or a
// tree
//              of at most as many nodes (prune_into, which may find more to merge).
// LAW prune.5  prune_into also merges nested operators (a u (b u c) becomes a u b u c); as a truth
//              function its result equals that of prune.
// LAW prune.6  of trees with attributes: CutOff{classify, decide} in place of classify asks
//              decide(attribute) -> Membership at every node that has an attribute first; what is
//              not Unknown is taken for all of the node's subtree, whose primitives are then not
//              classified. Where that is the membership of the subtree, LAW prune.1 holds.
//              Attributes stay as they were: those of a changed tree may be made anew.
// Operands that cannot matter any more are not classified. No recursion.
// REQUIRES classify answers alike for equal primitives during one call.
// COST: prune O(nodes), a node that the source shares counting once; prune_into O(occurrences of
// nodes), one pass over the source and at most one over the result. prune_into allocates only where
// the capacity of destination (never more than the source's nodes) or of scratch does not suffice.
//
// Source: Davy and Dew, section 3.4 (Full - P must be kept); Woodwark, Bowyer and others (Bath) for
// pruning; one algorithm serves both memory layouts.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/operator_laws.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/csg/tree_concept.hpp"

namespace exactcsg::csg {

template <class F, class P>
concept ClassifiesPrimitive = std::is_invocable_r_v<Membership, F&, const P&>;

namespace detail {

// What a pruned subtree has become. Kept: it is what the sink has received since its mark.
enum class Pruned : std::uint8_t { Empty, Full, Kept };

constexpr Pruned pruned(Constant constant) noexcept {
  return constant == Constant::Full ? Pruned::Full : Pruned::Empty;
}
constexpr Constant constant(Pruned outcome) noexcept {
  return outcome == Pruned::Full ? Constant::Full : Constant::Empty;
}
constexpr Constant opposite(Constant value) noexcept {
  return value == Constant::Full ? Constant::Empty : Constant::Full;
}

// A composed node of the source whose operands are being pruned.
template <class Cursor, class O, class Mark>
struct PruneFrame {
  Cursor self;
  Cursor child;
  Cursor end;
  Mark mark;  // where its result begins in the sink
  std::size_t kept = 0;
  KeptOperation<Cursor, O> operation;
  Position position = Position::First;
  bool complemented = false;   // the result is the complement of what is kept
  bool only_constant = false;  // what is kept is one constant operand
};

// The algorithm of both prunings. It decides; the sink builds the result:
//   recall(node) -> optional<Pruned>  the pruned subtree, if the sink has it in store and took it
//   remember(node, outcome)           a composed node is done
//   begin() -> Mark                   a composed node begins
//   keep(node), keep(constant)        an operand of the composed node that began last
//   discard(mark)                     the node is a constant: forget what it received
//   collapse(mark)                    the node is its only operand
//   merge(mark)                       its operands become operands of the node above
//   finish(node, mark)                the node stays
template <class Cursor, PrunableOperator O, class Classify, class Sink>
class Pruner {
 public:
  using Frame = PruneFrame<Cursor, O, typename Sink::Mark>;

  Pruner(Classify& classify, Sink& sink, std::vector<Frame>& frames)
      : classify_(classify), sink_(sink), frames_(frames) {
    frames_.clear();
  }

  Pruned run(Cursor node) {
    for (;;) {
      Result result = descend(node);
      while (!frames_.empty()) {
        Frame& top = frames_.back();
        if (const auto decided = receive(top, result)) {
          sink_.discard(top.mark);
          result = {pruned(*decided)};
        } else {
          top.child = top.child.next_sibling();
          if (!(top.child == top.end)) {
            node = top.child;
            break;
          }
          result = close(top);
        }
        sink_.remember(top.self, result.outcome);
        frames_.pop_back();
      }
      if (frames_.empty()) return result.outcome;
    }
  }

 private:
  struct Result {
    Pruned outcome;
    std::size_t operands = 1;
  };

  // Opens composed nodes down to the first leaf, and prunes that.
  Result descend(Cursor node) {
    for (;;) {
      if constexpr (is_cut_off<Classify>) {
        if (const std::optional<Pruned> known = cut_off(node)) return {*known};
      }
      if (node.kind() != NodeKind::Compose) break;
      if (const std::optional<Pruned> known = sink_.recall(node)) return {*known};
      const Cursor child = node.first_child();
      frames_.push_back({node, child, node.children_end(), sink_.begin(), 0, node.operation()});
      node = child;
    }
    if (node.kind() != NodeKind::Primitive) {
      return {node.kind() == NodeKind::Full ? Pruned::Full : Pruned::Empty};
    }
    switch (static_cast<Membership>(classify_(node.primitive()))) {
      case Membership::Out:
        return {Pruned::Empty};
      case Membership::In:
        return {Pruned::Full};
      case Membership::Unknown:
        break;
    }
    sink_.keep(node);
    return {Pruned::Kept};
  }

  std::optional<Pruned> cut_off(Cursor node) {
    if (node.kind() == NodeKind::Full || node.kind() == NodeKind::Empty) return std::nullopt;
    switch (static_cast<Membership>(decided(node, classify_))) {
      case Membership::Out:
        return Pruned::Empty;
      case Membership::In:
        return Pruned::Full;
      case Membership::Unknown:
        break;
    }
    return std::nullopt;
  }

  // Takes the next operand; returns the value of the whole node if that decides it.
  std::optional<Constant> receive(Frame& frame, const Result& operand) {
    const Position position = std::exchange(frame.position, Position::Later);
    if (operand.outcome == Pruned::Kept) {
      frame.kept += operand.operands;
      frame.only_constant = false;
      return std::nullopt;
    }
    const O& operation = frame.operation;
    switch (react(operation, position, constant(operand.outcome))) {
      case Reaction::Drop:
        break;
      case Reaction::BecomeEmpty:
        return Constant::Empty;
      case Reaction::BecomeFull:
        return Constant::Full;
      case Reaction::Keep:
        sink_.keep(constant(operand.outcome));
        frame.only_constant = frame.kept++ == 0;
        break;
      case Reaction::Complement:
        frame.complemented = !frame.complemented;
        break;
    }
    return std::nullopt;
  }

  // All operands are there.
  Result close(Frame& frame) {
    if (frame.kept == 0) {
      const O& operation = frame.operation;
      const Constant value = neutral(operation);
      sink_.discard(frame.mark);
      return {pruned(frame.complemented ? opposite(value) : value)};
    }
    if (frame.only_constant) {  // LAW react.2: a kept constant is Full
      sink_.discard(frame.mark);
      return {Pruned::Full};
    }
    const bool merges = merges_into_parent(frame);
    if (frame.complemented) {
      if (merges) {
        Frame& parent = frames_[frames_.size() - 2];
        parent.complemented = !parent.complemented;
      } else {
        sink_.keep(Constant::Full);
        ++frame.kept;
      }
    }
    if (frame.kept == 1) {
      sink_.collapse(frame.mark);
      return {Pruned::Kept};
    }
    if (merges) {
      sink_.merge(frame.mark);
      return {Pruned::Kept, frame.kept};
    }
    sink_.finish(frame.self, frame.mark);
    return {Pruned::Kept};
  }

  bool merges_into_parent(const Frame& frame) const {
    if constexpr (Sink::merges_nested) {
      if (frames_.size() < 2) return false;
      const Frame& parent = frames_[frames_.size() - 2];
      const O& outer = parent.operation;
      const O& inner = frame.operation;
      return splices(outer, parent.position, inner);
    } else {
      return false;
    }
  }

  Classify& classify_;
  Sink& sink_;
  std::vector<Frame>& frames_;
};

// Builds a tree of handles, every composed node after its operands. Handles of the source are not
// copied before they are needed: copies count references, on which threads that prune trees with
// common nodes would wait for each other.
template <class P, class O>
class HandleSink {
 public:
  using Cursor = typename Tree<P, O>::Cursor;
  using Mark = std::size_t;
  static constexpr bool merges_nested = false;  // LAW prune.2 comes first

  std::optional<Pruned> recall(Cursor node) {
    if (!node.tree().is_shared()) return std::nullopt;
    const auto known = known_.find(node.tree().identity());
    if (known == known_.end()) return std::nullopt;
    if (known->second.is_empty()) return Pruned::Empty;
    if (known->second.is_full()) return Pruned::Full;
    keep(known->second);
    return Pruned::Kept;
  }
  void remember(Cursor node, Pruned outcome) {
    if (node.tree().is_shared()) known_.emplace(node.tree().identity(), value(outcome));
  }
  Mark begin() const noexcept { return kept_.size(); }
  void keep(Cursor node) { keep(node.tree()); }
  void keep(Constant constant) {
    kept_.push_back(
        {nullptr, constant == Constant::Full ? Tree<P, O>::full() : Tree<P, O>::empty()});
  }
  void discard(Mark mark) { kept_.resize(mark); }
  void collapse(Mark) noexcept {}
  void merge(Mark) noexcept {}
  void finish(Cursor node, Mark mark) {
    const auto first = kept_.begin() + static_cast<std::ptrdiff_t>(mark);
    const auto before = node.tree().children();
    const bool unchanged =
        std::equal(first, kept_.end(), before.begin(), before.end(),
                   [](const Kept& a, const Tree<P, O>& b) { return same_handle(a.tree(), b); });
    if (unchanged) {
      discard(mark);
      return keep(node);
    }
    for (auto kept = first; kept != kept_.end(); ++kept) operands_.push_back(kept->take());
    auto composed = Tree<P, O>::compose_from(node.operation(), std::span(operands_));
    operands_.clear();
    discard(mark);
    kept_.push_back({nullptr, std::move(composed)});
  }
  // REQUIRES the last to be done had this outcome.
  Tree<P, O> value(Pruned outcome) const {
    switch (outcome) {
      case Pruned::Empty:
        return Tree<P, O>::empty();
      case Pruned::Full:
        return Tree<P, O>::full();
      case Pruned::Kept:
        break;
    }
    return kept_.back().tree();
  }

 private:
  // A handle of the source or of known_, or one of our own.
  struct Kept {
    const Tree<P, O>* lent;
    Tree<P, O> own;
    const Tree<P, O>& tree() const noexcept { return lent != nullptr ? *lent : own; }
    Tree<P, O> take() noexcept { return lent != nullptr ? *lent : std::move(own); }
  };

  void keep(const Tree<P, O>& lent) { kept_.push_back({&lent, {}}); }

  std::vector<Kept> kept_;
  std::vector<Tree<P, O>> operands_;
  std::unordered_map<const void*, Tree<P, O>> known_;
};

// Builds a flat tree in pre-order. The node of an operator is written before it is known whether it
// will stay; one that does not gets extent 0 and is removed in the end, in one pass. (Moving its
// operands at once would be quadratic in a chain of such nodes.)
template <class P, class O>
class FlatSink {
 public:
  struct Mark {
    std::uint32_t index;
    std::uint32_t removed;
  };
  static constexpr bool merges_nested = true;

  explicit FlatSink(FlatTree<P, O>& destination) : nodes_(destination.nodes_) { nodes_.clear(); }

  template <class Cursor>
  std::optional<Pruned> recall(Cursor) const noexcept {
    return std::nullopt;
  }
  template <class Cursor>
  void remember(Cursor, Pruned) const noexcept {}

  Mark begin() {
    const Mark mark{static_cast<std::uint32_t>(nodes_.size()), removed_};
    append(NodeKind::Compose, {});
    return mark;
  }
  template <class Cursor>
  void keep(Cursor node) {
    append(NodeKind::Primitive, node.primitive());
  }
  void keep(Constant constant) {
    append(constant == Constant::Full ? NodeKind::Full : NodeKind::Empty, {});
  }
  void discard(Mark mark) {
    nodes_.erase(nodes_.begin() + static_cast<std::ptrdiff_t>(mark.index), nodes_.end());
    removed_ = mark.removed;
  }
  void collapse(Mark mark) noexcept {
    nodes_[mark.index].extent = 0;
    ++removed_;
  }
  void merge(Mark mark) noexcept { collapse(mark); }
  template <class Cursor>
  void finish(Cursor node, Mark mark) noexcept {
    nodes_[mark.index].operation = node.operation();
    nodes_[mark.index].extent =
        static_cast<std::uint32_t>(nodes_.size()) - mark.index - (removed_ - mark.removed);
  }
  void complete(Pruned outcome) {
    if (outcome != Pruned::Kept) return keep(constant(outcome));
    if (removed_ != 0) std::erase_if(nodes_, [](const auto& node) { return node.extent == 0; });
  }

 private:
  void append(NodeKind kind, const P& primitive) {
    if (nodes_.size() == std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorId::TooLarge, {"more than 2^32 - 1 nodes in one flat tree", ""});
    }
    nodes_.push_back({1, kind, {}, primitive});
  }

  std::vector<typename FlatTree<P, O>::Node>& nodes_;
  std::uint32_t removed_ = 0;
};

}  // namespace detail

// The stack of prune_into, kept by the caller between calls. REQUIRES not used by two calls at
// once.
template <ReadableTree T>
class PruneScratch {
 public:
  using Frame = detail::PruneFrame<
      typename T::Cursor, typename T::Operator,
      typename detail::FlatSink<typename T::Primitive, typename T::Operator>::Mark>;
  std::vector<Frame>& frames() noexcept { return frames_; }

 private:
  std::vector<Frame> frames_;
};

template <class P, PrunableOperator O, ClassifiesPrimitive<P> Classify>
Tree<P, O> prune(const Tree<P, O>& tree, Classify&& classify) {
  using Sink = detail::HandleSink<P, O>;
  using Pruner =
      detail::Pruner<typename Tree<P, O>::Cursor, O, std::remove_reference_t<Classify>, Sink>;
  Sink sink;
  std::vector<typename Pruner::Frame> frames;
  const detail::Pruned outcome = Pruner(classify, sink, frames).run(tree.root());
  return sink.value(outcome);
}

// Without what Empty and Full make superfluous: prune with nothing known of the primitives.
template <class P, PrunableOperator O>
Tree<P, O> simplify(const Tree<P, O>& tree) {
  return prune(tree, [](const P&) { return Membership::Unknown; });
}

// REQUIRES destination is not the source.
template <ReadableTree T, ClassifiesPrimitive<typename T::Primitive> Classify>
requires PrunableOperator<typename T::Operator>
void prune_into(const T& source, Classify&& classify,
                FlatTree<typename T::Primitive, typename T::Operator>& destination,
                PruneScratch<T>& scratch) {
  using O = typename T::Operator;
  using Sink = detail::FlatSink<typename T::Primitive, O>;
  Sink sink(destination);
  detail::Pruner<typename T::Cursor, O, std::remove_reference_t<Classify>, Sink> pruner(
      classify, sink, scratch.frames());
  sink.complete(pruner.run(source.root()));
}

template <ReadableTree T, ClassifiesPrimitive<typename T::Primitive> Classify>
requires PrunableOperator<typename T::Operator>
void prune_into(const T& source, Classify&& classify,
                FlatTree<typename T::Primitive, typename T::Operator>& destination) {
  PruneScratch<T> scratch;
  prune_into(source, classify, destination, scratch);
}

}  // namespace exactcsg::csg
