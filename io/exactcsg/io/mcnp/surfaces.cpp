// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mcnp/surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <span>
#include <utility>

#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/domain/vector.hpp"
#include "exactcsg/io/openmc/surfaces.hpp"

namespace exactcsg::io::mcnp {

namespace {

using csg::BooleanOperator;
using domain::detail::is_zero;
using domain::detail::scalar_product;
using domain::detail::scaled;
using domain::detail::vector_product;
using Vector = domain::Coordinates<3>;
using Quadric = domain::Quadric<3>;
using Sides = csg::BooleanTree<ShapeSide>;

constexpr std::array<std::string_view, 3> axis_names{"x", "y", "z"};

// a + factor b
Vector sum(const Vector& a, const Rational& factor, const Vector& b) {
  Vector result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] + factor * b[i];
  return result;
}
Vector unit(std::size_t axis) {
  Vector result;
  result[axis] = 1;
  return result;
}
// The one component that is not 0.
std::optional<std::size_t> axis_along(const Vector& a) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a[i] != 0 && a[(i + 1) % 3] == 0 && a[(i + 2) % 3] == 0) return i;
  }
  return std::nullopt;
}
Vector vector_at(std::span<const Rational> values, std::size_t from) {
  return {values[from], values[from + 1], values[from + 2]};
}

// ---- surfaces ----------------------------------------------------------------------------------

// Each returns the side at which its polynomial is below 0.
ShapeSide add(Body& body, std::string type, std::vector<Rational> coefficients) {
  body.shapes.push_back({std::move(type), std::move(coefficients)});
  return {static_cast<std::uint32_t>(body.shapes.size() - 1), false};
}

// {x : normal x <= offset}
ShapeSide add_plane(Body& body, const Vector& normal, const Rational& offset) {
  const auto axis = axis_along(normal);
  if (!axis) return add(body, "plane", {normal[0], normal[1], normal[2], offset});
  ShapeSide side =
      add(body, fmt::format("{}-plane", axis_names[*axis]), {Rational(offset / normal[*axis])});
  side.is_positive = normal[*axis] < 0;
  return side;
}

ShapeSide add_sphere(Body& body, const Vector& centre, const Rational& radius) {
  return add(body, "sphere", {centre[0], centre[1], centre[2], radius});
}

ShapeSide add_quadric(Body& body, const Quadric& f) {
  const auto& linear = f.linear();
  if (f.is_linear()) return add_plane(body, linear.normal, Rational(-linear.constant));
  const auto& s = f.square();
  const auto twice = [](const Rational& x) { return Rational(2 * x); };
  return add(body, "quadric",
             {s[0][0], s[1][1], s[2][2], twice(s[0][1]), twice(s[1][2]), twice(s[0][2]),
              linear.normal[0], linear.normal[1], linear.normal[2], linear.constant});
}

ShapeSide add_cylinder(Body& body, const domain::Axis& axis, const Rational& radius) {
  const auto along = axis_along(axis.direction);
  if (!along) {
    return add_quadric(body, domain::make_cylinder(axis, Rational(radius * radius)).polynomial());
  }
  std::vector<Rational> coefficients;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i != *along) coefficients.push_back(axis.point[i]);
  }
  coefficients.push_back(radius);
  return add(body, fmt::format("{}-cylinder", axis_names[*along]), std::move(coefficients));
}

ShapeSide add_cone(Body& body, const domain::Axis& axis, const Rational& squared_slope) {
  const auto along = axis_along(axis.direction);
  if (!along) return add_quadric(body, domain::make_double_cone(axis, squared_slope).polynomial());
  return add(body, fmt::format("{}-cone", axis_names[*along]),
             {axis.point[0], axis.point[1], axis.point[2], squared_slope});
}

// factor ((x - centre) direction)^2
Quadric square_along(const Rational& factor, const Vector& direction, const Vector& centre) {
  const domain::LinearForm<3> form{direction, Rational(-scalar_product(direction, centre))};
  return factor * domain::product(form, form);
}
Quadric constant(const Rational& value) { return Quadric(domain::LinearForm<3>{{}, value}); }

Sides primitive(const ShapeSide& side) { return Sides::primitive(side); }
Sides compose(BooleanOperator operation, std::vector<Sides> operands) {
  if (operands.size() == 1) return std::move(operands.front());
  return Sides::compose(operation, std::move(operands));
}

