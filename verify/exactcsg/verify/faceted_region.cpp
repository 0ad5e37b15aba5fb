// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/faceted_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/domain/vector.hpp"
#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::verify {

namespace {

using csg::BooleanOperator;
using domain::detail::scalar_product;
using domain::detail::vector_product;
using io::openmc::HalfSpaceRegion;
using io::openmc::Region;
using io::openmc::Surface;
using io::openmc::SurfaceSide;
using Box = domain::Box<3>;
using Row = std::array<Rational, 3>;

// ---- surfaces as sums of squares --------------------------------------------------------------

// x^T square x + linear x + constant, negative on the side "-id".
struct Polynomial {
  std::array<Row, 3> square;
  Row linear;
  Rational constant;

  void add_square(std::size_t axis, const Rational& factor, const Rational& centre) {
    square[axis][axis] += factor;
    linear[axis] -= 2 * factor * centre;
    constant += factor * centre * centre;
  }
};

std::size_t axis_of(const Surface& surface) {
  return static_cast<std::size_t>(surface.type.front() - 'x');
}
bool is_aligned(const Surface& surface, std::string_view kind) {
  return surface.type.size() == kind.size() + 2 && surface.type.ends_with(kind) &&
         surface.type[1] == '-';
}

Polynomial quadric_of(const std::vector<Rational>& c) {
  Polynomial f;
  for (std::size_t i = 0; i < 3; ++i) {
    f.square[i][i] = c[i];
    f.square[i][(i + 1) % 3] = f.square[(i + 1) % 3][i] = c[3 + i] / 2;
    f.linear[i] = c[6 + i];
  }
  f.constant = c[9];
  return f;
}

// nullopt: a torus, or one nappe of a cone.
std::optional<Polynomial> polynomial_of(const io::openmc::HalfSpace& half_space) {
  const auto* quadric = half_space.quadric();
  if (quadric == nullptr || quadric->nappe()) return std::nullopt;
  const auto& f = quadric->polynomial();
  return Polynomial{f.square(), f.linear().normal, f.linear().constant};
}

// nullopt: a torus.
std::optional<Polynomial> polynomial_of(const Surface& surface) {
  const std::vector<Rational>& c = surface.coefficients;
  Polynomial f;
  if (surface.type == "plane") {
    f.linear = {c[0], c[1], c[2]};
    f.constant = -c[3];
  } else if (is_aligned(surface, "plane")) {
    f.linear[axis_of(surface)] = 1;
    f.constant = -c[0];
  } else if (surface.type == "sphere") {
    for (std::size_t i = 0; i < 3; ++i) f.add_square(i, 1, c[i]);
    f.constant -= c[3] * c[3];
  } else if (is_aligned(surface, "cylinder")) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (i != axis_of(surface)) f.add_square(i, 1, c[next++]);
    }
    f.constant -= c[2] * c[2];
  } else if (is_aligned(surface, "cone")) {
    for (std::size_t i = 0; i < 3; ++i) {
      f.add_square(i, i == axis_of(surface) ? Rational(-c[3]) : Rational(1), c[i]);
    }
  } else if (surface.type == "quadric") {
    f = quadric_of(c);
  } else {
    return std::nullopt;
  }
  return f;
}

struct Square {
  Rational factor;
  Row normal;
  Rational offset;
};

// factor (normal x + offset)^2, summed up, and what is left.
struct SumOfSquares {
  std::vector<Square> squares;
  Row linear;
  Rational constant;
};

// A direction in which the form is not 0: an axis, or the sum of two; nullopt: it is 0 throughout.
std::optional<Row> direction_of_change(const std::array<Row, 3>& form) {
  for (std::size_t i = 0; i < 3; ++i) {
    Row direction;
    direction[i] = 1;
    if (form[i][i] != 0) return direction;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    Row direction;
    direction[i] = direction[j] = 1;
    if (form[i][j] != 0) return direction;
  }
  return std::nullopt;
}

