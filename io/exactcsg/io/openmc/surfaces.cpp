// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <span>
#include <utility>

#include "exactcsg/domain/half_spaces.hpp"

namespace exactcsg::io::openmc {

namespace {

using domain::LinearForm;
using domain::Quadric;

enum class Shape : unsigned char { Plane, AxisPlane, Sphere, Cylinder, Cone, Quadric, Torus };

struct Kind {
  std::string_view name;
  Shape shape;
  std::size_t axis;  // of those that have one
};

constexpr std::array<Kind, 15> kinds{{{"plane", Shape::Plane, 0},
                                      {"x-plane", Shape::AxisPlane, 0},
                                      {"y-plane", Shape::AxisPlane, 1},
                                      {"z-plane", Shape::AxisPlane, 2},
                                      {"sphere", Shape::Sphere, 0},
                                      {"x-cylinder", Shape::Cylinder, 0},
                                      {"y-cylinder", Shape::Cylinder, 1},
                                      {"z-cylinder", Shape::Cylinder, 2},
                                      {"x-cone", Shape::Cone, 0},
                                      {"y-cone", Shape::Cone, 1},
                                      {"z-cone", Shape::Cone, 2},
                                      {"quadric", Shape::Quadric, 0},
                                      {"x-torus", Shape::Torus, 0},
                                      {"y-torus", Shape::Torus, 1},
                                      {"z-torus", Shape::Torus, 2}}};

constexpr std::size_t coefficient_count(Shape shape) {
  switch (shape) {
    case Shape::AxisPlane:
      return 1;
    case Shape::Cylinder:
      return 3;
    case Shape::Plane:
    case Shape::Sphere:
    case Shape::Cone:
      return 4;
    case Shape::Torus:
      return 6;
    case Shape::Quadric:
      break;
  }
  return 10;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

const Kind& kind_of(std::string_view type) {
  return *std::find_if(kinds.begin(), kinds.end(),
                       [&](const Kind& kind) { return kind.name == type; });
}

Boundary read_boundary(const Field& field) {
  constexpr std::array<std::string_view, 5> names{"transmission", "vacuum", "reflective", "white",
                                                  "periodic"};
  const std::string name = lower_case(field.stripped());
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    field.fail(ErrorId::UnknownNode, fmt::format("the boundary '{:.40}'", name),
               "transmission, vacuum, reflective, white or periodic");
  }
  return static_cast<Boundary>(found - names.begin());
}

// A cylinder's axis passes through two given coordinates and 0.
domain::Axis axis_of(const Kind& kind, std::span<const Rational> c) {
  domain::Coordinates<3> point;
  domain::Coordinates<3> direction;
  direction[kind.axis] = 1;
  std::size_t next = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (kind.shape == Shape::Cylinder && i == kind.axis) continue;
    point[i] = c[next++];
  }
  return {point, direction};
}

Quadric<3> quadric_of(std::span<const Rational> c) {
  Quadric<3>::Matrix square;
  for (std::size_t i = 0; i < 3; ++i) square[i][i] = c[i];
  square[0][1] = square[1][0] = c[3] / 2;
  square[1][2] = square[2][1] = c[4] / 2;
  square[0][2] = square[2][0] = c[5] / 2;
  return {std::move(square), LinearForm<3>{{c[6], c[7], c[8]}, c[9]}};
}

// Without a major radius it is an ellipsoid.
HalfSpace torus_of(const Kind& kind, std::span<const Rational> c) {
  const domain::Axis axis = axis_of(kind, c);
  const Rational& along = c[4];
  const Rational& across = c[5];
  if (c[3] > 0) return domain::make_torus(axis, c[3], along, across);
  domain::Coordinates<3> squares;
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational& semi_axis = i == kind.axis ? along : across;
    squares[i] = semi_axis * semi_axis;
  }
  return domain::make_ellipsoid<3>(axis.point, squares);
}

