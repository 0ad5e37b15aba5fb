// SPDX-License-Identifier: Apache-2.0
#pragma once

// Sorting by one thread of items whose keys are spread evenly over a known range; see
// solid/bucket_sort.hpp. Private to the kernel.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace exactcsg {

// Moves `from` to `to`, which has the same size, sorted by bucket, and by `less` within a bucket.
// REQUIRES bucket_of(item) < bucket_count, and less than 2^32 items
// COST: O(n + buckets) if the buckets are small, O(n log n) if they are not.
template <class Item, class BucketOf, class Less>
void sort_in_buckets(std::span<Item> from, std::span<Item> to, std::size_t bucket_count,
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

}  // namespace exactcsg
