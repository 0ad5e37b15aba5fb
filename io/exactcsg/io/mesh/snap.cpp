// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mesh/snap.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "exactcsg/io/mesh/written_surface.hpp"
#include "exactcsg/solid/fill_rule.hpp"
#include "exactcsg/solid/measures.hpp"
#include "exactcsg/solid/polyhedron_signs.hpp"

namespace exactcsg::io {

namespace {

using Index = std::uint32_t;
using Triangle = std::array<Index, 3>;
using Coordinates = std::array<double, 3>;

// Each coarser grid has cells of four times the side.
constexpr unsigned grids = 6;
constexpr unsigned rounds_per_grid = 6;

class Rounder {
 public:
  // grid 0: the format's own numbers. The others are multiples of one length, that of a unit in the
  // last place of the largest coordinate or more.
  Rounder(double largest, bool single_precision, unsigned grid)
      : single_precision_(single_precision) {
    if (grid == 0) return;
    const int digits =
        single_precision ? std::numeric_limits<float>::digits : std::numeric_limits<double>::digits;
    int exponent = 0;
    std::frexp(largest, &exponent);
    cell_ = std::ldexp(1.0, exponent - digits + 2 * static_cast<int>(grid));
  }

  double cell() const { return cell_; }

  // REQUIRES what the constructor was given is not exceeded
  double operator()(double value) const {
    if (cell_ > 0) return std::nearbyint(value / cell_) * cell_ + 0.0;
    return single_precision_ ? double{static_cast<float>(value)} : value;
  }

 private:
  bool single_precision_;
  double cell_ = 0;
};

double largest_coordinate(const Boundary& boundary, bool single_precision) {
  double largest = 0;
  for (const Coordinates& point : boundary.approximate) {
    for (const double value : point) largest = std::max(largest, std::abs(value));
  }
  const double limit = single_precision ? double{std::numeric_limits<float>::max()}
                                        : std::numeric_limits<double>::max();
  if (!(largest <= limit)) {
    throw Error(ErrorId::NumberOutOfRange,
                {"the coordinate " + std::to_string(largest), "what the format can hold"});
  }
  return largest;
}

struct Rounded {
  RoundedSurface surface;
  double largest_move = 0;
};

// Points that become equal are one; triangles that lose an edge are left out.
Rounded rounded(const Boundary& boundary, const Rounder& round) {
  Rounded result;
  std::map<Coordinates, Index> known;
  std::vector<Index> of_vertex;
  Rational largest = 0;
  for (std::size_t v = 0; v < boundary.vertices.size(); ++v) {
    Coordinates point{};
    for (std::size_t i = 0; i < 3; ++i) {
      point[i] = round(boundary.approximate[v][i]) + 0.0;
      const Rational move = abs(rational_of(point[i]) - coordinate(boundary.vertices[v], i));
      if (move > largest) largest = move;
    }
    const auto [place, is_new] =
        known.emplace(point, static_cast<Index>(result.surface.points.size()));
    if (is_new) result.surface.points.push_back(point);
    of_vertex.push_back(place->second);
  }
  for (const auto& [a, b, c] : triangulate(boundary)) {
    const Triangle triangle{of_vertex[a], of_vertex[b], of_vertex[c]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    result.surface.triangles.push_back(triangle);
  }
  result.largest_move = nearest_double(largest);
  return result;
}

std::vector<Point3> exact_points(const std::vector<Coordinates>& points) {
  std::vector<Point3> result;
  result.reserve(points.size());
  for (const Coordinates& p : points) {
    result.push_back({rational_of(p[0]), rational_of(p[1]), rational_of(p[2])});
  }
  return result;
}

Polyhedron polyhedron_of(const RoundedSurface& surface) {
  Polyhedron result{exact_points(surface.points), {}};
  result.facets.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles) result.facets.push_back({a, b, c});
  return result;
}

// Takes triangles without area out of a closed surface. The longest side of such a triangle is
// replaced, in the neighbour there, by the two others: the neighbour becomes two triangles, which
// may be flat in turn.
class FlatTriangles {
 public:
  explicit FlatTriangles(RoundedSurface& surface)
      : surface_(surface), signs_(exact_points(surface.points)) {}

  // How many there were; nullopt if they do not come to an end.
  std::optional<std::size_t> remove() {
    for (Index t = 0; t < surface_.triangles.size(); ++t) {
      if (is_flat(surface_.triangles[t])) flat_.push_back(t);
    }
    if (flat_.empty()) return 0;
    alive_.assign(surface_.triangles.size(), true);
    for (Index t = 0; t < surface_.triangles.size(); ++t) enter(t);
    const std::size_t limit = 20 * surface_.triangles.size() + 1000;
    std::size_t removed = 0;
    while (!flat_.empty()) {
      const Index t = flat_.front();
      flat_.pop_front();
      if (!alive_[t]) continue;
      if (++removed > limit || !replace(t)) return std::nullopt;
    }
    std::vector<Triangle> kept;
    for (Index t = 0; t < surface_.triangles.size(); ++t) {
      if (alive_[t]) kept.push_back(surface_.triangles[t]);
    }
    surface_.triangles = std::move(kept);
    return removed;
  }

