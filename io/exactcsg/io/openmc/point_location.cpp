// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/point_location.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/domain/classify.hpp"
#include "exactcsg/io/openmc/lattices.hpp"
#include "exactcsg/io/openmc/surfaces.hpp"

namespace exactcsg::io::openmc {

namespace {

std::string text_of(const Model& model, const Step& step) {
  switch (step.kind) {
    case StepKind::Universe:
      return fmt::format("universe {}", model.universes[step.index].id);
    case StepKind::Cell:
      return fmt::format("cell {}", model.cells[step.index].id);
    case StepKind::Lattice:
      break;
  }
  const Lattice& lattice = model.lattices[step.index];
  std::string text = fmt::format("lattice {}", lattice.id);
  if (!step.element) return text;
  const auto& [i, j, layer] = *step.element;
  return text + (lattice.has_layers ? fmt::format(" ({}, {}, {})", i, j, layer)
                                    : fmt::format(" ({}, {})", i, j));
}

struct Candidate {
  Index cell;
  HalfSpaceRegion region;
};

// What is known of a point in one universe.
struct Found {
  std::vector<Index> cells;
  bool is_on_boundary = false;
};

void ask(const Candidate& candidate, const Point& point, Found& found) {
  const PointClass result = domain::classify(candidate.region, point);
  if (result == PointClass::Out) return;
  found.cells.push_back(candidate.cell);
  found.is_on_boundary = found.is_on_boundary || result == PointClass::On;
}

// Follows fills downwards. find(universe, point) -> Found
template <class Find>
Location descend(const Model& model, Point point, Find&& find) {
  Location result;
  Index universe = model.root;
  for (;;) {
    result.path.push_back({StepKind::Universe, universe, std::nullopt});
    Found found = find(universe, point);
    result.cells = std::move(found.cells);
    if (found.is_on_boundary || result.cells.size() != 1) {
      result.verdict = found.is_on_boundary   ? PointVerdict::OnBoundary
                       : result.cells.empty() ? PointVerdict::InGap
                                              : PointVerdict::InOverlap;
      return result;
    }
    const Cell& cell = model.cells[result.cells.front()];
    result.path.push_back({StepKind::Cell, result.cells.front(), std::nullopt});
    if (cell.fill == FillKind::Material) {
      result.verdict = PointVerdict::InCell;
      return result;
    }
    if (cell.to_fill) point = domain::apply(*cell.to_fill, point);
    universe = cell.filled_with;
    if (cell.fill != FillKind::Lattice) continue;
    LatticePlace place = place_in(model.lattices[cell.filled_with], point);
    result.path.push_back({StepKind::Lattice, cell.filled_with, place.element});
    if (place.is_on_boundary || !place.universe) {
      result.verdict = place.is_on_boundary ? PointVerdict::OnBoundary : PointVerdict::InGap;
      if (place.is_on_boundary) result.path.back().element.reset();
      result.cells.clear();
      return result;
    }
    universe = *place.universe;
    point = std::move(place.local);
  }
}

// Rough extents of the surfaces of some cells, widened; where none is bounded along an axis, the
// axis is not divided.
struct Frame {
  std::array<double, 3> lower, upper;
  std::array<bool, 3> is_divided;
};

Frame frame_of(const Model& model, const Universe& universe) {
  constexpr double far = 1e9;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Frame frame{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, {}};
  for (const Index cell : universe.cells) {
    csg::for_each_primitive(model.cells[cell].region, [&](const SurfaceSide& side) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto extent = extent_along(model.surfaces[side.surface], axis);
        frame.lower[axis] = std::min(frame.lower[axis], extent[0]);
        frame.upper[axis] = std::max(frame.upper[axis], extent[1]);
      }
    });
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double& lower = frame.lower[axis];
    double& upper = frame.upper[axis];
    frame.is_divided[axis] = lower < upper;
    if (!(lower <= upper)) {
      lower = -far;
      upper = far;
    }
    // Odd numbers: points that people write should not lie on the walls.
    const double margin = 0.51371 * (upper - lower) + 0.01371 * std::max(1.0, std::abs(upper));
    lower -= margin;
    upper += margin;
  }
  return frame;
}

// A surface's polynomial in doubles, for its range over a frame. [Certified]
class SurfaceRange {
 public:
  explicit SurfaceRange(const HalfSpace& half_space) {
    const domain::Quadric<3>& f = half_space.polynomial();
    constant_ = nearest_double(f.linear().constant);
    for (std::size_t i = 0; i < 3; ++i) {
      linear_[i] = nearest_double(f.linear().normal[i]);
      for (std::size_t j = 0; j < 3; ++j) square_[i][j] = nearest_double(f.square()[i][j]);
    }
  }

