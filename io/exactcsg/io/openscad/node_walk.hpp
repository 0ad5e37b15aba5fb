// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The walk over the nodes of a .csg file that both rounding modes share: modifiers, unknown nodes,
// positions of errors, and an explicit stack instead of recursion. What a node means is said by a
// builder.
//
// A builder has
//   Context                                   what a node hands down to its children
//   Outcome                                   what a node hands up; has a member `std::uint32_t
//   node` Context root(); Context below(NodeKind, node, const Context&);           of the children
//   of an inner node Outcome leaf(NodeKind, node, const Context&); Outcome inner(NodeKind, node,
//   const Context&, span<Outcome> children);
//
// LAW walk.1  the results of the children of a node are handed up in the order of the file; nodes
//             under % or * are not visited; under !, only that subtree is.
// LAW walk.2  an Error without position leaves with that of its node.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/io/openscad/arguments.hpp"
#include "exactcsg/io/openscad/node_kind.hpp"
#include "exactcsg/io/openscad/syntax.hpp"

namespace exactcsg::io::openscad {

template <class Builder>
class NodeWalk {
 public:
  using Context = typename Builder::Context;
  using Outcome = typename Builder::Outcome;

  NodeWalk(const SyntaxTree& tree, Builder& builder, Warnings& warnings, Progress* progress)
      : tree_(tree), builder_(builder), warnings_(warnings), progress_(progress) {}

  // The outcomes of the statements of the file (or of the one with the modifier !).
  std::vector<Outcome> run() {
    std::uint32_t begin = 0;
    auto end = static_cast<std::uint32_t>(tree_.nodes.size());
    if (const auto root = find_root()) {
      begin = *root;
      end = tree_.nodes[*root].end;
    }
    if (progress_ != nullptr) progress_->begin("read", end - begin);
    for (std::uint32_t node = begin; node < end; node = tree_.nodes[node].end) {
      enter(node, builder_.root());
      while (!frames_.empty()) step();
    }
    return std::move(results_);
  }

 private:
  struct Frame {
    std::uint32_t node;
    std::uint32_t next;
    NodeKind kind;
    std::size_t first_result;
    Context context;
    Context below;
  };

  std::optional<std::uint32_t> find_root() const {
    for (std::uint32_t i = 0; i < tree_.nodes.size();) {
      const Modifiers& modifiers = tree_.nodes[i].modifiers;
      if (modifiers.root) return i;
      i = modifiers.background || modifiers.disabled ? tree_.nodes[i].end : i + 1;
    }
    return std::nullopt;
  }

  SourcePosition position(std::uint32_t node) const {
    return tree_.position(tree_.nodes[node].offset);
  }

  void step() {
    Frame& frame = frames_.back();
    const std::uint32_t end = tree_.nodes[frame.node].end;
    if (frame.next == end) {
      const Frame done = std::move(frame);
      frames_.pop_back();
      leave(done);
      return;
    }
    const std::uint32_t child = frame.next;
    frame.next = tree_.nodes[child].end;
    // Given away with the last child, so that the contexts of a long chain are not all kept.
    enter(child, frame.next == end ? std::move(frame.below) : Context(frame.below));
  }

  void enter(std::uint32_t index, Context context) {
    const Node& node = tree_.nodes[index];
    if (node.modifiers.background || node.modifiers.disabled) return;
    if (progress_ != nullptr) {
      progress_->advance();
      progress_->check();
    }
    const NodeKind kind = kind_of(index);
    if (!is_leaf(kind)) {
      Context below = builder_.below(kind, index, context);
      if (!has_own_frame(kind)) context = Context();  // nobody else comes back to it
      frames_.push_back(
          {index, index + 1, kind, results_.size(), std::move(context), std::move(below)});
      return;
    }
    if (node.end != index + 1) {
      warnings_.add("'" + std::string(node.name) + "' takes no children: ignored",
                    position(index + 1));
    }
    add_result(index, [&] { return builder_.leaf(kind, index, context); });
  }

  NodeKind kind_of(std::uint32_t index) const {
    const std::string_view name = tree_.nodes[index].name;
    const auto kind = find_node_kind(name);
    constexpr std::size_t longest = 64;
    if (!kind) {
      throw Error(ErrorId::UnknownNode, {"'" + std::string(name.substr(0, longest)) + "'",
                                         suggest_node(name), position(index)});
    }
    if (*kind == NodeKind::Unsupported) {
      throw Error(ErrorId::UnsupportedNode, {"'" + std::string(name) + "'", "", position(index)});
    }
    return *kind;
  }

  void leave(const Frame& frame) {
    add_result(frame.node, [&] {
      Outcome outcome = builder_.inner(frame.kind, frame.node, frame.context,
                                       std::span(results_).subspan(frame.first_result));
      results_.resize(frame.first_result);
      return outcome;
    });
  }

  template <class Function>
  void add_result(std::uint32_t node, const Function& make) {
    try {
      Outcome outcome = make();
      outcome.node = node;
      results_.push_back(std::move(outcome));
    } catch (const Error& error) {
      throw error.at(position(node));
    }
  }

  const SyntaxTree& tree_;
  Builder& builder_;
  Warnings& warnings_;
  Progress* progress_;
  std::vector<Frame> frames_;
  std::vector<Outcome> results_;
};

}  // namespace exactcsg::io::openscad
