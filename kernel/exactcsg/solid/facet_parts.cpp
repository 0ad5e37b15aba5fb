// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/facet_parts.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "exactcsg/solid/cell_evaluation.hpp"
#include "exactcsg/solid/polygon.hpp"

namespace exactcsg {

namespace {

// What another facet has in common with this one, or one of its sides if both lie in one plane: on
// the line in which the plane given meets this facet's.
struct Segment {
  PlaneRef plane;
  Vertex from;
  Vertex to;
};

class FacetCutter {
 public:
  FacetCutter(const Scene& scene, FacetIndex facet, TierStatistics& statistics)
      : scene_(scene), facet_(scene.facets[facet]), statistics_(statistics) {}

  std::vector<FacetPart> cut(std::span<const FacetIndex> others) {
    std::vector<Segment> segments;
    for (const FacetIndex other : others) add_segments(scene_.facets[other], segments);
    FacetPart whole{{}, facet_share::whole};
    scene_.corners_of(facet_).append_to(whole.corners);
    pending_.push_back({std::move(whole), std::move(segments)});
    while (!pending_.empty()) {
      Region region = std::move(pending_.back());
      pending_.pop_back();
      divide(std::move(region));
    }
    return std::move(parts_);
  }

 private:
  struct Region {
    FacetPart part;
    std::vector<Segment> segments;  // each reaches the part along some length
  };

  PlaneRef own_plane() const { return facet_.plane.plane; }

  void add_segments(const SceneFacet& other, std::vector<Segment>& segments) {
    const CornerView corners = scene_.corners_of(other);
    if (other.plane.plane == own_plane()) {
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vertex next = corners.vertex(k + 1 == corners.size() ? 0 : k + 1);
        add_clipped({corners.side_plane(k), corners.vertex(k), next}, segments);
      }
      return;
    }
    if (std::optional<Segment> segment = crossing_of(other)) {
      add_clipped(*std::move(segment), segments);
    }
  }

  // nullopt: nothing, or a single point.
  std::optional<Segment> crossing_of(const SceneFacet& other) {
    const CornerView corners = scene_.corners_of(other);
    split_signs(scene_.geometry, corners, own_plane(), signs_, statistics_);
    std::vector<Vertex> points;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Sign here = signs_[k];
      const Sign there = signs_[k + 1 == corners.size() ? 0 : k + 1];
      if (here == Sign::Zero) points.push_back(corners.vertex(k));
      if (here != Sign::Zero && there == -here) {
        points.push_back(scene_.geometry.meet(other.plane.plane, corners.side_plane(k), own_plane(),
                                              corners.vertex(k),
                                              corners.vertex(k + 1 == corners.size() ? 0 : k + 1)));
      }
    }
    if (points.size() < 2) return std::nullopt;
    // More than two where a side has vertices in its middle.
    const auto [first, last] =
        std::minmax_element(points.begin(), points.end(), [&](const Vertex& a, const Vertex& b) {
          return points.size() > 2 && scene_.geometry.compare_position(a, b, statistics_) < 0;
        });
    if (points.size() == 2) return Segment{other.plane.plane, points[0], points[1]};
    return Segment{other.plane.plane, *first, *last};
  }

  // The parts of a segment on either side of a plane.
  struct Halves {
    std::optional<Segment> negative;
    std::optional<Segment> positive;
  };
  Halves halve(Segment segment, PlaneRef plane) {
    const Sign from = scene_.geometry.side(segment.from, plane, statistics_);
    const Sign to = scene_.geometry.side(segment.to, plane, statistics_);
    Halves halves;
    if (from == Sign::Zero && to == Sign::Zero) return halves;  // along the plane
    if (from != Sign::Positive && to != Sign::Positive) {
      halves.negative = std::move(segment);
    } else if (from != Sign::Negative && to != Sign::Negative) {
      halves.positive = std::move(segment);
    } else {
      const Vertex middle =
          scene_.geometry.meet(own_plane(), segment.plane, plane, segment.from, segment.to);
      Segment first{segment.plane, segment.from, middle};
      Segment second{segment.plane, middle, segment.to};
      if (from == Sign::Positive) std::swap(first, second);
      halves.negative = std::move(first);
      halves.positive = std::move(second);
    }
    return halves;
  }

  // What of the segment lies inside this facet.
  void add_clipped(Segment segment, std::vector<Segment>& segments) {
    const CornerView corners = scene_.corners_of(facet_);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      Halves halves = halve(std::move(segment), corners.side_plane(k));
      std::optional<Segment>& inner =
          inside_of(corners, k) == Sign::Positive ? halves.positive : halves.negative;
      if (!inner) return;
      segment = *std::move(inner);
    }
    segments.push_back(std::move(segment));
  }

  // The side of the k-th side's plane that the polygon is on.
  Sign inside_of(const CornerView& corners, std::size_t k) {
    for (std::size_t step = 2; step < corners.size(); ++step) {
      const Sign sign = scene_.geometry.side(corners.vertex((k + step) % corners.size()),
                                             corners.side_plane(k), statistics_);
      if (sign != Sign::Zero) return sign;
    }
    return Sign::Zero;
  }

  void divide(Region region) {
    while (!region.segments.empty()) {
      const PlaneRef plane = take_any(region.segments).plane;
      const std::vector<Corner>& corners = region.part.corners;
      if (split_signs(scene_.geometry, corners, plane, signs_, statistics_) != PlaneSplit::Both) {
        continue;  // along the rim
      }
      Region negative;
      Region positive;
      const std::uint64_t share = region.part.share / 2;
      negative.part.share = positive.part.share = share;
      const PolygonCut cut(scene_.geometry, corners, own_plane(), plane, signs_);
      cut.append_part(corners, signs_, Sign::Negative, negative.part.corners);
      cut.append_part(corners, signs_, Sign::Positive, positive.part.corners);
      for (Segment& segment : region.segments) {
        Halves halves = halve(std::move(segment), plane);
        if (halves.negative) negative.segments.push_back(*std::move(halves.negative));
        if (halves.positive) positive.segments.push_back(*std::move(halves.positive));
      }
      pending_.push_back(std::move(negative));
      pending_.push_back(std::move(positive));
      return;
    }
    parts_.push_back(std::move(region.part));
  }

  // The multiples of a large odd number jump about.
  static Segment take_any(std::vector<Segment>& segments) {
    constexpr std::uint64_t multiplier = 2654435761U;
    const std::size_t chosen = ((segments.size() * multiplier) >> 8U) % segments.size();
    std::swap(segments[chosen], segments.back());
    Segment segment = std::move(segments.back());
    segments.pop_back();
    return segment;
  }

  const Scene& scene_;
  const SceneFacet& facet_;
  TierStatistics& statistics_;
  std::vector<Sign> signs_;
  std::vector<Region> pending_;
  std::vector<FacetPart> parts_;
};

}  // namespace

std::vector<FacetPart> parts_of_facet(const Scene& scene, FacetIndex facet,
                                      std::span<const FacetIndex> others,
                                      TierStatistics& statistics) {
  return FacetCutter(scene, facet, statistics).cut(others);
}

}  // namespace exactcsg
