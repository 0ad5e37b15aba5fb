// SPDX-License-Identifier: Apache-2.0
#pragma once

// Moments and the centroid of a set inside a box, between bounds that are proved. [Certified]
//
//   moment(tree, box, exponents, limits, origin)   the integral of (x-o)^i (y-o)^j (z-o)^k
//   moments(tree, box, limits, origin)             all with i + j + k <= 2
//   centroid(tree, box, limits)
//
// LAW moments.1  the integral over the tree's set inside the box lies in value.
// LAW moments.2  moment: as LAW certified_measure.2, where a relative width is one relative to the
//                lower bound if that is positive.
// LAW moments.3  moments: relative_width is relative to the volume times the greatest value of the
//                function's magnitude in the box; absolute_width does not count.
// LAW moments.4  centroid: each coordinate's bounds lie in the box and are at most relative_width
//                times the box's side apart, unless `stop` says otherwise. nullopt if the volume is
//                not shown to be above 0.
// COST: that of volume (certified_measure.hpp) for each integral; the width falls in the same way.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "exactcsg/measure/certified_measure.hpp"

namespace exactcsg::measure {

// Of x, y and z.
// REQUIRES each at most 2, at most 2 together
using Exponents = std::array<unsigned, 3>;

namespace detail {

// The product of powers of coordinates that are linear in those of a column.
class MonomialQuantity {
 public:
  // coordinate = offset + scale * u, in the order of the column.
  struct Factor {
    CertifiedDouble offset;
    CertifiedDouble scale;
    unsigned exponent = 0;

    CertifiedDouble at(const CertifiedDouble& u) const {
      CertifiedDouble result = exactly(1);
      for (unsigned i = 0; i < exponent; ++i) result = result * (offset + scale * u);
      return result;
    }
  };
  explicit MonomialQuantity(std::array<Factor, 3> factors) : factors_(std::move(factors)) {}

  CertifiedDouble below(const Height& height, const Rectangle& r) const {
    constexpr std::size_t order = series_order;
    const Series z = height.graph ? height.graph->series_at_centre(order - 1)
                                  : constant_series(exactly(height.lower));
    const Series z_anywhere = height.graph ? height.graph->series_anywhere(order) : z;
    return detail::integral(
        r, integrand(z, exactly(r.s), exactly(r.t), order - 1),
        integrand(z_anywhere, CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b}, order), order);
  }
  // The mean of the function along the height between the two.
  CertifiedDouble mean_between(const Height& one, const Height& two, const Rectangle& r) const {
    const Factor& f = factors_[2];
    const CertifiedDouble low = one.range();
    const CertifiedDouble high = two.range();
    CertifiedDouble mean = exactly(1);
    if (f.exponent == 1) mean = f.offset + exactly(0.5) * f.scale * (low + high);
    if (f.exponent == 2) {
      const CertifiedDouble squares = low * low + low * high + high * high;
      mean = f.offset * f.offset + f.offset * f.scale * (low + high) +
             f.scale * f.scale * squares / exactly(3);
    }
    return mean * across(r);
  }
  CertifiedDouble between_heights(double from, double to, const Rectangle& r) const {
    return below({to, to, {}}, r) - below({from, from, {}}, r);
  }
  CertifiedDouble part_between_heights(double from, double to, const Rectangle& r) const {
    return up_to(across(r) * factors_[2].at(between(from, to)) * (exactly(to) - exactly(from)) *
                 exactly(4) * exactly(r.a) * exactly(r.b));
  }

