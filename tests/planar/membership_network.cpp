// SPDX-License-Identifier: GPL-3.0-or-later
#include "planar/membership_network.hpp"

#include <unordered_map>

#include "exactcsg/csg/walk.hpp"

namespace exactcsg::test {

MembershipNetwork::MembershipNetwork(const PlanarTree& tree) {
  using Cursor = PlanarTree::Cursor;
  std::unordered_map<const void*, std::uint32_t> known;
  const auto number = [&](Cursor cursor) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    known.emplace(cursor.tree().identity(), index);
    nodes_.emplace_back().kind = cursor.kind();
    return index;
  };
  csg::walk(
      tree.root(), [&](Cursor cursor) { return !known.contains(cursor.tree().identity()); },
      [&](Cursor cursor) {
        if (known.contains(cursor.tree().identity())) return;
        const std::uint32_t index = number(cursor);
        nodes_[index].value = cursor.kind() == csg::NodeKind::Full;
        if (cursor.kind() != csg::NodeKind::Primitive) return;
        figures_.push_back(&cursor.primitive());
        node_of_figure_.push_back(index);
      },
      [&](Cursor cursor) {
        const std::uint32_t index = number(cursor);
        const auto children = cursor.tree().children();
        for (std::size_t i = 0; i < children.size(); ++i) {
          Node& child = nodes_[known.at(children[i].identity())];
          child.parents.push_back({index, i == 0});
          if (i == 0) {
            nodes_[index].first_value = child.value;
          } else if (child.value) {
            ++nodes_[index].operands_in;
          }
        }
        Node& node = nodes_[index];
        node.operation = cursor.operation();
        node.operands = static_cast<std::uint32_t>(children.size());
        node.value = evaluate(node);
      });
}

bool MembershipNetwork::evaluate(const Node& node) {
  switch (node.operation) {
    case csg::BooleanOperator::Union:
      return node.first_value || node.operands_in > 0;
    case csg::BooleanOperator::Intersection:
      return node.first_value && node.operands_in == node.operands - 1;
    case csg::BooleanOperator::Difference:
      return node.first_value && node.operands_in == 0;
    case csg::BooleanOperator::SymmetricDifference:
      return node.first_value != (node.operands_in % 2 == 1);
  }
  return false;
}

void MembershipNetwork::flip(std::uint32_t index) {
  Node& node = nodes_[index];
  node.value = !node.value;
  for (const ParentLink& link : node.parents) {
    Node& parent = nodes_[link.node];
    if (link.first_operand) {
      parent.first_value = node.value;
    } else if (node.value) {
      ++parent.operands_in;
    } else {
      --parent.operands_in;
    }
    if (parent.queued) continue;
    parent.queued = true;
    pending_.push(link.node);
  }
}

// In the order of numbers every operator is looked at once, after all its operands are final.
void MembershipNetwork::toggle(std::uint32_t figure) {
  flip(node_of_figure_[figure]);
  while (!pending_.empty()) {
    const std::uint32_t index = pending_.top();
    pending_.pop();
    nodes_[index].queued = false;
    if (evaluate(nodes_[index]) != nodes_[index].value) flip(index);
  }
}

}  // namespace exactcsg::test
