// SPDX-License-Identifier: Apache-2.0
// Shells, components, cavities and genus of a boundary.
//
// Round an edge, faces alternate between solid and complement. The two faces that bound one sector
// of the solid are joined, so that where the boundary touches itself it is pulled apart and the
// solid's side kept together; what is joined then are closed surfaces, the shells. Round a vertex,
// the corners of faces that follow each other across joined edges make one copy of the vertex.
//
// A cavity is a bounded component of the complement: there, faces that bound one sector of the
// complement are joined instead. That differs only if some edge has four faces or more.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "exactcsg/number/bucket_sort.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/solid/scaled_vertices.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

using Index = std::uint32_t;

[[noreturn]] void broken(const std::string& what) {
  throw Error(ErrorId::InternalError, {what, "a balanced boundary of a bounded solid"});
}

// A side of a face, walked with the face on the left seen from outside.
struct Side {
  Index from = 0;
  Index to = 0;
  Index face = 0;
};

struct Surface {
  std::vector<Side> sides;
  std::vector<Index> next;  // the side that follows in its face's outline
  std::vector<Index> previous;
  std::vector<Index> outlines;  // of each face: how many closed walks bound its interior
};

Surface sides_of(const Boundary& boundary) {
  Surface s;
  for (Index f = 0; f < boundary.faces.size(); ++f) {
    for (const auto& loop : boundary.faces[f].loops) {
      const auto begin = static_cast<Index>(s.sides.size());
      const auto n = static_cast<Index>(loop.size());
      for (Index k = 0; k < n; ++k) {
        s.sides.push_back({loop[k], loop[(k + 1) % n], f});
        s.next.push_back(begin + (k + 1) % n);
      }
    }
  }
  return s;
}

// Sorts directions in a plane counter-clockwise from the first one on.
// sine(i, j) and cosine(i, j): the signs of those of the angle from i to j.
template <class Sine, class Cosine>
void sort_round(std::vector<std::size_t>& items, const Sine& sine, const Cosine& cosine) {
  const std::size_t pivot = items.front();
  const auto half = [&](std::size_t i) {
    const Sign s = sine(pivot, i);
    if (s != Sign::Zero) return s == Sign::Positive ? 1 : 3;
    return cosine(pivot, i) == Sign::Positive ? 0 : 2;
  };
  std::sort(items.begin() + 1, items.end(), [&](std::size_t i, std::size_t j) {
    const int a = half(i);
    const int b = half(j);
    return a != b ? a < b : sine(i, j) == Sign::Positive;
  });
}

// Where one face has several corners at one vertex, its outlines touch there, and how they were cut
// into loops is arbitrary: an incoming side is followed by the outgoing one next to it across the
// face's interior, clockwise from the direction that it came from.
class OutlineRepair {
 public:
  OutlineRepair(const Boundary& boundary, Surface& surface)
      : boundary_(boundary), surface_(surface) {}

  void run() {
    std::vector<std::pair<std::uint64_t, Index>> corners;  // (face, vertex) of outgoing sides
    corners.reserve(surface_.sides.size());
    // Sides of a face are neighbours in the list: sort face by face.
    for (std::size_t begin = 0; begin < surface_.sides.size();) {
      std::size_t end = begin;
      corners.clear();
      while (end < surface_.sides.size() &&
             surface_.sides[end].face == surface_.sides[begin].face) {
        corners.emplace_back(surface_.sides[end].from, static_cast<Index>(end));
        ++end;
      }
      std::sort(corners.begin(), corners.end());
      for (std::size_t k = 0; k < corners.size();) {
        std::size_t last = k + 1;
        while (last < corners.size() && corners[last].first == corners[k].first) ++last;
        if (last > k + 1)
          repair({corners.begin() + static_cast<std::ptrdiff_t>(k),
                  corners.begin() + static_cast<std::ptrdiff_t>(last)});
        k = last;
      }
      begin = end;
    }
  }