// Lagrange's reduction: each square takes the dependence on one direction away.
SumOfSquares sum_of_squares(Polynomial f) {
  SumOfSquares result;
  while (const std::optional<Row> v = direction_of_change(f.square)) {
    Square next;
    for (std::size_t i = 0; i < 3; ++i) next.normal[i] = scalar_product(f.square[i], *v);
    next.factor = scalar_product(next.normal, *v);
    next.offset = scalar_product(f.linear, *v) / (2 * next.factor);
    for (Rational& x : next.normal) x /= next.factor;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        f.square[i][j] -= next.factor * next.normal[i] * next.normal[j];
      }
      f.linear[i] -= 2 * next.factor * next.offset * next.normal[i];
    }
    f.constant -= next.factor * next.offset * next.offset;
    result.squares.push_back(std::move(next));
  }
  result.linear = f.linear;
  result.constant = f.constant;
  return result;
}

// ---- what can be faceted ----------------------------------------------------------------------

enum class Form : unsigned char { Plane, Ellipsoid, Cylinder, DoubleCone };

// The convex side (or that of the two nappes) in coordinates y = to_local(x): y0^2/s0 + y1^2/s1 +
// y2^2/s2 <= 1, the same without y2, or y0^2/s0 + y1^2/s1 <= y2^2.
struct NormalForm {
  Form form = Form::Plane;
  bool is_negated = false;  // it is the side "id"
  AffineMap to_local;
  std::array<Rational, 3> squared_axes;
};

AffineMap to_local(const std::vector<Square>& squares) {
  AffineMap map;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    for (std::size_t j = 0; j < 3; ++j) map.m[i][j] = squares[i].normal[j];
    map.m[i][3] = squares[i].offset;
  }
  if (squares.size() == 2) {
    const Row along = vector_product(squares[0].normal, squares[1].normal);
    for (std::size_t j = 0; j < 3; ++j) map.m[2][j] = along[j];
  }
  return map;
}

// nullopt: a surface that is not faceted.
std::optional<NormalForm> normal_form(const Polynomial& polynomial) {
  SumOfSquares sum = sum_of_squares(polynomial);
  std::vector<Square>& squares = sum.squares;
  NormalForm result;
  if (squares.empty()) return result;
  if (squares.size() < 2 || sum.linear != Row{}) return std::nullopt;
  const auto is_negative = [](const Square& square) { return square.factor < 0; };
  const auto negative =
      static_cast<std::size_t>(std::count_if(squares.begin(), squares.end(), is_negative));
  result.is_negated = 2 * negative > squares.size();
  if (result.is_negated) {
    for (Square& square : squares) square.factor = -square.factor;
    sum.constant = -sum.constant;
  }
  // The one of the other sign last.
  std::stable_partition(squares.begin(), squares.end(),
                        [&](const Square& square) { return !is_negative(square); });
  const std::size_t others = result.is_negated ? squares.size() - negative : negative;
  Rational right = -sum.constant;
  if (others == 0 && right > 0) {
    result.form = squares.size() == 3 ? Form::Ellipsoid : Form::Cylinder;
  } else if (others == 1 && squares.size() == 3 && right == 0) {
    result.form = Form::DoubleCone;
    right = -squares[2].factor;
  } else {
    return std::nullopt;
  }
  result.to_local = to_local(squares);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    result.squared_axes[i] = right / squares[i].factor;
  }
  if (squares.size() == 2 || result.form == Form::DoubleCone) result.squared_axes[2] = 1;
  return result;
}

// Exact of squares.
Enclosure square_root(const Rational& value) {
  constexpr std::size_t precision = 48;
  const Integer whole = value.get_num() * value.get_den();
  const std::size_t bits = mpz_sizeinbase(whole.get_mpz_t(), 2);
  const std::size_t shift = bits < precision ? (precision - bits + 1) / 2 : 0;
  const Integer scaled = whole << (2 * shift);
  const Integer root = sqrt(scaled);
  const Integer unit = value.get_den() << shift;
  Enclosure result{Rational(root, unit), Rational(root * root == scaled ? root : root + 1, unit)};
  result.lower.canonicalize();
  result.upper.canonicalize();
  return result;
}

