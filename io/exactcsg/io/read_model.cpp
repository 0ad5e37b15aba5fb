// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/io/model.hpp"
#include "exactcsg/io/openscad/front_end.hpp"
#include "exactcsg/io/openscad/polyhedron.hpp"

namespace exactcsg::io {

namespace {

namespace fs = std::filesystem;

void check_readable(const fs::path& file) {
  const SourcePosition position{file.string()};
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) {
    throw Error(ErrorId::FileNotReadable, {"no file of this name", "", position});
  }
  if (fs::is_directory(status)) {
    throw Error(ErrorId::FileNotReadable, {"a directory", "a file", position});
  }
  // A pipe may never end, a device like /dev/zero never does.
  if (!fs::is_regular_file(status)) {
    throw Error(ErrorId::FileNotReadable, {"a pipe or device", "a regular file", position});
  }
  if (!std::ifstream(file)) {
    throw Error(ErrorId::FileNotReadable, {"a file that may not be read", "", position});
  }
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), {});
  if (stream.bad()) {
    throw Error(ErrorId::FileNotReadable,
                {"a failure while reading", "", SourcePosition{file.string()}});
  }
  if (text.empty()) throw Error(ErrorId::EmptyFile, {"", "", SourcePosition{file.string()}});
  return text;
}

std::string lower_case_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

// The lines of OpenSCAD's messages that a user must see.
std::vector<Warning> warnings_of(const std::string& messages, const std::string& name) {
  std::vector<Warning> warnings;
  std::istringstream lines(messages);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("WARNING") || line.starts_with("DEPRECATED")) {
      warnings.push_back({"openscad: " + line, SourcePosition{name}});
    }
  }
  return warnings;
}

Model read_source(const fs::path& file, const ReadOptions& options) {
  static_cast<void>(read_text(file));  // an empty file is answered here, not by OpenSCAD
  openscad::FrontEndResult front_end = openscad::run_openscad(file, options.progress);
  std::vector<Warning> warnings = warnings_of(front_end.messages, file.string());
  Model model;
  if (std::all_of(front_end.csg.begin(), front_end.csg.end(),
                  [](unsigned char c) { return std::isspace(c) != 0; })) {
    // The source makes nothing, which is a valid model; as an input .csg it would be an empty file.
    model.name = file.string();
    warnings.push_back({"the model is empty", SourcePosition{file.string()}});
    model.warnings = std::move(warnings);
    model.front_end_messages = std::move(front_end.messages);
    return model;
  }
  try {
    model = read_openscad_csg(front_end.csg, file.string(), options);
  } catch (const Error& error) {
    // Lines are those of the exported text, which the user does not have: keep only the file.
    Error::Details details = error.details();
    if (details.position && details.position->line != 0) {
      details.found += " (line " + std::to_string(details.position->line) + ", column " +
                       std::to_string(details.position->column) + " of its export as .csg)";
      details.position = SourcePosition{file.string()};
    }
    throw Error(error.id(), std::move(details));
  }
  warnings.insert(warnings.end(), std::make_move_iterator(model.warnings.begin()),
                  std::make_move_iterator(model.warnings.end()));
  model.warnings = std::move(warnings);
  model.front_end_messages = std::move(front_end.messages);
  return model;
}

Model read_mesh(const fs::path& file, const ReadOptions& options) {
  PolygonSoup soup = read_polygon_soup(file);
  const SourcePosition position{file.string()};
  Model model;
  model.name = file.string();
  model.rounding_bound = soup.rounding_bound;
  try {
    const InsideRule inside{options.fill,
                            [&](const std::string& text) {
                              model.warnings.push_back({text, position});
                            },
                            options.progress, options.threads};
    model.solid = openscad::solid_of_polyhedron({std::move(soup.vertices), std::move(soup.facets)},
                                                inside, file.string());
  } catch (const Error& error) {
    throw error.at(position);
  }
  model.primitives = 1;
  return model;
}

}  // namespace

Model read_model(const fs::path& file, const ReadOptions& given) {
  check_readable(file);
  ReadOptions options = given;
  if (!options.folder) options.folder = file.parent_path();
  const std::string ending = lower_case_ending(file);
  if (ending == ".csg") return read_openscad_csg(read_text(file), file.string(), options);
  if (ending == ".scad") return read_source(file, options);
  if (ending == ".off" || ending == ".stl" || ending == ".obj" || ending == ".ply") {
    return read_mesh(file, options);
  }
  throw Error(ErrorId::UnknownFormat,
              {ending.empty() ? "a name without an ending" : "'" + ending + "'",
               ".csg, .scad, .off, .stl, .obj or .ply", SourcePosition{file.string()}});
}

}  // namespace exactcsg::io
