// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/membranes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exactcsg/verify/plain_vector.hpp"

namespace exactcsg::verify {
namespace {

using Facet = std::vector<std::uint32_t>;

class Membrane {
 public:
  Membrane(const FacetComplex& complex, const OracleFacet& facet) {
    for (const auto& cycle : facet.cycles) {
      std::vector<PlainVector> outline;
      for (const std::uint32_t v : cycle) {
        vertices_.push_back(complex.vertices[v]);
        outline.push_back(approximate(complex.vertices[v]));
        positions_.push_back(outline.back());
      }
      outlines_.push_back(std::move(outline));
    }
    for (const auto& outline : outlines_) {
      for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
        area_vector_ =
            area_vector_ + 0.5 * cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
      }
    }
  }

  bool holds(const WeldedMesh& mesh, const Facet& facet) const {
    const bool corners = std::all_of(facet.begin(), facet.end(),
                                     [&](std::uint32_t v) { return is_vertex(mesh, v); });
    if (!corners) return false;
    PlainVector middle{0, 0, 0};
    for (const std::uint32_t v : facet) middle = middle + mesh.positions[v];
    middle = (1 / static_cast<double>(facet.size())) * middle;
    return inside(middle) || near_outline(middle, 2 * largest_displacement(mesh, facet));
  }

  double area() const { return length(area_vector_); }
  const std::vector<PlainVector>& positions() const { return positions_; }

 private:
  bool is_vertex(const WeldedMesh& mesh, std::uint32_t v) const {
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (length(positions_[i] - mesh.positions[v]) > 2 * mesh.displacement[v]) continue;
      if (may_stand_for(mesh, v, vertices_[i])) return true;
    }
    return false;
  }

  bool inside(const PlainVector& p) const {
    const std::size_t drop = longest_axis(area_vector_);
    bool result = false;
    for (const auto& outline : outlines_) {
      result ^= crosses_oddly(
          drop, p, outline.size(), [&](std::size_t i) -> const auto& { return outline[i]; });
    }
    return result;
  }

  bool near_outline(const PlainVector& p, double reach) const {
    for (const auto& outline : outlines_) {
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const PlainVector& next = outline[(i + 1) % outline.size()];
        if (nearest_on_segment(outline[i], next, p).distance <= reach) return true;
      }
    }
    return false;
  }

  std::vector<Point3> vertices_;
  std::vector<PlainVector> positions_;
  std::vector<std::vector<PlainVector>> outlines_;
  PlainVector area_vector_{0, 0, 0};
};

// What was found of one membrane.
struct Cover {
  double area = 0;
  PlainVector sum{0, 0, 0};
  double slack = 0;

  void add(const WeldedMesh& mesh, const Facet& facet) {
    const PlainVector vector = area_vector(mesh, facet);
    area += length(vector);
    sum = sum + vector;
    slack += area_slack(mesh, facet);
  }
  bool covers_both_sides(const Membrane& membrane) const {
    const double bound = slack + 1e-12 * area;
    return std::fabs(area - 2 * membrane.area()) <= bound && length(sum) <= bound;
  }
};

}  // namespace

Check take_out_membranes(const FacetComplex& complex, WeldedMesh& mesh, const std::string& label) {
  Check check;
  check.name = label + ": membranes";
  std::vector<Membrane> membranes;
  for (const OracleFacet& facet : complex.membranes) membranes.emplace_back(complex, facet);
  std::vector<Cover> covers(membranes.size());
  std::vector<Facet> kept;
  std::size_t taken = 0;
  for (Facet& facet : mesh.facets) {
    const auto found =
        std::find_if(membranes.begin(), membranes.end(),
                     [&](const Membrane& membrane) { return membrane.holds(mesh, facet); });
    if (found == membranes.end()) {
      kept.push_back(std::move(facet));
    } else {
      covers[static_cast<std::size_t>(found - membranes.begin())].add(mesh, facet);
      ++taken;
    }
  }
  mesh.facets = std::move(kept);
  count_edges(mesh);

  double expected = 0;
  double area = 0;
  double slack = 0;
  for (std::size_t i = 0; i < membranes.size(); ++i) {
    expected += 2 * membranes[i].area();
    area += covers[i].area;
    slack += covers[i].slack;
    if (covers[i].covers_both_sides(membranes[i])) continue;
    add_mismatch(check, {"a membrane that the file does not cover once from either side",
                         membranes[i].positions()});
  }
  check.ours = fmt::format("{} of area {:.6g}", membranes.size(), expected);
  check.theirs = fmt::format("{} facets of {:.6g}", taken, area);
  check.difference = fmt::format("{:.3g}", area - expected);
  check.bound = fmt::format("{:.3g}", slack);
  check.explanation =
      "OpenSCAD's membranes without thickness, as its .nef3 has them, left out of the checks below";
  return check;
}

}  // namespace exactcsg::verify
