// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Decks for the tests of the reader of MCNP's input files.

#include <filesystem>
#include <string>
#include <string_view>

#include "exactcsg/domain/classify.hpp"
#include "exactcsg/io/mcnp/reader.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::mcnp {

inline std::string deck_of(const std::string& cells, const std::string& surfaces,
                           const std::string& data = "mode n\n") {
  return "title\n" + cells + "\n" + surfaces + "\n" + data;
}

// One cell of the region, and one surface or several.
inline openmc::Model model_of(const std::string& region, const std::string& surfaces,
                              const std::string& data = "mode n\n") {
  return read_geometry(deck_of("1 0 " + region + " imp:n=1\n", surfaces + "\n", data), "text");
}

inline PointClass class_at(const openmc::Model& model, const openmc::Point& point) {
  return domain::classify(openmc::half_spaces(model, model.cells.front().region), point);
}

inline std::filesystem::path deck_folder() {
  return std::filesystem::path(EXACTCSG_SOURCE_DIR) / "data" / "mcnp";
}
inline openmc::Model read_deck_file(const std::string& name) {
  return openmc::read_geometry_file(deck_folder() / name);
}

}  // namespace exactcsg::io::mcnp
