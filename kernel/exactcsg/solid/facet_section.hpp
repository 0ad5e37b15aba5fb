// SPDX-License-Identifier: Apache-2.0
#pragma once

// The section of a convex polygon with a convex set, and what is left of the polygon beside it.
// Internal to the evaluator. [Exact]
//
// A polygon that a convex set cuts along k planes falls into k convex parts and the section if it
// is cut by one plane after the other. What is left of it is one region for every stretch of the
// section's rim that lies inside the polygon, and that is how it is handed on: a loop that need not
// be convex, or the polygon and a hole in it.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

// Corners in a store.
struct CornerRun {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t size() const { return end - begin; }
};

// Of a polygon, or of a section of it.
struct SectionCorner {
  static constexpr std::int32_t none = -1;
  std::uint32_t vertex = 0;  // in a store
  // The side of the polygon that the side from here to the next corner is a part of; none: it is
  // inside the polygon, in a plane that cut it.
  std::int32_t side = none;
  // Where on the rim of the polygon it is: 2 i at its corner i, 2 i + 1 between that and the next
  // one; none: inside.
  std::int32_t place = none;
  PlaneRef side_plane;
};

// Vertices and corners that polygons are made of. Runs of corners stay where they are.
// LAW section.2  a meeting point of three planes that cuts found is stored once between two calls
// of clear: facets that meet in it need not find it again.
class SectionStore {
 public:
  std::vector<SectionCorner> corners;

  std::span<const SectionCorner> of(const CornerRun& run) const {
    return std::span(corners).subspan(run.begin, run.size());
  }
  const Vertex& vertex(const SectionCorner& corner) const { return vertices_[corner.vertex]; }
  const Vertex& vertex(std::uint32_t number) const { return vertices_[number]; }
  std::size_t vertex_count() const { return vertices_.size(); }
  std::uint32_t append(const Vertex& vertex);
  // Geometry::meet, of vertices in the store.
  std::uint32_t meet(const Geometry& geometry, PlaneRef p, PlaneRef q, PlaneRef r,
                     std::uint32_t from, std::uint32_t to);
  void clear();

 private:
  struct Slot {
    std::uint32_t vertex = 0;
    std::uint32_t round = 0;  // in use if it is the present one
  };

  Slot& slot_of(const std::array<PlaneRef, 3>& planes);
  void enlarge_slots();

  std::vector<Vertex> vertices_;
  std::vector<Slot> slots_;  // open addressing
  std::size_t met_ = 0;      // slots in use
  std::uint32_t round_ = 1;
};

CornerRun append_polygon(const CornerView& polygon, SectionStore& store);

// A plane and, of a polygon's corners, the sides of it on which they are.
struct CuttingPlane {
  PlaneRef plane;
  std::span<const Sign> signs;
};

// The vertices in which the plane crosses the polygon's sides, in the order of the sides.
// REQUIRES both signs occur
std::array<std::uint32_t, 2> append_crossings(const Geometry& geometry, PlaneRef supporting,
                                              const CornerRun& polygon, const CuttingPlane& cut,
                                              SectionStore& store);

// The part on the side `kept`: a section of whatever the run is a section of.
CornerRun append_part(const CornerRun& polygon, const CuttingPlane& cut, Sign kept,
                      const std::array<std::uint32_t, 2>& crossings, SectionStore& store);

// The same of a section of the polygon that `half` is the same plane's part of, on the same side: a
// section of the half. REQUIRES the half is as append_part left it. A section that lies on the kept
// side as a whole has no crossings.
CornerRun append_part_of_half(const CornerRun& section, const CuttingPlane& cut, Sign kept,
                              const std::array<std::uint32_t, 2>& crossings, const CornerRun& half,
                              SectionStore& store);

// Makes a section a polygon of its own.
void forget_whole(const CornerRun& section, SectionStore& store);

// A corner of a loop, and the plane that meets the polygon's in the side from there to the next.
struct LoopCorner {
  std::uint32_t vertex;
  PlaneRef side_plane;
};

// What is left of a polygon beside a section of it that has a side inside: loops with the region on
// their left. LAW section.1  the regions are connected, disjoint, and cover with the section the
// polygon. Each has one loop; or there is one region, with the polygon's loop and that of a hole.
class Remainder {
 public:
  // The store must not change meanwhile.
  Remainder(const CornerRun& polygon, const CornerRun& section, const SectionStore& store);

  std::size_t loop_count() const { return is_ring() ? 2 : starts_.size(); }
  bool is_ring() const { return starts_.empty(); }
  // The second loop of a ring is that of the hole.
  void append_loop(std::size_t i, std::vector<LoopCorner>& result) const;

 private:
  void append_reversed(std::size_t from, std::size_t count, std::vector<LoopCorner>& result) const;

  std::span<const SectionCorner> polygon_;
  std::span<const SectionCorner> section_;
  std::vector<std::uint32_t>
      starts_;  // the section's corners on the rim from which a side leads in
};

}  // namespace exactcsg
