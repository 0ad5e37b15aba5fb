// SPDX-License-Identifier: GPL-3.0-or-later

// Why not OpenMesh's writers: OFF and OBJ go through float whatever precision is asked for, and PLY
// needs one of OpenMesh's own mesh kernels (docs/decisions/0021-mesh-files.md).

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>
#include <vector>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io {

namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Coordinates = std::array<double, 3>;

void append_point(std::string& text, const Coordinates& p) {
  fmt::format_to(std::back_inserter(text), "{:.17g} {:.17g} {:.17g}\n", p[0], p[1], p[2]);
}

std::string off(const RoundedSurface& surface) {
  std::string text = fmt::format("OFF\n{} {} 0\n", surface.points.size(), surface.triangles.size());
  for (const Coordinates& p : surface.points) append_point(text, p);
  for (const auto& [a, b, c] : surface.triangles) {
    fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", a, b, c);
  }
  return text;
}

std::string obj(const RoundedSurface& surface) {
  std::string text;
  for (const Coordinates& p : surface.points) {
    text += "v ";
    append_point(text, p);
  }
  for (const auto& [a, b, c] : surface.triangles) {
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

std::string ply(const RoundedSurface& surface) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      surface.points.size(), surface.triangles.size());
  for (const Coordinates& p : surface.points) append_point(text, p);
  for (const auto& [a, b, c] : surface.triangles) {
    fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", a, b, c);
  }
  return text;
}

void append_bits(std::string& bytes, std::uint32_t value) {
  for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFFU);
}
void append_float(std::string& bytes, double value) {
  append_bits(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

Coordinates unit_normal(const Coordinates& a, const Coordinates& b, const Coordinates& c) {
  Coordinates u;
  Coordinates v;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i];
    v[i] = c[i] - a[i];
  }
  Coordinates n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  for (double& component : n) component = length > 0 ? component / length : 0;
  return n;
}

// Not beginning with "solid", so that nobody takes it for text.
std::string binary_stl(const RoundedSurface& surface) {
  std::string bytes = "exactcsg binary STL";
  bytes.resize(80, ' ');
  append_bits(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
  for (const auto& triangle : surface.triangles) {
    const auto& [a, b, c] = triangle;
    for (const double n : unit_normal(surface.points[a], surface.points[b], surface.points[c])) {
      append_float(bytes, n);
    }
    for (const std::uint32_t v : triangle) {
      for (const double value : surface.points[v]) append_float(bytes, value);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

struct Format {
  std::string_view ending;
  std::string (*write)(const RoundedSurface&);
  bool single_precision;
};
constexpr std::array<Format, 4> formats = {
    {{".off", off, false}, {".stl", binary_stl, true}, {".obj", obj, false}, {".ply", ply, false}}};

const Format& format_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const Format& format : formats) {
    if (ending == format.ending) return format;
  }
  throw Error(ErrorId::UnknownFormat, {"the ending \"" + ending + "\"", ".off, .stl, .obj or .ply",
                                       SourcePosition{file.string()}});
}

// The points as the format will hold them. Single precision rounds the double: twice rounded, so
// the report says what became of the exact coordinate.
std::vector<Coordinates> rounded_points(const Boundary& boundary, bool single_precision,
                                        WriteReport& report) {
  std::vector<Coordinates> points = boundary.approximate;
  Rational largest = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Point3& exact = boundary.vertices[v];
    const std::array<const Rational*, 3> coordinates{&exact.x, &exact.y, &exact.z};
    for (std::size_t i = 0; i < 3; ++i) {
      double& value = points[v][i];
      const double limit = single_precision ? double{std::numeric_limits<float>::max()}
                                            : std::numeric_limits<double>::max();
      if (!(std::abs(value) <= limit)) {
        throw Error(ErrorId::NumberOutOfRange,
                    {"the coordinate " + to_text(*coordinates[i]), "what the format can hold"});
      }
      if (single_precision) value = double{static_cast<float>(value)};
      const Rational error = abs(rational_of(value) - *coordinates[i]);
      if (error > largest) largest = error;
    }
  }
  report.largest_rounding = nearest_double(largest);
  return points;
}

std::size_t merged_vertices(std::vector<Coordinates> points) {
  std::sort(points.begin(), points.end());
  const auto distinct = std::unique(points.begin(), points.end());
  return static_cast<std::size_t>(points.end() - distinct);
}

bool is_degenerate(const Coordinates& a, const Coordinates& b, const Coordinates& c) {
  // Doubles often have no area where the exact points have some; decided exactly, but only where
  // the doubles come out small.
  Coordinates u;
  Coordinates v;
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i];
    v[i] = c[i] - a[i];
    size = std::max({size, std::abs(u[i]), std::abs(v[i])});
  }
  const Coordinates n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]};
  // Differences are correctly rounded, so each component is off by at most about 8 u size^2.
  const double bound = 1e-14 * size * size;
  if (std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}) > bound && bound > 1e-290) {
    return false;
  }
  const auto exact = [](const Coordinates& p) {
    return Point3{rational_of(p[0]), rational_of(p[1]), rational_of(p[2])};
  };
  const Point3 origin = exact(a);
  return cross(exact(b) - origin, exact(c) - origin) == Vector3{0, 0, 0};
}

}  // namespace

WriteReport write_boundary(const Boundary& boundary, const std::filesystem::path& file) {
  const Format& format = format_of(file);
  WriteReport report;
  const Triangles triangles = triangulate(boundary);
  report.triangles = triangles.size();
  const auto points = rounded_points(boundary, format.single_precision, report);
  report.merged_vertices = merged_vertices(points);
  for (const auto& [a, b, c] : triangles) {
    if (is_degenerate(points[a], points[b], points[c])) ++report.degenerate_triangles;
  }
  write_surface({points, triangles}, file);
  return report;
}

bool is_single_precision(const std::filesystem::path& file) {
  return format_of(file).single_precision;
}

void write_surface(const RoundedSurface& surface, const std::filesystem::path& file) {
  const std::string bytes = format_of(file).write(surface);
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) {
    throw Error(ErrorId::FileNotWritable,
                {"an error when writing", "", SourcePosition{file.string()}});
  }
}

}  // namespace exactcsg::io
