// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/domain/neighbourhood.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "exactcsg/domain/direction_cells.hpp"
#include "exactcsg/domain/torus_frame.hpp"
#include "exactcsg/domain/vector.hpp"
#include "exactcsg/number/algebraic_number.hpp"

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

// u' A v
template <std::size_t D>
Rational bilinear(const Quadric<D>& f, const Coordinates<D>& u, const Coordinates<D>& v) {
  Rational value;
  for (std::size_t i = 0; i < D; ++i) value += u[i] * scalar_product(f.square()[i], v);
  return value;
}

// Whether the surface, with this gradient at one of its points, has the whole tangent plane or line
// there: it is that, or a pair of such, away from the other one.
bool contains_tangent(const Quadric<3>& f, const Vector& gradient) {
  if (is_zero(gradient)) return false;
  const auto [u, v] = plane_across(gradient);
  return f.half_curvature(u) == 0 && f.half_curvature(v) == 0 && bilinear(f, u, v) == 0;
}
bool contains_tangent(const Quadric<2>& f, const Vector2& gradient) {
  return !is_zero(gradient) && f.half_curvature(turned(gradient)) == 0;
}

// A surface through the point, with its gradient there.
template <std::size_t D>
struct Surface {
  const Quadric<D>* f;
  const Torus* torus;
  Coordinates<D> gradient;
  bool is_flat = false;  // near the point

  // Near the point. REQUIRES parallel gradients
  bool is_same_set(const Surface& other) const {
    if (is_flat || other.is_flat) return is_flat == other.is_flat;
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
    const Coordinates<D> gradient = surface.polynomial->gradient(point.coordinates());
    const bool is_flat =
        surface.torus == nullptr && contains_tangent(*surface.polynomial, gradient);
    result.push_back({surface.polynomial, surface.torus, gradient, is_flat});
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

using SurfaceList = std::vector<const Surface<3>*>;

struct Line {
  Vector point, direction;
};

// f - factor * x'x has terms of degree two along one direction only.
Quadric<3>::Matrix without_spherical_part(const Quadric<3>& f, const Rational& factor) {
  Quadric<3>::Matrix rest = f.square();
  for (std::size_t i = 0; i < 3; ++i) rest[i][i] -= factor;
  return rest;
}

// What the terms of degree two are, times x'x, across an axis to which the direction is normal.
Rational spherical_factor(const Quadric<3>& f, const Vector& across) {
  return Rational(f.half_curvature(across) / scalar_product(across, across));
}

// The only axis round which the quadrics can all be surfaces of revolution, if the direction is
// that of a circle round it: of one that has a single axis, through the centres of two spheres, or
// through the centre of one across a plane.
std::optional<Line> possible_axis(const SurfaceList& surfaces, const Vector& across) {
  std::optional<Vector> centre;
  std::optional<Vector> normal;
  for (const Surface<3>* surface : surfaces) {
    const Quadric<3>& f = *surface->f;
    if (surface->is_flat) {
      normal = surface->gradient;
      continue;
    }
    const Rational factor = spherical_factor(f, across);
    if (factor == 0) return std::nullopt;
    const Vector here = scaled(Rational(-1 / (2 * factor)), f.linear().normal);
    for (const Vector& row : without_spherical_part(f, factor)) {
      if (!is_zero(row)) return Line{here, row};
    }
    if (centre && *centre != here) return Line{here, sum(*centre, scaled(Rational(-1), here))};
    centre = here;
  }
  if (!centre || !normal) return std::nullopt;
  return Line{*centre, *normal};
}

bool is_round(const Quadric<3>& f, const Line& axis, const Vector& across) {
  const auto rest = without_spherical_part(f, spherical_factor(f, across));
  return parallel(f.gradient(axis.point), axis.direction) &&
         std::all_of(rest.begin(), rest.end(),
                     [&](const Vector& row) { return parallel(row, axis.direction); });
}

// Whether all are surfaces of revolution round one axis, so that they have a circle through the
// point in common, in the direction. REQUIRES none is singular at the point
bool share_circle(const Point<3>& point, const SurfaceList& surfaces, const Vector& direction) {
  const auto torus = std::find_if(surfaces.begin(), surfaces.end(),
                                  [](const Surface<3>* s) { return s->torus != nullptr; });
  if (torus != surfaces.end()) {  // then the point is not on the axis
    const TorusFrame frame(*(*torus)->torus);
    return std::all_of(surfaces.begin(), surfaces.end(), [&](const Surface<3>* s) {
      return s->torus != nullptr ? is_coaxial(frame, *s->torus) : is_coaxial(frame, *s->f);
    });
  }
  const std::optional<Line> axis = possible_axis(surfaces, direction);
  if (!axis) return false;
  const Vector radius = sum(point.coordinates(), scaled(Rational(-1), axis->point));
  const Vector tangent = vector_product(axis->direction, radius);
  return !is_zero(tangent) && parallel(tangent, direction) &&
         std::all_of(surfaces.begin(), surfaces.end(),
                     [&](const Surface<3>* s) { return is_round(*s->f, *axis, direction); });
}

bool share_curve(const Point<3>& point, const SurfaceList& surfaces, const Vector& direction) {
  return std::all_of(surfaces.begin(), surfaces.end(),
                     [&](const Surface<3>* surface) {
                       return contains_line(*surface, point, direction);
                     }) ||
         share_circle(point, surfaces, direction);
}

// Surfaces with one tangent plane.
using Group = std::vector<Surface<3>>;

std::vector<Group> groups_of(const std::vector<Surface<3>>& surfaces) {
  std::vector<Group> groups;
  for (const Surface<3>& surface : surfaces) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& other) {
      return parallel(surface.gradient, other.front().gradient);
    });
    if (group == groups.end()) {
      groups.push_back({surface});
    } else {
      group->push_back(surface);
    }
  }
  return groups;
}

