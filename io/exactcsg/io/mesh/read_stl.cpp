// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <cmath>
#include <cstring>

#include "exactcsg/io/mesh/mesh_readers.hpp"
#include "exactcsg/io/mesh/text_scanner.hpp"

namespace exactcsg::io {

namespace {

constexpr std::size_t header_bytes = 84;  // 80 of comment, 4 of the number of triangles
constexpr std::size_t triangle_bytes = 50;
constexpr std::size_t normal_bytes = 12;

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return value;
}

PolygonSoup read_binary(std::string_view bytes, const std::string& file) {
  PolygonSoup soup;
  soup.format = MeshFormat::StlBinary;
  CoordinateSurvey survey;
  VertexTable table;
  const std::uint32_t triangles = little_endian(bytes.substr(80));
  for (std::size_t t = 0; t < triangles; ++t) {
    auto& facet = soup.facets.emplace_back();
    std::size_t at = header_bytes + t * triangle_bytes + normal_bytes;
    for (int corner = 0; corner < 3; ++corner) {
      Point3 p;
      for (Rational* const coordinate : {&p.x, &p.y, &p.z}) {
        const float value = std::bit_cast<float>(little_endian(bytes.substr(at)));
        if (!std::isfinite(value)) {
          throw Error(ErrorId::NumberOutOfRange,
                      {"a coordinate that is not finite, in triangle " + std::to_string(t) +
                           " at byte " + std::to_string(at),
                       "a finite coordinate", SourcePosition{file}});
        }
        *coordinate = rational_of(double{value});
        survey.note(*coordinate);
        at += 4;
      }
      facet.push_back(table.number(p, soup.vertices));
    }
  }
  soup.rounding_bound = half_binary_unit(survey.largest, 24);
  return soup;
}

PolygonSoup read_ascii(std::string_view text, const std::string& file) {
  TextScanner scanner(text, file, '\0');
  PolygonSoup soup;
  soup.format = MeshFormat::StlAscii;
  CoordinateSurvey survey;
  VertexTable table;
  do {
    scanner.keyword("solid");
    scanner.skip_line();  // its name
    for (;;) {
      const std::string_view word = scanner.word("facet or endsolid");
      if (equals_ignoring_case(word, "endsolid")) break;
      if (!equals_ignoring_case(word, "facet")) scanner.unexpected(word, "facet or endsolid");
      scanner.keyword("normal");
      for (int i = 0; i < 3; ++i) scanner.skip_number("a normal");
      scanner.keyword("outer");
      scanner.keyword("loop");
      auto& facet = soup.facets.emplace_back();
      for (int corner = 0; corner < 3; ++corner) {
        scanner.keyword("vertex");
        Point3 p;
        for (Rational* const coordinate : {&p.x, &p.y, &p.z}) {
          *coordinate = scanner.coordinate(survey);
        }
        facet.push_back(table.number(p, soup.vertices));
      }
      scanner.keyword("endloop");
      scanner.keyword("endfacet");
    }
    scanner.skip_line();  // its name
  } while (!scanner.at_end());
  soup.rounding_bound = text_rounding_bound(survey);
  return soup;
}

}  // namespace

std::size_t VertexTable::Hash::operator()(const Point3& p) const {
  std::size_t seed = 0;
  for (const Rational* const value : {&p.x, &p.y, &p.z}) {
    // Equal rationals have equal truncated doubles.
    seed = seed * 0x9E3779B97F4A7C15ULL + std::hash<double>()(value->get_d());
    seed ^= seed >> 29U;
  }
  return seed;
}

std::uint32_t VertexTable::number(const Point3& point, std::vector<Point3>& vertices) {
  const auto [at, added] = numbers_.try_emplace(point, static_cast<std::uint32_t>(vertices.size()));
  if (added) vertices.push_back(point);
  return at->second;
}

// A binary file may begin with "solid" too; its length, which follows from its count, tells.
PolygonSoup read_stl(std::string_view bytes, const std::string& file) {
  const bool has_header = bytes.size() >= header_bytes;
  const std::uint64_t announced =
      has_header ? header_bytes + std::uint64_t{triangle_bytes} * little_endian(bytes.substr(80))
                 : 0;
  if (has_header && announced == bytes.size()) return read_binary(bytes, file);
  const bool text = bytes.find('\0') == bytes.npos;
  const std::size_t start = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (text && start != bytes.npos && equals_ignoring_case(bytes.substr(start, 5), "solid")) {
    return read_ascii(bytes, file);
  }
  const Error::Details details{std::to_string(bytes.size()) + " bytes",
                               has_header
                                   ? std::to_string(announced) + " by the number of triangles"
                                   : "84 bytes of header or the word solid",
                               SourcePosition{file}};
  if (!has_header) throw Error(text ? ErrorId::UnknownFormat : ErrorId::TruncatedInput, details);
  throw Error(bytes.size() < announced ? ErrorId::TruncatedInput : ErrorId::UnexpectedText,
              details);
}

}  // namespace exactcsg::io
