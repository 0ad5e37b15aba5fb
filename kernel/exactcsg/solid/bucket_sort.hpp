// SPDX-License-Identifier: Apache-2.0
#pragma once

// Sorting of many items whose keys are spread evenly over a known range, as numbers of vertices and
// planes are: counted into buckets, which hold few items each. Comparing costs most of std::sort,
// since nearly every comparison of a random order is guessed wrongly.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace exactcsg {

// Sorts by bucket, and by `less` within a bucket. REQUIRES bucket_of(item) < bucket_count, and less
// than 2^32 items. COST: O(n + buckets) if the buckets are small, O(n log n) if they are not.
template <class Item, class BucketOf, class Less>
void sort_in_buckets(std::vector<Item>& items, std::size_t bucket_count, BucketOf bucket_of,
                     Less less) {
  std::vector<std::uint32_t> place(bucket_count + 1, 0);
  for (const Item& item : items) ++place[bucket_of(item) + 1];
  for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  std::vector<Item> sorted(items.size());
  // Afterwards every place is where its bucket ends.
  for (Item& item : items) sorted[place[bucket_of(item)]++] = std::move(item);
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < bucket_count; ++i) {
    const std::uint32_t end = place[i];
    if (end - begin > 1) std::sort(sorted.begin() + begin, sorted.begin() + end, less);
    begin = end;
  }
  items = std::move(sorted);
}

// As many buckets as items for numbers of type double; larger numbers have no smaller buckets.
class DoubleBuckets {
 public:
  template <class Item, class KeyOf>
  DoubleBuckets(const std::vector<Item>& items, KeyOf key_of) : count_(items.size() + 1) {
    double lowest = std::numeric_limits<double>::max();
    double highest = std::numeric_limits<double>::lowest();
    for (const Item& item : items) {
      const double key = key_of(item);
      if (!(key >= std::numeric_limits<double>::lowest() &&
            key <= std::numeric_limits<double>::max())) {
        continue;
      }
      lowest = std::min(lowest, key);
      highest = std::max(highest, key);
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
