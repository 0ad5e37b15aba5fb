// SPDX-License-Identifier: Apache-2.0
// 1. Facets that meet all others in common vertices and edges only have one winding number all over
//    their front, and the same as their neighbours across edges of two such facets: one ray decides
//    for each part of the surface that is connected so.
// 2. Each of the others is cut along what it has in common with those that it meets otherwise, and
// a
//    ray decides for each part.
// 3. A part is boundary where the rule differs between its sides; the facet of the lowest number
//    stands for all that cover it. Parts are merged as those of any evaluation.

#include "exactcsg/solid/fill_rule.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "exactcsg/solid/canonical_boundary.hpp"
#include "exactcsg/solid/facet_parts.hpp"
#include "exactcsg/solid/facet_stabbing.hpp"
#include "exactcsg/solid/in_parallel_counting.hpp"
#include "exactcsg/solid/polyhedron_check.hpp"
#include "exactcsg/solid/prepared_polyhedron.hpp"
#include "exactcsg/solid/whole_facets.hpp"

namespace exactcsg {

namespace {

// A surface that was checked, and which facets meet others in more than common vertices and edges.
struct Surface {
  PolyhedralMesh mesh;
  // By facet: the others that it meets so are partners[begins[f]] ... partners[begins[f + 1]].
  std::vector<std::uint32_t> begins;
  std::vector<FacetIndex> partners;
  std::vector<FacetIndex> part;  // of manifold_parts, among facets without partners

  std::span<const FacetIndex> partners_of(FacetIndex f) const {
    return std::span(partners).subspan(begins[f], begins[f + 1] - begins[f]);
  }
};

void add_partners(Surface& surface, const std::vector<std::array<FacetIndex, 2>>& pairs) {
  surface.begins.assign(surface.mesh.polyhedron->facets.size() + 1, 0);
  for (const auto& [f, g] : pairs) {
    ++surface.begins[f + 1];
    ++surface.begins[g + 1];
  }
  for (std::size_t f = 1; f < surface.begins.size(); ++f) {
    surface.begins[f] += surface.begins[f - 1];
  }
  std::vector<std::uint32_t> next(surface.begins.begin(), surface.begins.end() - 1);
  surface.partners.resize(2 * pairs.size());
  for (const auto& [f, g] : pairs) {
    surface.partners[next[f]++] = g;
    surface.partners[next[g]++] = f;
  }
}

Surface checked(Polyhedron given, unsigned threads) {
  const Polyhedron polyhedron = with_distinct_vertices(std::move(given), threads);
  const PolyhedronSigns signs(polyhedron.vertices);
  const std::vector<FacetFrame> frames = check_facets(polyhedron, signs, threads);
  const std::vector<HalfEdge> edges = half_edges(polyhedron, threads);
  check_closed(polyhedron, edges);
  Surface surface;
  surface.mesh = {store_mesh(polyhedron, threads)};
  add_partners(surface, improper_pairs(polyhedron, signs, frames, threads));
  surface.part = manifold_parts(polyhedron, edges,
                                [&](FacetIndex f) { return surface.partners_of(f).empty(); });
  return surface;
}

Scene scene_of(const Surface& surface) {
  Scene scene = make_scene(Solid::primitive(Primitive{surface.mesh}));
  scene.primitives.front().meets_itself = true;
  return scene;
}

class Filling {
 public:
  Filling(const Surface& surface, const Scene& scene, FillRule rule, const EvaluateOptions& options)
      : surface_(surface), scene_(scene), stabbing_(scene), rule_(rule), options_(options) {}

  // Every part of a facet is covered by that facet alone, between the numbers 0 and 1.
  bool is_simple() const {
    const auto as_outside = [&](FacetIndex f, const WindingSides& sides) {
      const bool along = scene_.facets[f].plane.sense > 0;
      return sides.lowest == f && (along ? sides.front : sides.behind) == 0 &&
             (along ? sides.behind : sides.front) == 1;
    };
    TierStatistics unused;
    std::vector<bool> known(scene_.facets.size(), false);
    for (FacetIndex f = 0; f < scene_.facets.size(); ++f) {
      if (options_.progress != nullptr) options_.progress->check();
      const std::span<const FacetIndex> partners = surface_.partners_of(f);
      if (!partners.empty()) {
        for (const FacetPart& part : parts_of_facet(scene_, f, partners, unused)) {
          if (!as_outside(f, stabbing_.winding_sides(f, part.corners, unused))) return false;
        }
      } else if (!known[surface_.part[f]]) {
        known[surface_.part[f]] = true;
        if (!as_outside(f, stabbing_.winding_sides(f, scene_.corners_of(f), unused))) return false;
      }
    }
    return true;
  }

