// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/planar/outline.hpp"

namespace exactcsg::io {

PlanarFigure resolve(const PlanarTree& tree) {
  const Outline outline = outline_of(tree);
  PlanarFigure figure;
  for (const OutlineComponent& component : outline.components) {
    for (const PlanarLoop& loop : component.loops) {
      auto& path = figure.paths.emplace_back();
      for (const std::uint32_t v : loop) path.push_back(outline.points[v]);
    }
  }
  return figure;
}

}  // namespace exactcsg::io
