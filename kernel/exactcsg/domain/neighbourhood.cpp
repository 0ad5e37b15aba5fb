// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/domain/neighbourhood.hpp"

#include <algorithm>
#include <array>

#include "exactcsg/domain/torus_frame.hpp"
#include "exactcsg/domain/vector.hpp"

namespace exactcsg::domain {

namespace {

using Vector2 = Coordinates<2>;
using Vector = Coordinates<3>;

using detail::is_zero;
using detail::scalar_product;
using detail::scaled;
using detail::sum;
using detail::vector_product;

bool parallel(const Vector& u, const Vector& v) { return is_zero(vector_product(u, v)); }
bool parallel(const Vector2& u, const Vector2& v) { return u[0] * v[1] == u[1] * v[0]; }

// By a quarter turn, counter-clockwise.
Vector2 turned(const Vector2& v) { return {-v[1], v[0]}; }

// A surface through the point, with its gradient there.
template <std::size_t D>
struct Surface {
  const Quadric<D>* f;
  const Torus* torus;
  Coordinates<D> gradient;

  // REQUIRES parallel gradients
  bool is_same_set(const Surface& other) const {
    if (torus != nullptr || other.torus != nullptr) return torus == other.torus;
    const Rational here = scalar_product(gradient, gradient);
    const Rational there = scalar_product(gradient, other.gradient);
    return there * *f == here * *other.f;
  }
};

template <std::size_t D>
std::vector<Surface<D>> with_gradients(const Point<D>& point,
                                       std::span<const GermSurface<D>> surfaces) {
  std::vector<Surface<D>> result;
  for (const GermSurface<D>& surface : surfaces) {
    result.push_back(
        {surface.polynomial, surface.torus, surface.polynomial->gradient(point.coordinates())});
  }
  return result;
}

// Takes out the surfaces that have no tangent plane at the point, and returns them.
template <std::size_t D>
std::vector<Surface<D>> take_singular(std::vector<Surface<D>>& surfaces) {
  std::vector<Surface<D>> singular;
  for (Surface<D>& surface : surfaces) {
    if (is_zero(surface.gradient)) singular.push_back(surface);
  }
  std::erase_if(surfaces, [](const Surface<D>& s) { return is_zero(s.gradient); });
  return singular;
}

// u' A v
template <std::size_t D>
Rational bilinear(const Quadric<D>& f, const Coordinates<D>& u, const Coordinates<D>& v) {
  Rational value;
  for (std::size_t i = 0; i < D; ++i) value += u[i] * scalar_product(f.square()[i], v);
  return value;
}

// One of the vectors, or the sum of two of them, on which f does not vanish to second order; the
// basis is changed so that it is the last one. False if there is none.
template <std::size_t D>
bool move_curved_last(const Quadric<D>& f, std::vector<Coordinates<D>>& basis) {
  for (std::size_t i = 0; i < basis.size(); ++i) {
    for (std::size_t j = i; j < basis.size(); ++j) {
      const Coordinates<D> v = i == j ? basis[i] : sum(basis[i], basis[j]);
      if (f.half_curvature(v) == 0) continue;
      basis.erase(basis.begin() + static_cast<std::ptrdiff_t>(i));
      basis.push_back(v);
      return true;
    }
  }
  return false;
}

// Vectors v with v_i' A v_j = 0 for i != j, which Lagrange's method finds without roots: at the
// apex of a cone they show every sign that f has round it.
template <std::size_t D>
std::vector<Coordinates<D>> conjugate_directions(const Quadric<D>& f) {
  std::vector<Coordinates<D>> basis(D);
  for (std::size_t i = 0; i < D; ++i) basis[i][i] = 1;
  std::vector<Coordinates<D>> result;
  while (!basis.empty() && move_curved_last(f, basis)) {
    const Coordinates<D> v = basis.back();
    basis.pop_back();
    const Rational curvature = f.half_curvature(v);
    for (Coordinates<D>& w : basis) {
      w = sum(w, scaled(Rational(-bilinear(f, w, v) / curvature), v));
    }
    result.push_back(v);
  }
  return result;
}

// REQUIRES both are singular at the point, so that they consist of terms of degree two there.
template <std::size_t D>
bool is_same_cone(const Surface<D>& a, const Surface<D>& b) {
  if (a.torus != nullptr || b.torus != nullptr) return a.torus == b.torus;
  for (const Coordinates<D>& v : conjugate_directions(*a.f)) {
    return b.f->half_curvature(v) * *a.f == a.f->half_curvature(v) * *b.f;
  }
  return false;
}

// Those with components -1, 0 and 1.
template <std::size_t D>
void add_directions(Germs<D>& result) {
  Coordinates<D> direction;
  direction.fill(-1);
  for (;;) {
    if (!is_zero(direction)) result.germs.push_back({direction, {}, false});
    std::size_t axis = 0;
    while (axis < D && direction[axis] == 1) direction[axis++] = -1;
    if (axis == D) return;
    direction[axis] += 1;
  }
}

// Germs that show the cells of each singular surface alone. They are all cells if there is but one
// surface, since its own cells are the inside of either nappe and the outside; but not at the
// centre of a horn torus, outside of which no direction leads.
template <std::size_t D>
void add_singular(const std::vector<Surface<D>>& singular, bool alone, Germs<D>& result) {
  for (const Surface<D>& surface : singular) {
    for (const Coordinates<D>& direction : conjugate_directions(*surface.f)) {
      result.germs.push_back({direction, {}, false});
      result.germs.push_back({scaled(Rational(-1), direction), {}, false});
    }
    alone = alone && is_same_cone(surface, singular.front()) &&
            (surface.torus == nullptr || surface.torus->squared_ratio() != 1);
  }
  if (singular.empty() || alone) return;
  result.complete = false;
  add_directions(result);  // perhaps they show that the point is On
}

// Each point set once.
template <std::size_t D>
void remove_duplicates(std::vector<Surface<D>>& surfaces) {
  std::vector<Surface<D>> different;
  for (Surface<D>& surface : surfaces) {
    const bool known =
        std::any_of(different.begin(), different.end(), [&](const Surface<D>& other) {
          return parallel(surface.gradient, other.gradient) && surface.is_same_set(other);
        });
    if (!known) different.push_back(std::move(surface));
  }
  surfaces = std::move(different);
}

// The surfaces that have a tangent plane at the point, each point set once. The germs that show the
// cells of the others are added to the result.
template <std::size_t D>
std::vector<Surface<D>> regular_surfaces(const Point<D>& point,
                                         std::span<const GermSurface<D>> surfaces,
                                         Germs<D>& result) {
  std::vector<Surface<D>> regular = with_gradients(point, surfaces);
  const auto singular = take_singular(regular);
  add_singular(singular, regular.empty(), result);
  remove_duplicates(regular);
  return regular;
}

bool is_in_upper_half(const Vector2& v) { return v[1] > 0 || (v[1] == 0 && v[0] > 0); }

// Counter-clockwise from the positive x axis.
bool precedes(const Vector2& u, const Vector2& v) {
  if (is_in_upper_half(u) != is_in_upper_half(v)) return is_in_upper_half(u);
  return u[0] * v[1] > u[1] * v[0];
}
bool same_direction(const Vector2& u, const Vector2& v) {
  return parallel(u, v) && scalar_product(u, v) > 0;
}

// The directions along the lines with these normals, both ways, each once, counter-clockwise.
std::vector<Vector2> directions_of_lines(std::span<const Vector2> normals) {
  std::vector<Vector2> directions;
  for (const Vector2& normal : normals) {
    directions.push_back(turned(normal));
    directions.push_back(scaled(Rational(-1), directions.back()));
  }
  std::sort(directions.begin(), directions.end(), precedes);
  directions.erase(std::unique(directions.begin(), directions.end(), same_direction),
                   directions.end());
  return directions;
}

// One direction between each and the next. REQUIRES they are opposite in pairs
std::vector<Vector2> directions_between(std::span<const Vector2> directions) {
  std::vector<Vector2> result;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vector2& next = directions[(i + 1) % directions.size()];
    result.push_back(parallel(directions[i], next) ? turned(directions[i])
                                                   : sum(directions[i], next));
  }
  return result;
}

// Between the curves that leave the point along the direction, in the order of their curvatures.
void add_curved_germs(const std::vector<Surface<2>>& curves, const Vector2& direction,
                      Germs<2>& result) {
  const Vector2 normal = turned(direction);
  struct Curve {
    Rational curvature;
    const Surface<2>* curve;
  };
  std::vector<Curve> tangent;
  for (const Surface<2>& curve : curves) {
    if (scalar_product(curve.gradient, direction) != 0) continue;
    const Rational bend = curve.f->half_curvature(direction);
    tangent.push_back({Rational(-bend / scalar_product(curve.gradient, normal)), &curve});
  }
  std::sort(tangent.begin(), tangent.end(),
            [](const Curve& a, const Curve& b) { return a.curvature < b.curvature; });
  for (std::size_t i = 0; i + 1 < tangent.size(); ++i) {
    const Rational& here = tangent[i].curvature;
    const Rational& next = tangent[i + 1].curvature;
    if (here == next) {
      result.complete = false;  // different curves that osculate
    } else {
      result.germs.push_back({direction, scaled(Rational((here + next) / 2), normal), true});
    }
  }
}

}  // namespace

