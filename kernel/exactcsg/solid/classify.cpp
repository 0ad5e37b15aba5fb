// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/classify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/number/orientation.hpp"
#include "exactcsg/solid/local_form.hpp"
#include "exactcsg/solid/nearest_crossing.hpp"
#include "exactcsg/solid/neighbourhood.hpp"
#include "exactcsg/solid/prepared_polyhedron.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

// A plane through the point and which side of it leads where, as in a local form.
struct ConeNode {
  std::size_t plane = 0;  // index into the planes through the point
  LocalPlace positive = LocalPlace::decided(Membership::Out);
  LocalPlace negative = LocalPlace::decided(Membership::Out);
};

// A primitive near the point: In or Out all around, or the cone that it looks like there.
struct NearPrimitive {
  Membership membership = Membership::Unknown;
  LocalPlace root = LocalPlace::decided(Membership::Out);
  std::vector<ConeNode> nodes;
};

class SinglePoint {
 public:
  explicit SinglePoint(const Point3& point) : point_(point), near_(approximate(point)) {}

  PointClass classify(const Solid& solid) {
    const Membership around = csg::membership_of(
        solid, [&](const Primitive& primitive) { return near_point(primitive).membership; });
    if (around == Membership::In) return PointClass::In;
    if (around == Membership::Out) return PointClass::Out;
    return classify_neighbourhood(planes_, [&](std::span<const Sign> sides) {
      return csg::membership_of(
          solid, [&](const Primitive& primitive) { return walk(near_point(primitive), sides); });
    });
  }

 private:
  static Membership walk(const NearPrimitive& near, std::span<const Sign> sides) {
    if (near.membership != Membership::Unknown) return near.membership;
    LocalPlace place = near.root;
    while (!place.is_decided()) {
      const ConeNode& node = near.nodes[place.node()];
      place = sides[node.plane] == Sign::Positive ? node.positive : node.negative;
    }
    return place.membership();
  }

  // Each primitive is looked at once, however often it occurs.
  const NearPrimitive& near_point(const Primitive& primitive) {
    if (const auto* half_space = std::get_if<HalfSpace>(&primitive.shape)) {
      return remember(&primitive, [&] { return near_half_space(*half_space); });
    }
    if (const auto* polytope = std::get_if<ConvexPolytope>(&primitive.shape)) {
      return remember(polytope->polyhedron.get(),
                      [&] { return near_polytope(*polytope->polyhedron); });
    }
    const auto& mesh = std::get<PolyhedralMesh>(primitive.shape);
    return remember(mesh.polyhedron.get(), [&] { return near_mesh(primitive, *mesh.polyhedron); });
  }

  template <class Look>
  const NearPrimitive& remember(const void* key, Look look) {
    const auto [place, is_new] = known_.try_emplace(key);
    if (is_new) place->second = look();
    return place->second;
  }

