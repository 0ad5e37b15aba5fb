// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The domains that the conformance suite is run on: one row each. A row makes random sets together
// with their definition in plain rational arithmetic, written here from the geometry (distances,
// not the library's polynomials), and one point of the boundary.

#include <array>
#include <functional>
#include <tuple>
#include <vector>

#include "domain/random_rationals.hpp"
#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/domain/classify.hpp"
#include "exactcsg/domain/curve_region.hpp"
#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/domain/surface_half_space.hpp"

namespace exactcsg::domain::test {

template <class S, std::size_t D>
struct Sample {
  S set;
  std::function<Rational(const Coordinates<D>&)> value;  // < 0 inside, 0 on the boundary
  Coordinates<D> boundary_point;

  PointClass reference(const Coordinates<D>& x) const {
    const Rational at = value(x);
    return at < 0 ? PointClass::In : at == 0 ? PointClass::On : PointClass::Out;
  }
};

template <std::size_t D>
Coordinates<D> difference(const Coordinates<D>& p, const Coordinates<D>& q) {
  Coordinates<D> result;
  for (std::size_t i = 0; i < D; ++i) result[i] = p[i] - q[i];
  return result;
}
template <std::size_t D>
Rational scalar_product(const Coordinates<D>& u, const Coordinates<D>& v) {
  Rational result;
  for (std::size_t i = 0; i < D; ++i) result += u[i] * v[i];
  return result;
}
template <std::size_t D>
Rational squared(const Coordinates<D>& v) {
  return scalar_product(v, v);
}
template <std::size_t D>
Coordinates<D> moved(const Coordinates<D>& p, const Rational& factor, const Coordinates<D>& v) {
  Coordinates<D> result;
  for (std::size_t i = 0; i < D; ++i) result[i] = p[i] + factor * v[i];
  return result;
}

// Points where a filter cannot tell: second intersections of lines through a boundary point with
// the surface, which are rational.
template <std::size_t D>
Coordinates<D> point_of_surface(const Quadric<D>& surface, const Coordinates<D>& boundary_point,
                                Random& random) {
  Coordinates<D> direction = random.direction<D>();
  if (surface.is_linear()) {
    // Along the surface: take away the part along the normal.
    const Coordinates<D>& normal = surface.linear().normal;
    direction =
        moved(direction, Rational(-scalar_product(normal, direction) / squared(normal)), normal);
    return moved(boundary_point, random.rational(), direction);
  }
  const LineSection<D> line{boundary_point, direction, {}, {}};
  const QuadraticPolynomial along = restrict(surface, line);
  if (along.square == 0) return boundary_point;
  return line.at(Rational(-along.linear / along.square)).coordinates();
}

// What the rows of half-spaces share.
template <std::size_t D>
struct HalfSpaceRow {
  static constexpr std::size_t dimension = D;
  static constexpr bool is_exact_for_boxes = true;
  static Coordinates<D> degenerate_point(const Sample<HalfSpace<D>, D>& sample, Random& random) {
    return point_of_surface(sample.set.polynomial(), sample.boundary_point, random);
  }
};

struct LineRow : HalfSpaceRow<2> {
  static constexpr const char* name = "line";
  static Sample<HalfSpace<2>, 2> sample(Random& random) {
    const Coordinates<2> p = random.coordinates<2>();
    const Coordinates<2> d = random.direction<2>();
    const auto value = [p, d](const Coordinates<2>& x) {
      return Rational(d[1] * (x[0] - p[0]) - d[0] * (x[1] - p[1]));
    };
    return {make_line(Point<2>(p), Point<2>(moved(p, 1, d))), value, p};
  }
};

// Centre and a boundary point; the radius is their distance, mostly irrational.
template <std::size_t D>
Sample<HalfSpace<D>, D> sample_of_ball(Random& random) {
  const Coordinates<D> centre = random.coordinates<D>();
  const Coordinates<D> to_boundary = random.direction<D>();
  const Rational squared_radius = squared(to_boundary);
  const auto value = [centre, squared_radius](const Coordinates<D>& x) {
    return Rational(squared(difference(x, centre)) - squared_radius);
  };
  return {make_ball<D>(centre, squared_radius), value, moved(centre, 1, to_boundary)};
}

struct DiscRow : HalfSpaceRow<2> {
  static constexpr const char* name = "disc";
  static Sample<HalfSpace<2>, 2> sample(Random& random) { return sample_of_ball<2>(random); }
};

struct SphereRow : HalfSpaceRow<3> {
  static constexpr const char* name = "sphere";
  static Sample<HalfSpace<3>, 3> sample(Random& random) { return sample_of_ball<3>(random); }
};

struct PlaneRow : HalfSpaceRow<3> {
  static constexpr const char* name = "plane";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    const Coordinates<3> p = random.coordinates<3>();
    const Coordinates<3> normal = random.direction<3>();
    const auto value = [p, normal](const Coordinates<3>& x) {
      return Rational(scalar_product(normal, difference(x, p)));
    };
    return {make_plane(normal, Rational(-scalar_product(normal, p))), value, p};
  }
};

