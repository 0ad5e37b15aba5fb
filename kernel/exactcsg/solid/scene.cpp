// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>

#include "exactcsg/number/homogeneous.hpp"
#include "exactcsg/number/prepared_plane.hpp"
#include "exactcsg/solid/in_parallel.hpp"
#include "exactcsg/solid/polygon.hpp"
#include "exactcsg/solid/polyhedron_signs.hpp"
#include "exactcsg/support/give_up.hpp"

namespace exactcsg {

namespace {

constexpr double largest_coordinate = 1e290;

// Of a few well-spread triples of corners the one that spans most: it conditions the plane best.
// `near` are the vertices, rounded.
std::array<std::uint32_t, 3> spanning_triple(const Polyhedron& polyhedron,
                                             const std::vector<HashedPoint>& near,
                                             const Facet& facet) {
  const auto count = static_cast<std::uint32_t>(facet.size());
  if (count == 3) return {facet[0], facet[1], facet[2]};
  const auto span_of = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const ApproximatePoint& p = near[facet[i]].near;
    const ApproximatePoint& q = near[facet[j]].near;
    const ApproximatePoint& r = near[facet[k]].near;
    const double ux = q.x - p.x, uy = q.y - p.y, uz = q.z - p.z;
    const double vx = r.x - p.x, vy = r.y - p.y, vz = r.z - p.z;
    return std::abs(uy * vz - uz * vy) + std::abs(uz * vx - ux * vz) + std::abs(ux * vy - uy * vx);
  };
  std::array<std::uint32_t, 3> best{0, 1, 2};
  double widest = -1;
  const std::uint32_t tried = std::min<std::uint32_t>(count, 4);
  for (std::uint32_t i = 0; i < tried; ++i) {
    std::array<std::uint32_t, 3> triple{i, (i + count / 3) % count, (i + 2 * count / 3) % count};
    std::sort(triple.begin(), triple.end());
    const double span = span_of(triple[0], triple[1], triple[2]);
    if (span > widest) {
      widest = span;
      best = triple;
    }
  }
  // Corners in the middle of straight sides may make every tried triple collinear.
  const auto corner = [&](std::uint32_t i) -> const Point3& {
    return polyhedron.vertices[facet[i]];
  };
  for (std::uint32_t k = 2; !(widest > 0) && k < count; ++k) {
    if (cross(corner(1) - corner(0), corner(k) - corner(0)) != Vector3{}) {
      best = {0, 1, k};
      break;
    }
  }
  return {facet[best[0]], facet[best[1]], facet[best[2]]};
}

using Triple = std::array<std::uint32_t, 3>;

// A plane through the side from one vertex to another, not the facet's own: it contains the axis
// that the facet's normal leans to most.
struct PlaneAcross {
  std::uint32_t from;
  std::uint32_t to;
  Axis axis;
};

// What copies of one shape have in common: they have the same facets, and those that are not convex
// are images of each other under a translation. Planes are numbered within the shape, those of
// facets first.
struct Kind {
  std::shared_ptr<const Polyhedron> first;
  bool convex = true;
  std::vector<std::uint32_t> first_corners;  // of each facet, and the end
  std::vector<std::uint32_t> corners;        // vertices, those of all facets in turn
  std::vector<std::uint32_t> facet_planes;   // of each facet; empty: facet f has plane f
  // Of the side from each corner to the next: a plane that meets the facet's plane in it.
  std::vector<std::uint32_t> side_planes;
  std::vector<Triple> triples;             // of facets' planes: corners that span the plane
  std::vector<PlaneAcross> planes_across;  // sides between coplanar facets
  std::vector<ApproximatePoint> near;      // the first's vertices, unless it is convex

  std::uint32_t facet_count() const { return static_cast<std::uint32_t>(first_corners.size() - 1); }
  std::uint32_t plane_count() const {
    return static_cast<std::uint32_t>(triples.size() + planes_across.size());
  }
  std::uint32_t plane_of(std::uint32_t facet) const {
    return facet_planes.empty() ? facet : facet_planes[facet];
  }
  std::span<const std::uint32_t> corners_of(std::uint32_t facet) const {
    return std::span(corners).subspan(first_corners[facet],
                                      first_corners[facet + 1] - first_corners[facet]);
  }
  // Where the side ends that begins at this corner of this facet.
  std::uint32_t end_of_side(std::uint32_t facet, std::uint32_t side) const {
    return corners[side + 1 == first_corners[facet + 1] ? first_corners[facet] : side + 1];
  }
};

// What can be said of a polyhedron by itself.
struct PreparedPolyhedron {
  std::vector<HashedPoint> points;
  std::array<Range, 3> bounds;  // of the points
  std::vector<PreparedPlane> planes;
  std::vector<Triple> triples;  // empty: those of the kind

