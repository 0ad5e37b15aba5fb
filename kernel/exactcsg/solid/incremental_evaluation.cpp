// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/incremental_evaluation.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/solid/canonical_boundary.hpp"
#include "exactcsg/solid/cell_tree.hpp"
#include "exactcsg/solid/growing_scene.hpp"
#include "exactcsg/solid/whole_facets.hpp"

namespace exactcsg {

using csg::BooleanOperator;

namespace {

using OccurrenceTree = csg::FlatTree<std::uint32_t, BooleanOperator>;

// More primitives than that which are no longer in the tree, and as many again as are: too many.
constexpr std::size_t dead_primitives_borne = 64;

struct OccurrenceRecord {
  Primitive primitive;
  PrimitiveIndex index = 0;
};

// Operators applied one after another at the root, equal ones in succession: one node's.
struct Run {
  BooleanOperator operation;
  std::size_t begin;
  std::size_t end;
};

std::vector<Run> runs_of(const std::vector<BooleanOperator>& operations) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < operations.size(); ++i) {
    if (runs.empty() || runs.back().operation != operations[i]) {
      runs.push_back({operations[i], i, i});
    }
    runs.back().end = i + 1;
  }
  return runs;
}

bool contains_full(const OccurrenceTree& tree) {
  auto node = tree.root();
  const auto end = node.next_sibling();
  for (; !(node == end); node = node.first_child()) {
    if (node.kind() == csg::NodeKind::Full) return true;
  }
  return false;
}

}  // namespace

class IncrementalEvaluation::State {
 public:
  State(const Solid& solid, const EvaluateOptions& options)
      : options_(options), scene_(options), cells_(options) {
    std::uint32_t count = 0;
    first_tree_ = csg::flatten(solid, [&](const Primitive& primitive) {
      occurrences_.push_back({primitive, 0});
      return count++;
    });
    first_count_ = count;
    contains_full_ = contains_full(first_tree_);
    begin_progress("prepare", 0);
    scene_.restart(primitives_in_use());
    UpdateStatistics update;
    evaluate_everything(update);
  }

  void announce(std::span<const Primitive> primitives) {
    const bool fits = scene_.add(primitives);
    announced_.insert(announced_.end(), primitives.begin(), primitives.end());
    if (fits) return;
    is_stale_ = true;
    needs_restart_ = true;
  }

  UpdateStatistics replace(Occurrence occurrence, const Primitive& primitive) {
    OccurrenceRecord& record = occurrences_[checked(occurrence)];
    const bool fits = scene_.add({&primitive, 1});
    const PrimitiveIndex before = record.index;
    record = {primitive, *scene_.find(primitive)};
    if (fits && !is_stale_ && before == record.index) return finished({});
    tree_is_known_ = false;
    if (!may_go_on(fits)) return everything_anew();
    is_stale_ = true;
    UpdateStatistics update;
    const WorkingScene& working = scene_.now();
    const std::array<DoubleBox, 2> boxes{working.boxes[before], working.boxes[record.index]};
    cells_.rebuild(working, tree(), cells_.leaves_touched(boxes), update);
    is_stale_ = false;
    return finished(update);
  }

  UpdateStatistics apply(BooleanOperator operation, const Primitive& primitive) {
    if (occurrences_.size() >= 0xffffffffU) throw Error(ErrorId::TooLarge, {"2^32 primitives", ""});
    const bool fits = scene_.add({&primitive, 1});
    occurrences_.push_back({primitive, *scene_.find(primitive)});
    applied_.push_back(operation);
    tree_is_known_ = false;
    if (!may_go_on(fits)) return everything_anew();
    is_stale_ = true;
    UpdateStatistics update;
    const WorkingScene& working = scene_.now();
    std::vector<CellTree::NodeNumber> left =
        cells_.apply(working, operation, occurrences_.back().index, update);
    if (!left.empty()) cells_.rebuild(working, tree(), std::move(left), update);
    is_stale_ = false;
    return finished(update);
  }

  std::uint32_t occurrence_count() const { return static_cast<std::uint32_t>(occurrences_.size()); }

  const Primitive& primitive(Occurrence occurrence) const {
    return occurrences_[checked(occurrence)].primitive;
  }

  std::vector<Occurrence> occurrences_of(const Primitive& primitive) const {
    std::vector<Occurrence> result;
    const std::optional<PrimitiveIndex> index = scene_.find(primitive);
    for (std::uint32_t i = 0; index && i < occurrence_count(); ++i) {
      if (occurrences_[i].index == *index) result.push_back(Occurrence{i});
    }
    return result;
  }

