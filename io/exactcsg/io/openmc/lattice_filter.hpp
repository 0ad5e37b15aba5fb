// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A lattice in doubles: which element a point is certainly in. [Certified]
//
// LAW lattice_filter.1  place(p), if it has a value, is place_in for every point within the errors
//                       of p, which is on no boundary; `local` encloses its local coordinates.

#include <array>
#include <cstdint>
#include <optional>

#include "exactcsg/io/openmc/model.hpp"
#include "exactcsg/io/openmc/surface_filter.hpp"

namespace exactcsg::io::openmc {

struct FilteredPlace {
  std::optional<std::array<std::int64_t, 3>> element;  // these two as in LatticePlace
  std::optional<Index> universe;
  CertifiedPoint local;
};

class LatticeFilter {
 public:
  // REQUIRES that the lattice outlives it.
  explicit LatticeFilter(const Lattice& lattice);

  std::optional<FilteredPlace> place(const CertifiedPoint& point) const;

 private:
  // The number of an interval along an axis, and the coordinate relative to its middle.
  struct Interval {
    std::int64_t index = 0;
    CertifiedDouble local;
  };
  std::optional<Interval> interval(CertifiedDouble x, std::size_t axis) const;
  // The first two numbers of the element, and the first two local coordinates.
  std::optional<std::array<Interval, 2>> hexagon(const CertifiedPoint& point) const;

  const Lattice* lattice_;
  std::array<CertifiedDouble, 3> origin_;  // along z the lower end
  std::array<CertifiedDouble, 3> pitch_;
  CertifiedDouble step_;  // of columns of hexagons
};

}  // namespace exactcsg::io::openmc