  NearPoint near_point(const Polyhedron& polyhedron, std::uint32_t v) const {
    return {polyhedron.vertices[v], points[v].near};
  }
};

void list_corners(Kind& kind) {
  const std::vector<Facet>& facets = kind.first->facets;
  kind.first_corners.reserve(facets.size() + 1);
  kind.first_corners.push_back(0);
  std::size_t count = 0;
  for (const Facet& facet : facets) {
    count += facet.size();
    kind.first_corners.push_back(static_cast<std::uint32_t>(count));
  }
  kind.corners.reserve(count);
  for (const Facet& facet : facets) {
    kind.corners.insert(kind.corners.end(), facet.begin(), facet.end());
  }
}

// Of every side the first one that walks the same edge the other way. A side has the number of the
// corner where it begins.
// THROWS Error(InternalError) if there is none.
// COST: O(n) if few sides leave a vertex, else O(n log n)
std::vector<std::uint32_t> opposite_sides(const Kind& kind, unsigned threads) {
  struct Leaving {
    std::uint32_t to;
    std::uint32_t side;
  };
  const auto comes_before = [](const Leaving& a, const Leaving& b) {
    return a.to != b.to ? a.to < b.to : a.side < b.side;
  };
  const auto count = static_cast<std::uint32_t>(kind.corners.size());
  const std::size_t vertex_count = kind.first->vertices.size();
  // Of the sides that leave a vertex. Counted two places further on, so that each place is where
  // the row before ends once all are filled.
  std::vector<std::uint32_t> begin(vertex_count + 2, 0);
  for (const std::uint32_t from : kind.corners) ++begin[from + 2];
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<Leaving> leaving(count);
  std::vector<std::uint32_t> ends(count);
  for (std::uint32_t f = 0; f < kind.facet_count(); ++f) {
    for (std::uint32_t side = kind.first_corners[f]; side < kind.first_corners[f + 1]; ++side) {
      ends[side] = kind.end_of_side(f, side);
      leaving[begin[kind.corners[side] + 1]++] = {ends[side], side};
    }
  }
  const auto sides_from = [&](std::size_t v) {
    return std::span(leaving).subspan(begin[v], begin[v + 1] - begin[v]);
  };
  // Short rows are searched from their beginning, long ones are sorted first.
  constexpr std::size_t short_row = 32;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto row = sides_from(v);
    if (row.size() > short_row) std::sort(row.begin(), row.end(), comes_before);
  }
  std::vector<std::uint32_t> result(count);
  in_parallel_parts(threads, count, [&](std::size_t side) {
    const std::uint32_t back_to = kind.corners[side];
    const auto row = sides_from(ends[side]);
    const auto found =
        row.size() > short_row
            ? std::lower_bound(row.begin(), row.end(), Leaving{back_to, 0}, comes_before)
            : std::find_if(row.begin(), row.end(),
                           [back_to](const Leaving& other) { return other.to == back_to; });
    if (found == row.end() || found->to != back_to) {
      throw Error(ErrorId::InternalError, {"a primitive that is not closed", "a closed one"});
    }
    result[side] = found->side;
  });
  return result;
}

std::vector<std::uint32_t> facets_of_sides(const Kind& kind) {
  std::vector<std::uint32_t> result;
  result.reserve(kind.corners.size());
  for (std::uint32_t f = 0; f < kind.facet_count(); ++f) {
    result.resize(kind.first_corners[f + 1], f);
  }
  return result;
}

PreparedPlane plane_through_corners(const Polyhedron& polyhedron, const PreparedPolyhedron& known,
                                    const Triple& triple) {
  return prepared_plane(known.near_point(polyhedron, triple[0]),
                        known.near_point(polyhedron, triple[1]),
                        known.near_point(polyhedron, triple[2]));
}

Axis steepest_axis(const Geometry::ApproximatePlane& plane) {
  const double a = std::abs(plane.a);
  const double b = std::abs(plane.b);
  const double c = std::abs(plane.c);
  return a >= b && a >= c ? Axis::X : b >= c ? Axis::Y : Axis::Z;
}

// Finds the planes of a mesh's facets and sides: neighbours in one plane share it, and the side
// between them is given another plane.
class MeshPlanes {
 public:
  // known: of the kind's first polyhedron. REQUIRES its points; its planes are filled in.
  MeshPlanes(Kind& kind, PreparedPolyhedron& known, unsigned threads)
      : kind_(kind),
        known_(known),
        threads_(threads),
        polyhedron_(*kind.first),
        opposite_(opposite_sides(kind, threads)),
        facets_(facets_of_sides(kind)) {}

  void find() {
    planes_.resize(kind_.triples.size());
    in_parallel_parts(threads_, planes_.size(), [&](std::size_t f) {
      planes_[f] = plane_through_corners(polyhedron_, known_, kind_.triples[f]);
    });
    find_flat_sides();
    keep_planes();
    set_side_planes();
  }