// Of the vector from the axis's point to x: the part along the axis, and the one across it.
struct AxialParts {
  Rational height;            // along, in units of the direction's length
  Rational squared_distance;  // across
  AxialParts(const Axis& axis, const Coordinates<3>& x) {
    const Coordinates<3> v = difference(x, axis.point.coordinates());
    height = scalar_product(v, axis.direction) / squared(axis.direction);
    squared_distance = squared(moved(v, Rational(-height), axis.direction));
  }
};

inline Axis random_axis(Random& random) {
  Axis axis{random.coordinates<3>(), random.direction<3>()};
  if (random.one_in(3)) axis.direction = {0, 0, 1};
  return axis;
}

struct CylinderRow : HalfSpaceRow<3> {
  static constexpr const char* name = "cylinder";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    const Axis axis = random_axis(random);
    for (;;) {
      const Coordinates<3> p = random.coordinates<3>();
      const Rational squared_radius = AxialParts(axis, p).squared_distance;
      if (squared_radius == 0) continue;
      const auto value = [axis, squared_radius](const Coordinates<3>& x) {
        return Rational(AxialParts(axis, x).squared_distance - squared_radius);
      };
      return {make_cylinder(axis, squared_radius), value, p};
    }
  }
};

template <bool one_nappe>
Sample<HalfSpace<3>, 3> sample_of_cone(Random& random) {
  Axis axis = random_axis(random);
  for (;;) {
    const Coordinates<3> p = random.coordinates<3>();
    const AxialParts parts(axis, p);
    if (parts.height == 0 || parts.squared_distance == 0) continue;
    if (one_nappe && parts.height < 0) {
      for (Rational& component : axis.direction) component = -component;
    }
    const Rational length = squared(axis.direction);
    const Rational squared_slope = parts.squared_distance / (parts.height * parts.height * length);
    const auto value = [axis, squared_slope, length](const Coordinates<3>& x) {
      const AxialParts at(axis, x);
      if (one_nappe && at.height < 0) return squared(difference(x, axis.point.coordinates()));
      return Rational(at.squared_distance - squared_slope * at.height * at.height * length);
    };
    return {one_nappe ? make_cone(axis, squared_slope) : make_double_cone(axis, squared_slope),
            value, p};
  }
}

struct DoubleConeRow : HalfSpaceRow<3> {
  static constexpr const char* name = "double_cone";
  static Sample<HalfSpace<3>, 3> sample(Random& random) { return sample_of_cone<false>(random); }
};

struct ConeRow : HalfSpaceRow<3> {
  static constexpr const char* name = "cone";
  static Sample<HalfSpace<3>, 3> sample(Random& random) { return sample_of_cone<true>(random); }
};

