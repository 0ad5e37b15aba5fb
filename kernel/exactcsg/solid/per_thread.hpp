// SPDX-License-Identifier: Apache-2.0
#pragma once

// A value for each thread that asks for one.

#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace exactcsg {

// As tbb::enumerable_thread_specific, but a work of one thread touches nothing of oneTBB: its
// allocator is loaded as a library when it is first used, which takes longer than a small solid.
template <class T>
class PerThread {
 public:
  explicit PerThread(std::function<T()> make) : make_(std::move(make)) {}

  // The calling thread's value, made when first asked for. COST: a lock that is rarely waited for,
  // hence not for inner loops
  T& local() {
    const std::scoped_lock lock(mutex_);
    const auto id = std::this_thread::get_id();
    const auto found = values_.find(id);
    if (found != values_.end()) return found->second;
    return values_.emplace(id, make_()).first->second;
  }

 private:
  std::function<T()> make_;
  std::mutex mutex_;
  std::map<std::thread::id, T> values_;  // whose elements stay where they are
};

}  // namespace exactcsg
