// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/mesh_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <unordered_map>

#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/solid/measures.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/exact_sums.hpp"
#include "exactcsg/verify/facet_complex.hpp"
#include "exactcsg/verify/membranes.hpp"
#include "exactcsg/verify/welded_mesh.hpp"

namespace exactcsg::verify {
namespace {

constexpr int working_bits = 160;
constexpr int shown_digits = 12;
// Beyond so many, the file is another solid: a place is not searched for each.
constexpr std::size_t enough = 2000;

std::string short_number(double value) { return fmt::format("{:.3g}", value); }

std::string point_text(const PlainVector& p) {
  return fmt::format("({:.17g}, {:.17g}, {:.17g})", p[0], p[1], p[2]);
}

Check named(const std::string& label, const char* what) {
  Check check;
  check.name = label + ": " + what;
  return check;
}

Mismatch edge_mismatch(const std::string& text, const PlainVector& a, const PlainVector& b) {
  return {fmt::format("{}: {} - {}", text, point_text(a), point_text(b)), {a, b}};
}

Mismatch vertex_mismatch(const std::string& text, const PlainVector& p) {
  return {fmt::format("{}: {}", text, point_text(p)), {p}};
}

// ---- finding points near a point ---------------------------------------------------------------

class PointGrid {
 public:
  PointGrid(const std::vector<PlainVector>& points, double least_cell) {
    PlainVector lower{0, 0, 0};
    PlainVector upper{0, 0, 0};
    if (!points.empty()) lower = upper = points.front();
    for (const PlainVector& p : points) {
      for (std::size_t k = 0; k < 3; ++k) {
        lower[k] = std::min(lower[k], p[k]);
        upper[k] = std::max(upper[k], p[k]);
      }
    }
    const double extent = length(upper - lower);
    cell_ = std::max({extent / std::cbrt(static_cast<double>(points.size()) + 1), least_cell,
                      extent * 1e-9, 1e-300});
    origin_ = lower;
    for (std::size_t i = 0; i < points.size(); ++i) {
      cells_[key(index_of(points[i]))].push_back(static_cast<std::uint32_t>(i));
    }
  }

  // Calls visit(index) for every point within `reach` of p in each coordinate, and for some others.
  template <class Visit>
  void near(const PlainVector& p, double reach, Visit visit) const {
    const Index low = index_of(p - PlainVector{reach, reach, reach});
    const Index high = index_of(p + PlainVector{reach, reach, reach});
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto found = cells_.find(key({x, y, z}));
          if (found == cells_.end()) continue;
          for (const std::uint32_t i : found->second) visit(i);
        }
      }
    }
  }

 private:
  using Index = std::array<std::int64_t, 3>;
  Index index_of(const PlainVector& p) const {
    Index index{};
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr double far = 1e12;  // far away is outside all cells; keep the conversion defined
      index[k] =
          static_cast<std::int64_t>(std::floor(std::clamp((p[k] - origin_[k]) / cell_, -far, far)));
    }
    return index;
  }
  static std::uint64_t key(const Index& i) {
    return static_cast<std::uint64_t>(i[0]) * 0x9E3779B97F4A7C15U ^
           static_cast<std::uint64_t>(i[1]) * 0xC2B2AE3D27D4EB4FU ^
           static_cast<std::uint64_t>(i[2]) * 0x165667B19E3779F9U;
  }
  double cell_ = 1;
  PlainVector origin_{};
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

// ---- our side -----------------------------------------------------------------------------------

struct Ours {
  const Boundary& boundary;
  std::vector<Plane> planes;
  std::vector<PlainVector> positions;
  std::vector<std::vector<std::uint32_t>> edges_at;  // of each vertex
  std::vector<std::vector<std::uint32_t>> faces_at;  // of each edge
  std::set<std::uint32_t> crowded_edges;             // edges with more than two faces

