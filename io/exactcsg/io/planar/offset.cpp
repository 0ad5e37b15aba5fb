// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/planar/offset.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "exactcsg/io/planar/outline.hpp"
#include "exactcsg/io/planar/substitute.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io {

namespace {

// Clipper's integers are 2^16 to OpenSCAD's unit; its arcs are cut by a tolerance in integers.
constexpr double clipper_scale = 65536.0;
constexpr double least_tolerance = 0.25;
// OpenSCAD's miter limit is a million: sharper corners are cut square.
constexpr double least_miter = 2e-12;
constexpr double least_turn = 0x1p-20;
constexpr double largest_arc = 2'000'000;

struct Vector2 {
  Rational x, y;
};

Point2 operator+(const Point2& p, const Vector2& v) { return {p.x + v.x, p.y + v.y}; }
Vector2 operator-(const Point2& p, const Point2& q) { return {p.x - q.x, p.y - q.y}; }
Vector2 operator*(const Rational& s, const Vector2& v) { return {s * v.x, s * v.y}; }
Rational cross(const Vector2& u, const Vector2& v) { return u.x * v.y - u.y * v.x; }
Rational dot(const Vector2& u, const Vector2& v) { return u.x * v.x + u.y * v.y; }

std::optional<Rational> rational_root(const Rational& square) {
  if (mpz_perfect_square_p(square.get_num_mpz_t()) == 0 ||
      mpz_perfect_square_p(square.get_den_mpz_t()) == 0) {
    return std::nullopt;
  }
  return Rational(sqrt(square.get_num()), sqrt(square.get_den()));
}

// An edge and the unit normal on its right.
struct Edge {
  Vector2 along;
  Vector2 normal;
  double x = 0, y = 0;  // the normal
  double length = 0;    // of `along`; for the chamfer alone
  bool exact = false;
};

Edge edge_between(const Point2& from, const Point2& to) {
  Edge edge;
  edge.along = to - from;
  const Rational largest = std::max(Rational(abs(edge.along.x)), Rational(abs(edge.along.y)));
  // With a largest component of 1 no double overflows or underflows. With u = 2^-53: components are
  // off by u, squares by 3 u, their sum by 4 u, the root by 3 u and the quotient by 5 u < 2^-50.
  const double u = nearest_double(edge.along.x / largest);
  const double v = nearest_double(edge.along.y / largest);
  const double root = std::sqrt(u * u + v * v);
  edge.x = v / root;
  edge.y = -u / root;
  edge.length = nearest_double(largest) * root;
  if (const auto length = rational_root(dot(edge.along, edge.along))) {
    edge.normal = {edge.along.y / *length, -edge.along.x / *length};
    edge.exact = true;
  } else {
    edge.normal = {rational_of(edge.x), rational_of(edge.y)};
  }
  return edge;
}

class Offsetter {
 public:
  explicit Offsetter(const Offset& parameters)
      : distance_(parameters.distance), corner_(parameters.corner) {
    const double size = std::fabs(nearest_double(distance_));
    const double scaled = size * clipper_scale;
    double tolerance = parameters.arc_tolerance * clipper_scale;
    tolerance = tolerance <= 0 ? least_tolerance : std::min(tolerance, scaled * least_tolerance);
    const double steps =
        std::min(std::numbers::pi / std::acos(1 - tolerance / scaled), scaled * std::numbers::pi);
    step_angle_ = 2 * std::numbers::pi / steps;
    steps_per_radian_ = steps / (2 * std::numbers::pi);
    if (!(steps < largest_arc)) {
      throw Error(ErrorId::TooLarge, {"an arc of " + std::to_string(steps) + " pieces", ""});
    }
  }

  void walk(const std::vector<Point2>& path) {
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < path.size(); ++i) {
      edges.push_back(edge_between(path[i], path[(i + 1) % path.size()]));
    }
    for (std::size_t i = 0; i < path.size(); ++i) {
      const std::size_t next = (i + 1) % path.size();
      const Vector2 shift = distance_ * edges[i].normal;
      swept_.push_back(
          PlanarTree::primitive({{{path[i], path[next], path[next] + shift, path[i] + shift}}}));
      note_rounding(edges[i], 1);
      const Rational turn = cross(edges[i].along, edges[next].along);
      if (sgn(turn) * sgn(distance_) > 0) add_corner(path[next], edges[i], edges[next]);
    }
  }

  std::vector<PlanarTree> take_swept() { return std::move(swept_); }
  const Rational& rounding() const { return rounding_; }