Germs<2> germs_at(const Point<2>& point, std::span<const GermSurface<2>> surfaces) {
  Germs<2> result;
  const std::vector<Surface<2>> curves = regular_surfaces(point, surfaces, result);
  std::vector<Vector2> normals;
  for (const Surface<2>& curve : curves) normals.push_back(curve.gradient);
  const std::vector<Vector2> directions = directions_of_lines(normals);
  for (Vector2& between : directions_between(directions)) {
    result.germs.push_back({std::move(between), {}, false});
  }
  for (const Vector2& direction : directions) add_curved_germs(curves, direction, result);
  return result;
}

namespace {

// No torus does.
bool contains_line(const Surface<3>& surface, const Point<3>& point, const Vector& direction) {
  return surface.torus ==
         nullptr&& restrict(*surface.f, LineSection<3>{point.coordinates(), direction, {}, {}})
             .is_zero();
}

// Whether one is a torus and the others are surfaces of revolution round its axis.
// REQUIRES none is singular at the point: then the point is not on the axis.
bool share_circle(std::span<const Surface<3>* const> surfaces) {
  const auto torus = std::find_if(surfaces.begin(), surfaces.end(),
                                  [](const Surface<3>* s) { return s->torus != nullptr; });
  if (torus == surfaces.end()) return false;
  const TorusFrame frame(*(*torus)->torus);
  return std::all_of(surfaces.begin(), surfaces.end(), [&](const Surface<3>* s) {
    return s->torus != nullptr ? is_coaxial(frame, *s->torus) : is_coaxial(frame, *s->f);
  });
}

// Two vectors that span the plane across the direction.
std::array<Vector, 2> plane_across(const Vector& direction) {
  const std::size_t zero = direction[0] == 0 ? 0 : direction[1] == 0 ? 1 : 2;
  Vector axis;
  axis[zero] = 1;
  if (parallel(axis, direction)) {
    axis[zero] = 0;
    axis[0] = 1;
  }
  const Vector first = vector_product(direction, axis);
  return {first, vector_product(direction, first)};
}

// The cells that have this line of the tangent planes on their boundary.
void add_germs_round(const Point<3>& point, const std::vector<Surface<3>>& planes,
                     const Vector& direction, Germs<3>& result) {
  const auto [first, second] = plane_across(direction);
  std::vector<Vector2> normals;
  std::vector<const Surface<3>*> tangent;
  for (const Surface<3>& surface : planes) {
    if (scalar_product(surface.gradient, direction) != 0) continue;
    normals.push_back(
        {scalar_product(surface.gradient, first), scalar_product(surface.gradient, second)});
    tangent.push_back(&surface);
  }
  const auto share_line = [&] {
    return std::all_of(tangent.begin(), tangent.end(), [&](const Surface<3>* surface) {
      return contains_line(*surface, point, direction);
    });
  };
  if (tangent.size() > 2 && !share_line() && !share_circle(tangent)) result.complete = false;
  for (const Vector2& between : directions_between(directions_of_lines(normals))) {
    result.germs.push_back(
        {direction, sum(scaled(between[0], first), scaled(between[1], second)), false});
  }
}

// The cells of the tangent planes.
void add_tangent_cells(const Point<3>& point, const std::vector<Surface<3>>& planes,
                       Germs<3>& result) {
  if (planes.size() == 1) {
    const Vector& normal = planes.front().gradient;
    result.germs.push_back({normal, {}, false});
    result.germs.push_back({scaled(Rational(-1), normal), {}, false});
    return;
  }
  std::vector<Vector> lines;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vector line = vector_product(planes[i].gradient, planes[j].gradient);
      if (std::any_of(lines.begin(), lines.end(),
                      [&](const Vector& other) { return parallel(line, other); })) {
        continue;
      }
      lines.push_back(line);
      add_germs_round(point, planes, line, result);
      add_germs_round(point, planes, scaled(Rational(-1), line), result);
    }
  }
}

