// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <random>

#include "exactcsg/solid/measures.hpp"
#include "exactcsg/verify/boundary_classifier.hpp"
#include "exactcsg/verify/facet_complex.hpp"

namespace exactcsg::verify {
namespace {

using Random = std::mt19937_64;

// Portable, unlike the distributions of the standard library.
std::size_t below(Random& random, std::size_t n) { return static_cast<std::size_t>(random() % n); }

Rational fraction(Random& random) {
  constexpr int bits = 20;
  Rational value(Integer(static_cast<unsigned long>(random() >> (64 - bits))), Integer(1) << bits);
  value.canonicalize();
  return value;
}

Point3 middle(const Point3& p, const Point3& q) {
  return {(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
}

// A tiny step along one of the axes.
Point3 a_little_off(const Point3& p, const Rational& step, Random& random) {
  Point3 moved = p;
  const std::size_t which = below(random, 6);
  Rational& c = which % 3 == 0 ? moved.x : which % 3 == 1 ? moved.y : moved.z;
  c += which < 3 ? step : Rational(-step);
  return moved;
}

// A point in the plane of a face near one of its corners; mostly inside it.
Point3 corner_point(const Boundary& boundary, const BoundaryFace& face, Random& random) {
  const auto& loop = face.loops[below(random, face.loops.size())];
  const std::size_t i = below(random, loop.size());
  const Point3& a = boundary.vertices[loop[i]];
  const Point3& b = boundary.vertices[loop[(i + 1) % loop.size()]];
  const Point3& c = boundary.vertices[loop[(i + 2) % loop.size()]];
  return middle(middle(a, c), b);
}

class Deadline {
 public:
  explicit Deadline(double seconds) : seconds_(seconds) {}
  bool is_over() const {
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - start_;
    return past.count() > seconds_;
  }

 private:
  double seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string name_of(PointClass c) {
  return c == PointClass::In ? "In" : c == PointClass::Out ? "Out" : "On";
}

}  // namespace

std::vector<Point3> sample_points(const Boundary& boundary, std::size_t count, std::uint64_t seed) {
  std::vector<Point3> points;
  const auto box = bounding_box(boundary);
  if (!box) return points;
  Random random(seed);
  const Vector3 extent = box->upper - box->lower;
  const Rational longest = std::max({extent.x, extent.y, extent.z});
  const Rational step = longest / Rational(Integer(1) << 60);
  while (points.size() < count) {
    Point3 p;
    switch (points.size() % 8) {
      case 0:
      case 1:
        p = boundary.vertices[below(random, boundary.vertices.size())];
        break;
      case 2:
      case 3: {
        const BoundaryEdge& edge = boundary.edges[below(random, boundary.edges.size())];
        p = middle(boundary.vertices[edge.from], boundary.vertices[edge.to]);
        break;
      }
      case 4:
      case 5:
        p = corner_point(boundary, boundary.faces[below(random, boundary.faces.size())], random);
        break;
      default: {
        // The box grown by an eighth on every side.
        const auto between = [&](const Rational& low, const Rational& size) {
          return Rational(low - size / 8 + fraction(random) * size * Rational(5, 4));
        };
        p = {between(box->lower.x, extent.x), between(box->lower.y, extent.y),
             between(box->lower.z, extent.z)};
      }
    }
    if (points.size() % 2 == 1) p = a_little_off(p, step, random);
    points.push_back(std::move(p));
  }
  return points;
}

std::vector<Check> check_sampling(const Solid& solid, const Boundary& boundary,
                                  std::span<const Point3> points, std::span<const PointClass> nef,
                                  double budget_seconds) {
  std::vector<PointClass> ours;
  const Deadline deadline(budget_seconds);
  for (const Point3& p : points) {
    if (deadline.is_over()) break;
    ours.push_back(classify(solid, p));
  }
  const auto compare = [&](const std::string& name, std::size_t most,
                           const std::function<PointClass(std::size_t)>& other) {
    Check check;
    check.oracle = "sampling";
    check.name = "sampling: " + name;
    std::size_t counts[3] = {0, 0, 0};
    std::size_t done = 0;
    const Deadline own_deadline(budget_seconds);
    for (; done < std::min(most, ours.size()) && !own_deadline.is_over(); ++done) {
      const PointClass theirs = other(done);
      ++counts[static_cast<std::size_t>(theirs)];
      if (theirs == ours[done]) continue;
      add_mismatch(check, {fmt::format("{} by the tree, {} by {}: {}", name_of(ours[done]),
                                       name_of(theirs), name, describe(points[done])),
                           {approximate(points[done])}});
    }
    check.ours = fmt::format("{} points", done);
    check.theirs = fmt::format("{} in, {} on, {} out", counts[2], counts[1], counts[0]);
    check.difference = std::to_string(check.mismatch_count);
    check.bound = "0";
    if (done == 0 && !points.empty()) {
      check.verdict = Verdict::Skipped;
      check.explanation = "no time";
    }
    return check;
  };
  std::vector<Check> checks;
  const BoundaryClassifier by_boundary(boundary);
  checks.push_back(
      compare("boundary", points.size(), [&](std::size_t i) { return by_boundary(points[i]); }));
  const PointClassifier retained(solid);
  checks.push_back(compare("retained classifier", points.size(),
                           [&](std::size_t i) { return retained(points[i]); }));
  if (!nef.empty()) {
    checks.push_back(compare("nef", nef.size(), [&](std::size_t i) { return nef[i]; }));
  }
  return checks;
}

}  // namespace exactcsg::verify
