// SPDX-License-Identifier: Apache-2.0
#pragma once

// The volume of a set inside a box, between two bounds that are proved. [Certified]
//
//   volume(tree, box, limits) -> CertifiedMeasure
//
// LAW certified_measure.1  the volume of the tree's set inside the box lies in value.
// LAW certified_measure.2  stop says why the work ended; at Width, upper - lower is at most the
//                          absolute width asked for, or the relative one times lower.
// LAW certified_measure.3  without a deadline and a cancellation, the result depends on the
//                          arguments alone. Sets bounded by planes across the axes alone have
//                          lower == upper.
// REQUIRES the primitives model domain::Domain in space. Any are measured; those whose polynomial
// is known (half-spaces of quadrics and tori) are measured well:
// COST: the box is divided into cells, those first whose bounds are furthest apart; in each the
// tree is pruned. A cell in which every surface left is a graph over the same face becomes a
// column (column.hpp): only the face is divided further. There the width falls, in the number n of
// cells, as n^-4 where one surface is left or two cross, as n^-2 at worst. Other primitives:
// n^-1/2.
//
// Source: Davy and Dew, section 3.4 and 5.3 (the area of a set by division and pruning); bounds,
// columns and best-first order are ours.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "exactcsg/measure/local_region.hpp"
#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg::measure {

enum class StopReason : unsigned char { Width, Cells, Deadline, Cancelled, Precision };

struct MeasureLimits {
  // Either is enough; 0 is reached only where the result is exact.
  double absolute_width = 0;
  double relative_width = 1e-6;
  std::uint64_t cells = 20'000'000;
  std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt;
  // Cells are counted there, and the relative width reached is shown; a cancellation ends the work
  // with the bounds reached.
  Progress* progress = nullptr;
};

struct CertifiedMeasure {
  Enclosure value;
  StopReason stop = StopReason::Width;
  std::uint64_t cells = 0;
};

namespace detail {

// Sums of equal numbers of terms are added first: errors grow with the logarithm of the count.
class PairwiseSum {
 public:
  void add(CertifiedDouble term) {
    ++count_;
    for (std::uint64_t bits = count_; bits % 2 == 0; bits /= 2) {
      term = partial_.back() + term;
      partial_.pop_back();
    }
    partial_.push_back(term);
  }
  CertifiedDouble total() const {
    CertifiedDouble sum;
    for (auto term = partial_.rbegin(); term != partial_.rend(); ++term) sum = sum + *term;
    return sum;
  }

 private:
  std::vector<CertifiedDouble> partial_;
  std::uint64_t count_ = 0;
};

// The clock is asked once for so many cells.
constexpr std::uint64_t cells_per_look_at_clock = 64;

// The half lengths of a box along its axes from one on, in cyclic order.
inline std::array<CertifiedDouble, 3> half_lengths(const Box3& box, std::size_t first) {
  std::array<CertifiedDouble, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t axis = (first + i) % 3;
    result[i] = certified_double_of(Rational((box.upper()[axis] - box.lower()[axis]) / 2));
  }
  return result;
}

// A column and what is measured in it: a part of a cell, of which rectangles are divided.
template <class InColumn>
class MeasuredColumn {
 public:
  MeasuredColumn(Column column, InColumn measure)
      : column_(std::move(column)), measure_(std::move(measure)) {}

  CertifiedDouble of_any_part(const Rectangle& r) const { return measure_.of_any_part(column_, r); }
  CertifiedDouble operator()(const Rectangle& r) const { return measure_(column_, r); }

  // Along both sides, or along one if the heights hardly vary along the other.
  std::array<int, 2> parts(const Rectangle& r) const {
    constexpr double hardly = 0.25;
    const std::array<double, 2> variations = column_.variations(r);
    return {variations[0] < hardly * variations[1] ? 1 : 2,
            variations[1] < hardly * variations[0] ? 1 : 2};
  }

 private:
  Column column_;
  InColumn measure_;
};

// The one column that a cell is, or none.
template <class InColumn, SpatialDomain P, class MeasureIn>
std::vector<MeasuredColumn<InColumn>> measured_column(const SurfaceTable<P>& table,
                                                      const LiteralTree& tree, const Box3& box,
                                                      MeasureIn&& measure_in) {
  std::vector<MeasuredColumn<InColumn>> result;
  if (std::optional<Column> column = column_of(table, tree, box)) {
    InColumn measure = measure_in(*column);
    result.emplace_back(std::move(*column), std::move(measure));
  }
  return result;
}

