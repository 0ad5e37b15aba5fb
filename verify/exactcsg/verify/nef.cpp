// SPDX-License-Identifier: GPL-3.0-or-later
// The only file that sees CGAL::Nef_polyhedron_3 (it takes most of a minute to compile).
#include "exactcsg/verify/nef.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Surface_mesh.h>
#include <gmpxx.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "exactcsg/support/error.hpp"

namespace exactcsg::verify {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using ExactNumber = Number::ET;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

// CGAL's exact rational is mpq_class, Gmpq or Boost's, as CGAL was configured.
template <class Exact>
Exact exact_of(const Rational& value) {
  if constexpr (std::is_same_v<Exact, mpq_class>) {
    return value;
  } else {
    return Exact(value.get_mpq_t());
  }
}

template <class Exact>
Rational rational_of_exact(const Exact& exact) {
  if constexpr (std::is_same_v<Exact, mpq_class>) {
    return exact;
  } else if constexpr (requires { exact.mpq(); }) {
    return Rational(mpq_class(exact.mpq()));
  } else {
    return Rational(mpq_class(exact.backend().data()));
  }
}

Number to_cgal(const Rational& value) { return Number(exact_of<ExactNumber>(value)); }
Rational from_cgal(const Number& value) { return rational_of_exact<ExactNumber>(value.exact()); }

Kernel::Point_3 to_cgal(const Point3& p) { return {to_cgal(p.x), to_cgal(p.y), to_cgal(p.z)}; }

// ---- primitives -------------------------------------------------------------------------------

using Facets = std::vector<Facet>;

// Equal coordinates get one index.
Polyhedron weld(const Polyhedron& polyhedron) {
  const auto less = [](const Point3& p, const Point3& q) { return compare(p, q) < 0; };
  std::map<Point3, std::uint32_t, decltype(less)> known(less);
  Polyhedron result;
  std::vector<std::uint32_t> index;
  for (const Point3& p : polyhedron.vertices) {
    const auto [found, added] =
        known.try_emplace(p, static_cast<std::uint32_t>(result.vertices.size()));
    if (added) result.vertices.push_back(p);
    index.push_back(found->second);
  }
  for (const Facet& facet : polyhedron.facets) {
    Facet mapped;
    for (const std::uint32_t v : facet) mapped.push_back(index[v]);
    result.facets.push_back(std::move(mapped));
  }
  return result;
}

// The groups of facets that hang together by edges.
std::vector<Facets> shells_of(const Facets& facets) {
  std::vector<std::size_t> parent(facets.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::array<std::uint32_t, 2>, std::size_t> first;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (std::size_t i = 0; i < facets[f].size(); ++i) {
      const auto [a, b] = std::minmax(facets[f][i], facets[f][(i + 1) % facets[f].size()]);
      const auto [found, added] = first.try_emplace({a, b}, f);
      if (!added) parent[root(f)] = root(found->second);
    }
  }
  std::map<std::size_t, Facets> groups;
  for (std::size_t f = 0; f < facets.size(); ++f) groups[root(f)].push_back(facets[f]);
  std::vector<Facets> shells;
  for (auto& [name, group] : groups) shells.push_back(std::move(group));
  return shells;
}

Rational six_volume(const Polyhedron& points, const Facets& facets) {
  Rational sum = 0;
  const auto vector = [&](std::uint32_t i) { return points.vertices[i] - Point3{0, 0, 0}; };
  for (const Facet& facet : facets) {
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      sum += dot(vector(facet[0]), cross(vector(facet[i]), vector(facet[i + 1])));
    }
  }
  return sum;
}