// Over a direction d of the tangent plane, a surface is at p + e d + e^2 height normal.
Rational height(const Surface<3>& surface, const Vector& direction, const Vector& normal) {
  return Rational(-surface.f->half_curvature(direction) / scalar_product(surface.gradient, normal));
}

// In the middle between each two successive heights of the group.
std::vector<Rational> gaps_over(const Vector& direction, const Group& group) {
  std::vector<Rational> heights;
  for (const Surface<3>& surface : group) {
    heights.push_back(height(surface, direction, group.front().gradient));
  }
  std::sort(heights.begin(), heights.end());
  std::vector<Rational> gaps;
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    if (heights[i] != heights[i + 1]) gaps.push_back(Rational((heights[i] + heights[i + 1]) / 2));
  }
  return gaps;
}

// Where the gaps of two groups cross, over the line of their tangent planes: offsets u with
// u n = |n|^2 gap for both normals n.
void add_crossed_gaps(const Vector& direction, const Group& a, const Group& b, Germs<3>& result) {
  const Vector& m = a.front().gradient;
  const Vector& n = b.front().gradient;
  const Rational mm = scalar_product(m, m);
  const Rational mn = scalar_product(m, n);
  const Rational nn = scalar_product(n, n);
  const Rational determinant = mm * nn - mn * mn;
  for (const Rational& first : gaps_over(direction, a)) {
    for (const Rational& second : gaps_over(direction, b)) {
      const Rational x = (first * mm * nn - second * nn * mn) / determinant;
      const Rational y = (second * nn * mm - first * mm * mn) / determinant;
      result.germs.push_back({direction, sum(scaled(x, m), scaled(y, n)), true});
    }
  }
}

// The cells that have this line of the tangent planes on their boundary.
void add_germs_round(const Point<3>& point, const std::vector<Group>& groups,
                     const Vector& direction, Germs<3>& result) {
  const auto [first, second] = plane_across(direction);
  std::vector<Vector2> normals;
  std::vector<const Group*> tangent;
  SurfaceList surfaces;
  for (const Group& group : groups) {
    const Vector& normal = group.front().gradient;
    if (scalar_product(normal, direction) != 0) continue;
    normals.push_back({scalar_product(normal, first), scalar_product(normal, second)});
    tangent.push_back(&group);
    for (const Surface<3>& surface : group) surfaces.push_back(&surface);
  }
  if (tangent.size() > 2 && !share_curve(point, surfaces, direction)) result.complete = false;
  for (const Vector2& between : directions_between(directions_of_lines(normals))) {
    result.germs.push_back(
        {direction, sum(scaled(between[0], first), scaled(between[1], second)), false});
  }
  for (std::size_t i = 0; i < tangent.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      add_crossed_gaps(direction, *tangent[i], *tangent[j], result);
    }
  }
}

