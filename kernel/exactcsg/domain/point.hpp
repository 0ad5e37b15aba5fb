// SPDX-License-Identifier: Apache-2.0
#pragma once

// Points, boxes and sections of lines in D dimensions, with rational coordinates: what is
// classified. [Exact]

#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <utility>

#include "exactcsg/number/certified_double.hpp"
#include "exactcsg/number/exact.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::domain {

template <std::size_t D>
using Coordinates = std::array<Rational, D>;

// A point, and what the filters ask: its coordinates as doubles, computed once.
template <std::size_t D>
class Point {
 public:
  static constexpr std::size_t dimension = D;

  Point() : Point(Coordinates<D>{}) {}
  Point(Coordinates<D> coordinates) : exact_(std::move(coordinates)) {
    for (std::size_t i = 0; i < D; ++i) approximate_[i] = certified_double_of(exact_[i]);
  }
  template <std::convertible_to<Rational>... R>
  requires(sizeof...(R) == D && D > 1) Point(const R&... coordinates)
      : Point(Coordinates<D>{Rational(coordinates)...}) {}

  const Rational& operator[](std::size_t axis) const noexcept { return exact_[axis]; }
  const Coordinates<D>& coordinates() const noexcept { return exact_; }
  const std::array<CertifiedDouble, D>& approximate() const noexcept { return approximate_; }

  friend bool operator==(const Point& p, const Point& q) { return p.exact_ == q.exact_; }

 private:
  Coordinates<D> exact_;
  std::array<CertifiedDouble, D> approximate_;
};

// The closed axis-parallel box. LAW box.1  lower < upper along every axis.
template <std::size_t D>
class Box {
 public:
  static constexpr std::size_t dimension = D;

  // THROWS Error(BadArgument) unless lower < upper along every axis.
  Box(Point<D> lower, Point<D> upper) : lower_(std::move(lower)), upper_(std::move(upper)) {
    for (std::size_t i = 0; i < D; ++i) {
      if (lower_[i] < upper_[i]) continue;
      throw Error(ErrorId::BadArgument, {"a box from " + to_text(lower_[i]) + " to " +
                                             to_text(upper_[i]) + " along an axis",
                                         "a lower bound below the upper one"});
    }
  }

  const Point<D>& lower() const noexcept { return lower_; }
  const Point<D>& upper() const noexcept { return upper_; }
  Point<D> centre() const {
    Coordinates<D> middle;
    for (std::size_t i = 0; i < D; ++i) middle[i] = (lower_[i] + upper_[i]) / 2;
    return middle;
  }
  friend bool operator==(const Box&, const Box&) = default;

 private:
  Point<D> lower_;
  Point<D> upper_;
};

// The points origin + t direction of a line with begin <= t <= end; a bound that is not there is
// infinite.
template <std::size_t D>
struct LineSection {
  static constexpr std::size_t dimension = D;

  Coordinates<D> origin;
  Coordinates<D> direction;
  std::optional<Rational> begin;
  std::optional<Rational> end;

  Point<D> at(const Rational& parameter) const {
    Coordinates<D> point;
    for (std::size_t i = 0; i < D; ++i) point[i] = origin[i] + parameter * direction[i];
    return point;
  }
};

namespace detail {

template <std::size_t D>
LineSection<D> section(const Coordinates<D>& origin, const Coordinates<D>& direction) {
  for (const Rational& component : direction) {
    if (component != 0) return {origin, direction, std::nullopt, std::nullopt};
  }
  throw Error(ErrorId::BadArgument,
              {"a line without direction", "two different points, or a direction that is not 0"});
}

}  // namespace detail

// These THROW Error(BadArgument) if the direction is zero, or both points are the same.
template <std::size_t D>
LineSection<D> whole_line(const Point<D>& origin, const Coordinates<D>& direction) {
  return detail::section<D>(origin.coordinates(), direction);
}
template <std::size_t D>
LineSection<D> ray(const Point<D>& origin, const Coordinates<D>& direction) {
  LineSection<D> result = whole_line(origin, direction);
  result.begin = 0;
  return result;
}
// From t = 0 to t = 1.
template <std::size_t D>
LineSection<D> segment(const Point<D>& from, const Point<D>& to) {
  Coordinates<D> direction;
  for (std::size_t i = 0; i < D; ++i) direction[i] = to[i] - from[i];
  LineSection<D> result = ray(from, direction);
  result.end = 1;
  return result;
}

}  // namespace exactcsg::domain
