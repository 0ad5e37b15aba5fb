// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What classify and info answer for OpenMC geometries, whose cells are many solids in one file.

#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::cli {

// Reads a geometry and passes its warnings on.
io::openmc::Model read_geometry(Context& context, const std::filesystem::path& file);

// A line for each point: In, On, Gap or Overlap, the cells, and the path through universes.
Answer locate_points(Context& context, const std::string& model, const std::vector<Point3>& points);
Answer print_geometry_info(Context& context, const std::string& model);

}  // namespace exactcsg::cli