// The cells of the tangent planes.
void add_tangent_cells(const Point<3>& point, const std::vector<Group>& groups, Germs<3>& result) {
  if (groups.size() == 1) {
    const Vector& normal = groups.front().front().gradient;
    result.germs.push_back({normal, {}, false});
    result.germs.push_back({scaled(Rational(-1), normal), {}, false});
    return;
  }
  std::vector<Vector> lines;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vector line = vector_product(groups[i].front().gradient, groups[j].front().gradient);
      if (std::any_of(lines.begin(), lines.end(),
                      [&](const Vector& other) { return parallel(line, other); })) {
        continue;
      }
      lines.push_back(line);
      add_germs_round(point, groups, line, result);
      add_germs_round(point, groups, scaled(Rational(-1), line), result);
    }
  }
}

// The cells between surfaces with one tangent plane. Over the directions d of that plane they are
// at heights that are quadratic forms; their order, and the side of the other surfaces, change only
// at directions in which two heights are equal, and at the traces of the other tangent planes.
class CellsBetween {
 public:
  CellsBetween(const Point<3>& point, const std::vector<Group>& groups, std::size_t own)
      : point_(point), groups_(groups), group_(groups[own]), own_(own) {
    std::tie(u_, v_) = basis();
  }

  void add_to(Germs<3>& result) {
    find_changes();
    if (has_equal_heights_) result.complete = false;
    std::sort(changes_.begin(), changes_.end(),
              [](const Change& a, const Change& b) { return a.at < b.at; });
    std::vector<AlgebraicNumber> numbers;
    for (std::size_t i = 0; i < changes_.size();) {
      std::size_t end = i + 1;
      while (end < changes_.size() && changes_[end].at == changes_[i].at) ++end;
      if (!is_simple(i, end)) result.complete = false;
      numbers.push_back(changes_[i].at);
      i = end;
    }
    for (const Rational& t : rationals_between(numbers)) {
      const Vector direction = direction_at(t);
      for (const Rational& gap : gaps_over(direction, group_)) {
        const Vector offset = scaled(gap, group_.front().gradient);
        result.germs.push_back({direction, offset, true});
        result.germs.push_back({scaled(Rational(-1), direction), offset, true});
      }
    }
  }

 private:
  // u + at v
  struct Change {
    AlgebraicNumber at;
    bool is_trace = false;
    int multiplicity = 1;
  };

  Vector direction_at(const Rational& t) const { return sum(u_, scaled(t, v_)); }

  Rational difference(const Surface<3>& a, const Surface<3>& b, const Vector& d) const {
    const Vector& normal = group_.front().gradient;
    return Rational(height(a, d, normal) - height(b, d, normal));
  }