// REQUIRES what check has seen.
HalfSpace half_space_of(const Kind& kind, std::span<const Rational> c) {
  switch (kind.shape) {
    case Shape::Plane:
      return domain::make_plane({c[0], c[1], c[2]}, Rational(-c[3]));
    case Shape::AxisPlane: {
      domain::Coordinates<3> normal;
      normal[kind.axis] = 1;
      return domain::make_plane(normal, Rational(-c[0]));
    }
    case Shape::Sphere:
      return domain::make_sphere({c[0], c[1], c[2]}, Rational(c[3] * c[3]));
    case Shape::Cylinder:
      return domain::make_cylinder(axis_of(kind, c), Rational(c[2] * c[2]));
    case Shape::Cone:
      return domain::make_double_cone(axis_of(kind, c), c[3]);
    case Shape::Torus:
      return torus_of(kind, c);
    case Shape::Quadric:
      break;
  }
  return domain::HalfSpace<3>(quadric_of(c));
}

void check_not_below_zero(const Field& word, const Rational& value, std::string_view what) {
  if (value >= 0) return;
  word.fail(ErrorId::BadArgument, fmt::format("{} {:.40}", what, to_text(value)),
            "none below 0 (OpenMC squares it)");
}

// Signs of what must have one, and whether there is a surface at all.
void check(const Kind& kind, const std::vector<Field>& words, const std::vector<Rational>& c) {
  const auto degenerate = [&](std::string_view found) {
    words.front().fail(ErrorId::DegenerateSurface, std::string(found), "");
  };
  switch (kind.shape) {
    case Shape::Plane:
      if (c[0] == 0 && c[1] == 0 && c[2] == 0) degenerate("a plane whose normal is 0");
      return;
    case Shape::AxisPlane:
      return;
    case Shape::Sphere:
    case Shape::Cylinder:
      check_not_below_zero(words.back(), c.back(), "the radius");
      if (c.back() == 0) degenerate("a radius of 0");
      return;
    case Shape::Cone:
      check_not_below_zero(words.back(), c.back(), "the squared slope");
      if (c.back() == 0) degenerate("a slope of 0");
      return;
    case Shape::Torus:
      for (std::size_t i = 3; i < 6; ++i) check_not_below_zero(words[i], c[i], "the radius");
      if (c[4] == 0 || c[5] == 0) degenerate("a minor radius of 0");
      return;
    case Shape::Quadric:
      if (!takes_both_signs(quadric_of(c))) {
        degenerate("a quadric that is nowhere above 0, or nowhere below");
      }
      return;
  }
}

const Kind& read_kind(const Element& element) {
  const Field type = element.required("type");
  const std::string name = lower_case(type.stripped());
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) { return kind.name == name; });
  if (name.empty() || found == kinds.end()) {
    type.fail(ErrorId::UnknownNode, fmt::format("a surface of type '{:.40}'", name),
              "plane, x-plane, sphere, x-cylinder, x-cone, quadric, ...");
  }
  return *found;
}

}  // namespace

// The homogeneous form of f, four variables: f takes both signs iff that is indefinite, since where
// it is not 0 it keeps its sign nearby, also away from the plane at infinity. It is diagonalised by
// congruences: a pivot on the diagonal is one sign of the inertia; if there is none but something
// beside it, x y takes both signs.
bool takes_both_signs(const domain::Quadric<3>& f) {
  std::array<std::array<Rational, 4>, 4> m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = f.square()[i][j];
    m[i][3] = m[3][i] = f.linear().normal[i] / 2;
  }
  m[3][3] = f.linear().constant;
  bool has_positive = false;
  bool has_negative = false;
  std::array<bool, 4> done{};
  for (;;) {
    std::size_t pivot = 0;
    while (pivot < 4 && (done[pivot] || m[pivot][pivot] == 0)) ++pivot;
    if (pivot == 4) break;
    has_positive = has_positive || m[pivot][pivot] > 0;
    has_negative = has_negative || m[pivot][pivot] < 0;
    done[pivot] = true;
    for (std::size_t i = 0; i < 4; ++i) {
      if (done[i] || m[i][pivot] == 0) continue;
      const Rational factor = m[i][pivot] / m[pivot][pivot];
      for (std::size_t j = 0; j < 4; ++j) {
        if (!done[j]) m[i][j] -= factor * m[pivot][j];
      }
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      if (!done[i] && !done[j] && m[i][j] != 0) return true;
    }
  }
  return has_positive && has_negative;
}

