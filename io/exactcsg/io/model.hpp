// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A model as a reader hands it on: the solid and what the reader has to say about it.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactcsg/solid/fill_rule.hpp"
#include "exactcsg/solid/solid.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg::io {

struct Warning {
  std::string text;
  SourcePosition position;
};

// A font that text of a model is drawn with: no part of the model, yet the solid depends on it.
struct FontFile {
  std::string asked;  // as the model names it, or OpenSCAD's default
  std::string name;   // family, style and version as the font has them
  std::string file;
};

struct Model {
  Solid solid;
  std::string name;  // the file's name as given
  std::vector<Warning> warnings;
  std::size_t primitives = 0;
  // What an external front end printed on stderr while making the model (.scad only).
  std::string front_end_messages;
  std::vector<FontFile> fonts;
  // Every coordinate of the model differs by at most this from the one meant by irrational
  // formulas (sines, cosines, radii) of the source: the documented rounding of the tessellation.
  Rational rounding_bound{0};
};

enum class Rounding {
  AsWritten,    // decimals mean themselves; faceted primitives are exactly planar
  OpenScadGrid  // OpenSCAD 2021.01's own: coordinates in double, cut to multiples of 2^-20, convex
                // operands replaced by the hull of their cut corners (docs/openscad.md)
};

struct ReadOptions {
  Rounding rounding = Rounding::AsWritten;
  std::size_t nesting_limit = 10'000'000;
  // Where `import` and `surface` of a .csg text look for their files, as OpenSCAD looks in the
  // model's folder. nullopt: they are refused (a text alone reads no files); read_model fills it
  // in.
  std::optional<std::filesystem::path> folder{};
  // What is inside of a polyhedron, an imported mesh or a twisted extrusion that meets itself or is
  // turned inside out. nullopt: they are refused. Not of any use to OpenScadGrid, which knows no
  // such rule.
  std::optional<FillRule> fill{};
  Progress* progress = nullptr;
  unsigned threads = 1;  // for the checks of meshes, as in EvaluateOptions
};

// THROWS Error with a position for everything that is wrong with the text.
Model read_openscad_csg(std::string_view text, std::string name, const ReadOptions& options = {});

// Reads .csg, .scad (through `openscad --render`), and mesh files (.off .stl .obj .ply) as one
// polyhedral mesh. By the file's ending. THROWS Error(FileNotReadable | EmptyFile | UnknownFormat |
// whatever the format's reader throws)
Model read_model(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace exactcsg::io
