// SPDX-License-Identifier: Apache-2.0
#pragma once

// All pairs of boxes that meet, by a hierarchy of bounding boxes. [Exact on the doubles given]
//
// The boxes are sorted by the places of their centres along Hilbert's curve, in which what is near
// in space is mostly near in the order. Of the hierarchy nothing but its boxes is stored: a leaf is
// a few boxes in a row, and every other node is two nodes in a row.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace exactcsg {

struct DoubleBox {
  std::array<double, 3> lower;
  std::array<double, 3> upper;

  // Closed boxes: touching is meeting.
  friend bool meet(const DoubleBox& a, const DoubleBox& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (a.lower[i] > b.upper[i] || b.lower[i] > a.upper[i]) return false;
    }
    return true;
  }
  friend DoubleBox join(const DoubleBox& a, const DoubleBox& b) {
    DoubleBox c = a;
    for (std::size_t i = 0; i < 3; ++i) {
      c.lower[i] = std::min(a.lower[i], b.lower[i]);
      c.upper[i] = std::max(a.upper[i], b.upper[i]);
    }
    return c;
  }
};

// The numbers of the boxes in the order of Hilbert's curve through their centres. Bounds may be
// infinite; boxes without a finite centre come last. COST: O(n) if the centres are spread over
// about a thousandth of their extent, and as much again for each thousandth part in which many lie
std::vector<std::uint32_t> order_along_curve(std::span<const DoubleBox> boxes);

class BoxHierarchy {
 public:
  // The boxes are copied. COST: that of order_along_curve
  explicit BoxHierarchy(std::span<const DoubleBox> boxes) : BoxHierarchy(boxes, {}) {}

  // Only pairs of boxes of different groups are wanted. REQUIRES a group for each box, none of them
  // 2^32 - 1; or none at all: every box is a group of its own
  BoxHierarchy(std::span<const DoubleBox> boxes, std::span<const std::uint32_t> groups);

  // visit(i, j) once for each pair of different boxes that meet and are wanted, in an order that
  // depends on the boxes alone.
  // COST: expected O((n + pairs) log n)
  template <class Visit>
  void for_each_pair(Visit visit) const {
    if (!boxes_.empty()) visit_pairs_within(top_level(), 0, visit);
  }

  // A share of the search for pairs: those within a node, or between two.
  struct Search {
    std::size_t level;
    std::size_t first;
    std::size_t second;
  };
  // Shares that several threads can search at once; they depend on the boxes alone.
  std::vector<Search> searches() const;
  // LAW box_pairs.1  for_each_pair visits every pair in one of the searches.
  template <class Visit>
  void for_each_pair(const Search& search, Visit visit) const {
    if (search.first == search.second) {
      visit_pairs_within(search.level, search.first, visit);
    } else {
      visit_pairs_between(search.level, search.first, search.second, visit);
    }
  }

  // visit(i) for each box that meets the query.
  template <class Visit>
  void for_each_meeting(const DoubleBox& query, Visit visit) const {
    if (!boxes_.empty() && meet(nodes_.back(), query)) {
      visit_meeting(top_level(), 0, query, visit);
    }
  }

 private:
  static constexpr std::size_t leaf_size = 4;
  static constexpr std::uint32_t several_groups = std::numeric_limits<std::uint32_t>::max();

  // Node i of a level has the nodes 2 i and 2 i + 1 of the level below, the last one perhaps only
  // the first of them; leaf i has the boxes leaf_size * i and so on. Level 0 is that of the leaves.
  std::size_t top_level() const { return level_begins_.size() - 2; }
  std::size_t level_size(std::size_t level) const {
    return level_begins_[level + 1] - level_begins_[level];
  }
  const DoubleBox* level_boxes(std::size_t level) const {
    return nodes_.data() + level_begins_[level];
  }
  std::uint32_t group_of(std::size_t level, std::size_t node) const {
    return node_groups_.empty() ? several_groups : node_groups_[level_begins_[level] + node];
  }
  std::size_t end_of_leaf(std::size_t leaf) const {
    return std::min(boxes_.size(), (leaf + 1) * leaf_size);
  }
  bool is_wanted(std::size_t i, std::size_t j) const {
    return groups_.empty() || groups_[i] != groups_[j];
  }