struct EllipsoidRow : HalfSpaceRow<3> {
  static constexpr const char* name = "ellipsoid";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    const Coordinates<3> centre = random.coordinates<3>();
    Coordinates<3> semi_axes;
    for (Rational& length : semi_axes) length = random.positive();
    const auto value = [centre, semi_axes](const Coordinates<3>& x) {
      Rational sum = -1;
      for (std::size_t i = 0; i < 3; ++i) {
        const Rational share = (x[i] - centre[i]) / semi_axes[i];
        sum += share * share;
      }
      return sum;
    };
    Coordinates<3> squares;
    for (std::size_t i = 0; i < 3; ++i) squares[i] = semi_axes[i] * semi_axes[i];
    const Coordinates<3> end_of_axis{Rational(centre[0] + semi_axes[0]), centre[1], centre[2]};
    return {make_ellipsoid<3>(centre, squares), value, end_of_axis};
  }
};

// A bounded primitive: convex, so that its value is the greatest of those of its surfaces.
struct TreeSample : Sample<Solid3, 3> {
  std::function<Coordinates<3>(Random&)> on_surface;
};
struct TreeRow {
  static constexpr std::size_t dimension = 3;
  static constexpr bool is_exact_for_boxes = false;
  static Coordinates<3> degenerate_point(const TreeSample& sample, Random& random) {
    return sample.on_surface(random);
  }
};

// Coordinates on, between and beyond those of the box.
inline Coordinates<3> point_of_grid(const Box<3>& box, Random& random) {
  Coordinates<3> point;
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational size = box.upper()[i] - box.lower()[i];
    point[i] = box.lower()[i] + size * random.integer(-1, 4) / 3;
  }
  return point;
}

inline Rational value_of_box(const Box<3>& box, const Coordinates<3>& x) {
  Rational value = box.lower()[0] - x[0];
  for (std::size_t i = 0; i < 3; ++i) {
    value = std::max({value, Rational(box.lower()[i] - x[i]), Rational(x[i] - box.upper()[i])});
  }
  return value;
}

struct BlockRow : TreeRow {
  static constexpr const char* name = "block";
  static TreeSample sample(Random& random) {
    const Box<3> box = random.box<3>();
    return {{make_block(box), [box](const auto& x) { return value_of_box(box, x); },
             box.lower().coordinates()},
            [box](Random& r) { return point_of_grid(box, r); }};
  }
};

struct WedgeRow : TreeRow {
  static constexpr const char* name = "wedge";
  static TreeSample sample(Random& random) {
    const Box<3> box = random.box<3>();
    const auto value = [box](const Coordinates<3>& x) {
      Rational sum = -1;
      for (std::size_t i = 0; i < 2; ++i) {
        sum += (x[i] - box.lower()[i]) / (box.upper()[i] - box.lower()[i]);
      }
      return std::max(value_of_box(box, x), sum);
    };
    return {{make_wedge(box), value, box.lower().coordinates()},
            [box](Random& r) { return point_of_grid(box, r); }};
  }
};

struct BoundedBallRow : TreeRow {
  static constexpr const char* name = "bounded_ball";
  static TreeSample sample(Random& random) {
    const Coordinates<3> centre = random.coordinates<3>();
    const Coordinates<3> radius = random.direction<3>();
    const Rational squared_radius = squared(radius);
    const auto value = [=](const Coordinates<3>& x) {
      return Rational(squared(difference(x, centre)) - squared_radius);
    };
    const Solid3 ball = make_bounded_ball(centre, squared_radius);
    const Coordinates<3> pole = moved(centre, 1, radius);
    return {{ball, value, pole},
            [=](Random& r) { return point_of_surface(ball.primitive().polynomial(), pole, r); }};
  }
};

