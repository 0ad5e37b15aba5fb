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
#include "exactcsg/solid/bucket_sort.hpp"
#include "exactcsg/solid/certified_vector.hpp"
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

// Of every side of every facet in turn: the facet that walks it the other way.
// THROWS Error(InternalError) if there is none. COST: O(n log n)
std::vector<std::uint32_t> neighbours_of(const Polyhedron& polyhedron) {
  struct Side {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t facet;
    std::uint32_t number;
    bool ascends;
  };
  std::vector<Side> sides;
  for (std::uint32_t f = 0; f < polyhedron.facets.size(); ++f) {
    const Facet& facet = polyhedron.facets[f];
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const std::uint32_t from = facet[i];
      const std::uint32_t to = facet[i + 1 == facet.size() ? 0 : i + 1];
      const auto number = static_cast<std::uint32_t>(sides.size());
      sides.push_back({std::min(from, to), std::max(from, to), f, number, from < to});
    }
  }
  sort_in_buckets(
      sides, polyhedron.vertices.size(), [](const Side& side) { return side.low; },
      [](const Side& a, const Side& b) {
        return a.high != b.high ? a.high < b.high : a.number < b.number;
      });
  std::vector<std::uint32_t> result(sides.size());
  for (auto begin = sides.begin(); begin != sides.end();) {
    const auto end = std::find_if(begin, sides.end(), [&](const Side& side) {
      return side.low != begin->low || side.high != begin->high;
    });
    for (auto side = begin; side != end; ++side) {
      const auto other =
          std::find_if(begin, end, [&](const Side& s) { return s.ascends != side->ascends; });
      if (other == end) {
        throw Error(ErrorId::InternalError, {"a primitive that is not closed", "a closed one"});
      }
      result[side->number] = other->facet;
    }
    begin = end;
  }
  return result;
}

// What can be said of a polyhedron by itself.
struct PreparedPolyhedron {
  std::vector<HashedPoint> points;
  std::vector<std::array<std::uint32_t, 3>> triples;  // of facets: corners that span the plane
  std::vector<bool> flat_sides;  // the neighbour lies in the same plane; empty: none does
};

// Tells which neighbours of a facet lie in its plane: mostly by doubles that none does.
class FlatSides {
 public:
  FlatSides(const Polyhedron& polyhedron, const std::vector<HashedPoint>& near)
      : polyhedron_(polyhedron), near_(near) {}

  // The facets asked about next are neighbours of this one.
  void set_facet(const Facet& facet, const std::array<std::uint32_t, 3>& triple) {
    facet_ = &facet;
    triple_ = triple;
    origin_ = position_of(near_[triple[0]].near);
    normal_ = cross(difference(position_of(near_[triple[1]].near), origin_),
                    difference(position_of(near_[triple[2]].near), origin_));
  }

  bool is_flat(const Facet& neighbour) {
    return std::all_of(neighbour.begin(), neighbour.end(), [&](std::uint32_t corner) {
      return std::find(facet_->begin(), facet_->end(), corner) != facet_->end() ||
             is_in_plane(corner);
    });
  }

 private:
  bool is_in_plane(std::uint32_t corner) {
    const CertifiedVector to_corner = difference(position_of(near_[corner].near), origin_);
    if (sign_of_certain(dot(normal_, to_corner)) != Sign::Zero) return false;
    if (!signs_) signs_.emplace(polyhedron_.vertices);
    return signs_->orientation(triple_[0], triple_[1], triple_[2], corner) == Sign::Zero;
  }

  const Polyhedron& polyhedron_;
  const std::vector<HashedPoint>& near_;
  const Facet* facet_ = nullptr;
  std::array<std::uint32_t, 3> triple_{};
  CertifiedVector origin_;
  CertifiedVector normal_;
  std::optional<PolyhedronSigns> signs_;  // once doubles do not tell
};

