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
#include "exactcsg/solid/polygon.hpp"
#include "exactcsg/solid/prepared_polyhedron.hpp"
#include "exactcsg/support/give_up.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

namespace {

constexpr double largest_coordinate = 1e290;

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
        geometry.emplace(std::move(builder_).build(threads));
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
    std::shared_ptr<const StoredPolyhedron> polyhedron;
    bool convex = true;
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
    const FacetPlanes& own_planes = *shape.polyhedron->prepared->facets;
    const std::uint32_t own = f - scene.primitives[primitive].first_facet;
    const std::span<const std::uint32_t> corners = own_planes.facets.corners();
    const std::uint32_t begin = own_planes.facets.begins()[own];
    const std::uint32_t end = own_planes.facets.begins()[own + 1];
    const std::uint32_t first = shape.first_corner + begin;
    scene.facets[f] = {primitive, false, planes[shape.first_plane + own_planes.of_facet(own)],
                       first, end - begin};
    for (std::uint32_t i = begin; i < end; ++i) {
      const PlaneRef side = planes[shape.first_plane + own_planes.of_sides[i]].plane;
      scene.corners[shape.first_corner + i] = {points_[shape.first_point + corners[i]],
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
    std::shared_ptr<const StoredPolyhedron> polyhedron = shared_polyhedron_of(primitive);
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

  static std::shared_ptr<const StoredPolyhedron> shared_polyhedron_of(const Primitive& primitive) {
    if (const auto* polytope = std::get_if<ConvexPolytope>(&primitive.shape)) {
      return polytope->polyhedron;
    }
    if (const auto* mesh = std::get_if<PolyhedralMesh>(&primitive.shape)) return mesh->polyhedron;
    return nullptr;
  }

  // Numbers points and planes in the order of the primitives, of some at a time; then all threads
  // set these planes.
  void add_shapes(unsigned threads) {
    make_room();
    const std::size_t at_a_time = threads == 1 ? 1 : 256;
    for (std::size_t first = 0; first < shapes_.size(); first += at_a_time) {
      const std::span<Shape> shapes =
          std::span(shapes_).subspan(first, std::min(at_a_time, shapes_.size() - first));
      for (Shape& shape : shapes) {
        if (shape.polyhedron) {
          add_polyhedron(shape, threads);
        } else {
          add_half_space(shape);
        }
      }
      set_planes(shapes, threads);
    }
  }

  void make_room() {
    std::size_t points = 0;
    std::size_t planes = 0;
    for (const Shape& shape : shapes_) {
      if (!shape.polyhedron) continue;
      points += shape.polyhedron->vertices.size();
      planes += shape.polyhedron->facets.size();
    }
    builder_.reserve(points, planes);
    points_.resize(points);
    primitives_.reserve(shapes_.size());
  }

  void add_half_space(Shape& shape) {
    const Plane& plane = shape.half_space->plane;
    primitives_.push_back({true, facet_count_++, 1});
    shape.first_plane = builder_.add_plane(plane);
    for (const Integer* n : {&plane.a, &plane.b, &plane.c}) {
      largest_normal_ = std::max(largest_normal_, std::abs(n->get_d()));
    }
    largest_offset_ = std::max(largest_offset_, std::abs(plane.d.get_d()));
    has_half_spaces_ = true;
  }

  // All but the planes, for which it makes room.
  void add_polyhedron(Shape& shape, unsigned threads) {
    const StoredPolyhedron& polyhedron = *shape.polyhedron;
    if (!polyhedron.prepared) {
      throw Error(ErrorId::NumberOutOfRange, {"a coordinate beyond 1e290", ""});
    }
    const PreparedPolyhedron& known = *polyhedron.prepared;
    const FacetPlanes& facets = *known.facets;
    primitives_.push_back({shape.convex, facet_count_, facets.facet_count()});
    facet_count_ += facets.facet_count();
    shape.first_corner = corner_count_;
    corner_count_ += static_cast<std::uint32_t>(facets.facets.corners().size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower_[axis] = std::min(lower_[axis], known.bounds[axis].lower);
      upper_[axis] = std::max(upper_[axis], known.bounds[axis].upper);
    }
    shape.first_point = point_count_;
    point_count_ += known.points.size();
    const std::span<PointId> points =
        std::span(points_).subspan(shape.first_point, known.points.size());
    builder_.add_owner(shape.polyhedron);
    builder_.add_owned_points(polyhedron.vertices, known.points, points);
    shape.first_plane = builder_.add_planes(facets.plane_count(), threads);
    builder_.add_incidences({points, facets.facets.begins(), facets.facets.corners(),
                             facets.of_facets, shape.first_plane});
    auto plane = shape.first_plane + static_cast<std::uint32_t>(known.triples().size());
    for (const PlaneAcross& across : facets.across) {
      builder_.add_incidence(points[across.from], plane);
      builder_.add_incidence(points[across.to], plane++);
    }
  }

  // The planes of these shapes, of large ones in parts.
  void set_planes(std::span<const Shape> shapes, unsigned threads) {
    struct Part {
      const Shape* shape;
      std::uint32_t begin;
      std::uint32_t end;
    };
    constexpr std::uint32_t most = 4096;
    std::vector<Part> parts;
    for (const Shape& shape : shapes) {
      if (!shape.polyhedron) continue;
      const std::uint32_t count = shape.polyhedron->prepared->facets->plane_count();
      for (std::uint32_t begin = 0; begin < count; begin += most) {
        parts.push_back({&shape, begin, std::min(begin + most, count)});
      }
    }
    in_parallel(threads, parts.size(), [&](std::size_t i) {
      for (std::uint32_t p = parts[i].begin; p < parts[i].end; ++p) set_plane(*parts[i].shape, p);
    });
  }

  // The plane p of the shape's own.
  void set_plane(const Shape& shape, std::uint32_t p) {
    const PreparedPolyhedron& known = *shape.polyhedron->prepared;
    const PreparedPlane& plane = known.planes[p];
    PreparedPlane copy{plane.near, plane.key,
                       plane.exact ? std::make_unique<const Plane>(*plane.exact) : nullptr};
    const auto point = [&](std::uint32_t v) { return points_[shape.first_point + v]; };
    const std::uint32_t added = shape.first_plane + p;
    const std::vector<Triple>& triples = known.triples();
    if (p < triples.size()) {
      const auto [a, b, c] = triples[p];
      builder_.set_plane(added, std::move(copy), point(a), point(b), point(c));
    } else {
      const auto [from, to, axis] = known.facets->across[p - triples.size()];
      builder_.set_plane(added, std::move(copy), point(from), point(to), axis);
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
  std::size_t point_count_ = 0;  // of those that are known
  FacetIndex facet_count_ = 0;
  std::uint32_t corner_count_ = 0;
  std::unordered_map<const StoredPolyhedron*, PrimitiveIndex> known_;
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