// Points of the round surface and of its rims: the point at that height on a line through `from`
// along a ruling.
struct BoundedCylinderRow : TreeRow {
  static constexpr const char* name = "bounded_cylinder";
  static TreeSample sample(Random& random) {
    const Axis axis = random_axis(random);
    for (;;) {
      const Coordinates<3> p = random.coordinates<3>();
      const AxialParts parts(axis, p);
      const Rational squared_radius = parts.squared_distance;
      if (squared_radius == 0) continue;
      const auto value = [=](const Coordinates<3>& x) {
        const AxialParts at(axis, x);
        return std::max({Rational(-at.height), Rational(at.height - 1),
                         Rational(at.squared_distance - squared_radius)});
      };
      const Quadric<3> surface = make_cylinder(axis, squared_radius).polynomial();
      const auto on_surface = [=](Random& r) {
        const Coordinates<3> point = point_of_surface(surface, p, r);
        if (r.one_in(3)) return point;
        const Rational height = r.one_in(2) ? Rational(r.integer(0, 1)) : r.rational();
        return moved(point, Rational(height - AxialParts(axis, point).height), axis.direction);
      };
      return {{make_bounded_cylinder(axis, squared_radius), value,
               moved(p, Rational(Rational(1, 2) - parts.height), axis.direction)},
              on_surface};
    }
  }
};

struct BoundedConeRow : TreeRow {
  static constexpr const char* name = "bounded_cone";
  static TreeSample sample(Random& random) {
    const Axis axis = random_axis(random);
    const Coordinates<3> apex = moved(axis.point.coordinates(), 1, axis.direction);
    for (;;) {
      // A point of the rim: across the axis from its point.
      const Coordinates<3> v = random.direction<3>();
      const AxialParts parts(axis, moved(axis.point.coordinates(), 1, v));
      const Rational squared_radius = parts.squared_distance;
      if (squared_radius == 0) continue;
      const Coordinates<3> rim =
          moved(moved(axis.point.coordinates(), 1, v), Rational(-parts.height), axis.direction);
      const auto value = [=](const Coordinates<3>& x) {
        const AxialParts at(axis, x);
        const Rational below = 1 - at.height;
        if (below < 0) return squared(difference(x, apex));
        return std::max(Rational(-at.height),
                        Rational(at.squared_distance - squared_radius * below * below));
      };
      const Solid3 cone = make_bounded_cone(axis, squared_radius);
      const Quadric<3> surface = cone.children().back().primitive().polynomial();
      const auto on_surface = [=](Random& r) {
        if (r.one_in(10)) return apex;
        const Coordinates<3> point = point_of_surface(surface, rim, r);
        const Rational below = 1 - AxialParts(axis, point).height;
        if (r.one_in(2) || below == 0) return point;
        // Along the ruling to the base, or anywhere.
        const Rational factor = r.one_in(2) ? Rational(1 / below) : r.rational();
        return moved(apex, factor, difference(point, apex));
      };
      return {{cone, value, rim}, on_surface};
    }
  }
};

// A polygon that is star-shaped about its centre: corners in the eight directions of a compass.
struct CurveSample : Sample<CurveRegion, 2> {
  std::vector<Coordinates<2>> corners;
};

// Crossings of the ray to the right of x, counted edge by edge in rationals.
inline int class_by_edges(const std::vector<Coordinates<2>>& corners, const Coordinates<2>& x) {
  bool inside = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Coordinates<2>& p = corners[i];
    const Coordinates<2>& q = corners[(i + 1) % corners.size()];
    const Coordinates<2> along = difference(q, p);
    const Coordinates<2> to_x = difference(x, p);
    const Rational side = along[0] * to_x[1] - along[1] * to_x[0];
    const Rational share = scalar_product(along, to_x);
    if (side == 0 && share >= 0 && share <= squared(along)) return 0;
    const bool is_upward = p[1] <= x[1] && x[1] < q[1];
    const bool is_downward = q[1] <= x[1] && x[1] < p[1];
    if ((is_upward && side > 0) || (is_downward && side < 0)) inside = !inside;
  }
  return inside ? -1 : 1;
}

