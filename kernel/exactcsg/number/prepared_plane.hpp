// SPDX-License-Identifier: Apache-2.0
#pragma once

// Planes before a Geometry numbers them: what any thread can find of a plane by itself. Private to
// the kernel. [Exact]

#include <memory>
#include <optional>

#include "exactcsg/number/geometry.hpp"

namespace exactcsg {

// A number of a plane that depends neither on its scale nor on its sense, between two bounds:
// planes whose enclosures are disjoint are different. [Certified]
struct PlaneKey {
  double lower;
  double upper;
};

struct PreparedPlane {
  Geometry::ApproximatePlane near;
  PlaneKey key;
  std::unique_ptr<const Plane> exact;  // given, or computed already; may be null
};

// A point and what approximate() says of it.
struct NearPoint {
  const Point3& exact;
  const ApproximatePoint& near;
};

// The plane through three points, counter-clockwise from outside. Nothing exact is computed unless
// the certified double is too poor.
// THROWS Error(DegenerateFacet) if they are collinear.
PreparedPlane prepared_plane(const NearPoint& p, const NearPoint& q, const NearPoint& r);
// The same, or nullopt if the certified double is too poor.
std::optional<PreparedPlane> quickly_prepared_plane(const NearPoint& p, const NearPoint& q,
                                                    const NearPoint& r);
// The plane through p, q and p moved up along the axis: the normal is (q - p) x (the axis).
// THROWS Error(DegenerateFacet) if the line through p and q has the axis' direction.
PreparedPlane prepared_plane(const NearPoint& p, const NearPoint& q, Axis axis);
// REQUIRES coprime coefficients (LAW plane.1)
PreparedPlane prepared_plane(const Plane& plane);

}  // namespace exactcsg
