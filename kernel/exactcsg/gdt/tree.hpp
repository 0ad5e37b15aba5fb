// SPDX-License-Identifier: Apache-2.0
#pragma once

// The geometric decomposition tree: the retained form of a recursive division, such as an octree
// whose leaves hold what is known of their cell. [Exact]
//
// A tree is Terminal(T), or Interior with children of any number and a label N (the plane that
// divides the cell, say; none by default). It is a value in three arrays, without pointers.
//
// LAW gdt.1  the children of a node keep their order; so do the terminals, from left to right.
// LAW gdt.2  nothing recurses on the depth: a tree a million deep is copied, traversed, destroyed.
// Reading from several threads at once is safe. A moved-from tree may only be assigned or
// destroyed. COST: 12 bytes a node besides the T and N. At most 2^32 - 2 nodes, else THROWS
// Error(TooLarge).
//
// map(tree, function [, label_function]) is the same tree with function(t) in place of every
// terminal t, and label_function(n) in place of every label n. LAW gdt.3  map keeps the shape, and
// calls each function once a node, terminals from left to right.
//
// Source: Davy and Dew, section 3.3; labels make it the multi-resolution tree of 3.7 as well, and
// let a path be followed (section 6.1 misses that).

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/gdt/subtree.hpp"
#include "exactcsg/skeleton/executor.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::gdt {

struct NoLabel {
  friend bool operator==(NoLabel, NoLabel) = default;
};

template <class T, class N = NoLabel>
class Tree {
 public:
  using Terminal = T;
  using Label = N;

 private:
  static constexpr std::uint32_t terminal_mark = std::numeric_limits<std::uint32_t>::max();

  // The children of a node are neighbours, so that one number leads to any of them.
  struct Record {
    std::uint32_t first_child = 0;
    std::uint32_t degree = terminal_mark;
    std::uint32_t payload = 0;  // of a terminal or label
    friend bool operator==(const Record&, const Record&) = default;
  };

 public:
  struct Children;

  // One node of a tree that outlives it.
  class Node {
   public:
    bool is_terminal() const noexcept { return record().degree == terminal_mark; }
    // REQUIRES is_terminal()
    const T& terminal() const noexcept { return tree_->terminals_[record().payload]; }
    // REQUIRES !is_terminal(), these three; index < degree().
    const N& label() const noexcept { return tree_->labels_[record().payload]; }
    // Of a multi-resolution tree: what is known of this node's part, whichever kind it is.
    const T& geometry() const noexcept requires std::same_as<T, N> {
      return is_terminal() ? terminal() : label();
    }
    std::size_t degree() const noexcept { return record().degree; }
    Node child(std::size_t index) const noexcept {
      return Node(*tree_, record().first_child + static_cast<std::uint32_t>(index));
    }
    // The same node of the same tree, not an equal one.
    friend bool operator==(const Node&, const Node&) = default;
    // REQUIRES !is_terminal()
    Children children() const noexcept { return {child(0), child(degree())}; }

   private:
    friend class Tree;
    friend struct Children;
    Node(const Tree& tree, std::uint32_t index) noexcept : tree_(&tree), index_(index) {}
    const auto& record() const noexcept { return tree_->nodes_[index_]; }
    const Tree* tree_;
    std::uint32_t index_;
  };

  // The range of a node's children. (Clang 14 cannot read the views of libstdc++.)
  struct Children {
    struct Iterator {
      Node node;
      Node operator*() const noexcept { return node; }
      Iterator& operator++() noexcept {
        ++node.index_;
        return *this;
      }
      friend bool operator==(const Iterator&, const Iterator&) = default;
    };
    Node first;
    Node past_last;
    Iterator begin() const noexcept { return {first}; }
    Iterator end() const noexcept { return {past_last}; }
  };

  static Tree terminal(T value) { return Tree(detail::Subtree<T, N>::terminal(std::move(value))); }
  // COST: O(nodes of the children); to build a large tree, use create.
  static Tree interior(std::vector<Tree> children, N label = {});

  // Makes a tree from what a reader meets, in order.
  class Builder {
   public:
    void open(N label);  // an interior node, whose children follow
    void terminal(T value);
    void close();  // REQUIRES an open node
    // REQUIRES every node closed, and exactly one that is not a child of another.
    Tree take() &&;

