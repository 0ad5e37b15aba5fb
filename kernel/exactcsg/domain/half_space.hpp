// SPDX-License-Identifier: Apache-2.0
#pragma once

// Half-spaces bounded by surfaces of degree at most two, and what every domain can be asked: which
// class a point has, what a box is, and where a line crosses the boundary. [Exact]
//
// A half-space is {x : f(x) <= 0} for a polynomial f of degree at most two, or the part of such a
// set with g(x) <= 0 as well, g linear (one nappe of a cone); or the closure of the complement of
// either. It is an immutable value that shares its data: copying costs O(1).
//
// LAW half_space.1  classify(h, point) is On exactly where the boundary is: where f is zero (and
//                   g <= 0); In is the interior.
// LAW half_space.2  classify(h, box) is In iff the box is a subset of h, Out iff the interiors are
//                   disjoint, and Unknown iff neither: it is mixed. Never conservative.
// LAW half_space.3  section(h, line).between[i] is the class of every point of the line strictly
//                   between crossing i-1 and crossing i; all crossings are On or on both sides On.
// LAW half_space.4  complement(h) has In and Out swapped, On where h has.
// LAW half_space.5  apply(m, h) has at m(x) the class that h has at x, for points; for lines the
//                   same parameters.
// COST: a point some twenty operations in doubles, and near the boundary as many in integers on the
// stack, or rational ones where bits are too many for that (statistics count which); a box the
// like, exact (see quadric.hpp) only if it nearly touches; a line O(1) rational operations.
//
// Source: Davy and Dew, sections 3.2 and 3.4 (the domain of half-spaces); exactness is ours.

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/domain/point_class.hpp"
#include "exactcsg/domain/quadric.hpp"
#include "exactcsg/number/algebraic_number.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg::domain {

// A parameter at which a line meets the boundary. multiplicity: of the zero of f: 1 where the line
// crosses, 2 where it touches (or passes through the apex of a cone); 0 at the apex of a line that
// lies in the cone's surface.
struct Crossing {
  AlgebraicNumber parameter;
  int multiplicity = 1;
};

// LAW section.1  between.size() == crossings.size() + 1; crossings ascend, strictly between the
//                bounds of the line's section. (The bounds are points: classify them as such.)
struct Section {
  std::vector<Crossing> crossings;
  std::vector<PointClass> between;
};

// What the algorithms on trees need of a primitive; half-spaces are one model, a user's own type
// another.
template <class P>
concept Domain = std::copyable<P> &&
    requires(const P& primitive, const Point<P::dimension>& point, const Box<P::dimension>& box,
             const LineSection<P::dimension>& line) {
  { classify(primitive, point) } -> std::same_as<PointClass>;
  { classify(primitive, box) } -> std::same_as<csg::Membership>;
  { section(primitive, line) } -> std::same_as<Section>;
  { complement(primitive) } -> std::same_as<P>;
};

template <std::size_t D>
class HalfSpace {
 public:
  static constexpr std::size_t dimension = D;

  // {x : f(x) <= 0}. REQUIRES f takes both signs round every point where it is zero.
  explicit HalfSpace(Quadric<D> f) : data_(std::make_shared<const Data>(std::move(f))) {}
  // {x : f(x) <= 0 and g(x) <= 0}.
  // REQUIRES it is convex, and f > 0 where g = 0, but for one point, the apex, where f = 0.
  HalfSpace(Quadric<D> f, LinearForm<D> g)
      : data_(std::make_shared<const Data>(std::move(f), Quadric<D>(std::move(g)))) {}

  const Quadric<D>& polynomial() const noexcept { return data_->f; }
  // g of a half-space that has only one nappe.
  const std::optional<Quadric<D>>& nappe() const noexcept { return data_->g; }
  // True of the complement of what f (and g) describe.
  bool is_complement() const noexcept { return is_complement_; }

  friend HalfSpace complement(HalfSpace half_space) {
    half_space.is_complement_ = !half_space.is_complement_;
    return half_space;
  }
  // As written, not as a point set.
  friend bool operator==(const HalfSpace& a, const HalfSpace& b) {
    return a.is_complement_ == b.is_complement_ &&
           (a.data_ == b.data_ || (a.data_->f == b.data_->f && a.data_->g == b.data_->g));
  }

 private:
  struct Data {
    explicit Data(Quadric<D> polynomial, std::optional<Quadric<D>> nappe = std::nullopt)
        : f(std::move(polynomial)), g(std::move(nappe)) {}
    Quadric<D> f;
    std::optional<Quadric<D>> g;
  };
  std::shared_ptr<const Data> data_;
  bool is_complement_ = false;
};

