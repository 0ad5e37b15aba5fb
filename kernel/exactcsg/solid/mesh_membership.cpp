// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/mesh_membership.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "exactcsg/solid/certified_vector.hpp"
#include "exactcsg/solid/nearest_crossing.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

// Segments tried in doubles before rationals are taken.
constexpr std::size_t attempts = 4;

// n p + d
CertifiedDouble value_at(const Geometry::ApproximatePlane& plane, const CertifiedVector& p) {
  return CertifiedDouble{plane.a, plane.normal_error} * p[0] +
         CertifiedDouble{plane.b, plane.normal_error} * p[1] +
         CertifiedDouble{plane.c, plane.normal_error} * p[2] +
         CertifiedDouble{plane.d, plane.offset_error};
}

double distance_squared(const Vertex& point, const DoubleBox& box) {
  const std::array<double, 3> p{point.x, point.y, point.z};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = std::max({box.lower[i] - p[i], p[i] - box.upper[i], 0.0});
    sum += d * d;
  }
  return sum;
}

// Segments whose ends are doubles, from one point.
class SegmentTrials {
 public:
  SegmentTrials(const Geometry& geometry, const Vertex& point, std::span<const FacetPolygon> facets,
                TierStatistics& statistics)
      : geometry_(geometry), point_(point), facets_(facets), statistics_(statistics) {
    boxes_.reserve(facets.size());
    distances_.reserve(facets.size());
    for (const FacetPolygon& facet : facets) {
      boxes_.push_back(box_of(facet.corners));
      distances_.push_back(distance_squared(point, boxes_.back()));
    }
  }

  // Towards the nearest facets. nullopt: doubles do not decide.
  std::optional<Membership> run() {
    for (std::size_t attempt = 0; attempt < std::min(attempts, facets_.size()); ++attempt) {
      const auto nearest = std::min_element(distances_.begin(), distances_.end());
      const auto target = static_cast<std::size_t>(nearest - distances_.begin());
      *nearest = std::numeric_limits<double>::infinity();
      if (const auto membership = before_first_crossing(end_beyond(facets_[target].corners))) {
        return membership;
      }
    }
    return std::nullopt;
  }

 private:
  struct Crossing {
    CertifiedDouble parameter;
    Membership before;
  };

  // A little beyond the middle of the corners.
  Vertex end_beyond(const CornerView& corners) const {
    std::array<double, 3> end{point_.x, point_.y, point_.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double sum = 0;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        sum += corners.coordinate(i, static_cast<Axis>(axis)).value;
      }
      const double middle = sum / static_cast<double>(corners.size());
      end[axis] += 1.125 * (middle - end[axis]);
    }
    return between_walls(geometry_, end);
  }

  std::optional<Membership> before_first_crossing(const Vertex& end) {
    const DoubleBox reach = join(box_of(point_), box_of(end));
    std::optional<Crossing> nearest;
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (!meet(boxes_[f], reach)) continue;
      const OrientedPlaneRef plane = facets_[f].plane;
      const Sign here = geometry_.side(point_, plane.plane, statistics_);
      const Sign there = geometry_.side(end, plane.plane, statistics_);
      if (here == Sign::Zero || there == Sign::Zero) return std::nullopt;
      if (here == there) continue;
      const std::optional<bool> passing = passes(end, facets_[f].corners);
      if (!passing) return std::nullopt;
      if (!*passing) continue;
      const Geometry::ApproximatePlane near = geometry_.approximate(plane.plane);
      const CertifiedDouble at_point = value_at(near, position_of(point_));
      const CertifiedDouble at_end = value_at(near, position_of(end));
      const Sign outside = here * sign_of(static_cast<int>(plane.sense));
      const Crossing crossing{at_point / (at_point - at_end),
                              outside == Sign::Positive ? Membership::Out : Membership::In};
      const Sign farther =
          nearest ? sign_of_certain(crossing.parameter - nearest->parameter) : Sign::Negative;
      if (farther == Sign::Zero) return std::nullopt;
      if (farther == Sign::Negative) nearest = crossing;
    }
    if (!nearest) return std::nullopt;
    return nearest->before;
  }

  // Whether the line through point and end passes the inside of the convex polygon, on the same
  // side of all its sides. nullopt: unknown.
  std::optional<bool> passes(const Vertex& end, const CornerView& corners) const {
    const CertifiedVector from = position_of(point_);
    const CertifiedVector along = difference(position_of(end), from);
    Sign common = Sign::Zero;
    bool is_certain = true;
    CertifiedVector a = difference(position_of(corners.vertex(corners.size() - 1)), from);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const CertifiedVector b = difference(position_of(corners.vertex(i)), from);
      const CertifiedDouble turn = dot(along, cross(a, b));
      a = b;
      const Sign sign = sign_of_certain(turn);
      if (sign == Sign::Zero) {
        is_certain = false;
      } else if (common == Sign::Zero) {
        common = sign;
      } else if (sign != common) {
        return false;
      }
    }
    return is_certain ? std::optional(true) : std::nullopt;
  }

  const Geometry& geometry_;
  const Vertex& point_;
  std::span<const FacetPolygon> facets_;
  TierStatistics& statistics_;
  std::vector<DoubleBox> boxes_;
  std::vector<double> distances_;
};

Membership exact_membership(const Geometry& geometry, const Vertex& point,
                            std::span<const FacetPolygon> facets) {
  const auto corners_of = [&](std::size_t f) {
    std::vector<Point3> corners;
    for (const Corner corner : facets[f].corners) {
      corners.push_back(geometry.exact_point(corner.vertex));
    }
    return corners;
  };
  return nearest_crossing(
      geometry.exact_point(point), facets.size(),
      [&](std::size_t f) { return box_of(facets[f].corners); }, corners_of);
}

}  // namespace

Membership mesh_membership(const Geometry& geometry, const Vertex& point,
                           std::span<const FacetPolygon> facets, TierStatistics& statistics) {
  if (const auto membership = SegmentTrials(geometry, point, facets, statistics).run()) {
    return *membership;
  }
  return exact_membership(geometry, point, facets);
}

}  // namespace exactcsg