// ---- images ------------------------------------------------------------------------------------

// Of an axis under a map that takes it to an axis: which, and in which direction.
struct AxisImage {
  std::size_t axis;
  bool is_reversed;
};
std::optional<AxisImage> image_of_axis(const AffineMap& map, std::size_t axis) {
  const auto along = axis_along({map.m[0][axis], map.m[1][axis], map.m[2][axis]});
  if (!along) return std::nullopt;
  return AxisImage{*along, map.m[*along][axis] < 0};
}

std::size_t axis_of(const Shape& shape) { return static_cast<std::size_t>(shape.type[0] - 'x'); }
bool is_kind(const Shape& shape, std::string_view kind) {
  return shape.type.size() == kind.size() + 2 && shape.type.ends_with(kind);
}

Vector image_of_point(const AffineMap& map, const Vector& point) {
  return domain::apply(map, domain::Point<3>(point)).coordinates();
}

Quadric image_of_quadric(const AffineMap& map, const Shape& shape) {
  const auto half_space = openmc::half_space_of(shape.type, shape.coefficients);
  return domain::apply(map, *half_space->quadric()).polynomial();
}

// The image of {f <= 0}, added to the body.
std::optional<ShapeSide> add_image(Body& body, const AffineMap& map, const Shape& shape) {
  const std::vector<Rational>& c = shape.coefficients;
  if (shape.type == "sphere") {
    return add_sphere(body, image_of_point(map, vector_at(c, 0)), c[3]);
  }
  const bool is_cylinder = is_kind(shape, "cylinder");
  const bool is_torus = is_kind(shape, "torus");
  if (!is_cylinder && !is_torus && !is_kind(shape, "cone")) {
    return add_quadric(body, image_of_quadric(map, shape));
  }
  const auto image = image_of_axis(map, axis_of(shape));
  if (!image) {
    if (is_torus) return std::nullopt;
    return add_quadric(body, image_of_quadric(map, shape));
  }
  Vector point;
  std::size_t next = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_cylinder || i != axis_of(shape)) point[i] = c[next++];
  }
  const domain::Axis axis{image_of_point(map, point), unit(image->axis)};
  if (is_cylinder) return add_cylinder(body, axis, c[2]);
  if (!is_torus) return add_cone(body, axis, c[3]);
  return add(body, fmt::format("{}-torus", axis_names[image->axis]),
             {axis.point[0], axis.point[1], axis.point[2], c[3], c[4], c[5]});
}

// ---- cards -------------------------------------------------------------------------------------

bool are_across(const Vector& a, const Vector& b) {
  constexpr double tolerance = 1e-6;  // of the squared cosine
  const Rational product = scalar_product(a, b);
  return nearest_double(Rational(product * product)) <=
         tolerance * nearest_double(Rational(scalar_product(a, a) * scalar_product(b, b)));
}

Rational root_of(const Rational& value) {
  const Integer& n = value.get_num();
  const Integer& d = value.get_den();
  if (mpz_perfect_square_p(n.get_mpz_t()) != 0 && mpz_perfect_square_p(d.get_mpz_t()) != 0) {
    return Rational(sqrt(n), sqrt(d));
  }
  return rational_of(std::sqrt(nearest_double(value)));
}

class SurfaceReader {
 public:
  SurfaceReader(const Card& card, std::vector<Warning>& warnings)
      : card_(card), warnings_(warnings), words_(words_of(card, 0, card.text().size())) {}

  SurfaceCard read() {
    SurfaceCard result;
    std::size_t next = read_number(result);
    if (next < words_.size() && is_integer(words_[next].text)) {
      const Word& word = words_[next++];
      const std::int32_t value = integer_of(card_, word);
      if (value > 0) {
        result.transformation = word;
      } else if (value < 0) {
        if (result.boundary != openmc::Boundary::Transmission) {
          card_.fail(ErrorId::BadArgument, "a reflecting surface that is periodic as well",
                     "one of both", word.at);
        }
        result.boundary = openmc::Boundary::Periodic;
        result.partner = word;
      }
    }
    if (next == words_.size()) {
      card_.fail(ErrorId::MissingValue, "a surface without a type", "px, so, cz, rpp, ...",
                 words_.back().at);
    }
    type_ = words_[next];
    entries_ = entries_of(card_, words_, next + 1);
    values_ = values_of(card_, entries_);
    read_body();
    result.body = std::move(body_);
    if (result.boundary == openmc::Boundary::Periodic && !result.is_plane()) {
      card_.fail(ErrorId::BadArgument, "a periodic surface that is no plane", "a plane", type_.at);
    }
    return result;
  }