// What IntegralMeter measures: the volume.
class VolumeMeasure {
 public:
  static constexpr bool is_never_negative = true;

  Rational in_full_cell(const Box3& box) const { return volume_of(box); }
  // Of any part of the cell.
  template <SpatialDomain P>
  CertifiedDouble in_mixed_cell(const SurfaceTable<P>&, const LiteralTree&, const Box3& box) const {
    return up_to(certified_double_of(volume_of(box)));
  }

  class InColumn {
   public:
    explicit InColumn(const Box3& box)
        : scale_(certified_double_of(Rational(volume_of(box) / 8))) {}
    // Of any part of what is over the rectangle.
    CertifiedDouble of_any_part(const Column&, const Rectangle& r) const {
      return up_to(exactly(2 * r.area()) * scale_);
    }
    CertifiedDouble operator()(const Column& column, const Rectangle& r) const {
      return column.volume(r) * scale_;
    }

   private:
    CertifiedDouble scale_;  // the volume of the cell over that of its own coordinates
  };
  using Part = MeasuredColumn<InColumn>;
  // The parts that a cell consists of, of which only rectangles need be divided; none if the cell
  // is to be divided itself.
  template <SpatialDomain P>
  std::vector<Part> parts(const SurfaceTable<P>& table, const LiteralTree& tree,
                          const Box3& box) const {
    return measured_column<InColumn>(table, tree, box,
                                     [&](const Column&) { return InColumn(box); });
  }
};

template <SpatialDomain P, class Measure>
class IntegralMeter {
 public:
  IntegralMeter(const csg::BooleanTree<P>& tree, const Box3& box, const MeasureLimits& limits,
                Measure measure = {})
      : limits_(limits),
        measure_(std::move(measure)),
        tree_(table_.add(tree)),
        memberships_(table_) {
    if (limits_.progress != nullptr) limits_.progress->begin("measure", limits_.cells);
    add_cell(box, tree_);
  }

  CertifiedMeasure run() {
    for (;;) {
      if (leaves_.empty()) settle_sums();
      if (width_ <= allowed_width() * (1 + 0x1p-30)) {
        CertifiedMeasure result = bounds(StopReason::Width);
        const Rational width = result.value.upper - result.value.lower;
        if (width <= rational_of(limits_.absolute_width) ||
            width <= rational_of(limits_.relative_width) * result.value.lower) {
          return result;
        }
        settle_sums();
        if (leaves_.empty()) return bounds(StopReason::Precision);
      }
      if (leaves_.empty()) return bounds(StopReason::Precision);
      if (cells_ >= limits_.cells) return bounds(StopReason::Cells);
      if (limits_.progress != nullptr && limits_.progress->cancelled()) {
        return bounds(StopReason::Cancelled);
      }
      if (cells_ / cells_per_look_at_clock != looked_at_clock_) {
        looked_at_clock_ = cells_ / cells_per_look_at_clock;
        show_width();
        if (limits_.deadline && std::chrono::steady_clock::now() >= *limits_.deadline) {
          return bounds(StopReason::Deadline);
        }
      }
      refine();
    }
  }

 private:
  using Part = typename Measure::Part;
  struct LocalCell {
    Box3 box;
    LiteralTree tree;
    AxisPlane cut;
  };
  struct Leaf {
    CertifiedDouble value;
    std::shared_ptr<const Part> part;
    std::shared_ptr<const LocalCell> cell;  // if there is no part
    Rectangle rectangle;
    friend bool operator<(const Leaf& a, const Leaf& b) { return a.value.error < b.value.error; }
  };

  double allowed_width() const {
    return std::max(limits_.absolute_width,
                    limits_.relative_width * (approximate_full_ + middle_ - width_ / 2));
  }

  void add_cell(const Box3& box, const LiteralTree& above) {
    count();
    memberships_.enter(box);
    LiteralTree tree = csg::prune(above, memberships_);
    if (tree.is_empty()) return;
    if (tree.is_full()) {
      const Rational value = measure_.in_full_cell(box);
      full_ += value;
      approximate_full_ += nearest_double(value);
      return;
    }
    const std::optional<AxisPlane> cut = axis_cut(table_, tree, box);
    if (!cut) {
      std::vector<Part> parts = measure_.parts(table_, tree, box);
      for (Part& part : parts) {
        add_rectangle(std::make_shared<const Part>(std::move(part)), Rectangle());
      }
      if (!parts.empty()) return;
    }
    DividingAxis axis(box);
    axis.add(table_, tree, box);
    push({measure_.in_mixed_cell(table_, tree, box), nullptr,
          std::make_shared<const LocalCell>(
              LocalCell{box, std::move(tree), cut ? *cut : axis.bisector(box)}),
          Rectangle()});
  }

