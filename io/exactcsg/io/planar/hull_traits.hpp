// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The predicates that CGAL's quickhull asks for, answered by PolyhedronSigns: doubles first, exact
// integers where they cannot tell. CGAL's lazy kernel builds rationals for every plane of points
// that are not doubles, which took most of the time of models with hulls. [Exact]

#include <CGAL/Kernel_traits.h>

#include <cstdint>

#include "exactcsg/solid/polyhedron_signs.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io {

// One of the distinct points of `signs`.
struct HullPoint {
  const PolyhedronSigns* signs = nullptr;
  std::uint32_t index = 0;
};
inline bool operator==(const HullPoint& p, const HullPoint& q) { return p.index == q.index; }

struct HullTraits {
  using Point_3 = HullPoint;
  struct Plane_3 {
    HullPoint a, b, c;
  };

  struct Construct_plane_3 {
    Plane_3 operator()(HullPoint a, HullPoint b, HullPoint c) const { return {a, b, c}; }
  };
  struct Equal_3 {
    bool operator()(HullPoint p, HullPoint q) const { return p == q; }
  };
  struct Collinear_3 {
    bool operator()(HullPoint p, HullPoint q, HullPoint r) const {
      return p.signs->collinear(p.index, q.index, r.index);
    }
  };
  struct Coplanar_3 {
    bool operator()(HullPoint p, HullPoint q, HullPoint r, HullPoint s) const {
      return p.signs->orientation(p.index, q.index, r.index, s.index) == Sign::Zero;
    }
  };
  struct Has_on_positive_side_3 {
    bool operator()(const Plane_3& plane, HullPoint p) const {
      return p.signs->orientation(plane.a.index, plane.b.index, plane.c.index, p.index) ==
             Sign::Positive;
    }
  };
  struct Less_signed_distance_to_plane_3 {
    bool operator()(const Plane_3& plane, HullPoint p, HullPoint q) const {
      return p.signs->along_normal(plane.a.index, plane.b.index, plane.c.index, p.index, q.index) ==
             Sign::Positive;
    }
  };
  // Asked for collinear points only, of which there are none.
  struct Less_distance_to_point_3 {
    bool operator()(HullPoint, HullPoint, HullPoint) const { throw_flat(); }
  };

  // Asked for coplanar points only.
  struct NoProjection {
    struct Left_turn_2 {
      bool operator()(HullPoint, HullPoint, HullPoint) const { throw_flat(); }
    };
    Left_turn_2 left_turn_2_object() const { return {}; }
  };
  using Traits_xy_3 = NoProjection;
  using Traits_yz_3 = NoProjection;
  using Traits_xz_3 = NoProjection;

  Construct_plane_3 construct_plane_3_object() const { return {}; }
  Equal_3 equal_3_object() const { return {}; }
  Collinear_3 collinear_3_object() const { return {}; }
  Coplanar_3 coplanar_3_object() const { return {}; }
  Has_on_positive_side_3 has_on_positive_side_3_object() const { return {}; }
  Less_signed_distance_to_plane_3 less_signed_distance_to_plane_3_object() const { return {}; }
  Less_distance_to_point_3 less_distance_to_point_3_object() const { return {}; }
  NoProjection construct_traits_xy_3_object() const { return {}; }
  NoProjection construct_traits_yz_3_object() const { return {}; }
  NoProjection construct_traits_xz_3_object() const { return {}; }

  [[noreturn]] static void throw_flat() {
    throw Error(ErrorId::InternalError, {"a hull of points that do not span space", ""});
  }
};

// Found by CGAL through its argument's namespace.
template <class Iterator, class Output>
Output convex_hull_points_2(Iterator, Iterator, Output, const HullTraits::NoProjection&) {
  HullTraits::throw_flat();
}

}  // namespace exactcsg::io

namespace CGAL {

template <>
struct Kernel_traits<exactcsg::io::HullPoint> {
  using type = exactcsg::io::HullTraits;
  using Kernel = type;
};

}  // namespace CGAL