struct StripTreeRow {
  static constexpr const char* name = "strip_tree";
  static constexpr std::size_t dimension = 2;
  // The value only has a sign, which no search can follow; see CurveRegion.BoxesAreExact.
  static constexpr bool is_exact_for_boxes = false;

  static CurveSample sample(Random& random) {
    static constexpr std::array<std::array<int, 2>, 8> compass{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
    const double x = static_cast<double>(random.integer(-8, 8)) / 4;
    const double y = static_cast<double>(random.integer(-8, 8)) / 4;
    std::vector<CurvePoint> points;
    for (const auto& [east, north] : compass) {
      const double reach = static_cast<double>(random.integer(1, 16)) / 4;
      points.push_back({x + reach * east, y + reach * north});
    }
    std::vector<Coordinates<2>> corners;
    for (const CurvePoint& p : points) corners.push_back({Rational(p.x), Rational(p.y)});
    points.push_back(points.front());
    const auto value = [corners](const Coordinates<2>& at) {
      return Rational(class_by_edges(corners, at));
    };
    return {{CurveRegion(make_strip_tree(points)), value, corners.front()}, corners};
  }

  // A point of an edge, its ends included.
  static Coordinates<2> degenerate_point(const CurveSample& sample, Random& random) {
    const auto i = static_cast<std::size_t>(random.integer(0, 7));
    const Coordinates<2>& p = sample.corners[i];
    const Rational share = Rational(random.integer(0, 7)) / 7;
    return moved(p, share, difference(sample.corners[(i + 1) % 8], p));
  }
};

// A torus with a rational frame, of which rational points are known: the ends of rational radii of
// the circle through its axis, turned round the axis by a rational rotation.
struct TorusSample : Sample<Torus, 3> {
  Coordinates<3> centre;
  std::array<Coordinates<3>, 3> frame;  // orthonormal; the last is the axis
  Rational major, along, across;

  Coordinates<3> at(const std::array<Rational, 2>& round_tube,
                    const std::array<Rational, 2>& round_axis) const {
    const Rational rho = major + across * round_tube[0];
    Coordinates<3> result = moved(centre, Rational(along * round_tube[1]), frame[2]);
    result = moved(result, Rational(rho * round_axis[0]), frame[0]);
    return moved(result, Rational(rho * round_axis[1]), frame[1]);
  }
};

// A point of the unit circle.
inline std::array<Rational, 2> point_of_circle(Random& random) {
  const Rational t = random.rational();
  const Rational scale = 1 / (1 + t * t);
  return {Rational((1 - t * t) * scale), Rational(2 * t * scale)};
}

// The columns of the rotation by a quaternion.
inline std::array<Coordinates<3>, 3> rational_frame(int w, int x, int y, int z) {
  const Rational n = w * w + x * x + y * y + z * z;
  return {{{Rational((w * w + x * x - y * y - z * z) / n), Rational(2 * (x * y + w * z) / n),
            Rational(2 * (x * z - w * y) / n)},
           {Rational(2 * (x * y - w * z) / n), Rational((w * w - x * x + y * y - z * z) / n),
            Rational(2 * (y * z + w * x) / n)},
           {Rational(2 * (x * z + w * y) / n), Rational(2 * (y * z - w * x) / n),
            Rational((w * w - x * x - y * y + z * z) / n)}}};
}

// General quadrics: in a rational frame at a point, the sum of signed squares of coordinates in
// units of lengths, plus a multiple of the third coordinate, is at most a constant.
struct Signature {
  std::array<int, 3> squares;
  int along_third;
  int constant;
};

inline Sample<HalfSpace<3>, 3> sample_of_quadric(Random& random, const Signature& signature) {
  const auto number = [&] { return static_cast<int>(random.integer(1, 3)); };
  const auto frame = rational_frame(number(), number(), number(), number());
  const Coordinates<3> centre = random.coordinates<3>();
  Coordinates<3> lengths;
  for (Rational& length : lengths) length = random.positive();
  const auto value = [=](const Coordinates<3>& x) {
    const Coordinates<3> v = difference(x, centre);
    Rational sum = -signature.constant;
    for (std::size_t i = 0; i < 3; ++i) {
      const Rational share = scalar_product(v, frame[i]) / lengths[i];
      sum += signature.squares[i] * share * share;
    }
    return Rational(sum + signature.along_third * scalar_product(v, frame[2]));
  };
  // The value is c + b'v + v'Av.
  Quadric<3>::Matrix square;
  Coordinates<3> slope = moved<3>({}, Rational(signature.along_third), frame[2]);
  Rational constant = -signature.constant - scalar_product(slope, centre);
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational factor = signature.squares[i] / (lengths[i] * lengths[i]);
    const Rational shift = scalar_product(centre, frame[i]);
    constant += factor * shift * shift;
    slope = moved(slope, Rational(-2 * factor * shift), frame[i]);
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) square[j][k] += factor * frame[i][j] * frame[i][k];
    }
  }
  // Where a square alone makes up for the constant; a paraboloid passes through its own point.
  Coordinates<3> on_boundary = centre;
  for (std::size_t i = 0; i < 3 && signature.constant != 0; ++i) {
    if (signature.squares[i] != signature.constant) continue;
    on_boundary = moved(centre, lengths[i], frame[i]);
    break;
  }
  return {HalfSpace<3>(Quadric<3>(square, {slope, constant})), value, on_boundary};
}