  // Of f <= 0. In and Out are certain.
  csg::Membership classify(const Frame& frame) const {
    double low = constant_;
    double high = 0;  // above low
    double magnitude = std::abs(constant_);
    for (std::size_t i = 0; i < 3; ++i) {
      const double middle = 0.5 * (frame.lower[i] + frame.upper[i]);
      const double reach = 0.5 * (frame.upper[i] - frame.lower[i]);
      const double far = std::abs(middle) + reach;
      double slope = linear_[i];
      low += linear_[i] * middle;
      magnitude += std::abs(linear_[i]) * far;
      for (std::size_t j = 0; j < 3; ++j) {
        const double other = 0.5 * (frame.lower[j] + frame.upper[j]);
        const double other_reach = 0.5 * (frame.upper[j] - frame.lower[j]);
        slope += 2 * square_[i][j] * other;
        low += square_[i][j] * middle * other;
        magnitude += 4 * std::abs(square_[i][j]) * far * (std::abs(other) + other_reach);
        if (i == j) continue;
        const double mixed = std::abs(square_[i][j]) * reach * other_reach;
        low -= mixed;
        high += 2 * mixed;
      }
      const auto [least, greatest] = range_along(square_[i][i], slope, reach);
      low += least;
      high += greatest - least;
    }
    // Some fifty roundings of terms whose sum of magnitudes this is: far below a part in 10^12.
    const double slack = 1e-12 * magnitude + 1e-300;
    if (low > slack) return csg::Membership::Out;
    return low + high < -slack ? csg::Membership::In : csg::Membership::Unknown;
  }

 private:
  // Of a t^2 + b t for |t| <= reach.
  static std::array<double, 2> range_along(double a, double b, double reach) {
    const double square = a * reach * reach;
    const double sides = std::abs(b) * reach;
    std::array<double, 2> range{square - sides, square + sides};
    if (std::abs(b) < 2 * std::abs(a) * reach) range[a > 0 ? 0 : 1] = -b * b / (4 * a);
    return range;
  }

  double constant_ = 0;
  std::array<double, 3> linear_{};
  std::array<std::array<double, 3>, 3> square_{};
};

// How a coordinate compares with a double.
Sign compare(const Point& point, std::size_t axis, double value) {
  const CertifiedDouble& x = point.approximate()[axis];
  const double difference = x.value - value;
  if (std::abs(difference) > x.error * (1 + 0x1p-50)) return sign_of(difference > 0 ? 1 : -1);
  return sign_of(cmp(point[axis], rational_of(value)));
}

// A universe's space in halves, each with its cells' regions pruned to it. What is pruned to a box
// says nothing about points on its walls: these, like those outside, are asked of all cells.
class UniverseIndex {
 public:
  UniverseIndex(const Model& model, const std::vector<SurfaceRange>& ranges,
                const Universe& universe) {
    std::vector<Piece> pieces;
    for (const Index cell : universe.cells) pieces.push_back({cell, model.cells[cell].region});
    all_ = candidates_of(model, pieces);
    if (size_of(pieces) > few_surfaces) {
      divide(model, ranges, frame_of(model, universe), std::move(pieces));
    }
  }

  Found find(const Point& point) const {
    Found found;
    for (const Candidate& candidate : candidates(point)) ask(candidate, point, found);
    return found;
  }

 private:
  static constexpr std::uint64_t few_surfaces = 12;
  static constexpr unsigned most_divisions = 40;
  static constexpr unsigned most_divisions_in_vain = 3;

  // What a cell is in a frame.
  struct Piece {
    Index cell;
    Region region;
  };
  struct Node {
    std::size_t axis = 0;
    double wall = 0;
    std::size_t children = 0;  // the lower one, the upper one follows; 0: a leaf
    std::vector<Candidate> candidates;
  };
  struct Task {
    std::size_t node;
    Frame frame;
    std::vector<Piece> pieces;
    unsigned depth;
    unsigned in_vain;  // divisions since one made this branch smaller
  };

  static std::uint64_t size_of(const std::vector<Piece>& pieces) {
    std::uint64_t size = 0;
    for (const Piece& piece : pieces) size += piece.region.primitive_count();
    return size;
  }

  static std::vector<Candidate> candidates_of(const Model& model,
                                              const std::vector<Piece>& pieces) {
    std::vector<Candidate> result;
    for (const Piece& piece : pieces) {
      result.push_back({piece.cell, half_spaces(model, piece.region)});
    }
    return result;
  }

  static std::vector<Piece> pruned(const std::vector<SurfaceRange>& ranges,
                                   const std::vector<Piece>& pieces, const Frame& frame) {
    std::vector<Piece> result;
    for (const Piece& piece : pieces) {
      Region region = csg::prune(piece.region, [&](const SurfaceSide& side) {
        const csg::Membership negative = ranges[side.surface].classify(frame);
        if (!side.is_positive || negative == csg::Membership::Unknown) return negative;
        return negative == csg::Membership::In ? csg::Membership::Out : csg::Membership::In;
      });
      if (!region.is_empty()) result.push_back({piece.cell, std::move(region)});
    }
    return result;
  }

