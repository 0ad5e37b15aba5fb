// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/point_location.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/domain/classify.hpp"
#include "exactcsg/io/openmc/lattice_filter.hpp"
#include "exactcsg/io/openmc/lattices.hpp"
#include "exactcsg/io/openmc/surface_filter.hpp"
#include "exactcsg/io/openmc/surfaces.hpp"

namespace exactcsg::io::openmc {

namespace {

std::array<std::int64_t, 3> numbered(const Lattice& lattice,
                                     const std::array<std::int64_t, 3>& element) {
  if (!lattice.numbering) return element;
  std::array<std::int64_t, 3> result = lattice.numbering->offset;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i] += lattice.numbering->matrix[i][j] * element[j];
  }
  return result;
}

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
  const auto [i, j, layer] = numbered(lattice, *step.element);
  return text + (lattice.has_layers ? fmt::format(" ({}, {}, {})", i, j, layer)
                                    : fmt::format(" ({}, {})", i, j));
}

// What is known of a point in one universe.
struct Found {
  std::vector<Index> cells;
  bool is_on_boundary = false;
};

void ask(Index cell, const HalfSpaceRegion& region, const Point& point, Found& found) {
  const PointClass result = domain::classify(region, point);
  if (result == PointClass::Out) return;
  found.cells.push_back(cell);
  found.is_on_boundary = found.is_on_boundary || result == PointClass::On;
}

// Where a step into a lattice leads.
struct LatticeStep {
  bool is_on_boundary = false;
  std::optional<std::array<std::int64_t, 3>> element;
  std::optional<Index> universe;
};