  Solid solid() const;
  Boundary boundary();

 private:
  std::size_t checked(Occurrence occurrence) const {
    const auto i = static_cast<std::size_t>(occurrence);
    if (i < occurrences_.size()) return i;
    throw Error(ErrorId::BadArgument, {"occurrence " + std::to_string(i),
                                       "one below " + std::to_string(occurrences_.size())});
  }

  void begin_progress(const char* phase, std::size_t total) const {
    if (options_.progress != nullptr) options_.progress->begin(phase, total);
  }

  UpdateStatistics finished(UpdateStatistics update) {
    update.cells = cells_.leaf_count();
    last_ = update;
    return update;
  }

  std::vector<Primitive> primitives_in_use() const {
    std::vector<Primitive> result = announced_;
    for (const OccurrenceRecord& record : occurrences_) result.push_back(record.primitive);
    return result;
  }

  std::size_t count_in_use() const {
    std::vector<bool> used(scene_.size(), false);
    for (const OccurrenceRecord& record : occurrences_) used[record.index] = true;
    for (const Primitive& primitive : announced_) used[*scene_.find(primitive)] = true;
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  }

  // Whether the cells that there are can be changed; otherwise all must be made anew.
  bool may_go_on(bool fits) {
    if (!fits) needs_restart_ = true;
    return !is_stale_ && !needs_restart_ && !too_many_dead();
  }

  bool too_many_dead() {
    // Counted now and then only: it takes a look at all occurrences.
    if (scene_.size() <= next_count_) return false;
    const std::size_t in_use = count_in_use();
    next_count_ = 2 * in_use + dead_primitives_borne;
    if (scene_.size() <= next_count_) return false;
    needs_restart_ = true;
    return true;
  }

  UpdateStatistics everything_anew() {
    UpdateStatistics update;
    evaluate_everything(update);
    return finished(update);
  }

  void evaluate_everything(UpdateStatistics& update) {
    is_stale_ = true;
    if (needs_restart_) scene_.restart(primitives_in_use());
    needs_restart_ = false;
    for (OccurrenceRecord& record : occurrences_) record.index = *scene_.find(record.primitive);
    tree_is_known_ = false;
    begin_progress("decompose", scene_.now().scene.facets.size());
    cells_.begin(scene_.now(), tree(), update);
    update.everything = true;
    is_stale_ = false;
    last_ = update;
  }

  std::vector<PieceBuffer> gathered_pieces() const;

  // The present tree over the scene's primitives.
  const PrunedTree& tree();

  EvaluateOptions options_;
  GrowingScene scene_;
  CellTree cells_;
  OccurrenceTree first_tree_;  // over the first occurrences
  std::size_t first_count_ = 0;
  bool contains_full_ = false;
  std::vector<OccurrenceRecord> occurrences_;
  std::vector<BooleanOperator> applied_;  // with the occurrences after the first
  std::vector<Primitive> announced_;
  PrunedTree tree_;
  bool tree_is_known_ = false;
  bool is_stale_ = true;        // the cells are not those of the present tree
  bool needs_restart_ = false;  // nor does the scene fit
  std::size_t next_count_ = dead_primitives_borne;
  UpdateStatistics last_;
};

const PrunedTree& IncrementalEvaluation::State::tree() {
  if (tree_is_known_) return tree_;
  tree_.clear();
  const std::vector<Run> runs = runs_of(applied_);
  std::vector<PrunedTree::OpenNode> open;
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    open.push_back(tree_.open(run->operation));
  }
  const auto close = [&] {
    tree_.close(open.back());
    open.pop_back();
  };
  csg::walk(
      first_tree_.root(),
      [&](auto node) {
        open.push_back(tree_.open(node.operation()));
        return true;
      },
      [&](auto node) {
        if (node.kind() == csg::NodeKind::Primitive) {
          tree_.append_primitive(occurrences_[node.primitive()].index);
        } else if (node.kind() == csg::NodeKind::Full) {
          tree_.append_full();
        } else {
          tree_.append_empty();
        }
      },
      [&](auto) { close(); });
  for (const Run& run : runs) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      tree_.append_primitive(occurrences_[first_count_ + i].index);
    }
    close();
  }
  tree_is_known_ = true;
  return tree_;
}

