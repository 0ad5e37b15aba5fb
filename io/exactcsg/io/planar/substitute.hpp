// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A tree with a whole tree in place of every primitive. [Exact]
//
// LAW substitute.1  function is called once for every distinct node, and what was shared is shared
// again. No recursion. COST: O(distinct nodes).

#include <iterator>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactcsg/csg/tree.hpp"
#include "exactcsg/csg/walk.hpp"

namespace exactcsg::io {

template <class Target, class P, class F>
Target substitute(const csg::Tree<P, csg::BooleanOperator>& tree, const Target& full,
                  F&& function) {
  std::unordered_map<const void*, Target> known;
  std::vector<Target> results;
  const auto recall = [&](auto node) {
    const auto found = known.find(node.tree().identity());
    if (found == known.end()) return false;
    results.push_back(found->second);
    return true;
  };
  const auto remember = [&](auto node) {
    if (node.tree().is_shared()) known.emplace(node.tree().identity(), results.back());
  };
  csg::walk(
      tree.root(), [&](auto node) { return !recall(node); },
      [&](auto node) {
        if (node.kind() == csg::NodeKind::Empty) {
          results.push_back(Target::empty());
        } else if (node.kind() == csg::NodeKind::Full) {
          results.push_back(full);
        } else if (!recall(node)) {
          results.push_back(function(node.primitive()));
          remember(node);
        }
      },
      [&](auto node) {
        const auto first =
            results.end() - static_cast<std::ptrdiff_t>(node.tree().children().size());
        std::vector<Target> children(std::make_move_iterator(first),
                                     std::make_move_iterator(results.end()));
        results.erase(first, results.end());
        results.push_back(Target::compose(node.operation(), std::move(children)));
        remember(node);
      });
  return std::move(results.back());
}

// The union of the members, none of them if there is none, itself if there is one.
template <class Target>
Target unite_all(std::vector<Target> members) {
  if (members.empty()) return Target::empty();
  if (members.size() == 1) return std::move(members.front());
  return Target::compose(csg::BooleanOperator::Union, std::move(members));
}

}  // namespace exactcsg::io
