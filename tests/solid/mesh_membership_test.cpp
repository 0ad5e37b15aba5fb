// SPDX-License-Identifier: GPL-3.0-or-later
// Points against meshes whose sets are known: boxes with boxes as cavities and spikes of an
// octahedron, from all facets. The expected value is the inequality of the set.

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "exactcsg/solid/mesh_membership.hpp"
#include "solid/polyhedra.hpp"

namespace exactcsg {
namespace {

using csg::Membership;

class MeshPoints {
 public:
  explicit MeshPoints(Polyhedron polyhedron)
      : scene_(make_scene(Solid::primitive(Primitive{make_mesh(std::move(polyhedron))}))) {
    for (const SceneFacet& facet : scene_.facets) {
      polygons_.push_back({facet.plane, scene_.corners_of(facet)});
    }
  }

  Membership at(const std::array<double, 3>& place) const {
    TierStatistics statistics;
    const Vertex point = between_walls(scene_.geometry, place);
    return mesh_membership(scene_.geometry, point, polygons_, statistics);
  }

 private:
  Scene scene_;
  std::vector<FacetPolygon> polygons_;
};

// On no facet of the meshes below, whose corners have short fractions.
std::vector<std::array<double, 3>> random_places(double reach) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate(-reach, reach);
  std::vector<std::array<double, 3>> places;
  for (int i = 0; i < 500; ++i) {
    places.push_back({coordinate(random), coordinate(random), coordinate(random)});
    for (double& x : places.back()) x = round_wall_position(x);
  }
  return places;
}

bool is_within(const std::array<double, 3>& p, double lower, double upper) {
  return std::ranges::all_of(p, [&](double x) { return lower < x && x < upper; });
}

TEST(MeshMembership, ABoxWithACavity) {
  const MeshPoints mesh(
      test::together(test::triangulated(test::box_polyhedron(-2, -2, -2, 2, 2, 2)),
                     test::reversed(test::box_polyhedron(-1, -1, -1, 1, 1, 1))));
  for (const auto& place : random_places(3)) {
    const bool inside = is_within(place, -2, 2) && !is_within(place, -1, 1);
    EXPECT_EQ(mesh.at(place), inside ? Membership::In : Membership::Out);
  }
}

// A grid of lines from a point to the middles of facets passes through many sides and corners.
TEST(MeshMembership, PointsInGeneralAndSpecialPosition) {
  const MeshPoints mesh(
      test::together(test::triangulated(test::box_polyhedron(-2, -2, -2, 2, 2, 2)),
                     test::reversed(test::box_polyhedron(-1, -1, -1, 1, 1, 1))));
  for (const double x : {-2.5, -1.5, 0.0, 0.5, 1.5}) {
    for (const double y : {-1.5, 0.0, 1.25}) {
      for (const double z : {-1.5, 0.0, 0.5}) {
        const std::array<double, 3> place{x, y, z};
        const bool inside = is_within(place, -2, 2) && !is_within(place, -1, 1);
        EXPECT_EQ(mesh.at(place), inside ? Membership::In : Membership::Out);
      }
    }
  }
}

// Coordinates far from the origin: doubles leave few bits of the octahedron.
TEST(MeshMembership, ATinyOctahedronFarAway) {
  for (const Rational& size : {Rational(1), Rational(1, 1L << 20), Rational(1, 1L << 45)}) {
    const Rational far = 1000;
    Polyhedron octahedron;
    for (const int axis : {0, 1, 2}) {
      for (const int sense : {1, -1}) {
        std::array<Rational, 3> at{far, far, far};
        at[static_cast<std::size_t>(axis)] += sense * size;
        octahedron.vertices.push_back({at[0], at[1], at[2]});
      }
    }
    for (const std::uint32_t x : {0U, 1U}) {
      for (const std::uint32_t y : {2U, 3U}) {
        for (const std::uint32_t z : {4U, 5U}) {
          const bool turned = ((x + y + z) & 1U) != 0;
          octahedron.facets.push_back(turned ? Facet{x, z, y} : Facet{x, y, z});
        }
      }
    }
    const MeshPoints mesh(octahedron);
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> offset(-1, 1);
    for (int i = 0; i < 200; ++i) {
      std::array<double, 3> place{};
      Rational distance = 0;
      for (double& x : place) {
        x = round_wall_position(1000 + size.get_d() * offset(random));
        distance += abs(Rational(rational_of(x) - far));
      }
      if (distance == size) continue;
      EXPECT_EQ(mesh.at(place), distance < size ? Membership::In : Membership::Out);
    }
  }
}

}  // namespace
}  // namespace exactcsg
