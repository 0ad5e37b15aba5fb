// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Boxes that contain regions of an OpenMC model. [Exact]
//
// LAW region_bounds.1  every point of the region is within the bounds; nullopt: the region is empty
//                      for reasons of these bounds alone.
// LAW region_bounds.2  an intersection of planes, spheres, cylinders along an axis and tori is
//                      bounded as tightly as its planes and the boxes of the others bound it
//                      together.
// What is not bounded, or not seen to be (quadrics, cones, unions within intersections of slanted
// planes), has no bound on that side. COST: O(nodes), and O(k^3) for k planes of one intersection.

#include <array>
#include <optional>

#include "exactcsg/io/openmc/model.hpp"
#include "exactcsg/io/openmc/surfaces.hpp"

namespace exactcsg::io::openmc {

using RegionBounds = std::optional<std::array<Extent, 3>>;

RegionBounds bounds_of(const Model& model, const Region& region);
// The smallest that contain both.
RegionBounds hull(const RegionBounds& a, const RegionBounds& b);
// The part of the box within the bounds; nullopt if it has no interior.
std::optional<domain::Box<3>> cut(const domain::Box<3>& box, const RegionBounds& bounds);

// The box in which the root is looked at if nobody says which: its cells' bounds, and a little
// more, so that what lies next to them is seen. Along an axis without bounds: those of all surfaces
// of the root; or, if the whole model is the same everywhere along it, from -1 to 1.
// THROWS Error(UnboundedSolid) if no surface of the root's cells has a boundary condition, or an
// axis has no bounds.
domain::Box<3> box_of_root(const Model& model);

}  // namespace exactcsg::io::openmc