  // Down to nodes of the level `lowest`.
  void add_searches_within(std::size_t level, std::size_t node, std::size_t lowest,
                           std::vector<Search>& result) const;
  void add_searches_between(std::size_t level, std::size_t a, std::size_t b, std::size_t lowest,
                            std::vector<Search>& result) const;

  // Recursion is as deep as the logarithm of the number of boxes.
  template <class Visit>
  void visit_pairs_within(std::size_t level, std::size_t node, Visit& visit) const {
    if (group_of(level, node) != several_groups) return;
    if (level == 0) {
      const std::size_t end = end_of_leaf(node);
      for (std::size_t i = node * leaf_size; i < end; ++i) {
        for (std::size_t j = i + 1; j < end; ++j) {
          if (meet(boxes_[i], boxes_[j]) && is_wanted(i, j)) visit(order_[i], order_[j]);
        }
      }
      return;
    }
    const std::size_t first = 2 * node;
    visit_pairs_within(level - 1, first, visit);
    if (first + 1 == level_size(level - 1)) return;
    visit_pairs_within(level - 1, first + 1, visit);
    const DoubleBox* boxes = level_boxes(level - 1);
    if (meet(boxes[first], boxes[first + 1])) {
      visit_pairs_between(level - 1, first, first + 1, visit);
    }
  }

  // REQUIRES a < b and nodes that meet
  template <class Visit>
  void visit_pairs_between(std::size_t level, std::size_t a, std::size_t b, Visit& visit) const {
    const std::uint32_t group = group_of(level, a);
    if (group != several_groups && group == group_of(level, b)) return;
    const DoubleBox& second = level_boxes(level)[b];
    if (level == 0) {
      const std::size_t end = end_of_leaf(b);
      for (std::size_t i = a * leaf_size; i < (a + 1) * leaf_size; ++i) {
        if (!meet(boxes_[i], second)) continue;
        for (std::size_t j = b * leaf_size; j < end; ++j) {
          if (meet(boxes_[i], boxes_[j]) && is_wanted(i, j)) visit(order_[i], order_[j]);
        }
      }
      return;
    }
    const DoubleBox* boxes = level_boxes(level - 1);
    const std::size_t end = std::min(2 * b + 2, level_size(level - 1));
    for (std::size_t i = 2 * a; i < 2 * a + 2; ++i) {
      if (!meet(boxes[i], second)) continue;
      for (std::size_t j = 2 * b; j < end; ++j) {
        if (meet(boxes[i], boxes[j])) visit_pairs_between(level - 1, i, j, visit);
      }
    }
  }

  // REQUIRES a node that meets the query
  template <class Visit>
  void visit_meeting(std::size_t level, std::size_t node, const DoubleBox& query,
                     Visit& visit) const {
    if (level == 0) {
      for (std::size_t i = node * leaf_size; i < end_of_leaf(node); ++i) {
        if (meet(boxes_[i], query)) visit(order_[i]);
      }
      return;
    }
    const DoubleBox* boxes = level_boxes(level - 1);
    const std::size_t end = std::min(2 * node + 2, level_size(level - 1));
    for (std::size_t i = 2 * node; i < end; ++i) {
      if (meet(boxes[i], query)) visit_meeting(level - 1, i, query, visit);
    }
  }

  std::vector<std::uint32_t> order_;
  std::vector<DoubleBox> boxes_;            // in this order
  std::vector<std::uint32_t> groups_;       // in this order
  std::vector<DoubleBox> nodes_;            // level by level
  std::vector<std::uint32_t> node_groups_;  // the group of all boxes, or several_groups
  std::vector<std::size_t> level_begins_;
};

// Boxes in groups, of which only pairs of different groups are wanted.
class GroupedBoxes {
 public:
  // Group g is the boxes begins[g] ... begins[g + 1], the last one up to the end.
  // REQUIRES begins ascends from 0, if there are boxes
  GroupedBoxes(std::span<const DoubleBox> boxes, std::span<const std::uint32_t> begins)
      : hierarchy_(boxes, groups_of(boxes.size(), begins)) {}

  // visit(i, j) once for each pair of boxes of different groups that meet.
  template <class Visit>
  void for_each_pair(Visit visit) const {
    hierarchy_.for_each_pair(visit);
  }

  const BoxHierarchy& hierarchy() const { return hierarchy_; }

 private:
  static std::vector<std::uint32_t> groups_of(std::size_t count,
                                              std::span<const std::uint32_t> begins);

  BoxHierarchy hierarchy_;
};

}  // namespace exactcsg
