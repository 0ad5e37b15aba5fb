// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/planar/outline.hpp"

#include <algorithm>
#include <utility>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/planar/outline_tracer.hpp"
#include "exactcsg/skeleton/divacon.hpp"

namespace exactcsg {

namespace {

using planar::Cell;

Sign turn(const Point2& a, const Point2& b, const Point2& c) {
  return sign_of(cmp((b.x - a.x) * (c.y - b.y), (b.y - a.y) * (c.x - b.x)));
}

Outline convex_outline(std::vector<Point2> polygon) {
  Outline outline;
  outline.points = std::move(polygon);
  PlanarLoop loop(outline.points.size());
  for (std::uint32_t i = 0; i < loop.size(); ++i) loop[i] = i;
  outline.components.push_back({{std::move(loop)}, true});
  return outline;
}

struct Done {};

std::vector<planar::Piece> pieces_of(const planar::Scene& scene, const OutlineOptions& options) {
  std::vector<planar::Piece> pieces;
  planar::Decomposition decomposition(scene, options);
  planar::CellEvaluator evaluator(scene);
  using Expansion = skeleton::Expansion<Done, std::vector<Cell>>;
  const auto solve = [&](const Cell& cell) -> Expansion {
    if (options.progress != nullptr) options.progress->advance(cell.edges.size());
    if (decomposition.is_one_convex_figure(cell)) {
      evaluator.emit_convex(cell, pieces);
    } else {
      evaluator.evaluate(cell, pieces);
    }
    return skeleton::Solved<Done>{};
  };
  skeleton::divacon(
      decomposition.root(),
      [&](Cell& cell) -> Expansion {
        if (options.progress != nullptr) options.progress->check();
        if (cell.tree.is_empty()) return skeleton::Solved<Done>{};
        auto parts = decomposition.divide(cell);
        if (!parts) return solve(cell);
        return skeleton::Divided<std::vector<Cell>>{std::move(*parts)};
      },
      [](std::span<Done>) { return Done{}; });
  return pieces;
}

}  // namespace

std::optional<std::vector<Point2>> strictly_convex(const std::vector<Point2>& path) {
  std::vector<Point2> corners;
  const auto straight_at_end = [&](const Point2& next) {
    const std::size_t n = corners.size();
    return corners.back() == next ||
           (n >= 2 && turn(corners[n - 2], corners[n - 1], next) == Sign::Zero);
  };
  for (const Point2& p : path) {
    while (!corners.empty() && straight_at_end(p)) corners.pop_back();
    corners.push_back(p);
  }
  // The same where the path closes.
  std::size_t first = 0;
  const auto remaining = [&] { return corners.size() - first; };
  for (bool changed = true; changed && remaining() >= 3;) {
    changed = true;
    if (straight_at_end(corners[first])) {
      corners.pop_back();
    } else if (turn(corners.back(), corners[first], corners[first + 1]) == Sign::Zero) {
      ++first;
    } else {
      changed = false;
    }
  }
  if (remaining() < 3) return std::nullopt;
  corners.erase(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first));

  // All turns to one side, and once round: the direction of x changes exactly twice.
  const std::size_t n = corners.size();
  const Sign side = turn(corners[n - 1], corners[0], corners[1]);
  const auto rightward = [&](std::size_t i) {
    const Point2& a = corners[i % n];
    const Point2& b = corners[(i + 1) % n];
    return a.x == b.x ? a.y < b.y : a.x < b.x;
  };
  std::size_t changes = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (turn(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]) != side) return std::nullopt;
    if (rightward(i) != rightward(i + 1)) ++changes;
  }
  if (changes != 2) return std::nullopt;
  if (side == Sign::Negative) std::reverse(corners.begin(), corners.end());
  return corners;
}

Outline outline_of(const PlanarTree& tree, const OutlineOptions& options) {
  if (tree.is_primitive()) {
    const PlanarFigure& figure = tree.primitive();
    if (figure.paths.size() == 1) {
      if (auto polygon = strictly_convex(figure.paths[0])) {
        return convex_outline(std::move(*polygon));
      }
    }
  }
  if (options.progress != nullptr) options.progress->begin("prepare", 0);
  const planar::Scene scene(tree);
  const auto far_away =
      csg::membership_of(scene.tree(), [](planar::FigureIndex) { return csg::Membership::Out; });
  if (far_away == csg::Membership::In) {
    throw Error(ErrorId::UnboundedSolid, {"an unbounded planar set", ""});
  }
  if (options.progress != nullptr) options.progress->begin("decompose", scene.edges().size());
  const std::vector<planar::Piece> pieces = pieces_of(scene, options);
  if (options.progress != nullptr) options.progress->begin("merge", 0);
  return planar::trace_outline(scene, planar::join_pieces(scene, pieces));
}

Outline outline_of(const PlanarFigure& figure) { return outline_of(PlanarTree::primitive(figure)); }

}  // namespace exactcsg