 private:
  void repair(const std::vector<std::pair<std::uint64_t, Index>>& corners) {
    const Index vertex = static_cast<Index>(corners.front().first);
    const Plane plane =
        exact_plane(boundary_, boundary_.faces[surface_.sides[corners.front().second].face]);
    const std::array<const Integer*, 3> normal{&plane.a, &plane.b, &plane.c};
    std::size_t k = 0;
    while (sgn(*normal[k]) == 0) ++k;
    const Sign orientation = sign_of(*normal[k]);

    // Items: outgoing sides, then the incoming ones, each as a direction away from the vertex.
    std::vector<Index> sides;
    std::vector<Vector3> directions;
    for (const auto& [v, outgoing] : corners) {
      sides.push_back(outgoing);
      directions.push_back(boundary_.vertices[surface_.sides[outgoing].to] -
                           boundary_.vertices[vertex]);
    }
    const std::size_t outgoing_count = sides.size();
    for (std::size_t i = 0; i < outgoing_count; ++i) {
      const Index incoming = surface_.previous[sides[i]];
      sides.push_back(incoming);
      directions.push_back(boundary_.vertices[surface_.sides[incoming].from] -
                           boundary_.vertices[vertex]);
    }
    std::vector<std::size_t> items(sides.size());
    std::iota(items.begin(), items.end(), std::size_t{0});
    const auto sine = [&](std::size_t i, std::size_t j) {
      const Vector3 c = cross(directions[i], directions[j]);
      return sign_of(k == 0 ? c.x : k == 1 ? c.y : c.z) * orientation;
    };
    const auto cosine = [&](std::size_t i, std::size_t j) {
      return sign_of(dot(directions[i], directions[j]));
    };
    sort_round(items, sine, cosine);
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (items[i] < outgoing_count) continue;
      // Clockwise: the item before.
      const std::size_t before = items[(i + items.size() - 1) % items.size()];
      if (before >= outgoing_count) broken("a face whose sides do not alternate round a vertex");
      surface_.next[sides[items[i]]] = sides[before];
    }
  }

  const Boundary& boundary_;
  Surface& surface_;
};

void set_previous(Surface& s) {
  s.previous.resize(s.next.size());
  for (Index i = 0; i < s.next.size(); ++i) s.previous[s.next[i]] = i;
}

void count_outlines(const Boundary& boundary, Surface& s) {
  s.outlines.assign(boundary.faces.size(), 0);
  std::vector<bool> seen(s.sides.size(), false);
  for (Index i = 0; i < s.sides.size(); ++i) {
    if (seen[i]) continue;
    ++s.outlines[s.sides[i].face];
    for (Index k = i; !seen[k]; k = s.next[k]) seen[k] = true;
  }
}

// The sides of each edge, one group after the other.
struct EdgeGroups {
  std::vector<Index> sides;
  std::vector<std::size_t> begins;  // of groups, and the end
  bool some_with_more_than_two = false;
};

EdgeGroups group_by_edge(const Surface& surface, std::size_t vertices) {
  std::vector<std::pair<std::uint64_t, Index>> keyed;
  keyed.reserve(surface.sides.size());
  for (Index i = 0; i < surface.sides.size(); ++i) {
    const auto [low, high] = std::minmax(surface.sides[i].from, surface.sides[i].to);
    keyed.emplace_back((static_cast<std::uint64_t>(low) << 32U) | high, i);
  }
  sort_in_buckets(
      keyed, vertices, [](const auto& ends_and_side) { return ends_and_side.first >> 32U; },
      std::less<>());
  EdgeGroups groups;
  groups.sides.reserve(keyed.size());
  for (std::size_t k = 0; k < keyed.size(); ++k) {
    if (k == 0 || keyed[k].first != keyed[k - 1].first) groups.begins.push_back(k);
    groups.sides.push_back(keyed[k].second);
  }
  groups.begins.push_back(keyed.size());
  for (std::size_t g = 0; g + 1 < groups.begins.size(); ++g) {
    const std::size_t count = groups.begins[g + 1] - groups.begins[g];
    if (count % 2 != 0) broken("an edge with " + std::to_string(count) + " faces");
    if (count > 2) groups.some_with_more_than_two = true;
  }
  return groups;
}

