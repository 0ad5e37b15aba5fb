// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Volumes of closed polygonal surfaces, exactly, also where the rational is too long to be written.
//
// A sum over thousands of unrelated denominators has millions of digits. Two such sums are compared
// by their residues: if a != b as rationals of at most B bits, they agree modulo a random 61-bit
// prime with probability below B / 2^55; four primes are taken. [Exact where the rational is short;
// else Probabilistic with an error below 10^-40]

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/number/point.hpp"

namespace exactcsg::verify {

using Cycles = std::vector<std::vector<std::uint32_t>>;

struct OrientedFace {
  const Cycles* cycles = nullptr;
  int sense = 1;  // -1: the cycles run clockwise seen from outside
};

inline constexpr std::size_t residue_count = 4;

struct VolumeSum {
  std::optional<Rational> exact;  // where a common denominator of the vertices is short
  std::array<std::uint64_t, residue_count> residues{};
  std::string decimal;  // 17 digits of the value, computed with 512 bits

  // Exact if both are; by residues otherwise.
  friend bool operator==(const VolumeSum& a, const VolumeSum& b);
};

// True if the volumes on the left add up to those on the right.
bool balances(const std::vector<VolumeSum>& left, const std::vector<VolumeSum>& right);

VolumeSum sum_volume(const std::vector<Point3>& points, const std::vector<OrientedFace>& faces);

}  // namespace exactcsg::verify
