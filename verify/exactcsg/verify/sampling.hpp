// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Points, random and degenerate, classified in several ways that must agree; and algebraic laws on
// random subtrees. [Exact]

#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/solid.hpp"
#include "exactcsg/support/progress.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

// Vertices, midpoints of edges, points of faces, points a little off each of these (by 2^-60 of the
// size), and random points of the bounding box. The same for the same seed.
// LAW sampling.1  fewer points of the same seed are a prefix of more
std::vector<Point3> sample_points(const Boundary& boundary, std::size_t count, std::uint64_t seed);

// Classification by the tree, by the retained classifier, and by our boundary alone (parity of
// exact crossings along a ray) agree on every point; and `nef`, the classes of the first nef.size()
// points. Each way stops after the budget; the checks say how many points were classified.
std::vector<Check> check_sampling(const Solid& solid, const Boundary& boundary,
                                  std::span<const Point3> points, std::span<const PointClass> nef,
                                  double budget_seconds = 10);

// v(A+B) + v(A*B) = v(A) + v(B), v(A-B) + v(A*B) = v(A), idempotence, absorption, De Morgan, A - A
// empty, on pairs of random bounded subtrees with at most `primitive_limit` primitives each.
struct LawOptions {
  std::size_t samples = 6;
  std::uint64_t seed = 1;
  std::size_t primitive_limit = 200;
  double budget_seconds = 20;
  Progress* progress = nullptr;
};
std::vector<Check> check_laws(const Solid& solid, const LawOptions& options);

}  // namespace exactcsg::verify