 private:
  // Of a vertex that is `factor` times as far off as the displaced edge.
  void note_rounding(const Edge& edge, const Rational& factor) {
    if (edge.exact) return;
    static const Rational unit(1, Integer(1) << 50U);
    rounding_ = std::max(rounding_, Rational(unit * abs(distance_) * factor));
  }

  void add_corner(const Point2& vertex, const Edge& before, const Edge& after) {
    std::vector<Point2> path{vertex, vertex + distance_ * before.normal};
    const double angle = std::fabs(angle_between(before, after));
    if (angle < least_turn) {
      // Prolonged, edges so nearly parallel would meet wherever their rounding says. The corner is
      // cut straight, which leaves out less than angle^2 / 8 of the distance.
      static const Rational unit(1, Integer(1) << 42U);
      rounding_ = std::max(rounding_, Rational(unit * abs(distance_)));
    } else if (corner_ == OffsetCorner::Round) {
      add_arc(path, vertex, before, after);
    } else if (corner_ == OffsetCorner::Sharp &&
               1 + (before.x * after.x + before.y * after.y) >= least_miter) {
      add_miter(path, vertex, before, after);
    } else {
      add_chamfer(path, vertex, before, after);
    }
    path.push_back(vertex + distance_ * after.normal);
    swept_.push_back(PlanarTree::primitive({{std::move(path)}}));
  }

  static double angle_between(const Edge& before, const Edge& after) {
    return std::atan2(before.x * after.y - after.x * before.y,
                      before.x * after.x + before.y * after.y);
  }

  void add_arc(std::vector<Point2>& path, const Point2& vertex, const Edge& before,
               const Edge& after) {
    const double turn = angle_between(before, after);
    const double steps = std::max(std::round(steps_per_radian_ * std::fabs(turn)), 1.0);
    for (double i = 1; i < steps; i += 1) {
      const double angle = std::copysign(i * step_angle_, turn);
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      path.push_back(vertex + distance_ * Vector2{rational_of(before.x * c - before.y * s),
                                                  rational_of(before.x * s + before.y * c)});
    }
    static const Rational unit(1, Integer(1) << 47U);
    if (steps > 1) rounding_ = std::max(rounding_, Rational(unit * abs(distance_)));
  }

  void add_miter(std::vector<Point2>& path, const Point2& vertex, const Edge& before,
                 const Edge& after) {
    const Point2 first = vertex + distance_ * before.normal;
    const Point2 second = vertex + distance_ * after.normal;
    const Rational turn = cross(before.along, after.along);
    path.push_back(first + Rational(cross(second - first, after.along) / turn) * before.along);
    // Where two lines meet moves by at most 2 e / sin(angle) if each is displaced by e.
    const Rational factor = 1 + 2 / rational_of(std::fabs(std::sin(angle_between(before, after))));
    note_rounding(before, factor);
    note_rounding(after, factor);
  }

  // Points at the same way along both displaced edges: exactly on them.
  void add_chamfer(std::vector<Point2>& path, const Point2& vertex, const Edge& before,
                   const Edge& after) {
    const double way = nearest_double(distance_) * std::tan(angle_between(before, after) / 4);
    const Rational forward = rational_of(way / before.length);
    const Rational backward = rational_of(-way / after.length);
    path.push_back(vertex + distance_ * before.normal + forward * before.along);
    path.push_back(vertex + distance_ * after.normal + backward * after.along);
    static const Rational unit(1, Integer(1) << 47U);
    rounding_ = std::max(rounding_, Rational(unit * abs(distance_)));
  }

  Rational distance_;
  OffsetCorner corner_;
  double step_angle_ = 0;
  double steps_per_radian_ = 0;
  std::vector<PlanarTree> swept_;
  Rational rounding_{0};
};

}  // namespace

OffsetResult offset(const PlanarTree& tree, const Offset& parameters) {
  OffsetResult result{resolve(tree)};
  if (parameters.distance == 0 || result.figure.paths.empty()) return result;
  Offsetter offsetter(parameters);
  for (const auto& path : result.figure.paths) offsetter.walk(path);
  result.rounding = offsetter.rounding();
  PlanarTree whole = PlanarTree::primitive(std::move(result.figure));
  std::vector<PlanarTree> swept = offsetter.take_swept();
  if (parameters.distance > 0) {
    swept.push_back(std::move(whole));
    result.figure = resolve(unite_all(std::move(swept)));
  } else {
    result.figure = resolve(PlanarTree::compose(csg::BooleanOperator::Difference,
                                                {std::move(whole), unite_all(std::move(swept))}));
  }
  return result;
}

}  // namespace exactcsg::io
