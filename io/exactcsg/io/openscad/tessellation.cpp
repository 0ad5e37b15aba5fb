// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/tessellation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "exactcsg/io/openscad/degree_trigonometry.hpp"
#include "exactcsg/number/common_denominator.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io::openscad {

namespace {

constexpr double grid = 1.0 / 1048576.0;  // OpenSCAD's GRID_FINE

[[noreturn]] void refuse(const std::string& found) {
  throw Error(ErrorId::TooLarge,
              {found, "at most " + std::to_string(shape_vertex_limit) + " vertices in a shape"});
}

std::size_t checked_count(double count, const char* what) {
  if (!(count <= static_cast<double>(shape_vertex_limit))) {
    refuse(std::string(what) + " " + std::to_string(count));
  }
  return static_cast<std::size_t>(count);
}

double minimum_slices(double twist) { return std::max(std::ceil(twist / 120.0), 1.0); }

// The arc length of the spiral r = a theta from the origin.
double archimedes_length(double a, double theta) {
  return 0.5 * a * (theta * std::sqrt(1 + theta * theta) + std::asinh(theta));
}

bool is_strictly_convex(const std::vector<Direction>& points) {
  const std::size_t n = points.size();
  std::vector<std::array<Rational, 2>> exact;
  exact.reserve(n);
  for (const Direction& p : points) exact.push_back({rational_of(p[0]), rational_of(p[1])});
  for (std::size_t i = 0; i < n; ++i) {
    const auto& p = exact[i];
    const auto& q = exact[(i + 1) % n];
    const auto& r = exact[(i + 2) % n];
    if ((q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]) <= 0) return false;
  }
  return true;
}

// The rings of OpenSCAD's sphere from the top: (radius, height).
std::vector<Direction> sphere_profile(std::size_t n) {
  const std::size_t rings = (n + 1) / 2;
  std::vector<Direction> profile;
  profile.reserve(rings);
  for (std::size_t j = 0; j < rings; ++j) {
    const double phi = (180.0 * (static_cast<double>(j) + 0.5)) / static_cast<double>(rings);
    profile.push_back({sine_of_degrees(phi), cosine_of_degrees(phi)});
  }
  return profile;
}

// Right of the axis, from the top down, turning clockwise all the way: a convex body of revolution.
bool is_convex_profile(const std::vector<Direction>& profile) {
  for (std::size_t j = 0; j < profile.size(); ++j) {
    if (profile[j][0] <= 0) return false;
    if (j + 1 < profile.size() && profile[j + 1][1] >= profile[j][1]) return false;
    if (j + 2 >= profile.size()) continue;
    const Rational ax = rational_of(profile[j + 1][0]) - rational_of(profile[j][0]);
    const Rational az = rational_of(profile[j + 1][1]) - rational_of(profile[j][1]);
    const Rational bx = rational_of(profile[j + 2][0]) - rational_of(profile[j + 1][0]);
    const Rational bz = rational_of(profile[j + 2][1]) - rational_of(profile[j + 1][1]);
    if (ax * bz - az * bx >= 0) return false;
  }
  return true;
}

// Rings of n vertices each from the top down, with caps; no ring has radius 0.
std::vector<Facet> ring_facets(std::size_t n, std::size_t rings) {
  const auto index = [n](std::size_t ring, std::size_t i) {
    return static_cast<std::uint32_t>(ring * n + i % n);
  };
  std::vector<Facet> facets;
  facets.reserve(2 + (rings - 1) * n);
  Facet top;
  Facet bottom;
  for (std::size_t i = 0; i < n; ++i) {
    top.push_back(index(0, i));
    bottom.push_back(index(rings - 1, n - 1 - i));
  }
  facets.push_back(std::move(top));
  facets.push_back(std::move(bottom));
  for (std::size_t ring = 0; ring + 1 < rings; ++ring) {
    for (std::size_t i = 0; i < n; ++i) {
      facets.push_back(
          {index(ring, i), index(ring + 1, i), index(ring + 1, i + 1), index(ring, i + 1)});
    }
  }
  return facets;
}

