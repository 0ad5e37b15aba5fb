// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/local_form.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "exactcsg/solid/polygon.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

LocalNode node_of(OrientedPlaneRef plane, LocalPlace outside, LocalPlace inside) {
  return plane.sense > 0 ? LocalNode{plane.plane, outside, inside}
                         : LocalNode{plane.plane, inside, outside};
}

// One region of the autopartition still to be divided.
struct OwnedPolygon {
  OrientedPlaneRef plane;
  std::vector<Corner> corners;
};

class Autopartition {
 public:
  Autopartition(const Geometry& geometry, std::vector<LocalNode>& nodes, TierStatistics& statistics)
      : geometry_(geometry), nodes_(nodes), statistics_(statistics) {}

  LocalPlace partition(std::vector<OwnedPolygon> polygons) {
    // Depth first with an explicit stack: a star-shaped fan makes a chain as long as its facets.
    struct Pending {
      std::vector<OwnedPolygon> polygons;
      std::uint32_t parent;
      bool positive;
    };
    constexpr std::uint32_t no_parent = std::numeric_limits<std::uint32_t>::max();
    std::vector<Pending> pending;
    pending.push_back({std::move(polygons), no_parent, false});
    LocalPlace root = LocalPlace::decided(Membership::Out);
    while (!pending.empty()) {
      Pending region = std::move(pending.back());
      pending.pop_back();
      const auto index = static_cast<std::uint32_t>(nodes_.size());
      if (region.parent == no_parent) {
        root = LocalPlace::at_node(index);
      } else {
        (region.positive ? nodes_[region.parent].positive : nodes_[region.parent].negative) =
            LocalPlace::at_node(index);
      }
      const OrientedPlaneRef divider = region.polygons[choose_divider(region.polygons)].plane;
      nodes_.push_back(node_of(divider, LocalPlace::decided(Membership::Out),
                               LocalPlace::decided(Membership::In)));
      std::vector<OwnedPolygon> positive;
      std::vector<OwnedPolygon> negative;
      for (OwnedPolygon& polygon : region.polygons) {
        distribute(std::move(polygon), divider.plane, positive, negative);
      }
      if (!positive.empty()) pending.push_back({std::move(positive), index, true});
      if (!negative.empty()) pending.push_back({std::move(negative), index, false});
    }
    return root;
  }

 private:
  // The plane that cuts fewest of the others, among a few.
  std::size_t choose_divider(const std::vector<OwnedPolygon>& polygons) {
    if (polygons.size() <= 2) return 0;
    std::size_t best = 0;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    const std::size_t step = std::max<std::size_t>(1, polygons.size() / 6);
    for (std::size_t i = 0; i < polygons.size(); i += step) {
      std::size_t cuts = 0;
      for (std::size_t j = 0; j < polygons.size(); j += std::max<std::size_t>(1, step / 2)) {
        if (polygons[j].plane.plane == polygons[i].plane.plane) continue;
        cuts += split_signs(geometry_, polygons[j].corners, polygons[i].plane.plane, signs_,
                            statistics_) == PlaneSplit::Both;
      }
      if (cuts < fewest) {
        fewest = cuts;
        best = i;
        if (cuts == 0) break;
      }
    }
    return best;
  }

  void distribute(OwnedPolygon polygon, PlaneRef divider, std::vector<OwnedPolygon>& positive,
                  std::vector<OwnedPolygon>& negative) {
    if (polygon.plane.plane == divider) return;
    switch (split_signs(geometry_, polygon.corners, divider, signs_, statistics_)) {
      case PlaneSplit::AllPositive:
        positive.push_back(std::move(polygon));
        return;
      case PlaneSplit::AllNegative:
        negative.push_back(std::move(polygon));
        return;
      case PlaneSplit::InPlane:
        throw Error(ErrorId::InternalError, {"a facet in a plane that is not its own", ""});
      case PlaneSplit::Both:
        break;
    }
    OwnedPolygon part{polygon.plane, {}};
    append_part(geometry_, polygon.corners, polygon.plane.plane, divider, signs_, Sign::Positive,
                part.corners);
    positive.push_back(std::move(part));
    part = {polygon.plane, {}};
    append_part(geometry_, polygon.corners, polygon.plane.plane, divider, signs_, Sign::Negative,
                part.corners);
    negative.push_back(std::move(part));
  }

  const Geometry& geometry_;
  std::vector<LocalNode>& nodes_;
  TierStatistics& statistics_;
  std::vector<Sign> signs_;
};

struct Crossing {
  Rational parameter;
  Membership membership;
};

Rational evaluate(const Plane& plane, const Point3& point) {
  return plane.a * point.x + plane.b * point.y + plane.c * point.z + plane.d;
}

Rational slope(const Plane& plane, const Vector3& direction) {
  return plane.a * direction.x + plane.b * direction.y + plane.c * direction.z;
}

enum class Inside : unsigned char { No, Yes, OnSide };

// Whether a point of the polygon's plane is inside it: strictly on the side of every side plane that
// the corners are on.
Inside point_in_polygon(const Geometry& geometry, const Point3& point,
                        std::span<const Corner> corners) {
  TierStatistics statistics;
  bool on_side = false;
  for (const Corner& corner : corners) {
    const Sign here = side(geometry.exact_plane_value(corner.side_plane), point);
    if (here == Sign::Zero) {
      on_side = true;
      continue;
    }
    for (const Corner& other : corners) {
      const Sign inner = geometry.side(other.vertex, corner.side_plane, statistics);
      if (inner == Sign::Zero) continue;
      if (inner != here) return Inside::No;
      break;
    }
  }
  return on_side ? Inside::OnSide : Inside::Yes;
}