  std::vector<PieceBuffer> pieces(TierStatistics& statistics) const {
    constexpr std::size_t facets_per_round = 64;
    const std::size_t rounds = scene_.facets.size() / facets_per_round + 1;
    std::vector<PieceBuffer> buffers(rounds + 1);
    PieceCollector untouched;
    add_untouched(untouched, statistics);
    buffers[rounds] = untouched.take();
    in_parallel_counting(
        options_.threads, rounds, statistics, [&](std::size_t round, TierStatistics& tiers) {
          PieceCollector touched;
          const std::size_t end = std::min(scene_.facets.size(), (round + 1) * facets_per_round);
          for (std::size_t f = round * facets_per_round; f < end; ++f) {
            if (options_.progress != nullptr) options_.progress->check();
            add_touched(static_cast<FacetIndex>(f), touched, tiers);
          }
          buffers[round] = touched.take();
          if (options_.progress != nullptr) options_.progress->advance(facets_per_round);
        });
    return buffers;
  }

 private:
  void add_untouched(PieceCollector& result, TierStatistics& statistics) const {
    // Of each part's first facet, along its outward normal.
    std::vector<std::optional<WindingSides>> sides(scene_.facets.size());
    for (FacetIndex f = 0; f < scene_.facets.size(); ++f) {
      if (!surface_.partners_of(f).empty()) continue;
      const signed char sense = scene_.facets[f].plane.sense;
      std::optional<WindingSides>& known = sides[surface_.part[f]];
      if (!known) {
        known = stabbing_.winding_sides(f, scene_.corners_of(f), statistics);
        if (sense < 0) std::swap(known->front, known->behind);
      }
      WindingSides here = *known;
      if (sense < 0) std::swap(here.front, here.behind);
      add_piece(f, here, facet_share::whole, scene_.corners_of(f), result);
    }
  }

  void add_touched(FacetIndex f, PieceCollector& result, TierStatistics& statistics) const {
    const std::span<const FacetIndex> partners = surface_.partners_of(f);
    if (partners.empty()) return;
    for (const FacetPart& part : parts_of_facet(scene_, f, partners, statistics)) {
      const WindingSides sides = stabbing_.winding_sides(f, part.corners, statistics);
      if (sides.lowest == f) add_piece(f, sides, part.share, part.corners, result);
    }
  }

  void add_piece(FacetIndex f, const WindingSides& sides, std::uint64_t share,
                 const CornerView& corners, PieceCollector& result) const {
    const bool behind = is_inside(rule_, sides.behind);
    if (is_inside(rule_, sides.front) == behind) return;
    const OrientedPlaneRef plane = scene_.facets[f].plane;
    const auto outward = static_cast<signed char>(behind ? 1 : -1);
    result.add({plane.plane, outward}, plane.sense, f, share, corners);
  }

  const Surface& surface_;
  const Scene& scene_;
  FacetStabbing stabbing_;
  FillRule rule_;
  const EvaluateOptions& options_;
};

}  // namespace

std::string_view name_of(FillRule rule) {
  switch (rule) {
    case FillRule::NonZero:
      return "nonzero";
    case FillRule::Positive:
      return "positive";
    case FillRule::EvenOdd:
      return "even-odd";
  }
  return "";
}

Boundary filled_boundary(Polyhedron polyhedron, FillRule rule, const EvaluateOptions& options) {
  if (options.progress != nullptr) options.progress->begin("prepare", 0);
  const Surface surface = checked(std::move(polyhedron), options.threads);
  const Scene scene = scene_of(surface);
  if (options.progress != nullptr) options.progress->begin("fill", scene.facets.size());
  TierStatistics tiers;
  std::vector<PieceBuffer> buffers = Filling(surface, scene, rule, options).pieces(tiers);
  restore_whole_facets(scene, buffers);
  if (options.progress != nullptr) options.progress->begin("merge", 0);
  Boundary boundary = merge_pieces(scene, std::move(buffers), options.threads, options.progress);
  boundary.statistics.tiers += tiers;
  boundary.statistics.primitives = 1;
  boundary.statistics.facets = scene.facets.size();
  return boundary;
}

bool is_boundary_of_solid(Polyhedron polyhedron, const EvaluateOptions& options) {
  const Surface surface = checked(std::move(polyhedron), options.threads);
  const Scene scene = scene_of(surface);
  return Filling(surface, scene, FillRule::Positive, options).is_simple();
}

}  // namespace exactcsg