 private:
  std::uint32_t neighbour(std::uint32_t side) const { return facets_[opposite_[side]]; }
  // More than two facets may share an edge: then it need not be.
  bool was_seen_from_there(std::uint32_t side) const {
    return opposite_[side] < side && opposite_[opposite_[side]] == side;
  }

  void find_flat_sides() {
    is_flat_.resize(kind_.corners.size());
    // First those of which doubles do not tell that they are not.
    in_parallel_parts(threads_, is_flat_.size(), [&](std::size_t side) {
      const auto i = static_cast<std::uint32_t>(side);
      is_flat_[side] = was_seen_from_there(i) ? 0 : may_be_flat(i);
    });
    if (std::ranges::find(is_flat_, 1) == is_flat_.end()) return;
    const PolyhedronSigns signs(polyhedron_.vertices);
    in_parallel_parts(threads_, is_flat_.size(), [&](std::size_t side) {
      if (is_flat_[side] != 0) is_flat_[side] = is_flat(static_cast<std::uint32_t>(side), signs);
    });
    for (std::uint32_t side = 0; side < is_flat_.size(); ++side) {
      if (was_seen_from_there(side)) is_flat_[side] = is_flat_[opposite_[side]];
    }
  }

  // all(corner) of every corner of the neighbour that is not the facet's.
  template <class Predicate>
  bool all_beyond(std::uint32_t side, const Predicate& all) const {
    const auto own = kind_.corners_of(facets_[side]);
    const auto corners = kind_.corners_of(neighbour(side));
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
      return std::find(own.begin(), own.end(), corner) != own.end() || all(corner);
    });
  }

  bool may_be_flat(std::uint32_t side) const {
    const Geometry::ApproximatePlane& plane = planes_[facets_[side]].near;
    return all_beyond(side, [&](std::uint32_t corner) {
      return Geometry::filtered_side(plane, known_.points[corner].near) == 0;
    });
  }

  bool is_flat(std::uint32_t side, const PolyhedronSigns& signs) const {
    const auto& [a, b, c] = kind_.triples[facets_[side]];
    return all_beyond(side, [&, a = a, b = b, c = c](std::uint32_t corner) {
      return signs.orientation(a, b, c, corner) == Sign::Zero;
    });
  }

  // Of coplanar facets, which are folded if they do not look the same way.
  bool look_the_same_way(std::uint32_t facet, std::uint32_t other) const {
    const Geometry::ApproximatePlane& p = planes_[facet].near;
    const Geometry::ApproximatePlane& q = planes_[other].near;
    return p.a * q.a + p.b * q.b + p.c * q.c > 0;
  }

  // The neighbour before in whose plane the facet is, or the facet.
  std::uint32_t facet_with_plane_of(std::uint32_t facet) const {
    for (std::uint32_t side = kind_.first_corners[facet]; side < kind_.first_corners[facet + 1];
         ++side) {
      const std::uint32_t other = neighbour(side);
      if (is_flat_[side] != 0 && other < facet && look_the_same_way(facet, other)) return other;
    }
    return facet;
  }

  // Coplanar facets that no neighbours connect keep planes of their own; the Geometry finds them.
  void keep_planes() {
    kind_.facet_planes.resize(kind_.facet_count());
    known_.planes.reserve(kind_.facet_count());
    std::uint32_t kept = 0;
    for (std::uint32_t f = 0; f < kind_.facet_count(); ++f) {
      if (const std::uint32_t other = facet_with_plane_of(f); other != f) {
        kind_.facet_planes[f] = kind_.facet_planes[other];
        continue;
      }
      known_.planes.push_back(std::move(planes_[f]));
      kind_.triples[kept] = kind_.triples[f];
      kind_.facet_planes[f] = kept++;
    }
    kind_.triples.resize(kept);
  }

  void set_side_planes() {
    kind_.side_planes.resize(kind_.corners.size());
    in_parallel_parts(threads_, kind_.side_planes.size(), [&](std::size_t i) {
      const auto side = static_cast<std::uint32_t>(i);
      if (is_flat_[side] == 0) kind_.side_planes[side] = kind_.facet_planes[neighbour(side)];
    });
    for (std::uint32_t side = 0; side < kind_.side_planes.size(); ++side) {
      if (is_flat_[side] != 0) kind_.side_planes[side] = plane_across(side);
    }
  }

  std::uint32_t plane_across(std::uint32_t side) {
    if (was_seen_from_there(side)) return kind_.side_planes[opposite_[side]];
    const std::uint32_t facet = facets_[side];
    const std::uint32_t from = kind_.corners[side];
    const std::uint32_t to = kind_.end_of_side(facet, side);
    const Axis axis = steepest_axis(planes_[facet].near);
    known_.planes.push_back(prepared_plane(known_.near_point(polyhedron_, from),
                                           known_.near_point(polyhedron_, to), axis));
    kind_.planes_across.push_back({from, to, axis});
    return kind_.plane_count() - 1;
  }

  Kind& kind_;
  PreparedPolyhedron& known_;
  unsigned threads_;
  const Polyhedron& polyhedron_;
  std::vector<std::uint32_t> opposite_;
  std::vector<std::uint32_t> facets_;   // of sides
  std::vector<PreparedPlane> planes_;   // of facets
  std::vector<unsigned char> is_flat_;  // sides: the neighbour lies in the same plane
};

