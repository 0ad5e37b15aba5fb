// SPDX-License-Identifier: Apache-2.0
#pragma once

// A decomposition tree while it is being built: subtrees are joined in O(children), which arrays
// cannot do. gdt::Tree takes it over in the end. Owning, movable, destroyed without recursion.

#include <utility>
#include <variant>
#include <vector>

namespace exactcsg::gdt::detail {

template <class T, class N>
class Subtree {
 public:
  static Subtree terminal(T value) { return Subtree(new Node{std::move(value)}); }
  static Subtree interior(std::vector<Subtree> children, N label) {
    return Subtree(new Node{Interior{std::move(children), std::move(label)}});
  }

  Subtree(Subtree&& other) noexcept : node_(std::exchange(other.node_, nullptr)) {}
  Subtree& operator=(Subtree&& other) noexcept {
    std::swap(node_, other.node_);
    return *this;
  }
  ~Subtree() {
    for (Node* dead = std::exchange(node_, nullptr); dead != nullptr;) {
      Node* const current = dead;
      dead = dead->next_dead;
      if (auto* interior = std::get_if<1>(&current->content)) {
        for (Subtree& child : interior->children) {
          Node* const below = std::exchange(child.node_, nullptr);
          if (below != nullptr) below->next_dead = std::exchange(dead, below);
        }
      }
      delete current;
    }
  }

  bool is_terminal() const noexcept { return node_->content.index() == 0; }
  // REQUIRES is_terminal()
  T& terminal() noexcept { return *std::get_if<0>(&node_->content); }
  // REQUIRES !is_terminal(), these two
  std::vector<Subtree>& children() noexcept { return std::get_if<1>(&node_->content)->children; }
  N& label() noexcept { return std::get_if<1>(&node_->content)->label; }

 private:
  struct Interior {
    std::vector<Subtree> children;
    N label;
  };
  struct Node {
    std::variant<T, Interior> content;
    Node* next_dead = nullptr;
  };
  explicit Subtree(Node* node) noexcept : node_(node) {}

  Node* node_;
};

}  // namespace exactcsg::gdt::detail
