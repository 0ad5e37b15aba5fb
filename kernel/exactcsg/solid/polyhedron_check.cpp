// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/polyhedron_check.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "exactcsg/number/bucket_sort.hpp"
#include "exactcsg/solid/first_error.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

namespace {

constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

void require_known_vertices(const Polyhedron& polyhedron) {
  for (std::size_t f = 0; f < polyhedron.facets.size(); ++f) {
    for (const std::uint32_t v : polyhedron.facets[f]) {
      if (v < polyhedron.vertices.size()) continue;
      throw Error(ErrorId::UnknownVertex,
                  {"vertex " + std::to_string(v) + " in facet " + std::to_string(f),
                   "a number below " + std::to_string(polyhedron.vertices.size())});
    }
  }
}

// For every vertex the first one at the same place.
std::vector<std::uint32_t> representatives(const std::vector<Point3>& points, unsigned threads) {
  std::vector<std::array<double, 3>> rounded(points.size());
  in_parallel_parts(threads, points.size(), [&](std::size_t i) {
    rounded[i] = {nearest_double(points[i].x), nearest_double(points[i].y),
                  nearest_double(points[i].z)};
  });
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  // Rounding is monotone, so equal points have equal doubles; only ties of all three doubles are
  // ordered exactly.
  const auto key = [&](std::uint32_t v) { return rounded[v][0]; };
  const DoubleBuckets buckets(order, key, threads);
  sort_in_buckets(
      order, buckets.count(), [&](std::uint32_t v) { return buckets.of(key(v)); },
      [&](std::uint32_t a, std::uint32_t b) {
        if (rounded[a] != rounded[b]) return rounded[a] < rounded[b];
        const std::strong_ordering exact = compare(points[a], points[b]);
        return exact != 0 ? exact < 0 : a < b;
      },
      threads);
  std::vector<std::uint32_t> first(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t v = order[k];
    const bool same =
        k > 0 && rounded[order[k - 1]] == rounded[v] && points[order[k - 1]] == points[v];
    first[v] = same ? first[order[k - 1]] : v;
  }
  return first;
}

// Keeps the points that are listed, each once, in the order of the list. They are swapped into
// their places: moving a rational allocates.
void keep_in_order(std::vector<Point3>& points, const std::vector<std::uint32_t>& kept) {
  std::vector<std::uint32_t> place_of(points.size());  // of the points given
  std::iota(place_of.begin(), place_of.end(), 0U);
  std::vector<std::uint32_t> point_at = place_of;
  for (std::uint32_t place = 0; place < kept.size(); ++place) {
    const std::uint32_t from = place_of[kept[place]];
    if (from == place) continue;
    swap(points[place].x, points[from].x);
    swap(points[place].y, points[from].y);
    swap(points[place].z, points[from].z);
    const std::uint32_t displaced = point_at[place];
    point_at[from] = displaced;
    place_of[displaced] = from;
  }
  points.resize(kept.size());
}

// A projection in which the triangle keeps a non-zero area, if it has one.
bool find_projection(const PolyhedronSigns& signs, FacetFrame& frame) {
  const auto [a, b, c] = frame.corners;
  for (CoordinateIndex dropped = 0; dropped < 3; ++dropped) {
    const Sign sign = signs.turn(dropped, a, b, c);
    if (sign == Sign::Zero) continue;
    frame.dropped = dropped;
    frame.sign = sign;
    return true;
  }
  return false;
}

void check_repeated_vertices(const Polyhedron& polyhedron, std::size_t f, Facet& scratch) {
  const Facet& facet = polyhedron.facets[f];
  const bool is_triangle = facet.size() == 3;
  if (is_triangle && facet[0] != facet[1] && facet[1] != facet[2] && facet[2] != facet[0]) return;
  scratch = facet;
  std::sort(scratch.begin(), scratch.end());
  const auto twice = std::adjacent_find(scratch.begin(), scratch.end());
  if (twice == scratch.end()) return;
  throw Error(ErrorId::DegenerateFacet, {describe_facet(polyhedron, f) + ", which comes to " +
                                             describe(polyhedron.vertices[*twice]) + " twice",
                                         "distinct vertices"});
}

FacetFrame frame_of(const Polyhedron& polyhedron, const PolyhedronSigns& signs, std::size_t f) {
  const Facet& facet = polyhedron.facets[f];
  if (facet.size() < 3) {
    throw Error(ErrorId::DegenerateFacet,
                {describe_facet(polyhedron, f), "at least three vertices"});
  }
  FacetFrame frame;
  for (std::size_t k = 2; k < facet.size(); ++k) {
    frame.corners = {facet[0], facet[1], facet[k]};
    if (find_projection(signs, frame)) return frame;
  }
  throw Error(ErrorId::DegenerateFacet,
              {describe_facet(polyhedron, f) + ", which are in one line", "a positive area"});
}

void check_planar(const Polyhedron& polyhedron, const PolyhedronSigns& signs, std::size_t f,
                  const FacetFrame& frame) {
  const auto [a, b, c] = frame.corners;
  for (const std::uint32_t v : polyhedron.facets[f]) {
    if (v == a || v == b || v == c) continue;
    if (signs.orientation(a, b, c, v) == Sign::Zero) continue;
    throw Error(ErrorId::NonPlanarFacet,
                {describe_facet(polyhedron, f) + ", of which " + describe(polyhedron.vertices[v]) +
                     " is off the plane of " + describe(polyhedron.vertices[a]) + ", " +
                     describe(polyhedron.vertices[b]) + ", " + describe(polyhedron.vertices[c]),
                 "all vertices exactly in one plane"});
  }
}

// Every turn goes left, or straight on without turning back, and the walk goes round once: its
// direction changes between lexicographically up and down exactly twice.
void check_convex(const Polyhedron& polyhedron, const PolyhedronSigns& signs, std::size_t f,
                  const FacetFrame& frame) {
  const Facet& facet = polyhedron.facets[f];
  const std::size_t n = facet.size();
  if (n == 3) return;
  const CoordinateIndex i = (frame.dropped + 1) % 3;
  const CoordinateIndex j = (frame.dropped + 2) % 3;
  const auto direction = [&](std::size_t k) {
    const std::uint32_t a = facet[k % n];
    const std::uint32_t b = facet[(k + 1) % n];
    const Sign first = signs.compare(i, a, b);
    return first != Sign::Zero ? first : signs.compare(j, a, b);
  };
  int changes = 0;
  Sign before = direction(n - 1);
  for (std::size_t k = 0; k < n; ++k) {
    const Sign now = direction(k);
    const Sign turn =
        signs.turn(frame.dropped, facet[(k + n - 1) % n], facet[k], facet[(k + 1) % n]) *
        frame.sign;
    const bool turns_back = turn == Sign::Zero && now != before;
    if (now != before) ++changes;
    if (turn == Sign::Negative || turns_back) {
      throw Error(ErrorId::NonConvexFacet,
                  {describe_facet(polyhedron, f) + ", which turns inwards at " +
                       describe(polyhedron.vertices[facet[k]]),
                   "a convex polygon"});
    }
    before = now;
  }
  if (changes != 2) {
    throw Error(
        ErrorId::NonConvexFacet,
        {describe_facet(polyhedron, f) + ", which goes round more than once", "a convex polygon"});
  }
}

}  // namespace