// ---- polyhedra in and round the unit ball and circle -------------------------------------------

struct CirclePoint {
  Rational x, y;
};

// At the angle, at most 2^-19 within the unit circle.
CirclePoint circle_point(double angle) {
  constexpr double scale = 0x1p20;
  const auto inwards = [](double x) { return rational_of(std::trunc(x * (scale - 1)) / scale); };
  CirclePoint point{inwards(std::cos(angle)), inwards(std::sin(angle))};
  if (point.x * point.x + point.y * point.y > 1) {
    throw Error(ErrorId::InternalError, {"a point outside the unit circle", ""});
  }
  return point;
}

// Sides, not corners, across the axes.
std::vector<CirclePoint> circle(std::uint32_t segments) {
  std::vector<CirclePoint> points;
  for (std::uint32_t i = 0; i < segments; ++i) {
    points.push_back(circle_point((2 * i + 1) * std::numbers::pi / segments));
  }
  return points;
}

Polyhedron prism(std::uint32_t segments) {
  Polyhedron result;
  Facet bottom;
  Facet top;
  for (const CirclePoint& p : circle(segments)) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back({p.x, p.y, -1});
    result.vertices.push_back({p.x, p.y, 1});
    bottom.insert(bottom.begin(), first);
    top.push_back(first + 1);
    const std::uint32_t next = (first + 2) % (2 * segments);
    result.facets.push_back({first, next, next + 1, first + 1});
  }
  result.facets.push_back(std::move(bottom));
  result.facets.push_back(std::move(top));
  return result;
}

// The apex in the origin, the base at z = 1.
Polyhedron pyramid(std::uint32_t segments) {
  Polyhedron result;
  Facet base;
  for (const CirclePoint& p : circle(segments)) {
    base.push_back(static_cast<std::uint32_t>(result.vertices.size()));
    result.vertices.push_back({p.x, p.y, 1});
  }
  result.vertices.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < segments; ++i) {
    result.facets.push_back({segments, (i + 1) % segments, i});
  }
  result.facets.push_back(std::move(base));
  return result;
}

// Rings of one polygon at several sizes, so that what lies between two of them is planar.
Polyhedron ball(std::uint32_t segments) {
  const std::uint32_t bands = segments / 2;
  const std::vector<CirclePoint> ring = circle(segments);
  Polyhedron result;
  for (std::uint32_t band = 1; band < bands; ++band) {
    const CirclePoint profile =
        circle_point((static_cast<double>(band) / bands - 0.5) * std::numbers::pi);
    for (const CirclePoint& p : ring) {
      result.vertices.push_back({profile.x * p.x, profile.x * p.y, profile.y});
    }
  }
  const auto south = static_cast<std::uint32_t>(result.vertices.size());
  result.vertices.push_back({0, 0, -1});
  result.vertices.push_back({0, 0, 1});
  const std::uint32_t last = segments * (bands - 2);
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::uint32_t next = (i + 1) % segments;
    result.facets.push_back({south, next, i});
    result.facets.push_back({south + 1, last + i, last + next});
    for (std::uint32_t first = 0; first < last; first += segments) {
      result.facets.push_back(
          {first + i, first + next, first + segments + next, first + segments + i});
    }
  }
  return result;
}

// A factor that takes every side of the polygon, which is round the origin, out of the unit circle.
Rational enlargement_of(const std::vector<CirclePoint>& points) {
  Rational nearest = 1;  // squared
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CirclePoint& p = points[i];
    const CirclePoint& q = points[(i + 1) % points.size()];
    const Rational moment = p.x * q.y - p.y * q.x;
    const Rational dx = q.x - p.x;
    const Rational dy = q.y - p.y;
    nearest = std::min(nearest, Rational(moment * moment / (dx * dx + dy * dy)));
  }
  return square_root(Rational(1 / nearest)).upper;
}