// known: of the kind's first polyhedron. REQUIRES its points; of a mesh the planes are filled in.
void complete(Kind& kind, PreparedPolyhedron& known, unsigned threads) {
  list_corners(kind);
  kind.triples.resize(kind.facet_count());
  in_parallel_parts(threads, kind.triples.size(), [&](std::size_t f) {
    kind.triples[f] = spanning_triple(*kind.first, known.points, kind.first->facets[f]);
  });
  if (!kind.convex) {
    MeshPlanes(kind, known, threads).find();
    return;
  }
  // Neighbours of a convex polytope are not coplanar.
  const std::vector<std::uint32_t> facets = facets_of_sides(kind);
  kind.side_planes = opposite_sides(kind, threads);
  for (std::uint32_t& side : kind.side_planes) side = facets[side];
}

// The planes of a polyhedron of a known kind. A triple that spans well in one copy need not do so
// in another.
void set_planes(const Polyhedron& polyhedron, const Kind& kind, PreparedPolyhedron& known,
                unsigned threads) {
  // Of a normal: well-conditioned ones are known better.
  constexpr double good = 0x1p-44;
  known.planes.resize(kind.plane_count());
  known.triples = kind.triples;
  in_parallel_parts(threads, known.triples.size(), [&](std::size_t p) {
    Triple& triple = known.triples[p];
    std::optional<PreparedPlane> plane = quickly_prepared_plane(
        known.near_point(polyhedron, triple[0]), known.near_point(polyhedron, triple[1]),
        known.near_point(polyhedron, triple[2]));
    if (!plane || plane->near.normal_error > good) {
      if (kind.convex) triple = spanning_triple(polyhedron, known.points, polyhedron.facets[p]);
      plane = plane_through_corners(polyhedron, known, triple);
    }
    known.planes[p] = *std::move(plane);
  });
  auto plane = known.planes.begin() + static_cast<std::ptrdiff_t>(kind.triples.size());
  for (const auto& [from, to, axis] : kind.planes_across) {
    *plane++ =
        prepared_plane(known.near_point(polyhedron, from), known.near_point(polyhedron, to), axis);
  }
}

// Finds the points' doubles. An infinite error: coordinates that doubles cannot hold.
void set_points(const Polyhedron& polyhedron, PreparedPolyhedron& known, unsigned threads) {
  known.points.resize(polyhedron.vertices.size());
  in_parallel_parts(threads, known.points.size(),
                    [&](std::size_t v) { known.points[v] = hashed(polyhedron.vertices[v]); });
  for (const HashedPoint& point : known.points) {
    const std::array<double, 3> coordinates{point.near.x, point.near.y, point.near.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = coordinates[axis];
      if (!(std::abs(value) <= largest_coordinate && point.near.error <= largest_coordinate)) {
        throw Error(ErrorId::NumberOutOfRange, {"a coordinate beyond 1e290", ""});
      }
      known.bounds[axis].lower = std::min(known.bounds[axis].lower, value);
      known.bounds[axis].upper = std::max(known.bounds[axis].upper, value);
    }
  }
}

// to - from, if doubles can hold it. REQUIRES no coordinate beyond 1e290
std::optional<double> exact_difference(double to, double from) {
  // Knuth's sum of two numbers, with the part that rounding takes from it.
  const double difference = to - from;
  const double rounded_from = to - difference;
  const double rounded_to = difference + rounded_from;
  if ((to - rounded_to) + (rounded_from - from) != 0) return std::nullopt;
  return difference;
}

// Whether one row of points is an image of the other under a translation; false as well if doubles
// do not tell.
bool is_translated(std::span<const ApproximatePoint> from, std::span<const HashedPoint> to) {
  if (from.size() != to.size()) return false;
  std::array<std::optional<double>, 3> translation;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const ApproximatePoint& p = from[i];
    const ApproximatePoint& q = to[i].near;
    if (p.error != 0 || q.error != 0) return false;
    const std::array<std::optional<double>, 3> moved{
        exact_difference(q.x, p.x), exact_difference(q.y, p.y), exact_difference(q.z, p.z)};
    if (i == 0) translation = moved;
    if (!moved[0] || !moved[1] || !moved[2] || moved != translation) return false;
  }
  return true;
}

