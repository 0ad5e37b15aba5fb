// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/shapes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "exactcsg/io/openscad/degree_trigonometry.hpp"

namespace exactcsg::io::openscad {

namespace {

using Names = std::span<const std::string_view>;

// OpenSCAD's least $fa and $fs.
constexpr double least_fineness = 0.01;

double special(const Arguments& arguments, std::string_view name, double fallback) {
  if (!arguments.is_given(name)) return fallback;
  const auto number = arguments.number(name);
  return number ? nearest_double(*number) : std::numeric_limits<double>::quiet_NaN();
}

Fineness read_fineness(const Arguments& arguments) {
  Fineness fineness;
  fineness.fn = special(arguments, "$fn", fineness.fn);
  fineness.fa = special(arguments, "$fa", fineness.fa);
  fineness.fs = special(arguments, "$fs", fineness.fs);
  if (fineness.fa < least_fineness) fineness.fa = least_fineness;
  if (fineness.fs < least_fineness) fineness.fs = least_fineness;
  return fineness;
}

Rational size_or(const Arguments& arguments, std::string_view name, const Rational& fallback) {
  const auto number = arguments.number(name);
  if (!number) return fallback;
  if (*number < 0) arguments.fail(*arguments.find(name), "a number of at least 0");
  return *number;
}

// A radius, or half of the diameter, which goes first as in OpenSCAD.
Rational radius_or(const Arguments& arguments, std::string_view radius, std::string_view diameter,
                   const Rational& fallback) {
  if (arguments.find(diameter) != nullptr) return size_or(arguments, diameter, 0) / 2;
  return size_or(arguments, radius, fallback);
}

template <std::size_t N>
std::array<Rational, N> sizes_or_one(const Arguments& arguments, std::string_view name) {
  std::array<Rational, N> sizes;
  sizes.fill(1);
  if (const auto given = arguments.vector(name, N, true)) {
    for (std::size_t i = 0; i < N; ++i) {
      if ((*given)[i] < 0) arguments.fail(*arguments.find(name), "sizes of at least 0");
      sizes[i] = (*given)[i];
    }
  }
  return sizes;
}

// The index that a list of points is asked for.
std::uint32_t read_index(const Arguments& arguments, const Value& value, std::size_t count) {
  const Rational number = arguments.number_of(value, "the index of a point");
  if (number.get_den() != 1) arguments.fail(value, "the index of a point");
  if (number < 0 || number >= Rational(Integer(static_cast<unsigned long>(count)))) {
    throw Error(ErrorId::UnknownVertex,
                {to_text(number),
                 count == 0 ? "no index, since there are no points"
                            : "an index from 0 to " + std::to_string(count - 1),
                 arguments.position(value)});
  }
  return static_cast<std::uint32_t>(number.get_num().get_ui());
}

std::vector<std::vector<std::uint32_t>> read_index_lists(const Arguments& arguments,
                                                         const Value& value, std::size_t count) {
  std::vector<std::vector<std::uint32_t>> lists;
  for (const std::uint32_t list : arguments.elements(value, "a vector of vectors of indices")) {
    std::vector<std::uint32_t> indices;
    for (const std::uint32_t index :
         arguments.elements(arguments.value(list), "a vector of indices of points")) {
      indices.push_back(read_index(arguments, arguments.value(index), count));
    }
    lists.push_back(std::move(indices));
  }
  return lists;
}

template <std::size_t N>
std::array<Rational, N> read_point(const Arguments& arguments, const Value& value) {
  constexpr std::string_view expected = N == 2 ? "a point [x, y]" : "a point [x, y, z]";
  const std::vector<std::uint32_t> entries = arguments.elements(value, expected);
  if (entries.size() != N) arguments.fail(value, expected);
  std::array<Rational, N> point;
  for (std::size_t i = 0; i < N; ++i) {
    point[i] = arguments.number_of(arguments.value(entries[i]), "a coordinate");
  }
  return point;
}

// The number that exactly `count` hexadecimal digits at the beginning of a text stand for.
std::optional<std::uint32_t> hexadecimal(std::string_view text, std::size_t count) {
  std::uint32_t number = 0;
  const std::string_view digits = text.substr(0, count);
  const auto [end, failure] =
      std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  if (failure != std::errc() || end != digits.data() + count) return std::nullopt;
  return number;
}

// What is no number of a character stands for the one that says so; number 0 is nothing.
void append_utf8(std::string& text, std::uint32_t character) {
  if (character > 0x10ffff || (character >= 0xd800 && character < 0xe000)) character = 0xfffd;
  if (character == 0) return;
  if (character < 0x80) {
    text += static_cast<char>(character);
    return;
  }
  const unsigned following = character < 0x800 ? 1 : character < 0x10000 ? 2 : 3;
  constexpr std::array<std::uint32_t, 4> lead{0, 0xc0, 0xe0, 0xf0};
  text += static_cast<char>(lead[following] | (character >> (6 * following)));
  for (unsigned i = following; i-- > 0;) {
    text += static_cast<char>(0x80U | ((character >> (6 * i)) & 0x3fU));
  }
}

// The text between quotes as OpenSCAD reads it: an unknown escape loses its backslash, and line
// ends that are not escaped are nothing.
std::string unescaped(std::string_view quoted) {
  std::string text;
  for (std::size_t i = 0; i < quoted.size(); ++i) {
    if (quoted[i] == '\n') continue;
    if (quoted[i] != '\\' || i + 1 == quoted.size()) {
      text += quoted[i];
      continue;
    }
    const std::string_view rest = quoted.substr(i + 1);
    constexpr std::string_view escapes = "tnr\"\\";
    constexpr std::string_view meanings = "\t\n\r\"\\";
    const auto escape = escapes.find(rest[0]);
    const std::string_view digits = rest.substr(1);
    if (escape != std::string_view::npos) {
      text += meanings[escape];
      ++i;
    } else if (const auto byte = hexadecimal(digits, 2); rest[0] == 'x' && byte && *byte < 0x80) {
      text += *byte == 0 ? ' ' : static_cast<char>(*byte);
      i += 3;
    } else if (const auto four = hexadecimal(digits, 4); rest[0] == 'u' && four) {
      append_utf8(text, *four);
      i += 5;
    } else if (const auto six = hexadecimal(digits, 6); rest[0] == 'U' && six) {
      append_utf8(text, *six);
      i += 7;
    }
  }
  return text;
}

// Text of an argument that may be missing.
std::string text_or(const Arguments& arguments, std::string_view name, std::string_view fallback) {
  const Value* const value = arguments.find(name);
  if (value == nullptr) return std::string(fallback);
  if (value->kind != Value::Kind::Text) arguments.fail(*value, "a text in quotes");
  return unescaped(value->text);
}

// As OpenSCAD: a word that is none of these counts as the first of them.
template <class Alignment, std::size_t N>
Alignment alignment_of(const Arguments& arguments, std::string_view name,
                       const std::array<std::pair<std::string_view, Alignment>, N>& words) {
  const std::string given = text_or(arguments, name, words[0].first);
  for (const auto& [word, alignment] : words) {
    if (given == word) return alignment;
  }
  arguments.warnings().add(std::string(name) + " = '" + given + "' is not known: '" +
                               std::string(words[0].first) + "' counts, as in OpenSCAD",
                           arguments.position(*arguments.find(name)));
  return words[0].second;
}

FileShape file_of(const Arguments& arguments) {
  constexpr std::string_view expected = "the name of a file, in quotes";
  const Value* const value = arguments.find("file");
  if (value == nullptr) {
    throw Error(ErrorId::BadArgument,
                {"no file", std::string(expected), arguments.node_position()});
  }
  if (value->kind != Value::Kind::Text || value->text.empty()) arguments.fail(*value, expected);
  return {unescaped(value->text), arguments.position(*value)};
}

}  // namespace

BoxShape read_cube(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"size", "center"};
  const Arguments arguments(tree, node, names, 2, warnings);
  return {sizes_or_one<3>(arguments, "size"), arguments.boolean("center").value_or(false)};
}