struct TiltedEllipsoidRow : HalfSpaceRow<3> {
  static constexpr const char* name = "tilted_ellipsoid";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    return sample_of_quadric(random, {{1, 1, 1}, 0, 1});
  }
};
struct OneSheetRow : HalfSpaceRow<3> {
  static constexpr const char* name = "hyperboloid_of_one_sheet";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    return sample_of_quadric(random, {{1, 1, -1}, 0, 1});
  }
};
struct TwoSheetsRow : HalfSpaceRow<3> {
  static constexpr const char* name = "hyperboloid_of_two_sheets";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    return sample_of_quadric(random, {{1, 1, -1}, 0, -1});
  }
};
struct EllipticParaboloidRow : HalfSpaceRow<3> {
  static constexpr const char* name = "elliptic_paraboloid";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    return sample_of_quadric(random, {{1, 1, 0}, -1, 0});
  }
};
struct HyperbolicParaboloidRow : HalfSpaceRow<3> {
  static constexpr const char* name = "hyperbolic_paraboloid";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    return sample_of_quadric(random, {{1, -1, 0}, -1, 0});
  }
};
struct ParabolicCylinderRow : HalfSpaceRow<3> {
  static constexpr const char* name = "parabolic_cylinder";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    return sample_of_quadric(random, {{1, 0, 0}, -1, 0});
  }
};
struct HyperbolicCylinderRow : HalfSpaceRow<3> {
  static constexpr const char* name = "hyperbolic_cylinder";
  static Sample<HalfSpace<3>, 3> sample(Random& random) {
    return sample_of_quadric(random, {{1, -1, 0}, 0, 1});
  }
};

