// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/welded_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace exactcsg::verify {
namespace {

constexpr int single_precision_bits = 24;
constexpr int double_precision_bits = 53;
constexpr int fewest_digits = 6;     // what OpenSCAD and many others print
constexpr int most_digits = 17;      // what a double needs
constexpr int digits_of_single = 9;  // a file with more digits did not pass single precision

// Half a unit in the last place of a binary format, at the value.
double half_binary_unit(double value, int bits) {
  if (value == 0) return 0;
  return std::ldexp(1.0, std::ilogb(value) - bits);
}

double half_decimal_unit(double value, int digits) {
  if (value == 0) return 0;
  const int decade = static_cast<int>(std::floor(std::log10(std::fabs(value))));
  return 0.5 * std::pow(10.0, decade - digits + 1);
}

// Significant decimal digits of the exact value; most_digits if it is no short decimal.
int significant_digits(const Rational& value) {
  Integer denominator = value.get_den();
  Integer scale = 1;
  for (int i = 0; i <= 2 * most_digits; ++i) {
    if (mpz_divisible_p(scale.get_mpz_t(), denominator.get_mpz_t()) != 0) {
      Integer digits = abs(value.get_num()) * (scale / denominator);
      while (digits != 0 && digits % 10 == 0) digits /= 10;
      const std::size_t count = digits == 0 ? 1 : digits.get_str().size();
      return static_cast<int>(std::min<std::size_t>(count, most_digits));
    }
    scale *= 10;
  }
  return most_digits;
}

bool is_single(const Rational& value) {
  const double nearest = nearest_double(value);
  return rational_of(nearest) == value &&
         static_cast<double>(static_cast<float>(nearest)) == nearest;
}

struct FormatPrecision {
  bool binary_single = false;
  int digits = fewest_digits;
};

FormatPrecision precision_of(const io::PolygonSoup& soup) {
  FormatPrecision precision;
  if (soup.format == io::MeshFormat::StlBinary) {
    precision.binary_single = true;
    return precision;
  }
  bool all_single = true;
  for (const Point3& p : soup.vertices) {
    for (const Rational* c : {&p.x, &p.y, &p.z}) {
      precision.digits = std::max(precision.digits, significant_digits(*c));
      all_single = all_single && is_single(*c);
    }
  }
  // PLY may hold binary single precision, whose decimals are long.
  precision.binary_single =
      soup.format == io::MeshFormat::Ply && all_single && precision.digits > digits_of_single;
  return precision;
}

double rounding_at(double value, const FormatPrecision& precision) {
  if (precision.binary_single) return half_binary_unit(value, single_precision_bits);
  // Text is printed from a double, or from a single-precision number (OpenSCAD does both).
  const int bits =
      precision.digits <= digits_of_single ? single_precision_bits : double_precision_bits;
  return half_decimal_unit(value, precision.digits) + half_binary_unit(value, bits);
}

std::uint32_t weld_vertex(const Point3& p, WeldedMesh& mesh,
                          std::map<std::array<Rational, 3>, std::uint32_t>& known) {
  const auto [found, added] =
      known.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(mesh.points.size()));
  if (added) {
    mesh.points.push_back(p);
    mesh.positions.push_back({nearest_double(p.x), nearest_double(p.y), nearest_double(p.z)});
  }
  return found->second;
}

std::vector<std::uint32_t> without_repetitions(const std::vector<std::uint32_t>& corners) {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t v : corners) {
    if (result.empty() || result.back() != v) result.push_back(v);
  }
  while (result.size() > 1 && result.front() == result.back()) result.pop_back();
  return result;
}

// Vertices of unbalanced edges that lie within rounding on another unbalanced edge are put into it.
bool close_junctions(WeldedMesh& mesh) {
  std::vector<MeshEdge> open;
  std::set<std::uint32_t> ends;
  for (const auto& [edge, use] : mesh.edges) {
    if (use.forward.size() == use.backward.size()) continue;
    open.push_back(edge);
    ends.insert(edge.begin(), edge.end());
  }
  constexpr std::size_t too_many = 20'000;  // not junctions but another solid: quadratic search
  if (open.empty() || open.size() > too_many) return false;
  std::map<MeshEdge, std::vector<std::pair<double, std::uint32_t>>> inserted;
  for (const MeshEdge& edge : open) {
    const PlainVector& a = mesh.positions[edge[0]];
    const PlainVector& b = mesh.positions[edge[1]];
    const double slack = std::max(mesh.displacement[edge[0]], mesh.displacement[edge[1]]);
    for (const std::uint32_t v : ends) {
      if (v == edge[0] || v == edge[1]) continue;
      const Nearest near = nearest_on_segment(a, b, mesh.positions[v]);
      if (near.distance <= slack + mesh.displacement[v] && near.parameter > 0 &&
          near.parameter < 1) {
        inserted[edge].push_back({near.parameter, v});
      }
    }
  }
  if (inserted.empty()) return false;
  for (auto& facet : mesh.facets) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const std::uint32_t a = facet[i];
      const std::uint32_t b = facet[(i + 1) % facet.size()];
      corners.push_back(a);
      const auto found = inserted.find({std::min(a, b), std::max(a, b)});
      if (found == inserted.end()) continue;
      auto between = found->second;
      std::sort(between.begin(), between.end());
      if (a > b) std::reverse(between.begin(), between.end());
      for (const auto& [parameter, v] : between) {
        // A corner of the facet itself must not occur twice.
        if (std::find(facet.begin(), facet.end(), v) != facet.end()) continue;
        corners.push_back(v);
        ++mesh.junctions;
      }
    }
    facet = std::move(corners);
  }
  return true;
}

