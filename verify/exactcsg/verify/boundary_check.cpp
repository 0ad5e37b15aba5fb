// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/boundary_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/solid/measures.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/facet_complex.hpp"

namespace exactcsg::verify {
namespace {

using Edge = std::array<std::uint32_t, 2>;

constexpr int enclosure_bits = 128;
constexpr int shown_digits = 17;

// Everything after this may index freely. False: indices are out of range, nothing else was
// checked.
bool check_indices(const Boundary& b, Check& check) {
  const std::size_t n = b.vertices.size();
  for (const BoundaryEdge& edge : b.edges) {
    if (edge.from >= n || edge.to >= n) {
      add_mismatch(check, {fmt::format("edge {}-{} of {} vertices", edge.from, edge.to, n), {}});
    }
  }
  for (std::size_t f = 0; f < b.faces.size(); ++f) {
    if (b.faces[f].plane >= b.plane_count) {
      add_mismatch(check, {fmt::format("face {} names plane {}", f, b.faces[f].plane), {}});
    }
    for (const auto& loop : b.faces[f].loops) {
      for (const std::uint32_t v : loop) {
        if (v >= n) add_mismatch(check, {fmt::format("face {} names vertex {}", f, v), {}});
      }
    }
  }
  return check.mismatch_count == 0;
}

void check_order(const Boundary& b, Check& check) {
  for (std::size_t i = 1; i < b.vertices.size(); ++i) {
    if (b.vertices[i - 1] < b.vertices[i]) continue;
    add_mismatch(check, {"vertices not sorted and distinct: " + describe(b.vertices[i]),
                         {approximate(b.vertices[i])}});
  }
  if (b.approximate.size() != b.vertices.size()) {
    add_mismatch(check, {fmt::format("{} approximate positions for {} vertices",
                                     b.approximate.size(), b.vertices.size()),
                         {}});
  }
  for (std::size_t i = 0; i < std::min(b.approximate.size(), b.vertices.size()); ++i) {
    if (b.approximate[i] != approximate(b.vertices[i])) {
      add_mismatch(check, {"approximate position is not the nearest: " + describe(b.vertices[i]),
                           {b.approximate[i]}});
    }
  }
  for (std::size_t i = 0; i < b.edges.size(); ++i) {
    const BoundaryEdge& edge = b.edges[i];
    if (edge.from < edge.to && (i == 0 || b.edges[i - 1] < edge)) continue;
    const ExactEdge place{b.vertices[edge.from], b.vertices[edge.to]};
    add_mismatch(check, {"edges not sorted and distinct: " + describe(place),
                         {approximate(place[0]), approximate(place[1])}});
  }
}

void check_order_of_faces(const Boundary& b, Check& check) {
  const auto where = [&](const BoundaryFace& face) -> std::vector<std::array<double, 3>> {
    if (face.loops.empty() || face.loops.front().empty()) return {};
    return {approximate(b.vertices[face.loops.front().front()])};
  };
  std::uint32_t next_plane = 0;
  for (std::size_t f = 0; f < b.faces.size(); ++f) {
    const BoundaryFace& face = b.faces[f];
    if (f > 0 && !(b.faces[f - 1].loops < face.loops)) {
      add_mismatch(check, {fmt::format("face {} is not sorted by its loops", f), where(face)});
    }
    if (face.plane > next_plane) {
      add_mismatch(check, {fmt::format("the plane of face {} is not numbered by its first face", f),
                           where(face)});
    }
    next_plane = std::max(next_plane, face.plane + 1);
  }
}

// By number: each has a face and a normal, and no two are the same.
void check_planes(const Boundary& b, const std::vector<Plane>& planes, Check& check) {
  std::vector<bool> used(planes.size(), false);
  for (const BoundaryFace& face : b.faces) used[face.plane] = true;
  const auto earlier = [](const Plane& p, const Plane& q) { return compare(p, q) < 0; };
  std::map<Plane, std::size_t, decltype(earlier)> known(earlier);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const Plane& plane = planes[p];
    if (!used[p]) {
      add_mismatch(check, {fmt::format("plane {} of no face", p), {}});
    } else if (plane.a == 0 && plane.b == 0 && plane.c == 0) {
      add_mismatch(check,
                   {fmt::format("plane {}: a face that does not turn at its corner", p), {}});
    } else if (const auto [first, is_new] = known.emplace(plane, p); !is_new) {
      add_mismatch(check, {fmt::format("planes {} and {} are the same: {}", first->second, p,
                                       describe(plane)),
                           {}});
    }
  }
}

// The area of a face as a multiple of its normal, positive if the loops turn counter-clockwise; and
// whether every loop is a cycle of at least three vertices in the plane.
void check_face(const Boundary& b, const std::vector<Plane>& planes, std::size_t f, Check& check) {
  const BoundaryFace& face = b.faces[f];
  const Plane& plane = planes[face.plane];
  Rational total = 0;
  std::size_t outer = 0;
  for (const auto& loop : face.loops) {
    if (loop.size() < 3) {
      add_mismatch(check, {fmt::format("a loop of face {} has {} vertices", f, loop.size()), {}});
      continue;
    }
    if (*std::min_element(loop.begin(), loop.end()) != loop.front()) {
      add_mismatch(check,
                   {fmt::format("a loop of face {} does not start at its smallest vertex", f),
                    {approximate(b.vertices[loop.front()])}});
    }
    const Point3& origin = b.vertices[loop.front()];
    Rational turn = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3& p = b.vertices[loop[i]];
      if (side(plane, p) != Sign::Zero) {
        add_mismatch(check, {fmt::format("vertex {} is not in the plane of its face {}",
                                         describe(p), describe(plane)),
                             {approximate(p)}});
      }
      const Vector3 c = cross(p - origin, b.vertices[loop[(i + 1) % loop.size()]] - origin);
      turn += plane.a * c.x + plane.b * c.y + plane.c * c.z;
    }
    if (turn == 0) {
      add_mismatch(check,
                   {fmt::format("a loop of face {} encloses no area", f), {approximate(origin)}});
    }
    if (turn > 0) ++outer;
    total += turn;
  }
  if (total > 0 && outer > 0) return;
  Mismatch mismatch{fmt::format("face {} turns against its plane {}", f, describe(plane)), {}};
  if (!face.loops.empty()) {
    for (const std::uint32_t v : face.loops.front()) {
      mismatch.where.push_back(approximate(b.vertices[v]));
    }
  }
  add_mismatch(check, std::move(mismatch));
}

