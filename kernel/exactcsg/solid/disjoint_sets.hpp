// SPDX-License-Identifier: Apache-2.0
#pragma once

// Disjoint sets of numbers that several threads unite at once.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace exactcsg {

// LAW disjoint_sets.1  find gives the smallest number of a set, so that what it gives when all are
// united depends neither on the order of the calls nor on the threads.
// Source: R. J. Anderson and H. Woll, Wait-free parallel algorithms for the union-find problem.
class DisjointSets {
 public:
  // Every number below `count` is a set of its own.
  explicit DisjointSets(std::size_t count) : parent_(count) {
    for (std::size_t i = 0; i < count; ++i) {
      parent_[i].store(static_cast<std::uint32_t>(i), std::memory_order_relaxed);
    }
  }

  // Asks for what find(item) reads first.
  void prefetch(std::uint32_t item) const { __builtin_prefetch(&parent_[item]); }

  // Any thread may call this while others unite.
  std::uint32_t find(std::uint32_t item) {
    while (true) {
      const std::uint32_t parent = parent_of(item);
      if (parent == item) return item;
      // Halves the way. Only roots are ever roots, and an ancestor stays one: whatever another
      // thread writes here at the same time is as good.
      const std::uint32_t above = parent_of(parent);
      if (above != parent) parent_[item].store(above, std::memory_order_relaxed);
      item = above;
    }
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    while (true) {
      a = find(a);
      b = find(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t root = a;
      if (parent_[a].compare_exchange_weak(root, b, std::memory_order_relaxed)) return;
    }
  }

 private:
  std::uint32_t parent_of(std::uint32_t item) const {
    return parent_[item].load(std::memory_order_relaxed);
  }

  std::vector<std::atomic<std::uint32_t>> parent_;
};

}  // namespace exactcsg
