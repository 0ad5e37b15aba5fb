// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/planar/decomposition.hpp"

#include <algorithm>
#include <cmath>

namespace exactcsg::planar {

namespace {

using csg::Membership;

constexpr std::uint32_t depth_limit = 4000;
constexpr std::size_t sample_size = 64;

// A division is one into cells that together are cheaper to evaluate, by this factor.
constexpr double worthwhile = 0.75;
// To find one, so many times the cell's edges may be handed down.
constexpr std::size_t look_ahead = 16;

bool is_all(const FigureTree& tree) { return tree.is_empty() || tree.is_full(); }

}  // namespace

Decomposition::Decomposition(const Scene& scene, const OutlineOptions& options)
    : scene_(scene),
      edges_per_cell_(options.edges_per_cell),
      status_(scene.figures().size(), Membership::Unknown),
      in_tree_(scene.figures().size(), 0),
      counted_(scene.segment_count(), 0) {}

Cell Decomposition::root() const {
  Cell cell;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -lower;
    for (PointIndex p = 0; p < scene_.point_count(); ++p) {
      lower = std::min(lower, scene_.point(p)[axis].lower());
      upper = std::max(upper, scene_.point(p)[axis].upper());
    }
    // All points are strictly within.
    cell.lower[axis] = std::nextafter(lower, -HUGE_VAL);
    cell.upper[axis] = std::nextafter(upper, HUGE_VAL);
  }
  cell.edges.reserve(scene_.edges().size());
  for (FigureIndex f = 0; f < scene_.figures().size(); ++f) {
    const Figure& figure = scene_.figures()[f];
    if (figure.edge_count == 0) continue;
    cell.figures.push_back({f, false, figure.first_edge, figure.edge_count});
  }
  for (EdgeIndex e = 0; e < scene_.edges().size(); ++e) {
    ClippedEdge clipped;
    clipped.edge = e;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const CertifiedDouble& a = scene_.point(scene_.edges()[e].from)[axis];
      const CertifiedDouble& b = scene_.point(scene_.edges()[e].to)[axis];
      clipped.lower[axis] = std::min(a.lower(), b.lower());
      clipped.upper[axis] = std::max(a.upper(), b.upper());
    }
    cell.edges.push_back(clipped);
  }
  // Figures without an edge are empty.
  FigureTree pruned;
  csg::PruneScratch<FigureTree> scratch;
  csg::prune_into(
      scene_.tree(),
      [&](FigureIndex f) {
        return scene_.figures()[f].edge_count == 0 ? Membership::Out : Membership::Unknown;
      },
      pruned, scratch);
  cell.tree = std::move(pruned);
  return cell;
}

std::size_t Decomposition::count_segments(const Cell& cell) {
  ++count_;
  std::size_t segments = 0;
  for (const ClippedEdge& clipped : cell.edges) {
    std::uint64_t& counted = counted_[scene_.edges()[clipped.edge].segment];
    if (counted == count_) continue;
    counted = count_;
    ++segments;
  }
  return segments;
}

bool Decomposition::is_small(const Cell& cell) {
  return cell.edges.size() <= edges_per_cell_ || is_one_convex_figure(cell) ||
         cell.depth >= depth_limit || count_segments(cell) <= edges_per_cell_;
}

// Of evaluation: every segment is held against every other, and against the figures.
double Decomposition::cost(const Cell& cell) {
  const auto edges = static_cast<double>(cell.edges.size());
  if (is_one_convex_figure(cell)) return edges;
  const auto segments = static_cast<double>(count_segments(cell));
  return segments * (segments + edges);
}

std::optional<std::vector<Cell>> Decomposition::divide(const Cell& cell) {
  if (is_small(cell)) return std::nullopt;
  const double bound = worthwhile * cost(cell);
  std::vector<Cell> cells;
  const auto divide_into = [&](const Cell& part, std::vector<Cell>& parts) {
    const auto wall = choose_wall(part);
    if (!wall) return false;
    for (Cell& child : divide(part, *wall)) parts.push_back(std::move(child));
    return true;
  };
  if (!divide_into(cell, cells)) return std::nullopt;
  for (;;) {
    double sum = 0;
    std::size_t edges = 0;
    for (const Cell& part : cells) {
      sum += cost(part);
      edges += part.edges.size();
    }
    if (sum <= bound) return cells;
    if (edges > std::min(look_ahead, cell.edges.size() / 8) * cell.edges.size()) {
      return std::nullopt;
    }
    std::vector<Cell> next;
    bool changed = false;
    for (Cell& part : cells) {
      if (!is_small(part) && divide_into(part, next)) {
        changed = true;
      } else {
        next.push_back(std::move(part));
      }
    }
    if (!changed) return std::nullopt;
    cells = std::move(next);
  }
}