// The same of a polyhedron round the origin and the unit ball.
Rational enlargement_of(const Polyhedron& polyhedron) {
  Rational nearest = 1;
  for (const Facet& facet : polyhedron.facets) {
    const Plane plane = plane_through(polyhedron.vertices[facet[0]], polyhedron.vertices[facet[1]],
                                      polyhedron.vertices[facet[2]]);
    const Integer square = plane.a * plane.a + plane.b * plane.b + plane.c * plane.c;
    nearest = std::min(nearest, Rational(Rational(plane.d * plane.d) / square));
  }
  return square_root(Rational(1 / nearest)).upper;
}

// ---- polyhedra in and round a torus ------------------------------------------------------------
//
// A torus is {((rho - major) / across)^2 + (z / along)^2 <= 1}. A ring has the same profile, a
// polygon, on every chord of a polygon in the unit circle: with s = 1 on the chord, its points have
// the distance rho = s |p| from the axis, p a point of the chord, which is between s / f and s if
// the polygon enlarged by f is round the circle. So a ring is within the torus if each corner of
// its profile is with s as well as with s / f for rho, since the torus's profile is convex; and a
// ring is round the torus if its profile has the points with s = rho and all up to s = f rho.

struct RingSize {
  Rational major, along, across;
};

// From the lowest on the outside up and back along the hole.
using Profile = std::vector<CirclePoint>;

// x > 0, upwards: half of a polygon in the unit circle, the other half of which is its mirror
// image.
std::vector<CirclePoint> half_circle(std::uint32_t segments) {
  std::vector<CirclePoint> points;
  for (const CirclePoint& p : circle(segments)) {
    if (p.x > 0) points.push_back(p);
  }
  std::sort(points.begin(), points.end(),
            [](const CirclePoint& a, const CirclePoint& b) { return a.y < b.y; });
  return points;
}

Profile with_mirrored(Profile outside, std::vector<CirclePoint> inside) {
  outside.insert(outside.end(), inside.rbegin(), inside.rend());
  return outside;
}

// Empty: too thin for the polygon.
Profile inner_profile(const RingSize& size, const std::vector<CirclePoint>& half,
                      const Rational& factor) {
  Profile outside;
  std::vector<CirclePoint> inside;
  for (const CirclePoint& p : half) {
    const Rational outer = size.major + size.across * p.x;
    const Rational inner = factor * (size.major - size.across * p.x);
    if (inner >= outer) continue;
    outside.push_back({outer, size.along * p.y});
    inside.push_back({inner, size.along * p.y});
  }
  return outside.size() < 2 ? Profile() : with_mirrored(std::move(outside), std::move(inside));
}

// Empty: the hole is too narrow for the polygon, or there is none.
Profile outer_profile(const RingSize& size, const std::vector<CirclePoint>& half,
                      const Rational& factor) {
  std::vector<CirclePoint> left;
  for (const CirclePoint& p : half) left.push_back({Rational(-p.x), p.y});
  const Rational enlargement = enlargement_of(with_mirrored(half, left));
  Profile outside;
  std::vector<CirclePoint> inside;
  for (const CirclePoint& p : half) {
    const Rational reach = size.across * enlargement * p.x;
    if (reach >= size.major) return {};
    const Rational height = size.along * enlargement * p.y;
    outside.push_back({Rational(factor * (size.major + reach)), height});
    inside.push_back({Rational(size.major - reach), height});
  }
  return with_mirrored(std::move(outside), std::move(inside));
}