// `neighbours` as of neighbours_of.
PreparedPolyhedron prepared(const Polyhedron& polyhedron, bool convex,
                            std::span<const std::uint32_t> neighbours) {
  PreparedPolyhedron result;
  result.points.reserve(polyhedron.vertices.size());
  for (const Point3& vertex : polyhedron.vertices) result.points.push_back(hashed(vertex));
  result.triples.reserve(polyhedron.facets.size());
  for (const Facet& facet : polyhedron.facets) {
    result.triples.push_back(spanning_triple(polyhedron, result.points, facet));
  }
  if (convex) return result;  // neighbours of a convex polytope are not coplanar
  FlatSides flat_sides(polyhedron, result.points);
  result.flat_sides.reserve(neighbours.size());
  std::size_t side = 0;
  for (std::size_t f = 0; f < polyhedron.facets.size(); ++f) {
    flat_sides.set_facet(polyhedron.facets[f], result.triples[f]);
    for (std::size_t i = 0; i < polyhedron.facets[f].size(); ++i, ++side) {
      result.flat_sides.push_back(flat_sides.is_flat(polyhedron.facets[neighbours[side]]));
    }
  }
  return result;
}

// A plane through the side from p to q, not the facet's own: it contains the axis that the facet's
// normal leans to most.
Plane plane_across(const Plane& facet, const Homogeneous<Integer>& p,
                   const Homogeneous<Integer>& q) {
  const auto leans_more = [](const Integer& a, const Integer& b) {
    return mpz_cmpabs(a.get_mpz_t(), b.get_mpz_t()) >= 0;
  };
  Homogeneous<Integer> along_axis = p;
  if (leans_more(facet.a, facet.b) && leans_more(facet.a, facet.c)) {
    along_axis.x += p.w;
  } else if (leans_more(facet.b, facet.c)) {
    along_axis.y += p.w;
  } else {
    along_axis.z += p.w;
  }
  return plane_through(p, q, along_axis);
}

SceneBounds bounds_of(const Scene& scene, unsigned threads) {
  SceneBounds result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.facets[axis].resize(scene.facets.size());
    result.primitives[axis].resize(scene.primitives.size());
  }
  in_parallel_parts(threads, scene.facets.size(), [&](std::size_t f) {
    std::array<Range, 3> bounds;
    widen(bounds, scene.corners_of(scene.facets[f]));
    for (std::size_t axis = 0; axis < 3; ++axis) result.facets[axis][f] = bounds[axis];
  });
  for (std::size_t f = 0; f < scene.facets.size(); ++f) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Range& bounds = result.facets[axis][f];
      Range& whole = result.primitives[axis][scene.facets[f].primitive];
      whole.lower = std::min(whole.lower, bounds.lower);
      whole.upper = std::max(whole.upper, bounds.upper);
    }
  }
  return result;
}

class SceneBuilder {
 public:
  SceneBuilder(const Solid& solid, unsigned threads) {
    tree_ = csg::flatten(solid, [this](const Primitive& primitive) { return index_of(primitive); });
    add_shapes(threads);
  }

  Scene finish(unsigned threads) && {
    Scene scene{
        std::move(builder_).build(), std::move(primitives_), {}, {}, {}, {}, std::move(tree_), {}};
    scene.root = root_cell();
    scene.corners.resize(corners_.size());
    in_parallel_parts(threads, corners_.size(), [&](std::size_t i) {
      const OrientedPlaneRef side_plane = scene.geometry.plane(corners_[i].side_plane);
      scene.corners[i] = {corners_[i].point, side_plane.plane.table_index()};
    });
    give_up(corners_);
    scene.facets.resize(facets_.size());
    in_parallel_parts(threads, facets_.size(), [&](std::size_t f) {
      scene.facets[f] = {facets_[f].primitive, facets_[f].corner_count == 0,
                         scene.geometry.plane(facets_[f].plane), facets_[f].first_corner,
                         facets_[f].corner_count};
    });
    give_up(facets_);
    for (SceneFacet& facet : scene.facets) {
      if (facet.is_half_space) add_half_space_polygon(scene, facet);
    }
    scene.bounds = bounds_of(scene, threads);
    return scene;
  }

 private:
  struct PendingCorner {
    PointId point;
    std::uint32_t side_plane;
  };
  struct PendingFacet {
    PrimitiveIndex primitive;
    std::uint32_t plane;
    std::uint32_t first_corner;
    std::uint32_t corner_count;  // 0: a half-space
  };

