// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/domain/torus.hpp"

#include <array>
#include <cmath>

#include "exactcsg/number/certified_root.hpp"

namespace exactcsg::domain {

namespace {

Quadric<3> constant(const Rational& value) { return {LinearForm<3>{{}, value}}; }

bool depends_on(const Quadric<3>& f, std::size_t axis) {
  return f.linear().normal[axis] != 0 || f.square()[axis] != Coordinates<3>{};
}

std::optional<std::size_t> separating_axis(const Quadric<3>& of_one, const Quadric<3>& of_others) {
  std::optional<std::size_t> result;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!depends_on(of_one, i)) continue;
    if (result || depends_on(of_others, i)) return std::nullopt;
    result = i;
  }
  return result;
}

// The sign of base - sqrt(radicand).
Sign exact_sign(const Rational& base, const Rational& radicand) {
  if (base < 0) return Sign::Negative;
  return sign_of(Rational(base * base - radicand));
}

CertifiedDouble approximate(const Torus& torus, const std::array<CertifiedDouble, 3>& at) {
  return torus.base().approximate(at) - square_root(torus.radicand().approximate(at));
}

double magnitude(const CertifiedDouble& x) { return std::abs(x.value) + x.error; }

// What base - sqrt(radicand) has on a box, from its value and its gradient in the middle. base is
// convex, and so is sqrt(radicand) = 2 rho, whose second derivative along v is at most v'Rv / (2
// rho), R the second-order part of the radicand: what is beyond the first order is between
// -v'Rv / (4 rho) and v'Bv, B that of base.
csg::Membership filtered_class(const Torus& torus, const detail::ApproximateBox<3>& box) {
  const CertifiedDouble root = square_root(torus.radicand().approximate(box.middle));
  const double radial_curvature = torus.radicand().curvature(box.extent);
  const double reach = std::sqrt(radial_curvature) * (1 + 0x1p-50);
  const double least_root = (root.value - root.error) * (1 - 0x1p-50) - reach;
  double first_order = 0;
  double below = 0;
  if (least_root > 0) {
    for (std::size_t i = 0; i < 3; ++i) {
      const CertifiedDouble slope =
          torus.base().approximate_slope(i, box.middle) -
          torus.radicand().approximate_slope(i, box.middle) / (CertifiedDouble{2, 0} * root);
      first_order += magnitude(slope) * box.extent[i];
    }
    below = radial_curvature / (2 * least_root);
  } else {  // the root may change by `reach`
    for (std::size_t i = 0; i < 3; ++i) {
      first_order += magnitude(torus.base().approximate_slope(i, box.middle)) * box.extent[i];
    }
    first_order += reach;
  }
  const CertifiedDouble value = torus.base().approximate(box.middle) - root;
  constexpr double rounding = 1 + 0x1p-40;
  if (value.value > value.error + (first_order + below) * rounding) return csg::Membership::Out;
  const double above = first_order + torus.base().curvature(box.extent);
  return -value.value > value.error + above * rounding ? csg::Membership::In
                                                       : csg::Membership::Unknown;
}

bool has_certainly_mixed_corners(const Torus& torus, const Box<3>& box) {
  return detail::has_mixed_corners(box, [&](const std::array<CertifiedDouble, 3>& corner) {
    switch (detail::certain_sign(approximate(torus, corner))) {
      case Sign::Negative:
        return csg::Membership::In;
      case Sign::Positive:
        return csg::Membership::Out;
      case Sign::Zero:
        break;
    }
    return csg::Membership::Unknown;
  });
}

// The box is a rectangle in (rho, z), and the torus a disc round (1, 0): nearest and farthest point
// of the rectangle. REQUIRES a box axis
csg::Membership exact_class(const Torus& torus, const Box<3>& box) {
  const Range radicand = range(torus.radicand(), box);
  const Range squared_height = range(torus.squared_height(), box);
  const auto sign_at = [&](const Rational& four_rho_squared, const Rational& z_squared) {
    return exact_sign(Rational(four_rho_squared / 4 + z_squared + 1 - torus.squared_ratio()),
                      four_rho_squared);
  };
  const Rational nearest = radicand.maximum < 4   ? radicand.maximum
                           : radicand.minimum > 4 ? radicand.minimum
                                                  : Rational(4);
  if (sign_at(nearest, squared_height.minimum) != Sign::Negative) return csg::Membership::Out;
  const bool is_inside = sign_at(radicand.minimum, squared_height.maximum) != Sign::Positive &&
                         sign_at(radicand.maximum, squared_height.maximum) != Sign::Positive;
  return is_inside ? csg::Membership::In : csg::Membership::Unknown;
}

}  // namespace