  // A node's halves across an axis.
  struct Division {
    std::size_t axis = 0;
    double wall = 0;
    std::array<Frame, 2> frames;
    std::array<std::vector<Piece>, 2> pieces;
    std::uint64_t size = 0;  // of both
  };

  static Division division(const std::vector<SurfaceRange>& ranges, const Frame& frame,
                           const std::vector<Piece>& pieces, std::size_t axis) {
    Division result;
    result.axis = axis;
    result.wall = frame.lower[axis] + 0.4917 * (frame.upper[axis] - frame.lower[axis]);
    result.frames = {frame, frame};
    result.frames[0].upper[axis] = result.wall;
    result.frames[1].lower[axis] = result.wall;
    for (std::size_t half = 0; half < 2; ++half) {
      result.pieces[half] = pruned(ranges, pieces, result.frames[half]);
      result.size += size_of(result.pieces[half]);
    }
    return result;
  }

  // The one that leaves the least.
  static std::optional<Division> best_division(const std::vector<SurfaceRange>& ranges,
                                               const Task& task) {
    std::optional<Division> best;
    const Frame& frame = task.frame;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double extent = frame.upper[axis] - frame.lower[axis];
      if (!frame.is_divided[axis] || !(extent > 1e-9 * std::abs(frame.upper[axis]))) continue;
      Division tried = division(ranges, frame, task.pieces, axis);
      if (!best || tried.size < best->size) best = std::move(tried);
    }
    return best;
  }

  void divide(const Model& model, const std::vector<SurfaceRange>& ranges, const Frame& frame,
              std::vector<Piece> pieces) {
    frame_ = frame;
    nodes_.emplace_back();
    std::vector<Task> pending;
    pending.push_back({0, frame, pruned(ranges, pieces, frame), 0, 0});
    while (!pending.empty()) {
      const Task task = std::move(pending.back());
      pending.pop_back();
      if (!divide_node(ranges, task, pending)) {
        nodes_[task.node].candidates = candidates_of(model, task.pieces);
      }
    }
  }

  // False if the node is to be a leaf.
  bool divide_node(const std::vector<SurfaceRange>& ranges, const Task& task,
                   std::vector<Task>& pending) {
    const std::uint64_t size = size_of(task.pieces);
    if (size <= few_surfaces || task.depth == most_divisions ||
        task.in_vain == most_divisions_in_vain) {
      return false;
    }
    std::optional<Division> best = best_division(ranges, task);
    if (!best) return false;
    nodes_[task.node] = {best->axis, best->wall, nodes_.size(), {}};
    for (std::size_t half = 0; half < 2; ++half) {
      const bool is_smaller = size_of(best->pieces[half]) * 10 <= size * 9;
      pending.push_back({nodes_.size(), best->frames[half], std::move(best->pieces[half]),
                         task.depth + 1, is_smaller ? 0 : task.in_vain + 1});
      nodes_.emplace_back();
    }
    return true;
  }

  const std::vector<Candidate>& candidates(const Point& point) const {
    if (nodes_.empty()) return all_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (compare(point, axis, frame_.lower[axis]) != Sign::Positive ||
          compare(point, axis, frame_.upper[axis]) != Sign::Negative) {
        return all_;
      }
    }
    const Node* node = nodes_.data();
    while (node->children != 0) {
      const Sign side = compare(point, node->axis, node->wall);
      if (side == Sign::Zero) return all_;
      node = &nodes_[node->children + (side == Sign::Positive ? 1 : 0)];
    }
    return node->candidates;
  }

  std::vector<Candidate> all_;
  Frame frame_{};
  std::vector<Node> nodes_;
};

}  // namespace

std::string path_text(const Model& model, const std::vector<Step>& path) {
  std::string text;
  for (const Step& step : path) text += (text.empty() ? "" : " > ") + text_of(model, step);
  return text;
}

Location locate(const Model& model, const Point& point) {
  return descend(model, point, [&](Index universe, const Point& local) {
    Found found;
    for (const Index cell : model.universes[universe].cells) {
      ask({cell, half_spaces(model, model.cells[cell].region)}, local, found);
    }
    return found;
  });
}

struct PointLocator::Data {
  explicit Data(const Model& m) : model(&m) {
    std::vector<SurfaceRange> ranges;
    for (const Surface& surface : m.surfaces) ranges.emplace_back(surface.negative);
    for (const Universe& universe : m.universes) universes.emplace_back(m, ranges, universe);
  }
  const Model* model;
  std::vector<UniverseIndex> universes;
};

PointLocator::PointLocator(const Model& model) : data_(std::make_unique<const Data>(model)) {}
PointLocator::~PointLocator() = default;
PointLocator::PointLocator(PointLocator&&) noexcept = default;
PointLocator& PointLocator::operator=(PointLocator&&) noexcept = default;

Location PointLocator::operator()(const Point& point) const {
  return descend(*data_->model, point, [&](Index universe, const Point& local) {
    return data_->universes[universe].find(local);
  });
}

}  // namespace exactcsg::io::openmc
