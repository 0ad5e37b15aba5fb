// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Regions of an OpenMC model with their curved surfaces replaced by convex polyhedra, once so that
// nothing is added and once so that nothing is lost. [Exact]
//
// Spheres, cylinders and cones along an axis or not, and ellipsoids are images of the unit ball, of
// the unit circle's cylinder or of its double cone. Their inner polyhedron has its corners in the
// set; the outer one is the inner one enlarged by a rational factor at which every side is at least
// 1 away from the centre. Tori round an axis of the box are held between rings of polygons, the
// corners of which are chosen so that what a chord cuts off is made good. Irrational semi-axes are
// rounded inwards for the one and outwards for the other. A region grows with the insides that it
// is made of and shrinks with the outsides: that says which of the two stands for which occurrence.
//
// It shares the reader's coefficients with the kernel, and no half-space, no column, no enclosure;
// but for the window, if there is one: what cells above leave visible, as the reader found it.
//
// LAW faceted_region.1  lower is a subset of what the region, the window and the box have in
//                       common, and upper a superset, but for sets without interior.
// LAW faceted_region.2  both are bounded: within the box.
// LAW faceted_region.3  if is_exact, the two are equal: all surfaces are planes.
// COST: O(segments^4) signs for a sphere, O(segments^2) for the others.

#include <optional>
#include <string>

#include "exactcsg/io/openmc/model.hpp"
#include "exactcsg/solid/solid.hpp"

namespace exactcsg::verify {

struct FacetedRegion {
  Solid lower;
  Solid upper;
  bool is_exact = true;
};

// Why the two have no faceted version: the first of the region's surfaces that is no plane and none
// of the above (a hyperboloid, a paraboloid, a pair of planes, a torus without a hole or with one
// that is too narrow for so many segments), or one such, or any torus, of the window; nullopt: they
// have one.
std::optional<std::string> reason_not_faceted(
    const io::openmc::Model& model, const io::openmc::Region& region, std::uint32_t segments,
    const io::openmc::HalfSpaceRegion& window = io::openmc::HalfSpaceRegion::full());

// segments: corners of a ball's equator, which has half as many bands, and of a torus's profile;
// cylinders, cones and the equators of tori have twice as many.
// REQUIRES !reason_not_faceted(model, region, segments, window), segments >= 4 and even
FacetedRegion faceted(
    const io::openmc::Model& model, const io::openmc::Region& region, const domain::Box<3>& box,
    std::uint32_t segments,
    const io::openmc::HalfSpaceRegion& window = io::openmc::HalfSpaceRegion::full());

}  // namespace exactcsg::verify
