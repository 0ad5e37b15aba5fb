// SPDX-License-Identifier: Apache-2.0
#pragma once

// A solid made ready for decomposition: its primitives as numbers, their facets as convex polygons
// over one Geometry, and its tree over those numbers. Internal to the evaluator and the classifier.
//
// LAW scene.1  facets of one convex primitive lie in pairwise different planes.
// LAW scene.2  every facet's interior meets the open root cell, and no facet lies in its walls.

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/solid.hpp"

namespace exactcsg {

using PrimitiveIndex = std::uint32_t;
using FacetIndex = std::uint32_t;
using PrunedTree = csg::FlatTree<PrimitiveIndex, csg::BooleanOperator>;

// A corner of a convex polygon, and the plane that meets the polygon's plane in the side from this
// corner to the next.
struct Corner {
  Vertex vertex;
  PlaneRef side_plane;
};

// A corner that is an input point, as scenes have nearly all of theirs; its side plane is one of
// the table.
struct PointCorner {
  PointId point{};
  std::uint32_t side_plane = 0;  // the table index

  friend bool operator==(const PointCorner&, const PointCorner&) = default;
};

// The corners of a convex polygon in order, whichever way they are stored.
class CornerView {
 public:
  CornerView() = default;
  CornerView(std::span<const Corner> corners) : corners_(corners.data()), size_(corners.size()) {}
  CornerView(std::span<Corner> corners) : CornerView(std::span<const Corner>(corners)) {}
  CornerView(const std::vector<Corner>& corners) : CornerView(std::span(corners)) {}
  CornerView(const Geometry& geometry, std::span<const PointCorner> corners)
      : geometry_(&geometry), points_(corners.data()), size_(corners.size()) {}

  std::size_t size() const { return size_; }
  Vertex vertex(std::size_t i) const {
    return geometry_ == nullptr ? corners_[i].vertex : geometry_->vertex(points_[i].point);
  }
  // visit(i, vertex) in order; what is stored as vertices is not copied.
  template <class Visit>
  void for_each_vertex(Visit visit) const {
    if (geometry_ == nullptr) {
      for (std::size_t i = 0; i < size_; ++i) visit(i, corners_[i].vertex);
    } else {
      for (std::size_t i = 0; i < size_; ++i) visit(i, geometry_->vertex(points_[i].point));
    }
  }
  PlaneRef side_plane(std::size_t i) const {
    return geometry_ == nullptr ? corners_[i].side_plane
                                : PlaneRef::of_table(points_[i].side_plane);
  }
  Corner operator[](std::size_t i) const { return {vertex(i), side_plane(i)}; }
  // A certified double coordinate, and how far off it may be.
  struct NearCoordinate {
    double value;
    double error;
  };
  NearCoordinate coordinate(std::size_t i, Axis axis) const {
    if (geometry_ == nullptr)
      return {corners_[i].vertex.coordinate(axis), corners_[i].vertex.error};
    const ApproximatePoint& near = geometry_->approximate(points_[i].point);
    return {axis == Axis::X ? near.x : axis == Axis::Y ? near.y : near.z, near.error};
  }

  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = Corner;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = Corner;

    Iterator(const CornerView& view, std::size_t i) : view_(&view), i_(i) {}
    Corner operator*() const { return (*view_)[i_]; }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    Iterator operator++(int) {
      const Iterator before = *this;
      ++i_;
      return before;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.i_ == b.i_; }

   private:
    const CornerView* view_;
    std::size_t i_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size_}; }

  void append_to(std::vector<Corner>& result) const {
    if (geometry_ == nullptr) {
      result.insert(result.end(), corners_, corners_ + size_);
    } else {
      for (std::size_t i = 0; i < size_; ++i) result.push_back((*this)[i]);
    }
  }

 private:
  const Geometry* geometry_ = nullptr;  // null: corners_ count, otherwise points_
  union {
    const Corner* corners_ = nullptr;
    const PointCorner* points_;
  };
  std::size_t size_ = 0;
};

// An open axis-parallel box.
struct Cell {
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
};

struct SceneFacet {
  PrimitiveIndex primitive = 0;
  bool is_half_space = false;  // cut off at the root cell's walls
  OrientedPlaneRef plane;      // outward
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
};

struct ScenePrimitive {
  bool convex = true;  // half-spaces and convex polytopes; otherwise a closed mesh
  FacetIndex first_facet = 0;
  std::uint32_t facet_count = 0;
  // Facets that meet do so in common vertices and common edges, unless it is said that they do not.
  bool meets_itself = false;
};

struct Range {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();
};

// Along each axis, bounds that the true corners do not exceed.
struct SceneBounds {
  std::array<std::vector<Range>, 3> facets;
  std::array<std::vector<Range>, 3> primitives;
};

// Widens `bounds` so that the true corners do not exceed them.
void widen(std::array<Range, 3>& bounds, const CornerView& corners);

struct Scene {
  Geometry geometry;
  std::vector<ScenePrimitive> primitives;
  std::vector<SceneFacet> facets;
  std::vector<PointCorner> corners;        // of all facets but those of half-spaces
  std::vector<Corner> half_space_corners;  // of those
  SceneBounds bounds;
  PrunedTree tree;
  Cell root;

  CornerView corners_of(const SceneFacet& facet) const {
    if (facet.is_half_space) {
      return std::span(half_space_corners).subspan(facet.first_corner, facet.corner_count);
    }
    return {geometry, std::span(corners).subspan(facet.first_corner, facet.corner_count)};
  }
  CornerView corners_of(FacetIndex facet) const { return corners_of(facets[facet]); }
};

// The meeting point of three walls, as near to the place as walls can be.
Vertex between_walls(const Geometry& geometry, const std::array<double, 3>& place);

// Occurrences of one handle in the tree become one primitive.
// threads: as in EvaluateOptions; the scene does not depend on it.
// THROWS Error(NumberOutOfRange) if a coordinate exceeds 1e290 in magnitude.
// COST: O(facets log facets).
Scene make_scene(const Solid& solid, unsigned threads = 1);

}  // namespace exactcsg
