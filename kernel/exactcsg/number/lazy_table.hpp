// SPDX-License-Identifier: Apache-2.0
#pragma once

// A table of values that are computed when they are first asked for, by any thread. Two threads may
// both compute an entry; the first to publish it wins and the other deletes its own.

#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

namespace exactcsg {

template <class T>
class LazyTable {
 public:
  LazyTable() = default;
  explicit LazyTable(std::size_t size) : size_(size), entries_(new std::atomic<const T*>[size]()) {}
  LazyTable(LazyTable&& other) noexcept
      : size_(std::exchange(other.size_, 0)), entries_(std::move(other.entries_)) {}
  LazyTable& operator=(LazyTable&& other) noexcept {
    std::swap(size_, other.size_);
    std::swap(entries_, other.entries_);
    return *this;
  }
  ~LazyTable() {
    for (std::size_t i = 0; i < size_; ++i) delete entries_[i].load(std::memory_order_acquire);
  }

  // Before any thread asks for entry i, which is known already.
  void set(std::size_t i, std::unique_ptr<const T> value) {
    delete entries_[i].exchange(value.release(), std::memory_order_acq_rel);
  }

  // Entry i if it is known.
  const T* known(std::size_t i) const { return entries_[i].load(std::memory_order_acquire); }

  // `compute()` returns the value. The reference lives as long as the table.
  template <class Compute>
  const T& get(std::size_t i, const Compute& compute) const {
    std::atomic<const T*>& entry = entries_[i];
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
  std::size_t size_ = 0;
  std::unique_ptr<std::atomic<const T*>[]> entries_;
};

}  // namespace exactcsg
