// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mesh/written_surface.hpp"

#include <algorithm>
#include <array>
#include <boost/pending/disjoint_sets.hpp>
#include <map>
#include <utility>
#include <vector>

#include "exactcsg/solid/fill_rule.hpp"

namespace exactcsg::io {

namespace {

// Unites what has a number in common.
class Pieces {
 public:
  explicit Pieces(std::size_t count) : ranks_(count), parents_(count), used_(count) {
    for (std::size_t i = 0; i < count; ++i) sets_.make_set(i);
  }
  void add(std::span<const std::uint32_t> corners) {
    for (const std::uint32_t v : corners) {
      used_[v] = true;
      sets_.union_set(corners.front(), v);
    }
  }
  std::size_t count() {
    std::size_t result = 0;
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (used_[i] && sets_.find_set(i) == i) ++result;
    }
    return result;
  }

 private:
  std::vector<std::size_t> ranks_;
  std::vector<std::size_t> parents_;
  std::vector<bool> used_;
  boost::disjoint_sets<std::size_t*, std::size_t*> sets_{ranks_.data(), parents_.data()};
};

// Of each vertex, the number of the first that is the same point.
std::vector<std::uint32_t> first_equals(const std::vector<Point3>& vertices) {
  std::map<Point3, std::uint32_t> known;
  std::vector<std::uint32_t> result;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    result.push_back(known.emplace(vertices[v], v).first->second);
  }
  return result;
}

std::vector<Facet> facets_with_distinct_corners(const PolygonSoup& soup) {
  const std::vector<std::uint32_t> first = first_equals(soup.vertices);
  std::vector<Facet> result;
  for (const auto& corners : soup.facets) {
    Facet facet;
    for (const std::uint32_t v : corners) facet.push_back(first[v]);
    Facet sorted = facet;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) {
      result.push_back(std::move(facet));
    }
  }
  return result;
}

}  // namespace

SurfaceFinding examine(const PolygonSoup& soup) {
  return examine(Polyhedron{soup.vertices, facets_with_distinct_corners(soup)});
}

SurfaceFinding examine(const Polyhedron& polyhedron) {
  try {
    (void)make_mesh(polyhedron);
    return {};
  } catch (const Error& error) {
    switch (error.id()) {
      case ErrorId::SelfIntersectingMesh:
        if (is_boundary_of_solid(polyhedron)) return {std::nullopt, true};
        return {error, false};
      case ErrorId::DegenerateFacet:
      case ErrorId::OpenMesh:
      case ErrorId::InvertedMesh:
        return {error, false};
      default:
        throw;
    }
  }
}

std::size_t count_pieces(const PolygonSoup& soup) {
  Pieces pieces(soup.vertices.size());
  for (const Facet& facet : facets_with_distinct_corners(soup)) pieces.add(facet);
  return pieces.count();
}

std::size_t count_pieces(const Boundary& boundary) {
  Pieces pieces(boundary.vertices.size());
  for (const BoundaryFace& face : boundary.faces) {
    for (const auto& loop : face.loops) {
      pieces.add(loop);
      pieces.add(std::array{face.loops.front().front(), loop.front()});
    }
  }
  return pieces.count();
}

}  // namespace exactcsg::io