void check_balance(const Boundary& b, Check& check) {
  std::map<Edge, std::array<int, 2>> uses;
  for (const BoundaryEdge& edge : b.edges) uses[{edge.from, edge.to}] = {0, 0};
  const auto place = [&](const Edge& edge) {
    return ExactEdge{b.vertices[edge[0]], b.vertices[edge[1]]};
  };
  const auto complain = [&](const Edge& edge, const std::string& text) {
    add_mismatch(check, {text + ": " + describe(place(edge)),
                         {approximate(b.vertices[edge[0]]), approximate(b.vertices[edge[1]])}});
  };
  for (const BoundaryFace& face : b.faces) {
    for (const auto& loop : face.loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t u = loop[i];
        const std::uint32_t v = loop[(i + 1) % loop.size()];
        const Edge edge{std::min(u, v), std::max(u, v)};
        const auto found = uses.find(edge);
        if (found == uses.end()) {
          complain(edge, "a side of a face is no edge of the boundary");
        } else {
          ++found->second[u < v ? 0 : 1];
        }
      }
    }
  }
  for (const auto& [edge, count] : uses) {
    if (count[0] != count[1]) {
      complain(edge, fmt::format("edge walked {} times forward and {} times backward", count[0],
                                 count[1]));
    } else if (count[0] == 0) {
      complain(edge, "edge of no face");
    }
  }
}