 private:
  // Without the power of the height.
  CertifiedDouble across(const Rectangle& r) const {
    return factors_[0].at({r.s, r.a}) * factors_[1].at({r.t, r.b});
  }
  // The function's antiderivative along the height.
  Series integrand(const Series& z, const CertifiedDouble& s, const CertifiedDouble& t,
                   std::size_t degree) const {
    const Factor& f = factors_[2];
    Series result = z;
    if (f.exponent > 0) {
      const Series square = product(z, z, degree);
      if (f.exponent == 1) {
        result = sum(scaled(f.offset, z, degree), scaled(exactly(0.5) * f.scale, square, degree),
                     degree);
      } else {
        const Series cube = product(square, z, degree);
        result = sum(scaled(f.offset * f.offset, z, degree),
                     sum(scaled(f.offset * f.scale, square, degree),
                         scaled(f.scale * f.scale / exactly(3), cube, degree), degree),
                     degree);
      }
    }
    const std::array<CertifiedDouble, 2> at{s, t};
    for (std::size_t i = 0; i < 2; ++i) {
      Series coordinate = scaled(factors_[i].scale, coordinate_series(i, at[i]), 1);
      coordinate[0][0] = coordinate[0][0] + factors_[i].offset;
      for (unsigned k = 0; k < factors_[i].exponent; ++k) {
        result = product(result, coordinate, degree);
      }
    }
    return result;
  }

  std::array<Factor, 3> factors_;
};

// What IntegralMeter measures: a moment.
class MomentMeasure {
 public:
  static constexpr bool is_never_negative = false;

  MomentMeasure(const Exponents& exponents, const domain::Point<3>& origin)
      : exponents_(exponents), origin_(origin) {}

  Rational in_full_cell(const Box3& box) const {
    Rational result = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Rational low = box.lower()[i] - origin_[i];
      const Rational high = box.upper()[i] - origin_[i];
      Rational power_of_low = low;
      Rational power_of_high = high;
      for (unsigned k = 0; k < exponents_[i]; ++k) {
        power_of_low *= low;
        power_of_high *= high;
      }
      result *= (power_of_high - power_of_low) / (exponents_[i] + 1);
    }
    return result;
  }
  template <SpatialDomain P>
  CertifiedDouble in_mixed_cell(const SurfaceTable<P>&, const LiteralTree&, const Box3& box) const {
    return of_any_part(factors(box, 0), box);
  }

  class InColumn {
   public:
    InColumn(const std::array<MonomialQuantity::Factor, 3>& factors, const CertifiedDouble& scale,
             const CertifiedDouble& greatest)
        : quantity_(factors), scale_(scale), greatest_(greatest) {}
    CertifiedDouble of_any_part(const Column&, const Rectangle& r) const {
      return up_to(greatest_ * exactly(2 * r.area()) * scale_);
    }
    CertifiedDouble operator()(const Column& column, const Rectangle& r) const {
      return column.integral(r, quantity_) * scale_;
    }

   private:
    MonomialQuantity quantity_;
    CertifiedDouble scale_;     // the volume of the cell over that of its own coordinates
    CertifiedDouble greatest_;  // encloses the function's values in the cell
  };
  using Part = MeasuredColumn<InColumn>;
  template <SpatialDomain P>
  std::vector<Part> parts(const SurfaceTable<P>& table, const LiteralTree& tree,
                          const Box3& box) const {
    return measured_column<InColumn>(table, tree, box, [&](const Column& column) {
      const auto in_order = factors(box, (column.axis() + 1) % 3);
      return InColumn(in_order, certified_double_of(Rational(volume_of(box) / 8)),
                      values(in_order));
    });
  }

 private:
  using Factors = std::array<MonomialQuantity::Factor, 3>;

  Factors factors(const Box3& box, std::size_t first) const {
    const std::array<CertifiedDouble, 3> halves = half_lengths(box, first);
    Factors result;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t axis = (first + i) % 3;
      const Rational middle = (box.lower()[axis] + box.upper()[axis]) / 2 - origin_[axis];
      result[i] = {certified_double_of(middle), halves[i], exponents_[axis]};
    }
    return result;
  }
  static CertifiedDouble values(const Factors& factors) {
    CertifiedDouble result = exactly(1);
    for (const auto& factor : factors) result = result * factor.at({0, 1});
    return result;
  }
  static CertifiedDouble of_any_part(const Factors& factors, const Box3& box) {
    return up_to(values(factors) * certified_double_of(volume_of(box)));
  }

  Exponents exponents_;
  domain::Point<3> origin_;
};

}  // namespace detail