std::string describe(const Point3& p) {
  return "(" + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + ")";
}

std::string describe_facet(const Polyhedron& polyhedron, std::size_t facet) {
  constexpr std::size_t shown = 6;
  const Facet& vertices = polyhedron.facets[facet];
  std::string text = "facet " + std::to_string(facet) + " with ";
  for (std::size_t k = 0; k < std::min(shown, vertices.size()); ++k) {
    if (k > 0) text += ", ";
    text += describe(polyhedron.vertices[vertices[k]]);
  }
  if (vertices.empty()) text += "no vertices";
  if (vertices.size() > shown) {
    text += " and " + std::to_string(vertices.size() - shown) + " more vertices";
  }
  return text;
}

Polyhedron with_distinct_vertices(Polyhedron polyhedron, unsigned threads) {
  require_known_vertices(polyhedron);
  const std::vector<std::uint32_t> first = representatives(polyhedron.vertices, threads);
  std::vector<std::uint32_t> renamed(polyhedron.vertices.size(), unused);
  std::vector<std::uint32_t> kept;
  for (Facet& facet : polyhedron.facets) {
    for (std::uint32_t& v : facet) {
      std::uint32_t& name = renamed[first[v]];
      if (name == unused) {
        name = static_cast<std::uint32_t>(kept.size());
        kept.push_back(first[v]);
      }
      v = name;
    }
  }
  keep_in_order(polyhedron.vertices, kept);
  return polyhedron;
}