inline TorusSample sample_of_torus(Random& random, const std::array<Coordinates<3>, 3>& frame) {
  TorusSample sample{{make_torus({{0, 0, 0}, {0, 0, 1}}, 3, 1, 1), {}, {}}, {}, frame, 0, 0, 0};
  sample.centre = random.coordinates<3>();
  sample.major = random.positive();
  sample.along = random.positive();
  sample.across = random.one_in(4) ? sample.major : random.positive();  // a horn torus
  if (random.one_in(3)) sample.along = sample.across;                   // a circular one
  Coordinates<3> direction{};
  direction = moved(direction, random.positive(), frame[2]);
  sample.set =
      make_torus({Point<3>(sample.centre), direction}, sample.major, sample.along, sample.across);
  const auto [centre, axis, a, b, c] =
      std::tuple(sample.centre, frame[2], sample.major, sample.along, sample.across);
  // (rho - a)^2 / c^2 + z^2 / b^2 <= 1 without roots: h <= 2 a rho.
  sample.value = [centre = centre, axis = axis, a = a, b = b, c = c](const Coordinates<3>& x) {
    const Rational z = scalar_product(difference(x, centre), axis);
    const Rational rho_squared = squared(difference(x, centre)) - z * z;
    const Rational h = rho_squared + a * a - c * c * (1 - z * z / (b * b));
    const Rational right = 4 * a * a * rho_squared;
    return h < 0 ? Rational(-right - h * h) : Rational(h * h - right);
  };
  sample.boundary_point = sample.at({1, 0}, point_of_circle(random));
  return sample;
}

struct TorusRow {
  static constexpr const char* name = "torus";
  static constexpr std::size_t dimension = 3;
  static constexpr bool is_exact_for_boxes = true;
  static TorusSample sample(Random& random) {
    const auto axis = static_cast<std::size_t>(random.integer(0, 2));
    std::array<Coordinates<3>, 3> frame;
    for (std::size_t i = 0; i < 3; ++i) frame[i][(axis + 1 + i) % 3] = 1;
    return sample_of_torus(random, frame);
  }
  static Coordinates<3> degenerate_point(const TorusSample& sample, Random& random) {
    std::array<Rational, 2> round_tube = point_of_circle(random);
    if (sample.across > sample.major) round_tube[0] = abs(round_tube[0]);  // not of the lemon
    return sample.at(round_tube, point_of_circle(random));
  }
};

// Boxes are not decided exactly if nothing is parallel.
struct TiltedTorusRow : TorusRow {
  static constexpr const char* name = "tilted torus";
  static constexpr bool is_exact_for_boxes = false;
  static TorusSample sample(Random& random) {
    const auto number = [&] { return static_cast<int>(random.integer(1, 3)); };
    return sample_of_torus(random, rational_frame(number(), number(), number(), number()));
  }
};

// The same as one of the kinds of surfaces that trees of both have.
struct SurfaceRow : TorusRow {
  static constexpr const char* name = "half-space of a surface";
  struct Either : Sample<SurfaceHalfSpace, 3> {
    std::function<Coordinates<3>(Random&)> degenerate_point;
  };
  template <class Row>
  static Either sample_of(Random& random) {
    const auto s = Row::sample(random);
    const auto point = [s](Random& r) { return Row::degenerate_point(s, r); };
    return {{s.set, s.value, s.boundary_point}, point};
  }
  static Either sample(Random& random) {
    return random.one_in(2) ? sample_of<TorusRow>(random) : sample_of<SphereRow>(random);
  }
  static Coordinates<3> degenerate_point(const Either& sample, Random& random) {
    return sample.degenerate_point(random);
  }
};

// One row for each domain.
using Rows = std::tuple<LineRow,                  //
                        DiscRow,                  //
                        PlaneRow,                 //
                        SphereRow,                //
                        CylinderRow,              //
                        DoubleConeRow,            //
                        ConeRow,                  //
                        EllipsoidRow,             //
                        TiltedEllipsoidRow,       //
                        OneSheetRow,              //
                        TwoSheetsRow,             //
                        EllipticParaboloidRow,    //
                        HyperbolicParaboloidRow,  //
                        ParabolicCylinderRow,     //
                        HyperbolicCylinderRow,    //
                        BlockRow,                 //
                        BoundedBallRow,           //
                        BoundedCylinderRow,       //
                        BoundedConeRow,           //
                        WedgeRow,                 //
                        TorusRow,                 //
                        TiltedTorusRow,           //
                        SurfaceRow,               //
                        StripTreeRow>;

}  // namespace exactcsg::domain::test
