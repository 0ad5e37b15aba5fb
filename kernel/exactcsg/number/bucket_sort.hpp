// SPDX-License-Identifier: Apache-2.0
#pragma once

// Sorting of many items whose keys are spread evenly over a known range, as numbers of vertices and
// planes are: counted into buckets, which hold few items each. Comparing costs most of std::sort,
// since nearly every comparison of a random order is guessed wrongly.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/number/sort_in_buckets.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

namespace detail {

// As sort_in_buckets, by groups of neighbouring buckets: each part of the items is counted and
// moved into the groups, then each group is sorted.
template <class Item, class BucketOf, class Less>
void sort_in_groups(unsigned threads, std::vector<Item>& items, std::size_t bucket_count,
                    const BucketOf& bucket_of, const Less& less) {
  constexpr std::size_t most_groups = 256;
  unsigned shift = 0;
  while ((bucket_count - 1) >> shift >= most_groups) ++shift;
  const std::size_t groups = ((bucket_count - 1) >> shift) + 1;
  const Parts parts(items.size());
  std::vector<std::array<std::uint32_t, most_groups>> place(parts.count());
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    place[part].fill(0);
    for (std::size_t i = begin; i < end; ++i) ++place[part][bucket_of(items[i]) >> shift];
  });
  std::vector<std::uint32_t> group_begins;
  std::uint32_t sum = 0;
  for (std::size_t group = 0; group < groups; ++group) {
    group_begins.push_back(sum);
    for (auto& places : place) sum += std::exchange(places[group], sum);
  }
  group_begins.push_back(sum);
  std::vector<Item> grouped;
  resize(threads, grouped, items.size());
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    auto& places = place[part];
    for (std::size_t i = begin; i < end; ++i) {
      grouped[places[bucket_of(items[i]) >> shift]++] = std::move(items[i]);
    }
  });
  in_parallel(threads, groups, [&](std::size_t group) {
    const std::size_t begin = group_begins[group];
    const std::size_t size = group_begins[group + 1] - begin;
    const std::size_t first_bucket = group << shift;
    sort_in_buckets(
        std::span(grouped).subspan(begin, size), std::span(items).subspan(begin, size),
        std::min(std::size_t{1} << shift, bucket_count - first_bucket),
        [&](const Item& item) { return bucket_of(item) - first_bucket; }, less);
  });
}

}  // namespace detail

// Sorts by bucket, and by `less` within a bucket. REQUIRES bucket_of(item) < bucket_count, and less
// than 2^32 items. COST: O(n + buckets) if the buckets are small, O(n log n) if they are not.
template <class Item, class BucketOf, class Less>
void sort_in_buckets(std::vector<Item>& items, std::size_t bucket_count, BucketOf bucket_of,
                     Less less, unsigned threads = 1) {
  constexpr std::size_t least_for_threads = 8192;
  if (threads != 1 && items.size() >= least_for_threads) {
    detail::sort_in_groups(threads, items, bucket_count, bucket_of, less);
    return;
  }
  std::vector<Item> sorted(items.size());
  sort_in_buckets(std::span(items), std::span(sorted), bucket_count, bucket_of, less);
  items = std::move(sorted);
}

// As many buckets as items for numbers of type double; larger numbers have no smaller buckets.
class DoubleBuckets {
 public:
  template <class Item, class KeyOf>
  DoubleBuckets(const std::vector<Item>& items, KeyOf key_of, unsigned threads = 1)
      : count_(items.size() + 1) {
    struct Ends {
      double lowest = std::numeric_limits<double>::max();
      double highest = std::numeric_limits<double>::lowest();
    };
    const Parts parts(items.size());
    std::vector<Ends> ends_of_parts(parts.count());
    in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
      Ends ends;
      for (std::size_t i = begin; i < end; ++i) {
        const double key = key_of(items[i]);
        if (!(key >= std::numeric_limits<double>::lowest() &&
              key <= std::numeric_limits<double>::max())) {
          continue;
        }
        ends.lowest = std::min(ends.lowest, key);
        ends.highest = std::max(ends.highest, key);
      }
      ends_of_parts[part] = ends;
    });
    double lowest = std::numeric_limits<double>::max();
    double highest = std::numeric_limits<double>::lowest();
    for (const Ends& ends : ends_of_parts) {
      lowest = std::min(lowest, ends.lowest);
      highest = std::max(highest, ends.highest);
    }
    lowest_ = lowest;
    scale_ = lowest < highest ? static_cast<double>(count_) / (highest - lowest) : 0;
    // Beyond the range of doubles everything is one bucket.
    if (!(scale_ <= std::numeric_limits<double>::max())) scale_ = 0;
  }

  std::size_t count() const { return count_; }
  // Rounding is monotone, and so are both operations.
  std::size_t of(double key) const {
    const double bucket = (key - lowest_) * scale_;
    if (!(bucket > 0)) return 0;
    const auto last = static_cast<double>(count_ - 1);
    return bucket < last ? static_cast<std::size_t>(bucket) : count_ - 1;
  }

 private:
  std::size_t count_;
  double lowest_ = 0;
  double scale_ = 0;
};

}  // namespace exactcsg
