// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/cell_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/csg/operator_laws.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/skeleton/divacon.hpp"
#include "exactcsg/solid/mesh_membership.hpp"
#include "exactcsg/support/give_up.hpp"

namespace exactcsg {

using csg::BooleanOperator;
using csg::Constant;
using csg::Membership;

namespace {

// Divisions of so many facets are worth the threads.
constexpr std::size_t facets_for_threads = 4096;

PrunedTree constant_tree(Constant constant) {
  PrunedTree tree;
  if (constant == Constant::Full) tree.append_full();
  return tree;
}

PrunedTree primitive_tree(PrimitiveIndex primitive) {
  PrunedTree tree;
  tree.append_primitive(primitive);
  return tree;
}

void append_tree(PrunedTree& tree, PrunedTree::Cursor part) {
  std::vector<PrunedTree::OpenNode> open;
  csg::walk(
      part,
      [&](auto node) {
        open.push_back(tree.open(node.operation()));
        return true;
      },
      [&](auto node) {
        if (node.kind() == csg::NodeKind::Primitive) {
          tree.append_primitive(node.primitive());
        } else if (node.kind() == csg::NodeKind::Full) {
          tree.append_full();
        } else {
          tree.append_empty();
        }
      },
      [&](auto) {
        tree.close(open.back());
        open.pop_back();
      });
}

// (first op second), simplified.
PrunedTree combined(const PrunedTree& first, BooleanOperator operation, const PrunedTree& second) {
  PrunedTree both;
  both.reserve(1 + first.node_count() + second.node_count());
  const auto node = both.open(operation);
  append_tree(both, first.root());
  append_tree(both, second.root());
  both.close(node);
  PrunedTree result;
  csg::prune_into(
      both, [](PrimitiveIndex) { return Membership::Unknown; }, result);
  return result;
}

std::optional<Constant> constant_of(const PrunedTree& tree) {
  if (tree.is_empty()) return Constant::Empty;
  if (tree.is_full()) return Constant::Full;
  return std::nullopt;
}

bool absorbs(Constant constant, BooleanOperator operation) {
  return csg::absorbs(constant == Constant::Full ? Membership::In : Membership::Out, operation);
}

std::optional<Vertex> point_in(const Geometry& geometry, const Cell& cell, double fraction) {
  std::array<double, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place[axis] =
        round_wall_position(cell.lower[axis] + fraction * (cell.upper[axis] - cell.lower[axis]));
    if (!(cell.lower[axis] < place[axis] && place[axis] < cell.upper[axis])) return std::nullopt;
  }
  return between_walls(geometry, place);
}

// A point of a cell against the primitives that have facets there.
class PointInCell {
 public:
  PointInCell(const WorkingScene& working, const CellTask& task, TierStatistics& statistics)
      : scene_(working.scene), tree_(task.tree), statistics_(statistics) {
    working.solver.decomposition().collect_facets(task, facets_);
  }

  // Nothing if the point lies in the plane of a facet.
  std::optional<Membership> operator()(const Vertex& point) {
    std::vector<std::pair<PrimitiveIndex, Membership>> known;
    for (std::size_t begin = 0; begin < facets_.size();) {
      const PrimitiveIndex primitive = facets_[begin].primitive;
      std::size_t end = begin;
      while (end < facets_.size() && facets_[end].primitive == primitive) ++end;
      const std::optional<Membership> found =
          in_primitive(point, std::span(facets_).subspan(begin, end - begin));
      if (!found) return std::nullopt;
      known.push_back({primitive, *found});
      begin = end;
    }
    return csg::membership_of(tree_, [&](PrimitiveIndex primitive) {
      const auto place = std::find_if(known.begin(), known.end(),
                                      [&](const auto& entry) { return entry.first == primitive; });
      return place == known.end() ? Membership::Unknown : place->second;
    });
  }

