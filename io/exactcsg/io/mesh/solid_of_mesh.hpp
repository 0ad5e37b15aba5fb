// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A closed mesh as a solid, also one that meets itself if there is a rule for its inside. [Exact]

#include <functional>
#include <optional>
#include <string>

#include "exactcsg/solid/fill_rule.hpp"
#include "exactcsg/solid/solid.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg::io {

// How the inside of a mesh is decided that make_mesh refuses because it meets itself or is turned
// inside out. Without a rule the refusal stands.
struct InsideRule {
  std::optional<FillRule> rule{};
  std::function<void(const std::string&)> warn{};  // told that the rule was needed, if given
  Progress* progress = nullptr;
  unsigned threads = 1;  // as in EvaluateOptions
};

// LAW mesh.1  a mesh that make_mesh accepts is that mesh, whatever the rule.
// THROWS what make_mesh throws; with a rule, what filled_boundary throws.
Solid solid_of_mesh(Polyhedron polyhedron, const InsideRule& inside = {});

}  // namespace exactcsg::io