struct Bounds {
  std::array<double, 3> lower;
  std::array<double, 3> upper;
};

Bounds bounds_of(std::span<const Corner> corners) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds bounds{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (const Corner& corner : corners) {
    const std::array<double, 3> position{corner.vertex.x, corner.vertex.y, corner.vertex.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bounds.lower[axis] = std::min(bounds.lower[axis], position[axis] - corner.vertex.error);
      bounds.upper[axis] = std::max(bounds.upper[axis], position[axis] + corner.vertex.error);
    }
  }
  return bounds;
}

// A point near the polygon's middle; each attempt gives another.
std::array<double, 3> aim(std::span<const Corner> corners, std::size_t attempt) {
  std::array<double, 3> target{};
  double total = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double weight = 1.0 + 0.37 * static_cast<double>((i * 7 + attempt * 5) % 11);
    target[0] += weight * corners[i].vertex.x;
    target[1] += weight * corners[i].vertex.y;
    target[2] += weight * corners[i].vertex.z;
    total += weight;
  }
  for (double& coordinate : target) coordinate /= total;
  return target;
}

// nullopt: the line meets a side or a corner, or misses everything.
std::optional<Membership> nearest_crossing(const Geometry& geometry, const Point3& point,
                                           std::span<const FacetPolygon> facets,
                                           std::span<const Bounds> bounds,
                                           const std::array<double, 3>& target) {
  const Point3 aimed{rational_of(target[0]), rational_of(target[1]), rational_of(target[2])};
  // Beyond the target nothing matters as long as the target is behind the first crossing; going a
  // little further makes sure of that although the target is rounded.
  const Vector3 direction = Rational(9, 8) * (aimed - point);
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
  const Point3 end = point + direction;
  const std::array from{point.x.get_d(), point.y.get_d(), point.z.get_d()};
  const std::array to{end.x.get_d(), end.y.get_d(), end.z.get_d()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double slack = 1e-12 * (std::abs(from[axis]) + std::abs(to[axis])) + 1e-290;
    lower[axis] = std::min(from[axis], to[axis]) - slack;
    upper[axis] = std::max(from[axis], to[axis]) + slack;
  }
  std::optional<Crossing> nearest;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    bool apart = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      apart |= bounds[f].lower[axis] > upper[axis] || bounds[f].upper[axis] < lower[axis];
    }
    if (apart) continue;
    const Plane plane = geometry.exact_plane_value(facets[f].plane.plane);
    const Rational height = evaluate(plane, point);
    const Rational rate = slope(plane, direction);
    if (sgn(rate) == 0) {
      if (sgn(height) == 0) return std::nullopt;
      continue;
    }
    Rational parameter = -height / rate;
    if (sgn(parameter) <= 0 || parameter > 1) continue;
    if (nearest && nearest->parameter < parameter) continue;
    switch (point_in_polygon(geometry, point + parameter * direction, facets[f].corners)) {
      case Inside::OnSide:
        return std::nullopt;
      case Inside::No:
        continue;
      case Inside::Yes:
        break;
    }
    const bool outside = sgn(height) * facets[f].plane.sense > 0;
    nearest = Crossing{std::move(parameter), outside ? Membership::Out : Membership::In};
  }
  if (!nearest) return std::nullopt;
  return nearest->membership;
}

}  // namespace

LocalPlace append_convex_form(std::span<const FacetPolygon> facets, std::vector<LocalNode>& nodes) {
  const auto first = static_cast<std::uint32_t>(nodes.size());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const LocalPlace inside = i + 1 == facets.size()
                                  ? LocalPlace::decided(Membership::In)
                                  : LocalPlace::at_node(static_cast<std::uint32_t>(first + i + 1));
    nodes.push_back(node_of(facets[i].plane, LocalPlace::decided(Membership::Out), inside));
  }
  return LocalPlace::at_node(first);
}

LocalPlace append_mesh_form(const Geometry& geometry, std::span<const FacetPolygon> facets,
                            std::vector<LocalNode>& nodes, TierStatistics& statistics) {
  std::vector<OwnedPolygon> polygons;
  polygons.reserve(facets.size());
  for (const FacetPolygon& facet : facets) {
    polygons.push_back({facet.plane, {facet.corners.begin(), facet.corners.end()}});
  }
  return Autopartition(geometry, nodes, statistics).partition(std::move(polygons));
}

Membership mesh_membership(const Geometry& geometry, const Point3& point,
                           std::span<const FacetPolygon> facets) {
  std::vector<Bounds> bounds;
  bounds.reserve(facets.size());
  for (const FacetPolygon& facet : facets) bounds.push_back(bounds_of(facet.corners));
  constexpr std::size_t rounds = 8;
  for (std::size_t attempt = 0; attempt < rounds; ++attempt) {
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const auto target = aim(facets[f].corners, attempt);
      if (const auto found = nearest_crossing(geometry, point, facets, bounds, target)) {
        return *found;
      }
    }
  }
  throw Error(ErrorId::InternalError, {"no segment that crosses the mesh in general position", ""});
}

}  // namespace exactcsg