// The region enclosed by a shell whose every edge has two facets and whose every vertex one fan of
// them; nullopt if it is no such shell.
std::optional<Nef> fill_manifold(const Polyhedron& points, const Facets& facets) {
  Mesh mesh;
  std::unordered_map<std::uint32_t, Mesh::Vertex_index> index;
  const bool inverted = six_volume(points, facets) < 0;
  for (const Facet& facet : facets) {
    std::vector<Mesh::Vertex_index> corners;
    for (const std::uint32_t v : facet) {
      auto found = index.find(v);
      if (found == index.end()) {
        found = index.emplace(v, mesh.add_vertex(to_cgal(points.vertices[v]))).first;
      }
      corners.push_back(found->second);
    }
    if (inverted) std::reverse(corners.begin(), corners.end());
    if (mesh.add_face(corners) == Mesh::null_face()) return std::nullopt;
  }
  // add_face accepts several fans at a vertex as long as they are open: count the closed ones.
  std::vector<std::size_t> valence(mesh.number_of_vertices(), 0);
  for (const auto h : mesh.halfedges()) {
    if (mesh.is_border(h)) return std::nullopt;
    ++valence[mesh.target(h)];
  }
  for (const auto v : mesh.vertices()) {
    if (mesh.degree(v) != valence[v]) return std::nullopt;
  }
  return Nef(mesh);
}

// A pyramid over a convex facet; nullopt if the apex lies in its plane.
std::optional<Nef> pyramid(const Polyhedron& points, const Facet& facet, const Point3& apex) {
  const Point3& p = points.vertices[facet[0]];
  Sign sense = Sign::Zero;
  for (std::size_t i = 1; i + 1 < facet.size() && sense == Sign::Zero; ++i) {
    sense = sign_of(
        dot(cross(points.vertices[facet[i]] - p, points.vertices[facet[i + 1]] - p), apex - p));
  }
  if (sense == Sign::Zero) return std::nullopt;
  Mesh mesh;
  std::vector<Mesh::Vertex_index> base;
  for (const std::uint32_t v : facet) base.push_back(mesh.add_vertex(to_cgal(points.vertices[v])));
  if (sense == Sign::Positive) std::reverse(base.begin(), base.end());
  const auto top = mesh.add_vertex(to_cgal(apex));
  mesh.add_face(base);
  for (std::size_t i = 0; i < base.size(); ++i) {
    mesh.add_face(base[(i + 1) % base.size()], base[i], top);
  }
  return Nef(mesh);
}

template <class Operation>
Nef fold_balanced(std::vector<Nef> parts, Operation operation) {
  while (parts.size() > 1) {
    std::vector<Nef> next;
    for (std::size_t i = 0; i < parts.size(); i += 2) {
      next.push_back(i + 1 < parts.size() ? operation(parts[i], parts[i + 1])
                                          : std::move(parts[i]));
    }
    parts = std::move(next);
  }
  return parts.empty() ? Nef(Nef::EMPTY) : std::move(parts.front());
}

Nef symmetric_difference(const Nef& a, const Nef& b) { return (a ^ b).regularization(); }

// Any closed oriented surface: a point is enclosed iff it lies in an odd number of the pyramids
// that join the facets to one vertex.
Nef fill_by_parity(const Polyhedron& points, const Facets& facets) {
  const Point3& apex = points.vertices[facets.front().front()];
  std::vector<Nef> parts;
  for (const Facet& facet : facets) {
    if (auto part = pyramid(points, facet, apex)) parts.push_back(std::move(*part));
  }
  return fold_balanced(std::move(parts), symmetric_difference);
}

Nef nef_of(const Polyhedron& polyhedron) {
  const Polyhedron welded = weld(polyhedron);
  std::vector<Nef> shells;
  for (const Facets& shell : shells_of(welded.facets)) {
    auto filled = fill_manifold(welded, shell);
    shells.push_back(filled ? std::move(*filled) : fill_by_parity(welded, shell));
  }
  return fold_balanced(std::move(shells), symmetric_difference);
}

Nef nef_of_box(const Point3& lower, const Point3& upper) {
  return nef_of(to_polyhedron(*make_box(lower, upper).polyhedron));
}

// ---- half-spaces ------------------------------------------------------------------------------

void raise(Integer& largest, const Integer& value) {
  if (mpz_cmpabs(value.get_mpz_t(), largest.get_mpz_t()) > 0) largest = abs(value);
}

// By Cramer's rule every meeting point of three planes with integer coefficients has coordinates of
// at most 6 m^2 d in magnitude.
struct LargestCoefficients {
  Integer normal = 1;
  Integer offset = 1;
  void add(const Plane& plane) {
    raise(normal, plane.a);
    raise(normal, plane.b);
    raise(normal, plane.c);
    raise(offset, plane.d);
  }
  Rational box() const { return Rational(6 * normal * normal * offset + 1); }
};

