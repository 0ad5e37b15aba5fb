// SPDX-License-Identifier: GPL-3.0-or-later
// What the generic operators cost: three computations, each by the library and written out by hand
// for its types, with the same data structures and the same explicit stacks (a tree may be a
// million deep). `overhead` checks that the answers agree; bench/gel_experiments counts the
// instructions of the functions of this file.
//
// By hand means: no function is a parameter, no type either, and nothing is there for cases that do
// not occur. What both use is the tree, and csg::prune for the areas.

#include <malloc.h>

#include <functional>
#include <iostream>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bench/gel/planar_model.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/traverse.hpp"
#include "exactcsg/skeleton/divacon.hpp"

namespace exactcsg::bench {

constexpr int deepest = 9;
const PlanarCell unit_square{{0, 0}, {1, 1}};

[[gnu::noinline]] PointClass generic_membership(const Planar& solid, const PlanarPoint& point) {
  return membership(solid, point);
}

[[gnu::noinline]] PointClass handwritten_membership(const Planar& solid, const PlanarPoint& point) {
  struct Open {
    Planar::Cursor child;
    Planar::Cursor end;
    csg::BooleanOperator operation;
    bool has_partial;
    PointClass partial;
  };
  std::vector<Open> open;
  Planar::Cursor node = solid.root();
  while (true) {
    while (node.kind() == csg::NodeKind::Compose) {
      open.push_back({node.first_child(), node.children_end(), node.operation(), false, {}});
      node = node.first_child();
    }
    PointClass value = PointClass::Out;
    if (node.kind() == csg::NodeKind::Primitive) {
      value = classify(node.primitive(), point);
    } else if (node.kind() == csg::NodeKind::Full) {
      value = PointClass::In;
    }
    while (true) {
      if (open.empty()) return value;
      Open& top = open.back();
      if (top.has_partial) value = combine(top.partial, top.operation, value);
      top.child = top.child.next_sibling();
      if (!(top.child == top.end)) {
        top.has_partial = true;
        top.partial = value;
        node = top.child;
        break;
      }
      open.pop_back();
    }
  }
}

[[gnu::noinline]] double generic_area(const Planar& solid) {
  return skeleton::divacon(
      Local{unit_square, solid},
      [](const Local& local) { return local.depth == deepest || is_decided(local); }, quadrants,
      area_of_leaf, sum);
}

// A sum needs no stack of results: they are added up as they come.
[[gnu::noinline]] double handwritten_area(const Planar& solid) {
  double sum = 0;
  std::vector<Local> open{{unit_square, solid}};
  while (!open.empty()) {
    const Local local = std::move(open.back());
    open.pop_back();
    if (local.depth == deepest || is_decided(local)) {
      sum += area_of_leaf(local);
      continue;
    }
    for (std::size_t i = 0; i < 4; ++i) open.push_back(localised(local, i));
  }
  return sum;
}

using AreaTree = gdt::Tree<double>;

AreaTree area_tree(const Planar& solid) {
  return gdt::create(Local{unit_square, solid}, is_decided, quadrants, area_of_leaf, deepest);
}

[[gnu::noinline]] double generic_sum(const AreaTree& tree) {
  return gdt::traverse(tree, std::identity(), sum);
}

// Keeps the results of each node's children apart, as a combine that is not a sum would need it.
[[gnu::noinline]] double handwritten_sum(const AreaTree& tree) {
  struct Open {
    AreaTree::Node node;
    std::size_t next_child;
    std::size_t first_result;
  };
  std::vector<Open> open;
  std::vector<double> results;
  AreaTree::Node node = tree.root();
  while (true) {
    while (!node.is_terminal()) {
      open.push_back({node, 1, results.size()});
      node = node.child(0);
    }
    results.push_back(node.terminal());
    while (!open.empty() && open.back().next_child == open.back().node.degree()) {
      const double* const r = results.data() + open.back().first_result;
      const double sum = r[0] + r[1] + r[2] + r[3];
      results.resize(open.back().first_result);
      results.push_back(sum);
      open.pop_back();
    }
    if (open.empty()) return results.front();
    node = open.back().node.child(open.back().next_child++);
  }
}

}  // namespace exactcsg::bench

// Whichever is first would else sort out what was left on the heap.
template <class Generic, class Handwritten>
bool agree(Generic generic, Handwritten handwritten) {
  malloc_trim(0);
  const auto result = generic();
  malloc_trim(0);
  return result == handwritten();
}

int main() {
  using namespace exactcsg::bench;
  const Planar many = squares(20'000);
  const PlanarPoint point{0.3, 0.7};
  const Planar solid = plate();
  const AreaTree tree = area_tree(solid);
  const bool equal =
      agree([&] { return generic_membership(many, point); },
            [&] { return handwritten_membership(many, point); }) &&
      agree([&] { return generic_area(solid); }, [&] { return handwritten_area(solid); }) &&
      agree([&] { return generic_sum(tree); }, [&] { return handwritten_sum(tree); });
  std::cout << (equal ? "equal\n" : "different\n");
  return equal ? 0 : 1;
}