// Follows fills downwards. nullopt where the walk does not decide.
//   walk.find(universe) -> optional<Found>          walk.enter(cell)       into its fill
//   walk.enter_lattice(index) -> optional<LatticeStep>
template <class Walk>
std::optional<Location> descend(const Model& model, Walk&& walk) {
  Location result;
  result.path.reserve(4);
  Index universe = model.root;
  for (;;) {
    result.path.push_back({StepKind::Universe, universe, std::nullopt});
    std::optional<Found> found = walk.find(universe);
    if (!found) return std::nullopt;
    result.cells = std::move(found->cells);
    if (found->is_on_boundary || result.cells.size() != 1) {
      result.verdict = found->is_on_boundary  ? PointVerdict::OnBoundary
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
    walk.enter(result.cells.front());
    universe = cell.filled_with;
    if (cell.fill != FillKind::Lattice) continue;
    const std::optional<LatticeStep> step = walk.enter_lattice(cell.filled_with);
    if (!step) return std::nullopt;
    result.path.push_back({StepKind::Lattice, cell.filled_with, step->element});
    if (step->is_on_boundary || !step->universe) {
      result.verdict = step->is_on_boundary ? PointVerdict::OnBoundary : PointVerdict::InGap;
      if (step->is_on_boundary) result.path.back().element.reset();
      result.cells.clear();
      return result;
    }
    universe = *step->universe;
  }
}

// In rational coordinates. find(universe, point) -> Found
template <class Find>
class ExactWalk {
 public:
  ExactWalk(const Model& model, const Point& point, Find find)
      : model_(model), point_(point), find_(std::move(find)) {}

  std::optional<Found> find(Index universe) { return find_(universe, point_); }
  void enter(Index cell) {
    const auto& map = model_.cells[cell].to_fill;
    if (map) point_ = domain::apply(*map, point_);
  }
  std::optional<LatticeStep> enter_lattice(Index lattice) {
    LatticePlace place = place_in(model_.lattices[lattice], point_);
    point_ = std::move(place.local);
    return LatticeStep{place.is_on_boundary, place.element, place.universe};
  }

 private:
  const Model& model_;
  Point point_;
  Find find_;
};

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

// How a coordinate compares with a double; nullopt if the errors are too large to tell.
std::optional<Sign> certain_comparison(const CertifiedDouble& x, double value) {
  const double difference = x.value - value;
  if (!(std::abs(difference) > x.error * (1 + 0x1p-50))) return std::nullopt;
  return sign_of(difference > 0 ? 1 : -1);
}
Sign compare(const Point& point, std::size_t axis, double value) {
  const std::optional<Sign> sign = certain_comparison(point.approximate()[axis], value);
  return sign ? *sign : sign_of(cmp(point[axis], rational_of(value)));
}

csg::Membership membership_near(const SurfaceSide& side, const std::vector<SurfaceFilter>& filters,
                                const CertifiedPoint& point) {
  return domain::detail::complement_if(side.is_positive, filters[side.surface].classify(point));
}

// Cells' regions, for points that come in millions: what is read of most of them is in one piece.
class CandidateTable {
 public:
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
  };

  std::size_t size() const { return candidates_.size(); }

  void add(const Model& model, Index cell, const Region& region) {
    const auto first = static_cast<std::uint32_t>(sides_.size());
    Candidate candidate{cell, false, first, first};
    const auto is_side = [](const Region& part) { return part.is_primitive(); };
    if (region.is_full() || is_side(region)) {
      candidate.is_intersection = true;
    } else if (region.is_compose()) {
      candidate.is_intersection =
          region.operation() == csg::BooleanOperator::Intersection &&
          std::all_of(region.children().begin(), region.children().end(), is_side);
    }
    if (candidate.is_intersection) {
      csg::for_each_primitive(region, [&](const SurfaceSide& side) { sides_.push_back(side); });
    }
    candidate.last_side = static_cast<std::uint32_t>(sides_.size());
    candidates_.push_back(candidate);
    regions_.push_back({region, half_spaces(model, region)});
  }

  void ask(const Range& range, const Point& point, Found& found) const {
    for (std::size_t i = range.first; i < range.last; ++i) {
      openmc::ask(candidates_[i].cell, regions_[i].half_spaces, point, found);
    }
  }

  // False if the errors are too large to tell.
  bool ask(const Range& range, const CertifiedPoint& point,
           const std::vector<SurfaceFilter>& filters, Found& found) const {
    for (std::size_t i = range.first; i < range.last; ++i) {
      const csg::Membership at = membership_near(i, point, filters);
      if (at == csg::Membership::Unknown) return false;
      if (at == csg::Membership::In) found.cells.push_back(candidates_[i].cell);
    }
    return true;
  }

 private:
  struct Candidate {
    Index cell;
    bool is_intersection;  // of sides, which are these
    std::uint32_t first_side;
    std::uint32_t last_side;
  };
  struct Regions {
    Region sides;
    HalfSpaceRegion half_spaces;  // the same
  };

  csg::Membership membership_near(std::size_t index, const CertifiedPoint& point,
                                  const std::vector<SurfaceFilter>& filters) const {
    const Candidate& candidate = candidates_[index];
    if (!candidate.is_intersection) {
      return csg::membership_of(regions_[index].sides, [&](const SurfaceSide& side) {
        return openmc::membership_near(side, filters, point);
      });
    }
    csg::Membership result = csg::Membership::In;
    for (std::size_t i = candidate.first_side; i < candidate.last_side; ++i) {
      const csg::Membership at = openmc::membership_near(sides_[i], filters, point);
      if (at == csg::Membership::Out) return at;
      if (at == csg::Membership::Unknown) result = at;
    }
    return result;
  }

  std::vector<Candidate> candidates_;
  std::vector<SurfaceSide> sides_;
  std::vector<Regions> regions_;
};

// A universe's space in halves, each with its cells' regions pruned to it. What is pruned to a box
// says nothing about points on its walls: these, like those outside, are asked of all cells.
class UniverseIndex {
 public:
  UniverseIndex(const Model& model, const std::vector<SurfaceFilter>& filters,
                const Universe& universe) {
    std::vector<Piece> pieces;
    for (const Index cell : universe.cells) pieces.push_back({cell, model.cells[cell].region});
    all_ = entered(model, pieces);
    if (size_of(pieces) > few_surfaces) {
      divide(model, filters, frame_of(model, universe), std::move(pieces));
    }
  }

  Found find(const Point& point) const {
    Found found;
    const auto* candidates = leaf([&](std::size_t axis, double wall) {
      return std::optional<Sign>(compare(point, axis, wall));
    });
    table_.ask(*candidates, point, found);
    return found;
  }

  // nullopt if the errors are too large to tell.
  std::optional<Found> find(const CertifiedPoint& point,
                            const std::vector<SurfaceFilter>& filters) const {
    const auto* candidates =
        leaf([&](std::size_t axis, double wall) { return certain_comparison(point[axis], wall); });
    Found found;
    if (candidates == nullptr || !table_.ask(*candidates, point, filters, found)) {
      return std::nullopt;
    }
    return found;
  }