  explicit Ours(const Boundary& b)
      : boundary(b),
        planes(exact_planes(b)),
        edges_at(b.vertices.size()),
        faces_at(b.edges.size()) {
    for (const Point3& p : b.vertices) positions.push_back(approximate(p));
    std::map<MeshEdge, std::uint32_t> index;
    for (std::size_t e = 0; e < b.edges.size(); ++e) {
      const auto id = static_cast<std::uint32_t>(e);
      edges_at[b.edges[e].from].push_back(id);
      edges_at[b.edges[e].to].push_back(id);
      index[{b.edges[e].from, b.edges[e].to}] = id;
    }
    for (std::size_t f = 0; f < b.faces.size(); ++f) {
      for (const auto& loop : b.faces[f].loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const auto [u, v] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
          const auto found = index.find({u, v});
          if (found == index.end()) continue;
          auto& faces = faces_at[found->second];
          faces.push_back(static_cast<std::uint32_t>(f));
          if (faces.size() > 2) crowded_edges.insert(found->second);
        }
      }
    }
  }
  const PlainVector& from(std::uint32_t edge) const { return positions[boundary.edges[edge].from]; }
  const PlainVector& to(std::uint32_t edge) const { return positions[boundary.edges[edge].to]; }
};

// Is p within `reach` of the face: of its plane, and its projection inside the loops?
bool near_face(const Ours& ours, const BoundaryFace& face, const PlainVector& p, double reach) {
  const Plane& plane = ours.planes[face.plane];
  const PlainVector raw{plane.a.get_d(), plane.b.get_d(), plane.c.get_d()};
  const double size = length(raw);
  if (!(size > 0) || !std::isfinite(size) || face.loops.empty()) return false;
  const PlainVector normal = (1 / size) * raw;
  const PlainVector& origin = ours.positions[face.loops.front().front()];
  if (std::fabs(dot(normal, p - origin)) > reach) return false;
  const std::size_t drop = longest_axis(normal);
  bool inside = false;
  for (const auto& loop : face.loops) {
    inside ^= crosses_oddly(
        drop, p,
        loop.size(), [&](std::size_t i) -> const auto& { return ours.positions[loop[i]]; });
  }
  return inside;
}

// ---- the comparison -----------------------------------------------------------------------------

// Which vertices of the one side stand for which of the other.
struct Matching {
  std::vector<std::vector<std::uint32_t>> ours_of;    // of each vertex of the file
  std::vector<std::vector<std::uint32_t>> theirs_of;  // of each vertex of the boundary
  std::vector<std::vector<std::uint32_t>> edges_of;   // our edges that a vertex of the file lies on
  double largest_displacement = 0;
};

Matching match_vertices(const Ours& ours, const WeldedMesh& mesh) {
  Matching matching;
  matching.ours_of.resize(mesh.points.size());
  matching.edges_of.resize(mesh.points.size());
  matching.theirs_of.resize(ours.positions.size());
  for (const double t : mesh.displacement) {
    matching.largest_displacement = std::max(matching.largest_displacement, t);
  }
  const PointGrid grid(ours.positions, 4 * matching.largest_displacement);
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    const double reach = 2 * mesh.displacement[v];
    grid.near(mesh.positions[v], reach, [&](std::uint32_t i) {
      if (length(ours.positions[i] - mesh.positions[v]) > reach) return;
      if (!may_stand_for(mesh, v, ours.boundary.vertices[i])) return;
      matching.ours_of[v].push_back(i);
      matching.theirs_of[i].push_back(v);
    });
    for (const std::uint32_t i : matching.ours_of[v]) {
      matching.edges_of[v].insert(matching.edges_of[v].end(), ours.edges_at[i].begin(),
                                  ours.edges_at[i].end());
    }
  }
  return matching;
}

Check check_closed(const std::string& label, const WeldedMesh& mesh) {
  Check check = named(label, "closed");
  std::size_t open = 0;
  for (const auto& [edge, use] : mesh.edges) {
    if (use.count() % 2 == 0) continue;
    ++open;
    add_mismatch(check, edge_mismatch(fmt::format("open edge, {} facets", use.count()),
                                      mesh.positions[edge[0]], mesh.positions[edge[1]]));
  }
  check.ours = "0 open edges";
  check.theirs = fmt::format("{} open edges", open);
  check.bound = "0";
  check.explanation = fmt::format(
      "{} facets, {} without area dropped, {} T-junctions closed within the format's rounding",
      mesh.facets.size(), mesh.dropped_facets, mesh.junctions);
  if (mesh.facets.empty()) {
    check.verdict = Verdict::Failed;
    check.explanation = "the file has no facets";
  }
  return check;
}