  // What becomes of a primitive; it lasts as long as the solid.
  struct Shape {
    const HalfSpace* half_space = nullptr;  // null: the polyhedron
    std::shared_ptr<const Polyhedron> polyhedron;
    bool convex = true;
    std::shared_ptr<const std::vector<std::uint32_t>> neighbours;  // while it is being added
  };

  PrimitiveIndex index_of(const Primitive& primitive) {
    const auto next = static_cast<PrimitiveIndex>(shapes_.size());
    std::shared_ptr<const Polyhedron> polyhedron = shared_polyhedron_of(primitive);
    if (polyhedron == nullptr) {
      shapes_.push_back({&std::get<HalfSpace>(primitive.shape), nullptr, true, nullptr});
      return next;
    }
    const auto [place, is_new] = known_.try_emplace(polyhedron.get(), next);
    if (is_new) {
      const bool convex = std::holds_alternative<ConvexPolytope>(primitive.shape);
      shapes_.push_back({nullptr, std::move(polyhedron), convex, nullptr});
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

  // Numbers points and planes in the order of the primitives. What can be found out of a primitive
  // by itself is found by several threads, of a few primitives at a time.
  void add_shapes(unsigned threads) {
    const std::size_t at_a_time = threads == 1 ? 1 : 64;
    std::vector<PreparedPolyhedron> some(at_a_time);
    for (std::size_t first = 0; first < shapes_.size(); first += at_a_time) {
      const auto shapes =
          std::span(shapes_).subspan(first, std::min(at_a_time, shapes_.size() - first));
      find_neighbours(shapes, threads);
      in_parallel(threads, shapes.size(), [&](std::size_t i) {
        const Shape& shape = shapes[i];
        if (shape.polyhedron)
          some[i] = prepared(*shape.polyhedron, shape.convex, *shape.neighbours);
      });
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (shapes[i].polyhedron) {
          builder_.add_owner(shapes[i].polyhedron);
          add_polyhedron(shapes[i], some[i]);
        } else {
          add_half_space(*shapes[i].half_space);
        }
        shapes[i].neighbours.reset();
      }
    }
  }

  // Copies of one shape follow one another in most models: their facets have the same vertices by
  // number.
  void find_neighbours(std::span<Shape> shapes, unsigned threads) {
    struct Kind {
      const Polyhedron* polyhedron;
      std::shared_ptr<std::vector<std::uint32_t>> neighbours;
    };
    std::vector<Kind> new_kinds;
    for (Shape& shape : shapes) {
      if (!shape.polyhedron) continue;
      if (last_kind_ == nullptr || last_kind_->facets != shape.polyhedron->facets) {
        last_kind_ = shape.polyhedron;
        new_kinds.push_back(
            {shape.polyhedron.get(), std::make_shared<std::vector<std::uint32_t>>()});
        last_neighbours_ = new_kinds.back().neighbours;
      }
      shape.neighbours = last_neighbours_;
    }
    in_parallel(threads, new_kinds.size(), [&](std::size_t i) {
      *new_kinds[i].neighbours = neighbours_of(*new_kinds[i].polyhedron);
    });
  }

  void add_half_space(const HalfSpace& half_space) {
    const auto index = static_cast<PrimitiveIndex>(primitives_.size());
    primitives_.push_back({true, static_cast<FacetIndex>(facets_.size()), 1});
    facets_.push_back({index, builder_.add_plane(half_space.plane), 0, 0});
    const Plane& plane = half_space.plane;
    for (const Integer* n : {&plane.a, &plane.b, &plane.c}) {
      largest_normal_ = std::max(largest_normal_, std::abs(n->get_d()));
    }
    largest_offset_ = std::max(largest_offset_, std::abs(plane.d.get_d()));
    has_half_spaces_ = true;
  }

  void add_polyhedron(const Shape& shape, const PreparedPolyhedron& known) {
    const Polyhedron& polyhedron = *shape.polyhedron;
    const std::vector<std::uint32_t>& neighbours = *shape.neighbours;
    const auto index = static_cast<PrimitiveIndex>(primitives_.size());
    primitives_.push_back({shape.convex, static_cast<FacetIndex>(facets_.size()),
                           static_cast<std::uint32_t>(polyhedron.facets.size())});
    std::vector<PointId> points;
    points.reserve(polyhedron.vertices.size());
    for (std::size_t v = 0; v < polyhedron.vertices.size(); ++v) {
      points.push_back(builder_.add_owned_point(polyhedron.vertices[v], known.points[v]));
      extend_bounds(known.points[v].near);
    }
    std::vector<std::uint32_t> planes;
    planes.reserve(polyhedron.facets.size());
    for (std::size_t f = 0; f < polyhedron.facets.size(); ++f) {
      const auto [a, b, c] = known.triples[f];
      planes.push_back(builder_.add_plane(points[a], points[b], points[c]));
      for (const std::uint32_t v : polyhedron.facets[f]) {
        if (v != a && v != b && v != c) builder_.add_incidence(points[v], planes.back());
      }
    }
    std::size_t side = 0;
    for (std::uint32_t f = 0; f < polyhedron.facets.size(); ++f) {
      const Facet& facet = polyhedron.facets[f];
      facets_.push_back({index, planes[f], static_cast<std::uint32_t>(corners_.size()),
                         static_cast<std::uint32_t>(facet.size())});
      for (std::size_t i = 0; i < facet.size(); ++i, ++side) {
        const std::uint32_t from = facet[i];
        const std::uint32_t to = facet[(i + 1) % facet.size()];
        const bool flat = !known.flat_sides.empty() && known.flat_sides[side];
        corners_.push_back(
            {points[from], flat ? plane_across_side(polyhedron, known.triples[f], from, to)
                                : planes[neighbours[side]]});
      }
    }
  }

  std::uint32_t plane_across_side(const Polyhedron& polyhedron,
                                  const std::array<std::uint32_t, 3>& triple, std::uint32_t from,
                                  std::uint32_t to) {
    const auto corner = [&](std::uint32_t v) { return homogeneous_of(polyhedron.vertices[v]); };
    const Plane own = plane_through(corner(triple[0]), corner(triple[1]), corner(triple[2]));
    return builder_.add_plane(plane_across(own, corner(from), corner(to)));
  }

  // An infinite error: coordinates that doubles cannot hold.
  void extend_bounds(const ApproximatePoint& near) {
    const std::array<double, 3> coordinates{near.x, near.y, near.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = coordinates[axis];
      if (!(std::abs(value) <= largest_coordinate && near.error <= largest_coordinate)) {
        throw Error(ErrorId::NumberOutOfRange, {"a coordinate beyond 1e290", ""});
      }
      lower_[axis] = std::min(lower_[axis], value);
      upper_[axis] = std::max(upper_[axis], value);
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

  static void add_half_space_polygon(Scene& scene, SceneFacet& facet) {
    facet.first_corner = static_cast<std::uint32_t>(scene.half_space_corners.size());
    append_half_space_polygon(scene, facet.plane);
    facet.corner_count =
        static_cast<std::uint32_t>(scene.half_space_corners.size()) - facet.first_corner;
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
  std::vector<PendingFacet> facets_;
  std::vector<PendingCorner> corners_;
  std::unordered_map<const Polyhedron*, PrimitiveIndex> known_;
  std::shared_ptr<const Polyhedron> last_kind_;
  std::shared_ptr<const std::vector<std::uint32_t>> last_neighbours_;
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
  std::array<Range, 3> result = bounds;
  const auto widen_range = [](Range& range, double value, double error) {
    // Widened by two units in the last place, for the rounding of this very sum.
    const double slack = error + 0x1p-51 * std::abs(value);
    range.lower = std::min(range.lower, value - slack);
    range.upper = std::max(range.upper, value + slack);
  };
  corners.for_each_vertex([&](std::size_t, const Vertex& vertex) {
    widen_range(result[0], vertex.x, vertex.error);
    widen_range(result[1], vertex.y, vertex.error);
    widen_range(result[2], vertex.z, vertex.error);
  });
  bounds = result;
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