void check_vertices(const Boundary& b, Check& check) {
  std::vector<std::vector<std::uint32_t>> around(b.vertices.size());
  for (const BoundaryEdge& edge : b.edges) {
    around[edge.from].push_back(edge.to);
    around[edge.to].push_back(edge.from);
  }
  for (std::size_t v = 0; v < b.vertices.size(); ++v) {
    bool turns = false;
    for (std::size_t i = 1; i < around[v].size() && !turns; ++i) {
      turns = !(cross(b.vertices[around[v][0]] - b.vertices[v],
                      b.vertices[around[v][i]] - b.vertices[v]) == Vector3{0, 0, 0});
    }
    if (turns) continue;
    add_mismatch(
        check, {"vertex where edges of fewer than two directions meet: " + describe(b.vertices[v]),
                {approximate(b.vertices[v])}});
  }
}

Check figure(const std::string& name) {
  Check check;
  check.oracle = "boundary";
  check.name = name;
  return check;
}

}  // namespace

Check check_boundary_laws(const Boundary& boundary) {
  Check check = figure("boundary: laws");
  check.ours = fmt::format("{} / {} / {}", boundary.vertices.size(), boundary.edges.size(),
                           boundary.faces.size());
  check.theirs = "contract";
  check.bound = "0";
  check.explanation =
      "vertices / edges / faces: sorted, planar, balanced, oriented, no straight vertex";
  if (check_indices(boundary, check)) {
    check_order(boundary, check);
    check_order_of_faces(boundary, check);
    const std::vector<Plane> planes = exact_planes(boundary);
    check_planes(boundary, planes, check);
    for (std::size_t f = 0; f < boundary.faces.size(); ++f) check_face(boundary, planes, f, check);
    check_balance(boundary, check);
    check_vertices(boundary, check);
  }
  check.difference = std::to_string(check.mismatch_count);
  return check;
}

std::vector<Check> check_measures(const Boundary& boundary) {
  std::vector<Check> checks;
  const VolumeSum sum = volume_sum(boundary);
  const Rational own = sum.exact ? *sum.exact : parse_rational(sum.decimal).value_or(Rational(0));
  const Rational slack = sum.exact ? Rational(0) : Rational(abs(own) / 10'000'000'000'000'000L);

  Check volume = figure("boundary: volume");
  const Enclosure enclosed = enclose_volume(boundary, enclosure_bits);
  volume.ours = to_decimal(Rational((enclosed.lower + enclosed.upper) / 2), shown_digits);
  volume.theirs = sum.decimal;
  volume.bound = "enclosure of 128 bits";
  if (own < enclosed.lower - slack || own > enclosed.upper + slack) {
    volume.verdict = Verdict::Failed;
    volume.explanation = "the divergence sum lies outside the enclosure";
  }
  const auto exact = exact_volume(boundary);
  if (exact && sum.exact && *exact != *sum.exact) {
    volume.verdict = Verdict::Failed;
    volume.explanation = "exact volume and divergence sum are different rationals";
  }
  if (!boundary.empty() && own <= 0) {
    volume.verdict = Verdict::Failed;
    volume.explanation = "the volume is not positive: the boundary is inside out";
  }
  checks.push_back(std::move(volume));

  Check counts = figure("boundary: counts");
  const Topology topo = topology(boundary);
  counts.ours = fmt::format("{} / {} / {}", topo.vertices, topo.edges, topo.faces);
  counts.theirs = fmt::format("{} / {} / {}", boundary.vertices.size(), boundary.edges.size(),
                              boundary.faces.size());
  counts.bound = "0";
  if (counts.ours != counts.theirs) {
    counts.verdict = Verdict::Failed;
    counts.explanation = "topology counts other vertices, edges or faces than the boundary has";
  }
  checks.push_back(std::move(counts));
  return checks;
}

}  // namespace exactcsg::verify