class SceneBuilder {
 public:
  SceneBuilder(const Solid& solid, unsigned threads) {
    tree_ = csg::flatten(solid, [this](const Primitive& primitive) { return index_of(primitive); });
    add_shapes(threads);
  }

  Scene finish(unsigned threads) && {
    // The first touch of large vectors takes about as long as all that is done to build a geometry.
    std::optional<Geometry> geometry;
    std::vector<PointCorner> corners;
    std::vector<SceneFacet> facets;
    SceneBounds bounds;
    in_parallel(threads, 2, [&](std::size_t task) {
      if (task == 0) {
        geometry.emplace(std::move(builder_).build());
        return;
      }
      resize(threads, corners, corner_count_);
      resize(threads, facets, facet_count_);
      for (std::vector<Range>& axis : bounds.facets) resize(threads, axis, facet_count_);
    });
    Scene scene{
        std::move(*geometry), std::move(primitives_), std::move(facets), std::move(corners), {},
        std::move(bounds),    std::move(tree_),       root_cell()};
    in_parallel(threads, Parts(facet_count_), [&](std::size_t, std::size_t begin, std::size_t end) {
      fill_facets(scene, static_cast<FacetIndex>(begin), static_cast<FacetIndex>(end));
    });
    give_up(shapes_);
    give_up(points_);
    for (FacetIndex f = 0; f < facet_count_; ++f) {
      if (scene.facets[f].is_half_space) add_half_space_polygon(scene, f);
    }
    set_bounds_of_primitives(scene, threads);
    return scene;
  }

 private:
  // What becomes of a primitive, and what it is numbered by; it lasts as long as the solid.
  struct Shape {
    const HalfSpace* half_space = nullptr;  // null: the polyhedron
    std::shared_ptr<const Polyhedron> polyhedron;
    bool convex = true;
    std::shared_ptr<const Kind> kind{};
    std::uint32_t first_plane = 0;   // as added
    std::uint32_t first_corner = 0;  // in the scene
    std::size_t first_point = 0;     // in points_
  };

  // The facets of one shape after the other.
  void fill_facets(Scene& scene, FacetIndex begin, FacetIndex end) const {
    auto primitive = static_cast<PrimitiveIndex>(
        std::upper_bound(scene.primitives.begin(), scene.primitives.end(), begin,
                         [](FacetIndex f, const ScenePrimitive& p) { return f < p.first_facet; }) -
        scene.primitives.begin() - 1);
    for (FacetIndex f = begin; f < end; ++primitive) {
      const ScenePrimitive& facets = scene.primitives[primitive];
      const FacetIndex last = std::min(end, facets.first_facet + facets.facet_count);
      for (; f < last; ++f) fill_facet(scene, primitive, f);
    }
  }

  void fill_facet(Scene& scene, PrimitiveIndex primitive, FacetIndex f) const {
    const Geometry& geometry = scene.geometry;
    const std::span<const OrientedPlaneRef> planes = geometry.planes();
    const Shape& shape = shapes_[primitive];
    if (shape.half_space != nullptr) {
      scene.facets[f] = {primitive, true, planes[shape.first_plane], 0, 0};
      return;
    }
    const Kind& kind = *shape.kind;
    const std::uint32_t own = f - scene.primitives[primitive].first_facet;
    const std::uint32_t begin = kind.first_corners[own];
    const std::uint32_t end = kind.first_corners[own + 1];
    const std::uint32_t first = shape.first_corner + begin;
    scene.facets[f] = {primitive, false, planes[shape.first_plane + kind.plane_of(own)], first,
                       end - begin};
    for (std::uint32_t i = begin; i < end; ++i) {
      const PlaneRef side = planes[shape.first_plane + kind.side_planes[i]].plane;
      scene.corners[shape.first_corner + i] = {points_[shape.first_point + kind.corners[i]],
                                               side.table_index()};
    }
    set_bounds(scene, f);
  }

  static void set_bounds(Scene& scene, FacetIndex f) {
    std::array<Range, 3> bounds;
    widen(bounds, scene.corners_of(f));
    for (std::size_t axis = 0; axis < 3; ++axis) scene.bounds.facets[axis][f] = bounds[axis];
  }

  static void set_bounds_of_primitives(Scene& scene, unsigned threads) {
    const std::size_t count = scene.primitives.size();
    for (std::vector<Range>& axis : scene.bounds.primitives) axis.resize(count);
    in_parallel(threads, 3 * count, [&](std::size_t round) {
      const std::size_t axis = round / count;
      const ScenePrimitive& primitive = scene.primitives[round % count];
      Range whole;
      for (const Range& bounds : std::span(scene.bounds.facets[axis])
                                     .subspan(primitive.first_facet, primitive.facet_count)) {
        whole.lower = std::min(whole.lower, bounds.lower);
        whole.upper = std::max(whole.upper, bounds.upper);
      }
      scene.bounds.primitives[axis][round % count] = whole;
    });
  }

