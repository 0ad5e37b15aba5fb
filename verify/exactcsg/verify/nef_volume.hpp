// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A region's volume between those of two polyhedra, by Nef polyhedra. [Certified]
//
// LAW nef_volume.1  the volume of the region within the window and the box lies in the bounds.
// LAW nef_volume.2  a check against them has failed only if the two have no number in common, and
//                   is Skipped with its reason where there are none.
// A fault that is smaller than the bounds' width is not seen; the check says how large that is.
// COST: two Nef polyhedra (faceted_region.hpp), each in a process of its own; one, if all surfaces
// are planes.

#include <optional>
#include <string>

#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/verify/faceted_region.hpp"
#include "exactcsg/verify/nef.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct NefVolume {
  std::optional<Enclosure> bounds;
  std::string reason;  // why there are none
};

NefVolume nef_volume(
    const io::openmc::Model& model, const io::openmc::Region& region, const domain::Box<3>& box,
    std::uint32_t segments, const NefLimits& limits,
    const io::openmc::HalfSpaceRegion& window = io::openmc::HalfSpaceRegion::full());

Check compare_with_nef(std::string name, const Enclosure& ours, const NefVolume& theirs);

}  // namespace exactcsg::verify
