// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/polyhedron.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "exactcsg/io/planar/planar.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io::openscad {

namespace {

using Face = std::vector<std::uint32_t>;

struct Welded {
  std::vector<Point3> vertices;
  std::vector<std::uint32_t> of_point;  // vertex of each input point
};

Welded weld(const std::vector<Point3>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return points[a] < points[b]; });
  Welded result;
  result.of_point.resize(points.size());
  std::vector<std::uint32_t> first_of(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeated = i > 0 && points[order[i]] == points[order[i - 1]];
    first_of[order[i]] = repeated ? first_of[order[i - 1]] : order[i];
  }
  // In the order of the input, so that messages and results are as the user counts.
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (first_of[i] == i) {
      result.of_point[i] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(points[i]);
    } else {
      result.of_point[i] = result.of_point[first_of[i]];
    }
  }
  return result;
}

// Without vertices that repeat their predecessor.
Face without_repetitions(Face face) {
  face.erase(std::unique(face.begin(), face.end()), face.end());
  while (face.size() > 1 && face.front() == face.back()) face.pop_back();
  return face;
}

// Twice the vector area; for a planar polygon a multiple of its normal.
Vector3 vector_area(const std::vector<Point3>& vertices, const Face& face) {
  Vector3 sum{0, 0, 0};
  const Point3& origin = vertices[face[0]];
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const Vector3 part = cross(vertices[face[i]] - origin, vertices[face[i + 1]] - origin);
    sum = {sum.x + part.x, sum.y + part.y, sum.z + part.z};
  }
  return sum;
}

bool is_zero(const Vector3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

bool is_planar(const std::vector<Point3>& vertices, const Face& face, const Vector3& normal) {
  return std::all_of(face.begin(), face.end(), [&](std::uint32_t v) {
    return dot(normal, vertices[v] - vertices[face[0]]) == 0;
  });
}

// Projection along the largest component of the normal, keeping counter-clockwise order.
struct Projection {
  int axis = 2;
  bool flip = false;

  explicit Projection(const Vector3& normal) {
    const Rational x = abs(normal.x);
    const Rational y = abs(normal.y);
    const Rational z = abs(normal.z);
    axis = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
    flip = (axis == 2 ? normal.z : axis == 1 ? normal.y : normal.x) < 0;
  }
  Point2 operator()(const Point3& p) const {
    Point2 q = axis == 2 ? Point2{p.x, p.y} : axis == 1 ? Point2{p.z, p.x} : Point2{p.y, p.z};
    if (flip) std::swap(q.x, q.y);
    return q;
  }
};

int turn(const Point2& p, const Point2& q, const Point2& r) {
  return sgn(Rational((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)));
}

// Never turning right, turning left somewhere, and going round once.
bool is_convex(const std::vector<Point2>& polygon) {
  const std::size_t n = polygon.size();
  bool left = false;
  std::size_t ascents = 0;  // once round: the x order rises in one run only
  std::vector<bool> rising(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Point2& p = polygon[i];
    const Point2& q = polygon[(i + 1) % n];
    const int sign = turn(p, q, polygon[(i + 2) % n]);
    if (sign < 0) return false;
    left = left || sign > 0;
    if (sign == 0) {
      // Straight on, not back.
      const Point2& r = polygon[(i + 2) % n];
      if ((q.x - p.x) * (r.x - q.x) + (q.y - p.y) * (r.y - q.y) <= 0) return false;
    }
    rising[i] = p.x < q.x || (p.x == q.x && p.y < q.y);
  }
  for (std::size_t i = 0; i < n; ++i) ascents += rising[i] && !rising[(i + n - 1) % n] ? 1 : 0;
  return left && ascents == 1;
}

bool strictly_inside_or_on(const Point2& p, const Point2& a, const Point2& b, const Point2& c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

// Triangles by cutting off ears; nullopt if the polygon is not simple enough to have any.
// COST: O(m^2) signs for usual polygons.
std::optional<std::vector<Face>> cut_ears(const Face& face, const std::vector<Point2>& points) {
  std::vector<std::size_t> rest(face.size());
  std::iota(rest.begin(), rest.end(), std::size_t{0});
  std::vector<Face> triangles;
  std::size_t at = 0;
  std::size_t failures = 0;
  while (rest.size() > 3) {
    const std::size_t m = rest.size();
    if (failures >= m) return std::nullopt;
    const std::size_t i = rest[(at + m - 1) % m];
    const std::size_t j = rest[at % m];
    const std::size_t k = rest[(at + 1) % m];
    bool ear = turn(points[i], points[j], points[k]) > 0;
    for (std::size_t r = 0; ear && r < m; ++r) {
      const Point2& p = points[rest[r]];
      if (rest[r] == i || rest[r] == j || rest[r] == k) continue;
      // A bridge to a hole repeats positions of the ear's own corners; they do not block it.
      if (p == points[i] || p == points[j] || p == points[k]) continue;
      ear = !strictly_inside_or_on(p, points[i], points[j], points[k]);
    }
    if (ear) {
      triangles.push_back({face[i], face[j], face[k]});
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at % m));
      failures = 0;
      at = at % m == 0 ? rest.size() - 1 : at % m - 1;
    } else {
      ++failures;
      at = (at + 1) % m;
    }
  }
  if (turn(points[rest[0]], points[rest[1]], points[rest[2]]) <= 0) return std::nullopt;
  triangles.push_back({face[rest[0]], face[rest[1]], face[rest[2]]});
  return triangles;
}