Polyhedron ring(const std::vector<CirclePoint>& directions, const Profile& profile) {
  Polyhedron result;
  for (const CirclePoint& direction : directions) {
    for (const CirclePoint& p : profile) {
      result.vertices.push_back({Rational(direction.x * p.x), Rational(direction.y * p.x), p.y});
    }
  }
  const auto count = static_cast<std::uint32_t>(profile.size());
  const auto all = static_cast<std::uint32_t>(result.vertices.size());
  for (std::uint32_t first = 0; first < all; first += count) {
    const std::uint32_t second = (first + count) % all;
    for (std::uint32_t j = 0; j < count; ++j) {
      const std::uint32_t next = (j + 1) % count;
      result.facets.push_back({first + j, second + j, second + next, first + next});
    }
  }
  return result;
}

// From a torus round the third axis and the origin. REQUIRES a torus
AffineMap place_of_torus(const Surface& surface) {
  const std::size_t axis = axis_of(surface);
  AffineMap map;
  for (std::size_t i = 0; i < 3; ++i) {
    map.m[(axis + 1 + i) % 3][i] = 1;
    map.m[i][3] = surface.coefficients[i];
  }
  return map;
}

RingSize size_of_torus(const Surface& surface) {
  const std::vector<Rational>& c = surface.coefficients;
  return {c[3], c[4], c[5]};
}

// ---- surfaces within a box --------------------------------------------------------------------

std::vector<Point3> corners_of(const Box& box) {
  std::vector<Point3> corners;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Row x;
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = ((corner >> i & 1U) != 0 ? box.upper() : box.lower())[i];
    }
    corners.push_back({x[0], x[1], x[2]});
  }
  return corners;
}

Solid subtract(Solid whole, Solid part) {
  std::vector<Solid> operands;
  operands.push_back(std::move(whole));
  operands.push_back(std::move(part));
  return Solid::compose(BooleanOperator::Difference, std::move(operands));
}
Solid combined(BooleanOperator operation, Solid a, Solid b) {
  std::vector<Solid> operands;
  operands.push_back(std::move(a));
  operands.push_back(std::move(b));
  return Solid::compose(operation, std::move(operands));
}

// "-id" or "id" of a surface as the format describes it, or a half-space of a window.
struct Side {
  const Surface* surface = nullptr;
  const io::openmc::HalfSpace* half_space = nullptr;
  bool is_positive = false;

  std::optional<Polynomial> polynomial() const {
    return surface != nullptr ? polynomial_of(*surface) : polynomial_of(*half_space);
  }
};
using SideRegion = csg::BooleanTree<Side>;

SideRegion sides_of(const io::openmc::Model& model, const Region& region) {
  return csg::map(region, [&](const SurfaceSide& side) {
    return Side{&model.surfaces[side.surface], nullptr, side.is_positive};
  });
}

bool is_complement(const io::openmc::HalfSpace& half_space) {
  return half_space.visit([](const auto& kind) { return kind.is_complement(); });
}

class Faceter {
 public:
  Faceter(const Box& box, std::uint32_t segments) : segments_(segments), corners_(corners_of(box)) {
    block_ = make_box(corners_.front(), corners_.back());
    solid_ = Solid::primitive(Primitive{block_});
  }

  FacetedRegion operator()(const SideRegion& region) {
    FacetedRegion result = csg::traverse(
        region, [&](const Side& side) { return of_side(side); },
        [](const FacetedRegion& a, BooleanOperator operation, const FacetedRegion& b) {
          return combine(a, operation, b);
        },
        csg::FullEmptyResult{FacetedRegion{solid_, solid_, true}, FacetedRegion{}});
    result.lower = combined(BooleanOperator::Intersection, result.lower, solid_);
    result.upper = combined(BooleanOperator::Intersection, result.upper, solid_);
    result.is_exact = is_exact_;
    return result;
  }