enum class Joined { Solid, Complement };

// Of every side the one that it is joined with across the edge.
class Twins {
 public:
  Twins(const Boundary& boundary, const Surface& surface, const EdgeGroups& groups)
      : boundary_(boundary), surface_(surface), groups_(groups) {}

  std::vector<Index> of(Joined joined) const {
    std::vector<Index> twins(surface_.sides.size());
    for (std::size_t g = 0; g + 1 < groups_.begins.size(); ++g) {
      const std::span<const Index> group(groups_.sides.data() + groups_.begins[g],
                                         groups_.begins[g + 1] - groups_.begins[g]);
      if (group.size() == 2) {
        if (ascending(group[0]) == ascending(group[1])) broken("an edge walked twice one way");
        twins[group[0]] = group[1];
        twins[group[1]] = group[0];
      } else {
        join_sectors(group, joined, twins);
      }
    }
    return twins;
  }

 private:
  bool ascending(Index side) const { return surface_.sides[side].from < surface_.sides[side].to; }

  // Looking along the edge e from its low end to its high end, the face with the outward normal n
  // lies in the direction of n x e if it ascends, else of -n x e: turned by the same right angle,
  // that is s n with s = 1 or -1. Counter-clockwise about e, the complement follows an ascending
  // face (e x (n x e) = n), the solid a descending one.
  void join_sectors(std::span<const Index> group, Joined joined, std::vector<Index>& twins) const {
    const Side& side = surface_.sides[group.front()];
    const auto [low, high] = std::minmax(side.from, side.to);
    const Point3& p = boundary_.vertices[low];
    const Point3& q = boundary_.vertices[high];
    std::size_t k = 0;
    while (coordinate(p, k) == coordinate(q, k)) ++k;
    const Sign direction = sign_of(cmp(coordinate(q, k), coordinate(p, k)));

    std::vector<std::array<Integer, 3>> normals;
    for (const Index s : group) {
      const Plane plane = exact_plane(boundary_, boundary_.faces[surface_.sides[s].face]);
      if (ascending(s)) {
        normals.push_back({plane.a, plane.b, plane.c});
      } else {
        normals.push_back({-plane.a, -plane.b, -plane.c});
      }
    }
    std::vector<std::size_t> items(group.size());
    std::iota(items.begin(), items.end(), std::size_t{0});
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    const auto sine = [&](std::size_t a, std::size_t b) {
      const Integer c = normals[a][i] * normals[b][j] - normals[a][j] * normals[b][i];
      return sign_of(c) * direction;
    };
    const auto cosine = [&](std::size_t a, std::size_t b) {
      const Integer c = normals[a][0] * normals[b][0] + normals[a][1] * normals[b][1] +
                        normals[a][2] * normals[b][2];
      return sign_of(c);
    };
    sort_round(items, sine, cosine);
    for (std::size_t n = 0; n < items.size(); ++n) {
      const Index first = group[items[n]];
      const Index second = group[items[(n + 1) % items.size()]];
      if (ascending(first) == ascending(second)) {
        broken("an edge round which solid and complement do not alternate");
      }
      if (ascending(first) == (joined == Joined::Complement)) {
        twins[first] = second;
        twins[second] = first;
      }
    }
  }

  const Boundary& boundary_;
  const Surface& surface_;
  const EdgeGroups& groups_;
};

struct Shells {
  std::vector<Index> of_face;
  Index count = 0;
};

