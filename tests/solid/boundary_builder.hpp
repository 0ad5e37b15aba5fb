// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Boundaries made by hand, independent of the evaluator: from lists of faces, and from sets of unit
// cubes.

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg::test {

using Loops = std::vector<std::vector<Point3>>;  // outer ones counter-clockwise from outside

inline bool plane_less(const Plane& p, const Plane& q) { return compare(p, q) < 0; }

inline std::vector<Plane> sorted_planes(const Boundary& boundary) {
  std::vector<Plane> planes = exact_planes(boundary);
  std::sort(planes.begin(), planes.end(), plane_less);
  return planes;
}

// Newell's normal: also for loops that are not convex.
inline Plane plane_of(const std::vector<Point3>& loop) {
  Vector3 n{0, 0, 0};
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vector3 c = cross(loop[i] - loop[0], loop[i + 1] - loop[0]);
    n = {n.x + c.x, n.y + c.y, n.z + c.z};
  }
  return make_plane(n.x, n.y, n.z, -dot(n, loop[0] - Point3{0, 0, 0}));
}

// REQUIRES every side of a loop to be one maximal edge.
inline Boundary boundary_of_faces(const std::vector<Loops>& faces) {
  Boundary b;
  std::vector<Point3> vertices;
  std::vector<Plane> planes;
  for (const Loops& loops : faces) {
    for (const auto& loop : loops) vertices.insert(vertices.end(), loop.begin(), loop.end());
    planes.push_back(plane_of(loops.front()));
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  b.vertices = ExactPoints(vertices);
  std::sort(planes.begin(), planes.end(), plane_less);
  planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  b.plane_count = static_cast<std::uint32_t>(planes.size());
  const auto index = [&](const Point3& p) {
    return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), p) -
                                      vertices.begin());
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Loops& loops : faces) {
    BoundaryFace face;
    face.plane = static_cast<std::uint32_t>(
        std::lower_bound(planes.begin(), planes.end(), plane_of(loops.front()), plane_less) -
        planes.begin());
    for (const auto& loop : loops) {
      face.loops.emplace_back();
      for (const Point3& p : loop) face.loops.back().push_back(index(p));
      auto& walk = face.loops.back();
      std::rotate(walk.begin(), std::min_element(walk.begin(), walk.end()), walk.end());
      for (std::size_t i = 0; i < walk.size(); ++i) {
        const auto [low, high] = std::minmax(walk[i], walk[(i + 1) % walk.size()]);
        edges.emplace_back(low, high);
      }
    }
    b.faces.push_back(std::move(face));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const auto& [from, to] : edges) b.edges.push_back({from, to});
  std::sort(b.faces.begin(), b.faces.end(),
            [](const BoundaryFace& f, const BoundaryFace& g) { return f.loops < g.loops; });
  for (const Point3& p : vertices) {
    b.approximate.push_back({nearest_double(p.x), nearest_double(p.y), nearest_double(p.z)});
  }
  return b;
}

// REQUIRES no two facets that share an edge to be coplanar.
inline Boundary boundary_of(const Polyhedron& polyhedron,
                            const AffineMap& map = AffineMap::identity()) {
  std::vector<Loops> faces;
  for (const Facet& facet : polyhedron.facets) {
    std::vector<Point3> loop;
    for (const auto v : facet) loop.push_back(apply(map, polyhedron.vertices[v]));
    faces.push_back({loop});
  }
  return boundary_of_faces(faces);
}

using Cell = std::array<int, 3>;