Check check_oriented(const std::string& label, const WeldedMesh& mesh, bool inside_out) {
  Check check = named(label, "oriented");
  std::size_t wrong = 0;
  for (const auto& [edge, use] : mesh.edges) {
    if (use.count() % 2 != 0 || use.forward.size() == use.backward.size()) continue;
    ++wrong;
    add_mismatch(check, edge_mismatch(fmt::format("facets turn against each other ({} and {})",
                                                  use.forward.size(), use.backward.size()),
                                      mesh.positions[edge[0]], mesh.positions[edge[1]]));
  }
  check.ours = "outward";
  check.theirs = inside_out ? "inside out" : wrong == 0 ? "outward" : "mixed";
  check.bound = "0";
  if (inside_out) {
    check.verdict = Verdict::Failed;
    check.explanation = "the volume is negative: the mesh is inside out";
  }
  return check;
}

bool along_segment(const PlainVector& a, const PlainVector& b, const PlainVector& p, double reach) {
  return nearest_on_segment(a, b, p).distance <= reach;
}

// A vertex inside an edge stands for one point of each edge that it lies on.
bool stands_for_several(const Matching& matching, std::uint32_t v) {
  const std::size_t vertices = matching.ours_of[v].size();
  return vertices > 1 || (vertices == 0 && matching.edges_of[v].size() > 1);
}

// Do the boxes around the segments ab and pq come within `reach` of each other?
bool boxes_meet(const PlainVector& a, const PlainVector& b, const PlainVector& p,
                const PlainVector& q, double reach) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::min(p[k], q[k]) > std::max(a[k], b[k]) + reach) return false;
    if (std::max(p[k], q[k]) < std::min(a[k], b[k]) - reach) return false;
  }
  return true;
}

// How many facets the model has around the segment ab: those at its edges that run along it, and
// two of every other face in which it lies. (An edge of one part that touches a face of another
// inside is an edge of two faces only, and yet four facets meet there.)
std::size_t facets_around(const Ours& ours, const PlainVector& a, const PlainVector& b,
                          double reach) {
  std::set<std::uint32_t> counted;
  std::size_t facets = 0;
  for (std::uint32_t e = 0; e < ours.boundary.edges.size(); ++e) {
    if (!boxes_meet(a, b, ours.from(e), ours.to(e), reach)) continue;
    if (!along_segment(ours.from(e), ours.to(e), a, reach)) continue;
    if (!along_segment(ours.from(e), ours.to(e), b, reach)) continue;
    facets += ours.faces_at[e].size();
    counted.insert(ours.faces_at[e].begin(), ours.faces_at[e].end());
  }
  const PlainVector middle = 0.5 * (a + b);
  for (std::uint32_t f = 0; f < ours.boundary.faces.size(); ++f) {
    if (counted.count(f) != 0) continue;
    if (near_face(ours, ours.boundary.faces[f], middle, reach)) facets += 2;
  }
  return facets;
}

Check check_manifold(const std::string& label, const Ours& ours, const WeldedMesh& mesh,
                     const Matching& matching) {
  Check check = named(label, "manifold");
  std::size_t crowded = 0;
  std::size_t allowed = 0;
  for (const auto& [edge, use] : mesh.edges) {
    if (use.count() <= 2) continue;
    ++crowded;
    const PlainVector& a = mesh.positions[edge[0]];
    const PlainVector& b = mesh.positions[edge[1]];
    const double reach = 2 * std::max(mesh.displacement[edge[0]], mesh.displacement[edge[1]]);
    const bool welded =
        stands_for_several(matching, edge[0]) || stands_for_several(matching, edge[1]);
    const bool search = crowded <= enough || check.mismatch_count == 0;
    if (welded || (search && facets_around(ours, a, b, reach) >= use.count())) {
      ++allowed;
      continue;
    }
    add_mismatch(check, edge_mismatch(fmt::format("{} facets at an edge", use.count()), a, b));
  }
  check.ours = fmt::format("{} edges of 4+ faces", ours.crowded_edges.size());
  check.theirs = fmt::format("{} edges of 3+ facets", crowded);
  check.bound = "0 besides ours";
  if (allowed > 0) {
    check.explanation = fmt::format(
        "{} edges of more than two facets are the model's own, or an edge of it that touches a "
        "face, or come from welded vertices",
        allowed);
  }
  return check;
}

