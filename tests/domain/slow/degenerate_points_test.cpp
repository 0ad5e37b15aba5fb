// SPDX-License-Identifier: GPL-3.0-or-later
// A million points on or next to the boundary of all domains together, against the rows'
// definitions in plain rational arithmetic.

#include <gtest/gtest.h>

#include "domain/laws.hpp"

namespace exactcsg::domain::test {
namespace {

template <class Row>
void expect_equal_for_points(int samples) {
  Random random(11, 2);
  for (int i = 0; i < samples; ++i) {
    const auto sample = Row::sample(random);
    for (int k = 0; k < 100; ++k) {
      const auto point = nearby(Row::degenerate_point(sample, random), random);
      ASSERT_EQ(classify(sample.set, Point<Row::dimension>(point)), sample.reference(point))
          << Row::name;
    }
  }
}

template <class Tuple>
struct ForEachRow;
template <class... Row>
struct ForEachRow<std::tuple<Row...>> {
  static void run(int points) {
    const int samples = points / 100 / static_cast<int>(sizeof...(Row)) + 1;
    (expect_equal_for_points<Row>(samples), ...);
  }
};

TEST(DegeneratePoints, AMillionEqualPureRationalEvaluation) { ForEachRow<Rows>::run(1'000'000); }

}  // namespace
}  // namespace exactcsg::domain::test
