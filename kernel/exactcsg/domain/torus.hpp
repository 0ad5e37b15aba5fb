// SPDX-License-Identifier: Apache-2.0
#pragma once

// Circular and elliptic tori round any axis, and their images under affine maps, as half-spaces.
// [Exact]
//
// With the distance rho from the axis and the height z along it, in units of the major radius, an
// affine map makes every torus {(rho - 1)^2 + z^2 <= q}, q the squared ratio of the minor semi-axis
// across the axis to the major radius. That is {base <= sqrt(radicand)} for the polynomials
//   base = rho^2 + z^2 + 1 - q,  radicand = 4 rho^2,
// both of degree two with rational coefficients, under every map and for every rational axis. The
// surface is where base^2 = radicand and base >= 0. If q > 1 (a spindle torus), base^2 - radicand
// vanishes on the lemon inside as well, where base < 0: that is no boundary.
//
// LAW torus.1  classify(t, point) is On exactly on the surface; In is the interior.
// LAW torus.2  classify(t, box) is In only if the box is a subset of t, Out only if the interiors
//              are disjoint. If the axis is parallel to an axis of the box (z depends on one
//              coordinate, rho on the others), Unknown means that neither holds. Else Unknown is
//              said too of boxes of size e where the first order of base - sqrt(radicand) about
//              the middle leaves the surface at a distance of O(e^2), and is not tested further.
// LAW torus.3  section(t, line) is exact: crossings are roots of a polynomial of degree four, with
//              their multiplicities: 2 where the line touches, or passes a tip of the spindle; 4
//              along the axis through the centre of a horn torus (q = 1).
// LAW torus.4  complement and apply as LAW half_space.4 and half_space.5.
// COST: a point some fifty operations in doubles, near the surface rational ones (statistics count
// which); a box the like, exact if it nearly touches; a line an isolation of four roots.

#include <memory>
#include <utility>

#include "exactcsg/domain/axis.hpp"
#include "exactcsg/domain/half_space.hpp"

namespace exactcsg::domain {

class Torus {
 public:
  static constexpr std::size_t dimension = 3;

  // REQUIRES base and radicand as above for some affine map, squared_ratio > 0. The map may be
  // singular: then the set is a cylinder over a section of a torus.
  Torus(Quadric<3> base, Quadric<3> radicand, Rational squared_ratio)
      : data_(std::make_shared<const Data>(std::move(base), std::move(radicand),
                                           std::move(squared_ratio))) {}

  const Quadric<3>& base() const noexcept { return data_->base; }
  const Quadric<3>& radicand() const noexcept { return data_->radicand; }
  // z^2, in units of the semi-axis along the axis that belongs to a circle.
  const Quadric<3>& squared_height() const noexcept { return data_->squared_height; }
  const Rational& squared_ratio() const noexcept { return data_->squared_ratio; }
  bool is_complement() const noexcept { return is_complement_; }
  // The coordinate on which alone z depends, while rho does not.
  const std::optional<std::size_t>& box_axis() const noexcept { return data_->box_axis; }

  friend Torus complement(Torus torus) {
    torus.is_complement_ = !torus.is_complement_;
    return torus;
  }
  // Base and radicand are those of one surface only, since the major radius is their unit.
  bool has_surface_of(const Torus& other) const {
    return data_ == other.data_ || (base() == other.base() && radicand() == other.radicand());
  }
  // Equal point sets.
  friend bool operator==(const Torus& a, const Torus& b) {
    return a.is_complement_ == b.is_complement_ && a.has_surface_of(b);
  }

 private:
  struct Data {
    Data(Quadric<3> base, Quadric<3> radicand, Rational squared_ratio);
    Quadric<3> base;
    Quadric<3> radicand;
    Quadric<3> squared_height;
    Rational squared_ratio;
    std::optional<std::size_t> box_axis;
  };
  std::shared_ptr<const Data> data_;
  bool is_complement_ = false;
};

// The points at a distance rho from the axis and z from the plane through its point across it with
// (rho - major)^2 / across^2 + z^2 / along^2 <= 1. The axis need not have unit length.
// THROWS Error(BadArgument) unless all radii are above 0 and the axis has a direction.
Torus make_torus(const Axis& axis, const Rational& major, const Rational& along,
                 const Rational& across);

PointClass classify(const Torus& torus, const Point<3>& point,
                    TierStatistics* statistics = nullptr);
csg::Membership classify(const Torus& torus, const Box<3>& box);
Section section(const Torus& torus, const LineSection<3>& line);
// THROWS Error(SingularMap)
Torus apply(const AffineMap& map, const Torus& torus);

static_assert(Domain<Torus>);

}  // namespace exactcsg::domain