namespace detail {

constexpr csg::Membership complement_if(bool complemented, csg::Membership value) {
  if (!complemented || value == csg::Membership::Unknown) return value;
  return value == csg::Membership::In ? csg::Membership::Out : csg::Membership::In;
}
constexpr PointClass complement_if(bool complemented, PointClass value) {
  return complemented ? complement(value) : value;
}

constexpr PointClass class_of(Sign f) {
  return f == Sign::Negative ? PointClass::In : f == Sign::Zero ? PointClass::On : PointClass::Out;
}
// Where f <= 0, g is zero at the apex only.
constexpr PointClass class_of(Sign f, Sign g) {
  return g == Sign::Positive ? PointClass::Out : class_of(f);
}

// A box as filters see it: every point of it is within extent of the middle.
template <std::size_t D>
struct ApproximateBox {
  std::array<CertifiedDouble, D> middle;
  std::array<double, D> extent{};

  explicit ApproximateBox(const Box<D>& box) {
    for (std::size_t i = 0; i < D; ++i) {
      const CertifiedDouble low = box.lower().approximate()[i];
      const CertifiedDouble high = box.upper().approximate()[i];
      const double m = low.value / 2 + high.value / 2;
      middle[i] = {m, 0};
      extent[i] = std::max(high.value + high.error - m, m - low.value + low.error) * (1 + 0x1p-50) +
                  0x1p-1000;
    }
  }
};

constexpr Sign certain_sign(const CertifiedDouble& value) {
  return value.value > value.error    ? Sign::Positive
         : -value.value > value.error ? Sign::Negative
                                      : Sign::Zero;
}

// In or Out if the doubles are certain for the whole box; Unknown if they are not.
template <std::size_t D>
csg::Membership filtered_class(const HalfSpace<D>& half_space, const Box<D>& box) {
  const ApproximateBox<D> region(box);
  const auto sign_in_box = [&](const Quadric<D>& f) {
    const CertifiedDouble value = f.approximate(region.middle);
    return certain_sign({value.value, value.error + f.variation(region.middle, region.extent)});
  };
  const Sign f = sign_in_box(half_space.polynomial());
  const Sign g = half_space.nappe() ? sign_in_box(*half_space.nappe()) : Sign::Negative;
  if (f == Sign::Positive || g == Sign::Positive) return csg::Membership::Out;
  return f == Sign::Negative && g == Sign::Negative ? csg::Membership::In
                                                    : csg::Membership::Unknown;
}

// The same by tight bounds, and whether it is mixed: nullopt if rounding does not allow to tell. Of
// one nappe it is not told. REQUIRES no mixed terms
template <std::size_t D>
std::optional<csg::Membership> class_by_bounds(const HalfSpace<D>& half_space, const Box<D>& box) {
  const RangeBounds f = half_space.polynomial().range_bounds(box);
  if (f.least_lower > 0) return csg::Membership::Out;
  if (half_space.nappe()) {
    const RangeBounds g = half_space.nappe()->range_bounds(box);
    if (g.least_lower > 0) return csg::Membership::Out;
    if (f.greatest_upper < 0 && g.greatest_upper < 0) return csg::Membership::In;
    return std::nullopt;
  }
  if (f.greatest_upper < 0) return csg::Membership::In;
  if (f.least_upper < 0 && f.greatest_lower > 0) return csg::Membership::Unknown;
  return std::nullopt;
}

// True if one corner is certainly inside and another outside: class_at(corner) -> Membership.
template <std::size_t D, class ClassAt>
bool has_mixed_corners(const Box<D>& box, ClassAt&& class_at) {
  bool has_inside = false;
  bool has_outside = false;
  for (std::size_t upper = 0; upper < (std::size_t{1} << D); ++upper) {
    std::array<CertifiedDouble, D> corner;
    for (std::size_t i = 0; i < D; ++i) {
      corner[i] = ((upper >> i & 1U) != 0 ? box.upper() : box.lower()).approximate()[i];
    }
    const csg::Membership at = class_at(corner);
    has_inside = has_inside || at == csg::Membership::In;
    has_outside = has_outside || at == csg::Membership::Out;
    if (has_inside && has_outside) return true;
  }
  return false;
}

// Unknown if the doubles do not tell.
template <std::size_t D>
csg::Membership filtered_class(const HalfSpace<D>& half_space,
                               const std::array<CertifiedDouble, D>& point) {
  const Sign f = certain_sign(half_space.polynomial().approximate(point));
  const Sign g =
      half_space.nappe() ? certain_sign(half_space.nappe()->approximate(point)) : Sign::Negative;
  if (f == Sign::Positive || g == Sign::Positive) return csg::Membership::Out;
  return f == Sign::Negative && g == Sign::Negative ? csg::Membership::In
                                                    : csg::Membership::Unknown;
}

template <std::size_t D>
bool has_certainly_mixed_corners(const HalfSpace<D>& half_space, const Box<D>& box) {
  return has_mixed_corners(box, [&](const std::array<CertifiedDouble, D>& corner) {
    return filtered_class(half_space, corner);
  });
}

// A point of the box near which sign f is least, perhaps: by steps along the axes.
template <std::size_t D>
std::array<CertifiedDouble, D> low_point(const Quadric<D>& f, double sign, const Box<D>& box) {
  constexpr int sweeps = 4;
  std::array<CertifiedDouble, D> x = ApproximateBox<D>(box).middle;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = 0; i < D; ++i) {
      const double low = box.lower().approximate()[i].upper();
      const double high = box.upper().approximate()[i].lower();
      if (!(low <= high)) continue;
      const double slope = sign * f.approximate_slope(i, x).value;
      const double curvature = sign * f.approximate_curvature(i);
      const double step = curvature > 0 ? -slope / (2 * curvature)
                          : slope > 0   ? low - high
                                        : high - low;
      x[i].value = std::clamp(x[i].value + step, low, high);
    }
  }
  return x;
}

