// SPDX-License-Identifier: GPL-3.0-or-later

// The Object File Format as Geomview and OpenSCAD write it: the counts may follow OFF on its line,
// comments start with '#', a facet's colour may follow it on its line.

#include "exactcsg/io/mesh/mesh_readers.hpp"
#include "exactcsg/io/mesh/text_scanner.hpp"

namespace exactcsg::io {

namespace {

// "OFF", "COFF", "NOFF", "CNOFF": with C and N, colours and normals follow the coordinates.
bool has_vertex_attributes(TextScanner& scanner) {
  const std::string_view header = scanner.word("OFF");
  if (header == "OFF") return false;
  if (header == "COFF" || header == "NOFF" || header == "CNOFF") return true;
  scanner.fail(ErrorId::UnknownFormat, "a file that does not begin with OFF",
               "OFF, COFF, NOFF or CNOFF");
}

void skip_attributes(TextScanner& scanner) {
  while (!scanner.at_line_end()) scanner.skip_number("a colour or a normal");
}

}  // namespace

PolygonSoup read_off(std::string_view text, const std::string& file) {
  TextScanner scanner(text, file, '#');
  const bool attributes = has_vertex_attributes(scanner);
  if (!scanner.at_end()) {
    TextScanner ahead = scanner;
    if (ahead.word("counts") == "BINARY") {
      ahead.fail(ErrorId::UnknownFormat, "a binary OFF file", "a text OFF file");
    }
  }
  const std::uint64_t vertices = scanner.count("the number of vertices");
  const std::uint64_t facets = scanner.count("the number of facets");
  if (!scanner.at_line_end()) scanner.count("the number of edges");

  PolygonSoup soup;
  soup.format = MeshFormat::Off;
  CoordinateSurvey survey;
  for (std::uint64_t i = 0; i < vertices; ++i) {
    Point3 p;
    for (Rational* const coordinate : {&p.x, &p.y, &p.z}) *coordinate = scanner.coordinate(survey);
    soup.vertices.push_back(std::move(p));
    if (attributes) skip_attributes(scanner);
  }
  for (std::uint64_t i = 0; i < facets; ++i) {
    const std::uint64_t corners = scanner.count("the number of a facet's vertices");
    if (corners < 3) scanner.unexpected(std::to_string(corners), "at least 3 vertices");
    auto& facet = soup.facets.emplace_back();
    for (std::uint64_t k = 0; k < corners; ++k) facet.push_back(scanner.index(vertices));
    skip_attributes(scanner);
  }
  if (!scanner.at_end()) scanner.unexpected(scanner.word(""), "the end of the file");
  soup.rounding_bound = text_rounding_bound(survey);
  return soup;
}

}  // namespace exactcsg::io
