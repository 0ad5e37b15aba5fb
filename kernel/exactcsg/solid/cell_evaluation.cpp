// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/cell_evaluation.hpp"

#include <algorithm>

#include "exactcsg/solid/polygon.hpp"

namespace exactcsg {

using csg::Membership;

CellEvaluator::CellEvaluator(const Scene& scene, Progress* progress)
    : scene_(scene),
      progress_(progress),
      truth_(scene.primitives.size(), CombineSides(), AbsorbsSides(),
             {BothSides{Membership::In, Membership::In},
              BothSides{Membership::Out, Membership::Out}}) {}

void CellEvaluator::build_local_forms(std::span<const CellFacet> facets) {
  nodes_.clear();
  locals_.clear();
  std::vector<FacetPolygon> polygons;
  for (std::size_t begin = 0; begin < facets.size();) {
    std::size_t end = begin;
    polygons.clear();
    while (end < facets.size() && facets[end].primitive == facets[begin].primitive) {
      polygons.push_back(facets[end].polygon);
      ++end;
    }
    const PrimitiveIndex primitive = facets[begin].primitive;
    const LocalPlace root = scene_.primitives[primitive].convex
                                ? append_convex_form(polygons, nodes_)
                                : append_mesh_form(scene_.geometry, polygons, nodes_, *statistics_);
    locals_.push_back({primitive, root, begin, end - begin});
    begin = end;
  }
}

void CellEvaluator::order_primitives_for(const CellFacet& facet,
                                         std::span<const CellFacet> facets) {
  order_.clear();
  const auto has_coplanar_facet = [&](const LocalPrimitive& local) {
    return std::any_of(
        facets.begin() + static_cast<std::ptrdiff_t>(local.first_facet),
        facets.begin() + static_cast<std::ptrdiff_t>(local.first_facet + local.facet_count),
        [&](const CellFacet& other) {
          return other.polygon.plane.plane == facet.polygon.plane.plane;
        });
  };
  for (std::uint32_t i = 0; i < locals_.size(); ++i) {
    if (locals_[i].primitive != facet.primitive) order_.push_back(i);
  }
  const auto rest = std::stable_partition(order_.begin(), order_.end(), [&](std::uint32_t i) {
    return has_coplanar_facet(locals_[i]);
  });
  coplanar_count_ = static_cast<std::size_t>(rest - order_.begin());
}

void CellEvaluator::evaluate(std::span<const CellFacet> facets, const PrunedTree& tree,
                             PieceCollector& result, TierStatistics& statistics) {
  result_ = &result;
  statistics_ = &statistics;
  build_local_forms(facets);
  truth_.assign(tree, {});
  for (const CellFacet& facet : facets) {
    if (progress_ != nullptr) progress_->check();
    facet_ = &facet;
    order_primitives_for(facet, facets);
    const bool outward_front = facet.polygon.plane.sense > 0;
    truth_.change(facet.primitive, outward_front ? BothSides{Membership::Out, Membership::In}
                                                 : BothSides{Membership::In, Membership::Out});
    pool_.clear();
    facet.polygon.corners.append_to(pool_);
    const PieceCollector::Mark before = result.mark();
    classify({0, pool_.size(), facet.share}, 0);
    join_pieces(facet, before);
    truth_.change(facet.primitive, {});
  }
}

// Other primitives' planes may cut a facet that all of them leave alone in the end.
void CellEvaluator::join_pieces(const CellFacet& facet, const PieceCollector::Mark& before) {
  const std::span<const BoundaryPiece> pieces = result_->pieces_since(before);
  if (pieces.size() < 2 || facet.share == 0) return;
  std::uint64_t sum = 0;
  for (const BoundaryPiece& piece : pieces) {
    if (piece.plane != pieces.front().plane) return;
    sum += piece.share;
  }
  if (sum != facet.share) return;
  const BoundaryPiece joined = pieces.front();
  result_->take_back_to(before);
  result_->add(joined.plane, joined.corner_sense, facet.facet, facet.share, facet.polygon.corners);
}

void CellEvaluator::classify(Range piece, std::size_t next) {
  const auto [front, behind] = truth_.value();
  if (front != Membership::Unknown && behind != Membership::Unknown) {
    if (front == behind) return;
    // A lower primitive that covers the piece in the same plane would emit it too.
    if (next >= coplanar_count_) {
      const signed char outward = behind == Membership::In ? 1 : -1;
      result_->add({facet_->polygon.plane.plane, outward}, facet_->polygon.plane.sense,
                   facet_->facet, piece.share,
                   std::span(pool_).subspan(piece.begin, piece.end - piece.begin));
      return;
    }
  }
  if (next == order_.size()) {
    throw Error(ErrorId::InternalError, {"a facet that is still undecided", "a decided one"});
  }
  const LocalPlace root = locals_[order_[next]].root;
  descend(piece, root, root, next);
}

void CellEvaluator::descend(Range piece, LocalPlace front, LocalPlace behind, std::size_t next) {
  const PlaneRef own = facet_->polygon.plane.plane;
  while (!front.is_decided() || !behind.is_decided()) {
    // A node in the facet's own plane divides front from behind, not the piece.
    if (!front.is_decided() && nodes_[front.node()].plane == own) {
      front = nodes_[front.node()].positive;
      continue;
    }
    if (!behind.is_decided() && nodes_[behind.node()].plane == own) {
      behind = nodes_[behind.node()].negative;
      continue;
    }
    const LocalPlace place = front.is_decided() ? behind : front;
    const LocalNode& node = nodes_[place.node()];
    const auto follow = [&](LocalPlace at, bool positive) {
      if (!(at == place)) return at;
      return positive ? node.positive : node.negative;
    };
    const std::size_t count = piece.end - piece.begin;
    pool_.reserve(pool_.size() + 2 * (count + 2));
    const auto polygon = std::span<const Corner>(pool_).subspan(piece.begin, count);
    const PlaneSplit split =
        split_signs(scene_.geometry, polygon, node.plane, signs_, *statistics_);
    if (split == PlaneSplit::Both) {
      const std::size_t positive_begin = pool_.size();
      const PolygonCut cut(scene_.geometry, polygon, own, node.plane, signs_);
      cut.append_part(polygon, signs_, Sign::Positive, pool_);
      const std::size_t negative_begin = pool_.size();
      cut.append_part(polygon, signs_, Sign::Negative, pool_);
      const std::size_t end = pool_.size();
      const std::uint64_t half = piece.share / 2;
      descend({positive_begin, negative_begin, half}, follow(front, true), follow(behind, true),
              next);
      descend({negative_begin, end, half}, follow(front, false), follow(behind, false), next);
      pool_.resize(positive_begin);
      return;
    }
    if (split == PlaneSplit::InPlane) {
      throw Error(ErrorId::InternalError, {"a facet in a plane that is not its own", ""});
    }
    const bool positive = split == PlaneSplit::AllPositive;
    const LocalPlace next_front = follow(front, positive);
    behind = follow(behind, positive);
    front = next_front;
  }
  const PrimitiveIndex primitive = locals_[order_[next]].primitive;
  const bool covered = front.membership() != behind.membership();
  if (covered && primitive < facet_->primitive) return;
  truth_.change(primitive, {front.membership(), behind.membership()});
  classify(piece, next + 1);
  truth_.change(primitive, {});
}

}  // namespace exactcsg