// True if a point is found that is certainly inside, and one outside.
template <std::size_t D>
bool has_certainly_mixed_points(const HalfSpace<D>& half_space, const Box<D>& box) {
  if (has_certainly_mixed_corners(half_space, box)) return true;
  if (half_space.polynomial().is_linear()) return false;
  const auto is_at_low_point = [&](double sign, csg::Membership expected) {
    return filtered_class(half_space, low_point(half_space.polynomial(), sign, box)) == expected;
  };
  return is_at_low_point(1, csg::Membership::In) && is_at_low_point(-1, csg::Membership::Out);
}

// Without the complement.
template <std::size_t D>
csg::Membership exact_class(const HalfSpace<D>& half_space, const Box<D>& box) {
  const Quadric<D>& f = half_space.polynomial();
  bool has_interior = false;
  bool has_exterior = false;
  for_each_extreme_candidate(f, box, [&](const Coordinates<D>& point) {
    const Sign sign = sign_of(f(point));
    const Sign nappe = half_space.nappe() ? sign_of((*half_space.nappe())(point)) : Sign::Negative;
    has_interior = has_interior || (sign == Sign::Negative && nappe == Sign::Negative);
    // One nappe is convex: a box of which no corner is outside is a subset.
    has_exterior = has_exterior || sign == Sign::Positive || nappe == Sign::Positive;
    return !(has_interior && has_exterior);
  });
  if (!has_interior) return csg::Membership::Out;
  return has_exterior ? csg::Membership::Unknown : csg::Membership::In;
}

}  // namespace detail

template <std::size_t D>
PointClass classify(const HalfSpace<D>& half_space, const Point<D>& point,
                    TierStatistics* statistics = nullptr) {
  const Sign f = half_space.polynomial().sign(point, statistics);
  const Sign g = half_space.nappe() && f != Sign::Positive
                     ? half_space.nappe()->sign(point, statistics)
                     : Sign::Negative;
  return detail::complement_if(half_space.is_complement(), detail::class_of(f, g));
}

template <std::size_t D>
csg::Membership classify(const HalfSpace<D>& half_space, const Box<D>& box) {
  const auto without_complement = [&] {
    const csg::Membership filtered = detail::filtered_class(half_space, box);
    if (filtered != csg::Membership::Unknown) return filtered;
    if (!half_space.polynomial().has_mixed_terms()) {
      if (const auto known = detail::class_by_bounds(half_space, box)) return *known;
    }
    return detail::has_certainly_mixed_points(half_space, box)
               ? csg::Membership::Unknown
               : detail::exact_class(half_space, box);
  };
  return detail::complement_if(half_space.is_complement(), without_complement());
}

namespace detail {

// A parameter strictly between crossing i-1 and crossing i, or a bound in the place of either.
inline Rational parameter_between(const std::vector<Crossing>& crossings, std::size_t i,
                                  const std::optional<Rational>& begin,
                                  const std::optional<Rational>& end) {
  using Bound = std::optional<AlgebraicNumber>;
  const auto bound = [](const std::optional<Rational>& value) {
    return value ? Bound(AlgebraicNumber(*value)) : Bound();
  };
  const Bound low = i > 0 ? Bound(crossings[i - 1].parameter) : bound(begin);
  const Bound high = i < crossings.size() ? Bound(crossings[i].parameter) : bound(end);
  if (low && high) return rational_between(*low, *high);
  if (low) return enclose(*low, 0).upper + 1;
  return high ? Rational(enclose(*high, 0).lower - 1) : Rational(0);
}

// On the whole line, without the complement.
struct SectionBuilder {
  QuadraticPolynomial f;
  std::optional<QuadraticPolynomial> g;
  Section section;