// The union of closed cubes of the side given, cell (i, j, k) from side * (i, j, k) on.
inline Boundary boundary_of_cells(const std::set<Cell>& cells, const Rational& side = 1) {
  using Side = std::pair<Cell, Cell>;  // unit edges, directed
  struct Region {
    std::set<Side> sides;
  };
  std::vector<Region> regions;
  std::map<Cell, std::set<int>> directions;  // at each grid point, the axes of unit edges there
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sense : {-1, 1}) {
      // Exposed unit faces by position along the axis, with their four directed sides.
      std::map<Cell, std::vector<Side>> exposed;
      for (const Cell& c : cells) {
        Cell neighbour = c;
        neighbour[static_cast<std::size_t>(axis)] += sense;
        if (cells.count(neighbour) != 0) continue;
        const auto corner = [&](int u, int v) {
          Cell p = c;
          if (sense > 0) ++p[static_cast<std::size_t>(axis)];
          p[static_cast<std::size_t>((axis + 1) % 3)] += u;
          p[static_cast<std::size_t>((axis + 2) % 3)] += v;
          return p;
        };
        std::vector<Cell> loop{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
        if (sense < 0) std::reverse(loop.begin(), loop.end());
        for (std::size_t i = 0; i < 4; ++i) exposed[c].push_back({loop[i], loop[(i + 1) % 4]});
      }
      // Regions: unit faces connected across sides.
      std::set<Cell> seen;
      for (const auto& [start, unused] : exposed) {
        if (!seen.insert(start).second) continue;
        Region region;
        std::vector<Cell> pending{start};
        while (!pending.empty()) {
          const Cell c = pending.back();
          pending.pop_back();
          for (const Side& s : exposed[c]) {
            if (region.sides.erase({s.second, s.first}) == 0) region.sides.insert(s);
          }
          for (int k = 1; k <= 2; ++k) {
            for (const int step : {-1, 1}) {
              Cell n = c;
              n[static_cast<std::size_t>((axis + k) % 3)] += step;
              if (exposed.count(n) != 0 && seen.insert(n).second) pending.push_back(n);
            }
          }
        }
        for (const Side& s : region.sides) {
          int along = 0;
          while (s.first[static_cast<std::size_t>(along)] ==
                 s.second[static_cast<std::size_t>(along)]) {
            ++along;
          }
          directions[s.first].insert(along);
          directions[s.second].insert(along);
        }
        regions.push_back(std::move(region));
      }
    }
  }
  std::vector<Loops> faces;
  for (Region& region : regions) {
    Loops loops;
    std::vector<std::vector<Cell>> walks;
    while (!region.sides.empty()) {
      // Where outlines touch, any way on is taken.
      std::vector<Cell> walk;
      const Cell start = region.sides.begin()->first;
      Cell at = start;
      do {
        const auto s = region.sides.lower_bound({at, Cell{-1000000, 0, 0}});
        walk.push_back(at);
        at = s->second;
        region.sides.erase(s);
      } while (at != start);
      walks.push_back(std::move(walk));
    }
    for (const auto& walk : walks) {
      std::vector<Point3> loop;
      for (const Cell& p : walk) {
        if (directions[p].size() < 2) continue;
        loop.push_back({side * p[0], side * p[1], side * p[2]});
      }
      loops.push_back(std::move(loop));
    }
    // The outer loop first: it holds the smallest vertex, but where loops touch there: then it is
    // the one with the larger area; its plane's normal must be the face's.
    std::stable_sort(loops.begin(), loops.end(), [](const auto& p, const auto& q) {
      return *std::min_element(p.begin(), p.end()) < *std::min_element(q.begin(), q.end());
    });
    faces.push_back(std::move(loops));
  }
  return boundary_of_faces(faces);
}

inline std::set<Cell> block(Cell low, Cell high) {
  std::set<Cell> cells;
  for (int i = low[0]; i < high[0]; ++i) {
    for (int j = low[1]; j < high[1]; ++j) {
      for (int k = low[2]; k < high[2]; ++k) cells.insert({i, j, k});
    }
  }
  return cells;
}

inline std::set<Cell> without(std::set<Cell> cells, const std::set<Cell>& others) {
  for (const Cell& c : others) cells.erase(c);
  return cells;
}

inline std::set<Cell> with(std::set<Cell> cells, const std::set<Cell>& others) {
  cells.insert(others.begin(), others.end());
  return cells;
}

// Cells of a side of 3^-level.
inline std::set<Cell> menger_cells(int level) {
  int size = 1;
  for (int i = 0; i < level; ++i) size *= 3;
  std::set<Cell> cells;
  for (const Cell& c : block({0, 0, 0}, {size, size, size})) {
    bool kept = true;
    for (int scale = 1; scale < size; scale *= 3) {
      int middles = 0;
      for (const int x : c) middles += x / scale % 3 == 1 ? 1 : 0;
      kept = kept && middles < 2;
    }
    if (kept) cells.insert(c);
  }
  return cells;
}

inline Polyhedron tetrahedron(const Rational& a, const Rational& b, const Rational& c) {
  return {{{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// The hull of (+-a, 0, 0), (0, +-b, 0), (0, 0, +-c).
inline Polyhedron octahedron(const Rational& a, const Rational& b, const Rational& c) {
  Polyhedron p{{{a, 0, 0}, {0, b, 0}, {0, 0, c}, {-a, 0, 0}, {0, -b, 0}, {0, 0, -c}}, {}};
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    const bool x = (octant & 1U) != 0;
    const bool y = (octant & 2U) != 0;
    const bool z = (octant & 4U) != 0;
    Facet f{x ? 3U : 0U, y ? 4U : 1U, z ? 5U : 2U};
    if ((x != y) != z) std::reverse(f.begin(), f.end());
    p.facets.push_back(f);
  }
  return p;
}

}  // namespace exactcsg::test
