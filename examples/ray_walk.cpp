// SPDX-License-Identifier: GPL-3.0-or-later
// What a ray meets in an octree, cell by cell and in order: the path of a neutral particle.
//
// The octree holds the ball x^2 + y^2 + z^2 <= 1 to depth 6, each cell with what it is of the ball.
// The ray along the x axis enters at x = -1 and leaves at x = 1 (the octree's cells end there), so
// it runs through full cells for a length of at most 2, and of at least 2 less the two cells of
// side 1/16 that the sphere crosses. In exact numbers: every bound is a multiple of 1/16.

#include <iostream>
#include <vector>

#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/ray_walk.hpp"

namespace {

using namespace exactcsg;
using Cell = gdt::Cell<Rational, 3>;

struct Task {
  Cell cell;
  csg::Membership membership;
};

}  // namespace

int main() {
  const auto ball = domain::make_sphere({0, 0, 0}, 1);
  const auto task_of = [&](const Cell& cell) {
    return Task{cell, classify(ball, domain::Box<3>(cell.lower, cell.upper))};
  };
  const Cell space{{-2, -2, -2}, {2, 2, 2}};
  const auto octree = gdt::create(
      task_of(space), [](const Task& task) { return task.membership != csg::Membership::Unknown; },
      [&](const Task& task) {
        std::vector<Task> octants;
        for (std::size_t i = 0; i < 8; ++i) {
          octants.push_back(task_of(gdt::Orthants()(task.cell, gdt::NoLabel(), i)));
        }
        return octants;
      },
      [](const Task& task) { return task.membership; }, 6);

  const gdt::Ray<Rational, 3> ray{{-2, 0, 0}, {1, 0, 0}};  // x = t - 2
  Rational full = 0;
  Rational undecided = 0;
  gdt::walk_ray(octree, space, gdt::Orthants(), ray,
                [&](csg::Membership membership, const Cell&, const gdt::RayPart<Rational>& part) {
                  const Rational length = part.end - part.begin;
                  if (membership == csg::Membership::In) full += length;
                  if (membership == csg::Membership::Unknown) undecided += length;
                });
  std::cout << "inside the ball for a length of " << full << " to " << Rational(full + undecided)
            << '\n';
}