Rational squared_distance(const Point3& p, const Point3& q) {
  const Vector3 d = p - q;
  return dot(d, d);
}

std::string describe(const Face& face) {
  std::string text = "[";
  for (std::size_t i = 0; i < face.size() && i < 8; ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(face[i]);
  }
  return text + (face.size() > 8 ? ", ...]" : "]");
}

class FaceSplitter {
 public:
  // With `any_outline`, outlines may cross themselves, and vertices are added for these.
  FaceSplitter(std::vector<Point3>& vertices, const std::function<void(const std::string&)>& warn,
               bool any_outline)
      : vertices_(vertices), warn_(warn), any_outline_(any_outline) {}

  // `name`: the face as the user wrote it.
  void add(const Face& face, const std::string& name) {
    const Vector3 normal = vector_area(vertices_, face);
    if (is_zero(normal)) {
      if (any_outline_ && fan_out(face)) return;
      throw Error(ErrorId::DegenerateFacet, {"face " + name, "a face with an area"});
    }
    if (face.size() == 3) {
      facets_.push_back(face);
      return;
    }
    const Projection project(normal);
    std::vector<Point2> points;
    points.reserve(face.size());
    for (const std::uint32_t v : face) points.push_back(project(vertices_[v]));
    const bool convex = is_convex(points);
    if (is_planar(vertices_, face, normal)) {
      if (convex) {
        facets_.push_back(face);
      } else {
        add_triangles(face, points, name);
      }
      return;
    }
    warn_("face " + name + " is not exactly planar: split into triangles");
    if (face.size() == 4 && convex) {
      const bool first = squared_distance(vertices_[face[0]], vertices_[face[2]]) <=
                         squared_distance(vertices_[face[1]], vertices_[face[3]]);
      const std::size_t s = first ? 0 : 1;
      facets_.push_back({face[s], face[s + 1], face[s + 2]});
      facets_.push_back({face[s], face[s + 2], face[(s + 3) % 4]});
    } else {
      add_triangles(face, points, name);
    }
  }

  std::vector<Facet> take() && { return std::move(facets_); }

 private:
  void add_triangles(const Face& face, const std::vector<Point2>& points, const std::string& name) {
    auto triangles = cut_ears(face, points);
    if (!triangles && any_outline_ && fan_out(face)) return;
    if (!triangles) {
      throw Error(ErrorId::SelfIntersectingMesh,
                  {"face " + name + ", whose outline crosses itself or turns clockwise",
                   "a simple polygon"});
    }
    for (Face& triangle : *triangles) facets_.push_back(std::move(triangle));
  }

  // Triangles round a point that is in line with no side: whatever the outline's shape, they go
  // round every point as often as it does. False: no such point was found (all vertices in one
  // line).
  bool fan_out(const Face& face) {
    constexpr unsigned attempts = 16;
    for (unsigned attempt = 0; attempt < attempts; ++attempt) {
      const Point3 middle = weighted_mean(face, attempt);
      bool in_line = false;
      for (std::size_t i = 0; i < face.size() && !in_line; ++i) {
        const Point3& from = vertices_[face[i]];
        in_line = is_zero(cross(vertices_[face[(i + 1) % face.size()]] - from, middle - from));
      }
      if (in_line) continue;
      const auto apex = static_cast<std::uint32_t>(vertices_.size());
      vertices_.push_back(middle);
      for (std::size_t i = 0; i < face.size(); ++i) {
        facets_.push_back({face[i], face[(i + 1) % face.size()], apex});
      }
      return true;
    }
    return false;
  }

  // Other weights at each attempt.
  Point3 weighted_mean(const Face& face, unsigned attempt) const {
    Vector3 sum{0, 0, 0};
    unsigned total = 0;
    const Point3 origin{0, 0, 0};
    for (std::size_t i = 0; i < face.size(); ++i) {
      const unsigned weight = 1 + (static_cast<unsigned>(i % 31) * (attempt + 3)) % 7;
      const Vector3 v = vertices_[face[i]] - origin;
      sum = {sum.x + weight * v.x, sum.y + weight * v.y, sum.z + weight * v.z};
      total += weight;
    }
    return {sum.x / total, sum.y / total, sum.z / total};
  }

  std::vector<Point3>& vertices_;
  const std::function<void(const std::string&)>& warn_;
  bool any_outline_;
  std::vector<Facet> facets_;
};