struct Measures {
  double area = 0;        // of the facets
  double area_bound = 0;  // of its difference, see the header
  double volume_bound = 0;
};

Measures measure(const WeldedMesh& mesh) {
  Measures result;
  for (const auto& facet : mesh.facets) {
    result.area += length(area_vector(mesh, facet));
    result.area_bound += area_slack(mesh, facet);
    const double t = largest_displacement(mesh, facet);
    const PlainVector& origin = mesh.positions[facet[0]];
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      const PlainVector e = mesh.positions[facet[i]] - origin;
      const PlainVector f = mesh.positions[facet[i + 1]] - origin;
      result.volume_bound +=
          t * (0.5 * length(cross(e, f)) + (length(e) + length(f)) * t + 2 * t * t);
    }
  }
  // The sums themselves are rounded; a relative 1e-12 covers a million additions.
  result.area_bound += 1e-12 * result.area;
  result.volume_bound *= 1 + 1e-9;
  return result;
}

struct FileVolume {
  Rational exact{0};
  bool known = false;
};

FileVolume file_volume(const WeldedMesh& mesh) {
  std::vector<Cycles> cycles;
  cycles.reserve(mesh.facets.size());
  for (const auto& facet : mesh.facets) cycles.push_back({facet});
  std::vector<OrientedFace> faces;
  for (const Cycles& c : cycles) faces.push_back({&c, 1});
  const VolumeSum sum = sum_volume(mesh.points, faces);
  if (sum.exact) return {*sum.exact, true};
  return {parse_rational(sum.decimal).value_or(Rational(0)), true};
}

Check compare_figure(const std::string& label, const char* what, const Enclosure& ours,
                     const Rational& theirs, double bound) {
  Check check = named(label, what);
  const Rational middle = (ours.lower + ours.upper) / 2;
  const Rational width = ours.upper - ours.lower;
  const Rational difference = theirs - middle;
  check.ours = to_decimal(middle, shown_digits);
  check.theirs = to_decimal(theirs, shown_digits);
  check.difference = to_decimal(difference, 3);
  check.bound = short_number(bound);
  if (abs(difference) > rational_of(bound) + width) {
    check.verdict = Verdict::Failed;
    check.explanation =
        fmt::format("the {} differs by {}, more than rounding in this format can explain ({})",
                    what, check.difference, check.bound);
  } else {
    check.explanation = "bound: what displacing every vertex by the format's rounding can change";
  }
  return check;
}

// Both sides get a share of the list, however long the other is.
void list_in_turn(Check& check, const std::vector<Mismatch>& missing,
                  const std::vector<Mismatch>& stray) {
  for (std::size_t i = 0; i < std::max(missing.size(), stray.size()); ++i) {
    if (i < missing.size()) add_mismatch(check, missing[i]);
    if (i < stray.size()) add_mismatch(check, stray[i]);
  }
}

// Has the face a corner besides the ends of the edge that rounding may have joined to one of them?
bool has_corner_near_ends(const Ours& ours, std::uint32_t face, std::uint32_t edge, double reach) {
  const BoundaryEdge& ends = ours.boundary.edges[edge];
  for (const auto& loop : ours.boundary.faces[face].loops) {
    for (const std::uint32_t v : loop) {
      if (v == ends.from || v == ends.to) continue;
      const PlainVector& p = ours.positions[v];
      if (length(p - ours.from(edge)) <= reach || length(p - ours.to(edge)) <= reach) return true;
    }
  }
  return false;
}

