// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The laws of half_space.hpp as checks on one sample of a row.

#include <gtest/gtest.h>

#include "domain/rows.hpp"

namespace exactcsg::domain::test {

// Perhaps a tiny way off.
template <std::size_t D>
Coordinates<D> nearby(Coordinates<D> point, Random& random) {
  if (random.one_in(3)) point[static_cast<std::size_t>(random.integer(0, D - 1))] += random.tiny();
  return point;
}

template <class Sample, std::size_t D>
void expect_equals_reference(const Sample& sample, const Coordinates<D>& point) {
  const PointClass expected = sample.reference(point);
  ASSERT_EQ(classify(sample.set, Point<D>(point)), expected);
  ASSERT_EQ(classify(complement(sample.set), Point<D>(point)), complement(expected));
}

// A rational point of the box, its surface included.
template <std::size_t D>
Coordinates<D> point_of(const Box<D>& box, Random& random, bool inside) {
  Coordinates<D> point;
  for (std::size_t i = 0; i < D; ++i) {
    Rational share(random.integer(inside ? 1 : 0, inside ? 6 : 7), 7);
    share.canonicalize();
    point[i] = box.lower()[i] + share * (box.upper()[i] - box.lower()[i]);
  }
  return point;
}

// What is said of the box holds of its points.
template <class Sample, std::size_t D>
void expect_box_tells_of_points(const Sample& sample, const Box<D>& box, Random& random) {
  const csg::Membership known = classify(sample.set, box);
  ASSERT_EQ(classify(complement(sample.set), box), detail::complement_if(true, known));
  if (known == csg::Membership::Unknown) return;
  for (int i = 0; i < 6; ++i) {
    const bool inside = i % 2 == 0;
    const PointClass at = classify(sample.set, Point<D>(point_of(box, random, inside)));
    const PointClass expected = known == csg::Membership::In ? PointClass::In : PointClass::Out;
    ASSERT_TRUE(at == expected || (!inside && at == PointClass::On))
        << "box " << static_cast<int>(known) << ", point " << static_cast<int>(at);
  }
}

// Looks for the point of the box where `better` values are, ever nearer to the best one so far,
// from each corner in turn, until one is on the better side of 0.
template <class Sample, std::size_t D, class Better>
PointClass class_by_search(const Sample& sample, const Box<D>& box, Random& random,
                           Better&& better) {
  constexpr std::int64_t one = 1 << 30;
  using Shares = std::array<std::int64_t, D>;
  const auto at = [&](const Shares& shares) {
    Coordinates<D> point;
    for (std::size_t i = 0; i < D; ++i) {
      Rational share(shares[i], one);
      share.canonicalize();
      point[i] = box.lower()[i] + share * (box.upper()[i] - box.lower()[i]);
    }
    return point;
  };
  Shares best{};
  for (std::size_t corner = 0; corner < (std::size_t{1} << D); ++corner) {
    for (std::size_t i = 0; i < D; ++i) best[i] = (corner >> i & 1U) != 0 ? one : 0;
    Rational value = sample.value(at(best));
    for (std::int64_t reach = one; reach > 4 && !better(value, Rational(0)); reach -= reach / 4) {
      for (int i = 0; i < 12; ++i) {
        Shares shares = best;
        for (std::int64_t& share : shares) {
          if (!random.one_in(3)) share += random.integer(-reach, reach);
          share = std::clamp(share, std::int64_t{0}, one);
        }
        const Rational found = sample.value(at(shares));
        if (!better(found, value)) continue;
        value = found;
        best = shares;
      }
    }
    if (better(value, Rational(0))) break;
  }
  return sample.reference(at(best));
}

// LAW half_space.3, on the open pieces, at the crossings, and for the complement.
template <class Sample, std::size_t D>
void expect_section_separates(const Sample& sample, const LineSection<D>& line) {
  const Section found = section(sample.set, line);
  const auto& crossings = found.crossings;
  ASSERT_EQ(found.between.size(), crossings.size() + 1);
  const auto class_at = [&](const Rational& t) {
    return sample.reference(line.at(t).coordinates());
  };
  for (std::size_t i = 0; i <= crossings.size(); ++i) {
    std::vector<Rational> parameters;
    if (i > 0) {
      if (i > 1) {
        ASSERT_TRUE(crossings[i - 2].parameter < crossings[i - 1].parameter);
      }
      const AlgebraicNumber& here = crossings[i - 1].parameter;
      if (line.begin) {
        ASSERT_TRUE(AlgebraicNumber(*line.begin) < here);
      }
      if (line.end) {
        ASSERT_TRUE(here < AlgebraicNumber(*line.end));
      }
      // A tree has crossings of its primitives that are not its own.
      const bool is_own = found.between[i - 1] != found.between[i] || requires {
        sample.set.is_complement();
      };
      const QuadraticNumber* quadratic = here.quadratic();
      if (is_own && quadratic != nullptr && quadratic->factor() == 0) {
        ASSERT_EQ(class_at(quadratic->rational_part()), PointClass::On);
      }
    }
    const auto low = i > 0        ? std::optional(crossings[i - 1].parameter)
                     : line.begin ? std::optional(AlgebraicNumber(*line.begin))
                                  : std::nullopt;
    const auto high = i < crossings.size() ? std::optional(crossings[i].parameter)
                      : line.end           ? std::optional(AlgebraicNumber(*line.end))
                                           : std::nullopt;
    if (low && high) {
      const Rational middle = rational_between(*low, *high);
      parameters = {middle, rational_between(*low, middle), rational_between(middle, *high)};
    } else if (low) {
      const Rational above = enclose(*low, 200).upper;
      parameters = {above + Rational(1, Integer(1) << 190), above + 1, above + 1000};
    } else if (high) {
      const Rational below = enclose(*high, 200).lower;
      parameters = {below - Rational(1, Integer(1) << 190), below - 1, below - 1000};
    } else {
      parameters = {Rational(0), Rational(-7), Rational(1000)};
    }
    for (const Rational& t : parameters) ASSERT_EQ(class_at(t), found.between[i]);
  }
  const Section outside = section(complement(sample.set), line);
  ASSERT_EQ(outside.between.size(), found.between.size());
  for (std::size_t i = 0; i < found.between.size(); ++i) {
    ASSERT_EQ(outside.between[i], complement(found.between[i]));
  }
}

inline AffineMap random_map(Random& random, std::size_t dimension) {
  for (;;) {
    AffineMap map = AffineMap::identity();
    for (std::size_t i = 0; i < dimension; ++i) {
      for (std::size_t j = 0; j < dimension; ++j) map.m[i][j] = random.rational();
      map.m[i][3] = random.rational();
    }
    if (determinant(map) != 0) return map;
  }
}

template <std::size_t D>
LineSection<D> random_line(const Coordinates<D>& through, Random& random) {
  LineSection<D> line{random.one_in(2) ? through : random.coordinates<D>(), random.direction<D>(),
                      std::nullopt, std::nullopt};
  if (random.one_in(2)) line.begin = random.rational();
  if (random.one_in(2)) {
    line.end = line.begin ? Rational(*line.begin + random.positive()) : random.rational();
  }
  return line;
}

}  // namespace exactcsg::domain::test
