// SPDX-License-Identifier: GPL-3.0-or-later
// A design that is changed: the cells of its evaluation are kept, and a change evaluates only those
// that it touches.
//
// A plate of 400 x 10 x 1 with 100 square holes of 2 x 2, one every 4: volume 4000 - 400 = 3600.
// Hole 7 becomes 3 x 2: 2 less. A rail of 400 x 1 x 1 above the plate: 400 more. In a variant the
// plate ends after 200, between two holes: 2000 - 200 - 2 + 200 = 1998 are left. Faces: 6 of the
// plate, 4 of each hole; the rail adds its top and one side, its other sides are flush.

#include <iostream>
#include <vector>

#include "exactcsg/solid/incremental_evaluation.hpp"
#include "exactcsg/solid/measures.hpp"

namespace {

using namespace exactcsg;

Primitive hole(int number, int length) {
  const int x = 4 * number + 1;
  return {make_box({x, 4, -1}, {x + length, 6, 2})};
}

void print(const char* what, IncrementalEvaluation& design) {
  const Boundary boundary = design.boundary();
  std::cout << what << ": volume " << to_text(*exact_volume(boundary)) << ", "
            << boundary.faces.size() << " faces\n";
  if (digest(boundary) != digest(evaluate(design.solid()))) {
    std::cout << "  not what a full evaluation says\n";
  }
}

// Of all cells, those that a change had to look at.
void print(const UpdateStatistics& update) {
  const bool few = !update.everything && 10 * update.renewed_cells < update.cells;
  std::cout << "  changed " << (few ? "less than a tenth" : "a tenth or more") << " of the cells\n";
}

}  // namespace

int main() {
  std::vector<Solid> operands{Solid::primitive({make_box({0, 0, 0}, {400, 10, 1})})};
  for (int i = 0; i < 100; ++i) operands.push_back(Solid::primitive(hole(i, 2)));
  IncrementalEvaluation design(
      Solid::compose(csg::BooleanOperator::Difference, std::move(operands)));
  print("plate", design);

  // Occurrences are numbered from left to right: the plate is 0, hole i is i + 1.
  const UpdateStatistics update = design.replace(Occurrence{8}, hole(7, 3));
  print("wider hole", design);
  print(update);

  design.unite({make_box({0, 0, 1}, {400, 1, 2})});
  print("with a rail", design);

  IncrementalEvaluation variant = design;  // shares its cells
  variant.intersect({make_box({0, 0, 0}, {200, 10, 5})});
  print("half of it", variant);
  print("the whole is as it was", design);
}
