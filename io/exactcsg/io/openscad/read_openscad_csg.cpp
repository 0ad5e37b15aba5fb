// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/model.hpp"
#include "exactcsg/io/openscad/evaluate.hpp"
#include "exactcsg/io/openscad/syntax.hpp"

namespace exactcsg::io {

Model read_openscad_csg(std::string_view text, std::string name, const ReadOptions& options) {
  const openscad::SyntaxTree tree = openscad::parse(text, name, options.nesting_limit);
  Model model = options.rounding == Rounding::AsWritten
                    ? openscad::evaluate_as_written(tree, options)
                    : openscad::evaluate_on_grid(tree, options);
  model.name = std::move(name);
  return model;
}

}  // namespace exactcsg::io