 private:
  static bool is_integer(std::string_view text) {
    const std::size_t digits = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
    return digits < text.size() &&
           text.find_first_not_of("0123456789", digits) == std::string_view::npos;
  }

  std::size_t read_number(SurfaceCard& result) {
    if (words_.empty()) card_.fail(ErrorId::MissingValue, "an empty card", "a surface");
    Word word = words_.front();
    std::size_t next = 1;
    if (word.text.starts_with('*') || word.text.starts_with('+')) {
      result.boundary =
          word.text[0] == '*' ? openmc::Boundary::Reflective : openmc::Boundary::White;
      word.text.erase(0, 1);
      ++word.at;
      if (word.text.empty() && words_.size() > 1) word = words_[next++];
    }
    result.number = integer_of(card_, word);
    constexpr openmc::Id greatest = 99'999'999;
    if (result.number <= 0 || result.number > greatest) {
      card_.fail(ErrorId::BadArgument, fmt::format("the surface's number {}", result.number),
                 "one from 1 to 99999999", word.at);
    }
    return next;
  }

  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected,
                         std::size_t value = 0) const {
    card_.fail(id, std::move(found), std::move(expected),
               value < entries_.size() ? entries_[value].word.at : type_.at);
  }

  void expect_count(std::initializer_list<std::size_t> counts) const {
    if (std::find(counts.begin(), counts.end(), values_.size()) != counts.end()) return;
    const std::size_t most = std::max(counts);
    fail(ErrorId::WrongCount, fmt::format("{} numbers of '{}'", values_.size(), type_.text),
         fmt::format("{}", fmt::join(counts, " or ")),
         values_.size() > most ? most : entries_.size());
  }

  void expect_radius(std::size_t index) const {
    if (values_[index] < 0) {
      fail(ErrorId::BadArgument, fmt::format("the radius {:.40}", entries_[index].word.text),
           "one above 0", index);
    }
    if (values_[index] == 0) fail(ErrorId::DegenerateSurface, "a radius of 0", "", index);
  }
  void expect_direction(std::size_t from) const {
    if (is_zero(vector_at(values_, from))) {
      fail(ErrorId::DegenerateSurface, "the vector 0 0 0", "any other", from);
    }
  }
  void expect_across(std::size_t first, std::size_t second) const {
    if (are_across(vector_at(values_, first), vector_at(values_, second))) return;
    fail(ErrorId::BadArgument, "a vector that is not at right angles to another one",
         "vectors at right angles", second);
  }

  void read_body() {
    const std::string& type = type_.text;
    const bool ends_on_axis = !type.empty() && type.back() >= 'x' && type.back() <= 'z';
    axis_ = ends_on_axis ? static_cast<std::size_t>(type.back() - 'x') : 0;
    const std::string_view stem =
        ends_on_axis ? std::string_view(type).substr(0, type.size() - 1) : std::string_view(type);
    if (read_plane(type, stem, ends_on_axis) || read_round(type, stem, ends_on_axis) ||
        read_macrobody(type)) {
      return;
    }
    fail(ErrorId::UnknownNode, fmt::format("a surface of type '{:.40}'", type),
         "p, px, so, s, c/x, cx, k/x, kx, sq, gq, tx, x, box, rpp, sph, rcc, ...", entries_.size());
  }

  void is(const ShapeSide& side) { body_.negative = primitive(side); }

  bool read_plane(std::string_view type, std::string_view stem, bool ends_on_axis) {
    if (stem == "p" && ends_on_axis) {
      expect_count({1});
      is(add_plane(body_, unit(axis_), values_[0]));
    } else if (type == "p") {
      expect_count({4, 9});
      if (values_.size() == 4) {
        read_plane_of_equation();
      } else {
        read_plane_of_points();
      }
    } else if (stem.empty() && ends_on_axis) {
      read_points_of_revolution();
    } else {
      return false;
    }
    return true;
  }

  void read_plane_of_equation() {
    const Vector normal = vector_at(values_, 0);
    if (is_zero(normal)) fail(ErrorId::DegenerateSurface, "a plane whose normal is 0", "");
    is(add_plane(body_, normal, values_[3]));
  }

  void read_plane_of_points() {
    const Vector a = vector_at(values_, 0);
    Vector normal =
        vector_product(sum(vector_at(values_, 3), -1, a), sum(vector_at(values_, 6), -1, a));
    if (is_zero(normal)) fail(ErrorId::DegenerateSurface, "three points on a line", "");
    Rational offset = scalar_product(normal, a);
    // The first of these that is not 0 decides.
    const std::array<Rational, 4> deciding{offset, normal[2], normal[1], normal[0]};
    const auto first =
        std::find_if(deciding.begin(), deciding.end(), [](const Rational& x) { return x != 0; });
    if (*first < 0) {
      normal = scaled(-1, normal);
      offset = -offset;
    }
    is(add_plane(body_, normal, offset));
  }

  bool read_round(std::string_view type, std::string_view stem, bool ends_on_axis) {
    const bool is_at_point = stem.ends_with('/');
    if (type == "so") {
      expect_count({1});
      expect_radius(0);
      is(add_sphere(body_, Vector(), values_[0]));
    } else if (type == "s" || type == "sph") {
      expect_count({4});
      expect_radius(3);
      is(add_sphere(body_, vector_at(values_, 0), values_[3]));
    } else if (stem == "s" && ends_on_axis) {
      expect_count({2});
      expect_radius(1);
      is(add_sphere(body_, scaled(values_[0], unit(axis_)), values_[1]));
    } else if ((stem == "c" || stem == "c/") && ends_on_axis) {
      expect_count({is_at_point ? 3U : 1U});
      expect_radius(values_.size() - 1);
      Vector point;
      if (is_at_point) {
        point[axis_ == 0 ? 1 : 0] = values_[0];
        point[axis_ == 2 ? 1 : 2] = values_[1];
      }
      is(add_cylinder(body_, {point, unit(axis_)}, values_.back()));
    } else if ((stem == "k" || stem == "k/") && ends_on_axis) {
      read_cone(is_at_point);
    } else if (stem == "t" && ends_on_axis) {
      read_torus();
    } else if (type == "sq" || type == "gq") {
      read_quadric(type == "sq");
    } else if (type == "ell") {
      read_ellipsoid();
    } else {
      return false;
    }
    return true;
  }

  // Inside the sheet: inside the cone and at one side of the plane through the apex.
  void make_one_sheet(const Vector& apex, const Rational& squared_slope, bool is_upper) {
    const ShapeSide cone = add_cone(body_, {apex, unit(axis_)}, squared_slope);
    const ShapeSide plane = add_plane(body_, scaled(is_upper ? -1 : 1, unit(axis_)),
                                      Rational(is_upper ? Rational(-apex[axis_]) : apex[axis_]));
    body_.shapes.back().is_auxiliary = true;
    body_.negative = compose(BooleanOperator::Intersection, {primitive(cone), primitive(plane)});
  }

  void read_cone(bool is_at_point) {
    const std::size_t slope = is_at_point ? 3 : 1;
    expect_count({slope + 1, slope + 2});
    const Vector apex = is_at_point ? vector_at(values_, 0) : scaled(values_[0], unit(axis_));
    if (values_[slope] < 0) {
      fail(ErrorId::BadArgument, "a squared slope below 0", "one above 0", slope);
    }
    if (values_[slope] == 0) fail(ErrorId::DegenerateSurface, "a slope of 0", "", slope);
    if (values_.size() == slope + 1) {
      return is(add_cone(body_, {apex, unit(axis_)}, values_[slope]));
    }
    const Rational& sheet = values_.back();
    if (abs(sheet) != 1) {
      fail(ErrorId::BadArgument, fmt::format("the sheet '{:.40}'", entries_.back().word.text),
           "1 or -1", slope + 1);
    }
    make_one_sheet(apex, values_[slope], sheet == 1);
  }

  void read_torus() {
    expect_count({6});
    if (values_[3] < 0) {
      fail(ErrorId::UnsupportedNode, "the inner surface of a degenerate torus (A below 0)",
           "A of at least 0", 3);
    }
    expect_radius(4);
    expect_radius(5);
    is(add(body_, fmt::format("{}-torus", axis_names[axis_]), values_));
  }

  void is_quadric(const Quadric& f) {
    if (f.is_linear() ? f.linear().is_constant() : !openmc::takes_both_signs(f)) {
      fail(ErrorId::DegenerateSurface, "an equation that is nowhere above 0, or nowhere below", "");
    }
    is(add_quadric(body_, f));
  }

  void read_quadric(bool is_centred) {
    expect_count({10});
    const std::vector<Rational>& v = values_;
    if (is_centred) {
      const Vector centre = vector_at(v, 7);
      Quadric f = constant(v[6]);
      for (std::size_t i = 0; i < 3; ++i) {
        const domain::LinearForm<3> offset{unit(i), Rational(-centre[i])};
        f = f + v[i] * domain::product(offset, offset) + Rational(2 * v[3 + i]) * Quadric(offset);
      }
      return is_quadric(f);
    }
    Quadric::Matrix square;
    for (std::size_t i = 0; i < 3; ++i) square[i][i] = v[i];
    square[0][1] = square[1][0] = v[3] / 2;
    square[1][2] = square[2][1] = v[4] / 2;
    square[0][2] = square[2][0] = v[5] / 2;
    is_quadric(Quadric(std::move(square), domain::LinearForm<3>{vector_at(v, 6), v[9]}));
  }

  // Centre, major semi-axis, and the other one as a negative number.
  void read_ellipsoid() {
    expect_count({7});
    if (values_[6] > 0) {
      fail(ErrorId::UnsupportedNode,
           "an ellipsoid by its foci, of which the manual's accounts differ",
           "its centre, its major axis and the minor radius as a negative number", 6);
    }
    if (values_[6] == 0) fail(ErrorId::DegenerateSurface, "a radius of 0", "", 6);
    expect_direction(3);
    const Vector centre = vector_at(values_, 0);
    const Vector axis = vector_at(values_, 3);
    const Rational across = 1 / Rational(values_[6] * values_[6]);
    const Rational along = 1 / scalar_product(axis, axis);
    Quadric f = constant(-1) + square_along(Rational(along * (along - across)), axis, centre);
    for (std::size_t i = 0; i < 3; ++i) f = f + square_along(across, unit(i), centre);
    is(add_quadric(body_, f));
  }

  // r^2 as a function of the place on the axis, through one to three points.
  void read_points_of_revolution() {
    expect_count({2, 4, 6});
    for (std::size_t i = 1; i < values_.size(); i += 2) {
      if (values_[i] < 0) fail(ErrorId::BadArgument, "a radius below 0", "one of at least 0", i);
    }
    const std::size_t count = values_.size() / 2;
    const auto x = [&](std::size_t i) -> const Rational& { return values_[2 * i]; };
    const auto r = [&](std::size_t i) -> const Rational& { return values_[2 * i + 1]; };
    const auto is_plane = [&] {
      for (std::size_t i = 1; i < count; ++i) {
        if (x(i) != x(0)) return false;
      }
      return true;
    };
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (x(i) == x(j) && r(i) == r(j)) {
          fail(ErrorId::BadArgument, "a point that is given twice", "another one", 2 * i);
        }
        if (x(i) == x(j) && !is_plane()) {
          fail(ErrorId::BadArgument, "points on parallel planes", "points of one surface", 2 * i);
        }
      }
    }
    if (is_plane()) return is(add_plane(body_, unit(axis_), x(0)));
    if (count == 2) return make_line_of_revolution(x(0), r(0), x(1), r(1));
    make_curve_of_revolution({x(0), x(1), x(2)},
                             {Rational(r(0) * r(0)), Rational(r(1) * r(1)), Rational(r(2) * r(2))});
  }

  void make_line_of_revolution(const Rational& x1, const Rational& r1, const Rational& x2,
                               const Rational& r2) {
    if (r1 == r2) {
      if (r1 == 0) fail(ErrorId::DegenerateSurface, "a radius of 0", "", 1);
      return is(add_cylinder(body_, {Vector(), unit(axis_)}, r1));
    }
    const Rational slope = (r2 - r1) / (x2 - x1);
    const Rational apex = x1 - r1 / slope;
    make_one_sheet(scaled(apex, unit(axis_)), Rational(slope * slope), slope > 0);
  }

  void make_curve_of_revolution(const std::array<Rational, 3>& x,
                                const std::array<Rational, 3>& square) {
    // Newton's divided differences: square = a x^2 + b x + c
    const Rational first = (square[1] - square[0]) / (x[1] - x[0]);
    const Rational second = (square[2] - square[1]) / (x[2] - x[1]);
    const Rational a = (second - first) / (x[2] - x[0]);
    const Rational b = first - a * (x[0] + x[1]);
    const Rational c = square[0] - x[0] * (a * x[0] + b);
    const Rational discriminant = b * b - 4 * a * c;
    if (a > 0 && discriminant == 0) {
      fail(ErrorId::UnsupportedNode, "a cone by three points", "two points of it");
    }
    if (a > 0 && discriminant > 0) {
      const Rational middle = -b / (2 * a);
      if ((x[0] < middle) != (x[1] < middle) || (x[0] < middle) != (x[2] < middle)) {
        fail(ErrorId::BadArgument, "points on both sheets of a hyperboloid", "points on one");
      }
    }
    Quadric f = constant(Rational(-c));
    for (std::size_t i = 0; i < 3; ++i) {
      const domain::LinearForm<3> form{unit(i), 0};
      f = f + (i == axis_ ? Rational(-a) : Rational(1)) * domain::product(form, form);
      if (i == axis_) f = f + Rational(-b) * Quadric(form);
    }
    is_quadric(f);
  }

  // ---- bodies ----------------------------------------------------------------------------------

  void add_facet(const ShapeSide& side) { body_.facets.emplace_back(side); }
  // {x : normal (x - point) <= 0}
  void add_facet(const Vector& normal, const Vector& point) {
    add_facet(add_plane(body_, normal, scalar_product(normal, point)));
  }
  void add_opposite_facets(const Vector& direction, const Vector& end, const Vector& begin) {
    add_facet(direction, end);
    add_facet(scaled(-1, direction), begin);
  }
  void intersect_facets() {
    std::vector<Sides> sides;
    for (const auto& facet : body_.facets) sides.push_back(primitive(*facet));
    body_.negative = compose(BooleanOperator::Intersection, std::move(sides));
    body_.is_macrobody = true;
  }

  bool read_macrobody(std::string_view type) {
    if (type == "box") {
      read_box();
    } else if (type == "rpp") {
      read_parallelepiped();
    } else if (type == "rcc") {
      read_cylinder();
    } else if (type == "rhp" || type == "hex") {
      read_hexagonal_prism();
    } else if (type == "rec") {
      read_elliptical_cylinder();
    } else if (type == "trc") {
      read_truncated_cone();
    } else if (type == "wed") {
      read_wedge();
    } else if (type == "arb") {
      read_polyhedron();
    } else {
      return false;
    }
    return true;
  }

  void read_box() {
    expect_count({9, 12});
    const Vector v = vector_at(values_, 0);
    for (std::size_t from = 3; from < values_.size(); from += 3) {
      expect_direction(from);
      for (std::size_t other = 3; other < from; other += 3) expect_across(other, from);
      const Vector a = vector_at(values_, from);
      add_opposite_facets(a, sum(v, 1, a), v);
    }
    intersect_facets();
  }

  void read_parallelepiped() {
    expect_count({6});
    for (std::size_t i = 0; i < 3; ++i) {
      const Rational& low = values_[2 * i];
      const Rational& high = values_[2 * i + 1];
      if (low == high) {
        fail(ErrorId::UnsupportedNode, "a body without extent, or without end, along an axis",
             "bounds that differ", 2 * i + 1);
      }
      if (low > high) {
        fail(ErrorId::BadArgument, "an upper bound below the lower one", "the lower one first",
             2 * i + 1);
      }
      add_opposite_facets(unit(i), scaled(high, unit(i)), scaled(low, unit(i)));
    }
    intersect_facets();
  }

  void add_ends(const Vector& base, const Vector& height) {
    add_opposite_facets(height, sum(base, 1, height), base);
  }

  void read_cylinder() {
    expect_count({7});
    expect_direction(3);
    expect_radius(6);
    const Vector v = vector_at(values_, 0);
    const Vector h = vector_at(values_, 3);
    add_facet(add_cylinder(body_, {v, h}, values_[6]));
    add_ends(v, h);
    intersect_facets();
  }

  void read_hexagonal_prism() {
    expect_count({9, 15});
    for (std::size_t from = 3; from < values_.size(); from += 3) expect_direction(from);
    const Vector v = vector_at(values_, 0);
    const Vector h = vector_at(values_, 3);
    const Vector r = vector_at(values_, 6);
    for (std::size_t from = 6; from < values_.size(); from += 3) expect_across(3, from);
    if (values_.size() == 15) {
      for (std::size_t from = 6; from < 15; from += 3) {
        const Vector s = vector_at(values_, from);
        add_opposite_facets(s, sum(v, 1, s), sum(v, -1, s));
      }
    } else {
      // r turned about h by 60 and by 120 degrees; sides as far away as r is long.
      const Rational sine = rational_of(std::numbers::sqrt3 / 2) / root_of(scalar_product(h, h));
      const Vector across = vector_product(h, r);
      const Rational offset = scalar_product(r, r);
      const auto add_pair = [&](const Vector& normal) {
        add_facet(add_plane(body_, normal, Rational(scalar_product(normal, v) + offset)));
        const Vector back = scaled(-1, normal);
        add_facet(add_plane(body_, back, Rational(scalar_product(back, v) + offset)));
      };
      add_pair(r);
      add_pair(sum(scaled(Rational(1, 2), r), sine, across));
      add_pair(sum(scaled(Rational(-1, 2), r), sine, across));
    }
    add_ends(v, h);
    intersect_facets();
  }

  void read_elliptical_cylinder() {
    expect_count({10, 12});
    const Vector v = vector_at(values_, 0);
    const Vector h = vector_at(values_, 3);
    const Vector a = vector_at(values_, 6);
    expect_direction(3);
    expect_direction(6);
    expect_across(3, 6);
    const auto inverse_square = [](const Rational& x) { return Rational(1 / (x * x)); };
    Quadric f = constant(-1) + square_along(inverse_square(scalar_product(a, a)), a, v);
    if (values_.size() == 12) {
      const Vector b = vector_at(values_, 9);
      expect_direction(9);
      expect_across(3, 9);
      expect_across(6, 9);
      f = f + square_along(inverse_square(scalar_product(b, b)), b, v);
    } else {
      expect_radius(9);
      const Vector b = vector_product(h, a);
      f = f + square_along(Rational(inverse_square(values_[9]) / scalar_product(b, b)), b, v);
    }
    add_facet(add_quadric(body_, f));
    add_ends(v, h);
    intersect_facets();
  }

  void read_truncated_cone() {
    expect_count({8});
    expect_direction(3);
    for (std::size_t i = 6; i < 8; ++i) {
      if (values_[i] < 0) fail(ErrorId::BadArgument, "a radius below 0", "one of at least 0", i);
    }
    const Vector v = vector_at(values_, 0);
    const Vector h = vector_at(values_, 3);
    const Rational change = values_[6] - values_[7];
    if (change == 0) {
      fail(ErrorId::BadArgument, "a cone of equal radii", "radii that differ, or an rcc", 7);
    }
    const Vector apex = sum(v, Rational(values_[6] / change), h);
    add_facet(add_cone(body_, {apex, h}, Rational(change * change / scalar_product(h, h))));
    add_ends(v, h);
    intersect_facets();
    // Alone it may be one sheet or two: the manual does not say.
    body_.facets.front().reset();
  }

  void read_wedge() {
    expect_count({12});
    const Vector v = vector_at(values_, 0);
    const Vector a = vector_at(values_, 3);
    const Vector b = vector_at(values_, 6);
    const Vector h = vector_at(values_, 9);
    for (std::size_t from = 3; from < 12; from += 3) {
      expect_direction(from);
      for (std::size_t other = 3; other < from; other += 3) expect_across(other, from);
    }
    Vector slant = vector_product(h, sum(a, -1, b));
    if (scalar_product(slant, a) < 0) slant = scaled(-1, slant);
    add_facet(slant, sum(v, 1, a));
    add_facet(scaled(-1, a), v);
    add_facet(scaled(-1, b), v);
    add_ends(v, h);
    intersect_facets();
  }

  // Eight corners, and for each of at most six sides the numbers of its corners.
  void read_polyhedron() {
    expect_count({30});
    std::vector<std::vector<std::size_t>> sides;
    std::vector<std::size_t> entries;
    Vector middle;
    Rational count = 0;
    for (std::size_t i = 24; i < 30; ++i) {
      std::vector<std::size_t> corners = corners_of(i);
      if (corners.empty()) continue;
      for (const std::size_t corner : corners) {
        middle = sum(middle, 1, vector_at(values_, 3 * corner));
        count += 1;
      }
      sides.push_back(std::move(corners));
      entries.push_back(i);
    }
    if (sides.size() < 4) {
      fail(ErrorId::BadArgument, fmt::format("a body of {} sides", sides.size()), "four to six",
           24);
    }
    middle = scaled(Rational(1 / count), middle);
    for (std::size_t i = 0; i < sides.size(); ++i) add_side(sides, i, middle, entries[i]);
    intersect_facets();
  }

  std::vector<std::size_t> corners_of(std::size_t index) const {
    const Rational& value = values_[index];
    if (value.get_den() != 1 || value < 0 || value > 8888) {
      fail(ErrorId::BadArgument, fmt::format("the side '{:.40}'", entries_[index].word.text),
           "the numbers of three or four corners", index);
    }
    std::vector<std::size_t> corners;
    for (long rest = value.get_num().get_si(); rest != 0; rest /= 10) {
      const long digit = rest % 10;
      if (digit > 8) fail(ErrorId::BadArgument, "corner 9", "corners from 1 to 8", index);
      if (digit > 0) corners.insert(corners.begin(), static_cast<std::size_t>(digit - 1));
    }
    if (!corners.empty() && corners.size() < 3) {
      fail(ErrorId::BadArgument, fmt::format("a side of {} corners", corners.size()),
           "three or four", index);
    }
    return corners;
  }

  void add_side(const std::vector<std::vector<std::size_t>>& sides, std::size_t index,
                const Vector& middle, std::size_t entry) {
    const auto corner = [&](std::size_t i) { return vector_at(values_, 3 * i); };
    const std::vector<std::size_t>& corners = sides[index];
    const Vector a = corner(corners[0]);
    Vector normal = vector_product(sum(corner(corners[1]), -1, a), sum(corner(corners[2]), -1, a));
    if (is_zero(normal)) {
      fail(ErrorId::DegenerateFacet, "a side whose corners are on a line", "", entry);
    }
    Rational height = scalar_product(normal, sum(middle, -1, a));
    if (height > 0) {
      normal = scaled(-1, normal);
      height = -height;
    }
    if (height == 0) fail(ErrorId::NotConvex, "a body without an inside", "", entry);
    // In units of the distance of the middle.
    constexpr double tolerance = 1e-5;
    const auto offset = [&](std::size_t i) {
      return nearest_double(Rational(scalar_product(normal, sum(corner(i), -1, a)) / -height));
    };
    for (const std::size_t i : corners) {
      if (std::abs(offset(i)) > tolerance) {
        fail(ErrorId::NonPlanarFacet, "four corners that are not in a plane", "", entry);
      }
      if (offset(i) != 0) {
        warnings_.push_back({"the side is the plane through its first three corners",
                             card_.position(entries_[entry].word.at)});
      }
    }
    for (const auto& side : sides) {
      for (const std::size_t i : side) {
        if (offset(i) > tolerance) {
          fail(ErrorId::NotConvex, "a side beyond which the body goes on", "", entry);
        }
      }
    }
    add_facet(normal, a);
  }

  const Card& card_;
  std::vector<Warning>& warnings_;
  std::vector<Word> words_;
  Word type_;
  std::vector<Entry> entries_;
  std::vector<Rational> values_;
  std::size_t axis_ = 0;
  Body body_;
};

}  // namespace

bool SurfaceCard::is_plane() const {
  return body.shapes.size() == 1 &&
         (body.shapes[0].type == "plane" || is_kind(body.shapes[0], "plane"));
}

SurfaceCard read_surface_card(const Card& card, std::vector<Warning>& warnings) {
  return SurfaceReader(card, warnings).read();
}

std::optional<Body> moved(const AffineMap& map, const Body& body) {
  Body result;
  result.is_macrobody = body.is_macrobody;
  std::vector<ShapeSide> images;
  for (const Shape& shape : body.shapes) {
    const auto image = add_image(result, map, shape);
    if (!image) return std::nullopt;
    result.shapes.back().is_auxiliary = shape.is_auxiliary;
    images.push_back(*image);
  }
  const auto side_of = [&](const ShapeSide& side) {
    return ShapeSide{images[side.shape].shape, side.is_positive != images[side.shape].is_positive};
  };
  result.negative = csg::map(body.negative, side_of);
  for (const auto& facet : body.facets) {
    result.facets.push_back(facet ? std::optional<ShapeSide>(side_of(*facet)) : std::nullopt);
  }
  return result;
}

}  // namespace exactcsg::io::mcnp