 private:
  std::optional<Membership> in_primitive(const Vertex& point, std::span<const CellFacet> facets) {
    bool inside_all = true;
    std::vector<FacetPolygon> polygons;
    for (const CellFacet& facet : facets) {
      const OrientedPlaneRef plane = facet.polygon.plane;
      const Sign side = scene_.geometry.side(point, plane.plane, statistics_);
      if (side == Sign::Zero) return std::nullopt;
      inside_all &= side * sign_of(static_cast<int>(plane.sense)) == Sign::Negative;
      polygons.push_back(facet.polygon);
    }
    if (scene_.primitives[facets.front().primitive].convex) {
      return inside_all ? Membership::In : Membership::Out;
    }
    return mesh_membership(scene_.geometry, point, polygons, statistics_);
  }

  const Scene& scene_;
  const PrunedTree& tree_;
  TierStatistics& statistics_;
  std::vector<CellFacet> facets_;  // of one primitive in succession
};

void drop_facets(CellTask& task) {
  give_up(task.primitives);
  give_up(task.whole);
  give_up(task.sliced);
  give_up(task.clipped);
  give_up(task.corners);
  task.facet_count = 0;
}

// A cell without boundary is Full or Empty: it can forget its facets.
void forget(const WorkingScene& working, CellTask& task, TierStatistics& statistics) {
  PointInCell membership_at(working, task, statistics);
  for (const double fraction : {0.5, 0.4140625, 0.6171875, 0.2734375}) {
    const std::optional<Vertex> point = point_in(working.scene.geometry, task.cell, fraction);
    if (!point) continue;
    const std::optional<Membership> found = membership_at(*point);
    if (!found || *found == Membership::Unknown) continue;
    task.tree = constant_tree(*found == Membership::In ? Constant::Full : Constant::Empty);
    drop_facets(task);
    return;
  }
}

// The facets of another task of the same cell, which is of one primitive, unless they are there.
void add_facets(CellTask& task, const CellTask& added) {
  PrimitiveFacets facets = added.primitives.front();
  const auto is_there = [&](const PrimitiveFacets& present) {
    return present.primitive == facets.primitive;
  };
  if (std::any_of(task.primitives.begin(), task.primitives.end(), is_there)) return;
  facets.first_whole = static_cast<std::uint32_t>(task.whole.size());
  facets.first_sliced = static_cast<std::uint32_t>(task.sliced.size());
  facets.first_clipped = static_cast<std::uint32_t>(task.clipped.size());
  task.primitives.push_back(facets);
  task.whole.insert(task.whole.end(), added.whole.begin(), added.whole.end());
  task.sliced.insert(task.sliced.end(), added.sliced.begin(), added.sliced.end());
  for (ClippedFacet facet : added.clipped) {
    facet.first_corner += static_cast<std::uint32_t>(task.corners.size());
    task.clipped.push_back(facet);
  }
  task.corners.insert(task.corners.end(), added.corners.begin(), added.corners.end());
  task.facet_count += added.facet_count;
}

DoubleBox box_of(const Cell& cell) { return {cell.lower, cell.upper}; }

}  // namespace

// A subtree that is not yet in its place.
struct CellTree::Built {
  std::optional<Division> division;  // unless a leaf
  std::array<Cell, 2> cells;         // of the children
  std::vector<Built> children;
  std::shared_ptr<const Leaf> leaf;
  UpdateStatistics update;
};

class CellTree::Builder {
 public:
  explicit Builder(const WorkingScene& working, Progress* progress)
      : working_(working), progress_(progress) {}

  std::vector<EvaluationTask> divide(EvaluationTask& task) const {
    std::vector<EvaluationTask> children = working_.solver.divide(task);
    // What is not needed to combine.
    drop_facets(task.cell);
    return children;
  }

  Built solve(EvaluationTask& task) const {
    if (progress_ != nullptr) progress_->advance(task.cell.facet_count);
    Built built;
    built.update.tiers = std::exchange(task.cell.statistics, {});
    built.update.renewed_cells = 1;
    auto leaf = std::make_shared<Leaf>();
    leaf->task = std::move(task.cell);
    CellSolver::Solution solution = working_.solver.solve(leaf->task, built.update.tiers);
    if (solution.was_classified) built.update.evaluated_cells = 1;
    leaf->pieces = std::move(solution.pieces);
    if (leaf->pieces.pieces.empty() && leaf->task.facet_count != 0) {
      forget(working_, leaf->task, built.update.tiers);
    }
    built.leaf = std::move(leaf);
    return built;
  }

