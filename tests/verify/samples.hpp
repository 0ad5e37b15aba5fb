// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Solids that the tests of the verification share, and ways to look into a report.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/solid.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify::samples {

inline Solid box(const Point3& lower, const Point3& upper) {
  return Solid::primitive({make_box(lower, upper), {}});
}

inline Solid unite(std::vector<Solid> parts) {
  return Solid::compose(csg::BooleanOperator::Union, std::move(parts));
}
inline Solid intersect(std::vector<Solid> parts) {
  return Solid::compose(csg::BooleanOperator::Intersection, std::move(parts));
}
inline Solid subtract(std::vector<Solid> parts) {
  return Solid::compose(csg::BooleanOperator::Difference, std::move(parts));
}

// A pyramid over the square [1/7, 5/7]^2 at height z with its apex at (3/7, 3/7, top): coordinates
// that no file format can hold.
inline Solid pyramid(const Rational& z, const Rational& top) {
  const Rational low(1, 7);
  const Rational high(5, 7);
  const Rational middle(3, 7);
  Polyhedron p;
  p.vertices = {
      {low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}, {middle, middle, top}};
  p.facets = {{3, 2, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return Solid::primitive({make_convex_polytope(std::move(p)), {}});
}

// The plate [0,4] x [0,3] x [0,2] with a square hole [1,2]^2 through it, a notch at its far upper
// corner and a pyramid on top.
inline Solid plate(const Rational& hole_shift = 0) {
  return unite(
      {subtract({box({0, 0, 0}, {4, 3, 2}), box({1 + hole_shift, 1, -1}, {2 + hole_shift, 2, 3}),
                 box({3, 2, 1}, {5, 4, 3})}),
       pyramid(1, 3)});
}

inline io::Model model_of(Solid solid, std::string name = "plate") {
  io::Model model;
  model.primitives = solid.primitive_count();
  model.solid = std::move(solid);
  model.name = std::move(name);
  return model;
}

inline const Boundary& plate_boundary() {
  static const Boundary boundary = evaluate(plate());
  return boundary;
}

// The canonical boundary as a soup of triangles with exact coordinates.
inline io::PolygonSoup soup_of(const Boundary& boundary) {
  io::PolygonSoup soup;
  soup.format = io::MeshFormat::Off;
  soup.vertices = to_vector(boundary.vertices);
  for (const auto& triangle : io::triangulate(boundary)) {
    soup.facets.push_back({triangle[0], triangle[1], triangle[2]});
  }
  return soup;
}

inline Rational round_to_six_digits(const Rational& value) {
  return *parse_rational(fmt::format("{:.6g}", nearest_double(value)));
}
inline Rational round_to_single(const Rational& value) {
  return rational_of(static_cast<double>(static_cast<float>(nearest_double(value))));
}

inline io::PolygonSoup rounded(io::PolygonSoup soup, io::MeshFormat format,
                               Rational (*round)(const Rational&)) {
  soup.format = format;
  for (Point3& p : soup.vertices) p = {round(p.x), round(p.y), round(p.z)};
  return soup;
}

// Everything that a failed check says, with the coordinates of its mismatches.
inline std::string complaints(const std::vector<Check>& checks) {
  std::string text;
  for (const Check& check : checks) {
    if (check.verdict != Verdict::Failed) continue;
    text += check.name + ": " + check.explanation + "\n";
    for (const Mismatch& mismatch : check.mismatches) {
      text += "  " + mismatch.text;
      for (const auto& p : mismatch.where) {
        text += fmt::format(" [{:.9g}, {:.9g}, {:.9g}]", p[0], p[1], p[2]);
      }
      text += "\n";
    }
  }
  return text;
}

inline const Check* find(const std::vector<Check>& checks, const std::string& name) {
  for (const Check& check : checks) {
    if (check.name == name) return &check;
  }
  return nullptr;
}

}  // namespace exactcsg::verify::samples
