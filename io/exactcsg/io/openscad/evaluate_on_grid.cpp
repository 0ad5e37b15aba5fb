// SPDX-License-Identifier: GPL-3.0-or-later
// The builder of Rounding::OpenScadGrid. Orders of operations in double are those of OpenSCAD
// 2021.01 (src/primitives.cc, src/GeometryEvaluator.cc) and are part of the result.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "exactcsg/io/openscad/clipping.hpp"
#include "exactcsg/io/openscad/degree_trigonometry.hpp"
#include "exactcsg/io/openscad/evaluate.hpp"
#include "exactcsg/io/openscad/grid_rounding.hpp"
#include "exactcsg/io/openscad/named_files.hpp"
#include "exactcsg/io/openscad/node_walk.hpp"
#include "exactcsg/io/openscad/shapes.hpp"
#include "exactcsg/io/planar/minkowski.hpp"
#include "exactcsg/io/planar/projection.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"

namespace exactcsg::io::openscad {

namespace {

using csg::BooleanOperator;

struct GridOutcome {
  std::uint32_t node = 0;
  int dimension = 0;
  bool exact = false;  // `solid` counts, not `soup`
  Soup soup;
  Solid solid;
  DoubleFigure planar;

  bool is_empty() const {
    if (dimension == 2) return planar.outlines.empty();
    return dimension == 0 || (exact ? solid.is_empty() : soup.is_empty());
  }
};

DoubleFigure clip(BooleanOperator operation, std::span<const GridOutcome> operands) {
  std::vector<DoubleFigure> figures;
  for (const GridOutcome& operand : operands) {
    figures.push_back(operand.dimension == 2 ? operand.planar : DoubleFigure{});
  }
  return clip(operation, figures);
}

// Of an outline that does not cross itself.
bool is_counter_clockwise(const DoubleOutline& outline) {
  double twice_area = 0;
  const auto& v = outline.vertices;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto& p = v[i];
    const auto& q = v[(i + 1) % v.size()];
    twice_area += p[0] * q[1] - p[1] * q[0];
  }
  return twice_area > 0;
}

bool is_convex(const DoubleFigure& figure) {
  if (figure.outlines.size() > 1) return false;
  if (figure.outlines.empty()) return true;
  const auto& v = figure.outlines[0].vertices;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto& p = v[i];
    const auto& q = v[(i + 1) % v.size()];
    const auto& r = v[(i + 2) % v.size()];
    if ((q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]) < 0) return false;
  }
  return true;
}

