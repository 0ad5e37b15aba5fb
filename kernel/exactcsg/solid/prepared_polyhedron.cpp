// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/prepared_polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "exactcsg/solid/polyhedron_signs.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

FlatFacets::FlatFacets(std::span<const Facet> facets) {
  auto rows = std::make_shared<Rows>();
  rows->begins.reserve(facets.size() + 1);
  rows->begins.push_back(0);
  std::size_t count = 0;
  for (const Facet& facet : facets) {
    count += facet.size();
    rows->begins.push_back(static_cast<std::uint32_t>(count));
  }
  rows->corners.reserve(count);
  for (const Facet& facet : facets) {
    rows->corners.insert(rows->corners.end(), facet.begin(), facet.end());
  }
  rows_ = std::move(rows);
}

bool operator==(const FlatFacets& a, const FlatFacets& b) {
  return std::ranges::equal(a.begins(), b.begins()) && std::ranges::equal(a.corners(), b.corners());
}

Polyhedron to_polyhedron(const StoredPolyhedron& polyhedron) {
  Polyhedron result{to_vector(polyhedron.vertices), {}};
  result.facets.reserve(polyhedron.facets.size());
  for (const auto facet : polyhedron.facets) result.facets.emplace_back(facet.begin(), facet.end());
  return result;
}

