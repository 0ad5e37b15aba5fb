// SPDX-License-Identifier: GPL-3.0-or-later

// Wavefront OBJ: the polygons of "v" and "f". Normals, texture coordinates, groups and materials
// are skipped; free-form curves and surfaces are refused.

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "exactcsg/io/mesh/mesh_readers.hpp"
#include "exactcsg/io/mesh/text_scanner.hpp"

namespace exactcsg::io {

namespace {

constexpr std::array<std::string_view, 11> skipped = {"vn", "vt", "vp",     "g",      "o", "s",
                                                      "l",  "p",  "usemtl", "mtllib", "mg"};

// "7", "7/1", "7//3", "7/1/3", "-1": from 1, or backwards from the last vertex so far.
std::uint32_t corner(TextScanner& scanner, std::size_t vertices) {
  const std::string_view word = scanner.word("a vertex");
  const std::string_view number = word.substr(0, word.find('/'));
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (number.empty() || end != number.data() + number.size() ||
      error == std::errc::invalid_argument ||
      word.find_first_not_of("-+0123456789/") != word.npos) {
    scanner.unexpected(word, "the number of a vertex");
  }
  const auto count = static_cast<std::int64_t>(vertices);
  const std::int64_t index = value < 0 ? count + value : value - 1;
  if (error != std::errc() || index < 0 || index >= count) {
    scanner.fail(ErrorId::UnknownVertex, "vertex " + std::string(number),
                 "one of the " + std::to_string(vertices) + " vertices before it");
  }
  return static_cast<std::uint32_t>(index);
}

[[noreturn]] void line_too_short(const TextScanner& scanner, std::string expected) {
  const bool last = scanner.offset() == scanner.size();
  scanner.fail(last ? ErrorId::TruncatedInput : ErrorId::UnexpectedText, "the end of the line",
               std::move(expected));
}

void read_vertex(TextScanner& scanner, CoordinateSurvey& survey, std::vector<Point3>& vertices) {
  Point3 p;
  for (Rational* const coordinate : {&p.x, &p.y, &p.z}) {
    if (scanner.at_line_end()) line_too_short(scanner, "three coordinates");
    *coordinate = scanner.coordinate(survey);
  }
  // One more number is a weight, three are a colour, four both.
  std::size_t more = 0;
  for (CoordinateSurvey ignored; !scanner.at_line_end(); ++more) {
    const Rational value = scanner.coordinate(ignored);
    const bool only = scanner.at_line_end();
    if (more == 0 && only && value != 1) {
      scanner.fail(ErrorId::UnexpectedText, "a weight of " + to_text(value), "no weight but 1");
    }
  }
  vertices.push_back(std::move(p));
}

}  // namespace

PolygonSoup read_obj(std::string_view text, const std::string& file) {
  TextScanner scanner(text, file, '#');
  PolygonSoup soup;
  soup.format = MeshFormat::Obj;
  CoordinateSurvey survey;
  while (!scanner.at_end()) {
    const std::string_view keyword = scanner.word("");
    if (keyword == "v") {
      read_vertex(scanner, survey, soup.vertices);
    } else if (keyword == "f") {
      auto& facet = soup.facets.emplace_back();
      while (!scanner.at_line_end()) facet.push_back(corner(scanner, soup.vertices.size()));
      if (facet.size() < 3) line_too_short(scanner, "at least three vertices");
    } else if (std::find(skipped.begin(), skipped.end(), keyword) != skipped.end()) {
      scanner.skip_line();
    } else {
      scanner.unexpected(keyword, "v, f or another word of polygon files");
    }
  }
  soup.rounding_bound = text_rounding_bound(survey);
  return soup;
}

}  // namespace exactcsg::io