// May rounding have left the edge without facets? A facet vanishes when two of its corners become
// one: both ends of the edge, or an end and a third corner of its face, on every side of the edge.
bool may_have_vanished(const Ours& ours, const Matching& matching, std::uint32_t edge,
                       double reach) {
  if (length(ours.to(edge) - ours.from(edge)) <= reach) {
    const BoundaryEdge& ends = ours.boundary.edges[edge];
    return matching.theirs_of[ends.from].empty() || matching.theirs_of[ends.to].empty();
  }
  const auto& faces = ours.faces_at[edge];
  return std::all_of(faces.begin(), faces.end(), [&](std::uint32_t face) {
    return has_corner_near_ends(ours, face, edge, reach);
  });
}

Check check_vertices(const std::string& label, const Ours& ours, const WeldedMesh& mesh,
                     Matching& matching) {
  Check check = named(label, "vertices");
  check.ours = std::to_string(ours.positions.size());
  check.theirs = std::to_string(mesh.points.size());
  check.bound = short_number(matching.largest_displacement);
  std::vector<Mismatch> missing;
  for (std::size_t i = 0; i < ours.positions.size(); ++i) {
    if (!matching.theirs_of[i].empty()) continue;
    const auto& edges = ours.edges_at[i];
    const bool vanished = std::all_of(edges.begin(), edges.end(), [&](std::uint32_t e) {
      return may_have_vanished(ours, matching, e, 2 * matching.largest_displacement);
    });
    if (vanished) continue;
    missing.push_back(
        vertex_mismatch("vertex of the model that the file does not have", ours.positions[i]));
  }
  std::set<std::uint32_t> used;
  for (const auto& facet : mesh.facets) used.insert(facet.begin(), facet.end());
  std::vector<Mismatch> stray;
  std::size_t searched = 0;
  for (const std::uint32_t v : used) {
    if (!matching.ours_of[v].empty()) continue;
    const double reach = mesh.displacement[v];
    bool explained = false;
    if (++searched <= enough || (missing.empty() && stray.empty())) {
      for (std::uint32_t e = 0; e < ours.boundary.edges.size(); ++e) {
        if (along_segment(ours.from(e), ours.to(e), mesh.positions[v], reach)) {
          matching.edges_of[v].push_back(e);
          explained = true;
        }
      }
      for (std::size_t f = 0; f < ours.boundary.faces.size() && !explained; ++f) {
        explained = near_face(ours, ours.boundary.faces[f], mesh.positions[v], reach);
      }
    }
    if (explained) continue;
    stray.push_back(vertex_mismatch("vertex of the file that is not on the model's boundary",
                                    mesh.positions[v]));
  }
  check.difference = std::to_string(missing.size() + stray.size());
  list_in_turn(check, missing, stray);
  return check;
}

// Can a path of edges be walked from one of `starts` to one of `ends`, all within `reach` of the
// segment?
template <class Neighbours, class Position>
bool walk_along(const PlainVector& a, const PlainVector& b, double reach,
                const std::vector<std::uint32_t>& starts, const std::vector<std::uint32_t>& ends,
                Neighbours neighbours, Position position) {
  const std::set<std::uint32_t> goals(ends.begin(), ends.end());
  std::vector<std::uint32_t> pending(starts);
  std::set<std::uint32_t> seen(starts.begin(), starts.end());
  while (!pending.empty()) {
    const std::uint32_t v = pending.back();
    pending.pop_back();
    if (goals.count(v) != 0) return true;
    neighbours(v, [&](std::uint32_t w) {
      if (along_segment(a, b, position(w), reach) && seen.insert(w).second) pending.push_back(w);
    });
  }
  return false;
}

struct FacetDirection {
  PlainVector area_vector;
  double uncertainty = 0;  // of its angle; rounding may have turned a sliver anywhere
};

FacetDirection direction_of(const WeldedMesh& mesh, std::uint32_t facet) {
  constexpr double anywhere = 4;  // more than pi
  const PlainVector area = area_vector(mesh, mesh.facets[facet]);
  const double size = length(area);
  const double ratio = size > 0 ? area_slack(mesh, mesh.facets[facet]) / size : 1;
  return {area, ratio < 0.5 ? std::asin(ratio) : anywhere};
}