// Near the median of the edges' middles, along the axis where fewer edges reach both sides.
std::optional<Wall> Decomposition::choose_wall(const Cell& cell) const {
  const std::size_t count = std::min(cell.edges.size(), sample_size);
  std::array<double, sample_size> middles;
  std::optional<Wall> best;
  double best_cost = std::numeric_limits<double>::infinity();
  const auto sampled = [&](std::size_t i) -> const ClippedEdge& {
    return cell.edges[i * cell.edges.size() / count];
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -least;
    for (std::size_t i = 0; i < count; ++i) {
      const ClippedEdge& edge = sampled(i);
      middles[i] = edge.lower[axis] + (edge.upper[axis] - edge.lower[axis]) / 2;
      least = std::min(least, edge.lower[axis]);
      greatest = std::max(greatest, edge.upper[axis]);
    }
    const auto end = middles.begin() + static_cast<std::ptrdiff_t>(count);
    const auto median = middles.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(middles.begin(), median, end);
    const double below = *std::max_element(middles.begin(), median);
    // Models' coordinates are round; the fraction is not.
    const std::array<double, 2> candidates{below + 0.4609375 * (*median - below),
                                           least + 0.4609375 * (greatest - least)};
    for (const double position : candidates) {
      if (!(cell.lower[axis] < position && position < cell.upper[axis])) continue;
      double reach_below = 0;
      double reach_above = 0;
      for (std::size_t i = 0; i < count; ++i) {
        if (sampled(i).lower[axis] <= position) ++reach_below;
        if (sampled(i).upper[axis] > position) ++reach_above;
      }
      const double cost =
          reach_below * std::log2(reach_below + 1) + reach_above * std::log2(reach_above + 1);
      if (cost < best_cost) {
        best_cost = cost;
        best = Wall{axis, position};
      }
    }
  }
  return best;
}

// What both children of one division share while they are made.
class Decomposition::Divider {
 public:
  Divider(Decomposition& decomposition, const Cell& cell, const Wall& wall)
      : decomposition_(decomposition),
        scene_(decomposition.scene_),
        cell_(cell),
        wall_(wall),
        ends_above_(decomposition.ends_above_) {}

  std::vector<Cell> divide() {
    find_sides();
    std::vector<Cell> children;
    children.reserve(2);
    for (const bool above : {false, true}) {
      Cell child;
      prune(above, child);
      if (is_all(child.tree)) continue;
      fill(above, child);
      children.push_back(std::move(child));
    }
    return children;
  }

 private:
  struct FigureSides {
    std::array<std::uint32_t, 2> counts{};  // of edges that reach below and above
    std::array<bool, 2> corner_inside{};    // of the children
  };

  bool is_above(const ClippedEdge& clipped, const ClipEnd& end, PointIndex point) const {
    if (!end.wall) return scene_.compare(point, wall_.axis, wall_.position) == Sign::Positive;
    if (end.wall->axis == wall_.axis) return end.wall->position > wall_.position;
    return scene_.compare_at_wall(clipped.edge, *end.wall, end.along, wall_.position) ==
           Sign::Positive;
  }

  void find_sides() {
    ends_above_.resize(cell_.edges.size());
    sides_.reserve(cell_.figures.size());
    const Wall base{1 - wall_.axis, cell_.lower[1 - wall_.axis]};
    for (const CellFigure& figure : cell_.figures) {
      FigureSides sides;
      bool corner_above = figure.corner_inside;
      for (std::uint32_t i = figure.first_edge; i < figure.first_edge + figure.edge_count; ++i) {
        const ClippedEdge& clipped = cell_.edges[i];
        auto& above = ends_above_[i];
        if (clipped.upper[wall_.axis] < wall_.position) {
          above = {false, false};
        } else if (clipped.lower[wall_.axis] > wall_.position) {
          above = {true, true};
        } else {
          const Edge& edge = scene_.edges()[clipped.edge];
          above = {is_above(clipped, clipped.from, edge.from),
                   is_above(clipped, clipped.to, edge.to)};
        }
        // The upper child's corner is beyond the crossings of the base that are below the wall.
        if (clipped.from.wall == base && !above[0]) corner_above = !corner_above;
        if (clipped.to.wall == base && !above[1]) corner_above = !corner_above;
        if (!above[0] || !above[1]) ++sides.counts[0];
        if (above[0] || above[1]) ++sides.counts[1];
      }
      sides.corner_inside = {figure.corner_inside, corner_above};
      sides_.push_back(sides);
    }
  }

