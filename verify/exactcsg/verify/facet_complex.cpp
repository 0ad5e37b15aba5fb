// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/facet_complex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/verify/exact_sums.hpp"

namespace exactcsg::verify {
namespace {

constexpr std::size_t longest_text = 40;  // a longer fraction is printed as a decimal
constexpr int text_digits = 17;

std::string short_text(const Rational& value) {
  const std::string text = to_text(value);
  return text.size() <= longest_text ? text : to_decimal(value, text_digits);
}

Vector3 position(const Point3& p) { return {p.x, p.y, p.z}; }

// Twice the area vector of a closed polygon, independent of the origin.
Vector3 double_area(const std::vector<Point3>& points, const std::vector<std::uint32_t>& cycle) {
  Vector3 sum{0, 0, 0};
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    const Vector3 c =
        cross(position(points[cycle[i]]), position(points[cycle[(i + 1) % cycle.size()]]));
    sum.x += c.x;
    sum.y += c.y;
    sum.z += c.z;
  }
  return sum;
}

Rational dot_normal(const Plane& plane, const Vector3& v) {
  return plane.a * v.x + plane.b * v.y + plane.c * v.z;
}

// Which way the cycles run: +1 counter-clockwise seen from outside.
int sense_of(const std::vector<Point3>& points, const OracleFacet& facet) {
  Rational sum = 0;
  for (const auto& cycle : facet.cycles) sum += dot_normal(facet.plane, double_area(points, cycle));
  return sum < 0 ? -1 : 1;
}

struct PlaneLess {
  bool operator()(const Plane& p, const Plane& q) const { return compare(p, q) < 0; }
};

using IndexEdge = std::array<std::uint32_t, 2>;

// The undirected edges that bound the union of the facets of one plane: those whose directed
// occurrences do not cancel.
void gather_edges(const std::vector<const OracleFacet*>& facets, const std::vector<Point3>& points,
                  std::set<IndexEdge>& edges) {
  std::map<IndexEdge, int> balance;
  for (const OracleFacet* facet : facets) {
    const int sense = sense_of(points, *facet);
    for (const auto& cycle : facet->cycles) {
      for (std::size_t i = 0; i < cycle.size(); ++i) {
        const std::uint32_t a = cycle[i];
        const std::uint32_t b = cycle[(i + 1) % cycle.size()];
        if (a < b) {
          balance[{a, b}] += sense;
        } else {
          balance[{b, a}] -= sense;
        }
      }
    }
  }
  for (const auto& [edge, count] : balance) {
    if (count != 0) edges.insert(edge);
  }
}

bool collinear(const Point3& p, const Point3& q, const Point3& r) {
  return cross(q - p, r - p) == Vector3{0, 0, 0};
}

// Joins edges at vertices where all edges lie along one line.
void join_straight(const std::vector<Point3>& points, std::set<IndexEdge>& edges) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> neighbours;
  for (const IndexEdge& edge : edges) {
    neighbours[edge[0]].push_back(edge[1]);
    neighbours[edge[1]].push_back(edge[0]);
  }
  for (auto& [vertex, around] : neighbours) {
    if (around.size() != 2 || !collinear(points[around[0]], points[vertex], points[around[1]])) {
      continue;
    }
    const std::uint32_t a = around[0];
    const std::uint32_t b = around[1];
    edges.erase({std::min(a, vertex), std::max(a, vertex)});
    edges.erase({std::min(b, vertex), std::max(b, vertex)});
    edges.insert({std::min(a, b), std::max(a, b)});
    std::replace(neighbours[a].begin(), neighbours[a].end(), vertex, b);
    std::replace(neighbours[b].begin(), neighbours[b].end(), vertex, a);
    around.clear();
  }
}

bool edge_less(const ExactEdge& e, const ExactEdge& f) {
  const auto order = compare(e[0], f[0]);
  return order != 0 ? order < 0 : compare(e[1], f[1]) < 0;
}

template <class Value, class Less>
void sort_unique(std::vector<Value>& values, Less less) {
  std::sort(values.begin(), values.end(), less);
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

void sort_sets(CanonicalSets& sets) {
  sort_unique(sets.vertices, [](const Point3& p, const Point3& q) { return p < q; });
  sort_unique(sets.edges, edge_less);
  sort_unique(sets.planes, PlaneLess{});
}

std::vector<std::array<double, 3>> place(const Point3& p) { return {approximate(p)}; }
std::vector<std::array<double, 3>> place(const ExactEdge& e) {
  return {approximate(e[0]), approximate(e[1])};
}
std::vector<std::array<double, 3>> place(const Plane&) { return {}; }

template <class Value, class Less>
Check compare_sets(const std::vector<Value>& ours, const std::vector<Value>& theirs, Less less,
                   const std::string& what) {
  Check check;
  check.ours = std::to_string(ours.size());
  check.theirs = std::to_string(theirs.size());
  check.bound = "0 (equal sets)";
  std::vector<Value> only_ours;
  std::vector<Value> only_theirs;
  std::set_difference(ours.begin(), ours.end(), theirs.begin(), theirs.end(),
                      std::back_inserter(only_ours), less);
  std::set_difference(theirs.begin(), theirs.end(), ours.begin(), ours.end(),
                      std::back_inserter(only_theirs), less);
  check.difference = std::to_string(only_ours.size() + only_theirs.size());
  // Both sides get a share of the list, however long the other is.
  const std::size_t rows = std::max(only_ours.size(), only_theirs.size());
  for (std::size_t i = 0; i < rows; ++i) {
    if (i < only_ours.size()) {
      add_mismatch(check, {fmt::format("{} only in ours: {}", what, describe(only_ours[i])),
                           place(only_ours[i])});
    }
    if (i < only_theirs.size()) {
      add_mismatch(check,
                   {fmt::format("{} only in the oracle's: {}", what, describe(only_theirs[i])),
                    place(only_theirs[i])});
    }
  }
  return check;
}

}  // namespace