// A polygon whose vertices OpenSCAD puts in from the last to the first.
std::vector<DoublePoint> reversed(std::vector<DoublePoint> polygon) {
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

// Turned and scaled, as a level of an extrusion is.
struct LevelMap {
  double xx, xy, yx, yy;
  LevelMap(const DoublePoint2& scale, double degrees) {
    const double s = sine_of_degrees(degrees);
    const double c = cosine_of_degrees(degrees);
    xx = scale[0] * c;
    xy = scale[0] * -s;
    yx = scale[1] * s;
    yy = scale[1] * c;
  }
  DoublePoint2 operator()(const DoublePoint2& p) const {
    return {xx * p[0] + xy * p[1], yx * p[0] + yy * p[1]};
  }
};

// -1 or 1 if one length is shorter by more than 10 millionths, else 0.
int compare_lengths(const DoublePoint2& u, const DoublePoint2& v) {
  const double a = std::sqrt(u[0] * u[0] + u[1] * u[1]);
  const double b = std::sqrt(v[0] * v[0] + v[1] * v[1]);
  if (2 * std::fabs(a - b) * 1e5 <= a + b) return 0;
  return a < b ? -1 : 1;
}

class GridBuilder {
 public:
  struct Context {};
  using Outcome = GridOutcome;

  GridBuilder(const SyntaxTree& tree, Warnings& warnings, const ReadOptions& options)
      : tree_(tree), warnings_(warnings), files_(options.folder) {}

  static Context root() { return {}; }
  static Context below(NodeKind, std::uint32_t, const Context&) { return {}; }

  Model finish(const std::vector<Outcome>& statements) {
    Model model;
    const Outcome whole = unite(statements);
    if (whole.dimension == 2) {
      throw Error(ErrorId::NotThreeDimensional,
                  {"a planar model", "a solid", position(whole.node)});
    }
    if (!whole.is_empty()) model.solid = exact(whole);
    if (model.solid.is_empty()) {
      warnings_.add("the model is empty (OpenSCAD refuses to export it)", position(0));
    }
    model.primitives = primitives_;
    model.fonts = texts_.fonts();
    // Cut by less than a cell, moved to a neighbour's cell by less than another.
    model.rounding_bound = Rational(1, Integer(1) << 19U);
    return model;
  }

  Outcome leaf(NodeKind kind, std::uint32_t node, const Context&) {
    Outcome result;
    using enum NodeKind;
    if (is_planar_leaf(kind)) {
      result.dimension = 2;
      result.planar = planar_leaf(kind, node);
      return result;
    }
    ++primitives_;
    result.dimension = 3;
    result.soup = kind == Cube       ? cube(node)
                  : kind == Sphere   ? sphere(node)
                  : kind == Cylinder ? cylinder(node)
                  : kind == Import   ? imported(node)
                  : kind == Surface  ? surface(node)
                                     : polyhedron(node);
    return result;
  }

  Outcome inner(NodeKind kind, std::uint32_t node, const Context&,
                std::span<const Outcome> operands) {
    switch (kind) {
      case NodeKind::Difference:
        return boolean(BooleanOperator::Difference, operands);
      case NodeKind::Intersection:
        return boolean(BooleanOperator::Intersection, operands);
      case NodeKind::Hull:
        return hull_of(operands);
      case NodeKind::Multmatrix:
        return moved(node, operands);
      case NodeKind::LinearExtrude:
        return linear(node, operands);
      case NodeKind::RotateExtrude:
        return rotate(node, operands);
      case NodeKind::Offset:
        return offset_of(node, operands);
      case NodeKind::Projection:
        return projection(node, operands);
      case NodeKind::Resize:
        return resized(node, operands);
      case NodeKind::Minkowski:
        return minkowski(operands);
      default:
        return unite(operands);
    }
  }

 private:
  SourcePosition position(std::uint32_t node) const {
    return tree_.position(tree_.nodes[node].offset);
  }

  Solid exact(const Outcome& outcome) const {
    if (outcome.dimension != 3 || outcome.is_empty()) return Solid::empty();
    try {
      return outcome.exact ? outcome.solid : cut_to_grid(outcome.soup);
    } catch (const Error& error) {
      throw error.at(position(outcome.node));
    }
  }

  Outcome unite(std::span<const Outcome> operands) {
    return boolean(BooleanOperator::Union, operands);
  }

  static const Outcome* first_of_any_dimension(std::span<const Outcome> operands) {
    const auto first = std::find_if(operands.begin(), operands.end(),
                                    [](const Outcome& o) { return o.dimension != 0; });
    return first == operands.end() ? nullptr : &*first;
  }

  Outcome boolean(BooleanOperator operation, std::span<const Outcome> operands) {
    Outcome result;
    const Outcome* const first = first_of_any_dimension(operands);
    if (first == nullptr) return result;
    if (operands.size() == 1) return *first;
    result.node = first->node;
    result.dimension = first->dimension;
    if (result.dimension == 2) {
      result.planar = clip(operation, operands);
      return result;
    }
    const auto is_operand = [](const Outcome& o) { return o.dimension == 3 && !o.is_empty(); };
    if (operation == BooleanOperator::Union) {
      const auto count = std::count_if(operands.begin(), operands.end(), is_operand);
      if (count == 0) return result;
      if (count == 1) return *std::find_if(operands.begin(), operands.end(), is_operand);
    }
    result.exact = true;
    std::vector<Solid> solids;
    for (std::size_t i = 0; i < operands.size(); ++i) {
      Solid solid = exact(operands[i]);
      if (!solid.is_empty()) {
        solids.push_back(std::move(solid));
      } else if (operation == BooleanOperator::Intersection ||
                 (operation == BooleanOperator::Difference && i == 0)) {
        return result;
      }
    }
    if (!solids.empty()) result.solid = Solid::compose(operation, std::move(solids));
    return result;
  }

  Outcome moved(std::uint32_t node, std::span<const Outcome> operands) {
    const auto map = read_multmatrix(tree_, node, warnings_);
    if (!map) return {};
    Outcome result = unite(operands);
    DoubleMap m{};
    AffineMap exact_map;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 4; ++k) {
        m[i][k] = nearest_double(map->m[i][k]);
        exact_map.m[i][k] = rational_of(m[i][k]);
      }
    }
    if (result.is_empty()) return result;
    if (result.dimension == 2) {
      move_planar(m, result.planar);
    } else if (!result.exact) {
      result.soup = transformed(m, std::move(result.soup));
    } else if (openscad::determinant(m) == 0) {
      result.solid = Solid::empty();
    } else {
      result.solid = apply(exact_map, result.solid);
    }
    return result;
  }

  static void move_planar(const DoubleMap& m, DoubleFigure& figure) {
    const double area = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    if (area == 0) {
      figure.outlines.clear();
      return;
    }
    for (DoubleOutline& outline : figure.outlines) {
      for (auto& [x, y] : outline.vertices) {
        const double u = m[0][0] * x + (m[0][1] * y + m[0][3]);
        const double v = m[1][0] * x + (m[1][1] * y + m[1][3]);
        x = u;
        y = v;
      }
    }
    if (area < 0) figure = sanitized(figure, Winding::Keep);
  }

  Outcome hull_of(std::span<const Outcome> operands) {
    Outcome result;
    const Outcome* const first = first_of_any_dimension(operands);
    if (first == nullptr) return result;
    result.dimension = first->dimension;
    result.dimension == 2 ? planar_hull(operands, result) : solid_hull(operands, result);
    return result;
  }

  static void planar_hull(std::span<const Outcome> operands, Outcome& result) {
    std::vector<PlanarTree> trees;
    for (const Outcome& operand : operands) {
      for (const DoubleOutline& outline : operand.planar.outlines) {
        PlanarFigure figure;
        auto& path = figure.paths.emplace_back();
        for (const auto& [x, y] : outline.vertices)
          path.push_back({rational_of(x), rational_of(y)});
        trees.push_back(PlanarTree::primitive(std::move(figure)));
      }
    }
    if (trees.empty()) return;
    const auto corners = hull(PlanarTree::compose(BooleanOperator::Union, std::move(trees)));
    if (corners.size() < 3) return;
    DoubleOutline& outline = result.planar.outlines.emplace_back();
    for (const Point2& p : corners) {
      outline.vertices.push_back({nearest_double(p.x), nearest_double(p.y)});
    }
  }

  static void solid_hull(std::span<const Outcome> operands, Outcome& result) {
    std::vector<DoublePoint> points;
    for (const Outcome& operand : operands) {
      if (operand.dimension != 3 || operand.is_empty()) continue;
      // OpenSCAD takes the doubles of the exact corners.
      const std::vector<DoublePoint> some =
          operand.exact ? corners_of(hull(operand.solid)) : points_of(operand.soup);
      points.insert(points.end(), some.begin(), some.end());
    }
    result.soup = hull_soup(points);
  }

  static std::vector<DoublePoint> points_of(const Soup& soup) {
    std::vector<DoublePoint> points;
    const auto add = [&](const std::vector<DoublePoint>& polygon) {
      points.insert(points.end(), polygon.begin(), polygon.end());
    };
    for (const Cap& cap : soup.caps) {
      for (const auto& loop : cap.loops) add(loop);
    }
    for (const auto& polygon : soup.polygons) add(polygon);
    return points;
  }

  static Solid hull_of_points(const std::vector<DoublePoint>& points) {
    std::vector<Point3> exact;
    for (const auto& [x, y, z] : points) {
      exact.push_back({rational_of(x), rational_of(y), rational_of(z)});
    }
    return hull(std::span<const Point3>(exact));
  }

  static Soup hull_soup(const std::vector<DoublePoint>& points) {
    Soup soup;
    soup.convexity = Soup::Convexity::Known;
    std::vector<DoublePoint> corners = corners_of(hull_of_points(points));
    if (!corners.empty()) soup.polygons.push_back(std::move(corners));
    return soup;
  }

  Outcome minkowski(std::span<const Outcome> operands) {
    const Outcome* const first = first_of_any_dimension(operands);
    if (first == nullptr) return {};
    if (first->dimension == 2) {
      Outcome result;
      result.node = first->node;
      result.dimension = 2;
      result.planar = minkowski_sum(figures_of(operands));
      return result;
    }
    std::optional<Outcome> sum;
    for (const Outcome& operand : operands) {
      if (operand.dimension != 3 || operand.is_empty()) continue;
      sum = sum ? sum_of_convex(*sum, operand) : operand;
    }
    return sum.value_or(Outcome{first->node, 3, false, {}, {}, {}});
  }

  static std::vector<DoubleFigure> figures_of(std::span<const Outcome> operands) {
    std::vector<DoubleFigure> figures;
    for (const Outcome& operand : operands) {
      if (operand.dimension == 2) figures.push_back(operand.planar);
    }
    return figures;
  }

  static bool is_convex_as_written(const Outcome& operand) {
    return !operand.exact && operand.soup.convexity == Soup::Convexity::Known;
  }

  // The hull of the sums, in double, of the corners that were cut.
  static Outcome sum_of_convex(const Outcome& a, const Outcome& b) {
    if (!is_convex_as_written(a) || !is_convex_as_written(b)) {
      refuse("'minkowski' of bodies other than convex ones, whose parts it rounds,");
    }
    const std::vector<DoublePoint> first = cut_corners(a.soup);
    const std::vector<DoublePoint> second = cut_corners(b.soup);
    if (!second.empty() && first.size() > minkowski_point_limit / second.size()) {
      throw Error(ErrorId::TooLarge,
                  {"more than " + std::to_string(minkowski_point_limit) + " sums of points", ""});
    }
    std::vector<DoublePoint> sums;
    for (const auto& p : first) {
      for (const auto& q : second) sums.push_back({p[0] + q[0], p[1] + q[1], p[2] + q[2]});
    }
    Outcome result;
    result.node = a.node;
    result.dimension = 3;
    result.soup = hull_soup(sums);
    return result;
  }

  static std::vector<DoublePoint> corners_of(const Solid& hull) {
    std::vector<DoublePoint> corners;
    if (!hull.is_primitive()) return corners;
    const auto& shape = hull.primitive().shape;
    for (const Point3& p : std::get<ConvexPolytope>(shape).polyhedron->vertices) {
      corners.push_back({nearest_double(p.x), nearest_double(p.y), nearest_double(p.z)});
    }
    return corners;
  }

  Soup cube(std::uint32_t node) {
    const BoxShape shape = read_cube(tree_, node, warnings_);
    Soup soup;
    soup.convexity = Soup::Convexity::Known;
    std::array<double, 3> lower{};
    std::array<double, 3> upper{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (shape.size[i] == 0) return soup;
      const double size = nearest_double(shape.size[i]);
      lower[i] = shape.center ? -size / 2 : 0;
      upper[i] = shape.center ? size / 2 : size;
    }
    for (const double z : {upper[2], lower[2]}) {
      soup.polygons.push_back({{lower[0], lower[1], z},
                               {upper[0], lower[1], z},
                               {upper[0], upper[1], z},
                               {lower[0], upper[1], z}});
    }
    return soup;
  }

  static std::vector<DoublePoint> ring(double radius, double z, std::size_t n) {
    std::vector<DoublePoint> points;
    for (const auto& [c, s] : circle_directions(n)) points.push_back({radius * c, radius * s, z});
    return points;
  }

  Soup sphere(std::uint32_t node) {
    const SphereShape shape = read_sphere(tree_, node, warnings_);
    Soup soup;
    soup.convexity = Soup::Convexity::Known;
    const double radius = nearest_double(shape.radius);
    if (radius == 0) return soup;
    const std::size_t n = fragments(radius, shape.fineness);
    const std::size_t rings = (n + 1) / 2;
    count_vertices(n, rings);
    for (std::size_t i = 0; i < rings; ++i) {
      const double phi = (180.0 * (static_cast<double>(i) + 0.5)) / static_cast<double>(rings);
      soup.polygons.push_back(
          ring(radius * sine_of_degrees(phi), radius * cosine_of_degrees(phi), n));
    }
    return soup;
  }

  Soup cylinder(std::uint32_t node) {
    const CylinderShape shape = read_cylinder(tree_, node, warnings_);
    Soup soup;
    soup.convexity = Soup::Convexity::Known;
    const double height = nearest_double(shape.height);
    const double lower = nearest_double(shape.lower_radius);
    const double upper = nearest_double(shape.upper_radius);
    if (height == 0 || (lower == 0 && upper == 0)) return soup;
    const std::size_t n = fragments(std::max(lower, upper), shape.fineness);
    count_vertices(n, 2);
    soup.polygons.push_back(ring(lower, shape.center ? -height / 2 : 0, n));
    soup.polygons.push_back(ring(upper, shape.center ? height / 2 : height, n));
    return soup;
  }

  // Without a position: the walk knows it.
  [[noreturn]] static void refuse(const std::string& what) {
    throw Error(ErrorId::UnsupportedNode, {what + " under OpenSCAD's own rounding", ""});
  }

  Outcome offset_of(std::uint32_t node, std::span<const Outcome> operands) {
    Outcome result;
    const OffsetShape shape = read_offset(tree_, node, warnings_);
    const auto figure = planar_children(operands);
    if (!figure) return result;
    result.dimension = 2;
    result.planar =
        grown(*figure, nearest_double(shape.distance), shape.corner, arc_tolerance(shape));
    return result;
  }

  Outcome projection(std::uint32_t node, std::span<const Outcome> operands) {
    const bool cut = read_projection_cut(tree_, node, warnings_);
    std::vector<Outcome> solids;
    for (const Outcome& operand : operands) {
      if (operand.dimension == 3) solids.push_back(operand);
    }
    Outcome result;
    result.dimension = 2;
    if (!cut) {
      result.planar = shadow_of(solids);
      return result;
    }
    const Outcome whole = unite(solids);
    if (whole.is_empty()) return result;
    for (const auto& path : resolve(section(exact(whole))).paths) {
      DoubleOutline& outline = result.planar.outlines.emplace_back();
      for (const Point2& p : path) {
        outline.vertices.push_back({p.x.get_d(), p.y.get_d()});  // cut, as OpenSCAD's doubles are
      }
      outline.positive = is_counter_clockwise(outline);
    }
    return result;
  }

  static DoubleFigure shadow_of(std::span<const Outcome> solids) {
    std::vector<DoubleFigure> facets;
    for (const Outcome& solid : solids) {
      if (solid.is_empty()) continue;
      if (!is_convex_as_written(solid)) {
        refuse(
            "'projection' without cut of bodies other than convex ones, whose facets it unites,");
      }
      facets.push_back(facets_from_above(hull_of_points(points_of(solid.soup))));
    }
    return united_shadows(facets);
  }

  static DoubleFigure facets_from_above(const Solid& hull) {
    DoubleFigure figure;
    if (!hull.is_primitive()) return figure;
    const StoredPolyhedron& shape = *std::get<ConvexPolytope>(hull.primitive().shape).polyhedron;
    for (const auto facet : shape.facets) {
      DoubleOutline& outline = figure.outlines.emplace_back();
      for (const std::uint32_t v : facet) {
        const Point3& p = shape.vertices[v];
        outline.vertices.push_back({nearest_double(p.x), nearest_double(p.y)});
      }
    }
    return figure;
  }

  Outcome resized(std::uint32_t node, std::span<const Outcome> operands) {
    const ResizeShape shape = read_resize(tree_, node, warnings_);
    Outcome result = unite(operands);
    if (result.is_empty()) return result;
    if (result.dimension == 3 && result.exact) {
      // The sizes' doubles by the exact extents, and that as a double.
      const auto box = bounding_box(evaluate(result.solid));
      if (!box) return result;
      const Vector3 extents = box->upper - box->lower;
      const std::array<Rational, 3> sizes{extents.x, extents.y, extents.z};
      ResizeShape rounded = shape;
      for (Rational& size : rounded.size) size = rational_of(nearest_double(size));
      const auto factors = resize_factors(rounded, sizes);
      AffineMap map = AffineMap::identity();
      // Its library's conversion to double cuts.
      for (std::size_t i = 0; i < 3; ++i) map.m[i][i] = rational_of(factors[i].get_d());
      result.solid = apply(map, result.solid);
      return result;
    }
    DoubleMap map{};
    const auto factors = double_factors(shape, result);
    for (std::size_t i = 0; i < 3; ++i) map[i][i] = factors[i];
    if (result.dimension == 2) {
      move_planar(map, result.planar);
    } else {
      result.soup = transformed(map, std::move(result.soup));
    }
    return result;
  }

  // The same in double, as OpenSCAD does it to figures and polygons.
  static std::array<double, 3> double_factors(const ResizeShape& shape, const Outcome& body) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    std::array<double, 3> lower{infinite, infinite, infinite};
    std::array<double, 3> upper{-infinite, -infinite, -infinite};
    const auto add = [&](const auto& point) {
      for (std::size_t i = 0; i < point.size(); ++i) {
        lower[i] = std::min(lower[i], point[i]);
        upper[i] = std::max(upper[i], point[i]);
      }
    };
    for (const DoubleOutline& outline : body.planar.outlines) {
      for (const auto& p : outline.vertices) add(p);
    }
    for (const auto& polygon : body.soup.polygons) {
      for (const auto& p : polygon) add(p);
    }
    for (const Cap& cap : body.soup.caps) {
      for (const auto& loop : cap.loops) {
        for (const auto& p : loop) add(p);
      }
    }
    const std::size_t axes = body.dimension == 2 ? 2 : 3;
    std::array<double, 3> factors{1, 1, 1};
    std::size_t largest = 0;
    for (std::size_t i = 0; i < axes; ++i) {
      if (shape.size[i] > 0) factors[i] = nearest_double(shape.size[i]) / (upper[i] - lower[i]);
      if (shape.size[i] > shape.size[largest]) largest = i;
    }
    for (std::size_t i = 0; i < axes; ++i) {
      if (shape.size[i] == 0 && shape.automatic[i]) factors[i] = factors[largest];
    }
    return factors;
  }

  Soup imported(std::uint32_t node) {
    const PolygonSoup& mesh = files_.mesh(read_import(tree_, node, warnings_));
    return soup_of({mesh.vertices, mesh.facets});
  }

  Soup surface(std::uint32_t node) {
    return soup_of(files_.height_field(read_surface(tree_, node, warnings_)));
  }

  Soup polyhedron(std::uint32_t node) { return soup_of(read_polyhedron(tree_, node, warnings_)); }

  static Soup soup_of(const FacedPoints& shape) {
    Soup soup;
    for (const auto& face : shape.faces) {
      auto& polygon = soup.polygons.emplace_back();
      for (const std::uint32_t index : face) {
        const Point3& p = shape.points[index];
        polygon.push_back({nearest_double(p.x), nearest_double(p.y), nearest_double(p.z)});
      }
    }
    return soup;
  }

  DoubleFigure planar_leaf(NodeKind kind, std::uint32_t node) {
    if (kind == NodeKind::Text) return text(node);
    DoubleFigure figure;
    if (kind == NodeKind::Polygon) {
      PlanarFigure given = read_polygon(tree_, node, warnings_);
      for (const auto& path : given.paths) {
        DoubleOutline& outline = figure.outlines.emplace_back();
        for (const Point2& p : path) {
          outline.vertices.push_back({nearest_double(p.x), nearest_double(p.y)});
        }
      }
      return sanitized(figure, Winding::MakePositive);
    }
    DoubleOutline outline;
    if (kind == NodeKind::Square) {
      const SquareShape shape = read_square(tree_, node, warnings_);
      const double x = nearest_double(shape.size[0]);
      const double y = nearest_double(shape.size[1]);
      if (x == 0 || y == 0) return figure;
      const double x0 = shape.center ? 0 - x / 2 : 0;
      const double y0 = shape.center ? 0 - y / 2 : 0;
      const double x1 = shape.center ? x - x / 2 : x;
      const double y1 = shape.center ? y - y / 2 : y;
      outline.vertices = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    } else {
      const CircleShape shape = read_circle(tree_, node, warnings_);
      const double radius = nearest_double(shape.radius);
      if (radius == 0) return figure;
      for (const auto& [c, s] : circle_directions(fragments(radius, shape.fineness))) {
        outline.vertices.push_back({radius * c, radius * s});
      }
    }
    figure.outlines.push_back(std::move(outline));
    return figure;
  }

  // OpenSCAD unites the letters even if there is only one.
  DoubleFigure text(std::uint32_t node) {
    const TextOutline outline = texts_.outline(read_text(tree_, node, warnings_));
    for (const std::string& remark : outline.remarks) warnings_.add(remark, position(node));
    std::vector<DoubleFigure> letters;
    for (const LetterPaths& paths : outline.letters) {
      DoubleFigure& letter = letters.emplace_back();
      for (const auto& path : paths) letter.outlines.push_back({path});
    }
    return clip(BooleanOperator::Union, letters);
  }

  // The planar children of an extrusion, united. nullopt: there are none at all.
  static std::optional<DoubleFigure> planar_children(std::span<const Outcome> operands) {
    if (first_of_any_dimension(operands) == nullptr) return std::nullopt;
    if (operands.size() == 1) return operands[0].planar;
    return clip(BooleanOperator::Union, operands);
  }

  Outcome linear(std::uint32_t node, std::span<const Outcome> operands) {
    Outcome result;
    const LinearExtrudeShape shape = read_linear_extrude(tree_, node, warnings_);
    const auto figure = planar_children(operands);
    if (!figure) return result;
    ++primitives_;
    result.dimension = 3;
    if (figure->outlines.empty() || shape.height == 0) return result;
    const double height = nearest_double(shape.height);
    const double twist = nearest_double(shape.twist);
    const DoublePoint2 scale{nearest_double(shape.scale[0]), nearest_double(shape.scale[1])};
    const double h1 = shape.center ? -height / 2.0 : 0;
    const double h2 = shape.center ? height / 2.0 : height;
    if (is_convex(*figure) && twist == 0 && scale[0] == scale[1]) {
      result.soup.convexity = Soup::Convexity::Known;
    }
    add_cap(result.soup, *figure, LevelMap({1, 1}, 0), h1, false);
    if (scale[0] > 0 && scale[1] > 0) {
      add_cap(result.soup, *figure, LevelMap(scale, -twist), h2, true);
    }
    const std::size_t slices = shape.slices ? *shape.slices : slice_count(shape, *figure);
    std::size_t vertices = 0;
    for (const DoubleOutline& outline : figure->outlines) vertices += outline.vertices.size();
    count_vertices(vertices, slices + 1);
    const auto count = static_cast<double>(slices);
    for (std::size_t j = 0; j < slices; ++j) {
      const auto a = static_cast<double>(j);
      const auto b = static_cast<double>(j + 1);
      const auto scaled = [&](double step) {
        return DoublePoint2{1 - (1 - scale[0]) * step / count, 1 - (1 - scale[1]) * step / count};
      };
      add_slice(result.soup, *figure, twist * a / count, twist * b / count,
                h1 + (h2 - h1) * a / count, h1 + (h2 - h1) * b / count, scaled(a), scaled(b));
    }
    return result;
  }

  static void add_cap(Soup& soup, const DoubleFigure& figure, const LevelMap& map, double z,
                      bool upward) {
    Cap& cap = soup.caps.emplace_back();
    for (const DoubleOutline& outline : figure.outlines) {
      auto& loop = cap.loops.emplace_back();
      for (const DoublePoint2& v : outline.vertices) {
        const auto [x, y] = map(v);
        loop.push_back({x, y, z});
      }
      if (!upward) std::reverse(loop.begin(), loop.end());
    }
  }

  static void add_slice(Soup& soup, const DoubleFigure& figure, double turn1, double turn2,
                        double h1, double h2, const DoublePoint2& scale1,
                        const DoublePoint2& scale2) {
    const LevelMap lower(scale1, -turn1);
    const LevelMap upper(scale2, -turn2);
    const bool any_zero = scale2[0] == 0 || scale2[1] == 0;
    const bool any_non_zero = scale2[0] != 0 || scale2[1] != 0;
    const bool back_twist = turn2 <= turn1;
    for (const DoubleOutline& outline : figure.outlines) {
      const auto& v = outline.vertices;
      DoublePoint2 p1 = lower(v[0]);
      DoublePoint2 p2 = upper(v[0]);
      const bool flip = !outline.positive != back_twist;
      for (std::size_t i = 1; i <= v.size(); ++i) {
        const DoublePoint2 c1 = lower(v[i % v.size()]);
        const DoublePoint2 c2 = upper(v[i % v.size()]);
        const int order =
            compare_lengths({p1[0] - c2[0], p1[1] - c2[1]}, {c1[0] - p2[0], c1[1] - p2[1]});
        const bool split_first = order == -1 || (order == 0 && !flip);
        const DoublePoint a1{p1[0], p1[1], h1};
        const DoublePoint a2{p2[0], p2[1], h2};
        const DoublePoint b1{c1[0], c1[1], h1};
        const DoublePoint b2{c2[0], c2[1], h2};
        const bool second = !any_zero || (any_non_zero && p2 != c2);
        if (split_first != any_zero) {
          soup.polygons.push_back(reversed({a1, b2, b1}));
          if (second) soup.polygons.push_back(reversed({b2, a1, a2}));
        } else {
          soup.polygons.push_back(reversed({a1, a2, b1}));
          if (second) soup.polygons.push_back(reversed({a2, b2, b1}));
        }
        p1 = c1;
        p2 = c2;
      }
    }
  }

  static std::size_t slice_count(const LinearExtrudeShape& shape, const DoubleFigure& figure) {
    const double height = nearest_double(shape.height);
    const double twist = nearest_double(shape.twist);
    const double sx = nearest_double(shape.scale[0]);
    const double sy = nearest_double(shape.scale[1]);
    double radius_squared = 0;
    double delta_squared = 0;
    for (const DoubleOutline& outline : figure.outlines) {
      for (const auto& [x, y] : outline.vertices) {
        radius_squared = std::max(radius_squared, x * x + y * y);
        const double dx = x - x * sx;
        const double dy = y - y * sy;
        delta_squared = std::max(delta_squared, dx * dx + dy * dy);
      }
    }
    if (twist == 0) {
      return sx == sy ? 1 : diagonal_slices(delta_squared, height, shape.fineness);
    }
    if ((sx == 1.0 && sy == 1.0) || sx != sy) {
      return helix_slices(radius_squared, height, twist, shape.fineness);
    }
    return conical_helix_slices(radius_squared, height, twist, sx, shape.fineness);
  }

  Outcome rotate(std::uint32_t node, std::span<const Outcome> operands) {
    Outcome result;
    const RotateExtrudeShape shape = read_rotate_extrude(tree_, node, warnings_);
    const auto figure = planar_children(operands);
    if (!figure || shape.angle == 0) return result;
    ++primitives_;
    result.dimension = 3;
    if (figure->outlines.empty()) return result;
    double least = 0;
    double largest = 0;
    std::size_t vertices = 0;
    for (const DoubleOutline& outline : figure->outlines) {
      vertices += outline.vertices.size();
      for (const auto& [x, y] : outline.vertices) {
        least = std::min(least, x);
        largest = std::max(largest, x);
      }
    }
    if (least < 0 && largest > 0) {
      throw Error(ErrorId::BadArgument, {"an outline on both sides of the axis of rotation",
                                         "x >= 0 everywhere, or x <= 0"});
    }
    const double angle = nearest_double(shape.angle);
    const auto count = static_cast<std::size_t>(std::max(
        static_cast<double>(fragments(largest - least, shape.fineness)) * std::abs(angle) / 360,
        1.0));
    count_vertices(vertices, count + 1);
    const bool flip =
        (least >= 0 && angle > 0 && angle != 360) || (least < 0 && (angle < 0 || angle == 360));
    if (angle != 360) add_rotation_caps(result.soup, *figure, angle, flip);
    for (const DoubleOutline& outline : figure->outlines) {
      add_rings(result.soup, outline, angle, count, flip);
    }
    return result;
  }

  static void add_rotation_caps(Soup& soup, const DoubleFigure& figure, double angle, bool flip) {
    const double c = cosine_of_degrees(angle);
    const double s = sine_of_degrees(angle);
    Cap start;
    Cap end;
    for (const DoubleOutline& outline : figure.outlines) {
      auto& first = start.loops.emplace_back();
      auto& last = end.loops.emplace_back();
      for (const auto& [x, y] : outline.vertices) {
        first.push_back({x, 0, y});
        last.push_back({c * x, s * x, y});
      }
      std::reverse(flip ? last.begin() : first.begin(), flip ? last.end() : first.end());
    }
    soup.caps.push_back(std::move(start));
    soup.caps.push_back(std::move(end));
  }

  static void add_rings(Soup& soup, const DoubleOutline& outline, double angle, std::size_t count,
                        bool flip) {
    const std::size_t m = outline.vertices.size();
    const auto ring_at = [&](double a) {
      std::vector<DoublePoint> ring;
      for (std::size_t i = 0; i < m; ++i) {
        const auto& [x, y] = outline.vertices[flip ? m - 1 - i : i];
        ring.push_back({x * sine_of_degrees(a), x * cosine_of_degrees(a), y});
      }
      return ring;
    };
    const auto steps = static_cast<double>(count);
    std::vector<DoublePoint> ring = ring_at(angle == 360 ? -90 : 90);
    for (std::size_t j = 0; j < count; ++j) {
      const double a = angle == 360 ? -90 + static_cast<double>((j + 1) % count) * 360.0 / steps
                                    : 90 - static_cast<double>(j + 1) * angle / steps;
      std::vector<DoublePoint> next = ring_at(a);
      for (std::size_t i = 0; i < m; ++i) {
        const std::size_t k = (i + 1) % m;
        soup.polygons.push_back(reversed({ring[i], next[k], ring[k]}));
        soup.polygons.push_back(reversed({ring[i], next[i], next[k]}));
      }
      ring = std::move(next);
    }
  }

  void count_vertices(std::size_t outline, std::size_t levels) {
    if (outline != 0 && levels > (model_vertex_limit - vertices_) / outline) {
      throw Error(
          ErrorId::TooLarge,
          {"more than " + std::to_string(model_vertex_limit) + " vertices of primitives", ""});
    }
    vertices_ += outline * levels;
  }

  const SyntaxTree& tree_;
  Warnings& warnings_;
  NamedFiles files_;
  TextOutlines texts_;
  std::size_t primitives_ = 0;
  std::size_t vertices_ = 0;
};

}  // namespace

Model evaluate_on_grid(const SyntaxTree& tree, const ReadOptions& options) {
  Warnings warnings;
  GridBuilder builder(tree, warnings, options);
  NodeWalk<GridBuilder> walk(tree, builder, warnings, options.progress);
  Model model = builder.finish(walk.run());
  model.warnings = std::move(warnings).take();
  return model;
}

}  // namespace exactcsg::io::openscad