  // A direction in which no heights are equal, unless they are throughout, and no other tangent
  // plane lies.
  bool is_free(const Vector& v, const Vector& u) const {
    for (std::size_t k = 0; k < groups_.size(); ++k) {
      if (k != own_ && scalar_product(groups_[k].front().gradient, v) == 0) return false;
    }
    for (std::size_t i = 0; i < group_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto at = [&](const Vector& d) { return difference(group_[i], group_[j], d); };
        if (at(v) == 0 && (at(u) != 0 || at(sum(u, v)) != 0)) return false;
      }
    }
    return true;
  }

  // The second one free. Each number excludes a few.
  std::pair<Vector, Vector> basis() const {
    const auto [first, second] = plane_across(group_.front().gradient);
    Vector free = second;
    while (!is_free(free, first)) free = sum(free, first);
    return {first, free};
  }

  void find_changes() {
    for (std::size_t i = 0; i < group_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto at = [&](const Vector& d) { return difference(group_[i], group_[j], d); };
        const Rational square = at(v_);
        const Rational constant = at(u_);
        const Rational linear = at(sum(u_, v_)) - square - constant;
        if (square == 0) {
          has_equal_heights_ = true;
          continue;
        }
        for (AlgebraicRoot& root : real_roots(std::array{constant, linear, square})) {
          changes_.push_back({std::move(root.value), false, root.multiplicity});
        }
      }
    }
    for (std::size_t k = 0; k < groups_.size(); ++k) {
      if (k == own_) continue;
      const Vector& normal = groups_[k].front().gradient;
      changes_.push_back(
          {Rational(-scalar_product(normal, u_) / scalar_product(normal, v_)), true, 1});
    }
  }

  // One trace, or two surfaces that cross; or several surfaces that have a curve in common there.
  // (Traces alone are what is said of lines of tangent planes.)
  bool is_simple(std::size_t begin, std::size_t end) const {
    const bool only_traces = std::all_of(changes_.begin() + static_cast<std::ptrdiff_t>(begin),
                                         changes_.begin() + static_cast<std::ptrdiff_t>(end),
                                         [](const Change& change) { return change.is_trace; });
    if (only_traces || (end == begin + 1 && changes_[begin].multiplicity == 1)) return true;
    const QuadraticNumber* at = changes_[begin].at.quadratic();
    if (at == nullptr || at->factor() != 0) return false;
    const Vector direction = direction_at(at->rational_part());
    const SurfaceList surfaces = meeting_along(direction);
    return share_curve(point_, surfaces, direction) && touch_along(surfaces, direction);
  }

  // Those of the group that are as high as another one, and those of the others.
  SurfaceList meeting_along(const Vector& direction) const {
    SurfaceList surfaces;
    for (const Surface<3>& one : group_) {
      const auto equal = std::count_if(group_.begin(), group_.end(), [&](const Surface<3>& other) {
        return difference(one, other, direction) == 0;
      });
      if (equal > 1) surfaces.push_back(&one);
    }
    for (std::size_t k = 0; k < groups_.size(); ++k) {
      if (k == own_ || scalar_product(groups_[k].front().gradient, direction) != 0) continue;
      for (const Surface<3>& surface : groups_[k]) surfaces.push_back(&surface);
    }
    return surfaces;
  }

  // Whether those of the group have one tangent plane all along the line or circle that they share.
  // The vector product of two gradients is of degree two along a line, so that three zeros prove it
  // to be zero; a rotation takes them along the circle.
  bool touch_along(const SurfaceList& surfaces, const Vector& direction) const {
    if (share_circle(point_, surfaces, direction)) return true;
    const LineSection<3> line{point_.coordinates(), direction, {}, {}};
    const Vector& normal = group_.front().gradient;
    for (const int t : {1, 2}) {
      const Coordinates<3> at = line.at(t).coordinates();
      std::optional<Vector> first;
      for (const Surface<3>* surface : surfaces) {
        if (!parallel(surface->gradient, normal)) continue;
        const Vector here = surface->f->gradient(at);
        if (first && !parallel(*first, here)) return false;
        first = here;
      }
    }
    return true;
  }

  const Point<3>& point_;
  const std::vector<Group>& groups_;
  const Group& group_;
  std::size_t own_;
  Vector u_, v_;
  std::vector<Change> changes_;
  bool has_equal_heights_ = false;  // of second order throughout: surfaces that osculate
};

// ---- apices ----------------------------------------------------------------------------------

// Surfaces at the apex of one of them, as forms: the terms of degree two of those that are singular
// there, and the tangent planes of the others.
struct Form {
  Quadric<3> f;
  bool is_cone = false;
  bool is_exact = false;  // the surface is what the form says, not only nearly so
};

Form form_of(const Surface<3>& surface) {
  if (is_zero(surface.gradient)) {
    return {Quadric<3>(surface.f->square(), {}), true, surface.torus == nullptr};
  }
  return {Quadric<3>(LinearForm<3>{surface.gradient, 0}), false, surface.is_flat};
}

// A binary form of degree two: what a cone is in a plane. b is half of the middle coefficient.
struct BinaryForm {
  Rational a, b, c;

  // Two different lines, or none but the apex.
  bool is_regular() const { return a * c != b * b; }
};

BinaryForm restricted(const Form& cone, const Form& plane) {
  const auto [u, v] = plane_across(plane.f.linear().normal);
  return {cone.f.half_curvature(u), bilinear(cone.f, u, v), cone.f.half_curvature(v)};
}

bool share_line(const BinaryForm& p, const BinaryForm& q) {
  const Rational outer = p.a * q.c - p.c * q.a;
  return outer * outer == 4 * (p.a * q.b - p.b * q.a) * (p.b * q.c - p.c * q.b);
}