// A cheap necessary condition of convexity: across every edge the neighbour's next vertex does not
// lie outside. Most meshes that are not convex fail it at once.
bool may_be_convex(const Polyhedron& polyhedron) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> facet_of_edge;
  for (std::size_t f = 0; f < polyhedron.facets.size(); ++f) {
    const Facet& facet = polyhedron.facets[f];
    for (std::size_t i = 0; i < facet.size(); ++i) {
      if (!facet_of_edge.emplace(std::pair(facet[i], facet[(i + 1) % facet.size()]), f).second) {
        return false;
      }
    }
  }
  for (std::size_t f = 0; f < polyhedron.facets.size(); ++f) {
    const Facet& facet = polyhedron.facets[f];
    const Vector3 normal = vector_area(polyhedron.vertices, facet);
    const Point3& origin = polyhedron.vertices[facet[0]];
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const auto twin = facet_of_edge.find({facet[(i + 1) % facet.size()], facet[i]});
      if (twin == facet_of_edge.end()) return false;
      for (const std::uint32_t v : polyhedron.facets[twin->second]) {
        if (dot(normal, polyhedron.vertices[v] - origin) > 0) return false;
      }
    }
  }
  return true;
}

std::optional<ConvexPolytope> as_convex_polytope(const Polyhedron& polyhedron) {
  // The complete check compares every vertex with every facet; a larger convex mesh is answered
  // just as rightly as a mesh.
  constexpr std::size_t largest_check = 4'000'000;
  if (polyhedron.vertices.size() > largest_check / polyhedron.facets.size()) return std::nullopt;
  if (!may_be_convex(polyhedron)) return std::nullopt;
  try {
    return make_convex_polytope(polyhedron);
  } catch (const Error& error) {
    if (error.id() == ErrorId::NotConvex || error.id() == ErrorId::OpenMesh) return std::nullopt;
    throw;
  }
}

// Vertices that no facet uses are dropped: hull and bounding boxes must not see them.
Polyhedron compacted(std::vector<Point3> vertices, std::vector<Facet> facets) {
  constexpr std::uint32_t unused = ~std::uint32_t{0};
  std::vector<std::uint32_t> index(vertices.size(), unused);
  for (const Facet& facet : facets) {
    for (const std::uint32_t v : facet) index[v] = 0;
  }
  Polyhedron result;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (index[v] == unused) continue;
    index[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(std::move(vertices[v]));
  }
  for (Facet& facet : facets) {
    for (std::uint32_t& v : facet) v = index[v];
  }
  result.facets = std::move(facets);
  return result;
}

Polyhedron with_convex_facets(const FacedPoints& input,
                              const std::function<void(const std::string&)>& warn,
                              bool any_outline) {
  Welded welded = weld(input.points);
  FaceSplitter splitter(welded.vertices, warn, any_outline);
  for (const Face& given : input.faces) {
    Face face;
    face.reserve(given.size());
    for (const std::uint32_t point : given) {
      if (point >= input.points.size()) {
        throw Error(
            ErrorId::UnknownVertex,
            {std::to_string(point), "an index below " + std::to_string(input.points.size())});
      }
      face.push_back(welded.of_point[point]);
    }
    face = without_repetitions(std::move(face));
    if (face.size() < 3) {
      warn("face " + describe(given) + " has fewer than three different vertices: dropped");
      continue;
    }
    splitter.add(face, describe(given));
  }
  Polyhedron polyhedron = compacted(std::move(welded.vertices), std::move(splitter).take());
  if (polyhedron.facets.empty()) {
    throw Error(ErrorId::OpenMesh, {"a polyhedron without faces", "at least four faces"});
  }
  return polyhedron;
}

// nullopt: Empty.
std::optional<Primitive> only_primitive(const Solid& solid) {
  if (solid.is_empty()) return std::nullopt;
  return solid.root().primitive();
}

}  // namespace

Primitive make_polyhedron(const FacedPoints& input,
                          const std::function<void(const std::string&)>& warn, unsigned threads) {
  Polyhedron polyhedron = with_convex_facets(input, warn, false);
  if (auto convex = as_convex_polytope(polyhedron)) return Primitive{*std::move(convex)};
  return Primitive{make_mesh(std::move(polyhedron), threads)};
}

Solid solid_of_polyhedron(const FacedPoints& input, const InsideRule& inside,
                          const std::string& origin) {
  std::optional<Primitive> primitive;
  if (inside.rule) {
    Polyhedron polyhedron = with_convex_facets(input, inside.warn, true);
    std::optional<ConvexPolytope> convex;
    try {
      convex = as_convex_polytope(polyhedron);
    } catch (const Error& error) {
      if (error.id() != ErrorId::InvertedMesh) throw;
    }
    primitive = convex ? Primitive{*std::move(convex)}
                       : only_primitive(solid_of_mesh(std::move(polyhedron), inside));
  } else {
    primitive = make_polyhedron(input, inside.warn, inside.threads);
  }
  if (!primitive) return Solid::empty();
  primitive->origin = origin;
  return Solid::primitive(*std::move(primitive));
}

}  // namespace exactcsg::io::openscad
