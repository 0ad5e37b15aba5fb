// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of OpenSCAD's .nef3: CGAL's text form of a selective Nef complex, with homogeneous
// integers. A reader of our own, because CGAL's trusts the file's indices and aborts on what is
// broken.
#include <fmt/format.h>

#include <sstream>
#include <string_view>

#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/openscad.hpp"

namespace exactcsg::verify {
namespace {

// "index { links | numbers } mark": the links between the objects, and the coordinates if any.
struct Record {
  std::vector<std::string> links;
  std::vector<Integer> numbers;
  bool mark = false;
};

class Lines {
 public:
  explicit Lines(const std::string& text) : in_(text) {}

  std::string next() {
    std::string line;
    if (!std::getline(in_, line)) fail("the end of the file");
    ++number_;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }
  [[noreturn]] void fail(const std::string& found) const {
    throw Error(ErrorId::OracleFailed, {fmt::format("{} in line {} of the .nef3", found, number_),
                                        "a selective Nef complex"});
  }

  std::size_t count(std::string_view name) {
    const std::string line = next();
    std::istringstream words(line);
    std::string word;
    std::size_t value = 0;
    if (!(words >> word >> value) || word != name) fail("'" + line.substr(0, 60) + "'");
    return value;
  }

  Record record() {
    const std::string line = next();
    const auto open = line.find('{');
    const auto close = line.rfind('}');
    if (open == std::string::npos || close == std::string::npos || close < open) {
      fail("'" + line.substr(0, 60) + "'");
    }
    Record record;
    const std::string inside = line.substr(open + 1, close - open - 1);
    const auto bar = inside.find('|');
    std::istringstream links(inside.substr(0, bar));
    for (std::string part; std::getline(links, part, ',');) record.links.push_back(part);
    if (bar != std::string::npos) {
      std::istringstream numbers(inside.substr(bar + 1));
      for (std::string word; numbers >> word;) {
        Integer value;
        if (value.set_str(word, 10) != 0) fail("'" + word.substr(0, 40) + "'");
        record.numbers.push_back(std::move(value));
      }
    }
    record.mark = line.find('1', close) != std::string::npos;
    return record;
  }

  std::vector<std::size_t> indices(const Record& record, std::size_t part, std::size_t limit) {
    if (part >= record.links.size()) fail("a missing link");
    std::vector<std::size_t> result;
    std::istringstream words(record.links[part]);
    for (long long value = 0; words >> value;) {
      if (value < 0 || static_cast<std::size_t>(value) >= limit) {
        fail(fmt::format("index {} of {}", value, limit));
      }
      result.push_back(static_cast<std::size_t>(value));
    }
    return result;
  }
  std::size_t index(const Record& record, std::size_t part, std::size_t limit) {
    const auto all = indices(record, part, limit);
    if (all.empty()) fail("a missing index");
    return all.front();
  }

 private:
  std::istringstream in_;
  std::size_t number_ = 0;
};

struct HalfFacet {
  std::size_t twin = 0;
  std::vector<std::size_t> cycles;  // one spherical half-edge of each
  std::size_t volume = 0;
  std::vector<Integer> plane;
  bool mark = false;
};

Rational quotient(const Integer& numerator, const Integer& denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return value;
}

}  // namespace

FacetComplex parse_nef3(const std::string& text) {
  Lines lines(text);
  if (lines.next() != "Selective Nef Complex") lines.fail("another format");
  if (lines.next() != "standard") lines.fail("an extended kernel");
  const std::size_t vertices = lines.count("vertices");
  const std::size_t halfedges = lines.count("halfedges");
  const std::size_t facets = lines.count("facets");
  const std::size_t volumes = lines.count("volumes");
  const std::size_t shalfedges = lines.count("shalfedges");
  lines.count("shalfloops");
  lines.count("sfaces");

  FacetComplex complex;
  for (std::size_t i = 0; i < vertices; ++i) {
    const Record record = lines.record();
    const auto& n = record.numbers;
    if (n.size() != 4 || n[3] == 0) lines.fail("a vertex without coordinates");
    complex.vertices.push_back({quotient(n[0], n[3]), quotient(n[1], n[3]), quotient(n[2], n[3])});
  }
  std::vector<std::size_t> origin(halfedges);  // the vertex of each half-edge
  for (std::size_t& vertex : origin) vertex = lines.index(lines.record(), 1, vertices);
  std::vector<HalfFacet> half_facets(facets);
  for (HalfFacet& facet : half_facets) {
    Record record = lines.record();
    if (record.numbers.size() != 4) lines.fail("a facet without plane");
    facet.twin = lines.index(record, 0, facets);
    facet.cycles = lines.indices(record, 1, shalfedges);
    facet.volume = lines.index(record, 3, volumes);
    facet.plane = std::move(record.numbers);
    facet.mark = record.mark;
  }
  std::vector<bool> inside(volumes);
  for (std::size_t i = 0; i < volumes; ++i) inside[i] = lines.record().mark;
  std::vector<std::size_t> start(shalfedges);
  std::vector<std::size_t> next(shalfedges);
  for (std::size_t i = 0; i < shalfedges; ++i) {
    const Record record = lines.record();
    start[i] = origin[lines.index(record, 3, halfedges)];
    next[i] = lines.index(record, 6, shalfedges);
  }

  const auto facet_of = [&](const HalfFacet& facet) {
    OracleFacet result;
    const auto& p = facet.plane;
    result.plane = make_plane(Rational(p[0]), Rational(p[1]), Rational(p[2]), Rational(p[3]));
    for (const std::size_t first : facet.cycles) {
      std::vector<std::uint32_t> cycle;
      std::size_t at = first;
      do {
        cycle.push_back(static_cast<std::uint32_t>(start[at]));
        at = next[at];
        if (cycle.size() > shalfedges) lines.fail("a facet whose cycle does not close");
      } while (at != first);
      result.cycles.push_back(std::move(cycle));
    }
    return result;
  };
  for (std::size_t i = 0; i < facets; ++i) {
    const HalfFacet& facet = half_facets[i];
    const bool in_here = inside[facet.volume];
    const bool in_there = inside[half_facets[facet.twin].volume];
    const bool first_of_two = i < facet.twin;
    if (facet.mark && !in_here && !in_there && first_of_two) {
      complex.membranes.push_back(facet_of(facet));
    }
    // The plane of a half-facet is positive towards its volume: the outer one points outward.
    if (!in_here && in_there) complex.facets.push_back(facet_of(facet));
  }
  return complex;
}

}  // namespace exactcsg::verify