  static Built combine(std::span<Built> results, const EvaluationTask& task) {
    Built built;
    built.division = task.division;
    built.cells.fill(task.cell.cell);
    const auto axis = static_cast<std::size_t>(task.division->axis);
    built.cells[0].upper[axis] = task.division->position;
    built.cells[1].lower[axis] = task.division->position;
    for (Built& result : results) {
      add(result.update, built.update);
      built.children.push_back(std::move(result));
    }
    return built;
  }

  static void add(const UpdateStatistics& part, UpdateStatistics& sum) {
    sum.tiers += part.tiers;
    sum.renewed_cells += part.renewed_cells;
    sum.evaluated_cells += part.evaluated_cells;
  }

 private:
  const WorkingScene& working_;
  Progress* progress_;
};

void CellTree::begin(const WorkingScene& working, const PrunedTree& tree,
                     UpdateStatistics& update) {
  nodes_.clear();
  free_.clear();
  nodes_.push_back({working.scene.root, {}, none, none, nullptr});
  PrunedTree simple;
  csg::prune_into(
      tree, [](PrimitiveIndex) { return Membership::Unknown; }, simple);
  establish(working, 0, working.solver.decomposition().task_of(working.scene.root, simple), update);
}

void CellTree::establish(const WorkingScene& working, NodeNumber node, CellTask task,
                         UpdateStatistics& update) {
  const Builder builder(working, options_.progress);
  const bool is_large = task.facet_count >= facets_for_threads;
  EvaluationTask first = working.solver.prepared(std::move(task));
  const auto with = [&](const auto& executor) {
    return skeleton::divacon(
        std::move(first), [](const EvaluationTask& part) { return !part.division; },
        [&](EvaluationTask& part) { return builder.divide(part); },
        [&](EvaluationTask&& part) { return builder.solve(part); },
        [](std::span<Built> results, const EvaluationTask& part) {
          return Builder::combine(results, part);
        },
        executor);
  };
  const auto build = [&] {
    if (!first.division) return builder.solve(first);
    if (!is_large || options_.threads == 1) return with(skeleton::SequentialExecutor{});
    return with(skeleton::ParallelExecutor<>(options_.threads));
  };
  Built built = build();
  Builder::add(built.update, update);
  collapse(node);
  place(node, std::move(built));
  renewed_.push_back(node);
}

CellTree::NodeNumber CellTree::add_children(NodeNumber parent) {
  NodeNumber first = none;
  if (!free_.empty()) {
    first = free_.back();
    free_.pop_back();
  } else {
    if (nodes_.size() + 2 >= none) throw Error(ErrorId::TooLarge, {"2^32 cells", "fewer"});
    first = static_cast<NodeNumber>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
  }
  nodes_[parent].children = first;
  nodes_[first] = nodes_[first + 1] = {{}, {}, parent, none, nullptr};
  return first;
}

void CellTree::place(NodeNumber node, Built built) {
  std::vector<std::pair<NodeNumber, Built>> pending;
  pending.push_back({node, std::move(built)});
  while (!pending.empty()) {
    auto [at, part] = std::move(pending.back());
    pending.pop_back();
    nodes_[at].leaf = std::move(part.leaf);
    if (!part.division) continue;
    nodes_[at].division = *part.division;
    const NodeNumber first = add_children(at);
    for (std::uint32_t i = 0; i < 2; ++i) {
      nodes_[first + i].cell = part.cells[i];
      pending.push_back({first + i, std::move(part.children[i])});
    }
  }
}

// Makes it a leaf of which nothing is known.
void CellTree::collapse(NodeNumber node) {
  std::vector<NodeNumber> pending{node};
  while (!pending.empty()) {
    Node& at = nodes_[pending.back()];
    pending.pop_back();
    at.leaf = nullptr;
    if (at.children == none) continue;
    pending.push_back(at.children);
    pending.push_back(at.children + 1);
    nodes_[at.children].parent = nodes_[at.children + 1].parent = none;
    free_.push_back(std::exchange(at.children, none));
  }
}