SphereShape read_sphere(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"r", "d", "$fn", "$fa", "$fs"};
  const Arguments arguments(tree, node, names, 1, warnings);
  return {radius_or(arguments, "r", "d", 1), read_fineness(arguments)};
}

CylinderShape read_cylinder(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"h",  "r1", "r2",  "center", "r",  "d",
                                               "d1", "d2", "$fn", "$fa",    "$fs"};
  const Arguments arguments(tree, node, names, 4, warnings);
  const Rational both = radius_or(arguments, "r", "d", 1);
  CylinderShape shape;
  shape.height = size_or(arguments, "h", 1);
  shape.lower_radius = radius_or(arguments, "r1", "d1", both);
  shape.upper_radius = radius_or(arguments, "r2", "d2", both);
  shape.center = arguments.boolean("center").value_or(false);
  shape.fineness = read_fineness(arguments);
  return shape;
}

FacedPoints read_polyhedron(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"points", "faces", "convexity", "triangles"};
  const Arguments arguments(tree, node, names, 3, warnings);
  const Value* const points = arguments.find("points");
  const Value* faces = arguments.find("faces");
  if (faces == nullptr) faces = arguments.find("triangles");  // its name until 2014
  if (points == nullptr || faces == nullptr) {
    throw Error(ErrorId::BadArgument,
                {points == nullptr ? "no points" : "no faces",
                 "a vector of points and a vector of faces", arguments.node_position()});
  }
  FacedPoints result;
  for (const std::uint32_t index : arguments.elements(*points, "a vector of points")) {
    auto [x, y, z] = read_point<3>(arguments, arguments.value(index));
    result.points.push_back({std::move(x), std::move(y), std::move(z)});
  }
  result.faces = read_index_lists(arguments, *faces, result.points.size());
  // OpenSCAD lists vertices clockwise as seen from outside.
  for (auto& face : result.faces) face = {face.rbegin(), face.rend()};
  return result;
}