 private:
  static constexpr std::uint64_t few_surfaces = 6;
  static constexpr unsigned most_divisions = 40;
  static constexpr unsigned most_divisions_in_vain = 3;

  // What a cell is in a frame.
  struct Piece {
    Index cell;
    Region region;
  };
  // Small: most of the time goes into fetching them.
  struct Node {
    double wall = 0;
    std::uint32_t link = 0;  // the lower child, which the upper one follows; of a leaf, a range
    std::uint32_t axis = leaf_axis;
  };
  static constexpr std::uint32_t leaf_axis = 3;
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

  CandidateTable::Range entered(const Model& model, const std::vector<Piece>& pieces) {
    const auto first = static_cast<std::uint32_t>(table_.size());
    for (const Piece& piece : pieces) table_.add(model, piece.cell, piece.region);
    return {first, static_cast<std::uint32_t>(table_.size())};
  }

  static std::vector<Piece> pruned(const std::vector<SurfaceFilter>& filters,
                                   const std::vector<Piece>& pieces, const Frame& frame) {
    std::vector<Piece> result;
    for (const Piece& piece : pieces) {
      Region region = csg::prune(piece.region, [&](const SurfaceSide& side) {
        const csg::Membership negative = filters[side.surface].classify(frame.lower, frame.upper);
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

  static Division division(const std::vector<SurfaceFilter>& filters, const Frame& frame,
                           const std::vector<Piece>& pieces, std::size_t axis) {
    Division result;
    result.axis = axis;
    result.wall = frame.lower[axis] + 0.4917 * (frame.upper[axis] - frame.lower[axis]);
    result.frames = {frame, frame};
    result.frames[0].upper[axis] = result.wall;
    result.frames[1].lower[axis] = result.wall;
    for (std::size_t half = 0; half < 2; ++half) {
      result.pieces[half] = pruned(filters, pieces, result.frames[half]);
      result.size += size_of(result.pieces[half]);
    }
    return result;
  }

  // The one that leaves the least.
  static std::optional<Division> best_division(const std::vector<SurfaceFilter>& filters,
                                               const Task& task) {
    std::optional<Division> best;
    const Frame& frame = task.frame;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double extent = frame.upper[axis] - frame.lower[axis];
      if (!frame.is_divided[axis] || !(extent > 1e-9 * std::abs(frame.upper[axis]))) continue;
      Division tried = division(filters, frame, task.pieces, axis);
      if (!best || tried.size < best->size) best = std::move(tried);
    }
    return best;
  }

  void divide(const Model& model, const std::vector<SurfaceFilter>& filters, const Frame& frame,
              std::vector<Piece> pieces) {
    frame_ = frame;
    nodes_.emplace_back();
    std::vector<Task> pending;
    pending.push_back({0, frame, pruned(filters, pieces, frame), 0, 0});
    while (!pending.empty()) {
      const Task task = std::move(pending.back());
      pending.pop_back();
      if (!divide_node(filters, task, pending)) {
        nodes_[task.node].link = static_cast<std::uint32_t>(leaves_.size());
        leaves_.push_back(entered(model, task.pieces));
      }
    }
  }

  // False if the node is to be a leaf.
  bool divide_node(const std::vector<SurfaceFilter>& filters, const Task& task,
                   std::vector<Task>& pending) {
    const std::uint64_t size = size_of(task.pieces);
    if (size <= few_surfaces || task.depth == most_divisions ||
        task.in_vain == most_divisions_in_vain) {
      return false;
    }
    std::optional<Division> best = best_division(filters, task);
    if (!best) return false;
    nodes_[task.node] = {best->wall, static_cast<std::uint32_t>(nodes_.size()),
                         static_cast<std::uint32_t>(best->axis)};
    // Nothing on one side: the frame was too wide there, which is neither in vain nor a success.
    const bool is_narrower =
        10 * std::min(size_of(best->pieces[0]), size_of(best->pieces[1])) <= size;
    for (std::size_t half = 0; half < 2; ++half) {
      const bool is_smaller = size_of(best->pieces[half]) * 10 <= size * 9;
      const unsigned in_vain = is_smaller ? 0 : task.in_vain + (is_narrower ? 0 : 1);
      pending.push_back({nodes_.size(), best->frames[half], std::move(best->pieces[half]),
                         task.depth + 1, in_vain});
      nodes_.emplace_back();
    }
    return true;
  }

  // compare(axis, wall) -> optional<Sign> says on which side of a wall the point is. nullptr if it
  // does not say.
  template <class Compare>
  const CandidateTable::Range* leaf(Compare&& compare_with) const {
    if (nodes_.empty()) return &all_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<Sign> below = compare_with(axis, frame_.lower[axis]);
      const std::optional<Sign> above = compare_with(axis, frame_.upper[axis]);
      if (!below || !above) return nullptr;
      if (*below != Sign::Positive || *above != Sign::Negative) return &all_;
    }
    const Node* node = nodes_.data();
    while (node->axis != leaf_axis) {
      const std::optional<Sign> side = compare_with(node->axis, node->wall);
      if (!side) return nullptr;
      if (*side == Sign::Zero) return &all_;
      node = &nodes_[node->link + (*side == Sign::Positive ? 1U : 0U)];
    }
    return &leaves_[node->link];
  }

  CandidateTable table_;
  CandidateTable::Range all_;
  Frame frame_{};
  std::vector<Node> nodes_;
  std::vector<CandidateTable::Range> leaves_;
};

}  // namespace

std::string path_text(const Model& model, const std::vector<Step>& path) {
  std::string text;
  for (const Step& step : path) text += (text.empty() ? "" : " > ") + text_of(model, step);
  return text;
}

Location locate(const Model& model, const Point& point) {
  return *descend(model, ExactWalk(model, point, [&](Index universe, const Point& local) {
                    Found found;
                    for (const Index cell : model.universes[universe].cells) {
                      ask(cell, half_spaces(model, model.cells[cell].region), local, found);
                    }
                    return found;
                  }));
}

struct PointLocator::Data {
  explicit Data(const Model& m) : model(&m) {
    for (const Surface& surface : m.surfaces) surfaces.emplace_back(surface.negative);
    for (const Universe& universe : m.universes) universes.emplace_back(m, surfaces, universe);
    for (const Lattice& lattice : m.lattices) lattices.emplace_back(lattice);
    for (const Cell& cell : m.cells) {
      maps.emplace_back();
      for (std::size_t i = 0; i < 3 && cell.to_fill; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          maps.back()[i][j] = certified_double_of(cell.to_fill->m[i][j]);
        }
      }
    }
  }
  const Model* model;
  std::vector<SurfaceFilter> surfaces;
  std::vector<UniverseIndex> universes;
  std::vector<LatticeFilter> lattices;
  // Of each cell, to its fill, if it has such a map.
  std::vector<std::array<std::array<CertifiedDouble, 4>, 3>> maps;