// A cone over a ring of n vertices (0 .. n - 1, counter-clockwise from above) with apex n.
std::vector<Facet> cone_facets(std::size_t n, bool apex_above) {
  std::vector<Facet> facets;
  facets.reserve(n + 1);
  const auto apex = static_cast<std::uint32_t>(n);
  Facet base;
  for (std::size_t i = 0; i < n; ++i) {
    const auto a = static_cast<std::uint32_t>(i);
    const auto b = static_cast<std::uint32_t>((i + 1) % n);
    base.push_back(static_cast<std::uint32_t>(apex_above ? n - 1 - i : i));
    facets.push_back(apex_above ? Facet{a, b, apex} : Facet{b, a, apex});
  }
  facets.push_back(std::move(base));
  return facets;
}

}  // namespace

std::size_t fragments(double radius, const Fineness& fineness) {
  const auto [fn, fa, fs] = fineness;
  if (radius < grid || !std::isfinite(fn)) return 3;
  if (fn > 0.0) return checked_count(fn >= 3 ? fn : 3, "$fn =");
  return checked_count(
      std::ceil(std::fmax(std::fmin(360.0 / fa, radius * 2 * std::numbers::pi / fs), 5)),
      "fragments of a circle:");
}

std::size_t helix_slices(double radius_squared, double height, double twist,
                         const Fineness& fineness) {
  const auto [fn, fa, fs] = fineness;
  twist = std::fabs(twist);
  const double least = minimum_slices(twist);
  if (std::sqrt(radius_squared) < grid || !std::isfinite(fn))
    return checked_count(least, "slices:");
  if (fn > 0.0) return checked_count(std::max(std::ceil(twist / 360.0 * fn), least), "slices:");
  const double turn = twist * std::numbers::pi / 180.0;
  const double pitch = height / turn;
  const double length = turn * std::sqrt(radius_squared + pitch * pitch);
  const double wanted = std::min(std::ceil(twist / fa), std::ceil(length / fs));
  return checked_count(std::max(wanted, least), "slices:");
}

std::size_t conical_helix_slices(double radius_squared, double height, double twist, double scale,
                                 const Fineness& fineness) {
  const auto [fn, fa, fs] = fineness;
  twist = std::fabs(twist);
  const double radius = std::sqrt(radius_squared);
  const double least = minimum_slices(twist);
  if (radius < grid || !std::isfinite(fn)) return checked_count(least, "slices:");
  if (fn > 0.0) return checked_count(std::max(std::ceil(twist * fn / 360), least), "slices:");
  const double turn = twist * std::numbers::pi / 180.0;
  const double end = scale > 1 ? turn * scale / (scale - 1) : turn / (1 - scale);
  const double a = radius / end;
  const double spiral = archimedes_length(a, end) - archimedes_length(a, end - turn);
  const double length = std::sqrt(spiral * spiral + height * height);
  const double wanted = std::min(std::ceil(twist / fa), std::ceil(length / fs));
  return checked_count(std::max(wanted, least), "slices:");
}

std::size_t diagonal_slices(double delta_squared, double height, const Fineness& fineness) {
  const auto [fn, fa, fs] = fineness;
  if (std::sqrt(delta_squared) < grid || !std::isfinite(fn)) return 1;
  if (fn > 0.0) return checked_count(std::max(std::trunc(fn), 1.0), "slices:");
  return checked_count(std::max(std::ceil(std::sqrt(delta_squared + height * height) / fs), 1.0),
                       "slices:");
}

std::vector<Direction> circle_directions(std::size_t n) {
  std::vector<Direction> directions;
  directions.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double phi = (360.0 * static_cast<double>(i)) / static_cast<double>(n);
    directions.push_back({cosine_of_degrees(phi), sine_of_degrees(phi)});
  }
  return directions;
}

Rational unit_rounding_bound() { return Rational(1, Integer(1) << 48U); }