SquareShape read_square(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"size", "center"};
  const Arguments arguments(tree, node, names, 2, warnings);
  return {sizes_or_one<2>(arguments, "size"), arguments.boolean("center").value_or(false)};
}

CircleShape read_circle(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"r", "d", "$fn", "$fa", "$fs"};
  const Arguments arguments(tree, node, names, 1, warnings);
  return {radius_or(arguments, "r", "d", 1), read_fineness(arguments)};
}

PlanarFigure read_polygon(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"points", "paths", "convexity"};
  const Arguments arguments(tree, node, names, 3, warnings);
  PlanarFigure figure;
  const Value* const points = arguments.find("points");
  if (points == nullptr) return figure;
  std::vector<Point2> vertices;
  for (const std::uint32_t index : arguments.elements(*points, "a vector of points")) {
    auto [x, y] = read_point<2>(arguments, arguments.value(index));
    vertices.push_back({std::move(x), std::move(y)});
  }
  const Value* const paths = arguments.find("paths");
  if (paths == nullptr) {
    figure.paths.push_back(std::move(vertices));
    return figure;
  }
  for (const auto& indices : read_index_lists(arguments, *paths, vertices.size())) {
    std::vector<Point2>& path = figure.paths.emplace_back();
    for (const std::uint32_t index : indices) path.push_back(vertices[index]);
  }
  return figure;
}

TextShape read_text(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"text",    "size",     "font",   "direction",
                                               "spacing", "language", "script", "halign",
                                               "valign",  "$fn",      "$fa",    "$fs"};
  const Arguments arguments(tree, node, names, 3, warnings);
  TextShape shape;
  shape.text = text_or(arguments, "text", "");
  if (const auto size = arguments.number("size")) shape.size = nearest_double(*size);
  if (const auto spacing = arguments.number("spacing")) shape.spacing = nearest_double(*spacing);
  shape.font = text_or(arguments, "font", "");
  shape.direction = text_or(arguments, "direction", "");
  shape.language = text_or(arguments, "language", shape.language);
  shape.script = text_or(arguments, "script", "");
  using enum HorizontalAlignment;
  shape.horizontal = alignment_of<HorizontalAlignment, 3>(
      arguments, "halign", {{{"left", Left}, {"center", Center}, {"right", Right}}});
  shape.vertical = alignment_of<VerticalAlignment, 4>(arguments, "valign",
                                                      {{{"baseline", VerticalAlignment::Baseline},
                                                        {"bottom", VerticalAlignment::Bottom},
                                                        {"center", VerticalAlignment::Center},
                                                        {"top", VerticalAlignment::Top}}});
  shape.fineness = read_fineness(arguments);
  return shape;
}

