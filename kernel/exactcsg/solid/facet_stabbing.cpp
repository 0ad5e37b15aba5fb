// SPDX-License-Identifier: Apache-2.0
// A ray starts at a point inside the part and runs along the axis that the facet's normal leans to
// most, to the front. It is met by facets whose projection along the axis holds the point's; which
// side of their planes the point is on tells whether they are ahead of it. Upright facets are met
// in their outline only, which is seen at their neighbours. A ray that meets an outline is given up
// for another.
//
// The starting point lies on the facet's plane and has doubles for its other two coordinates, so
// that the filters decide nearly every sign. If no such point lies in a part (a sliver), an exact
// mean of its corners is taken.

#include "exactcsg/solid/facet_stabbing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exactcsg/solid/nearest_crossing.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

constexpr unsigned attempts = 64;

std::vector<DoubleBox> boxes_of(const Scene& scene) {
  std::vector<DoubleBox> boxes;
  boxes.reserve(scene.facets.size());
  for (const SceneFacet& facet : scene.facets) {
    boxes.push_back(box_of(scene.corners_of(facet)));
  }
  return boxes;
}

constexpr Axis next_axis(Axis axis) {
  return axis == Axis::X ? Axis::Y : axis == Axis::Y ? Axis::Z : Axis::X;
}

double component(const Geometry::ApproximatePlane& plane, Axis axis) {
  return axis == Axis::X ? plane.a : axis == Axis::Y ? plane.b : plane.c;
}

Sign component_sign(const Geometry& geometry, PlaneRef plane, Axis axis) {
  const Geometry::ApproximatePlane near = geometry.approximate(plane);
  const double value = component(near, axis);
  if (std::abs(value) > near.normal_error) {
    return value > 0 ? Sign::Positive : Sign::Negative;
  }
  const Plane exact = geometry.exact_plane_value(plane);
  return sign_of(axis == Axis::X ? exact.a : axis == Axis::Y ? exact.b : exact.c);
}

Axis steepest_axis(const Geometry& geometry, PlaneRef plane) {
  const Geometry::ApproximatePlane near = geometry.approximate(plane);
  const double a = std::abs(near.a);
  const double b = std::abs(near.b);
  const double c = std::abs(near.c);
  if (a >= b && a >= c) return Axis::X;
  return b >= c ? Axis::Y : Axis::Z;
}

// Other weights at each attempt, without a pattern that a regular mesh could follow.
unsigned weight(std::size_t corner, unsigned attempt) {
  const auto i = static_cast<unsigned>(corner % 97);
  return 89 + (i * (37 + 11 * attempt) + attempt * attempt * 13) % 61;
}

enum class Shadow : unsigned char { Off, On, Edge };

}  // namespace

// Where a ray starts: a meeting point of the facet's plane and two walls, or an exact point.
class FacetStabbing::Origin {
 public:
  // nullopt: the point that was tried does not lie inside the part.
  static std::optional<Origin> in(const Geometry& geometry, PlaneRef plane, Axis axis,
                                  const CornerView& part, unsigned attempt,
                                  TierStatistics& statistics) {
    Origin origin(axis);
    std::array<double, 2> target{};
    double total = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const double w = weight(i, attempt);
      target[0] += w * part.vertex(i).coordinate(origin.across_[0]);
      target[1] += w * part.vertex(i).coordinate(origin.across_[1]);
      total += w;
    }
    std::array<PlaneRef, 2> walls;
    for (std::size_t k = 0; k < 2; ++k) {
      origin.position_[k] = round_wall_position(target[k] / total);
      walls[k] = PlaneRef::of_wall(origin.across_[k], origin.position_[k]);
    }
    origin.vertex_ = geometry.meet(plane, walls[0], walls[1]);
    if (!is_inside(geometry, part, origin.vertex_, statistics)) return std::nullopt;
    return origin;
  }

  static Origin exactly_in(const Geometry& geometry, Axis axis, const CornerView& part,
                           unsigned attempt) {
    Origin origin(axis);
    Vector3 sum{0, 0, 0};
    unsigned total = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Point3 corner = geometry.exact_point(part.vertex(i));
      const unsigned w = weight(i, attempt);
      sum = {sum.x + w * corner.x, sum.y + w * corner.y, sum.z + w * corner.z};
      total += w;
    }
    origin.exact_ = Point3{sum.x / total, sum.y / total, sum.z / total};
    Vertex& near = origin.vertex_;
    near.x = nearest_double(origin.exact_->x);
    near.y = nearest_double(origin.exact_->y);
    near.z = nearest_double(origin.exact_->z);
    near.error = 0x1p-52 * std::max({std::abs(near.x), std::abs(near.y), std::abs(near.z)}) +
                 std::numeric_limits<double>::min();
    return origin;
  }

  Axis axis() const { return axis_; }
  const Vertex& near() const { return vertex_; }

  Sign side(const Geometry& geometry, PlaneRef plane, TierStatistics& statistics) const {
    if (!exact_) return geometry.side(vertex_, plane, statistics);
    return exactcsg::side(geometry.exact_plane_value(plane), *exact_);
  }

  // The turn from the side p -> q to this point, seen against the axis.
  Sign turn(const Geometry& geometry, const Vertex& p, const Vertex& q) const {
    if (!exact_) {
      const double px = p.coordinate(across_[0]);
      const double py = p.coordinate(across_[1]);
      const double a = q.coordinate(across_[0]) - px;
      const double b = position_[1] - py;
      const double c = q.coordinate(across_[1]) - py;
      const double d = position_[0] - px;
      const double value = a * b - c * d;
      // Every difference is off by the errors e of two vertices and its own rounding u |difference|
      // (u = 2^-53); a product x y then by (e + u |x|) |y| + |x| (e + u |y|) + (e + u |x|)(e +
      // u |y|) and u |x y|, the last subtraction by u |value|. 8 u for 4.01 u pays for the
      // roundings of the bound.
      const double e = 1.0001 * (p.error + q.error);
      const double size = std::abs(a) + std::abs(b) + std::abs(c) + std::abs(d);
      const double bound =
          1.0001 * e * (size + 2 * e) + 0x1p-50 * (std::abs(a * b) + std::abs(c * d)) + 0x1p-1000;
      if (std::abs(value) > bound) return value > 0 ? Sign::Positive : Sign::Negative;
    }
    const Point3 from = geometry.exact_point(p);
    const Point3 to = geometry.exact_point(q);
    const Rational u = exact_ ? coordinate(*exact_, across_[0]) : rational_of(position_[0]);
    const Rational v = exact_ ? coordinate(*exact_, across_[1]) : rational_of(position_[1]);
    const Rational& x = coordinate(from, across_[0]);
    const Rational& y = coordinate(from, across_[1]);
    return sign_of(Rational((coordinate(to, across_[0]) - x) * (v - y) -
                            (coordinate(to, across_[1]) - y) * (u - x)));
  }

 private:
  explicit Origin(Axis axis) : axis_(axis), across_{next_axis(axis), next_axis(next_axis(axis))} {}

  // On the same side of the plane of every side of the part as the part's own corners.
  static bool is_inside(const Geometry& geometry, const CornerView& part, const Vertex& vertex,
                        TierStatistics& statistics) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Sign here = geometry.side(vertex, part.side_plane(i), statistics);
      if (here == Sign::Zero) return false;
      for (std::size_t step = 2; step < part.size(); ++step) {
        const Vertex other = part.vertex((i + step) % part.size());
        const Sign inside = geometry.side(other, part.side_plane(i), statistics);
        if (inside == Sign::Zero) continue;
        if (inside != here) return false;
        break;
      }
    }
    return true;
  }

  Axis axis_;
  std::array<Axis, 2> across_;
  std::array<double, 2> position_{};
  Vertex vertex_;
  std::optional<Point3> exact_;
};