VolumeSum volume_sum(const FacetComplex& complex) {
  std::vector<OrientedFace> faces;
  for (const OracleFacet& facet : complex.facets) {
    faces.push_back({&facet.cycles, sense_of(complex.vertices, facet)});
  }
  return sum_volume(complex.vertices, faces);
}

VolumeSum volume_sum(const Boundary& boundary) {
  std::vector<OrientedFace> faces;
  for (const BoundaryFace& face : boundary.faces) faces.push_back({&face.loops, 1});
  return sum_volume(to_vector(boundary.vertices), faces);
}

CanonicalSets canonical_sets(const FacetComplex& complex) {
  std::map<Plane, std::vector<const OracleFacet*>, PlaneLess> by_plane;
  for (const OracleFacet& facet : complex.facets) by_plane[facet.plane].push_back(&facet);
  std::set<IndexEdge> edges;
  CanonicalSets sets;
  for (const auto& [plane, facets] : by_plane) {
    sets.planes.push_back(plane);
    gather_edges(facets, complex.vertices, edges);
  }
  join_straight(complex.vertices, edges);
  for (const IndexEdge& edge : edges) {
    const Point3& p = complex.vertices[edge[0]];
    const Point3& q = complex.vertices[edge[1]];
    sets.edges.push_back(p < q ? ExactEdge{p, q} : ExactEdge{q, p});
    sets.vertices.push_back(p);
    sets.vertices.push_back(q);
  }
  sort_sets(sets);
  return sets;
}

CanonicalSets canonical_sets(const Boundary& boundary) {
  CanonicalSets sets;
  sets.vertices = to_vector(boundary.vertices);
  for (const BoundaryEdge& edge : boundary.edges) {
    const Point3& p = boundary.vertices[edge.from];
    const Point3& q = boundary.vertices[edge.to];
    sets.edges.push_back(p < q ? ExactEdge{p, q} : ExactEdge{q, p});
  }
  for (const BoundaryFace& face : boundary.faces) {
    sets.planes.push_back(exact_plane(boundary, face));
  }
  sort_sets(sets);
  return sets;
}

std::vector<Check> compare_exactly(const Boundary& boundary, const FacetComplex& oracle,
                                   const std::string& oracle_name, const std::string& label) {
  std::vector<Check> checks;
  Check figure;
  const VolumeSum ours = volume_sum(boundary);
  const VolumeSum theirs = volume_sum(oracle);
  figure.ours = ours.decimal;
  figure.theirs = theirs.decimal;
  figure.bound = ours.exact && theirs.exact ? "0 (equal rationals)" : "0 (equal residues)";
  figure.name = label + ": volume";
  if (ours.exact && theirs.exact) {
    figure.difference = to_decimal(Rational(*ours.exact - *theirs.exact), 3);
  } else {
    figure.explanation =
        "the rationals are too long to be written and are compared modulo four random primes of 61 "
        "bits";
  }
  if (!(ours == theirs)) {
    figure.verdict = Verdict::Failed;
    figure.explanation =
        fmt::format("the volumes are different rationals: ours {}, the oracle's {}",
                    ours.exact ? short_text(*ours.exact) : ours.decimal,
                    theirs.exact ? short_text(*theirs.exact) : theirs.decimal);
  }
  checks.push_back(std::move(figure));

  const CanonicalSets a = canonical_sets(boundary);
  const CanonicalSets b = canonical_sets(oracle);
  checks.push_back(compare_sets(
      a.vertices, b.vertices, [](const Point3& p, const Point3& q) { return p < q; }, "vertex"));
  checks.back().name = label + ": vertices";
  checks.push_back(compare_sets(a.edges, b.edges, edge_less, "edge"));
  checks.back().name = label + ": edges";
  checks.push_back(compare_sets(a.planes, b.planes, PlaneLess{}, "face plane"));
  checks.back().name = label + ": face planes";
  for (Check& check : checks) check.oracle = oracle_name;
  return checks;
}

std::string describe(const Point3& point) {
  return fmt::format("({}, {}, {})", short_text(point.x), short_text(point.y), short_text(point.z));
}

std::string describe(const ExactEdge& edge) {
  return describe(edge[0]) + " - " + describe(edge[1]);
}

std::string describe(const Plane& plane) {
  return fmt::format("{} x + {} y + {} z + {} <= 0", short_text(Rational(plane.a)),
                     short_text(Rational(plane.b)), short_text(Rational(plane.c)),
                     short_text(Rational(plane.d)));
}

std::array<double, 3> approximate(const Point3& point) {
  return {nearest_double(point.x), nearest_double(point.y), nearest_double(point.z)};
}

}  // namespace exactcsg::verify
