// SPDX-License-Identifier: GPL-3.0-or-later
// Counts of components, cavities and handles, on solids whose counts can be seen.
#include <gtest/gtest.h>

#include <chrono>
#include <iostream>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/support/error.hpp"
#include "solid/boundary_builder.hpp"
#include "time_limits.hpp"

namespace exactcsg {

inline std::ostream& operator<<(std::ostream& out, const Topology& t) {
  return out << "V " << t.vertices << " E " << t.edges << " F " << t.faces << " components "
             << t.components << " cavities " << t.cavities << " genus " << t.genus;
}

namespace {

using namespace test;

Topology make(std::uint64_t v, std::uint64_t e, std::uint64_t f, std::uint64_t components,
              std::uint64_t cavities, std::int64_t genus) {
  return {v, e, f, components, cavities, genus};
}

#define EXPECT_TOPOLOGY(cells, expected)                       \
  do {                                                         \
    const Topology found = topology(boundary_of_cells(cells)); \
    EXPECT_TRUE(found == (expected)) << found;                 \
  } while (false)

TEST(TopologyOf, Nothing) { EXPECT_EQ(topology(Boundary{}), Topology{}); }

TEST(TopologyOf, SimpleSolids) {
  EXPECT_TOPOLOGY(block({0, 0, 0}, {1, 1, 1}), make(8, 12, 6, 1, 0, 0));
  EXPECT_TOPOLOGY((std::set<Cell>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), make(12, 18, 8, 1, 0, 0));
  const Topology t = topology(boundary_of(tetrahedron(1, 1, 1)));
  EXPECT_TRUE(t == make(4, 6, 4, 1, 0, 0)) << t;
}

TEST(TopologyOf, ThroughHolesAndCavities) {
  const auto plate = block({0, 0, 0}, {5, 3, 1});
  // Top and bottom are faces with holes.
  EXPECT_TOPOLOGY(without(plate, {{1, 1, 0}}), make(16, 24, 10, 1, 0, 1));
  EXPECT_TOPOLOGY(without(plate, {{1, 1, 0}, {3, 1, 0}}), make(24, 36, 14, 1, 0, 2));
  const auto cube = block({0, 0, 0}, {5, 5, 5});
  EXPECT_TOPOLOGY(without(cube, {{1, 1, 1}}), make(16, 24, 12, 1, 1, 0));
  EXPECT_TOPOLOGY(without(cube, {{1, 1, 1}, {3, 3, 3}}), make(24, 36, 18, 1, 2, 0));
  // A cavity with an island: two components, one cavity.
  EXPECT_TOPOLOGY(with(without(cube, block({1, 1, 1}, {4, 4, 4})), {{2, 2, 2}}),
                  make(24, 36, 18, 2, 1, 0));
  // A cavity in the form of a ring: a torus.
  EXPECT_TOPOLOGY(without(cube, without(block({1, 1, 2}, {4, 4, 3}), {{2, 2, 2}})),
                  make(8 + 16, 12 + 24, 6 + 10, 1, 1, 1));
}

TEST(TopologyOf, BoxesThatTouch) {
  // Along an edge, with four faces round it; at a vertex; along part of an edge.
  EXPECT_TOPOLOGY((std::set<Cell>{{0, 0, 0}, {1, 1, 0}}), make(14, 23, 12, 2, 0, 0));
  EXPECT_TOPOLOGY((std::set<Cell>{{0, 0, 0}, {1, 1, 1}}), make(15, 24, 12, 2, 0, 0));
  EXPECT_TOPOLOGY((std::set<Cell>{{0, 0, 0}, {0, 0, 1}, {1, 1, 0}}), make(15, 24, 12, 2, 0, 0));
  // Every second cube of a 3 x 3 x 3 block, 14 with its corners.
  std::set<Cell> checkers;
  for (const Cell& c : block({0, 0, 0}, {3, 3, 3})) {
    if ((c[0] + c[1] + c[2]) % 2 == 0) checkers.insert(c);
  }
  const Topology t = topology(boundary_of_cells(checkers));
  EXPECT_EQ(t.components, 14U);
  EXPECT_EQ(t.genus, 0);
  // Of the 13 cubes left out only the one in the middle is not open to the outside: its six sides
  // are covered, and what it meets along edges are different components.
  EXPECT_EQ(t.cavities, 1U);
}

TEST(TopologyOf, CavitiesThatTouch) {
  const auto cube = block({0, 0, 0}, {4, 4, 4});
  // Along an edge: two bounded components of the complement. The solid's side kept together, they
  // open into each other: one sphere; V' - E' + F' = 14 - 24 + 12 = 2.
  EXPECT_TOPOLOGY(without(cube, {{1, 1, 1}, {2, 2, 1}}), make(8 + 14, 12 + 23, 18, 1, 2, 0));
  // At a vertex: the solid's boundary round it is two circles, two spheres.
  EXPECT_TOPOLOGY(without(cube, {{1, 1, 1}, {2, 2, 2}}), make(8 + 15, 12 + 24, 18, 1, 2, 0));
  // A cavity that touches the outside along an edge of a notch.
  const Topology notch = topology(boundary_of_cells(without(cube, {{0, 1, 1}, {1, 2, 1}})));
  EXPECT_EQ(notch.components, 1U);
  EXPECT_EQ(notch.cavities, 1U);
  EXPECT_EQ(notch.genus, 0);
}

// A bar bent to a C whose ends touch along an edge: no handle, and the outlines of top and bottom
// come twice to one vertex.
TEST(TopologyOf, OutlinesThatTouchThemselves) {
  const auto c = without(block({0, 0, 0}, {3, 3, 1}), {{0, 0, 0}, {1, 1, 0}});
  const Topology t = topology(boundary_of_cells(c));
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.cavities, 0U);
  EXPECT_EQ(t.genus, 0);
  // The same closed by a lid, which leaves a pocket whose complement's corner touches the outside.
  const auto closed = with(c, block({0, 0, 1}, {3, 3, 2}));
  const Topology u = topology(boundary_of_cells(closed));
  EXPECT_EQ(u.components, 1U);
  EXPECT_EQ(u.cavities, 0U);
}

// However the outlines that touch were cut into loops, the counts are the same.
TEST(TopologyOf, DoesNotDependOnTheCutOfLoops) {
  const auto c = without(block({0, 0, 0}, {3, 3, 1}), {{0, 0, 0}, {1, 1, 0}});
  const Boundary once = boundary_of_cells(c);
  Boundary cut = once;
  int changed = 0;
  for (BoundaryFace& face : cut.faces) {
    if (face.loops.size() == 1) {
      auto& loop = face.loops.front();
      for (std::size_t i = 0; i < loop.size() && face.loops.size() == 1; ++i) {
        for (std::size_t j = i + 1; j < loop.size(); ++j) {
          if (loop[i] != loop[j]) continue;
          const auto at = [&](std::size_t k) {
            return loop.begin() + static_cast<std::ptrdiff_t>(k);
          };
          const std::vector<std::uint32_t> part(at(i), at(j));
          loop.erase(at(i), at(j));
          face.loops.push_back(part);
          ++changed;
          break;
        }
      }
    } else if (face.loops.size() == 2) {
      auto& loops = face.loops;
      for (std::size_t i = 0; i < loops[0].size() && loops.size() == 2; ++i) {
        for (std::size_t j = 0; j < loops[1].size(); ++j) {
          if (loops[0][i] != loops[1][j]) continue;
          std::rotate(loops[1].begin(), loops[1].begin() + static_cast<std::ptrdiff_t>(j),
                      loops[1].end());
          loops[0].insert(loops[0].begin() + static_cast<std::ptrdiff_t>(i), loops[1].begin(),
                          loops[1].end());
          loops.pop_back();
          ++changed;
          break;
        }
      }
    }
  }
  EXPECT_EQ(changed, 2);  // top and bottom
  EXPECT_TRUE(topology(cut) == topology(once));
}

TEST(TopologyOf, MengerSponges) {
  // A handlebody has the characteristic 1 - genus. Level 1: 20 cubes and 24 squares where they meet
  // (edges cancel), 20 - 24 = 1 - 5. Level 2: 20 sponges of 1 - 5 that meet in 24 squares with
  // holes, of characteristic 0: 20 * -4 = 1 - 81.
  const std::array<std::int64_t, 3> genus{0, 5, 81};
  for (int n = 0; n < 3; ++n) {
    const Topology t = topology(boundary_of_cells(menger_cells(n)));
    EXPECT_EQ(t.genus, genus[static_cast<std::size_t>(n)]) << n;
    EXPECT_EQ(t.components, 1U);
    EXPECT_EQ(t.cavities, 0U);
  }
}

// The sign of a shell's volume where no double sees it: a tetrahedron as thin as 10^-40.
TEST(TopologyOf, ThinShells) {
  const Rational thin = parse_rational("1e-40").value();
  const Topology t = topology(boundary_of(tetrahedron(1, 1, thin)));
  EXPECT_TRUE(t == make(4, 6, 4, 1, 0, 0)) << t;
}

TEST(TopologyOf, BrokenBoundariesAreRefused) {
  Boundary b = boundary_of(tetrahedron(1, 1, 1));
  b.faces.pop_back();
  try {
    topology(b);
    FAIL() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(e.id(), ErrorId::InternalError);
  }
}

TEST(TopologyOf, LargeBoundariesAreFast) {
  // 500 000 edges: 42 000 octahedra.
  Boundary b;
  const Polyhedron o = octahedron(1, 1, 1);
  const int n = 42000;
  for (int i = 0; i < n; ++i) {
    const auto first = static_cast<std::uint32_t>(b.vertices.size());
    for (const Point3& p : o.vertices) {
      b.vertices.push_back({p.x + 3 * i, p.y, p.z});
      b.approximate.push_back(
          {nearest_double(p.x + 3 * i), nearest_double(p.y), nearest_double(p.z)});
    }
    for (const Facet& f : o.facets) {
      b.faces.push_back({0, {{first + f[0], first + f[1], first + f[2]}}});
    }
  }
  b.plane_count = 1;  // not looked at where edges have two faces
  b.edges.resize(12 * n);
  const auto start = std::chrono::steady_clock::now();
  const Topology t = topology(b);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("seconds", std::to_string(seconds));
  std::cout << "topology " << seconds << " s\n";
  EXPECT_EQ(t.components, static_cast<std::uint64_t>(n));
  EXPECT_EQ(t.genus, 0);
  EXPECT_LT(seconds, 10 * test::sanitizer_slowdown);  // loose: other work may run on the machine
}

}  // namespace
}  // namespace exactcsg
