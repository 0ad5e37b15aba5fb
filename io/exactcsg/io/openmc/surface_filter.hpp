// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A surface in doubles: on which side of it a point, or a whole box, certainly is. [Certified]
//
// LAW surface_filter.1  In or Out of {f <= 0} is said only of points, and of boxes, that are in the
//                       interior or the exterior; Unknown of others.

#include <array>
#include <optional>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/io/openmc/model.hpp"
#include "exactcsg/number/certified_double.hpp"

namespace exactcsg::io::openmc {

// A point known up to errors.
using CertifiedPoint = std::array<CertifiedDouble, 3>;

class SurfaceFilter {
 public:
  explicit SurfaceFilter(const HalfSpace& half_space);

  csg::Membership classify(const CertifiedPoint& point) const;
  // Of the box. REQUIRES lower <= upper
  csg::Membership classify(const std::array<double, 3>& lower,
                           const std::array<double, 3>& upper) const;

 private:
  std::optional<domain::Torus> torus_;  // the rest is a quadric's
  bool is_usable_ = true;  // false: the doubles are too small to be close to the coefficients
  double constant_ = 0;
  std::array<double, 3> linear_{};
  std::array<std::array<double, 3>, 3> square_{};
};

}  // namespace exactcsg::io::openmc