   private:
    struct Open {
      Record record;
      std::size_t first_done;
    };
    Tree tree_;  // the children of a node are appended when it is closed
    std::vector<Open> open_;
    std::vector<Record> done_;  // whose fathers are open
  };

  // From the linked form that create builds. COST: O(nodes).
  explicit Tree(detail::Subtree<T, N> root);

  Node root() const noexcept { return Node(*this, 0); }
  std::size_t node_count() const noexcept { return nodes_.size(); }
  // From left to right.
  std::span<const T> terminals() const noexcept { return {terminals_.data(), terminals_.size()}; }

  friend bool operator==(
      const Tree&, const Tree&) requires std::equality_comparable<T> && std::equality_comparable<N>
  = default;

  // See map.
  template <class F, class G>
  auto mapped(F& terminal_function, G& label_function) const {
    using U = std::remove_cvref_t<std::invoke_result_t<F&, const T&>>;
    using M = std::remove_cvref_t<std::invoke_result_t<G&, const N&>>;
    Tree<U, M> result;
    result.nodes_.reserve(nodes_.size());
    for (const Record& r : nodes_) {
      const bool counted = r.degree == terminal_mark || !std::is_empty_v<M>;
      result.nodes_.push_back({r.first_child, r.degree, counted ? r.payload : 0});
    }
    result.terminals_.reserve(terminals_.size());
    for (const T& terminal : terminals_) {
      result.terminals_.push_back(std::invoke(terminal_function, terminal));
    }
    if constexpr (!std::is_empty_v<M>) {
      static_assert(!std::is_empty_v<N>, "labels that say nothing cannot be told apart");
      result.labels_.reserve(labels_.size());
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        result.labels_.push_back(std::invoke(label_function, labels_[i]));
      }
    }
    return result;
  }

 private:
  template <class, class>
  friend class Tree;
  // One label is as good as all where it says nothing.
  struct OneLabel {
    N label{};
    const N& operator[](std::size_t) const noexcept { return label; }
    std::size_t size() const noexcept { return 0; }
    void push_back(N) noexcept {}
    friend bool operator==(const OneLabel&, const OneLabel&) { return true; }
  };
  using Labels = std::conditional_t<std::is_empty_v<N>, OneLabel, skeleton::detail::Array<N>>;

  Tree() noexcept = default;
  void fill(std::uint32_t index, detail::Subtree<T, N>& from);
  void adopt(std::size_t index, Tree child);
  static void require_room(std::size_t nodes, std::size_t more);

  std::vector<Record> nodes_;
  Labels labels_;
  skeleton::detail::Array<T> terminals_;
};

template <class T, class N>
void Tree<T, N>::require_room(std::size_t nodes, std::size_t more) {
  if (more >= terminal_mark - nodes) {
    throw Error(ErrorId::TooLarge, {"more than 2^32 - 2 nodes in a decomposition tree", ""});
  }
}

template <class T, class N>
void Tree<T, N>::Builder::open(N label) {
  const auto index = static_cast<std::uint32_t>(tree_.labels_.size());
  tree_.labels_.push_back(std::move(label));
  open_.push_back({{0, 0, index}, done_.size()});
}

template <class T, class N>
void Tree<T, N>::Builder::terminal(T value) {
  require_room(tree_.terminals_.size(), 1);
  done_.push_back({0, terminal_mark, static_cast<std::uint32_t>(tree_.terminals_.size())});
  tree_.terminals_.push_back(std::move(value));
}

template <class T, class N>
void Tree<T, N>::Builder::close() {
  const auto first = done_.begin() + static_cast<std::ptrdiff_t>(open_.back().first_done);
  const auto degree = static_cast<std::size_t>(done_.end() - first);
  require_room(tree_.nodes_.size(), degree);
  Record record = open_.back().record;
  record.first_child = static_cast<std::uint32_t>(tree_.nodes_.size());
  record.degree = static_cast<std::uint32_t>(degree);
  tree_.nodes_.insert(tree_.nodes_.end(), first, done_.end());
  done_.erase(first, done_.end());
  done_.push_back(record);
  open_.pop_back();
}

