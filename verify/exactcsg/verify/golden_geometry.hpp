// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Golden values of OpenMC geometries: volumes of cells and materials that are known by closed
// forms.
//
//   {"schema": "exactcsg.geometry_golden/1",
//    "models": {"pin_cell": {"cells": {"1": {"volume": ["10.5", "10.6"], "form": "20 pi r^2"}},
//                            "materials": {"void": ..., "7": ...}}}}
//
// `volume` is a number, as text ("26.4", "2/3"); two numbers that the volume lies between; or null,
// of what has no end. `form` says how it is known. Cells are named by their ids, materials by
// theirs, void, or several with ", " between them, as `exactcsg measure` prints them.
//
// LAW golden_geometry.1  a check has passed only if the proved bounds and the golden ones have a
//                        number in common, or both say that there is no end.
// LAW golden_geometry.2  a cell or material of the model without an entry, and an entry without
//                        one, have failed.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct GoldenVolume {
  std::optional<Enclosure> volume;  // nullopt: no end
  std::string form;
};

struct GoldenGeometry {
  std::map<std::string, GoldenVolume> cells;
  std::map<std::string, GoldenVolume> materials;
};

using GoldenGeometries = std::map<std::string, GoldenGeometry>;

// THROWS Error(FileNotReadable | GoldenFile)
GoldenGeometries read_golden_geometries(const std::filesystem::path& file);

// One check for each cell, then for each material; one that has failed if the file has no `name`.
std::vector<Check> check_golden(const GoldenGeometries& golden, const std::string& name,
                                const io::openmc::Model& model,
                                const io::openmc::GeometryVolumes& volumes);

}  // namespace exactcsg::verify