FacetStabbing::FacetStabbing(const Scene& scene)
    : scene_(scene), boxes_(boxes_of(scene)), hierarchy_(boxes_) {}

WindingSides FacetStabbing::winding_sides(FacetIndex facet, const CornerView& part,
                                          TierStatistics& statistics) const {
  const Geometry& geometry = scene_.geometry;
  const PlaneRef plane = scene_.facets[facet].plane.plane;
  const Axis axis = steepest_axis(geometry, plane);
  for (unsigned attempt = 0; attempt < attempts; ++attempt) {
    std::optional<Origin> origin = Origin::in(geometry, plane, axis, part, attempt, statistics);
    if (!origin && attempt % 4 != 3) continue;
    if (!origin) origin = Origin::exactly_in(geometry, axis, part, attempt);
    if (const auto sides = shoot(facet, *origin, statistics)) return *sides;
  }
  throw Error(ErrorId::InternalError,
              {"no ray in general position from a part of facet " + std::to_string(facet),
               "one in 64 attempts"});
}

std::optional<WindingSides> FacetStabbing::shoot(FacetIndex facet, const Origin& origin,
                                                 TierStatistics& statistics) const {
  const Geometry& geometry = scene_.geometry;
  const PlaneRef own = scene_.facets[facet].plane.plane;
  const Axis axis = origin.axis();
  const Sign direction = component_sign(geometry, own, axis);
  DoubleBox ray = box_of(origin.near());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (direction == Sign::Positive) {
    ray.upper[static_cast<std::size_t>(axis)] = infinity;
  } else {
    ray.lower[static_cast<std::size_t>(axis)] = -infinity;
  }
  const auto shadow = [&](const SceneFacet& other, Sign up) {
    const CornerView corners = scene_.corners_of(other);
    Shadow where = Shadow::On;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vertex next = corners.vertex(k + 1 == corners.size() ? 0 : k + 1);
      const Sign turn = origin.turn(geometry, corners.vertex(k), next) * up;
      if (turn == Sign::Negative) return Shadow::Off;
      if (turn == Sign::Zero) where = Shadow::Edge;
    }
    return where;
  };
  std::int64_t front = 0;
  std::int64_t covering = 0;
  FacetIndex lowest = facet;
  bool degenerate = false;
  hierarchy_.for_each_meeting(ray, [&](FacetIndex g) {
    if (degenerate) return;
    const SceneFacet& other = scene_.facets[g];
    const Sign rises = component_sign(geometry, other.plane.plane, axis);
    if (rises == Sign::Zero) return;
    const Sign up = rises * sign_of(static_cast<int>(other.plane.sense));
    const Shadow where = g == facet ? Shadow::On : shadow(other, up);
    if (where == Shadow::Off) return;
    if (other.plane.plane == own) {
      degenerate = where == Shadow::Edge;
      covering += other.plane.sense;
      lowest = std::min(lowest, g);
      return;
    }
    // Positive: the origin is above the facet along the axis.
    const Sign above = origin.side(geometry, other.plane.plane, statistics) * rises;
    if (above == direction) return;
    if (where == Shadow::Edge || above == Sign::Zero) {
      degenerate = true;
      return;
    }
    front += static_cast<int>(up * direction);
  });
  if (degenerate) return std::nullopt;
  return WindingSides{front, front + covering, lowest};
}

}  // namespace exactcsg
