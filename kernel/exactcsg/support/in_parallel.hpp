// SPDX-License-Identifier: Apache-2.0
#pragma once

// Loops whose rounds do not depend on each other, run on one or several threads.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "exactcsg/support/give_up.hpp"
#include "exactcsg/support/hand_over.hpp"
#include "exactcsg/support/in_arena.hpp"

namespace exactcsg {

// round(i) for every i below count, each once. threads: as in EvaluateOptions.
// An exception of a round is thrown on.
template <class Round>
void in_parallel(unsigned threads, std::size_t count, const Round& round) {
  if (threads == 1 || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) round(i);
    return;
  }
  const std::size_t allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::size_t used =
      std::min({threads == 0 ? allowed : std::size_t{threads}, allowed, count});
  // Every task takes some rounds after the other until none is left.
  const std::size_t at_once = std::max<std::size_t>(1, count / (64 * used));
  std::atomic<std::size_t> next = 0;
  const auto take_rounds = [&] {
    try {
      while (true) {
        const std::size_t begin = next.fetch_add(at_once, std::memory_order_relaxed);
        if (begin >= count) return;
        const std::size_t end = std::min(begin + at_once, count);
        for (std::size_t i = begin; i < end; ++i) round(i);
      }
    } catch (...) {
      next.store(count, std::memory_order_relaxed);
      throw;
    }
  };
  const detail::TakeOverAtEnd before_unwinding(&next);
  // Not more threads than tasks are used anyway.
  const std::size_t places = std::max<std::size_t>(
      used, static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
  detail::in_arena(static_cast<int>(places), [&] {
    tbb::task_group group;
    for (std::size_t task = 1; task < used; ++task) {
      group.run(detail::HandedOver(take_rounds, &next));
    }
    group.run_and_wait(take_rounds);
  });
}

// A long sequence in parts, which do not depend on the number of threads: what is found for each
// part and joined in their order does not either.
class Parts {
 public:
  // Parts that are long enough to be worth a task, and short enough to keep many threads busy.
  explicit Parts(std::size_t count) : Parts(count, [](std::size_t) { return true; }) {}

  // A part begins only where may_begin(i), as it does at 0.
  template <class MayBegin>
  Parts(std::size_t count, const MayBegin& may_begin) {
    const std::size_t size = std::max(least_size, (count + most_parts - 1) / most_parts);
    bounds_.push_back(0);
    while (bounds_.back() < count) {
      std::size_t end = std::min(bounds_.back() + size, count);
      while (end < count && !may_begin(end)) ++end;
      bounds_.push_back(end);
    }
  }

  // Where each part begins, and the end of the last one. Parts may be empty.
  explicit Parts(std::vector<std::size_t> bounds) : bounds_(std::move(bounds)) {}

  std::size_t count() const { return bounds_.size() - 1; }
  std::size_t begin(std::size_t part) const { return bounds_[part]; }
  std::size_t end(std::size_t part) const { return bounds_[part + 1]; }

 private:
  static constexpr std::size_t least_size = 2048;
  static constexpr std::size_t most_parts = 128;
  std::vector<std::size_t> bounds_;
};

// visit(part, begin, end) for every part.
template <class Visit>
void in_parallel(unsigned threads, const Parts& parts, const Visit& visit) {
  in_parallel(threads, parts.count(),
              [&](std::size_t part) { visit(part, parts.begin(part), parts.end(part)); });
}

// round(i) for every i below count, many of which are done at once: for short rounds.
template <class Round>
void in_parallel_parts(unsigned threads, std::size_t count, const Round& round) {
  in_parallel(threads, Parts(count), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) round(i);
  });
}

// For bytes that several threads may set at once.
inline void set_mark(unsigned char& mark) {
  std::atomic_ref(mark).store(1, std::memory_order_relaxed);
}

// Makes a vector longer. The new memory is touched by all threads before the new items are made by
// this one: the first touch of a page costs several times as much as filling it.
template <class Item>
void resize(unsigned threads, std::vector<Item>& items, std::size_t size) {
  constexpr std::size_t page = 4096;
  constexpr std::size_t pages_at_once = 64;
  const std::size_t old_size = items.size();
  items.reserve(size);
  const std::size_t bytes = size > old_size ? (size - old_size) * sizeof(Item) : 0;
  if (threads != 1 && bytes > page * pages_at_once) {
    auto* const memory = static_cast<unsigned char*>(static_cast<void*>(items.data() + old_size));
    in_parallel(threads, bytes / (page * pages_at_once), [&](std::size_t i) {
      for (std::size_t k = 0; k < pages_at_once; ++k) memory[(i * pages_at_once + k) * page] = 0;
    });
  }
  items.resize(size);
}

// Where each of several lists begins when they are joined, and the length of all.
template <class Lists>
std::vector<std::size_t> first_places(const Lists& lists) {
  std::vector<std::size_t> result{0};
  result.reserve(lists.size() + 1);
  for (const auto& list : lists) result.push_back(result.back() + list.size());
  return result;
}

template <class Item>
std::vector<Item> joined(unsigned threads, std::vector<std::vector<Item>> lists) {
  if (lists.size() == 1) return std::move(lists.front());
  const std::vector<std::size_t> places = first_places(lists);
  std::vector<Item> result;
  resize(threads, result, places.back());
  in_parallel(threads, lists.size(), [&](std::size_t i) {
    std::move(lists[i].begin(), lists[i].end(),
              result.begin() + static_cast<std::ptrdiff_t>(places[i]));
    give_up(lists[i]);
  });
  return result;
}

}  // namespace exactcsg
