// SPDX-License-Identifier: Apache-2.0
#pragma once

// All pairs of boxes that meet, by a hierarchy of bounding boxes. [Exact on the doubles given]

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
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

class BoxHierarchy {
 public:
  // COST: O(n log n)
  explicit BoxHierarchy(std::span<const DoubleBox> boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!boxes.empty()) build(0, static_cast<std::uint32_t>(boxes.size()));
    ordered_.reserve(boxes.size());
    for (const std::uint32_t i : order_) ordered_.push_back(boxes[i]);
  }

  // visit(i, j) once for each pair of different boxes that meet.
  // COST: expected O((n + pairs) log n)
  template <class Visit>
  void for_each_pair(Visit visit) const {
    std::vector<std::array<std::uint32_t, 2>> stack;
    if (!nodes_.empty()) stack.push_back({0, 0});
    while (!stack.empty()) {
      const auto [a, b] = stack.back();
      stack.pop_back();
      if (a != b && !meet(nodes_[a].box, nodes_[b].box)) continue;
      const Node& m = nodes_[a];
      const Node& n = nodes_[b];
      if (m.second == 0 && n.second == 0) {
        visit_leaves(m, n, a == b, visit);
      } else if (a == b) {
        stack.push_back({a + 1, a + 1});
        stack.push_back({m.second, m.second});
        stack.push_back({a + 1, m.second});
      } else if (n.second == 0 || (m.second != 0 && m.end - m.begin >= n.end - n.begin)) {
        stack.push_back({a + 1, b});
        stack.push_back({m.second, b});
      } else {
        stack.push_back({a, b + 1});
        stack.push_back({a, n.second});
      }
    }
  }

  // visit(i) for each box that meets the query.
  template <class Visit>
  void for_each_meeting(const DoubleBox& query, Visit visit) const {
    // The depth is the logarithm of the number of boxes, and one of two children waits at each.
    std::array<std::uint32_t, 64> stack;
    std::size_t waiting = nodes_.empty() ? 0 : 1;
    stack[0] = 0;
    while (waiting > 0) {
      const std::uint32_t a = stack[--waiting];
      const Node& n = nodes_[a];
      if (!meet(n.box, query)) continue;
      if (n.second != 0) {
        stack[waiting++] = a + 1;
        stack[waiting++] = n.second;
        continue;
      }
      for (std::uint32_t k = n.begin; k < n.end; ++k) {
        if (meet(ordered_[k], query)) visit(order_[k]);
      }
    }
  }

 private:
  static constexpr std::uint32_t leaf_size = 4;

  // The first child of node a is a + 1.
  struct Node {
    DoubleBox box;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t second = 0;  // the second child; 0: a leaf
  };

  // Recursion is as deep as the logarithm of the number of boxes.
  void build(std::uint32_t begin, std::uint32_t end) {
    DoubleBox box = boxes_[order_[begin]];
    for (std::uint32_t k = begin + 1; k < end; ++k) box = join(box, boxes_[order_[k]]);
    const std::size_t self = nodes_.size();
    nodes_.push_back({box, begin, end, 0});
    if (end - begin <= leaf_size) return;
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (box.upper[i] - box.lower[i] > box.upper[axis] - box.lower[axis]) axis = i;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t i, std::uint32_t j) {
                       const DoubleBox& p = boxes_[i];
                       const DoubleBox& q = boxes_[j];
                       return p.lower[axis] + p.upper[axis] < q.lower[axis] + q.upper[axis];
                     });
    build(begin, middle);
    nodes_[self].second = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
  }

  template <class Visit>
  void visit_leaves(const Node& m, const Node& n, bool same, Visit& visit) const {
    for (std::uint32_t i = m.begin; i < m.end; ++i) {
      for (std::uint32_t j = same ? i + 1 : n.begin; j < n.end; ++j) {
        if (meet(ordered_[i], ordered_[j])) visit(order_[i], order_[j]);
      }
    }
  }

  std::span<const DoubleBox> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<DoubleBox> ordered_;  // the boxes of a node lie side by side
  std::vector<Node> nodes_;
};

// Boxes in groups, of which only pairs of different groups are wanted. A group's own hierarchy is
// built when another group comes near.
class GroupedBoxes {
 public:
  // Group g is the boxes begins[g] ... begins[g + 1], the last one up to the end.
  // REQUIRES begins ascends from 0, if there are boxes; both outlive this.
  GroupedBoxes(std::span<const DoubleBox> boxes, std::span<const std::uint32_t> begins)
      : boxes_(boxes), begins_(begins), hierarchies_(begins.size()) {
    group_boxes_.reserve(begins.size());
    for (std::uint32_t g = 0; g < begins.size(); ++g) {
      DoubleBox box = boxes[begins[g]];
      for (std::uint32_t i = begins[g] + 1; i < end_of(g); ++i) box = join(box, boxes[i]);
      group_boxes_.push_back(box);
    }
  }

  // visit(i, j) once for each pair of boxes of different groups that meet.
  template <class Visit>
  void for_each_pair(Visit visit) {
    BoxHierarchy(group_boxes_).for_each_pair([&](std::uint32_t g, std::uint32_t h) {
      if (size_of(g) > size_of(h)) std::swap(g, h);
      for (std::uint32_t i = begins_[g]; i < end_of(g); ++i) {
        if (meet(boxes_[i], group_boxes_[h])) {
          for_each_meeting(h, boxes_[i], [&](std::uint32_t j) { visit(i, j); });
        }
      }
    });
  }

 private:
  static constexpr std::uint32_t small_group = 16;

  std::uint32_t end_of(std::uint32_t g) const {
    return g + 1 < begins_.size() ? begins_[g + 1] : static_cast<std::uint32_t>(boxes_.size());
  }
  std::uint32_t size_of(std::uint32_t g) const { return end_of(g) - begins_[g]; }

  template <class Visit>
  void for_each_meeting(std::uint32_t g, const DoubleBox& query, Visit visit) {
    if (size_of(g) <= small_group) {
      for (std::uint32_t i = begins_[g]; i < end_of(g); ++i) {
        if (meet(boxes_[i], query)) visit(i);
      }
      return;
    }
    std::optional<BoxHierarchy>& hierarchy = hierarchies_[g];
    if (!hierarchy) hierarchy.emplace(boxes_.subspan(begins_[g], size_of(g)));
    hierarchy->for_each_meeting(query, [&](std::uint32_t i) { visit(begins_[g] + i); });
  }

  std::span<const DoubleBox> boxes_;
  std::span<const std::uint32_t> begins_;
  std::vector<DoubleBox> group_boxes_;
  std::vector<std::optional<BoxHierarchy>> hierarchies_;
};

}  // namespace exactcsg
