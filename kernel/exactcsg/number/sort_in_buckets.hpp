// SPDX-License-Identifier: Apache-2.0
#pragma once

// Sorting by one thread of items whose keys are spread evenly over a known range; see
// number/bucket_sort.hpp. Private to the kernel.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace exactcsg {

namespace detail {

template <class Item, class BucketOf, class Less>
void sort_in_small_buckets(std::span<Item> from, std::span<Item> to, std::size_t bucket_count,
                           const BucketOf& bucket_of, const Less& less) {
  std::vector<std::uint32_t> place(bucket_count + 1, 0);
  for (const Item& item : from) ++place[bucket_of(item) + 1];
  for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  // Afterwards every place is where its bucket ends.
  for (Item& item : from) to[place[bucket_of(item)]++] = std::move(item);
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < bucket_count; ++i) {
    const std::uint32_t end = place[i];
    if (end - begin > 1) std::sort(to.begin() + begin, to.begin() + end, less);
    begin = end;
  }
}

}  // namespace detail

// Moves `from` to `to`, which has the same size, sorted by bucket, and by `less` within a bucket.
// REQUIRES bucket_of(item) < bucket_count, and less than 2^32 items
// COST: O(n + buckets) if the buckets are small, O(n log n) if they are not.
//
// What the caches do not hold is moved into few groups first: every single move into one of many
// buckets waits for the memory.
template <class Item, class BucketOf, class Less>
void sort_in_buckets(std::span<Item> from, std::span<Item> to, std::size_t bucket_count,
                     const BucketOf& bucket_of, const Less& less) {
  constexpr std::size_t cached_bytes = std::size_t{1} << 20U;
  constexpr unsigned groups_exponent = 8;
  if (from.size_bytes() <= cached_bytes) {
    detail::sort_in_small_buckets(from, to, bucket_count, bucket_of, less);
    return;
  }
  const auto width = static_cast<unsigned>(std::bit_width(bucket_count - 1));
  const unsigned shift = width > groups_exponent ? width - groups_exponent : 0;
  const std::size_t groups = ((bucket_count - 1) >> shift) + 1;
  std::vector<std::uint32_t> place(groups + 1, 0);
  for (const Item& item : from) ++place[(bucket_of(item) >> shift) + 1];
  for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  for (Item& item : from) to[place[bucket_of(item) >> shift]++] = std::move(item);
  std::vector<Item> group;
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < groups; ++i) {
    const std::span<Item> sorted = to.subspan(begin, place[i] - begin);
    begin = place[i];
    group.assign(std::make_move_iterator(sorted.begin()), std::make_move_iterator(sorted.end()));
    detail::sort_in_small_buckets(
        std::span(group), sorted, std::size_t{1} << shift,
        [&](const Item& item) { return bucket_of(item) - (i << shift); }, less);
  }
}

}  // namespace exactcsg