Solid IncrementalEvaluation::State::solid() const {
  std::vector<Solid> results;
  std::vector<std::size_t> begins;
  const auto compose = [&](BooleanOperator operation, std::size_t begin) {
    const auto first = results.begin() + static_cast<std::ptrdiff_t>(begin);
    Solid composed = Solid::compose_from(operation, std::span(first, results.end()));
    results.erase(first, results.end());
    results.push_back(std::move(composed));
  };
  csg::walk(
      first_tree_.root(),
      [&](auto) {
        begins.push_back(results.size());
        return true;
      },
      [&](auto node) {
        if (node.kind() == csg::NodeKind::Primitive) {
          results.push_back(Solid::primitive(occurrences_[node.primitive()].primitive));
        } else {
          results.push_back(node.kind() == csg::NodeKind::Full ? Solid::full() : Solid::empty());
        }
      },
      [&](auto node) {
        compose(node.operation(), begins.back());
        begins.pop_back();
      });
  for (const Run& run : runs_of(applied_)) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
      results.push_back(Solid::primitive(occurrences_[first_count_ + i].primitive));
    }
    compose(run.operation, 0);
  }
  return std::move(results.back());
}

// Copies: merging makes whole facets of those of which all parts are there.
std::vector<PieceBuffer> IncrementalEvaluation::State::gathered_pieces() const {
  std::vector<PieceBuffer> buffers(1);
  cells_.for_each_leaf([&](const CellTree::Leaf& leaf) { append(leaf.pieces, buffers.front()); });
  return buffers;
}

Boundary IncrementalEvaluation::State::boundary() {
  if (is_stale_) everything_anew();
  const WorkingScene& working = scene_.now();
  std::vector<PieceBuffer> buffers = gathered_pieces();
  // Sets made of bounded ones are bounded.
  if (contains_full_ || working.has_half_spaces) {
    require_bounded(solid(), working.scene, buffers, options_.threads);
  }
  restore_whole_facets(working.scene, buffers, options_.threads);
  begin_progress("merge", 0);
  Boundary boundary =
      merge_pieces(working.scene, std::move(buffers), options_.threads, options_.progress);
  boundary.statistics.tiers += last_.tiers;
  boundary.statistics.primitives = scene_.size();
  boundary.statistics.facets = working.scene.facets.size();
  boundary.statistics.cells = last_.cells;
  boundary.statistics.evaluated_cells = last_.evaluated_cells;
  return boundary;
}

IncrementalEvaluation::IncrementalEvaluation(const Solid& solid, const EvaluateOptions& options)
    : state_(std::make_unique<State>(solid, options)) {}
IncrementalEvaluation::IncrementalEvaluation(const IncrementalEvaluation& other)
    : state_(std::make_unique<State>(*other.state_)) {}
IncrementalEvaluation::IncrementalEvaluation(IncrementalEvaluation&& other) noexcept = default;
IncrementalEvaluation& IncrementalEvaluation::operator=(IncrementalEvaluation other) noexcept {
  state_ = std::move(other.state_);
  return *this;
}
IncrementalEvaluation::~IncrementalEvaluation() = default;

void IncrementalEvaluation::announce(std::span<const Primitive> primitives) {
  state_->announce(primitives);
}
UpdateStatistics IncrementalEvaluation::replace(Occurrence occurrence, const Primitive& primitive) {
  return state_->replace(occurrence, primitive);
}
UpdateStatistics IncrementalEvaluation::apply(BooleanOperator operation,
                                              const Primitive& primitive) {
  return state_->apply(operation, primitive);
}
UpdateStatistics IncrementalEvaluation::unite(const Primitive& primitive) {
  return apply(BooleanOperator::Union, primitive);
}
UpdateStatistics IncrementalEvaluation::subtract(const Primitive& primitive) {
  return apply(BooleanOperator::Difference, primitive);
}
UpdateStatistics IncrementalEvaluation::intersect(const Primitive& primitive) {
  return apply(BooleanOperator::Intersection, primitive);
}

std::uint32_t IncrementalEvaluation::occurrence_count() const { return state_->occurrence_count(); }
Occurrence IncrementalEvaluation::last_occurrence() const {
  return Occurrence{occurrence_count() - 1};
}
const Primitive& IncrementalEvaluation::primitive(Occurrence occurrence) const {
  return state_->primitive(occurrence);
}
std::vector<Occurrence> IncrementalEvaluation::occurrences_of(const Primitive& primitive) const {
  return state_->occurrences_of(primitive);
}
Solid IncrementalEvaluation::solid() const { return state_->solid(); }
Boundary IncrementalEvaluation::boundary() { return state_->boundary(); }

}  // namespace exactcsg
