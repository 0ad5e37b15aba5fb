// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The volumes of an OpenMC model's cells and materials, wherever they are visible. [Certified]
//
// A cell of a universe is visible once for each place that the universe is put down in: in the
// region of the cell that the universe fills, clipped by all cells and lattice elements above.
//
// LAW cell_volumes.1  the volume of all instances of a cell, each within what clips it, lies in its
//                     bounds. Where cells overlap, each counts in full.
// LAW cell_volumes.2  a cell has no bounds if one of its instances is not bounded, or is not shown
//                     to be (measure/bounding_box.hpp).
// LAW cell_volumes.3  the volume of a material is the sum of those of the cells that name it, or,
//                     where a cell names several, one for each instance, of those that name the
//                     same.
// LAW cell_volumes.4  the bounds of each cell are as near to each other as asked for, unless a
// limit
//                     was reached, which `stop` says.
// Method: views of a universe that are equal are one (visible_universes.hpp): the volumes are
// computed once and multiplied. COST: that of visible_cells; for each distinct instance a volume
// (measure/certified_measure.hpp).

#include <string>
#include <vector>

#include "exactcsg/io/openmc/visible_universes.hpp"
#include "exactcsg/measure/certified_measure.hpp"

namespace exactcsg::io::openmc {

struct VolumeLimits {
  // Of each cell; either is enough. A cell that is thinner than a millionth of its bounding box is
  // measured to the relative width times that.
  double relative_width = 1e-6;
  double absolute_width = 0;
  std::uint64_t cells = 5'000'000;  // of the decomposition, for one distinct instance
  std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt;
  Progress* progress = nullptr;
};

struct VisibleVolume {
  Integer instances;  // without those of which their boxes alone show that nothing is visible
  std::optional<Enclosure> volume;                        // nullopt: not bounded
  measure::StopReason stop = measure::StopReason::Width;  // the first that is not Width
};

using Materials = std::vector<std::optional<Id>>;
std::string text_of_materials(const Materials& materials);  // "void", "1, 2"

struct MaterialVolume {
  Materials materials;
  VisibleVolume visible;
};

struct GeometryVolumes {
  std::vector<VisibleVolume> cells;       // as the model's cells
  std::vector<MaterialVolume> materials;  // ascending, void first
  std::uint64_t distinct_instances = 0;   // whose volumes were computed
  std::uint64_t decomposition_cells = 0;
};

// THROWS Error(TooLarge) as visible_universes.
// REQUIRES visible_cells(model)
GeometryVolumes measure_volumes(const Model& model, const VisibleCells& visible,
                                const VolumeLimits& limits = {});
GeometryVolumes measure_volumes(const Model& model, const VolumeLimits& limits = {});

}  // namespace exactcsg::io::openmc