std::vector<FacetFrame> check_facets(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                                     unsigned threads) {
  std::vector<FacetFrame> frames(polyhedron.facets.size());
  const Parts parts(frames.size());
  in_parallel_to_first_error(threads, parts.count(), [&](std::size_t part) {
    Facet scratch;
    for (std::size_t f = parts.begin(part); f < parts.end(part); ++f) {
      check_repeated_vertices(polyhedron, f, scratch);
      frames[f] = frame_of(polyhedron, signs, f);
      check_planar(polyhedron, signs, f, frames[f]);
      check_convex(polyhedron, signs, f, frames[f]);
    }
  });
  return frames;
}

std::vector<HalfEdge> half_edges(const Polyhedron& polyhedron, unsigned threads) {
  std::vector<HalfEdge> edges;
  std::size_t count = 0;
  for (const Facet& facet : polyhedron.facets) count += facet.size();
  edges.reserve(count);
  for (std::size_t f = 0; f < polyhedron.facets.size(); ++f) {
    const Facet& facet = polyhedron.facets[f];
    for (std::size_t k = 0; k < facet.size(); ++k) {
      const std::uint32_t a = facet[k];
      const std::uint32_t b = facet[k + 1 == facet.size() ? 0 : k + 1];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(f), a < b});
    }
  }
  sort_in_buckets(
      edges, polyhedron.vertices.size(), [](const HalfEdge& edge) { return edge.low; },
      [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.high, a.facet) < std::tie(b.high, b.facet);
      },
      threads);
  return edges;
}

void check_closed(const Polyhedron& polyhedron, const std::vector<HalfEdge>& edges) {
  if (polyhedron.facets.empty()) throw Error(ErrorId::OpenMesh, {"no facets", "a closed surface"});
  std::size_t unbalanced = 0;
  std::string first;
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin;
    std::size_t up = 0;
    while (end < edges.size() && edges[end].low == edges[begin].low &&
           edges[end].high == edges[begin].high) {
      if (edges[end].ascending) ++up;
      ++end;
    }
    const std::size_t down = end - begin - up;
    if (up != down) {
      if (unbalanced == 0) {
        const HalfEdge& e = edges[begin];
        first = "the edge from " + describe(polyhedron.vertices[e.low]) + " to " +
                describe(polyhedron.vertices[e.high]) + " is walked " + std::to_string(up) +
                " times forwards and " + std::to_string(down) + " times backwards (facet " +
                std::to_string(e.facet) + " has it)";
      }
      ++unbalanced;
    }
    begin = end;
  }
  if (unbalanced == 0) return;
  throw Error(ErrorId::OpenMesh, {std::to_string(unbalanced) + " unmatched edges; " + first,
                                  "each edge as often in one direction as in the other"});
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(const Polyhedron& polyhedron) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const Facet& facet : polyhedron.facets) {
    for (std::size_t k = 2; k < facet.size(); ++k) {
      triangles.push_back({facet[0], facet[k - 1], facet[k]});
    }
  }
  return triangles;
}

}  // namespace exactcsg