  PrimitiveIndex index_of(const Primitive& primitive) {
    const auto next = static_cast<PrimitiveIndex>(shapes_.size());
    std::shared_ptr<const Polyhedron> polyhedron = shared_polyhedron_of(primitive);
    if (polyhedron == nullptr) {
      shapes_.push_back({&std::get<HalfSpace>(primitive.shape), nullptr});
      return next;
    }
    const auto [place, is_new] = known_.try_emplace(polyhedron.get(), next);
    if (is_new) {
      const bool convex = std::holds_alternative<ConvexPolytope>(primitive.shape);
      shapes_.push_back({nullptr, std::move(polyhedron), convex});
    }
    return place->second;
  }

  static std::shared_ptr<const Polyhedron> shared_polyhedron_of(const Primitive& primitive) {
    if (const auto* polytope = std::get_if<ConvexPolytope>(&primitive.shape)) {
      return polytope->polyhedron;
    }
    if (const auto* mesh = std::get_if<PolyhedralMesh>(&primitive.shape)) return mesh->polyhedron;
    return nullptr;
  }

  // Some of the shapes, and what is known of each.
  struct Batch {
    std::span<Shape> shapes;
    std::vector<PreparedPolyhedron> known;
  };

  // Numbers points and planes in the order of the primitives. What can be found out of a primitive
  // by itself is found by several threads, of a few primitives at a time, while one of them numbers
  // the points, and the planes of those before; of a few in all, they share each.
  void add_shapes(unsigned threads) {
    make_room();
    constexpr std::size_t few = 8;
    const bool share_each = shapes_.size() <= few;
    const unsigned inside = share_each ? threads : 1;
    const unsigned outside = share_each ? 1 : threads;
    const std::size_t at_a_time = threads == 1 ? 1 : 64;
    Batch before;
    for (std::size_t first = 0; first < shapes_.size(); first += at_a_time) {
      const std::size_t count = std::min(at_a_time, shapes_.size() - first);
      Batch batch{std::span(shapes_).subspan(first, count), std::vector<PreparedPolyhedron>(count)};
      in_parallel(outside, count, [&](std::size_t i) {
        if (const Shape& shape = batch.shapes[i]; shape.polyhedron) {
          set_points(*shape.polyhedron, batch.known[i], inside);
        }
      });
      in_parallel(threads, 2, [&](std::size_t task) {
        if (task == 0) {
          set_planes_of(batch, outside, inside);
        } else {
          add(before);
          add_points(batch);
        }
      });
      before = std::move(batch);
    }
    add(before);
  }

  void set_planes_of(Batch& batch, unsigned outside, unsigned inside) {
    set_kinds(batch.shapes, batch.known, outside, inside);
    in_parallel(outside, batch.shapes.size(), [&](std::size_t i) {
      const Shape& shape = batch.shapes[i];
      PreparedPolyhedron& known = batch.known[i];
      if (!shape.polyhedron || !known.planes.empty()) return;
      set_planes(*shape.polyhedron, *shape.kind, known, inside);
    });
  }

  void add_points(Batch& batch) {
    for (std::size_t i = 0; i < batch.shapes.size(); ++i) {
      if (batch.shapes[i].polyhedron) add_points(batch.shapes[i], batch.known[i]);
    }
  }

  // All but the points.
  void add(Batch& batch) {
    for (std::size_t i = 0; i < batch.shapes.size(); ++i) {
      if (batch.shapes[i].polyhedron) {
        add_polyhedron(batch.shapes[i], batch.known[i]);
      } else {
        add_half_space(batch.shapes[i]);
      }
    }
  }

  void make_room() {
    std::size_t points = 0;
    std::size_t planes = 0;
    std::size_t corners = 0;
    for (const Shape& shape : shapes_) {
      if (!shape.polyhedron) continue;
      points += shape.polyhedron->vertices.size();
      planes += shape.polyhedron->facets.size();
      for (const Facet& facet : shape.polyhedron->facets) corners += facet.size();
    }
    builder_.reserve(points, planes, corners);
    points_.reserve(points);
    primitives_.reserve(shapes_.size());
  }