// Whether the cells of the forms are those of the surfaces: every surface that is not exact meets
// the others along curves that leave the apex in different directions, and crosses them there.
class ApexCrossings {
 public:
  explicit ApexCrossings(const std::vector<Form>& forms) {
    for (const Form& form : forms) (form.is_cone ? cones_ : planes_).push_back(&form);
  }

  bool are_simple() const {
    for (const Form* cone : cones_) {
      if (!cone->is_exact && cones_.size() > 1) return false;
      for (const Form* plane : planes_) {
        if (!are_exact({cone, plane}) && !restricted(*cone, *plane).is_regular()) return false;
      }
    }
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      if (!has_simple_cones(*planes_[i])) return false;
      for (std::size_t j = 0; j < i; ++j) {
        if (!has_simple_line(*planes_[i], *planes_[j])) return false;
      }
    }
    return true;
  }

 private:
  static bool are_exact(std::initializer_list<const Form*> forms) {
    return std::all_of(forms.begin(), forms.end(), [](const Form* form) { return form->is_exact; });
  }

  // No line of two cones in a plane that is not exact.
  bool has_simple_cones(const Form& plane) const {
    for (std::size_t i = 0; !plane.is_exact && i < cones_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (share_line(restricted(*cones_[i], plane), restricted(*cones_[j], plane))) return false;
      }
    }
    return true;
  }

  // No third surface through the line of two planes, unless all three are exact.
  bool has_simple_line(const Form& a, const Form& b) const {
    const Vector line = vector_product(a.f.linear().normal, b.f.linear().normal);
    const auto is_simple = [&](const Form* other) {
      return other == &a || other == &b || are_exact({&a, &b, other}) || other->f(line) != 0;
    };
    return std::all_of(cones_.begin(), cones_.end(), is_simple) &&
           std::all_of(planes_.begin(), planes_.end(), is_simple);
  }

  std::vector<const Form*> cones_;
  std::vector<const Form*> planes_;
};

bool is_horn_torus(const Surface<3>& surface) {
  return surface.torus != nullptr && surface.torus->squared_ratio() == 1;
}

// REQUIRES singular surfaces, and regular ones that are different sets
Germs<3> germs_at_apex(const std::vector<Surface<3>>& singular,
                       const std::vector<Surface<3>>& regular) {
  Germs<3> result;
  std::vector<Surface<3>> surfaces;
  for (const Surface<3>& surface : singular) {
    const bool is_known =
        std::any_of(surfaces.begin(), surfaces.end(),
                    [&](const Surface<3>& other) { return is_same_cone(other, surface); });
    if (!is_known) surfaces.push_back(surface);
  }
  if (regular.empty() && surfaces.size() == 1) {
    add_singular(singular, true, result);
    return result;
  }
  bool touch = false;  // in the apex
  for (const Surface<3>& surface : regular) {
    const bool is_known =
        std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface<3>& other) {
          return !is_zero(other.gradient) && parallel(other.gradient, surface.gradient);
        });
    touch = touch || is_known;
    if (!is_known) surfaces.push_back(surface);
  }
  std::vector<Form> forms;
  std::vector<Quadric<3>> polynomials;
  for (const Surface<3>& surface : surfaces) {
    forms.push_back(form_of(surface));
    polynomials.push_back(forms.back().f);
  }
  DirectionCells cells = direction_cells(polynomials);
  for (Vector& direction : cells.directions) {
    result.germs.push_back({std::move(direction), {}, false});
  }
  result.complete = cells.complete && !touch && ApexCrossings(forms).are_simple() &&
                    std::none_of(surfaces.begin(), surfaces.end(), is_horn_torus);
  return result;
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
  std::vector<Surface<3>> different = with_gradients(point, surfaces);
  const std::vector<Surface<3>> singular = take_singular(different);
  remove_duplicates(different);
  if (!singular.empty()) return germs_at_apex(singular, different);
  const std::vector<Group> groups = groups_of(different);
  add_tangent_cells(point, groups, result);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i].size() > 1) CellsBetween(point, groups, i).add_to(result);
  }
  return result;
}

}  // namespace exactcsg::domain