  // The number of the plane among those through the point; `sense` is how it is turned there.
  std::size_t number_of(const Plane& plane, int& sense) {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      if (planes_[i] == plane) {
        sense = 1;
        return i;
      }
      if (planes_[i] == opposite(plane)) {
        sense = -1;
        return i;
      }
    }
    planes_.push_back(plane);
    sense = 1;
    return planes_.size() - 1;
  }

  ConeNode cone_node(const Plane& outward, LocalPlace outside, LocalPlace inside) {
    int sense = 1;
    const std::size_t number = number_of(outward, sense);
    return sense > 0 ? ConeNode{number, outside, inside} : ConeNode{number, inside, outside};
  }

  NearPrimitive cone(const std::vector<Plane>& outward_planes) {
    NearPrimitive near;
    if (outward_planes.empty()) {
      near.membership = Membership::In;
      return near;
    }
    near.root = LocalPlace::at_node(0);
    for (std::size_t i = 0; i < outward_planes.size(); ++i) {
      const LocalPlace inside = i + 1 == outward_planes.size()
                                    ? LocalPlace::decided(Membership::In)
                                    : LocalPlace::at_node(static_cast<std::uint32_t>(i + 1));
      near.nodes.push_back(
          cone_node(outward_planes[i], LocalPlace::decided(Membership::Out), inside));
    }
    return near;
  }

  NearPrimitive near_half_space(const HalfSpace& half_space) {
    switch (side(half_space.plane, point_)) {
      case Sign::Positive:
        return {Membership::Out, LocalPlace::decided(Membership::Out), {}};
      case Sign::Negative:
        return {Membership::In, LocalPlace::decided(Membership::In), {}};
      case Sign::Zero:
        break;
    }
    return cone({half_space.plane});
  }

  using Corners = std::span<const std::uint32_t>;

  static Plane plane_of(std::span<const Point3> vertices, Corners facet) {
    for (std::size_t k = 2; k < facet.size(); ++k) {
      const Point3& p = vertices[facet[0]];
      const Point3& q = vertices[facet[k - 1]];
      const Point3& r = vertices[facet[k]];
      if (cross(q - p, r - p) != Vector3{}) return plane_through(p, q, r);
    }
    throw Error(ErrorId::InternalError, {"a facet without area", ""});
  }

  Sign side_of_facet(std::span<const Point3> vertices, Corners facet) const {
    return side_of_polygon(
        facet.size(), [&](std::size_t i) -> const Point3& { return vertices[facet[i]]; }, point_);
  }

  // Doubles tell on which side of most facets the point lies.
  NearPrimitive near_polytope(const StoredPolyhedron& polyhedron) {
    std::vector<Plane> through;
    for (std::size_t f = 0; f < polyhedron.facets.size(); ++f) {
      const double near_side = filtered_side(polyhedron, f);
      if (near_side < 0) continue;
      if (near_side > 0) return {Membership::Out, LocalPlace::decided(Membership::Out), {}};
      const std::vector<Point3> corners = corners_of(polyhedron, f);
      std::vector<std::uint32_t> facet(corners.size());
      std::iota(facet.begin(), facet.end(), 0U);
      const Sign side = side_of_facet(corners, facet);
      if (side == Sign::Positive) {
        return {Membership::Out, LocalPlace::decided(Membership::Out), {}};
      }
      if (side == Sign::Zero) through.push_back(plane_of(corners, facet));
    }
    return cone(through);
  }

  // A number of the sign of the point's distance from the facet's plane, or zero. Facets of a
  // polytope have the planes of their numbers.
  double filtered_side(const StoredPolyhedron& polytope, std::size_t facet) const {
    if (!polytope.prepared) return 0;
    return Geometry::filtered_side(polytope.prepared->planes[facet].near, near_);
  }

  static std::vector<Point3> corners_of(const StoredPolyhedron& polyhedron, std::size_t facet) {
    std::vector<Point3> corners;
    for (const std::uint32_t v : polyhedron.facets[facet]) {
      corners.push_back(polyhedron.vertices[v]);
    }
    return corners;
  }

  bool holds_point(std::span<const Point3> vertices, Corners facet) const {
    if (side_of_facet(vertices, facet) != Sign::Zero) return false;
    const Plane plane = plane_of(vertices, facet);
    const Vector3 normal{plane.a, plane.b, plane.c};
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const Point3& from = vertices[facet[i]];
      const Point3& to = vertices[facet[(i + 1) % facet.size()]];
      if (sgn(dot(cross(to - from, point_ - from), normal)) < 0) return false;
    }
    return true;
  }

  // False only if the point is surely outside.
  bool may_be_in_bounding_box(const StoredPolyhedron& polyhedron) const {
    if (!polyhedron.prepared) return true;
    DoubleBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Vertices are rounded to the nearest double.
      const PreparedPolyhedron::Bounds& bounds = polyhedron.prepared->bounds[axis];
      box.lower[axis] = std::nextafter(bounds.lower, -std::numeric_limits<double>::infinity());
      box.upper[axis] = std::nextafter(bounds.upper, std::numeric_limits<double>::infinity());
    }
    return meet(box, box_of(point_));
  }

  NearPrimitive near_mesh(const Primitive& primitive, const StoredPolyhedron& polyhedron) {
    if (!may_be_in_bounding_box(polyhedron)) {
      return {Membership::Out, LocalPlace::decided(Membership::Out), {}};
    }
    const std::vector<Point3> vertices = to_vector(polyhedron.vertices);
    std::vector<std::size_t> holding;
    for (std::size_t f = 0; f < polyhedron.facets.size(); ++f) {
      if (holds_point(vertices, polyhedron.facets[f])) holding.push_back(f);
    }
    const auto corners = [&](std::size_t f) { return corners_of(polyhedron, f); };
    if (holding.empty()) {
      const auto bounds_of = [&](std::size_t f) {
        DoubleBox box = box_of(vertices[polyhedron.facets[f][0]]);
        for (const std::uint32_t v : polyhedron.facets[f]) {
          box = join(box, box_of(vertices[v]));
        }
        return box;
      };
      const Membership membership =
          nearest_crossing(point_, polyhedron.facets.size(), bounds_of, corners);
      return {membership, LocalPlace::decided(membership), {}};
    }
    return mesh_cone(primitive, holding);
  }

  // The facets that hold the point all have planes through it, so their partition does as well.
  NearPrimitive mesh_cone(const Primitive& primitive, const std::vector<std::size_t>& holding) {
    const Scene scene = make_scene(Solid::primitive(primitive));
    std::vector<FacetPolygon> polygons;
    for (const std::size_t f : holding) {
      const SceneFacet& facet = scene.facets[f];
      polygons.push_back({facet.plane, scene.corners_of(facet)});
    }
    std::vector<LocalNode> nodes;
    TierStatistics statistics;
    NearPrimitive near;
    near.root = append_mesh_form(scene.geometry, polygons, nodes, statistics);
    for (const LocalNode& node : nodes) {
      near.nodes.push_back(
          cone_node(scene.geometry.exact_plane_value(node.plane), node.positive, node.negative));
    }
    return near;
  }

  const Point3& point_;
  ApproximatePoint near_;
  std::vector<Plane> planes_;  // through the point, pairwise different
  std::unordered_map<const void*, NearPrimitive> known_;
};

}  // namespace

PointClass classify(const Solid& solid, const Point3& point) {
  return SinglePoint(point).classify(solid);
}

}  // namespace exactcsg
