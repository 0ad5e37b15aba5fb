// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mesh/solid_of_mesh.hpp"

#include <utility>

#include "exactcsg/io/mesh/solid_of_boundary.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"

namespace exactcsg::io {

namespace {

bool rule_decides(const Error& error) {
  return error.id() == ErrorId::SelfIntersectingMesh || error.id() == ErrorId::InvertedMesh;
}

}  // namespace

Solid solid_of_mesh(Polyhedron polyhedron, const InsideRule& inside) {
  if (!inside.rule) return Solid::primitive({make_mesh(std::move(polyhedron), inside.threads)});
  try {
    return Solid::primitive({make_mesh(polyhedron, inside.threads)});
  } catch (const Error& error) {
    if (!rule_decides(error)) throw;
    if (inside.warn) {
      inside.warn(std::string(describe(error.id()).title) + ": its inside is where " +
                  std::string(name_of(*inside.rule)) + " holds");
    }
  }
  EvaluateOptions options;
  options.progress = inside.progress;
  options.threads = inside.threads;
  return solid_of_boundary(filled_boundary(std::move(polyhedron), *inside.rule, options));
}

}  // namespace exactcsg::io
