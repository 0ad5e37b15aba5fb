// SPDX-License-Identifier: GPL-3.0-or-later
// How much two readings of one tree can differ, when every primitive is displaced a little.
//
// The result of Boolean operations changes only inside the union of the primitives' symmetric
// differences (a point that is in none of these has the same status in every primitive, hence in
// the tree), so volumes differ by at most the sum of the volumes of the symmetric differences.
//
// Convex polytopes with corners displaced by at most d: P' lies in P grown by d, and contains P
// eroded by d. By Steiner's formula, with area S, total edge length L and exterior angles of at
// most pi,
//   vol(P sym P') <= vol(P + dB) - vol(P - dB) <= 2 S d + (pi / 2) L d^2 + (4 pi / 3) d^3.
// Meshes with the same facets and displaced corners: the surface sweeps at most
//   d * sum over triangles of (area + (|e| + |f|) d + 2 d^2).
// Anything else: the exact symmetric difference is evaluated.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/verify/exact_sums.hpp"
#include "exactcsg/verify/facet_complex.hpp"
#include "exactcsg/verify/openscad.hpp"
#include "exactcsg/verify/plain_vector.hpp"

namespace exactcsg::verify {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double slack = 1 + 1e-9;  // of sums of doubles
constexpr std::size_t longest_leaf_list = 2'000'000;

using PrimitivePair = std::pair<const Primitive*, const Primitive*>;

// The leaves of two trees of the same form, in order, each pair of handles once for every
// occurrence. False: the trees differ in form.
bool pair_leaves(const Solid& a, const Solid& b, std::vector<PrimitivePair>& pairs) {
  std::vector<std::pair<const Solid*, const Solid*>> pending{{&a, &b}};
  while (!pending.empty()) {
    const auto [p, q] = pending.back();
    pending.pop_back();
    if (p->kind() != q->kind() || pairs.size() > longest_leaf_list) return false;
    if (p->is_primitive()) {
      pairs.push_back({&p->primitive(), &q->primitive()});
    } else if (p->is_compose()) {
      const auto left = p->children();
      const auto right = q->children();
      if (p->operation() != q->operation() || left.size() != right.size()) return false;
      for (std::size_t i = 0; i < left.size(); ++i) pending.push_back({&left[i], &right[i]});
    }
  }
  return true;
}

double distance(const Point3& p, const Point3& q) {
  // The difference is exact before it is rounded: displacements are far below the coordinates'
  // noise.
  return length(approximate(Point3{p.x - q.x, p.y - q.y, p.z - q.z}));
}

std::vector<PlainVector> positions_of(const StoredPolyhedron& polyhedron) {
  std::vector<PlainVector> result;
  for (const Point3& p : polyhedron.vertices) result.push_back(approximate(p));
  return result;
}

// The largest distance of a vertex of `from` to the nearest vertex of `to`.
double one_sided_distance(const StoredPolyhedron& from, const StoredPolyhedron& to) {
  const auto candidates = positions_of(to);
  double largest = 0;
  for (const Point3& p : from.vertices) {
    const PlainVector at = approximate(p);
    std::size_t best = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i) {
      if (length(candidates[i] - at) < length(candidates[best] - at)) best = i;
    }
    largest = std::max(largest, distance(p, to.vertices[best]));
  }
  return largest;
}

double paired_distance(const StoredPolyhedron& a, const StoredPolyhedron& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    largest = std::max(largest, distance(a.vertices[i], b.vertices[i]));
  }
  return largest;
}

struct Sizes {
  double area = 0;
  double perimeters = 0;  // of all facets: twice the total edge length
  double sides = 0;       // of the fan triangles: sum of |e| + |f|
  std::size_t triangles = 0;
};

Sizes sizes_of(const StoredPolyhedron& polyhedron) {
  const auto at = positions_of(polyhedron);
  Sizes sizes;
  for (const auto facet : polyhedron.facets) {
    for (std::size_t i = 0; i < facet.size(); ++i) {
      sizes.perimeters += length(at[facet[(i + 1) % facet.size()]] - at[facet[i]]);
    }
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      const PlainVector e = at[facet[i]] - at[facet[0]];
      const PlainVector f = at[facet[i + 1]] - at[facet[0]];
      sizes.area += 0.5 * length(cross(e, f));
      sizes.sides += length(e) + length(f);
      ++sizes.triangles;
    }
  }
  return sizes;
}

struct Contribution {
  double volume = 0;
  double displacement = 0;
};

Contribution convex_contribution(const StoredPolyhedron& a, const StoredPolyhedron& b) {
  const double d = std::max(one_sided_distance(a, b), one_sided_distance(b, a)) * slack;
  const Sizes sizes = sizes_of(a);
  return {2 * sizes.area * d + pi / 4 * sizes.perimeters * d * d + 4 * pi / 3 * d * d * d, d};
}

Contribution mesh_contribution(const StoredPolyhedron& a, const StoredPolyhedron& b) {
  const double d = paired_distance(a, b) * slack;
  const Sizes sizes = sizes_of(a);
  return {d * (sizes.area + sizes.sides * d + 2 * static_cast<double>(sizes.triangles) * d * d), d};
}

Contribution evaluated_contribution(const Primitive& a, const Primitive& b) {
  const Solid both = Solid::compose(csg::BooleanOperator::SymmetricDifference,
                                    {Solid::primitive(a), Solid::primitive(b)});
  const Boundary boundary = evaluate(both);
  std::vector<OrientedFace> faces;
  for (const BoundaryFace& face : boundary.faces) faces.push_back({&face.loops, 1});
  const VolumeSum volume = sum_volume(to_vector(boundary.vertices), faces);
  const Rational value = volume.exact ? *volume.exact : *parse_rational(volume.decimal);
  return {nearest_double(value), 0};
}

Contribution contribution(const Primitive& a, const Primitive& b) {
  const StoredPolyhedron* p = polyhedron_of(a);
  const StoredPolyhedron* q = polyhedron_of(b);
  if (p == nullptr || q == nullptr) return evaluated_contribution(a, b);
  if (p == q) return {};
  const bool convex = std::holds_alternative<ConvexPolytope>(a.shape) &&
                      std::holds_alternative<ConvexPolytope>(b.shape);
  if (convex) return convex_contribution(*p, *q);
  if (p->vertices.size() == q->vertices.size() && p->facets == q->facets) {
    return mesh_contribution(*p, *q);
  }
  return evaluated_contribution(a, b);
}

}  // namespace

std::optional<DisplacementBound> displacement_bound(const Solid& as_written, const Solid& gridded) {
  std::vector<PrimitivePair> pairs;
  if (!pair_leaves(as_written, gridded, pairs)) return std::nullopt;
  DisplacementBound bound;
  double sum = 0;
  for (const auto& [a, b] : pairs) {
    const Contribution part = contribution(*a, *b);
    if (part.volume > 0) ++bound.moved_primitives;
    sum += part.volume;
    bound.largest_displacement = std::max(bound.largest_displacement, part.displacement);
  }
  bound.volume = rational_of(sum * slack);
  return bound;
}

}  // namespace exactcsg::verify