  void add_crossings() {
    for (RealRoot& root : real_roots(f)) {
      if (!g || !is_positive(*g, root.value)) {
        section.crossings.push_back({std::move(root.value), root.multiplicity});
      }
    }
  }
  void add_classes() {
    for (std::size_t i = 0; i <= section.crossings.size(); ++i) {
      const Rational inside = parameter_between(section.crossings, i, std::nullopt, std::nullopt);
      section.between.push_back(
          class_of(sign_of(f(inside)), g ? sign_of((*g)(inside)) : Sign::Negative));
    }
  }

 private:
  // linear t + constant > 0 at t = a + b sqrt(c)
  static bool is_positive(const QuadraticPolynomial& linear, const QuadraticNumber& t) {
    return sign_of(QuadraticNumber(linear.linear * t.rational_part() + linear.constant,
                                   linear.linear * t.factor(), t.radicand())) == Sign::Positive;
  }
};

// Where the gradient of f vanishes on a line that lies in the surface, if at one point.
template <std::size_t D>
std::optional<Rational> apex_on(const Quadric<D>& f, const LineSection<D>& line) {
  const Coordinates<D> here = f.gradient(line.origin);
  const Coordinates<D> there = f.gradient(line.at(1).coordinates());
  std::optional<Rational> apex;
  for (std::size_t i = 0; i < D; ++i) {
    const Rational slope = there[i] - here[i];
    if (slope == 0 && here[i] == 0) continue;
    if (slope == 0) return std::nullopt;
    Rational zero = -here[i] / slope;
    if (apex && *apex != zero) return std::nullopt;
    apex = std::move(zero);
  }
  return apex;
}

// Keeps what lies strictly between the bounds.
inline void clip(Section& section, const std::optional<Rational>& begin,
                 const std::optional<Rational>& end) {
  auto& [crossings, between] = section;
  if (end) {
    const AlgebraicNumber bound(*end);
    while (!crossings.empty() && crossings.back().parameter >= bound) {
      crossings.pop_back();
      between.pop_back();
    }
  }
  if (begin) {
    const AlgebraicNumber bound(*begin);
    while (!crossings.empty() && crossings.front().parameter <= bound) {
      crossings.erase(crossings.begin());
      between.erase(between.begin());
    }
  }
}

}  // namespace detail

template <std::size_t D>
Section section(const HalfSpace<D>& half_space, const LineSection<D>& line) {
  detail::SectionBuilder builder{restrict(half_space.polynomial(), line), std::nullopt, {}};
  if (half_space.nappe()) builder.g = restrict(*half_space.nappe(), line);
  if (!builder.f.is_zero()) {
    builder.add_crossings();
  } else if (const auto apex = detail::apex_on(half_space.polynomial(), line)) {
    builder.section.crossings.push_back({*apex, 0});
  }
  builder.add_classes();
  detail::clip(builder.section, line.begin, line.end);
  for (PointClass& value : builder.section.between) {
    value = detail::complement_if(half_space.is_complement(), value);
  }
  return std::move(builder.section);
}

namespace detail {

template <std::size_t D>
AffineRows<D> rows_of(const AffineMap& map) {
  if constexpr (D == 3) {
    return map.m;
  } else {
    return {{{map.m[0][0], map.m[0][1], map.m[0][3]}, {map.m[1][0], map.m[1][1], map.m[1][3]}}};
  }
}

}  // namespace detail

// In the plane, the map's effect on x and y. REQUIRES D = 3; or D = 2, and the map leaves z alone
// and does not read it.
template <std::size_t D>
requires(D == 2 || D == 3) Point<D> apply(const AffineMap& map, const Point<D>& point) {
  const AffineRows<D> rows = detail::rows_of<D>(map);
  Coordinates<D> image;
  for (std::size_t i = 0; i < D; ++i) {
    image[i] = rows[i][D];
    for (std::size_t j = 0; j < D; ++j) image[i] += rows[i][j] * point[j];
  }
  return image;
}

// REQUIRES the same. THROWS Error(SingularMap)
template <std::size_t D>
requires(D == 2 || D == 3) HalfSpace<D> apply(const AffineMap& map,
                                              const HalfSpace<D>& half_space) {
  if (determinant(map) == 0) throw Error(ErrorId::SingularMap, {"", ""});
  const AffineRows<D> back = detail::rows_of<D>(inverse(map));
  const Quadric<D> f = substitute(half_space.polynomial(), back);
  const HalfSpace<D> image = half_space.nappe()
                                 ? HalfSpace<D>(f, substitute(half_space.nappe()->linear(), back))
                                 : HalfSpace<D>(f);
  return half_space.is_complement() ? complement(image) : image;
}

static_assert(Domain<HalfSpace<2>> && Domain<HalfSpace<3>>);

}  // namespace exactcsg::domain