  // Copies of one shape follow one another in most models.
  void set_kinds(std::span<Shape> shapes, std::span<PreparedPolyhedron> known, unsigned outside,
                 unsigned inside) {
    struct NewKind {
      std::shared_ptr<Kind> kind;
      PreparedPolyhedron* known;
    };
    std::vector<NewKind> new_kinds;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (!shapes[i].polyhedron) continue;
      if (!last_kind_ || !is_of_kind(shapes[i], known[i], *last_kind_)) {
        last_kind_ = new_kind(shapes[i], known[i]);
        new_kinds.push_back({last_kind_, &known[i]});
      }
      shapes[i].kind = last_kind_;
    }
    in_parallel(outside, new_kinds.size(),
                [&](std::size_t i) { complete(*new_kinds[i].kind, *new_kinds[i].known, inside); });
  }

  static bool is_of_kind(const Shape& shape, const PreparedPolyhedron& known, const Kind& kind) {
    return shape.convex == kind.convex && shape.polyhedron->facets == kind.first->facets &&
           (kind.convex || is_translated(kind.near, known.points));
  }

  // Of this shape, still to be completed.
  static std::shared_ptr<Kind> new_kind(const Shape& shape, const PreparedPolyhedron& known) {
    auto kind = std::make_shared<Kind>();
    kind->first = shape.polyhedron;
    kind->convex = shape.convex;
    if (!kind->convex) {
      kind->near.reserve(known.points.size());
      for (const HashedPoint& point : known.points) kind->near.push_back(point.near);
    }
    return kind;
  }

  void add_half_space(Shape& shape) {
    const Plane& plane = shape.half_space->plane;
    primitives_.push_back({true, facet_count_++, 1});
    shape.first_plane = builder_.add_plane(plane);
    ++plane_count_;
    for (const Integer* n : {&plane.a, &plane.b, &plane.c}) {
      largest_normal_ = std::max(largest_normal_, std::abs(n->get_d()));
    }
    largest_offset_ = std::max(largest_offset_, std::abs(plane.d.get_d()));
    has_half_spaces_ = true;
  }

  void add_points(Shape& shape, const PreparedPolyhedron& known) {
    builder_.add_owner(shape.polyhedron);
    shape.first_point = points_.size();
    for (std::size_t v = 0; v < known.points.size(); ++v) {
      points_.push_back(builder_.add_owned_point(shape.polyhedron->vertices[v], known.points[v]));
    }
  }

  // REQUIRES that its points were added.
  void add_polyhedron(Shape& shape, PreparedPolyhedron& known) {
    const Kind& kind = *shape.kind;
    primitives_.push_back({shape.convex, facet_count_, kind.facet_count()});
    facet_count_ += kind.facet_count();
    shape.first_corner = corner_count_;
    corner_count_ += static_cast<std::uint32_t>(kind.corners.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower_[axis] = std::min(lower_[axis], known.bounds[axis].lower);
      upper_[axis] = std::max(upper_[axis], known.bounds[axis].upper);
    }
    const auto point = [&](std::uint32_t v) { return points_[shape.first_point + v]; };
    shape.first_plane = plane_count_;
    plane_count_ += kind.plane_count();
    const std::vector<Triple>& triples = known.triples.empty() ? kind.triples : known.triples;
    auto plane = known.planes.begin();
    for (const auto& [a, b, c] : triples) {
      builder_.add_plane(std::move(*plane++), point(a), point(b), point(c));
    }
    for (std::uint32_t f = 0; f < kind.facet_count(); ++f) {
      const std::uint32_t added = shape.first_plane + kind.plane_of(f);
      for (const std::uint32_t v : kind.corners_of(f)) builder_.add_incidence(point(v), added);
    }
    for (const auto& [from, to, axis] : kind.planes_across) {
      const std::uint32_t added =
          builder_.add_plane(std::move(*plane++), point(from), point(to), axis);
      builder_.add_incidence(point(from), added);
      builder_.add_incidence(point(to), added);
    }
  }

  // Every vertex of a bounded solid is a point of a bounded primitive or the meeting point of three
  // half-spaces' planes; by Cramer's rule its coordinates are quotients of integers, at most
  // 6 N^2 D in magnitude for normals up to N and offsets up to D.
  Cell root_cell() const {
    Cell cell;
    double reach = 0;
    if (has_half_spaces_) {
      reach = 8 * (6 * largest_normal_ * largest_normal_ * (largest_offset_ + 1) + 1);
      if (!(reach <= largest_coordinate)) {
        throw Error(ErrorId::NumberOutOfRange, {"half-spaces that may meet beyond 1e290", ""});
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool bounded = lower_[axis] <= upper_[axis];
      const double lower = std::min(bounded ? lower_[axis] : 0.0, -reach);
      const double upper = std::max(bounded ? upper_[axis] : 0.0, reach);
      const double margin =
          std::max({(upper - lower) * 0.015625, std::abs(lower) * 0x1p-20,
                    std::abs(upper) * 0x1p-20, std::numeric_limits<double>::min() * 0x1p60});
      cell.lower[axis] = round_wall_position(lower - margin);
      cell.upper[axis] = round_wall_position(upper + margin);
    }
    return cell;
  }

  static void add_half_space_polygon(Scene& scene, FacetIndex f) {
    SceneFacet& facet = scene.facets[f];
    facet.first_corner = static_cast<std::uint32_t>(scene.half_space_corners.size());
    append_half_space_polygon(scene, facet.plane);
    facet.corner_count =
        static_cast<std::uint32_t>(scene.half_space_corners.size()) - facet.first_corner;
    set_bounds(scene, f);
  }

  // The plane clipped to the root cell: a parallelogram between the walls of the two axes that the
  // normal leans to least, cut by the walls of the third.
  static void append_half_space_polygon(Scene& scene, OrientedPlaneRef outward) {
    const Geometry& geometry = scene.geometry;
    const PlaneRef plane = outward.plane;
    const Geometry::ApproximatePlane near = geometry.approximate(plane);
    const std::array<double, 3> normal{near.a, near.b, near.c};
    const auto steepest = static_cast<std::size_t>(
        std::max_element(normal.begin(), normal.end(),
                         [](double a, double b) { return std::abs(a) < std::abs(b); }) -
        normal.begin());
    std::size_t u = (steepest + 1) % 3;
    std::size_t v = (steepest + 2) % 3;
    // Counter-clockwise seen from outside.
    if (normal[steepest] * outward.sense < 0) std::swap(u, v);
    const auto wall = [&](std::size_t axis, bool upper) {
      return PlaneRef::of_wall(static_cast<Axis>(axis),
                               upper ? scene.root.upper[axis] : scene.root.lower[axis]);
    };
    std::vector<Corner> polygon{
        {geometry.meet(plane, wall(u, false), wall(v, false)), wall(v, false)},
        {geometry.meet(plane, wall(u, true), wall(v, false)), wall(u, true)},
        {geometry.meet(plane, wall(u, true), wall(v, true)), wall(v, true)},
        {geometry.meet(plane, wall(u, false), wall(v, true)), wall(u, false)}};
    std::vector<Corner> kept;
    std::vector<Sign> signs;
    TierStatistics statistics;
    for (const bool upper : {false, true}) {
      const Sign inside = upper ? Sign::Negative : Sign::Positive;
      if (split_signs(geometry, polygon, wall(steepest, upper), signs, statistics) ==
          PlaneSplit::Both) {
        kept.clear();
        PolygonCut(geometry, polygon, plane, wall(steepest, upper), signs)
            .append_part(polygon, signs, inside, kept);
        polygon.swap(kept);
      }
    }
    scene.half_space_corners.insert(scene.half_space_corners.end(), polygon.begin(), polygon.end());
  }

  std::vector<Shape> shapes_;
  Geometry::Builder builder_;
  std::vector<ScenePrimitive> primitives_;
  std::vector<PointId> points_;  // of the vertices of all shapes in turn
  FacetIndex facet_count_ = 0;
  std::uint32_t corner_count_ = 0;
  std::uint32_t plane_count_ = 0;  // as added
  std::unordered_map<const Polyhedron*, PrimitiveIndex> known_;
  std::shared_ptr<Kind> last_kind_;
  std::array<double, 3> lower_{std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};
  std::array<double, 3> upper_{-std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
  double largest_normal_ = 0;
  double largest_offset_ = 0;
  bool has_half_spaces_ = false;
  PrunedTree tree_;
};

}  // namespace

