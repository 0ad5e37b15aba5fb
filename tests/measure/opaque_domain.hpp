// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The archetype of a domain of space.

#include "exactcsg/measure/surface_table.hpp"
#include "measure/curved_solids.hpp"

namespace exactcsg::measure::test {

// A domain of which only the concept is known.
struct Opaque {
  static constexpr std::size_t dimension = 3;
  HalfSpace<3> half_space;
};
inline PointClass classify(const Opaque& o, const Point<3>& p) { return classify(o.half_space, p); }
inline csg::Membership classify(const Opaque& o, const Box<3>& b) {
  return classify(o.half_space, b);
}
inline domain::Section section(const Opaque& o, const domain::LineSection<3>& line) {
  return section(o.half_space, line);
}
inline Opaque complement(const Opaque& o) { return {complement(o.half_space)}; }
static_assert(SpatialDomain<Opaque>);

}  // namespace exactcsg::measure::test