bool may_be_coplanar(const FacetDirection& f, const FacetDirection& g) {
  const double angle =
      std::atan2(length(cross(f.area_vector, g.area_vector)), dot(f.area_vector, g.area_vector));
  return angle <= f.uncertainty + g.uncertainty + 1e-12;
}

// Gives facet f on the one side of an edge a partner on the other, moving earlier pairs if it must.
bool find_partner(std::size_t f, const std::vector<FacetDirection>& left,
                  const std::vector<FacetDirection>& right,
                  std::vector<std::optional<std::size_t>>& partner_of, std::vector<bool>& tried) {
  for (std::size_t g = 0; g < right.size(); ++g) {
    if (tried[g] || !may_be_coplanar(left[f], right[g])) continue;
    tried[g] = true;
    if (!partner_of[g] || find_partner(*partner_of[g], left, right, partner_of, tried)) {
      partner_of[g] = f;
      return true;
    }
  }
  return false;
}

// True if the edge cannot stand for diagonals of faces alone: each diagonal brings two coplanar
// facets that turn the same way, and rounding may have laid several diagonals into one edge.
bool certainly_sharp(const WeldedMesh& mesh, const EdgeUse& use) {
  if (use.forward.size() != use.backward.size()) return true;
  constexpr std::size_t too_many = 64;  // no diagonals meet like this; keep the matching cheap
  if (use.forward.size() > too_many) return true;
  std::vector<FacetDirection> left;
  std::vector<FacetDirection> right;
  for (const std::uint32_t f : use.forward) left.push_back(direction_of(mesh, f));
  for (const std::uint32_t f : use.backward) right.push_back(direction_of(mesh, f));
  std::vector<std::optional<std::size_t>> partner_of(right.size());
  for (std::size_t f = 0; f < left.size(); ++f) {
    std::vector<bool> tried(right.size(), false);
    if (!find_partner(f, left, right, partner_of, tried)) return true;
  }
  return false;
}

// How far along the segment from a to b, beginning at the parameter `start`, does the edge of the
// model stay within `reach`? The distance to a segment is convex along a line: it leaves but once.
double follows_until(const Ours& ours, std::uint32_t edge, const PlainVector& a,
                     const PlainVector& b, double start, double reach) {
  const auto is_near = [&](double s) {
    return along_segment(ours.from(edge), ours.to(edge), a + s * (b - a), reach);
  };
  if (!is_near(start)) return start;
  if (is_near(1)) return 1;
  double near = start;
  double far = 1;
  constexpr int bits_of_a_double = 53;
  for (int i = 0; i < bits_of_a_double; ++i) {
    const double middle = 0.5 * (near + far);
    (is_near(middle) ? near : far) = middle;
  }
  return near;
}

// Is every point of the segment within `reach` of some edge of the model?
bool covered_by_edges(const Ours& ours, const PlainVector& a, const PlainVector& b, double reach) {
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t e = 0; e < ours.boundary.edges.size(); ++e) {
    if (boxes_meet(a, b, ours.from(e), ours.to(e), reach)) candidates.push_back(e);
  }
  double covered = 0;
  while (covered < 1) {
    double next = covered;
    for (const std::uint32_t e : candidates) {
      next = std::max(next, follows_until(ours, e, a, b, covered, reach));
    }
    if (!(next > covered)) return false;
    covered = next;
  }
  return true;
}

bool shares_edge(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  return std::any_of(a.begin(), a.end(),
                     [&](std::uint32_t e) { return std::find(b.begin(), b.end(), e) != b.end(); });
}