IntegerPolyhedron with_common_denominator(const Polyhedron& polyhedron) {
  IntegerPolyhedron result{{}, 1, ConvexFacets(polyhedron)};
  for (const Point3& p : polyhedron.vertices) {
    for (const Rational* c : {&p.x, &p.y, &p.z}) make_multiple(result.denominator, c->get_den());
  }
  result.vertices.reserve(polyhedron.vertices.size());
  for (const Point3& p : polyhedron.vertices) {
    std::array<Integer, 3> v;
    std::size_t axis = 0;
    for (const Rational* c : {&p.x, &p.y, &p.z}) {
      set_scaled(v[axis++], *c, result.denominator);
    }
    result.vertices.push_back(std::move(v));
  }
  return result;
}

namespace {

// Reduces many fractions of one denominator. Theirs are a power of two, from doubles, times a power
// of five, from decimals: the twos are counted, and what is left mostly fits a machine word.
class CommonDenominator {
 public:
  explicit CommonDenominator(const Integer& value)
      : value_(value), twos_(mpz_scan1(value.get_mpz_t(), 0)), odd_(value >> twos_) {}

  Rational reduced(Integer& numerator) const {
    Rational result;
    if (numerator == 0) return result;
    if (!odd_.fits_ulong_p()) {
      result = Rational(numerator, value_);
      result.canonicalize();
      return result;
    }
    const mp_bitcnt_t common_twos = std::min(twos_, mpz_scan1(numerator.get_mpz_t(), 0));
    mpz_tdiv_q_2exp(numerator.get_mpz_t(), numerator.get_mpz_t(), common_twos);
    unsigned long odd = odd_.get_ui();
    const unsigned long factor = mpz_gcd_ui(nullptr, numerator.get_mpz_t(), odd);
    if (factor != 1) {
      mpz_divexact_ui(numerator.get_mpz_t(), numerator.get_mpz_t(), factor);
      odd /= factor;
    }
    mpz_set(result.get_num_mpz_t(), numerator.get_mpz_t());
    mpz_set_ui(result.get_den_mpz_t(), odd);
    mpz_mul_2exp(result.get_den_mpz_t(), result.get_den_mpz_t(), twos_ - common_twos);
    return result;
  }

 private:
  Integer value_;
  mp_bitcnt_t twos_;
  Integer odd_;
};

std::vector<Point3> placed_vertices(const AffineMap& map, const IntegerPolyhedron& polyhedron) {
  // With one denominator for the map, too, a coordinate costs three products and one reduction.
  Integer map_denominator{1};
  for (const auto& row : map.m) {
    for (const Rational& entry : row) map_denominator = lcm(map_denominator, entry.get_den());
  }
  std::array<std::array<Integer, 4>, 3> rows;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Rational& entry = map.m[i][k];
      rows[i][k] = entry.get_num() * (map_denominator / entry.get_den());
    }
    rows[i][3] *= polyhedron.denominator;
  }
  const CommonDenominator denominator(map_denominator * polyhedron.denominator);

  std::vector<Point3> result;
  result.reserve(polyhedron.vertices.size());
  Integer sum;
  const auto coordinate = [&](const std::array<Integer, 4>& row, const std::array<Integer, 3>& v) {
    sum = row[3];
    for (std::size_t k = 0; k < 3; ++k) {
      mpz_addmul(sum.get_mpz_t(), row[k].get_mpz_t(), v[k].get_mpz_t());
    }
    return denominator.reduced(sum);
  };
  for (const auto& v : polyhedron.vertices) {
    result.push_back({coordinate(rows[0], v), coordinate(rows[1], v), coordinate(rows[2], v)});
  }
  return result;
}

}  // namespace

Polyhedron place(const AffineMap& map, const IntegerPolyhedron& polyhedron) {
  Polyhedron result{placed_vertices(map, polyhedron), {}};
  const bool mirrors = determinant(map) < 0;
  for (const auto facet : polyhedron.facets.facets()) {
    Facet& copy = result.facets.emplace_back(facet.begin(), facet.end());
    if (mirrors) std::reverse(copy.begin(), copy.end());
  }
  return result;
}