  void add_rectangle(const std::shared_ptr<const Part>& part, const Rectangle& r) {
    count();
    const CertifiedDouble any = part->of_any_part(r);
    CertifiedDouble value = (*part)(r);
    if (!(value.error < any.error)) value = any;  // says nothing; or has overflown
    // Rounding is all that is left, or soon would be.
    constexpr double negligible = 0x1p-41;
    if (value.error <= negligible * any.error || r.a < 0x1p-40 || r.b < 0x1p-40) {
      settled_.add(value);
      width_ += 2 * value.error;
      middle_ += value.value;
    } else {
      push({value, part, nullptr, r});
    }
  }

  void push(Leaf leaf) {
    width_ += 2 * leaf.value.error;
    middle_ += leaf.value.value;
    leaves_.push(std::move(leaf));
  }

  void refine() {
    const Leaf leaf = leaves_.top();
    leaves_.pop();
    width_ -= 2 * leaf.value.error;
    middle_ -= leaf.value.value;
    if (leaf.part == nullptr) {
      const auto halves = divided(leaf.cell->box, leaf.cell->cut);
      add_cell(halves.first, leaf.cell->tree);
      add_cell(halves.second, leaf.cell->tree);
      return;
    }
    divide(leaf.part, leaf.rectangle);
  }

  void divide(const std::shared_ptr<const Part>& part, const Rectangle& r) {
    const std::array<int, 2> parts = part->parts(r);
    const double a = r.a / parts[0];
    const double b = r.b / parts[1];
    for (int i = 0; i < parts[0]; ++i) {
      for (int j = 0; j < parts[1]; ++j) {
        add_rectangle(part, {r.s - r.a + (2 * i + 1) * a, r.t - r.b + (2 * j + 1) * b, a, b});
      }
    }
  }

  CertifiedDouble sum_of_leaves() const {
    PairwiseSum sum = settled_;
    for (const Leaf& leaf : leaves_.items()) sum.add(leaf.value);
    return sum.total();
  }
  // The running sums have drifted.
  void settle_sums() {
    const CertifiedDouble sum = sum_of_leaves();
    width_ = 2 * sum.error;
    middle_ = sum.value;
  }
  CertifiedMeasure bounds(StopReason reason) const {
    const CertifiedDouble sum = sum_of_leaves();
    const Rational middle = full_ + rational_of(sum.value);
    const Rational error = rational_of(sum.error);
    const Rational lower = middle - error;
    return {{Measure::is_never_negative ? std::max(lower, full_) : lower, Rational(middle + error)},
            reason,
            cells_};
  }

  void show_width() const {
    const double lower = approximate_full_ + middle_ - width_ / 2;
    if (limits_.progress != nullptr && lower > 0) limits_.progress->narrow_to(width_ / lower);
  }
  void count() {
    ++cells_;
    if (limits_.progress != nullptr) limits_.progress->advance();
  }

  struct Leaves : std::priority_queue<Leaf> {
    const std::vector<Leaf>& items() const { return this->c; }
  };

  const MeasureLimits& limits_;
  const Measure measure_;
  SurfaceTable<P> table_;
  LiteralTree tree_;
  LocalMemberships<P> memberships_;
  Leaves leaves_;
  PairwiseSum settled_;  // the leaves that are not refined any more
  Rational full_;
  double approximate_full_ = 0;
  double width_ = 0;   // of all leaves, nearly
  double middle_ = 0;  // the sum of their middles, nearly
  std::uint64_t cells_ = 0;
  std::uint64_t looked_at_clock_ = 0;
};

}  // namespace detail

template <SpatialDomain P>
CertifiedMeasure volume(const csg::BooleanTree<P>& tree, const domain::Box<3>& box,
                        const MeasureLimits& limits = {}) {
  return detail::IntegralMeter<P, detail::VolumeMeasure>(tree, box, limits).run();
}

}  // namespace exactcsg::measure
