// SPDX-License-Identifier: GPL-3.0-or-later
// Expected orders: those of std::sort.
#include "exactcsg/number/bucket_sort.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace exactcsg {
namespace {

std::vector<double> sorted(std::vector<double> keys) {
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<double> sorted_in_buckets(std::vector<double> keys) {
  const DoubleBuckets buckets(keys, [](double key) { return key; });
  sort_in_buckets(
      keys, buckets.count(), [&](double key) { return buckets.of(key); }, std::less<>());
  return keys;
}

TEST(BucketSort, SortsByBucketAndThenByLess) {
  std::mt19937 random(7);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> items(5000);
  for (auto& [bucket, rest] : items) {
    bucket = static_cast<std::uint32_t>(random() % 400);
    rest = static_cast<std::uint32_t>(random() % 50);
  }
  auto expected = items;
  std::sort(expected.begin(), expected.end());
  sort_in_buckets(
      items, 400, [](const auto& item) { return item.first; }, std::less<>());
  EXPECT_EQ(items, expected);
}

TEST(BucketSort, SortsTheSameWithEveryNumberOfThreads) {
  std::mt19937 random(9);
  for (const std::uint32_t buckets : {1U, 256U, 257U, 70000U}) {
    // Items that are moved, not copied; the middle bucket holds more than its share.
    std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> items(40000);
    for (auto& [bucket, rest] : items) {
      bucket = random() % 4 == 0 ? buckets / 2 : static_cast<std::uint32_t>(random() % buckets);
      rest.push_back(static_cast<std::uint32_t>(random()));
    }
    auto expected = items;
    std::sort(expected.begin(), expected.end());
    for (const unsigned threads : {1U, 2U, 0U}) {
      auto sorted = items;
      sort_in_buckets(
          sorted, buckets, [](const auto& item) { return item.first; }, std::less<>(), threads);
      EXPECT_EQ(sorted, expected) << buckets << ' ' << threads;
    }
  }
}

TEST(BucketSort, SortsNothing) {
  std::vector<int> none;
  sort_in_buckets(
      none, 0, [](int) { return std::size_t{0}; }, std::less<>());
  EXPECT_TRUE(none.empty());
}

TEST(BucketSort, SortsDoublesOfEveryKind) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double most = std::numeric_limits<double>::max();
  constexpr double least = std::numeric_limits<double>::denorm_min();
  std::mt19937 random(8);
  std::vector<double> spread;
  std::uniform_real_distribution<double> place(-3, 5);
  for (int i = 0; i < 3000; ++i) spread.push_back(place(random));
  for (const std::vector<double>& keys :
       {spread, std::vector<double>{}, std::vector<double>{2}, std::vector<double>{3, 3, 3},
        std::vector<double>{most, -most, 1, 0}, std::vector<double>{least, 0, -least},
        std::vector<double>{infinity, 1, -infinity, 0.5, infinity, -2},
        std::vector<double>{infinity, -infinity}, std::vector<double>{infinity, most, -most, -1},
        std::vector<double>{1e300, 1, 1 + 0x1p-52, 1 - 0x1p-53}}) {
    EXPECT_EQ(sorted_in_buckets(keys), sorted(keys));
  }
}

}  // namespace
}  // namespace exactcsg