  void prune(bool above, Cell& child) {
    auto& status = decomposition_.status_;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (sides_[i].counts[above ? 1 : 0] != 0) continue;
      status[cell_.figures[i].figure] =
          sides_[i].corner_inside[above ? 1 : 0] ? Membership::In : Membership::Out;
    }
    csg::prune_into(
        cell_.tree, [&](FigureIndex figure) { return status[figure]; }, child.tree,
        decomposition_.prune_);
    for (const CellFigure& figure : cell_.figures) status[figure.figure] = Membership::Unknown;
  }

  // 1: the tree's figures; 0: none, again.
  void mark(const FigureTree& tree, unsigned char value) {
    auto node = tree.root();
    const auto end = node.next_sibling();
    for (; !(node == end); node = node.first_child()) {
      if (node.kind() == csg::NodeKind::Primitive)
        decomposition_.in_tree_[node.primitive()] = value;
    }
  }

  void fill(bool above, Cell& child) {
    const std::size_t which = above ? 1 : 0;
    child.lower = cell_.lower;
    child.upper = cell_.upper;
    (above ? child.lower : child.upper)[wall_.axis] = wall_.position;
    child.depth = cell_.depth + 1;
    mark(child.tree, 1);
    std::size_t edges = 0;
    std::size_t figures = 0;
    const auto is_kept = [&](std::size_t i) {
      return sides_[i].counts[which] != 0 && decomposition_.in_tree_[cell_.figures[i].figure] != 0;
    };
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (!is_kept(i)) continue;
      ++figures;
      edges += sides_[i].counts[which];
    }
    child.edges.reserve(edges);
    child.figures.reserve(figures);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (!is_kept(i)) continue;
      const CellFigure& figure = cell_.figures[i];
      child.figures.push_back({figure.figure, sides_[i].corner_inside[which],
                               static_cast<std::uint32_t>(child.edges.size()),
                               sides_[i].counts[which]});
      for (std::uint32_t e = figure.first_edge; e < figure.first_edge + figure.edge_count; ++e) {
        add_part(above, e, child);
      }
    }
    mark(child.tree, 0);
  }

  void add_part(bool above, std::uint32_t index, Cell& child) {
    const auto [from_above, to_above] = ends_above_[index];
    const ClippedEdge& clipped = cell_.edges[index];
    if (from_above == to_above) {
      if (from_above == above) child.edges.push_back(clipped);
      return;
    }
    ClippedEdge& part = child.edges.emplace_back(clipped);
    const ClipEnd cut{wall_, scene_.at_wall(clipped.edge, wall_)};
    (from_above == above ? part.to : part.from) = cut;
    (above ? part.lower : part.upper)[wall_.axis] = wall_.position;
    // The edge is monotone: the other coordinate is between those of the part's ends.
    const std::size_t other = 1 - wall_.axis;
    const Sign direction = scene_.edges()[clipped.edge].direction[other];
    if (direction == Sign::Zero) return;
    const bool is_upper = (from_above == above) == (direction == Sign::Positive);
    if (is_upper) {
      part.upper[other] = std::min(part.upper[other], cut.along.upper());
    } else {
      part.lower[other] = std::max(part.lower[other], cut.along.lower());
    }
  }

  Decomposition& decomposition_;
  const Scene& scene_;
  const Cell& cell_;
  const Wall wall_;
  std::vector<std::array<bool, 2>>& ends_above_;
  std::vector<FigureSides> sides_;
};

std::vector<Cell> Decomposition::divide(const Cell& cell, const Wall& wall) {
  return Divider(*this, cell, wall).divide();
}

}  // namespace exactcsg::planar