std::optional<Constant> CellTree::constant_at(NodeNumber node) const {
  if (!is_leaf(node)) return std::nullopt;
  return constant_of(nodes_[node].leaf->task.tree);
}

// Neighbours that have become the same constant need no wall between them.
void CellTree::join_constant_leaves() {
  for (NodeNumber at : renewed_) {
    for (NodeNumber parent = nodes_[at].parent; parent != none; parent = nodes_[at].parent) {
      const NodeNumber first = nodes_[parent].children;
      const std::optional<Constant> constant = constant_at(first);
      if (!constant || constant != constant_at(first + 1)) break;
      make_constant(parent, *constant);
      at = parent;
    }
  }
  renewed_.clear();
}

// ---- operations at the root -------------------------------------------------------------------

std::vector<CellTree::NodeNumber> CellTree::apply(const WorkingScene& working,
                                                  BooleanOperator operation,
                                                  PrimitiveIndex primitive,
                                                  UpdateStatistics& update) {
  const Decomposition& decomposition = working.solver.decomposition();
  struct Pending {
    NodeNumber node;
    CellTask operand;
  };
  std::vector<NodeNumber> conflicts;
  std::vector<Pending> pending;
  pending.push_back({0, decomposition.task_of(nodes_[0].cell, primitive_tree(primitive))});
  while (!pending.empty()) {
    auto [node, operand] = std::move(pending.back());
    pending.pop_back();
    if (const std::optional<Constant> constant = constant_of(operand.tree)) {
      apply_constant(working, node, operation, *constant, update);
    } else if (is_leaf(node)) {
      apply_to_leaf(working, node, operation, primitive, operand, update);
    } else if (decomposition.has_facet_in_wall(operand, nodes_[node].division)) {
      conflicts.push_back(node);
    } else {
      std::vector<CellTask> parts = decomposition.divide(operand, nodes_[node].division);
      const NodeNumber first = nodes_[node].children;
      for (std::uint32_t i = 0; i < 2; ++i) pending.push_back({first + i, std::move(parts[i])});
    }
  }
  join_constant_leaves();
  return conflicts;
}

void CellTree::apply_constant(const WorkingScene& working, NodeNumber node,
                              BooleanOperator operation, Constant operand,
                              UpdateStatistics& update) {
  switch (csg::react(operation, csg::Position::Later, operand)) {
    case csg::Reaction::BecomeEmpty:
      return set_constant(node, Constant::Empty, update);
    case csg::Reaction::BecomeFull:
      return set_constant(node, Constant::Full, update);
    case csg::Reaction::Complement:
      return complement(working, node, update);
    default:
      return;
  }
}

void CellTree::set_constant(NodeNumber node, Constant constant, UpdateStatistics& update) {
  if (constant_at(node) == constant) return;
  make_constant(node, constant);
  renewed_.push_back(node);
  ++update.renewed_cells;
}

void CellTree::make_constant(NodeNumber node, Constant constant) {
  collapse(node);
  auto leaf = std::make_shared<Leaf>();
  leaf->task.cell = nodes_[node].cell;
  leaf->task.tree = constant_tree(constant);
  nodes_[node].leaf = std::move(leaf);
}

template <class Visit>
void CellTree::for_each_leaf_below(NodeNumber node, Visit visit) const {
  std::vector<NodeNumber> pending{node};
  while (!pending.empty()) {
    const NodeNumber at = pending.back();
    pending.pop_back();
    if (is_leaf(at)) {
      visit(at);
      continue;
    }
    pending.push_back(nodes_[at].children);
    pending.push_back(nodes_[at].children + 1);
  }
}

void CellTree::complement(const WorkingScene& working, NodeNumber node, UpdateStatistics& update) {
  std::vector<NodeNumber> leaves;
  for_each_leaf_below(node, [&](NodeNumber leaf) { leaves.push_back(leaf); });
  for (const NodeNumber leaf : leaves) {
    CellTask task = nodes_[leaf].leaf->task;
    task.tree =
        combined(task.tree, BooleanOperator::SymmetricDifference, constant_tree(Constant::Full));
    establish(working, leaf, std::move(task), update);
  }
}

