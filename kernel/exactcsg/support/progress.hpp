// SPDX-License-Identifier: Apache-2.0
#pragma once

// A passive record of how far long work has come. The work writes, any thread reads; the
// reader asks the work to stop by `cancel`. Nobody calls anybody back.

#include <atomic>
#include <cstdint>

#include "exactcsg/support/error.hpp"

namespace exactcsg {

class Progress {
 public:
  void begin(const char* stage, std::uint64_t total) noexcept {
    stage_.store(stage, std::memory_order_relaxed);
    done_.store(0, std::memory_order_relaxed);
    total_.store(total, std::memory_order_relaxed);
    relative_width_.store(-1, std::memory_order_relaxed);
  }
  void advance(std::uint64_t amount = 1) noexcept {
    done_.fetch_add(amount, std::memory_order_relaxed);
  }

  // Of a value that is known between two bounds: how far these are apart in relation to it.
  void narrow_to(double relative_width) noexcept {
    relative_width_.store(relative_width, std::memory_order_relaxed);
  }
  // Negative if nothing of the present stage is known so.
  double relative_width() const noexcept { return relative_width_.load(std::memory_order_relaxed); }

  // A string literal that names the present stage ("decompose", "merge"), never null.
  const char* stage() const noexcept { return stage_.load(std::memory_order_relaxed); }
  std::uint64_t done() const noexcept { return done_.load(std::memory_order_relaxed); }
  std::uint64_t total() const noexcept { return total_.load(std::memory_order_relaxed); }

  void cancel(ErrorId reason = ErrorId::Cancelled) noexcept {
    reason_.store(reason, std::memory_order_relaxed);
    cancelled_.store(true, std::memory_order_release);
  }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_acquire); }
  // THROWS Error(reason given to cancel) once cancel was called; otherwise costs one load.
  void check() const {
    if (cancelled()) throw Error(reason_.load(std::memory_order_relaxed), {stage(), ""});
  }

 private:
  std::atomic<const char*> stage_{"start"};
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::uint64_t> total_{0};
  std::atomic<double> relative_width_{-1};
  std::atomic<ErrorId> reason_{ErrorId::Cancelled};
  std::atomic<bool> cancelled_{false};
};

}  // namespace exactcsg
