// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/local_form.hpp"

#include <algorithm>
#include <limits>

#include "exactcsg/solid/polygon.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

LocalNode node_of(OrientedPlaneRef plane, LocalPlace outside, LocalPlace inside) {
  return plane.sense > 0 ? LocalNode{plane.plane, outside, inside}
                         : LocalNode{plane.plane, inside, outside};
}

// One region of the autopartition still to be divided.
struct OwnedPolygon {
  OrientedPlaneRef plane;
  std::vector<Corner> corners;
};

class Autopartition {
 public:
  Autopartition(const Geometry& geometry, std::vector<LocalNode>& nodes, TierStatistics& statistics)
      : geometry_(geometry), nodes_(nodes), statistics_(statistics) {}

  LocalPlace partition(std::vector<OwnedPolygon> polygons) {
    // Depth first with an explicit stack: a star-shaped fan makes a chain as long as its facets.
    struct Pending {
      std::vector<OwnedPolygon> polygons;
      std::uint32_t parent;
      bool positive;
    };
    constexpr std::uint32_t no_parent = std::numeric_limits<std::uint32_t>::max();
    std::vector<Pending> pending;
    pending.push_back({std::move(polygons), no_parent, false});
    LocalPlace root = LocalPlace::decided(Membership::Out);
    while (!pending.empty()) {
      Pending region = std::move(pending.back());
      pending.pop_back();
      const auto index = static_cast<std::uint32_t>(nodes_.size());
      if (region.parent == no_parent) {
        root = LocalPlace::at_node(index);
      } else {
        (region.positive ? nodes_[region.parent].positive : nodes_[region.parent].negative) =
            LocalPlace::at_node(index);
      }
      const OrientedPlaneRef divider = region.polygons[choose_divider(region.polygons)].plane;
      nodes_.push_back(node_of(divider, LocalPlace::decided(Membership::Out),
                               LocalPlace::decided(Membership::In)));
      std::vector<OwnedPolygon> positive;
      std::vector<OwnedPolygon> negative;
      for (std::size_t i = 0; i < region.polygons.size(); ++i) {
        distribute(std::move(region.polygons[i]), divider.plane, splits_of_divider_[i], positive,
                   negative);
      }
      if (!positive.empty()) pending.push_back({std::move(positive), index, true});
      if (!negative.empty()) pending.push_back({std::move(negative), index, false});
    }
    return root;
  }

 private:
  // The plane that cuts fewest of the others, among a few. What it does to those is kept.
  std::size_t choose_divider(const std::vector<OwnedPolygon>& polygons) {
    std::size_t best = 0;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    const std::size_t step = std::max<std::size_t>(1, polygons.size() / 6);
    for (std::size_t i = 0; i < polygons.size() && fewest > 0; i += step) {
      const std::size_t cuts = split_all(polygons, polygons[i].plane.plane, fewest);
      if (cuts >= fewest) continue;
      fewest = cuts;
      best = i;
      splits_of_divider_.swap(splits_);
    }
    return best;
  }

  // What the divider does to the polygons, into splits_. Returns how many it cuts, or `enough` if
  // it cuts as many; then the rest is not asked for.
  std::size_t split_all(const std::vector<OwnedPolygon>& polygons, PlaneRef divider,
                        std::size_t enough) {
    splits_.clear();
    std::size_t cuts = 0;
    for (const OwnedPolygon& polygon : polygons) {
      const bool lies_in_it = polygon.plane.plane == divider;
      splits_.push_back(
          lies_in_it ? PlaneSplit::InPlane
                     : split_signs(geometry_, polygon.corners, divider, signs_, statistics_));
      if (!lies_in_it && splits_.back() == PlaneSplit::InPlane) {
        throw Error(ErrorId::InternalError, {"a facet in a plane that is not its own", ""});
      }
      if (splits_.back() == PlaneSplit::Both && ++cuts == enough) break;
    }
    return cuts;
  }

  void distribute(OwnedPolygon polygon, PlaneRef divider, PlaneSplit split,
                  std::vector<OwnedPolygon>& positive, std::vector<OwnedPolygon>& negative) {
    switch (split) {
      case PlaneSplit::InPlane:
        return;
      case PlaneSplit::AllPositive:
        positive.push_back(std::move(polygon));
        return;
      case PlaneSplit::AllNegative:
        negative.push_back(std::move(polygon));
        return;
      case PlaneSplit::Both:
        break;
    }
    split_signs(geometry_, polygon.corners, divider, signs_, statistics_);
    const PolygonCut cut(geometry_, polygon.corners, polygon.plane.plane, divider, signs_);
    positive.push_back({polygon.plane, {}});
    cut.append_part(polygon.corners, signs_, Sign::Positive, positive.back().corners);
    negative.push_back({polygon.plane, {}});
    cut.append_part(polygon.corners, signs_, Sign::Negative, negative.back().corners);
  }

  const Geometry& geometry_;
  std::vector<LocalNode>& nodes_;
  TierStatistics& statistics_;
  std::vector<Sign> signs_;
  std::vector<PlaneSplit> splits_;
  std::vector<PlaneSplit> splits_of_divider_;
};

}  // namespace

LocalPlace append_convex_form(std::span<const FacetPolygon> facets, std::vector<LocalNode>& nodes) {
  const auto first = static_cast<std::uint32_t>(nodes.size());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const LocalPlace inside = i + 1 == facets.size()
                                  ? LocalPlace::decided(Membership::In)
                                  : LocalPlace::at_node(static_cast<std::uint32_t>(first + i + 1));
    nodes.push_back(node_of(facets[i].plane, LocalPlace::decided(Membership::Out), inside));
  }
  return LocalPlace::at_node(first);
}

LocalPlace append_mesh_form(const Geometry& geometry, std::span<const FacetPolygon> facets,
                            std::vector<LocalNode>& nodes, TierStatistics& statistics) {
  std::vector<OwnedPolygon> polygons;
  polygons.reserve(facets.size());
  for (const FacetPolygon& facet : facets) {
    polygons.push_back({facet.plane, {}});
    facet.corners.append_to(polygons.back().corners);
  }
  return Autopartition(geometry, nodes, statistics).partition(std::move(polygons));
}

}  // namespace exactcsg