void CellTree::apply_to_leaf(const WorkingScene& working, NodeNumber node,
                             BooleanOperator operation, PrimitiveIndex primitive,
                             const CellTask& operand, UpdateStatistics& update) {
  const CellTask& present = nodes_[node].leaf->task;
  const std::optional<Constant> constant = constant_of(present.tree);
  if (constant && absorbs(*constant, operation)) return;
  CellTask task = present;
  task.statistics = operand.statistics;
  add_facets(task, operand);
  task.tree = combined(task.tree, operation, primitive_tree(primitive));
  establish(working, node, std::move(task), update);
}

// ---- changes anywhere in the tree -------------------------------------------------------------

std::vector<CellTree::NodeNumber> CellTree::leaves_touched(std::span<const DoubleBox> boxes) const {
  std::vector<NodeNumber> result;
  std::vector<NodeNumber> pending{0};
  while (!pending.empty()) {
    const NodeNumber node = pending.back();
    pending.pop_back();
    const DoubleBox cell = box_of(nodes_[node].cell);
    if (std::none_of(boxes.begin(), boxes.end(),
                     [&](const DoubleBox& box) { return meet(box, cell); })) {
      continue;
    }
    if (is_leaf(node)) {
      result.push_back(node);
      continue;
    }
    pending.push_back(nodes_[node].children);
    pending.push_back(nodes_[node].children + 1);
  }
  return result;
}

void CellTree::rebuild(const WorkingScene& working, const PrunedTree& tree,
                       std::vector<NodeNumber> nodes, UpdateStatistics& update) {
  while (!nodes.empty()) nodes = rebuild_once(working, tree, nodes, update);
  join_constant_leaves();
}

// Returns nodes above some of the given that must be rebuilt instead of these.
std::vector<CellTree::NodeNumber> CellTree::rebuild_once(const WorkingScene& working,
                                                         const PrunedTree& tree,
                                                         std::span<const NodeNumber> nodes,
                                                         UpdateStatistics& update) {
  enum class Mark : unsigned char { Untouched, Above, Wanted };
  std::vector<Mark> marks(nodes_.size(), Mark::Untouched);
  DoubleBox reach = box_of(nodes_[nodes.front()].cell);
  for (const NodeNumber node : nodes) {
    reach = join(reach, box_of(nodes_[node].cell));
    NodeNumber at = nodes_[node].parent;
    for (; at != none && marks[at] == Mark::Untouched; at = nodes_[at].parent) {
      marks[at] = Mark::Above;
    }
    marks[node] = Mark::Wanted;
  }
  // Bounded primitives that do not come near are Empty in all of these cells.
  const auto near = [&](PrimitiveIndex primitive) {
    return meet(working.boxes[primitive], reach) ? Membership::Unknown : Membership::Out;
  };
  PrunedTree pruned;
  csg::prune_into(tree, near, pruned);

  const Decomposition& decomposition = working.solver.decomposition();
  std::vector<NodeNumber> conflicts;
  std::vector<std::pair<NodeNumber, CellTask>> pending;
  pending.push_back({0, decomposition.task_of(nodes_[0].cell, pruned)});
  while (!pending.empty()) {
    auto [node, task] = std::move(pending.back());
    pending.pop_back();
    if (marks[node] == Mark::Wanted) {
      // Else every change would divide anew what cannot be separated.
      task.stalled = is_leaf(node) ? nodes_[node].leaf->task.stalled : 0;
      establish(working, node, std::move(task), update);
    } else if (decomposition.has_facet_in_wall(task, nodes_[node].division)) {
      // Of a primitive that did not count when the cell was divided.
      conflicts.push_back(node);
    } else {
      std::vector<CellTask> parts = decomposition.divide(task, nodes_[node].division);
      const NodeNumber first = nodes_[node].children;
      for (std::uint32_t i = 0; i < 2; ++i) {
        if (marks[first + i] == Mark::Untouched) continue;
        pending.push_back({first + i, std::move(parts[i])});
      }
    }
  }
  return conflicts;
}

}  // namespace exactcsg
