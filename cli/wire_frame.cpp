// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/wire_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <pugixml.hpp>
#include <sstream>

namespace exactcsg::cli {

namespace {

// The directions in space that a view draws to the right and upwards.
struct View {
  const char* name;
  std::array<double, 3> right;
  std::array<double, 3> up;
};

// The axonometric view looks along (-1, -1, -1): isometric.
constexpr std::array<View, 4> views{
    {{"front", {1, 0, 0}, {0, 0, 1}},
     {"right", {0, 1, 0}, {0, 0, 1}},
     {"top", {1, 0, 0}, {0, 1, 0}},
     {"axonometric",
      {-0.70710678118654752, 0.70710678118654752, 0},
      {-0.40824829046386302, -0.40824829046386302, 0.81649658092772603}}}};
constexpr double panel = 480;  // pixels
constexpr double margin = 24;

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct Range {
  double lower = 0;
  double upper = 0;
  double middle() const { return lower / 2 + upper / 2; }
  double width() const { return upper - lower; }
};

Range range(const Boundary& boundary, const std::array<double, 3>& direction) {
  Range result;
  bool first = true;
  for (const auto& vertex : boundary.approximate) {
    const double value = dot(vertex, direction);
    result = first ? Range{value, value}
                   : Range{std::min(result.lower, value), std::max(result.upper, value)};
    first = false;
  }
  return result;
}

}  // namespace

std::string wire_frame_svg(const Boundary& boundary, const std::string& title) {
  double widest = 0;
  for (const View& view : views) {
    widest =
        std::max({widest, range(boundary, view.right).width(), range(boundary, view.up).width()});
  }
  const double scale = widest > 0 ? (panel - 2 * margin) / widest : 1;

  pugi::xml_document document;
  pugi::xml_node svg = document.append_child("svg");
  svg.append_attribute("xmlns") = "http://www.w3.org/2000/svg";
  svg.append_attribute("viewBox") = fmt::format("0 0 {0} {0}", 2 * panel).c_str();
  svg.append_child("title").text() = title.c_str();
  pugi::xml_node background = svg.append_child("rect");
  background.append_attribute("width") = "100%";
  background.append_attribute("height") = "100%";
  background.append_attribute("fill") = "white";
  for (std::size_t i = 0; i < views.size(); ++i) {
    const View& view = views[i];
    const double left = static_cast<double>(i % 2) * panel;
    const double top = static_cast<double>(i / 2) * panel;
    const double x0 = left + panel / 2 - scale * range(boundary, view.right).middle();
    const double y0 = top + panel / 2 + scale * range(boundary, view.up).middle();
    std::string path;
    for (const BoundaryEdge& edge : boundary.edges) {
      const auto& a = boundary.approximate[edge.from];
      const auto& b = boundary.approximate[edge.to];
      fmt::format_to(std::back_inserter(path), "M{:.2f} {:.2f}L{:.2f} {:.2f}",
                     x0 + scale * dot(a, view.right), y0 - scale * dot(a, view.up),
                     x0 + scale * dot(b, view.right), y0 - scale * dot(b, view.up));
    }
    pugi::xml_node label = svg.append_child("text");
    label.append_attribute("x") = left + margin / 2;
    label.append_attribute("y") = top + margin;
    label.append_attribute("font-family") = "sans-serif";
    label.append_attribute("font-size") = 14;
    label.text() = view.name;
    pugi::xml_node lines = svg.append_child("path");
    lines.append_attribute("d") = path.c_str();
    lines.append_attribute("fill") = "none";
    lines.append_attribute("stroke") = "black";
    lines.append_attribute("stroke-width") = "0.8";
    lines.append_attribute("stroke-linecap") = "round";
  }
  std::ostringstream text;
  document.save(text, " ");
  return text.str();
}

}  // namespace exactcsg::cli
