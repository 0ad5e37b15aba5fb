// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/named_files.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "exactcsg/io/mesh/text_scanner.hpp"
#include "exactcsg/io/openscad/tessellation.hpp"

namespace exactcsg::io::openscad {

namespace {

namespace fs = std::filesystem;

std::string lower_case_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return ending;
}

using Heights = std::vector<std::vector<Rational>>;

Heights read_heights(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  TextScanner scanner(text, file.string(), '#');
  CoordinateSurvey survey;
  Heights rows;
  std::size_t count = 0;
  while (!scanner.at_end()) {
    std::vector<Rational>& row = rows.emplace_back();
    while (!scanner.at_line_end()) row.push_back(scanner.coordinate(survey));
    if (row.size() != rows[0].size()) {
      scanner.fail(ErrorId::UnexpectedText, "a row of " + std::to_string(row.size()) + " heights",
                   "as many as in the first row, " + std::to_string(rows[0].size()));
    }
    // Corner, middle and floor.
    count += 3 * row.size();
    if (count > shape_vertex_limit) {
      scanner.fail(ErrorId::TooLarge,
                   "a surface of more than " + std::to_string(count / 3) + " heights", "");
    }
  }
  return rows;
}

// Points on the surface and below it on the floor, row by row, and the middles of the squares.
class HeightField {
 public:
  HeightField(const Heights& heights, bool center)
      : heights_(heights), rows_(heights.size()), columns_(heights[0].size()) {
    if (center) {
      shift_x_ = -Rational(static_cast<unsigned long>(columns_ - 1)) / 2;
      shift_y_ = -Rational(static_cast<unsigned long>(rows_ - 1)) / 2;
    }
  }

  FacedPoints build() {
    Rational floor{0};
    for (const auto& row : heights_) {
      for (const Rational& height : row) floor = std::min(floor, Rational(height - 1));
    }
    for (std::size_t y = 0; y < rows_; ++y) {
      for (std::size_t x = 0; x < columns_; ++x) {
        add_point(x, y, 0, heights_[y][x]);
        add_point(x, y, 0, floor);
      }
    }
    for (std::size_t y = 0; y + 1 < rows_; ++y) {
      for (std::size_t x = 0; x + 1 < columns_; ++x) add_square(x, y);
    }
    for (std::size_t x = 0; x + 1 < columns_; ++x) {
      add_side(at(x, 0), at(x + 1, 0));
      add_side(at(x + 1, rows_ - 1), at(x, rows_ - 1));
    }
    for (std::size_t y = 0; y + 1 < rows_; ++y) {
      add_side(at(0, y + 1), at(0, y));
      add_side(at(columns_ - 1, y), at(columns_ - 1, y + 1));
    }
    add_floor();
    return std::move(result_);
  }

 private:
  std::uint32_t at(std::size_t x, std::size_t y) const {
    return static_cast<std::uint32_t>(2 * (y * columns_ + x));
  }
  static std::uint32_t below(std::uint32_t point) { return point + 1; }

  void add_point(std::size_t x, std::size_t y, const Rational& half, const Rational& z) {
    result_.points.push_back({shift_x_ + static_cast<unsigned long>(x) + half,
                              shift_y_ + static_cast<unsigned long>(y) + half, z});
  }

  void add_square(std::size_t x, std::size_t y) {
    const std::array<std::uint32_t, 4> corners{at(x, y), at(x + 1, y), at(x + 1, y + 1),
                                               at(x, y + 1)};
    const auto middle = static_cast<std::uint32_t>(result_.points.size());
    add_point(
        x, y, Rational(1, 2),
        (heights_[y][x] + heights_[y][x + 1] + heights_[y + 1][x] + heights_[y + 1][x + 1]) / 4);
    for (std::size_t i = 0; i < 4; ++i) {
      result_.faces.push_back({corners[i], corners[(i + 1) % 4], middle});
    }
  }

  // Below an edge that is walked with the surface on its left.
  void add_side(std::uint32_t from, std::uint32_t to) {
    result_.faces.push_back({below(from), below(to), to, from});
  }

  void add_floor() {
    auto& face = result_.faces.emplace_back();
    for (std::size_t y = 0; y + 1 < rows_; ++y) face.push_back(below(at(0, y)));
    for (std::size_t x = 0; x + 1 < columns_; ++x) face.push_back(below(at(x, rows_ - 1)));
    for (std::size_t y = rows_ - 1; y > 0; --y) face.push_back(below(at(columns_ - 1, y)));
    for (std::size_t x = columns_ - 1; x > 0; --x) face.push_back(below(at(x, 0)));
  }

  const Heights& heights_;
  std::size_t rows_;
  std::size_t columns_;
  Rational shift_x_{0};
  Rational shift_y_{0};
  FacedPoints result_;
};

}  // namespace

fs::path NamedFiles::find(const FileShape& shape) const {
  if (!folder_) {
    throw Error(ErrorId::FileNotReadable, {"the name of a file in a text that has no folder",
                                           "a model that is read from a file", shape.position});
  }
  const fs::path file = *folder_ / shape.file;  // an absolute name stays itself
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  const auto refuse = [&](const std::string& found) {
    throw Error(ErrorId::FileNotReadable,
                {found + ": '" + file.string() + "'", "a regular file", shape.position});
  };
  if (!fs::exists(status)) refuse("no file of this name");
  if (!fs::is_regular_file(status)) refuse("no regular file");
  if (!std::ifstream(file)) refuse("a file that may not be read");
  return file;
}

const PolygonSoup& NamedFiles::mesh(const FileShape& shape) {
  const std::string ending = lower_case_ending(shape.file);
  if (ending != ".off" && ending != ".stl" && ending != ".obj") {
    throw Error(ErrorId::UnsupportedNode, {"'import' of a file that ends in '" + ending + "'",
                                           ".off, .stl or .obj", shape.position});
  }
  const fs::path file = find(shape);
  const auto known = meshes_.find(file);
  if (known != meshes_.end()) return known->second;
  return meshes_.emplace(file, read_polygon_soup(file)).first->second;
}

FacedPoints NamedFiles::height_field(const SurfaceShape& shape) const {
  if (lower_case_ending(shape.file.file) == ".png") {
    throw Error(ErrorId::UnsupportedNode,
                {"'surface' of a picture", "a text of heights", shape.file.position});
  }
  const Heights heights = read_heights(find(shape.file));
  if (heights.size() < 2 || heights[0].size() < 2) return {};
  return HeightField(heights, shape.center).build();
}

}  // namespace exactcsg::io::openscad