namespace {

constexpr double largest_coordinate = 1e290;

// Of a few well-spread triples of corners the one that spans most: it conditions the plane best.
// `near` are the vertices, rounded.
Triple spanning_triple(std::span<const Point3> vertices, const std::vector<HashedPoint>& near,
                       std::span<const std::uint32_t> facet) {
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
  Triple best{0, 1, 2};
  double widest = -1;
  const std::uint32_t tried = std::min<std::uint32_t>(count, 4);
  for (std::uint32_t i = 0; i < tried; ++i) {
    Triple triple{i, (i + count / 3) % count, (i + 2 * count / 3) % count};
    std::sort(triple.begin(), triple.end());
    const double span = span_of(triple[0], triple[1], triple[2]);
    if (span > widest) {
      widest = span;
      best = triple;
    }
  }
  // Corners in the middle of straight sides may make every tried triple collinear.
  const auto corner = [&](std::uint32_t i) -> const Point3& { return vertices[facet[i]]; };
  for (std::uint32_t k = 2; !(widest > 0) && k < count; ++k) {
    if (cross(corner(1) - corner(0), corner(k) - corner(0)) != Vector3{}) {
      best = {0, 1, k};
      break;
    }
  }
  return {facet[best[0]], facet[best[1]], facet[best[2]]};
}

// Where the side ends that begins at this corner of this facet.
std::uint32_t end_of_side(const FlatFacets& facets, std::uint32_t facet, std::uint32_t side) {
  const std::span<const std::uint32_t> begins = facets.begins();
  return facets.corners()[side + 1 == begins[facet + 1] ? begins[facet] : side + 1];
}

// Of every side the first one that walks the same edge the other way. A side has the number of the
// corner where it begins.
// THROWS Error(InternalError) if there is none.
// COST: O(n) if few sides leave a vertex, else O(n log n)
std::vector<std::uint32_t> opposite_sides(const FlatFacets& facets, std::size_t vertex_count,
                                          unsigned threads) {
  struct Leaving {
    std::uint32_t to;
    std::uint32_t side;
  };
  const auto comes_before = [](const Leaving& a, const Leaving& b) {
    return a.to != b.to ? a.to < b.to : a.side < b.side;
  };
  const std::span<const std::uint32_t> corners = facets.corners();
  const std::span<const std::uint32_t> begins = facets.begins();
  const auto count = static_cast<std::uint32_t>(corners.size());
  // Of the sides that leave a vertex. Counted two places further on, so that each place is where
  // the row before ends once all are filled.
  std::vector<std::uint32_t> begin(vertex_count + 2, 0);
  for (const std::uint32_t from : corners) ++begin[from + 2];
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<Leaving> leaving(count);
  std::vector<std::uint32_t> ends(count);
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    for (std::uint32_t side = begins[f]; side < begins[f + 1]; ++side) {
      ends[side] = end_of_side(facets, f, side);
      leaving[begin[corners[side] + 1]++] = {ends[side], side};
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
    const std::uint32_t back_to = corners[side];
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

std::vector<std::uint32_t> facets_of_sides(const FlatFacets& facets) {
  std::vector<std::uint32_t> result;
  result.reserve(facets.corners().size());
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    result.resize(facets.begins()[f + 1], f);
  }
  return result;
}

NearPoint near_point(std::span<const Point3> vertices, const PreparedPolyhedron& known,
                     std::uint32_t v) {
  return {vertices[v], known.points[v].near};
}

PreparedPlane plane_through_corners(std::span<const Point3> vertices,
                                    const PreparedPolyhedron& known, const Triple& triple) {
  return prepared_plane(near_point(vertices, known, triple[0]),
                        near_point(vertices, known, triple[1]),
                        near_point(vertices, known, triple[2]));
}

PreparedPlane plane_across_side(std::span<const Point3> vertices, const PreparedPolyhedron& known,
                                const PlaneAcross& across) {
  return prepared_plane(near_point(vertices, known, across.from),
                        near_point(vertices, known, across.to), across.axis);
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
  // REQUIRES the triples of all facets, and the points of `known`, whose planes are filled in
  MeshPlanes(std::span<const Point3> vertices, FacetPlanes& kind, PreparedPolyhedron& known,
             unsigned threads)
      : kind_(kind),
        known_(known),
        threads_(threads),
        vertices_(vertices),
        opposite_(opposite_sides(kind.facets, vertices.size(), threads)),
        facets_(facets_of_sides(kind.facets)) {}

  void find() {
    planes_.resize(kind_.triples.size());
    in_parallel_parts(threads_, planes_.size(), [&](std::size_t f) {
      planes_[f] = plane_through_corners(vertices_, known_, kind_.triples[f]);
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
    is_flat_.resize(kind_.facets.corners().size());
    // First those of which doubles do not tell that they are not.
    in_parallel_parts(threads_, is_flat_.size(), [&](std::size_t side) {
      const auto i = static_cast<std::uint32_t>(side);
      is_flat_[side] = was_seen_from_there(i) ? 0 : may_be_flat(i);
    });
    if (std::ranges::find(is_flat_, 1) == is_flat_.end()) return;
    const PolyhedronSigns signs(vertices_);
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
    const auto own = kind_.facets[facets_[side]];
    const auto corners = kind_.facets[neighbour(side)];
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
    const std::span<const std::uint32_t> begins = kind_.facets.begins();
    for (std::uint32_t side = begins[facet]; side < begins[facet + 1]; ++side) {
      const std::uint32_t other = neighbour(side);
      if (is_flat_[side] != 0 && other < facet && look_the_same_way(facet, other)) return other;
    }
    return facet;
  }

  // Coplanar facets that no neighbours connect keep planes of their own; the Geometry finds them.
  void keep_planes() {
    kind_.of_facets.resize(kind_.facet_count());
    known_.planes.reserve(kind_.facet_count());
    std::uint32_t kept = 0;
    for (std::uint32_t f = 0; f < kind_.facet_count(); ++f) {
      if (const std::uint32_t other = facet_with_plane_of(f); other != f) {
        kind_.of_facets[f] = kind_.of_facets[other];
        continue;
      }
      known_.planes.push_back(std::move(planes_[f]));
      kind_.triples[kept] = kind_.triples[f];
      kind_.of_facets[f] = kept++;
    }
    kind_.triples.resize(kept);
  }

  void set_side_planes() {
    kind_.of_sides.resize(kind_.facets.corners().size());
    in_parallel_parts(threads_, kind_.of_sides.size(), [&](std::size_t i) {
      const auto side = static_cast<std::uint32_t>(i);
      if (is_flat_[side] == 0) kind_.of_sides[side] = kind_.of_facets[neighbour(side)];
    });
    for (std::uint32_t side = 0; side < kind_.of_sides.size(); ++side) {
      if (is_flat_[side] != 0) kind_.of_sides[side] = plane_across(side);
    }
  }

  std::uint32_t plane_across(std::uint32_t side) {
    if (was_seen_from_there(side)) return kind_.of_sides[opposite_[side]];
    const std::uint32_t facet = facets_[side];
    const std::uint32_t from = kind_.facets.corners()[side];
    const std::uint32_t to = end_of_side(kind_.facets, facet, side);
    const Axis axis = steepest_axis(planes_[facet].near);
    known_.planes.push_back(plane_across_side(vertices_, known_, {from, to, axis}));
    kind_.across.push_back({from, to, axis});
    return kind_.plane_count() - 1;
  }

  FacetPlanes& kind_;
  PreparedPolyhedron& known_;
  unsigned threads_;
  std::span<const Point3> vertices_;
  std::vector<std::uint32_t> opposite_;
  std::vector<std::uint32_t> facets_;   // of sides
  std::vector<PreparedPlane> planes_;   // of facets
  std::vector<unsigned char> is_flat_;  // sides: the neighbour lies in the same plane
};

std::vector<Triple> spanning_triples(std::span<const Point3> vertices,
                                     const std::vector<HashedPoint>& near, const FlatFacets& facets,
                                     unsigned threads) {
  std::vector<Triple> result(facets.size());
  in_parallel_parts(threads, result.size(),
                    [&](std::size_t f) { result[f] = spanning_triple(vertices, near, facets[f]); });
  return result;
}

// The planes of a polyhedron whose planes are known to be those of `known.facets`. A triple that
// spans well in one image need not do so in another.
void set_planes(std::span<const Point3> vertices, PreparedPolyhedron& known, unsigned threads) {
  // Of a normal: well-conditioned ones are known better.
  constexpr double good = 0x1p-44;
  const FacetPlanes& kind = *known.facets;
  known.planes.resize(kind.plane_count());
  std::vector<Triple> triples = kind.triples;
  in_parallel_parts(threads, triples.size(), [&](std::size_t p) {
    Triple& triple = triples[p];
    std::optional<PreparedPlane> plane = quickly_prepared_plane(
        near_point(vertices, known, triple[0]), near_point(vertices, known, triple[1]),
        near_point(vertices, known, triple[2]));
    if (!plane || plane->near.normal_error > good) {
      if (kind.convex) triple = spanning_triple(vertices, known.points, kind.facets[p]);
      plane = plane_through_corners(vertices, known, triple);
    }
    known.planes[p] = *std::move(plane);
  });
  if (triples != kind.triples) known.own_triples = std::move(triples);
  for (std::size_t i = 0; i < kind.across.size(); ++i) {
    known.planes[kind.triples.size() + i] = plane_across_side(vertices, known, kind.across[i]);
  }
}

std::vector<HashedPoint> hashed_points(std::span<const Point3> vertices, unsigned threads) {
  std::vector<HashedPoint> result(vertices.size());
  in_parallel_parts(threads, result.size(),
                    [&](std::size_t v) { result[v] = hashed(vertices[v]); });
  return result;
}

// Sets the bounds. Returns false if a coordinate is beyond the largest one.
bool set_bounds(PreparedPolyhedron& known) {
  for (const HashedPoint& point : known.points) {
    const std::array<double, 3> coordinates{point.near.x, point.near.y, point.near.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = coordinates[axis];
      if (!(std::abs(value) <= largest_coordinate && point.near.error <= largest_coordinate)) {
        return false;
      }
      known.bounds[axis].lower = std::min(known.bounds[axis].lower, value);
      known.bounds[axis].upper = std::max(known.bounds[axis].upper, value);
    }
  }
  return true;
}

// The polyhedron with these facets, but for its planes; null if it has none, being too far away.
std::shared_ptr<PreparedPolyhedron> with_points(std::vector<HashedPoint> points) {
  auto known = std::make_shared<PreparedPolyhedron>();
  known->points = std::move(points);
  return set_bounds(*known) ? known : nullptr;
}

std::shared_ptr<const StoredPolyhedron> stored(std::span<const Point3> vertices,
                                               const FlatFacets& facets,
                                               std::shared_ptr<const PreparedPolyhedron> known) {
  return std::make_shared<const StoredPolyhedron>(
      StoredPolyhedron{ExactPoints(vertices), facets, std::move(known)});
}

std::shared_ptr<const FacetPlanes> planes_of_polytope(const Polyhedron& polyhedron,
                                                      const std::vector<HashedPoint>& points) {
  auto planes = std::make_shared<FacetPlanes>();
  planes->facets = FlatFacets(polyhedron.facets);
  planes->triples = spanning_triples(polyhedron.vertices, points, planes->facets, 1);
  // Neighbours of a convex polytope are not coplanar.
  const std::vector<std::uint32_t> facets = facets_of_sides(planes->facets);
  planes->of_sides = opposite_sides(planes->facets, polyhedron.vertices.size(), 1);
  for (std::uint32_t& side : planes->of_sides) side = facets[side];
  return planes;
}

std::shared_ptr<const StoredPolyhedron> store_with_planes(
    std::span<const Point3> vertices, std::vector<HashedPoint> points,
    const std::shared_ptr<const FacetPlanes>& planes, unsigned threads) {
  const std::shared_ptr<PreparedPolyhedron> known = with_points(std::move(points));
  if (known) {
    known->facets = planes;
    set_planes(vertices, *known, threads);
  }
  return stored(vertices, planes->facets, known);
}

}  // namespace

ConvexFacets::ConvexFacets(const Polyhedron& polyhedron)
    : planes_(planes_of_polytope(polyhedron, hashed_points(polyhedron.vertices, 1))) {}

const FlatFacets& ConvexFacets::facets() const { return planes_->facets; }

std::shared_ptr<const StoredPolyhedron> store_polytope(const Polyhedron& polyhedron) {
  std::vector<HashedPoint> points = hashed_points(polyhedron.vertices, 1);
  const std::shared_ptr<const FacetPlanes> planes = planes_of_polytope(polyhedron, points);
  return store_with_planes(polyhedron.vertices, std::move(points), planes, 1);
}

std::shared_ptr<const StoredPolyhedron> store_mesh(const Polyhedron& polyhedron, unsigned threads) {
  const std::span<const Point3> vertices = polyhedron.vertices;
  const FlatFacets facets(polyhedron.facets);
  const std::shared_ptr<PreparedPolyhedron> known = with_points(hashed_points(vertices, threads));
  if (known) {
    auto planes = std::make_shared<FacetPlanes>();
    planes->facets = facets;
    planes->convex = false;
    planes->triples = spanning_triples(vertices, known->points, facets, threads);
    MeshPlanes(vertices, *planes, *known, threads).find();
    known->facets = std::move(planes);
  }
  return stored(vertices, facets, known);
}

std::shared_ptr<const StoredPolyhedron> store_image(
    std::span<const Point3> vertices, const std::shared_ptr<const FacetPlanes>& planes,
    unsigned threads) {
  return store_with_planes(vertices, hashed_points(vertices, threads), planes, threads);
}

}  // namespace exactcsg