Check check_edges(const std::string& label, const Ours& ours, const WeldedMesh& mesh,
                  const Matching& matching) {
  Check check = named(label, "edges");
  std::vector<std::vector<std::uint32_t>> neighbours(mesh.points.size());
  for (const auto& [edge, use] : mesh.edges) {
    neighbours[edge[0]].push_back(edge[1]);
    neighbours[edge[1]].push_back(edge[0]);
  }
  const double reach = 2 * matching.largest_displacement;
  std::vector<Mismatch> missing;
  for (std::uint32_t e = 0; e < ours.boundary.edges.size(); ++e) {
    const auto& starts = matching.theirs_of[ours.boundary.edges[e].from];
    const auto& ends = matching.theirs_of[ours.boundary.edges[e].to];
    const bool found = walk_along(
        ours.from(e), ours.to(e), reach, starts, ends,
        [&](std::uint32_t v, auto visit) {
          for (const std::uint32_t w : neighbours[v]) visit(w);
        },
        [&](std::uint32_t v) { return mesh.positions[v]; });
    if (!found && !may_have_vanished(ours, matching, e, reach)) {
      missing.push_back(
          edge_mismatch("edge of the model that the file does not have", ours.from(e), ours.to(e)));
    }
  }
  std::size_t searched = 0;
  std::vector<Mismatch> stray;
  std::size_t sharp = 0;
  for (const auto& [edge, use] : mesh.edges) {
    if (!certainly_sharp(mesh, use)) continue;
    ++sharp;
    const PlainVector& a = mesh.positions[edge[0]];
    const PlainVector& b = mesh.positions[edge[1]];
    if (shares_edge(matching.edges_of[edge[0]], matching.edges_of[edge[1]])) continue;
    const bool search = ++searched <= enough || (missing.empty() && stray.empty());
    if (search && covered_by_edges(ours, a, b, reach)) continue;
    stray.push_back(edge_mismatch("sharp edge of the file that the model does not have", a, b));
  }
  check.ours = std::to_string(ours.boundary.edges.size());
  check.theirs = fmt::format("{} sharp", sharp);
  check.difference = std::to_string(missing.size() + stray.size());
  check.bound = short_number(reach);
  check.explanation =
      "edges between facets that rounding may have made coplanar are not required to match";
  list_in_turn(check, missing, stray);
  return check;
}

}  // namespace

std::vector<Check> compare_with_soup(const Boundary& boundary, const io::PolygonSoup& soup,
                                     const MeshComparisonOptions& options) {
  const std::string label = options.label.empty() ? "against" : options.label;
  WeldedMesh mesh = weld(soup, nearest_double(options.model_rounding));
  std::optional<Check> membranes;
  if (options.membranes != nullptr && !options.membranes->membranes.empty()) {
    membranes = take_out_membranes(*options.membranes, mesh, label);
  }
  const Ours ours(boundary);
  Matching matching = match_vertices(ours, mesh);
  const Measures measures = measure(mesh);
  const FileVolume volume = file_volume(mesh);

  // First, because it finds the edges that vertices of the file lie on.
  Check vertices = check_vertices(label, ours, mesh, matching);

  std::vector<Check> checks;
  if (membranes) checks.push_back(std::move(*membranes));
  checks.push_back(check_closed(label, mesh));
  checks.push_back(check_manifold(label, ours, mesh, matching));
  checks.push_back(check_oriented(label, mesh, volume.exact < 0));
  checks.push_back(compare_figure(label, "volume", enclose_volume(boundary, working_bits),
                                  volume.exact, measures.volume_bound));
  checks.push_back(compare_figure(label, "area", enclose_area(boundary, working_bits),
                                  rational_of(measures.area), measures.area_bound));
  checks.push_back(std::move(vertices));
  checks.push_back(check_edges(label, ours, mesh, matching));
  for (Check& check : checks) check.oracle = options.oracle;
  return checks;
}

std::vector<Check> compare_with_mesh_file(const Boundary& boundary,
                                          const std::filesystem::path& file,
                                          const MeshComparisonOptions& options) {
  MeshComparisonOptions named_options = options;
  if (named_options.label.empty()) named_options.label = file.filename().string();
  try {
    return compare_with_soup(boundary, io::read_polygon_soup(file), named_options);
  } catch (const Error& error) {
    if (error.id() == ErrorId::Cancelled || error.id() == ErrorId::TimeLimit) throw;
    Check check = named(named_options.label, "readable");
    check.oracle = options.oracle;
    check.verdict = Verdict::Failed;
    check.explanation = error.what();
    return {check};
  }
}

}  // namespace exactcsg::verify