void add_planes(const Polyhedron& polyhedron, LargestCoefficients& largest) {
  for (const Facet& facet : polyhedron.facets) {
    const Point3& p = polyhedron.vertices[facet[0]];
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      const Vector3 n =
          cross(polyhedron.vertices[facet[i]] - p, polyhedron.vertices[facet[i + 1]] - p);
      if (n == Vector3{0, 0, 0}) continue;
      largest.add(make_plane(n.x, n.y, n.z, -(n.x * p.x + n.y * p.y + n.z * p.z)));
      break;
    }
  }
}

// A block with one side in the plane that covers the half-space inside the box [-box, box]^3.
Nef nef_of_half_space(const Plane& plane, const Rational& box) {
  const Vector3 n{Rational(plane.a), Rational(plane.b), Rational(plane.c)};
  // Orthogonal integer directions in the plane; each at least one long.
  const Vector3 u = plane.a == 0 && plane.b == 0 ? Vector3{1, 0, 0} : Vector3{n.y, -n.x, 0};
  const Vector3 v = cross(n, u);
  const Rational scale = -Rational(plane.d) / dot(n, n);
  const Point3 foot{n.x * scale, n.y * scale, n.z * scale};
  const Rational reach = 4 * (box + abs(foot.x) + abs(foot.y) + abs(foot.z));  // 4 > 2 sqrt 3
  Polyhedron block;
  for (const int depth : {1, 0}) {
    for (const auto& [s, t] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      block.vertices.push_back(foot + Rational(reach * s) * u + Rational(reach * t) * v +
                               Rational(-reach * depth) * n);
    }
  }
  block.facets = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4},
                  {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return nef_of(block);
}

// ---- the tree ---------------------------------------------------------------------------------

struct Bounds {
  bool needed = false;  // half-spaces or Full occur
  Rational box = 1;
};

Bounds bounds_of(const Solid& solid) {
  Bounds bounds;
  LargestCoefficients largest;
  std::set<const void*> seen;
  std::vector<const Solid*> pending{&solid};
  while (!pending.empty()) {
    const Solid* node = pending.back();
    pending.pop_back();
    if (node->is_full()) bounds.needed = true;
    if (node->is_empty() || node->is_full() || !seen.insert(node->identity()).second) continue;
    if (node->is_primitive()) {
      const Primitive& primitive = node->primitive();
      if (const auto* half = std::get_if<HalfSpace>(&primitive.shape)) {
        bounds.needed = true;
        largest.add(half->plane);
      } else {
        add_planes(to_polyhedron(*polyhedron_of(primitive)), largest);
      }
      continue;
    }
    for (const Solid& child : node->children()) pending.push_back(&child);
  }
  bounds.box = largest.box();
  return bounds;
}

Nef nef_of(const Primitive& primitive, const Bounds& bounds) {
  if (const auto* half = std::get_if<HalfSpace>(&primitive.shape)) {
    return nef_of_half_space(half->plane, bounds.box);
  }
  return nef_of(to_polyhedron(*polyhedron_of(primitive)));
}

Nef combine(csg::BooleanOperator operation, std::vector<Nef> operands) {
  const auto unite = [](const Nef& a, const Nef& b) { return a + b; };
  switch (operation) {
    case csg::BooleanOperator::Union:
      return fold_balanced(std::move(operands), unite);
    case csg::BooleanOperator::Intersection:
      return fold_balanced(std::move(operands), [](const Nef& a, const Nef& b) { return a * b; });
    case csg::BooleanOperator::Difference: {
      if (operands.size() == 1) return operands.front();
      const Nef first = operands.front();
      operands.erase(operands.begin());
      return (first - fold_balanced(std::move(operands), unite)).closure();
    }
    case csg::BooleanOperator::SymmetricDifference:
      return fold_balanced(std::move(operands), symmetric_difference);
  }
  return Nef(Nef::EMPTY);
}