LinearExtrudeShape read_linear_extrude(const SyntaxTree& tree, std::uint32_t node,
                                       Warnings& warnings) {
  static constexpr std::string_view names[] = {"height", "center", "convexity", "twist",
                                               "slices", "scale",  "$fn",       "$fa",
                                               "$fs",    "v",      "segments",  "file"};
  const Arguments arguments(tree, node, names, 1, warnings);
  for (const std::string_view name : {"v", "segments", "file"}) {
    if (const Value* const value = arguments.find(name)) {
      throw Error(ErrorId::UnsupportedNode, {"linear_extrude with '" + std::string(name) + "'", "",
                                             arguments.position(*value)});
    }
  }
  LinearExtrudeShape shape;
  shape.height = size_or(arguments, "height", 100);
  shape.center = arguments.boolean("center").value_or(false);
  shape.twist = arguments.number("twist").value_or(0);
  shape.scale = sizes_or_one<2>(arguments, "scale");
  if (const auto slices = arguments.number("slices")) {
    if (*slices > Rational(static_cast<unsigned long>(shape_vertex_limit))) {
      throw Error(ErrorId::TooLarge,
                  {"slices = " + to_text(*slices), "at most " + std::to_string(shape_vertex_limit),
                   arguments.position(*arguments.find("slices"))});
    }
    // Cut to an integer, at least 1.
    shape.slices = *slices < 1 ? 1 : Integer(slices->get_num() / slices->get_den()).get_ui();
  }
  shape.fineness = read_fineness(arguments);
  return shape;
}

RotateExtrudeShape read_rotate_extrude(const SyntaxTree& tree, std::uint32_t node,
                                       Warnings& warnings) {
  static constexpr std::string_view names[] = {"angle", "convexity", "start", "$fn",
                                               "$fa",   "$fs",       "file"};
  const Arguments arguments(tree, node, names, 1, warnings);
  if (const Value* const value = arguments.find("file")) {
    throw Error(ErrorId::UnsupportedNode,
                {"rotate_extrude with 'file'", "", arguments.position(*value)});
  }
  RotateExtrudeShape shape;
  shape.angle = arguments.number("angle").value_or(360);
  if (shape.angle <= -360 || shape.angle > 360) shape.angle = 360;
  shape.start = arguments.number("start");
  shape.fineness = read_fineness(arguments);
  return shape;
}

OffsetShape read_offset(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"r", "delta", "chamfer", "$fn", "$fa", "$fs"};
  const Arguments arguments(tree, node, names, 1, warnings);
  OffsetShape shape;
  shape.fineness = read_fineness(arguments);
  const bool chamfer = arguments.boolean("chamfer").value_or(false);
  const auto delta = arguments.number("delta");
  shape.distance = arguments.number("r").value_or(1);
  // A radius goes first.
  if (delta && arguments.find("r") == nullptr) {
    shape.distance = *delta;
    shape.corner = chamfer ? OffsetCorner::Chamfer : OffsetCorner::Sharp;
  }
  return shape;
}

double arc_tolerance(const OffsetShape& shape) {
  const double radius = std::fabs(nearest_double(shape.distance));
  const auto n = static_cast<double>(fragments(radius, shape.fineness));
  return radius * (1 - cosine_of_degrees(180 / n));
}

bool read_projection_cut(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"cut", "convexity"};
  return Arguments(tree, node, names, 1, warnings).boolean("cut").value_or(false);
}