void widen(std::array<Range, 3>& bounds, const CornerView& corners) {
  if (corners.size() == 0) return;
  std::array<Range, 3> near;
  double error = 0;
  const auto include = [](Range& range, double value) {
    range.lower = std::min(range.lower, value);
    range.upper = std::max(range.upper, value);
  };
  corners.for_each_vertex([&](std::size_t, const Vertex& vertex) {
    include(near[0], vertex.x);
    include(near[1], vertex.y);
    include(near[2], vertex.z);
    error = std::max(error, vertex.error);
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [lower, upper] = near[axis];
    // Widened by two units in the last place, for the rounding of this very sum.
    const double slack = error + 0x1p-51 * std::max(std::abs(lower), std::abs(upper));
    include(bounds[axis], lower - slack);
    include(bounds[axis], upper + slack);
  }
}

Vertex between_walls(const Geometry& geometry, const std::array<double, 3>& place) {
  std::array<PlaneRef, 3> walls;
  for (std::size_t i = 0; i < 3; ++i) {
    walls[i] = PlaneRef::of_wall(static_cast<Axis>(i), round_wall_position(place[i]));
  }
  return geometry.meet(walls[0], walls[1], walls[2]);
}

Scene make_scene(const Solid& solid, unsigned threads) {
  return SceneBuilder(solid, threads).finish(threads);
}

}  // namespace exactcsg