Shells shells_of(const Boundary& boundary, const Surface& surface,
                 const std::vector<Index>& twins) {
  std::vector<Index> parent(boundary.faces.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto find = [&](Index f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  for (Index i = 0; i < twins.size(); ++i) {
    parent[find(surface.sides[i].face)] = find(surface.sides[twins[i]].face);
  }
  Shells shells{std::vector<Index>(parent.size()), 0};
  for (Index f = 0; f < parent.size(); ++f) {
    if (parent[f] == f) shells.of_face[f] = shells.count++;
  }
  for (Index f = 0; f < parent.size(); ++f) shells.of_face[f] = shells.of_face[find(f)];
  return shells;
}

// Orbits of sides round their first vertices, from face to face across joined edges.
std::uint64_t count_vertex_copies(const Surface& surface, const std::vector<Index>& twins) {
  std::vector<bool> seen(surface.sides.size(), false);
  std::uint64_t copies = 0;
  for (Index i = 0; i < seen.size(); ++i) {
    if (seen[i]) continue;
    ++copies;
    for (Index k = i; !seen[k]; k = twins[surface.previous[k]]) seen[k] = true;
  }
  return copies;
}

// The signs of the shells' volumes: in doubles where these decide, else in ever longer integers (no
// shell has volume zero).
class ShellVolumes {
 public:
  ShellVolumes(const Boundary& boundary, const Shells& shells)
      : boundary_(boundary), shells_(shells), signs_(shells.count, Sign::Zero) {}

  std::vector<Sign> signs() {
    decide_by_doubles();
    constexpr int longest = 1 << 20;
    for (int bits = 128; undecided(); bits *= 2) {
      if (bits > longest) broken("a shell without volume");
      decide_by_integers(bits);
    }
    return std::move(signs_);
  }

 private:
  bool undecided() const {
    return std::find(signs_.begin(), signs_.end(), Sign::Zero) != signs_.end();
  }

  // Six times the volume, from a vertex of the shell; bound as in polyhedron_signs.cpp: each
  // determinant of entries up to D, off by at most e each, is off by 20 e D^2 + 32 u D^3, and each
  // of n partial sums, at most 6 n D^3, rounds once.
  void decide_by_doubles() {
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    struct Sum {
      double value = 0;
      double largest = 0;
      double terms = 0;
      Index reference = 0;
      bool started = false;
    };
    double magnitude = 0;
    for (const auto& p : boundary_.approximate) {
      for (const double c : p) magnitude = std::max(magnitude, std::abs(c));
    }
    std::vector<Sum> sums(shells_.count);
    for (Index f = 0; f < boundary_.faces.size(); ++f) {
      Sum& sum = sums[shells_.of_face[f]];
      for (const auto& loop : boundary_.faces[f].loops) {
        if (!std::exchange(sum.started, true)) sum.reference = loop.front();
        const auto a = from(sum.reference, loop.front(), sum.largest);
        auto b = a;
        for (std::size_t k = 1; k < loop.size(); ++k) {
          const auto c = from(sum.reference, loop[k], sum.largest);
          sum.value += (a[1] * b[2] - a[2] * b[1]) * c[0] + (a[2] * b[0] - a[0] * b[2]) * c[1] +
                       (a[0] * b[1] - a[1] * b[0]) * c[2];
          sum.terms += 1;
          b = c;
        }
      }
    }
    for (std::size_t s = 0; s < sums.size(); ++s) {
      const double d = sums[s].largest;
      const double e = ulp * (2 * magnitude + d);
      const double bound = sums[s].terms * d * d * (20 * e + (32 + 8 * sums[s].terms) * ulp * d);
      if (!(d > 1e-70 && magnitude < 1e70 && e < d / 128)) continue;
      if (sums[s].value > bound) signs_[s] = Sign::Positive;
      if (sums[s].value < -bound) signs_[s] = Sign::Negative;
    }
  }

  std::array<double, 3> from(Index reference, Index v, double& largest) const {
    std::array<double, 3> d{};
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] = boundary_.approximate[v][i] - boundary_.approximate[reference][i];
      largest = std::max(largest, std::abs(d[i]));
    }
    return d;
  }

  // Bound as in measures.cpp.
  void decide_by_integers(int bits) {
    const ScaledVertices vertices = scale_vertices(boundary_, bits);
    std::vector<Integer> sums(shells_.count);
    std::vector<unsigned long> sides(shells_.count, 0);
    for (Index f = 0; f < boundary_.faces.size(); ++f) {
      const Index s = shells_.of_face[f];
      if (signs_[s] != Sign::Zero) continue;
      for (const auto& loop : boundary_.faces[f].loops) {
        sums[s] += loop_volume(vertices, loop);
        sides[s] += loop.size();
      }
    }
    const Integer& m = vertices.largest;
    const Integer n = m + 1;
    const Integer error = vertices.exact ? Integer(0) : Integer(6 * (n * n * n - m * m * m));
    for (Index s = 0; s < shells_.count; ++s) {
      if (signs_[s] != Sign::Zero) continue;
      const Integer bound = error * sides[s];
      if (sums[s] > bound) signs_[s] = Sign::Positive;
      if (sums[s] < -bound) signs_[s] = Sign::Negative;
      if (vertices.exact && signs_[s] == Sign::Zero) broken("a shell without volume");
    }
  }

  static Integer loop_volume(const ScaledVertices& vertices, const std::vector<Index>& loop) {
    std::array<Integer, 3> area;
    std::array<Integer, 3> p;
    std::array<Integer, 3> q;
    set_coordinates(q, vertices, loop.front());
    for (std::size_t k = 0; k < loop.size(); ++k) {
      p.swap(q);
      set_coordinates(q, vertices, loop[(k + 1) % loop.size()]);
      for (std::size_t i = 0; i < 3; ++i) {
        area[i] += p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3];
      }
    }
    return q[0] * area[0] + q[1] * area[1] + q[2] * area[2];
  }

  const Boundary& boundary_;
  const Shells& shells_;
  std::vector<Sign> signs_;
};