ConvexPolytope place_polytope(const AffineMap& map, const IntegerPolyhedron& polyhedron) {
  if (determinant(map) < 0) return make_convex_polytope_unchecked(place(map, polyhedron));
  return make_convex_polytope_unchecked(placed_vertices(map, polyhedron), polyhedron.facets);
}

struct ShapeCache::Tables {
  std::map<std::size_t, IntegerPolyhedron> spheres;
  std::map<std::size_t, IntegerPolyhedron> cylinders;
  std::optional<IntegerPolyhedron> box;

  // The circle, convex as the shapes' builders need it.
  static std::vector<Direction> circle(std::size_t n) {
    std::vector<Direction> directions = circle_directions(n);
    // Edges turn by 2 pi / n; rounding cannot undo that below n = 10^7, far beyond the limit.
    if (!is_strictly_convex(directions)) {
      throw Error(
          ErrorId::InternalError,
          {"a rounded circle of " + std::to_string(n) + " vertices that is not convex", ""});
    }
    return directions;
  }
};

ShapeCache::ShapeCache() : tables_(std::make_unique<Tables>()) {}
ShapeCache::~ShapeCache() = default;

const IntegerPolyhedron& ShapeCache::sphere(std::size_t n) {
  if (const auto found = tables_->spheres.find(n); found != tables_->spheres.end()) {
    return found->second;
  }
  const std::size_t rings = (n + 1) / 2;
  if (n > shape_vertex_limit / rings) {
    refuse("a sphere of " + std::to_string(n) + " fragments");
  }
  const std::vector<Direction> profile = sphere_profile(n);
  if (!is_convex_profile(profile)) {
    throw Error(ErrorId::InternalError,
                {"a rounded sphere of " + std::to_string(n) + " fragments that is not convex", ""});
  }
  Polyhedron sphere;
  sphere.vertices.reserve(n * rings);
  const std::vector<Direction> circle = Tables::circle(n);
  for (const Direction& ring : profile) {
    const Rational radius = rational_of(ring[0]);
    const Rational height = rational_of(ring[1]);
    for (const Direction& direction : circle) {
      sphere.vertices.push_back(
          {radius * rational_of(direction[0]), radius * rational_of(direction[1]), height});
    }
  }
  sphere.facets = ring_facets(n, rings);
  return tables_->spheres.emplace(n, with_common_denominator(sphere)).first->second;
}

const IntegerPolyhedron& ShapeCache::cylinder(std::size_t n) {
  if (const auto found = tables_->cylinders.find(n); found != tables_->cylinders.end()) {
    return found->second;
  }
  return tables_->cylinders.emplace(n, frustum(n, 1)).first->second;
}

const IntegerPolyhedron& ShapeCache::box() {
  if (!tables_->box) {
    Polyhedron box;
    for (int corner = 0; corner < 8; ++corner) {
      box.vertices.push_back({corner & 1, (corner >> 1) & 1, (corner >> 2) & 1});
    }
    box.facets = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    tables_->box = with_common_denominator(box);
  }
  return *tables_->box;
}

IntegerPolyhedron ShapeCache::frustum(std::size_t n, const Rational& ratio) {
  if (n > shape_vertex_limit / 2) refuse("a cylinder of " + std::to_string(n) + " fragments");
  Polyhedron frustum;
  const std::vector<Direction> circle = Tables::circle(n);
  const auto add_ring = [&](const Rational& radius, const Rational& height) {
    for (const Direction& direction : circle) {
      frustum.vertices.push_back(
          {radius * rational_of(direction[0]), radius * rational_of(direction[1]), height});
    }
  };
  if (ratio == 0) {
    add_ring(1, 0);
    frustum.vertices.push_back({0, 0, 1});
    frustum.facets = cone_facets(n, true);
  } else {
    add_ring(ratio, 1);
    add_ring(1, 0);
    frustum.facets = ring_facets(n, 2);
  }
  return with_common_denominator(frustum);
}

}  // namespace exactcsg::io::openscad
