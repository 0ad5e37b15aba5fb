// SPDX-License-Identifier: Apache-2.0
#pragma once

// A table of values that are computed when they are first asked for, by any thread. Two threads may
// both compute an entry; the first to publish it wins and the other deletes its own.

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace exactcsg {

template <class T>
class LazyTable {
 public:
  LazyTable() = default;
  explicit LazyTable(std::size_t size) : blocks_((size + block_size - 1) / block_size) {}
  LazyTable(LazyTable&&) noexcept = default;
  LazyTable& operator=(LazyTable&& other) noexcept {
    std::swap(blocks_, other.blocks_);
    return *this;
  }
  ~LazyTable() {
    for (const std::atomic<Block*>& place : blocks_) {
      const std::unique_ptr<Block> block(place.load(std::memory_order_acquire));
      if (!block) continue;
      for (const Entry& entry : block->entries) delete entry.load(std::memory_order_acquire);
    }
  }

  // Before any thread asks for entry i, which is known already.
  void set(std::size_t i, std::unique_ptr<const T> value) {
    delete entry(i).exchange(value.release(), std::memory_order_acq_rel);
  }

  // Entry i if it is known.
  const T* known(std::size_t i) const {
    const Block* block = blocks_[i / block_size].load(std::memory_order_acquire);
    if (block == nullptr) return nullptr;
    return block->entries[i % block_size].load(std::memory_order_acquire);
  }

  // `compute()` returns the value. The reference lives as long as the table.
  template <class Compute>
  const T& get(std::size_t i, const Compute& compute) const {
    Entry& entry = this->entry(i);
    if (const T* known = entry.load(std::memory_order_acquire)) return *known;
    auto mine = std::make_unique<const T>(compute());
    const T* winner = nullptr;
    if (entry.compare_exchange_strong(winner, mine.get(), std::memory_order_acq_rel,
                                      std::memory_order_acquire)) {
      winner = mine.release();
    }
    return *winner;
  }

 private:
  using Entry = std::atomic<const T*>;
  static constexpr std::size_t block_size = 512;
  struct Block {
    std::array<Entry, block_size> entries{};
  };

  Entry& entry(std::size_t i) const {
    std::atomic<Block*>& place = blocks_[i / block_size];
    Block* block = place.load(std::memory_order_acquire);
    if (block == nullptr) {
      auto mine = std::make_unique<Block>();
      if (place.compare_exchange_strong(block, mine.get(), std::memory_order_acq_rel,
                                        std::memory_order_acquire)) {
        block = mine.release();
      }
    }
    return block->entries[i % block_size];
  }

  // Null: no entry of the block was asked for. Most tables are nearly empty for good, and the first
  // touch of memory is dear.
  mutable std::vector<std::atomic<Block*>> blocks_;
};

}  // namespace exactcsg