  // In doubles with their errors, which decide most points.
  class Walk {
   public:
    Walk(const Data& data, const CertifiedPoint& point) : data_(data), point_(point) {}

    std::optional<Found> find(Index universe) {
      return data_.universes[universe].find(point_, data_.surfaces);
    }
    void enter(Index cell) {
      if (!data_.model->cells[cell].to_fill) return;
      const auto& map = data_.maps[cell];
      CertifiedPoint image;
      for (std::size_t i = 0; i < 3; ++i) {
        image[i] = map[i][3];
        for (std::size_t j = 0; j < 3; ++j) image[i] = image[i] + map[i][j] * point_[j];
      }
      point_ = image;
    }
    std::optional<LatticeStep> enter_lattice(Index lattice) {
      const std::optional<FilteredPlace> place = data_.lattices[lattice].place(point_);
      if (!place) return std::nullopt;
      point_ = place->local;
      return LatticeStep{false, place->element, place->universe};
    }

   private:
    const Data& data_;
    CertifiedPoint point_;
  };
};

PointLocator::PointLocator(const Model& model) : data_(std::make_unique<const Data>(model)) {}
PointLocator::~PointLocator() = default;
PointLocator::PointLocator(PointLocator&&) noexcept = default;
PointLocator& PointLocator::operator=(PointLocator&&) noexcept = default;

Location PointLocator::operator()(const Point& point) const {
  if (auto location = descend(*data_->model, Data::Walk(*data_, point.approximate()))) {
    return *std::move(location);
  }
  return *descend(*data_->model,
                  ExactWalk(*data_->model, point, [&](Index universe, const Point& local) {
                    return data_->universes[universe].find(local);
                  }));
}

}  // namespace exactcsg::io::openmc