Torus::Data::Data(Quadric<3> base_, Quadric<3> radicand_, Rational squared_ratio_)
    : base(std::move(base_)),
      radicand(std::move(radicand_)),
      squared_height(base + Rational(-1, 4) * radicand + constant(squared_ratio_ - 1)),
      squared_ratio(std::move(squared_ratio_)),
      box_axis(separating_axis(squared_height, radicand)) {}

Torus make_torus(const Axis& axis, const Rational& major, const Rational& along,
                 const Rational& across) {
  detail::check(axis);
  for (const Rational& radius : {major, along, across}) {
    if (radius > 0) continue;
    throw Error(ErrorId::BadArgument, {"the radius " + to_text(radius), "one above 0"});
  }
  const Rational unit = 1 / (detail::squared_length(axis.direction) * major * major);
  const Rational squash = across / along;
  const Rational ratio = across / major;
  const Quadric<3> squared_radius = unit * detail::squared_distance(axis);
  const LinearForm<3> height = detail::height(axis);
  const Quadric<3> squared_height = Rational(unit * squash * squash) * product(height, height);
  Rational squared_ratio = ratio * ratio;
  return {squared_radius + squared_height + constant(1 - squared_ratio),
          Rational(4) * squared_radius, std::move(squared_ratio)};
}

PointClass classify(const Torus& torus, const Point<3>& point, TierStatistics* statistics) {
  Sign sign = detail::certain_sign(approximate(torus, point.approximate()));
  if (sign != Sign::Zero) {
    if (statistics != nullptr) statistics->record(Tier::Double, false);
  } else {
    sign = exact_sign(torus.base()(point.coordinates()), torus.radicand()(point.coordinates()));
    if (statistics != nullptr) statistics->record(Tier::Unbounded, sign == Sign::Zero);
  }
  return detail::complement_if(torus.is_complement(), detail::class_of(sign));
}

csg::Membership classify(const Torus& torus, const Box<3>& box) {
  csg::Membership result = filtered_class(torus, detail::ApproximateBox<3>(box));
  if (result == csg::Membership::Unknown && torus.box_axis() &&
      !has_certainly_mixed_corners(torus, box)) {
    result = exact_class(torus, box);
  }
  return detail::complement_if(torus.is_complement(), result);
}

Section section(const Torus& torus, const LineSection<3>& line) {
  const QuadraticPolynomial base = restrict(torus.base(), line);
  const QuadraticPolynomial radicand = restrict(torus.radicand(), line);
  const std::array<Rational, 5> surface{
      Rational(base.constant * base.constant - radicand.constant),
      Rational(2 * base.constant * base.linear - radicand.linear),
      Rational(base.linear * base.linear + 2 * base.constant * base.square - radicand.square),
      Rational(2 * base.linear * base.square), Rational(base.square * base.square)};
  // base is negative between its zeros: there the polynomial has zeros of the lemon.
  const std::vector<RealRoot> lemon = real_roots(base);
  Section result;
  for (AlgebraicRoot& root : real_roots(surface)) {
    if (lemon.size() == 2 && root.value > lemon[0].value && root.value < lemon[1].value) continue;
    result.crossings.push_back({std::move(root.value), root.multiplicity});
  }
  for (std::size_t i = 0; i <= result.crossings.size(); ++i) {
    const Rational t = detail::parameter_between(result.crossings, i, std::nullopt, std::nullopt);
    result.between.push_back(detail::complement_if(
        torus.is_complement(), detail::class_of(exact_sign(base(t), radicand(t)))));
  }
  detail::clip(result, line.begin, line.end);
  return result;
}

Torus apply(const AffineMap& map, const Torus& torus) {
  if (determinant(map) == 0) throw Error(ErrorId::SingularMap, {"", ""});
  const AffineRows<3> back = inverse(map).m;
  const Torus image(substitute(torus.base(), back), substitute(torus.radicand(), back),
                    torus.squared_ratio());
  return torus.is_complement() ? complement(image) : image;
}

}  // namespace exactcsg::domain