std::uint64_t count_sign(const Boundary& boundary, const Shells& shells, Sign sign) {
  const std::vector<Sign> signs = ShellVolumes(boundary, shells).signs();
  return static_cast<std::uint64_t>(std::count(signs.begin(), signs.end(), sign));
}

}  // namespace

Topology topology(const Boundary& boundary) {
  Topology result;
  result.vertices = boundary.vertices.size();
  result.edges = boundary.edges.size();
  result.faces = boundary.faces.size();
  if (boundary.empty()) return result;

  Surface surface = sides_of(boundary);
  set_previous(surface);
  OutlineRepair(boundary, surface).run();
  set_previous(surface);
  count_outlines(boundary, surface);
  const EdgeGroups groups = group_by_edge(surface, boundary.vertices.size());
  const Twins twins(boundary, surface, groups);

  const std::vector<Index> round_solid = twins.of(Joined::Solid);
  const Shells shells = shells_of(boundary, surface, round_solid);
  result.components = count_sign(boundary, shells, Sign::Positive);
  if (groups.some_with_more_than_two) {
    const Shells of_complement = shells_of(boundary, surface, twins.of(Joined::Complement));
    result.cavities = count_sign(boundary, of_complement, Sign::Negative);
  } else {
    result.cavities = shells.count - result.components;
  }

  // Euler's characteristic of all shells together, 2 - 2 genus each. A face with n outlines is a
  // sphere with n holes: 2 - n.
  std::int64_t characteristic =
      static_cast<std::int64_t>(count_vertex_copies(surface, round_solid)) -
      static_cast<std::int64_t>(surface.sides.size() / 2);
  for (const Index n : surface.outlines) characteristic += 2 - static_cast<std::int64_t>(n);
  result.genus = static_cast<std::int64_t>(shells.count) - characteristic / 2;
  if (characteristic % 2 != 0) broken("an odd Euler characteristic");
  return result;
}

}  // namespace exactcsg