 private:
  static std::uint64_t edge(Index from, Index to) {
    return (static_cast<std::uint64_t>(from) << 32U) | to;
  }

  bool is_flat(const Triangle& t) const { return signs_.collinear(t[0], t[1], t[2]); }

  void enter(Index t) {
    const Triangle& triangle = surface_.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      owners_.emplace(edge(triangle[i], triangle[(i + 1) % 3]), t);
    }
  }

  void leave(Index t) {
    alive_[t] = false;
    const Triangle& triangle = surface_.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      auto [place, end] = owners_.equal_range(edge(triangle[i], triangle[(i + 1) % 3]));
      while (place != end && place->second != t) ++place;
      owners_.erase(place);
    }
  }

  void add(const Triangle& triangle) {
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      return;
    }
    const auto t = static_cast<Index>(surface_.triangles.size());
    surface_.triangles.push_back(triangle);
    alive_.push_back(true);
    enter(t);
    if (is_flat(triangle)) flat_.push_back(t);
  }

  // The corner between the two others comes first. Along a line, points are in lexicographic order.
  Triangle with_middle_first(const Triangle& t) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const Triangle turned{t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
      const Coordinates& p = surface_.points[turned[0]];
      const Coordinates& q = surface_.points[turned[1]];
      const Coordinates& r = surface_.points[turned[2]];
      if ((q < p) == (p < r)) return turned;
    }
    return t;
  }

  bool replace(Index t) {
    const auto [middle, from, to] = with_middle_first(surface_.triangles[t]);
    leave(t);
    const auto [begin, end] = owners_.equal_range(edge(to, from));
    if (begin == end) return false;
    // Of several, one that has an area.
    const auto found = std::find_if(
        begin, end, [&](const auto& owner) { return !is_flat(surface_.triangles[owner.second]); });
    const Index neighbour = found != end ? found->second : begin->second;
    const Triangle other = surface_.triangles[neighbour];
    std::size_t i = 0;
    while (other[i] != to || other[(i + 1) % 3] != from) ++i;
    const Index opposite = other[(i + 2) % 3];
    leave(neighbour);
    add({to, middle, opposite});
    add({middle, from, opposite});
    return true;
  }

  RoundedSurface& surface_;
  PolyhedronSigns signs_;
  std::deque<Index> flat_;
  std::vector<bool> alive_;
  std::unordered_multimap<std::uint64_t, Index> owners_;
};

Rational volume_of(const Polyhedron& polyhedron) {
  Rational six = 0;
  const Point3 origin{0, 0, 0};
  for (const Facet& f : polyhedron.facets) {
    const auto& v = polyhedron.vertices;
    six += dot(v[f[0]] - origin, cross(v[f[1]] - origin, v[f[2]] - origin));
  }
  return six / 6;
}

// To more digits than are ever shown; as a fraction it may have thousands for each vertex.
Rational volume_near(const Boundary& boundary) {
  constexpr int bits = 160;
  const Enclosure volume = enclose_volume(boundary, bits);
  return (volume.lower + volume.upper) / 2;
}

Error without_volume() {
  return Error(ErrorId::DegenerateFacet,
               {"a surface that rounding made flat", "one with a volume behind it"});
}

// On one grid. nullopt: no surface came out that bounds a solid, and `fault` says why.
std::optional<SnappedSurface> snap_on(const Boundary& boundary, const Rounder& round,
                                      const EvaluateOptions& options, unsigned& rounds,
                                      std::optional<Error>& fault) {
  std::optional<Boundary> resolved;
  double moved = 0;
  for (unsigned k = 0; k < rounds_per_grid; ++k) {
    if (options.progress != nullptr) options.progress->check();
    Rounded now = rounded(resolved ? *resolved : boundary, round);
    moved += now.largest_move;
    const std::optional<std::size_t> flat = FlatTriangles(now.surface).remove();
    if (!flat || now.surface.triangles.empty()) {
      fault = without_volume();
      return std::nullopt;
    }
    Polyhedron polyhedron = polyhedron_of(now.surface);
    fault = examine(polyhedron).fault;
    if (!fault) {
      const Rational change = volume_of(polyhedron) - volume_near(boundary);
      return SnappedSurface{std::move(now.surface), rounds, *flat,
                            round.cell(),           moved,  nearest_double(change)};
    }
    ++rounds;
    resolved = filled_boundary(std::move(polyhedron), FillRule::Positive, options);
    if (resolved->empty()) {
      fault = without_volume();
      return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace

SnappedSurface snap(const Boundary& boundary, bool single_precision,
                    const EvaluateOptions& options) {
  if (boundary.empty()) throw Error(ErrorId::EmptySolid, {"no surface", ""});
  const double largest = largest_coordinate(boundary, single_precision);
  std::optional<Error> fault;
  unsigned rounds = 0;
  for (unsigned grid = 0; grid < grids; ++grid) {
    const Rounder round(largest, single_precision, grid);
    if (auto snapped = snap_on(boundary, round, options, rounds, fault)) return *std::move(snapped);
  }
  Error::Details details = fault->details();
  details.found = "after " + std::to_string(rounds) + " rounds of snapping on " +
                  std::to_string(grids) + " grids: " + details.found;
  throw Error(fault->id(), std::move(details));
}

}  // namespace exactcsg::io
