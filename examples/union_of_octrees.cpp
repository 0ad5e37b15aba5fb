// SPDX-License-Identifier: GPL-3.0-or-later
// The union of two octrees with different subdivisions, which is an octree again.
//
// Two balls of radius 1 and 3/4 whose centres are 1 apart. United cell by cell, two octrees of one
// depth give the octree that is made of the union at once; with a shallower one, a coarser octree.

#include <iostream>
#include <optional>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/overlay.hpp"

namespace {

using namespace exactcsg;
using csg::Membership;
using Cell = gdt::Cell<Rational, 3>;
using Octree = gdt::Tree<Membership>;
using Solid = csg::Tree<domain::HalfSpace<3>, csg::BooleanOperator>;

struct Task {
  Cell cell;
  Solid solid;
};

Octree octree_of(const Solid& solid, std::size_t depth) {
  const auto task_of = [](const Cell& cell, const Solid& outer) {
    const domain::Box<3> box(cell.lower, cell.upper);
    return Task{cell, csg::prune(outer, [&](const auto& h) { return classify(h, box); })};
  };
  return gdt::create(
      task_of({{-2, -2, -2}, {2, 2, 2}}, solid),
      [](const Task& task) { return task.solid.is_empty() || task.solid.is_full(); },
      [&](const Task& task) {
        std::vector<Task> octants;
        for (std::size_t i = 0; i < 8; ++i) {
          octants.push_back(task_of(gdt::Orthants()(task.cell, gdt::NoLabel(), i), task.solid));
        }
        return octants;
      },
      [](const Task& task) {
        return task.solid.is_full()    ? Membership::In
               : task.solid.is_empty() ? Membership::Out
                                       : Membership::Unknown;
      },
      depth);
}

}  // namespace

int main() {
  const Solid large = Solid::primitive(domain::make_sphere({0, 0, 0}, 1));
  const Solid small = Solid::primitive(domain::make_sphere({1, 0, 0}, {9, 16}));
  const auto unite = [](Membership a, Membership b) {
    return csg::combine(a, csg::BooleanOperator::Union, b);
  };
  const auto in_early = [](const Membership* a, const Membership* b) -> std::optional<Membership> {
    const bool in =
        (a != nullptr && *a == Membership::In) || (b != nullptr && *b == Membership::In);
    return in ? std::optional(Membership::In) : std::nullopt;
  };
  const auto united = [&](std::size_t depth_of_large, std::size_t depth_of_small) {
    return gdt::merge_equal(gdt::overlay(octree_of(large, depth_of_large),
                                         octree_of(small, depth_of_small), unite, in_early));
  };
  const Octree direct = gdt::merge_equal(octree_of(csg::unite(large, small), 5));
  std::cout << "equally deep: "
            << (united(5, 5) == direct ? "the octree of the union" : "another octree") << '\n';
  std::cout << "5 and 3 deep: " << (united(5, 3) == direct ? "the same" : "a coarser one") << '\n';
}