 private:
  static FacetedRegion combine(const FacetedRegion& a, BooleanOperator operation,
                               const FacetedRegion& b) {
    switch (operation) {
      case BooleanOperator::Union:
      case BooleanOperator::Intersection:
        return {combined(operation, a.lower, b.lower), combined(operation, a.upper, b.upper), true};
      case BooleanOperator::Difference:
        return {subtract(a.lower, b.upper), subtract(a.upper, b.lower), true};
      case BooleanOperator::SymmetricDifference:
        break;
    }
    return combine(combine(a, BooleanOperator::Difference, b), BooleanOperator::Union,
                   combine(b, BooleanOperator::Difference, a));
  }

  FacetedRegion of_side(const Side& side) {
    const std::pair key{static_cast<const void*>(side.surface), side.is_positive};
    if (side.surface != nullptr) {
      const auto found = sides_.find(key);
      if (found != sides_.end()) return found->second;
    }
    FacetedRegion result;
    if (const std::optional<Polynomial> f = side.polynomial()) {
      result = of_polynomial(*f, side.is_positive);
    } else {
      result = of_torus(*side.surface);
      if (side.is_positive) result = outside(result);
    }
    if (side.surface != nullptr) sides_.emplace(key, result);
    return result;
  }

  FacetedRegion of_polynomial(const Polynomial& f, bool is_positive) {
    const NormalForm form = *normal_form(f);
    if (form.form == Form::Plane) {
      const Plane plane = make_plane(f.linear[0], f.linear[1], f.linear[2], f.constant);
      const Solid solid = of_plane(is_positive ? opposite(plane) : plane);
      return {solid, solid, true};
    }
    is_exact_ = false;
    const FacetedRegion result = of_curved(form);
    return is_positive != form.is_negated ? outside(result) : result;
  }

  FacetedRegion outside(const FacetedRegion& inside) const {
    return {subtract(solid_, inside.upper), subtract(solid_, inside.lower), inside.is_exact};
  }

  FacetedRegion of_torus(const Surface& surface) {
    is_exact_ = false;
    const RingSize size = size_of_torus(surface);
    const AffineMap map = place_of_torus(surface);
    const std::vector<CirclePoint> directions = circle(2 * segments_);
    const Rational factor = enlargement_of(directions);
    const std::vector<CirclePoint> half = half_circle(segments_);
    const auto solid = [&](const Profile& profile) {
      if (profile.empty()) return Solid::empty();
      return Solid::primitive(
          apply(map, Primitive{make_mesh_unchecked(ring(directions, profile))}));
    };
    return {solid(inner_profile(size, half, factor)), solid(outer_profile(size, half, factor)),
            false};
  }

  // The part of the box in the half-space.
  Solid of_plane(const Plane& plane) const {
    const auto has = [&](Sign sign) {
      return std::any_of(corners_.begin(), corners_.end(),
                         [&](const Point3& corner) { return side(plane, corner) == sign; });
    };
    if (!has(Sign::Negative)) return Solid::empty();
    if (!has(Sign::Positive)) return solid_;
    std::vector<HalfSpace> half_spaces{HalfSpace{plane}};
    const StoredPolyhedron& block = *block_.polyhedron;
    for (const auto facet : block.facets) {
      half_spaces.push_back({plane_through(block.vertices[facet[0]], block.vertices[facet[1]],
                                           block.vertices[facet[2]])});
    }
    return Solid::primitive(Primitive{make_convex_polytope(half_spaces)});
  }

  // Beyond every corner of the box along the axis of a cylinder or cone.
  Rational reach(const NormalForm& form) const {
    Rational result = 0;
    for (const Point3& corner : corners_) {
      result = std::max(result, Rational(abs(apply(form.to_local, corner).z)));
    }
    return Rational(result + result / 4 + Rational(1, 1024));
  }

