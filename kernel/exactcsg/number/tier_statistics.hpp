// SPDX-License-Identifier: Apache-2.0
#pragma once

// How often each tier of the filtered predicates gave the answer, and how often it was zero.

#include <array>
#include <cstddef>
#include <cstdint>

namespace exactcsg {

// Symbolic: known incidence. Double: certified floating-point filter. Fixed: integers of fixed
// width on the stack. Unbounded: GMP integers.
enum class Tier : unsigned char { Symbolic, Double, Fixed, Unbounded };
inline constexpr std::size_t tier_count = 4;

struct TierStatistics {
  std::array<std::uint64_t, tier_count> answers{};
  std::array<std::uint64_t, tier_count> zeros{};  // of the answers, those that were Zero / equal

  void record(Tier tier, bool zero) noexcept {
    ++answers[static_cast<std::size_t>(tier)];
    if (zero) ++zeros[static_cast<std::size_t>(tier)];
  }
  TierStatistics& operator+=(const TierStatistics& other) noexcept {
    for (std::size_t i = 0; i < tier_count; ++i) {
      answers[i] += other.answers[i];
      zeros[i] += other.zeros[i];
    }
    return *this;
  }
  friend bool operator==(const TierStatistics&, const TierStatistics&) = default;
};

}  // namespace exactcsg
