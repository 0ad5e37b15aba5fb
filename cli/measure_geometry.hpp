// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What measure answers for OpenMC geometries: the volumes of cells and materials.

#include <string>

#include "cli/command.hpp"

namespace exactcsg::cli {

// Of every volume: relative to it, or absolute.
struct WidthOption {
  double width = 1e-6;
  bool is_absolute = false;
};

// Yes if all volumes are as narrow as asked for. `lines`: one JSON object on a line.
Answer measure_geometry(Context& context, const std::string& file, const WidthOption& width,
                        bool json, bool lines);

}  // namespace exactcsg::cli
