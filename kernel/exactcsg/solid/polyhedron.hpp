// SPDX-License-Identifier: Apache-2.0
#pragma once

// Polyhedra as they are given, and as primitives keep them: exact points and flat facets, and
// beside them what every evaluation asks of them. [Exact]

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <vector>

#include "exactcsg/number/exact_points.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg {

// The vertices of a convex planar polygon, counter-clockwise seen from outside the solid.
using Facet = std::vector<std::uint32_t>;

// Vertices and facets of a bounded polyhedron. Facets are strictly planar convex polygons of
// non-zero area (a vertex in the middle of a straight side is allowed in a mesh).
struct Polyhedron {
  std::vector<Point3> vertices;
  std::vector<Facet> facets;
};

// Facets, immutable, one after the other in one block that copies share. A side of a facet has the
// number of the corner where it begins.
class FlatFacets {
 public:
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = std::span<const std::uint32_t>;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = value_type;

    Iterator() = default;
    Iterator(const FlatFacets& facets, std::size_t f) : facets_(&facets), f_(f) {}
    value_type operator*() const { return (*facets_)[f_]; }
    Iterator& operator++() {
      ++f_;
      return *this;
    }
    Iterator operator++(int) { return {*facets_, f_++}; }
    friend bool operator==(const Iterator&, const Iterator&) = default;

   private:
    const FlatFacets* facets_ = nullptr;
    std::size_t f_ = 0;
  };

  FlatFacets() = default;
  explicit FlatFacets(std::span<const Facet> facets);

  std::size_t size() const { return begins().empty() ? 0 : begins().size() - 1; }
  std::span<const std::uint32_t> operator[](std::size_t f) const {
    const std::vector<std::uint32_t>& begin = rows_->begins;
    return std::span(rows_->corners).subspan(begin[f], begin[f + 1] - begin[f]);
  }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }
  // Facet f has the corners begins()[f] ... begins()[f + 1], of vertices corners()[...].
  std::span<const std::uint32_t> begins() const {
    return rows_ ? std::span<const std::uint32_t>(rows_->begins) : std::span<const std::uint32_t>();
  }
  std::span<const std::uint32_t> corners() const {
    return rows_ ? std::span<const std::uint32_t>(rows_->corners)
                 : std::span<const std::uint32_t>();
  }

 private:
  struct Rows {
    std::vector<std::uint32_t> begins;
    std::vector<std::uint32_t> corners;
  };
  std::shared_ptr<const Rows> rows_;
};

bool operator==(const FlatFacets& a, const FlatFacets& b);

// Which planes facets and sides have (prepared_polyhedron.hpp): images of a polyhedron share it.
struct FacetPlanes;
// Rounded points and planes (prepared_polyhedron.hpp).
struct PreparedPolyhedron;

// A polyhedron that is made once and evaluated often.
struct StoredPolyhedron {
  ExactPoints vertices;
  FlatFacets facets;
  // Null if a coordinate exceeds 1e290 in magnitude: such a polyhedron can be mapped, written and
  // asked about points, but not evaluated.
  std::shared_ptr<const PreparedPolyhedron> prepared;
};

// A copy that can be changed.
Polyhedron to_polyhedron(const StoredPolyhedron& polyhedron);

// The facets of a convex polytope, which are those of its images under maps that do not mirror,
// too. Copies share them.
class ConvexFacets {
 public:
  // THROWS Error(InternalError) if the facets do not close up
  explicit ConvexFacets(const Polyhedron& polyhedron);

  const FlatFacets& facets() const;
  const std::shared_ptr<const FacetPlanes>& planes() const { return planes_; }

 private:
  std::shared_ptr<const FacetPlanes> planes_;
};

}  // namespace exactcsg