ResizeShape read_resize(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"newsize", "auto", "convexity"};
  const Arguments arguments(tree, node, names, 2, warnings);
  ResizeShape shape;
  if (const Value* const sizes = arguments.find("newsize")) {
    constexpr std::string_view expected = "a vector of at most 3 sizes of at least 0";
    const auto indices = arguments.elements(*sizes, expected);
    if (indices.size() > 3) arguments.fail(*sizes, expected);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const Value& size = arguments.value(indices[i]);
      shape.size[i] = arguments.number_of(size, expected);
      // OpenSCAD mirrors some bodies and ignores the size of others.
      if (shape.size[i] < 0) arguments.fail(size, expected);
    }
  }
  const auto flag = [&](const Value& value) {
    if (value.kind == Value::Kind::Boolean) return value.boolean;
    return arguments.number_of(value, "true or false") != 0;
  };
  if (const Value* const automatic = arguments.find("auto")) {
    if (automatic->kind != Value::Kind::Vector) {
      shape.automatic.fill(flag(*automatic));
      return shape;
    }
    const auto indices = arguments.elements(*automatic, "a vector of truth values");
    for (std::size_t i = 0; i < std::min<std::size_t>(indices.size(), 3); ++i) {
      shape.automatic[i] = flag(arguments.value(indices[i]));
    }
  }
  return shape;
}

FileShape read_import(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"file",  "layer",  "convexity", "origin",
                                               "scale", "center", "dpi",       "id",
                                               "$fn",   "$fa",    "$fs",       "timestamp"};
  return file_of(Arguments(tree, node, names, 1, warnings));
}

SurfaceShape read_surface(const SyntaxTree& tree, std::uint32_t node, Warnings& warnings) {
  static constexpr std::string_view names[] = {"file",   "center",    "convexity",
                                               "invert", "timestamp", "color"};
  const Arguments arguments(tree, node, names, 3, warnings);
  return {file_of(arguments), arguments.boolean("center").value_or(false)};
}

std::optional<AffineMap> read_multmatrix(const SyntaxTree& tree, std::uint32_t node,
                                         Warnings& warnings) {
  static constexpr std::string_view names[] = {"m"};
  const Arguments arguments(tree, node, names, 1, warnings);
  std::array<std::array<Rational, 4>, 4> rows;
  for (std::size_t i = 0; i < 4; ++i) rows[i][i] = 1;
  const Value* const matrix = arguments.find("m");
  if (matrix != nullptr) {
    constexpr std::string_view expected = "a matrix of at most 4 rows of at most 4 numbers";
    const auto row_values = arguments.elements(*matrix, expected);
    if (row_values.size() > 4) arguments.fail(*matrix, expected);
    for (std::size_t i = 0; i < row_values.size(); ++i) {
      const Value& row = arguments.value(row_values[i]);
      const auto entries = arguments.elements(row, expected);
      if (entries.size() > 4) arguments.fail(row, expected);
      for (std::size_t k = 0; k < entries.size(); ++k) {
        const Value& entry = arguments.value(entries[k]);
        // nan and inf: OpenSCAD drops the object.
        if (entry.kind == Value::Kind::Undefined) {
          warnings.add("the matrix has an entry that is no number: the object is removed",
                       arguments.position(entry));
          return std::nullopt;
        }
        rows[i][k] = arguments.number_of(entry, "a number");
      }
    }
  }
  if (rows[3][3] == 0) {
    warnings.add("the matrix's last entry is zero: the object is removed",
                 arguments.node_position());
    return std::nullopt;
  }
  if (rows[3][0] != 0 || rows[3][1] != 0 || rows[3][2] != 0) {
    warnings.add("the matrix's last row is not [0, 0, 0, w]: only w counts, as in OpenSCAD",
                 arguments.node_position());
  }
  AffineMap map;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      map.m[i][k] = std::move(rows[i][k]);
      if (rows[3][3] != 1) map.m[i][k] /= rows[3][3];
    }
  }
  return map;
}

}  // namespace exactcsg::io::openscad