  FacetedRegion of_curved(const NormalForm& form) const {
    const AffineMap back = inverse(form.to_local);
    std::array<Enclosure, 3> axes;
    for (std::size_t i = 0; i < 3; ++i) axes[i] = square_root(form.squared_axes[i]);
    const auto stretched = [&](const ConvexPolytope& polytope, const Rational& x, const Rational& y,
                               const Rational& z) {
      AffineMap map = AffineMap::identity();
      map.m[0][0] = x;
      map.m[1][1] = y;
      map.m[2][2] = z;
      return Solid::primitive(apply(back * map, Primitive{polytope}));
    };
    const auto along = [&](std::size_t i, const Rational& factor) {
      return Rational(axes[i].upper * factor);
    };
    if (form.form == Form::Ellipsoid) {
      const Polyhedron local = ball(segments_);
      const ConvexPolytope polytope = make_convex_polytope(local);
      const Rational factor = enlargement_of(local);
      return {stretched(polytope, axes[0].lower, axes[1].lower, axes[2].lower),
              stretched(polytope, along(0, factor), along(1, factor), along(2, factor)), false};
    }
    // Cheap enough for four times the sharpness.
    const std::uint32_t segments = 2 * segments_;
    const Rational factor = enlargement_of(circle(segments));
    const Rational end = reach(form);
    if (form.form == Form::Cylinder) {
      const ConvexPolytope polytope = make_convex_polytope(prism(segments));
      return {stretched(polytope, axes[0].lower, axes[1].lower, end),
              stretched(polytope, along(0, factor), along(1, factor), end), false};
    }
    const ConvexPolytope polytope = make_convex_polytope(pyramid(segments));
    const auto nappes = [&](const Rational& x, const Rational& y) {
      return combined(BooleanOperator::Union,
                      stretched(polytope, Rational(x * end), Rational(y * end), end),
                      stretched(polytope, Rational(x * end), Rational(y * end), Rational(-end)));
    };
    return {nappes(axes[0].lower, axes[1].lower), nappes(along(0, factor), along(1, factor)),
            false};
  }

  std::uint32_t segments_;
  std::vector<Point3> corners_;
  ConvexPolytope block_;
  Solid solid_;
  bool is_exact_ = true;
  std::map<std::pair<const void*, bool>, FacetedRegion> sides_;
};

// Whether the surface is a torus that has polyhedra with so many segments round it.
bool has_ring(const Surface& surface, std::uint32_t segments) {
  return is_aligned(surface, "torus") &&
         !outer_profile(size_of_torus(surface), half_circle(segments),
                        enlargement_of(circle(2 * segments)))
              .empty();
}

}  // namespace

std::optional<std::string> reason_not_faceted(const io::openmc::Model& model, const Region& region,
                                              std::uint32_t segments,
                                              const HalfSpaceRegion& window) {
  std::optional<std::string> reason;
  csg::for_each_primitive(region, [&](const SurfaceSide& side) {
    const Surface& surface = model.surfaces[side.surface];
    const std::optional<Polynomial> f = reason ? std::nullopt : polynomial_of(surface);
    if (reason || (f && normal_form(*f)) || (!f && has_ring(surface, segments))) return;
    reason = fmt::format(
        "surface {}, a {}, is no plane, sphere, cylinder, cone, ellipsoid or torus with a hole",
        surface.id, surface.type);
  });
  csg::for_each_primitive(window, [&](const io::openmc::HalfSpace& half_space) {
    const std::optional<Polynomial> f = reason ? std::nullopt : polynomial_of(half_space);
    if (reason || (f && normal_form(*f))) return;
    reason =
        "a surface above, through which it is seen, is no plane, sphere, cylinder, cone or "
        "ellipsoid";
  });
  return reason;
}

FacetedRegion faceted(const io::openmc::Model& model, const Region& region, const Box& box,
                      std::uint32_t segments, const HalfSpaceRegion& window) {
  const SideRegion above = csg::map(window, [](const io::openmc::HalfSpace& half_space) {
    return Side{nullptr, &half_space, is_complement(half_space)};
  });
  return Faceter(box, segments)(csg::intersect(sides_of(model, region), above));
}

}  // namespace exactcsg::verify
