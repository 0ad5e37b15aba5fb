// SPDX-License-Identifier: Apache-2.0
#pragma once

// The planes of a boundary's faces. They follow from its vertices, and many questions never ask for
// them: their coefficients are long numbers. [Exact]

#include <vector>

#include "exactcsg/solid/boundary.hpp"

namespace exactcsg {

// The coprime coefficients, the normal outward and the solid at plane <= 0.
// LAW faceplane.1  all vertices of the face lie in it.
// REQUIRES the face's smallest vertex to be a corner of it, as in every boundary of a solid; of a
// broken face with a straight corner there the plane is {0, 0, 0, 0}.
Plane exact_plane(const Boundary& boundary, const BoundaryFace& face);

// LAW faceplane.2  exact_planes(b)[f.plane] == exact_plane(b, f) for every face f of b.
// REQUIRES every face's plane number below plane_count. A plane of no face is {0, 0, 0, 0}.
// COST: a common divisor of long numbers for each plane.
std::vector<Plane> exact_planes(const Boundary& boundary);

}  // namespace exactcsg