// Equal trees have equal arrays: the order of the blocks of children is that of fill.
template <class T, class N>
Tree<T, N> Tree<T, N>::Builder::take() && {
  std::vector<Record> nodes{done_.back()};
  nodes.reserve(tree_.nodes_.size() + 1);
  std::vector<std::uint32_t> pending{0};
  while (!pending.empty()) {
    Record& record = nodes[pending.back()];
    pending.pop_back();
    if (record.degree == terminal_mark) continue;
    const auto first = tree_.nodes_.begin() + record.first_child;
    record.first_child = static_cast<std::uint32_t>(nodes.size());
    for (std::uint32_t i = record.degree; i-- > 0;) pending.push_back(record.first_child + i);
    nodes.insert(nodes.end(), first, first + record.degree);
  }
  tree_.nodes_ = std::move(nodes);
  return std::move(tree_);
}

template <class T, class N>
void Tree<T, N>::fill(std::uint32_t index, detail::Subtree<T, N>& from) {
  if (from.is_terminal()) {
    nodes_[index].payload = static_cast<std::uint32_t>(terminals_.size());
    terminals_.push_back(std::move(from.terminal()));
    return;
  }
  const std::size_t degree = from.children().size();
  require_room(nodes_.size(), degree);
  nodes_[index] = {static_cast<std::uint32_t>(nodes_.size()), static_cast<std::uint32_t>(degree),
                   static_cast<std::uint32_t>(labels_.size())};
  labels_.push_back(std::move(from.label()));
  nodes_.resize(nodes_.size() + degree);
}

// Takes the subtrees apart from left to right; each dies as soon as it has been copied.
template <class T, class N>
Tree<T, N>::Tree(detail::Subtree<T, N> root) {
  std::vector<std::pair<std::uint32_t, detail::Subtree<T, N>>> pending;
  nodes_.emplace_back();
  pending.emplace_back(0U, std::move(root));
  while (!pending.empty()) {
    const auto index = pending.back().first;
    detail::Subtree<T, N> subtree = std::move(pending.back().second);
    pending.pop_back();
    fill(index, subtree);
    if (subtree.is_terminal()) continue;
    auto children = std::move(subtree.children());
    const std::uint32_t first = nodes_[index].first_child;
    for (std::size_t i = children.size(); i-- > 0;) {
      pending.emplace_back(first + static_cast<std::uint32_t>(i), std::move(children[i]));
    }
  }
}

template <class T, class N>
Tree<T, N> Tree<T, N>::interior(std::vector<Tree> children, N label) {
  Tree result;
  result.nodes_.push_back({1, static_cast<std::uint32_t>(children.size()), 0});
  result.labels_.push_back(std::move(label));
  result.nodes_.resize(1 + children.size());
  for (std::size_t i = 0; i < children.size(); ++i) result.adopt(1 + i, std::move(children[i]));
  return result;
}

template <class T, class N>
void Tree<T, N>::adopt(std::size_t index, Tree child) {
  require_room(nodes_.size(), child.nodes_.size());
  const auto nodes_before = static_cast<std::uint32_t>(nodes_.size() - 1);  // less the child's root
  const auto terminals_before = static_cast<std::uint32_t>(terminals_.size());
  const auto labels_before = static_cast<std::uint32_t>(labels_.size());
  const auto moved = [&](Record record) {
    if (record.degree == terminal_mark) {
      record.payload += terminals_before;
    } else {
      record.payload += labels_before;
      record.first_child += nodes_before;
    }
    return record;
  };
  nodes_[index] = moved(child.nodes_[0]);
  for (std::size_t i = 1; i < child.nodes_.size(); ++i) nodes_.push_back(moved(child.nodes_[i]));
  for (T& terminal : child.terminals_) terminals_.push_back(std::move(terminal));
  for (std::size_t i = 0; i < child.labels_.size(); ++i) {
    labels_.push_back(std::move(child.labels_[i]));
  }
}

template <class T, class N, std::invocable<const T&> F, std::invocable<const N&> G = std::identity>
auto map(const Tree<T, N>& tree, F&& function, G&& label_function = {}) {
  return tree.mapped(function, label_function);
}

}  // namespace exactcsg::gdt