// Whether the surfaces have one tangent plane all along the line, or along a circle. The vector
// product of their gradients is of degree two along a line, so that three zeros prove it to be
// zero; a rotation takes them along the circle.
bool touch_along(const Point<3>& point, const Surface<3>& a, const Surface<3>& b,
                 const Vector& direction) {
  if (share_circle(std::array{&a, &b})) return true;
  if (!contains_line(a, point, direction) || !contains_line(b, point, direction)) return false;
  const LineSection<3> line{point.coordinates(), direction, {}, {}};
  for (const int t : {1, 2}) {
    const Coordinates<3> at = line.at(t).coordinates();
    if (!parallel(a.f->gradient(at), b.f->gradient(at))) return false;
  }
  return true;
}

// The cells between two different surfaces with one tangent plane. Over the direction d of that
// plane they are at the heights a(d), b(d), quadratic forms; where a < b there is a cell between.
void add_cells_between(const Point<3>& point, const Surface<3>& a, const Surface<3>& b,
                       Germs<3>& result) {
  const Vector& normal = a.gradient;
  const auto [u, v] = plane_across(normal);
  const auto height = [&](const Surface<3>& surface, const Vector& d) {
    return Rational(-surface.f->half_curvature(d) / scalar_product(surface.gradient, normal));
  };
  const auto difference = [&](const Vector& d) { return Rational(height(a, d) - height(b, d)); };
  // q(x, y) = uu x^2 + 2 uv x y + vv y^2 on x u + y v
  const Rational uu = difference(u);
  const Rational vv = difference(v);
  const Rational uv = (difference(sum(u, v)) - uu - vv) / 2;
  const Rational discriminant = uu * vv - uv * uv;
  std::vector<Vector> directions{u, v, sum(u, v)};
  if (uu != 0) {
    // Across u: q is uu x^2 + (discriminant / uu) y^2 there, so these show both signs of q.
    directions.push_back(sum(v, scaled(Rational(-uv / uu), u)));
  } else {
    // q = y (2 uv x + vv y): both signs for y = 1 and large |x|.
    const Rational large = uv == 0 ? Rational(0) : Rational((abs(vv) + 1) / uv);
    directions.push_back(sum(v, scaled(large, u)));
    directions.push_back(sum(v, scaled(Rational(-large), u)));
  }
  for (const Vector& d : directions) {
    const Rational here = height(a, d);
    const Rational there = height(b, d);
    if (here == there) continue;
    result.germs.push_back({d, scaled(Rational((here + there) / 2), normal), true});
  }
  if (discriminant != 0) return;
  const Vector flat = uu != 0 ? sum(v, scaled(Rational(-uv / uu), u)) : u;
  const bool is_semidefinite = uu != 0 || vv != 0;
  if (!is_semidefinite || !touch_along(point, a, b, flat)) result.complete = false;
}

}  // namespace

