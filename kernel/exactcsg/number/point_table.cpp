// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/point_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>

#include "exactcsg/number/rounding.hpp"
#include "exactcsg/support/give_up.hpp"

namespace exactcsg {

namespace {

__extension__ using Wide = unsigned __int128;

// Both halves of a product: every bit of the value reaches the low bits of the hash, also the
// exponent of a double that has few others.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  const Wide product = Wide{hash ^ value} * 0xff51afd7ed558ccdULL;
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64U);
}

// Mostly the doubles tell points apart. Far from the origin, or where they cannot hold coordinates
// at all, many different points have equal ones.
std::uint64_t hash_of(const Point3& point, const ApproximatePoint& near) {
  std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
  for (const double value : {near.x, near.y, near.z}) {
    hash = mixed(hash, std::bit_cast<std::uint64_t>(value));
  }
  if (near.error == 0) return hash;
  std::uint64_t limbs = 0;
  for (const Rational* value : {&point.x, &point.y, &point.z}) {
    const mpz_srcptr numerator = value->get_num_mpz_t();
    const auto size = static_cast<mp_size_t>(mpz_size(numerator));
    for (mp_size_t i = 0; i < size; ++i) limbs = std::rotl(limbs, 21) + mpz_getlimbn(numerator, i);
  }
  return mixed(hash, limbs);
}

// Slots lie anywhere: so many are asked for before they are read.
constexpr std::size_t slots_ahead = 16;

bool are_equal(const ApproximatePoint& p, const ApproximatePoint& q) {
  return p.x == q.x && p.y == q.y && p.z == q.z && p.error == q.error;
}

}  // namespace

ApproximatePoint approximate(const Point3& point) {
  const NearestDouble x = round_to_nearest(point.x);
  const NearestDouble y = round_to_nearest(point.y);
  const NearestDouble z = round_to_nearest(point.z);
  if (!std::isfinite(x.value) || !std::isfinite(y.value) || !std::isfinite(z.value)) {
    return {0, 0, 0, std::numeric_limits<double>::infinity()};
  }
  double error = 0;
  for (const NearestDouble& rounded : {x, y, z}) {
    if (rounded.is_exact) continue;
    // Half a unit in the last place is at most 2^-53 of the value, or 2^-1075 of a subnormal one.
    const double half_unit =
        std::max(std::fabs(rounded.value) * 0x1p-53, std::numeric_limits<double>::denorm_min());
    error = std::max(error, half_unit);
  }
  return {x.value, y.value, z.value, error};
}

HashedPoint hashed(const Point3& point) {
  const ApproximatePoint near = approximate(point);
  return {hash_of(point, near), near};
}

PointId PointTable::intern(const Point3& point) {
  const PointView view = view_of(point);
  const auto [id, is_new] = find_or_add(hashed(point), [&](PointRecord known) {
    return compare(known.view(), view) == std::strong_ordering::equal;
  });
  if (is_new) {
    copies_.push_back(view);
    points_.push_back(copies_.record(copies_.size() - 1));
  }
  return id;
}

void PointTable::intern_lasting(const ExactPoints& points, std::span<const HashedPoint> hashed,
                                std::span<PointId> ids) {
  reserve(hashed.size());
  const std::size_t mask = slots_.size() - 1;
  const auto ask_for = [&](std::size_t i) {
    if (i < hashed.size()) __builtin_prefetch(&slots_[hashed[i].hash & mask], 1);
  };
  for (std::size_t i = 0; i < slots_ahead; ++i) ask_for(i);
  for (std::size_t i = 0; i < hashed.size(); ++i) {
    ask_for(i + slots_ahead);
    const PointRecord point = points.record(i);
    const auto [id, is_new] =
        find_or_add(hashed[i], [point](PointRecord known) { return known == point; });
    if (is_new) points_.push_back(point);
    ids[i] = id;
  }
}

template <class Equals>
std::pair<PointId, bool> PointTable::find_or_add(const HashedPoint& hashed, const Equals& equals) {
  if (points_.size() * 2 >= slots_.size()) enlarge_slots(points_.size() + 1);
  const std::uint64_t hash = hashed.hash;
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  for (; slots_[slot] != 0; slot = (slot + 1) & mask) {
    const std::uint32_t id = slots_[slot] - 1;
    if (hashes_[id] != hash || !are_equal(approximate_[id], hashed.near)) continue;
    if (hashed.near.error == 0 || equals(points_[id])) return {PointId{id}, false};
  }
  const auto id = static_cast<std::uint32_t>(points_.size());
  slots_[slot] = id + 1;
  hashes_.push_back(hash);
  approximate_.push_back(hashed.near);
  return {PointId{id}, true};
}

void PointTable::close() {
  give_up(hashes_);
  give_up(slots_);
}

void PointTable::reserve(std::size_t more) {
  const std::size_t size = points_.size() + more;
  if (size > points_.capacity()) {
    // Twice the size at least, so that asking often for a little room costs no more.
    const std::size_t room = std::max(size, points_.size() * 2);
    points_.reserve(room);
    hashes_.reserve(room);
    approximate_.reserve(room);
  }
  if (size * 2 > slots_.size()) enlarge_slots(size);
}

// Slots for at least so many points.
void PointTable::enlarge_slots(std::size_t least) {
  std::size_t size = std::max<std::size_t>(slots_.size() * 2, 64);
  while (size < least * 2) size *= 2;
  slots_.assign(size, 0);
  for (std::uint32_t id = 0; id < hashes_.size(); ++id) {
    std::size_t slot = hashes_[id] & (size - 1);
    while (slots_[slot] != 0) slot = (slot + 1) & (size - 1);
    slots_[slot] = id + 1;
  }
}

}  // namespace exactcsg