Nef nef_of(const Solid& solid, const Bounds& bounds) {
  const Point3 low{-bounds.box, -bounds.box, -bounds.box};
  const Point3 high{bounds.box, bounds.box, bounds.box};
  std::unordered_map<const void*, Nef> shared;
  struct Frame {
    const Solid* node;
    std::size_t next;
  };
  std::vector<Frame> stack{{&solid, 0}};
  std::vector<Nef> results;
  while (!stack.empty()) {
    Frame& frame = stack.back();
    const Solid* const node = frame.node;
    const auto known = shared.find(node->identity());
    if (frame.next == 0 && !node->is_empty() && known != shared.end()) {
      results.push_back(known->second);
      stack.pop_back();
      continue;
    }
    if (node->is_compose() && frame.next < node->children().size()) {
      const Solid* const child = &node->children()[frame.next++];
      stack.push_back({child, 0});
      continue;
    }
    if (node->is_empty()) {
      results.emplace_back(Nef::EMPTY);
    } else if (node->is_full()) {
      results.push_back(nef_of_box(low, high));
    } else if (node->is_primitive()) {
      results.push_back(nef_of(node->primitive(), bounds));
    } else {
      const auto first = results.end() - static_cast<std::ptrdiff_t>(node->children().size());
      std::vector<Nef> operands(first, results.end());
      results.erase(first, results.end());
      results.push_back(combine(node->operation(), std::move(operands)));
    }
    if (!node->is_empty()) shared.emplace(node->identity(), results.back());
    stack.pop_back();
  }
  Nef result = results.back();
  if (bounds.needed) result = result * nef_of_box(low, high);
  return result.regularization();
}

// ---- out again --------------------------------------------------------------------------------

FacetComplex complex_of(const Nef& nef) {
  FacetComplex complex;
  std::map<const void*, std::uint32_t> index;
  const auto vertex = [&](Nef::Vertex_const_handle v) {
    const auto [found, added] =
        index.try_emplace(&*v, static_cast<std::uint32_t>(complex.vertices.size()));
    if (added) {
      const auto& p = v->point();
      complex.vertices.push_back({from_cgal(p.x()), from_cgal(p.y()), from_cgal(p.z())});
    }
    return found->second;
  };
  for (auto f = nef.halffacets_begin(); f != nef.halffacets_end(); ++f) {
    // A facet's plane is positive towards its volume: the outer halffacet has the outward normal.
    if (f->incident_volume()->mark() || !f->twin()->incident_volume()->mark()) continue;
    OracleFacet facet;
    const auto& plane = f->plane();
    facet.plane = make_plane(from_cgal(plane.a()), from_cgal(plane.b()), from_cgal(plane.c()),
                             from_cgal(plane.d()));
    for (auto c = f->facet_cycles_begin(); c != f->facet_cycles_end(); ++c) {
      if (!c.is_shalfedge()) continue;
      facet.cycles.emplace_back();
      const Nef::SHalfedge_const_handle start(c);
      Nef::SHalfedge_around_facet_const_circulator edge(start);
      const auto end = edge;
      do {
        facet.cycles.back().push_back(vertex(edge->source()->center_vertex()));
      } while (++edge != end);
    }
    complex.facets.push_back(std::move(facet));
  }
  return complex;
}

PointClass locate(const Nef& nef, const Point3& point) {
  const auto object = nef.locate(to_cgal(point));
  Nef::Volume_const_handle volume;
  if (!CGAL::assign(volume, object)) return PointClass::On;  // on a facet, an edge or a vertex
  return volume->mark() ? PointClass::In : PointClass::Out;
}

void check_bounded(const FacetComplex& complex, const Bounds& bounds) {
  if (!bounds.needed) return;
  for (const Point3& p : complex.vertices) {
    if (abs(p.x) == bounds.box || abs(p.y) == bounds.box || abs(p.z) == bounds.box) {
      throw Error(ErrorId::UnboundedSolid, {"the Nef polyhedron reaches its box", ""});
    }
  }
}

}  // namespace

NefResult evaluate_nef(const Solid& solid, std::span<const Point3> points) {
  try {
    const Bounds bounds = bounds_of(solid);
    const Nef nef = nef_of(solid, bounds);
    NefResult result;
    result.complex = complex_of(nef);
    check_bounded(result.complex, bounds);
    for (const Point3& p : points) result.classes.push_back(locate(nef, p));
    return result;
  } catch (const CGAL::Failure_exception& e) {
    throw Error(ErrorId::OracleFailed, {e.what(), "a Nef polyhedron"});
  }
}

}  // namespace exactcsg::verify