std::optional<HalfSpace> half_space_of(std::string_view type,
                                       const std::vector<Rational>& coefficients) {
  const Kind& kind = kind_of(type);
  const std::vector<Rational>& c = coefficients;
  const bool is_surface = [&] {
    switch (kind.shape) {
      case Shape::Plane:
        return c[0] != 0 || c[1] != 0 || c[2] != 0;
      case Shape::AxisPlane:
        return true;
      case Shape::Sphere:
      case Shape::Cylinder:
      case Shape::Cone:
        return c.back() > 0;
      case Shape::Torus:
        return c[3] >= 0 && c[4] > 0 && c[5] > 0;
      case Shape::Quadric:
        break;
    }
    return takes_both_signs(quadric_of(c));
  }();
  if (!is_surface) return std::nullopt;
  return half_space_of(kind, c);
}

Surface read_surface(const Element& element) {
  const Field id = element.required("id").word();
  const Id number = id.integer();
  if (number <= 0) {
    id.fail(ErrorId::BadArgument, fmt::format("the surface's id {}", number), "one above 0");
  }
  const Kind& kind = read_kind(element);
  const Field field = element.required("coeffs");
  const std::vector<Field> words = field.words();
  std::vector<Rational> coefficients = field.numbers();
  const std::size_t wanted = coefficient_count(kind.shape);
  if (words.size() != wanted) {
    (words.size() > wanted ? words[wanted] : field)
        .fail(ErrorId::WrongCount, fmt::format("{} coefficients", words.size()),
              fmt::format("{} of a {}", wanted, kind.name));
  }
  check(kind, words, coefficients);
  const std::optional<Field> boundary = element.field("boundary");
  HalfSpace negative = half_space_of(kind, coefficients);
  return {number,
          element.text_or_empty("name"),
          std::string(kind.name),
          boundary ? read_boundary(*boundary) : Boundary::Transmission,
          std::move(coefficients),
          std::move(negative),
          element.position()};
}

std::optional<PlaneSide> plane_side(const Surface& surface, bool is_positive) {
  const Kind& kind = kind_of(surface.type);
  if (kind.shape != Shape::Plane && kind.shape != Shape::AxisPlane) return std::nullopt;
  PlaneSide side;
  side.offset = surface.coefficients.back();
  for (std::size_t i = 0; i < 3; ++i) {
    side.normal[i] = kind.shape == Shape::Plane ? surface.coefficients[i] : i == kind.axis ? 1 : 0;
    if (is_positive) side.normal[i] = -side.normal[i];
  }
  if (is_positive) side.offset = -side.offset;
  return side;
}

Extent inside_extent(const Surface& surface, std::size_t axis) {
  const Kind& kind = kind_of(surface.type);
  const std::vector<Rational>& c = surface.coefficients;
  const auto round = [](const Rational& centre, const Rational& reach) {
    return Extent{Rational(centre - reach), Rational(centre + reach)};
  };
  if (kind.shape == Shape::Sphere) return round(c[axis], c[3]);
  if (kind.shape == Shape::Torus) {
    return round(c[axis], kind.axis == axis ? c[4] : Rational(c[3] + c[5]));
  }
  if (kind.shape == Shape::Cylinder && kind.axis != axis) {
    return round(axis_of(kind, c).point[axis], c[2]);
  }
  return {};
}

std::array<double, 2> extent_along(const Surface& surface, std::size_t axis) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Kind& kind = kind_of(surface.type);
  const auto only = [](const Rational& place) {
    return std::array{nearest_double(place), nearest_double(place)};
  };
  if (kind.shape == Shape::AxisPlane && kind.axis == axis) return only(surface.coefficients[0]);
  if (kind.shape == Shape::Cone) return only(surface.coefficients[axis]);
  const Extent inside = inside_extent(surface, axis);
  if (!inside.lower || !inside.upper) return {infinity, -infinity};
  return {nearest_double(*inside.lower), nearest_double(*inside.upper)};
}

}  // namespace exactcsg::io::openmc