Quadric<3> second_order(const Torus& torus, const Point<3>& point) {
  // base = b + l + q, of degrees 0, 1 and 2 about the point: base^2 is b^2 + 2 b (l + q) + l^2.
  const Rational b = torus.base()(point.coordinates());
  LinearForm<3> l{torus.base().gradient(point.coordinates()), 0};
  l.constant = -l(point.coordinates());
  return Rational(2 * b) * torus.base() + product(l, l) + Rational(-1) * torus.radicand() +
         Quadric<3>(LinearForm<3>{{}, Rational(-b * b)});
}

Germs<3> germs_at(const Point<3>& point, std::span<const GermSurface<3>> surfaces) {
  Germs<3> result;
  const std::vector<Surface<3>> different = regular_surfaces(point, surfaces, result);
  if (different.empty()) return result;
  std::vector<Surface<3>> planes;  // one for each tangent plane
  for (const Surface<3>& surface : different) {
    const bool known = std::any_of(planes.begin(), planes.end(), [&](const Surface<3>& other) {
      return parallel(surface.gradient, other.gradient);
    });
    if (!known) planes.push_back(surface);
  }
  add_tangent_cells(point, planes, result);
  if (different.size() == planes.size()) return result;
  if (planes.size() == 1 && different.size() == 2) {
    add_cells_between(point, different[0], different[1], result);
  } else {
    result.complete = false;
  }
  return result;
}

}  // namespace exactcsg::domain
