// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

PlanarTree apply(const AffineMap2& map, const PlanarTree& tree) {
  const auto& m = map.m;
  if (m[0][0] * m[1][1] == m[0][1] * m[1][0]) return PlanarTree::empty();
  return csg::map(tree, [&](const PlanarFigure& figure) {
    PlanarFigure image = figure;
    for (auto& path : image.paths) {
      for (Point2& p : path) {
        p = {m[0][0] * p.x + m[0][1] * p.y + m[0][2], m[1][0] * p.x + m[1][1] * p.y + m[1][2]};
      }
    }
    return image;
  });
}

}  // namespace exactcsg::io