double perimeter(const WeldedMesh& mesh, const std::vector<std::uint32_t>& facet) {
  double sum = 0;
  for (std::size_t i = 0; i < facet.size(); ++i) {
    sum += length(mesh.positions[facet[(i + 1) % facet.size()]] - mesh.positions[facet[i]]);
  }
  return sum;
}

}  // namespace

void count_edges(WeldedMesh& mesh) {
  mesh.edges.clear();
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto& facet = mesh.facets[f];
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const std::uint32_t a = facet[i];
      const std::uint32_t b = facet[(i + 1) % facet.size()];
      EdgeUse& use = mesh.edges[{std::min(a, b), std::max(a, b)}];
      (a < b ? use.forward : use.backward).push_back(static_cast<std::uint32_t>(f));
    }
  }
}

std::vector<std::array<double, 3>> format_rounding(const io::PolygonSoup& soup) {
  const FormatPrecision precision = precision_of(soup);
  double largest = 0;
  for (const Point3& p : soup.vertices) {
    for (const Rational* c : {&p.x, &p.y, &p.z}) {
      largest = std::max(largest, std::fabs(nearest_double(*c)));
    }
  }
  // Short formats come from programs that compute in doubles: an exact zero may be 1e-16 there.
  const bool is_short = precision.binary_single || precision.digits <= digits_of_single;
  const double noise = is_short ? std::ldexp(largest, -50) : 0;
  std::vector<std::array<double, 3>> result;
  for (const Point3& p : soup.vertices) {
    result.push_back({rounding_at(nearest_double(p.x), precision) + noise,
                      rounding_at(nearest_double(p.y), precision) + noise,
                      rounding_at(nearest_double(p.z), precision) + noise});
  }
  return result;
}

PlainVector area_vector(const WeldedMesh& mesh, const std::vector<std::uint32_t>& facet) {
  const PlainVector& origin = mesh.positions[facet[0]];
  PlainVector sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
    sum = sum + cross(mesh.positions[facet[i]] - origin, mesh.positions[facet[i + 1]] - origin);
  }
  return 0.5 * sum;
}

double largest_displacement(const WeldedMesh& mesh, const std::vector<std::uint32_t>& facet) {
  double t = 0;
  for (const std::uint32_t v : facet) t = std::max(t, mesh.displacement[v]);
  return t;
}

double area_slack(const WeldedMesh& mesh, const std::vector<std::uint32_t>& facet) {
  const double t = largest_displacement(mesh, facet);
  return t * perimeter(mesh, facet) + static_cast<double>(facet.size()) * t * t;
}

bool may_stand_for(const WeldedMesh& mesh, std::uint32_t v, const Point3& exact) {
  const Point3& p = mesh.points[v];
  const auto& rounding = mesh.rounding[v];
  return abs(exact.x - p.x) <= rational_of(rounding[0]) &&
         abs(exact.y - p.y) <= rational_of(rounding[1]) &&
         abs(exact.z - p.z) <= rational_of(rounding[2]);
}

WeldedMesh weld(const io::PolygonSoup& soup, double model_rounding) {
  WeldedMesh mesh;
  std::map<std::array<Rational, 3>, std::uint32_t> known;
  const auto rounding = format_rounding(soup);
  std::vector<std::uint32_t> index;
  constexpr double noise = 1e-15;  // of a double against the exact coordinate, generously
  for (std::size_t i = 0; i < soup.vertices.size(); ++i) {
    const std::uint32_t v = weld_vertex(soup.vertices[i], mesh, known);
    index.push_back(v);
    if (v < mesh.rounding.size()) continue;
    std::array<double, 3> r = rounding[i];
    for (double& c : r) c = c * (1 + 1e-12) + model_rounding;
    mesh.rounding.push_back(r);
    mesh.displacement.push_back(length(r) * (1 + 1e-12) + noise * length(mesh.positions[v]));
  }
  for (const auto& corners : soup.facets) {
    std::vector<std::uint32_t> facet;
    facet.reserve(corners.size());
    for (const std::uint32_t v : corners) facet.push_back(index[v]);
    facet = without_repetitions(facet);
    if (facet.size() < 3) {
      ++mesh.dropped_facets;
    } else {
      mesh.facets.push_back(std::move(facet));
    }
  }
  count_edges(mesh);
  if (close_junctions(mesh)) count_edges(mesh);
  return mesh;
}

}  // namespace exactcsg::verify