template <SpatialDomain P>
CertifiedMeasure moment(const csg::BooleanTree<P>& tree, const domain::Box<3>& box,
                        const Exponents& exponents, const MeasureLimits& limits = {},
                        const domain::Point<3>& origin = {}) {
  return detail::IntegralMeter<P, detail::MomentMeasure>(tree, box, limits,
                                                         detail::MomentMeasure(exponents, origin))
      .run();
}

struct Moments {
  CertifiedMeasure volume;
  std::array<CertifiedMeasure, 3> first;                  // of x, y, z
  std::array<std::array<CertifiedMeasure, 3>, 3> second;  // of the products of two
};

template <SpatialDomain P>
Moments moments(const csg::BooleanTree<P>& tree, const domain::Box<3>& box,
                const MeasureLimits& limits = {}, const domain::Point<3>& origin = {}) {
  Moments result;
  result.volume = volume(tree, box, limits);
  std::array<Rational, 3> reach;
  for (std::size_t i = 0; i < 3; ++i) {
    reach[i] = std::max(abs(Rational(box.upper()[i] - origin[i])),
                        abs(Rational(box.lower()[i] - origin[i])));
  }
  const Rational width = rational_of(limits.relative_width) * result.volume.value.lower;
  const auto measured = [&](const Exponents& exponents, const Rational& greatest) {
    MeasureLimits absolute = limits;
    absolute.relative_width = 0;
    absolute.absolute_width = nearest_double(Rational(width * greatest));
    return moment(tree, box, exponents, absolute, origin);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    Exponents exponents{};
    exponents[i] = 1;
    result.first[i] = measured(exponents, reach[i]);
    for (std::size_t j = i; j < 3; ++j) {
      Exponents product = exponents;
      ++product[j];
      result.second[i][j] = measured(product, Rational(reach[i] * reach[j]));
      result.second[j][i] = result.second[i][j];
    }
  }
  return result;
}

struct Centroid {
  std::array<Enclosure, 3> coordinates;
  StopReason stop = StopReason::Width;
};

template <SpatialDomain P>
std::optional<Centroid> centroid(const csg::BooleanTree<P>& tree, const domain::Box<3>& box,
                                 const MeasureLimits& limits = {}) {
  // About the box's centre a coordinate is at most half a side: of the width allowed, the first
  // moment's takes a half, and the volume's, times that coordinate, a quarter.
  MeasureLimits halved = limits;
  halved.absolute_width = 0;
  halved.relative_width = limits.relative_width / 2;
  const CertifiedMeasure mass = volume(tree, box, halved);
  if (mass.value.lower <= 0) return std::nullopt;
  Centroid result{{}, mass.stop};
  const domain::Point<3> centre = box.centre();
  for (std::size_t i = 0; i < 3; ++i) {
    MeasureLimits absolute = halved;
    absolute.relative_width = 0;
    absolute.absolute_width = nearest_double(Rational(
        rational_of(halved.relative_width) * mass.value.lower * (box.upper()[i] - box.lower()[i])));
    Exponents exponents{};
    exponents[i] = 1;
    const CertifiedMeasure first = moment(tree, box, exponents, absolute, centre);
    if (result.stop == StopReason::Width) result.stop = first.stop;
    const auto quotient = [&](const Rational& numerator, bool is_lower) {
      const bool by_lower = (numerator < 0) == is_lower;
      return Rational(centre[i] + numerator / (by_lower ? mass.value.lower : mass.value.upper));
    };
    result.coordinates[i] = {std::max(quotient(first.value.lower, true), box.lower()[i]),
                             std::min(quotient(first.value.upper, false), box.upper()[i])};
  }
  return result;
}

}  // namespace exactcsg::measure
