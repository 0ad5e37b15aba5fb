// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/evaluate.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "exactcsg/io/openscad/degree_trigonometry.hpp"
#include "exactcsg/io/openscad/named_files.hpp"
#include "exactcsg/io/openscad/node_walk.hpp"
#include "exactcsg/io/openscad/shapes.hpp"
#include "exactcsg/io/planar/minkowski.hpp"
#include "exactcsg/io/planar/offset.hpp"
#include "exactcsg/io/planar/projection.hpp"
#include "exactcsg/io/planar/unions.hpp"
#include "exactcsg/number/products.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"

namespace exactcsg::io::openscad {

namespace {

using csg::BooleanOperator;

// Where the leaves of a subtree are put. The planar map is kept beside the spatial one, since
// OpenSCAD takes the planar part of every single matrix: the part of a product is not the product
// of the parts.
struct Placement {
  AffineMap space = AffineMap::identity();
  AffineMap2 plane = {{{{1, 0, 0}, {0, 1, 0}}}};
  bool singular = false;  // in space: every solid below is empty
};
using PlacementPointer = std::shared_ptr<const Placement>;

// A composition must stay computable however many matrices a file nests.
constexpr std::size_t map_bit_limit = 100'000;

AffineMap2 compose(const AffineMap2& f, const AffineMap& g) {
  AffineMap2 result;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const auto& [k, column] : {std::pair<std::size_t, std::size_t>{0, 0}, {1, 1}, {2, 3}}) {
      add_product(result.m[i][k], f.m[i][0], g.m[0][column]);
      add_product(result.m[i][k], f.m[i][1], g.m[1][column]);
    }
    result.m[i][2] += f.m[i][2];
  }
  return result;
}

std::size_t largest_bits(const AffineMap& map) {
  std::size_t bits = 0;
  for (const auto& row : map.m) {
    for (const Rational& entry : row) {
      bits = std::max({bits, mpz_sizeinbase(entry.get_num_mpz_t(), 2),
                       mpz_sizeinbase(entry.get_den_mpz_t(), 2)});
    }
  }
  return bits;
}

// Largest sum of magnitudes in a row of the linear part: how far it can stretch an error.
template <class Map>
Rational stretch(const Map& map) {
  Rational largest{0};
  for (const auto& row : map.m) {
    Rational sum{0};
    for (std::size_t k = 0; k + 1 < row.size(); ++k) sum += abs(row[k]);
    if (sum > largest) largest = sum;
  }
  return largest;
}

Point2 apply(const AffineMap2& map, const Point2& p) {
  return {map.m[0][0] * p.x + map.m[0][1] * p.y + map.m[0][2],
          map.m[1][0] * p.x + map.m[1][1] * p.y + map.m[1][2]};
}

bool is_singular(const AffineMap2& map) {
  return map.m[0][0] * map.m[1][1] == map.m[0][1] * map.m[1][0];
}

AffineMap diagonal(const Rational& x, const Rational& y, const Rational& z, const Point3& shift) {
  AffineMap map = AffineMap::identity();
  map.m[0][0] = x;
  map.m[1][1] = y;
  map.m[2][2] = z;
  map.m[0][3] = shift.x;
  map.m[1][3] = shift.y;
  map.m[2][3] = shift.z;
  return map;
}

// What a subtree stands for. Dimension 0: nothing at all (a group without children); an empty set
// of dimension 2 or 3 is something else, since it takes part in choosing the parent's dimension.
struct ExactOutcome {
  std::uint32_t node = 0;
  int dimension = 0;
  Solid solid;
  PlanarTree planar;
  Rational rounding{0};  // of its coordinates, as Model::rounding_bound
};

template <class Tree>
const Tree& tree_of(const ExactOutcome& outcome);
template <>
const Solid& tree_of<Solid>(const ExactOutcome& outcome) {
  return outcome.solid;
}
template <>
const PlanarTree& tree_of<PlanarTree>(const ExactOutcome& outcome) {
  return outcome.planar;
}

// OpenSCAD's rules for empty operands: a difference without its first is empty, an intersection
// with an empty one too, all others are skipped.
template <class Tree>
Tree combine(BooleanOperator operation, std::span<const ExactOutcome> operands) {
  std::vector<Tree> trees;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Tree& tree = tree_of<Tree>(operands[i]);
    if (!tree.is_empty()) {
      trees.push_back(tree);
    } else if (operation == BooleanOperator::Intersection ||
               (operation == BooleanOperator::Difference && i == 0)) {
      return Tree::empty();
    }
  }
  if (trees.empty()) return Tree::empty();
  if (trees.size() == 1) return trees.front();
  return Tree::compose(operation, std::move(trees));
}

// Least and largest coordinates of points, axis by axis.
template <std::size_t N>
class Extents {
 public:
  void add(const std::array<Rational, N>& point) {
    for (std::size_t i = 0; i < N; ++i) {
      if (empty_ || point[i] < lower_[i]) lower_[i] = point[i];
      if (empty_ || point[i] > upper_[i]) upper_[i] = point[i];
    }
    empty_ = false;
  }
  bool empty() const { return empty_; }
  std::array<Rational, N> sizes() const {
    std::array<Rational, N> sizes;
    for (std::size_t i = 0; i < N; ++i) sizes[i] = upper_[i] - lower_[i];
    return sizes;
  }

 private:
  bool empty_ = true;
  std::array<Rational, N> lower_;
  std::array<Rational, N> upper_;
};

Extents<3> extents_of(const Solid& solid) {
  Extents<3> extents;
  const auto add = [&](const auto& points) {
    for (const Point3& p : points) extents.add({p.x, p.y, p.z});
  };
  if (only_unites(solid) && is_bounded(solid)) {
    csg::for_each_primitive(
        solid, [&](const Primitive& primitive) { add(polyhedron_of(primitive)->vertices); });
  } else {
    add(evaluate(solid).vertices);
  }
  return extents;
}

Extents<2> extents_of(const PlanarFigure& figure) {
  Extents<2> extents;
  for (const auto& path : figure.paths) {
    for (const Point2& p : path) extents.add({p.x, p.y});
  }
  return extents;
}

class ExactBuilder {
 public:
  using Context = PlacementPointer;
  using Outcome = ExactOutcome;

  ExactBuilder(const SyntaxTree& tree, Warnings& warnings, const ReadOptions& options)
      : tree_(tree),
        warnings_(warnings),
        files_(options.folder),
        fill_(options.fill),
        progress_(options.progress),
        threads_(options.threads) {}

  Context root() const { return identity_; }

  Model finish(std::vector<Outcome> statements) {
    Model model;
    rounding_ = largest_rounding(statements);
    Outcome whole = unite(statements);
    if (whole.dimension == 2) {
      throw Error(ErrorId::NotThreeDimensional,
                  {"a planar model", "a solid", position(whole.node)});
    }
    model.solid = std::move(whole.solid);
    if (model.solid.is_empty()) {
      warnings_.add("the model is empty (OpenSCAD refuses to export it)", position(0));
    }
    model.primitives = primitives_;
    model.rounding_bound = std::move(rounding_);
    model.fonts = texts_.fonts();
    return model;
  }

  Context below(NodeKind kind, std::uint32_t node, const Context& placement) {
    if (has_own_frame(kind)) return identity_;
    if (kind != NodeKind::Multmatrix) return placement;
    const auto map = read_multmatrix(tree_, node, warnings_);
    Placement next;
    if (!map) {
      next.singular = true;
      next.plane.m = {};
      return std::make_shared<const Placement>(std::move(next));
    }
    if (*map == AffineMap::identity()) return placement;
    next.space = placement->space * *map;
    next.plane = compose(placement->plane, *map);
    next.singular = placement->singular;
    if (!next.singular && determinant(*map) == 0) {
      next.singular = true;
      warnings_.add("the matrix is singular: solids below it are empty", position(node));
    }
    if (largest_bits(next.space) > map_bit_limit) {
      throw Error(ErrorId::TooLarge, {"nested matrices whose product has numbers of more than " +
                                          std::to_string(map_bit_limit) + " bits",
                                      "", position(node)});
    }
    return std::make_shared<const Placement>(std::move(next));
  }

  Outcome inner(NodeKind kind, std::uint32_t node, const Context& placement,
                std::span<const Outcome> operands) {
    rounding_ = largest_rounding(operands);
    Outcome result = combined(kind, node, placement, operands);
    result.rounding = std::move(rounding_);
    return result;
  }

  Outcome leaf(NodeKind kind, std::uint32_t node, const Context& context) {
    rounding_ = 0;
    Outcome result = leaf_of(kind, node, *context);
    result.rounding = std::move(rounding_);
    return result;
  }

 private:
  Outcome combined(NodeKind kind, std::uint32_t node, const Context& placement,
                   std::span<const Outcome> operands) {
    switch (kind) {
      case NodeKind::Difference:
        return boolean(BooleanOperator::Difference, operands);
      case NodeKind::Intersection:
        return boolean(BooleanOperator::Intersection, operands);
      case NodeKind::Hull:
        return hull_of(unite(operands));
      case NodeKind::LinearExtrude:
        return linear(node, *placement, operands);
      case NodeKind::RotateExtrude:
        return rotate(node, *placement, operands);
      case NodeKind::Offset:
        return offset_of(node, *placement, operands);
      case NodeKind::Projection:
        return projection(node, *placement, operands);
      case NodeKind::Resize:
        return resized(node, *placement, operands);
      case NodeKind::Minkowski:
        return minkowski(*placement, operands);
      default:
        return unite(operands);
    }
  }

  Outcome leaf_of(NodeKind kind, std::uint32_t node, const Placement& placement) {
    Outcome result;
    using enum NodeKind;
    if (is_planar_leaf(kind)) {
      result.dimension = 2;
      result.planar = planar_leaf(kind, node, placement);
      return result;
    }
    result.dimension = 3;
    if (kind == Polyhedron) {
      result.solid = polyhedron_leaf(node, placement);
      return result;
    }
    if (kind == Import) {
      result.solid = imported(node, placement);
      return result;
    }
    if (kind == Surface) {
      result.solid = surface(node, placement);
      return result;
    }
    const auto shape = kind == Cube ? cube(node) : kind == Sphere ? sphere(node) : cylinder(node);
    if (!shape) return result;
    ++primitives_;
    count_vertices(shape->polyhedron->vertices.size());
    if (placement.singular) return result;
    add_rounding(shape->rounding * stretch(placement.space));
    result.solid = Solid::primitive(
        {place_polytope(placement.space * shape->map, *shape->polyhedron), origin(node)});
    return result;
  }

  SourcePosition position(std::uint32_t node) const {
    return tree_.position(tree_.nodes[node].offset);
  }

  static Rational largest_rounding(std::span<const Outcome> outcomes) {
    Rational largest{0};
    for (const Outcome& outcome : outcomes) largest = std::max(largest, outcome.rounding);
    return largest;
  }

  Outcome unite(std::span<const Outcome> operands) {
    return boolean(BooleanOperator::Union, operands);
  }

  // The first child that is anything decides the dimension; children of the other one count as
  // empty.
  Outcome boolean(BooleanOperator operation, std::span<const Outcome> operands) {
    Outcome result;
    const auto first = std::find_if(operands.begin(), operands.end(),
                                    [](const Outcome& o) { return o.dimension != 0; });
    if (first == operands.end()) return result;
    result.node = first->node;
    result.dimension = first->dimension;
    for (const Outcome& operand : operands) {
      if (operand.dimension != 0 && operand.dimension != result.dimension) {
        warnings_.add(result.dimension == 2 ? "a solid among planar figures counts as empty"
                                            : "a planar figure among solids counts as empty",
                      position(operand.node));
      }
    }
    if (result.dimension == 2) {
      result.planar = combine<PlanarTree>(operation, operands);
    } else {
      result.solid = combine<Solid>(operation, operands);
    }
    return result;
  }

  Outcome hull_of(Outcome all) {
    if (all.dimension == 2 && !all.planar.is_empty()) {
      all.planar = figure_tree({{hull(all.planar)}});
    } else if (all.dimension == 3 && !all.solid.is_empty()) {
      all.solid = hull(all.solid);
    }
    return all;
  }

  // The union of the planar children; solids count as empty. nullopt if there is nothing at all.
  std::optional<PlanarTree> planar_children(std::span<const Outcome> operands) {
    bool anything = false;
    for (const Outcome& operand : operands) {
      anything = anything || operand.dimension != 0;
      if (operand.dimension == 3) {
        warnings_.add("a solid below a node of planar figures counts as empty",
                      position(operand.node));
      }
    }
    if (!anything) return std::nullopt;
    return combine<PlanarTree>(BooleanOperator::Union, operands);
  }

  Outcome linear(std::uint32_t node, const Placement& placement,
                 std::span<const Outcome> operands) {
    Outcome result;
    const LinearExtrudeShape shape = read_linear_extrude(tree_, node, warnings_);
    const auto outline = planar_children(operands);
    if (!outline) return result;
    result.dimension = 3;
    if (outline->is_empty() || shape.height == 0) return result;
    LinearExtrusion extrusion;
    extrusion.lower = shape.center ? Rational(-shape.height / 2) : Rational(0);
    extrusion.upper = shape.center ? Rational(shape.height / 2) : shape.height;
    extrusion.scale = shape.scale;
    const bool same_scale = shape.scale[0] == shape.scale[1];
    // A coordinate moves by at most twice as much turned, and then as the scale says.
    const Rational factor = 2 * std::max({Rational(1), shape.scale[0], shape.scale[1]});
    if (shape.twist != 0 || !same_scale || shape.scale[0] > 1) rounding_ *= factor;
    if (shape.twist != 0 || !same_scale) {
      extrusion.levels = levels(shape, *outline);
    }
    result.solid = placed(linear_extrude(*outline, extrusion, inside_rule(node)), placement);
    return result;
  }

  std::vector<LinearExtrusion::Level> levels(const LinearExtrudeShape& shape,
                                             const PlanarTree& outline) {
    const double twist = nearest_double(shape.twist);
    const PlanarFigure figure = resolve(outline);
    const std::size_t slices = shape.slices ? *shape.slices : slice_count(shape, figure);
    std::size_t vertices = 0;
    Rational largest{0};
    for (const auto& path : figure.paths) {
      vertices += path.size();
      for (const Point2& p : path)
        largest = std::max({largest, Rational(abs(p.x)), Rational(abs(p.y))});
    }
    count_vertices(vertices * (slices + 1));
    if (twist != 0) {
      rounding_ += unit_rounding_bound() * largest * 2 *
                   std::max({Rational(1), shape.scale[0], shape.scale[1]});
    }
    std::vector<LinearExtrusion::Level> result;
    result.reserve(slices);
    const Rational count(static_cast<unsigned long>(slices));
    for (std::size_t j = 1; j <= slices; ++j) {
      const double turn = -(twist * static_cast<double>(j) / static_cast<double>(slices));
      const Rational part = Rational(static_cast<unsigned long>(j)) / count;
      LinearExtrusion::Level level;
      level.cosine = rational_of(cosine_of_degrees(turn));
      level.sine = rational_of(sine_of_degrees(turn));
      level.scale = {1 - (1 - shape.scale[0]) * part, 1 - (1 - shape.scale[1]) * part};
      result.push_back(std::move(level));
    }
    return result;
  }

  static std::size_t slice_count(const LinearExtrudeShape& shape, const PlanarFigure& figure) {
    const double height = nearest_double(shape.height);
    const double twist = nearest_double(shape.twist);
    const double scale_x = nearest_double(shape.scale[0]);
    const double scale_y = nearest_double(shape.scale[1]);
    double radius_squared = 0;
    double delta_squared = 0;
    for (const auto& path : figure.paths) {
      for (const Point2& p : path) {
        const double x = nearest_double(p.x);
        const double y = nearest_double(p.y);
        const double dx = x - x * scale_x;
        const double dy = y - y * scale_y;
        radius_squared = std::max(radius_squared, x * x + y * y);
        delta_squared = std::max(delta_squared, dx * dx + dy * dy);
      }
    }
    if (twist == 0) return diagonal_slices(delta_squared, height, shape.fineness);
    if ((scale_x == 1.0 && scale_y == 1.0) || scale_x != scale_y) {
      return helix_slices(radius_squared, height, twist, shape.fineness);
    }
    return conical_helix_slices(radius_squared, height, twist, scale_x, shape.fineness);
  }

  Outcome rotate(std::uint32_t node, const Placement& placement,
                 std::span<const Outcome> operands) {
    Outcome result;
    const RotateExtrudeShape shape = read_rotate_extrude(tree_, node, warnings_);
    const auto outline = planar_children(operands);
    if (!outline || shape.angle == 0) return result;
    result.dimension = 3;
    if (outline->is_empty()) return result;
    const PlanarFigure figure = resolve(*outline);
    Rational least{0};
    Rational largest{0};
    std::size_t vertices = 0;
    for (const auto& path : figure.paths) {
      vertices += path.size();
      for (const Point2& p : path) {
        least = std::min(least, p.x);
        largest = std::max(largest, p.x);
      }
    }
    if (vertices == 0) return result;
    if (least < 0 && largest > 0) {
      throw Error(ErrorId::BadArgument, {"an outline on both sides of the axis of rotation",
                                         "x >= 0 everywhere, or x <= 0"});
    }
    const auto directions = ring_directions(shape, largest - least);
    count_vertices(vertices * directions.size());
    rounding_ += unit_rounding_bound() * (largest - least);
    result.solid = placed(rotate_extrude(*outline, directions, shape.angle == 360), placement);
    return result;
  }

  // Counter-clockwise as seen from above.
  static std::vector<std::array<Rational, 2>> ring_directions(const RotateExtrudeShape& shape,
                                                              const Rational& radius) {
    const double angle = nearest_double(shape.angle);
    const bool closed = shape.angle == 360;
    const double pieces =
        std::max(static_cast<double>(fragments(nearest_double(radius), shape.fineness)) *
                     std::abs(angle) / 360,
                 1.0);
    const auto count = static_cast<std::size_t>(pieces);
    if (std::abs(angle) / static_cast<double>(count) >= 180) {
      throw Error(ErrorId::BadArgument, {"a rotation by " + std::to_string(angle) + " degrees in " +
                                             std::to_string(count) + " pieces",
                                         "pieces of less than 180 degrees: a larger $fn"});
    }
    std::vector<std::array<Rational, 2>> directions;
    for (std::size_t j = 0; j < (closed ? count : count + 1); ++j) {
      const auto step = static_cast<double>(j);
      const auto steps = static_cast<double>(count);
      double cosine = 0;
      double sine = 0;
      if (shape.start) {
        const double a = nearest_double(*shape.start) + step * angle / steps;
        cosine = cosine_of_degrees(a);
        sine = sine_of_degrees(a);
      } else {
        // OpenSCAD 2021.01 measures its angle from the y axis.
        const double a = closed ? -90 + step * 360.0 / steps : 90 - step * angle / steps;
        cosine = sine_of_degrees(a);
        sine = cosine_of_degrees(a);
      }
      directions.push_back({rational_of(cosine), rational_of(sine)});
    }
    const bool clockwise = shape.start ? angle < 0 : closed || angle < 0;
    if (clockwise) std::reverse(directions.begin(), directions.end());
    return directions;
  }

  Solid placed(const Solid& solid, const Placement& placement) {
    primitives_ += solid.primitive_count();
    return moved(solid, placement);
  }

  // Out of a frame of its own.
  Solid moved(const Solid& solid, const Placement& placement) {
    if (placement.singular || solid.is_empty()) return Solid::empty();
    if (placement.space == AffineMap::identity()) return solid;
    rounding_ *= stretch(placement.space);
    return apply(placement.space, solid, threads_);
  }

  PlanarTree moved(const PlanarTree& tree, const Placement& placement, std::uint32_t node) {
    if (tree.is_empty() || placement.plane.m == identity_->plane.m) return tree;
    if (is_singular(placement.plane)) {
      warn_of_singular_plane(node);
      return PlanarTree::empty();
    }
    rounding_ *= stretch(placement.plane);
    return io::apply(placement.plane, tree);
  }

  void warn_of_singular_plane(std::uint32_t node) {
    warnings_.add("a matrix above is singular in the plane: the figure is empty", position(node));
  }

  Outcome offset_of(std::uint32_t node, const Placement& placement,
                    std::span<const Outcome> operands) {
    Outcome result;
    const OffsetShape shape = read_offset(tree_, node, warnings_);
    const auto outline = planar_children(operands);
    if (!outline) return result;
    result.dimension = 2;
    if (outline->is_empty()) return result;
    Offset parameters;
    parameters.distance = shape.distance;
    parameters.corner = shape.corner;
    parameters.arc_tolerance = arc_tolerance(shape);
    OffsetResult grown = offset(*outline, parameters);
    for (const auto& path : grown.figure.paths) count_vertices(path.size());
    rounding_ += grown.rounding;
    result.planar = moved(figure_tree(std::move(grown.figure)), placement, node);
    return result;
  }

  // The union of the children that are solids; planar ones count as empty.
  Solid solid_children(std::span<const Outcome> operands) {
    for (const Outcome& operand : operands) {
      if (operand.dimension == 2) {
        warnings_.add("a planar figure below a projection counts as empty", position(operand.node));
      }
    }
    return combine<Solid>(BooleanOperator::Union, operands);
  }

  Outcome projection(std::uint32_t node, const Placement& placement,
                     std::span<const Outcome> operands) {
    Outcome result;
    const bool cut = read_projection_cut(tree_, node, warnings_);
    const Solid solid = solid_children(operands);
    result.dimension = 2;
    if (solid.is_empty()) return result;
    PlanarFigure figure = resolve(cut ? section(solid) : shadow(solid));
    for (const auto& path : figure.paths) count_vertices(path.size());
    result.planar = moved(figure_tree(std::move(figure)), placement, node);
    return result;
  }

  Outcome resized(std::uint32_t node, const Placement& placement,
                  std::span<const Outcome> operands) {
    const ResizeShape shape = read_resize(tree_, node, warnings_);
    Outcome result = unite(operands);
    if (result.dimension == 2 && !result.planar.is_empty()) {
      const auto extents = extents_of(resolve(result.planar));
      if (extents.empty()) return {0, 2, {}, {}};
      const auto factors = resize_factors(shape, extents.sizes());
      const AffineMap2 map{{{{factors[0], 0, 0}, {0, factors[1], 0}}}};
      rounding_ *= stretch(map);
      result.planar = moved(io::apply(map, result.planar), placement, node);
    } else if (result.dimension == 3 && !result.solid.is_empty()) {
      const auto extents = extents_of(result.solid);
      if (extents.empty()) return {0, 3, {}, {}};
      const auto factors = resize_factors(shape, extents.sizes());
      const AffineMap map = diagonal(factors[0], factors[1], factors[2], {0, 0, 0});
      rounding_ *= stretch(map);
      result.solid =
          moved(map == AffineMap::identity() ? result.solid : apply(map, result.solid), placement);
    }
    return result;
  }

  // As OpenSCAD: what is empty is no operand, but for the first of planar ones.
  Outcome minkowski(const Placement& placement, std::span<const Outcome> operands) {
    Outcome result = boolean(BooleanOperator::Union, operands);
    Rational rounding{0};
    for (const Outcome& operand : operands) rounding += operand.rounding;
    rounding_ = std::move(rounding);
    if (result.dimension == 2) {
      result.planar = operands.front().planar;
      for (const Outcome& operand : operands.subspan(1)) {
        if (operand.planar.is_empty() || result.planar.is_empty()) continue;
        result.planar = minkowski_sum(result.planar, operand.planar);
      }
      result.planar = moved(figure_tree(resolve(result.planar)), placement, result.node);
    } else {
      result.solid = Solid::empty();
      for (const Outcome& operand : operands) {
        if (extents_of(operand.solid).empty()) continue;
        result.solid =
            result.solid.is_empty() ? operand.solid : minkowski_sum(result.solid, operand.solid);
      }
      result.solid = moved(result.solid, placement);
    }
    return result;
  }

  std::string origin(std::uint32_t node) const {
    const SourcePosition at = position(node);
    return at.file + ':' + std::to_string(at.line) + ':' + std::to_string(at.column);
  }

  // A convex shape: the image of a unit shape. nullopt: empty, since a size is zero.
  struct Shape {
    const IntegerPolyhedron* polyhedron;
    AffineMap map;
    Rational rounding{0};
    std::unique_ptr<const IntegerPolyhedron> own{};
  };

  std::optional<Shape> cube(std::uint32_t node) {
    const BoxShape shape = read_cube(tree_, node, warnings_);
    const auto& [x, y, z] = shape.size;
    if (x == 0 || y == 0 || z == 0) return std::nullopt;
    const Point3 shift = shape.center ? Point3{-x / 2, -y / 2, -z / 2} : Point3{0, 0, 0};
    return Shape{&shapes_.box(), diagonal(x, y, z, shift)};
  }

  std::optional<Shape> sphere(std::uint32_t node) {
    const SphereShape shape = read_sphere(tree_, node, warnings_);
    const Rational& r = shape.radius;
    if (r == 0) return std::nullopt;
    const std::size_t n = fragments(nearest_double(r), shape.fineness);
    return Shape{&shapes_.sphere(n), diagonal(r, r, r, {0, 0, 0}), unit_rounding_bound() * r};
  }

  std::optional<Shape> cylinder(std::uint32_t node) {
    const CylinderShape shape = read_cylinder(tree_, node, warnings_);
    const Rational& h = shape.height;
    const Rational& lower = shape.lower_radius;
    const Rational& upper = shape.upper_radius;
    if (h == 0 || (lower == 0 && upper == 0)) return std::nullopt;
    const Rational widest = std::max(lower, upper);
    const std::size_t n = fragments(nearest_double(widest), shape.fineness);
    const Rational bottom = shape.center ? Rational(-h / 2) : Rational(0);
    const Rational rounding = unit_rounding_bound() * widest;
    if (lower == upper) {
      return Shape{&shapes_.cylinder(n), diagonal(lower, lower, h, {0, 0, bottom}), rounding};
    }
    // A cone that stands on its apex is the other one upside down.
    const bool upside_down = lower == 0;
    const Rational& base = upside_down ? upper : lower;
    auto own = std::make_unique<const IntegerPolyhedron>(
        shapes_.frustum(n, upside_down ? Rational(0) : Rational(upper / lower)));
    const AffineMap map = upside_down ? diagonal(base, base, -h, {0, 0, bottom + h})
                                      : diagonal(base, base, h, {0, 0, bottom});
    const IntegerPolyhedron* const polyhedron = own.get();
    return Shape{polyhedron, map, rounding, std::move(own)};
  }

  Solid polyhedron_leaf(std::uint32_t node, const Placement& placement) {
    const FacedPoints points = read_polyhedron(tree_, node, warnings_);
    count_vertices(points.points.size());
    ++primitives_;
    if (points.points.empty() && points.faces.empty()) return Solid::empty();
    return faced(points, node, placement);
  }

  Solid faced(const FacedPoints& points, std::uint32_t node, const Placement& placement) {
    Solid solid = solid_of_polyhedron(points, inside_rule(node), origin(node));
    if (placement.singular) return Solid::empty();
    if (placement.space == AffineMap::identity()) return solid;
    return exactcsg::apply(placement.space, solid, threads_);
  }

  InsideRule inside_rule(std::uint32_t node) {
    return {fill_, [this, node](const std::string& text) { warnings_.add(text, position(node)); },
            progress_, threads_};
  }

  Solid imported(std::uint32_t node, const Placement& placement) {
    const PolygonSoup& soup = files_.mesh(read_import(tree_, node, warnings_));
    count_vertices(soup.vertices.size());
    ++primitives_;
    return faced({soup.vertices, soup.facets}, node, placement);
  }

  Solid surface(std::uint32_t node, const Placement& placement) {
    FacedPoints field = files_.height_field(read_surface(tree_, node, warnings_));
    if (field.points.empty()) {
      warnings_.add("a surface of fewer than two rows or columns is empty", position(node));
      return Solid::empty();
    }
    count_vertices(field.points.size());
    ++primitives_;
    if (placement.singular) return Solid::empty();
    Primitive primitive{make_mesh_unchecked({std::move(field.points), std::move(field.faces)}), {}};
    if (placement.space != AffineMap::identity()) {
      primitive = apply(placement.space, primitive, threads_);
    }
    primitive.origin = origin(node);
    return Solid::primitive(std::move(primitive));
  }

  static PlanarTree figure_tree(PlanarFigure figure) {
    std::erase_if(figure.paths, [](const auto& path) { return path.size() < 3; });
    if (figure.paths.empty()) return PlanarTree::empty();
    return PlanarTree::primitive(std::move(figure));
  }

  PlanarTree planar_leaf(NodeKind kind, std::uint32_t node, const Placement& placement) {
    // Only text has several.
    std::vector<PlanarFigure> figures(1);
    if (kind == NodeKind::Square) {
      figures[0] = square(node);
    } else if (kind == NodeKind::Circle) {
      figures[0] = circle(node, placement);
    } else if (kind == NodeKind::Polygon) {
      figures[0] = read_polygon(tree_, node, warnings_);
    } else {
      figures = letters(node);
    }
    std::erase_if(figures, [](const PlanarFigure& figure) { return figure.paths.empty(); });
    if (figures.empty()) return PlanarTree::empty();
    if (is_singular(placement.plane)) {
      warn_of_singular_plane(node);
      return PlanarTree::empty();
    }
    std::vector<PlanarTree> trees;
    for (PlanarFigure& figure : figures) {
      for (auto& path : figure.paths) {
        count_vertices(path.size());
        for (Point2& p : path) p = openscad::apply(placement.plane, p);
      }
      trees.push_back(figure_tree(std::move(figure)));
    }
    if (trees.size() == 1) return trees.front();
    return PlanarTree::compose(BooleanOperator::Union, std::move(trees));
  }

  std::vector<PlanarFigure> letters(std::uint32_t node) {
    const TextOutline outline = texts_.outline(read_text(tree_, node, warnings_));
    for (const std::string& remark : outline.remarks) warnings_.add(remark, position(node));
    std::vector<PlanarFigure> figures;
    for (const LetterPaths& letter : outline.letters) {
      if (progress_ != nullptr) progress_->check();
      std::vector<std::vector<Point2>> paths;
      for (const auto& path : letter) {
        auto& exact = paths.emplace_back();
        for (const auto& [x, y] : path) exact.push_back({rational_of(x), rational_of(y)});
      }
      figures.push_back(resolve_winding(paths));
    }
    return figures;
  }

  PlanarFigure square(std::uint32_t node) {
    const SquareShape shape = read_square(tree_, node, warnings_);
    const auto& [x, y] = shape.size;
    if (x == 0 || y == 0) return {};
    const Rational x0 = shape.center ? Rational(-x / 2) : Rational(0);
    const Rational y0 = shape.center ? Rational(-y / 2) : Rational(0);
    return {{{{x0, y0}, {x0 + x, y0}, {x0 + x, y0 + y}, {x0, y0 + y}}}};
  }

  PlanarFigure circle(std::uint32_t node, const Placement& placement) {
    const CircleShape shape = read_circle(tree_, node, warnings_);
    const Rational& r = shape.radius;
    if (r == 0) return {};
    add_rounding(unit_rounding_bound() * r * stretch(placement.plane));
    PlanarFigure figure;
    auto& path = figure.paths.emplace_back();
    for (const Direction& d : circle_directions(fragments(nearest_double(r), shape.fineness))) {
      path.push_back({r * rational_of(d[0]), r * rational_of(d[1])});
    }
    return figure;
  }

  void add_rounding(const Rational& bound) {
    if (bound > rounding_) rounding_ = bound;
  }

  void count_vertices(std::size_t count) {
    if (count > model_vertex_limit - vertices_) {
      throw Error(
          ErrorId::TooLarge,
          {"more than " + std::to_string(model_vertex_limit) + " vertices of primitives", ""});
    }
    vertices_ += count;
  }

  const SyntaxTree& tree_;
  Warnings& warnings_;
  const Context identity_ = std::make_shared<const Placement>();
  NamedFiles files_;
  std::optional<FillRule> fill_;
  Progress* progress_;
  unsigned threads_;
  ShapeCache shapes_;
  TextOutlines texts_;
  std::size_t primitives_ = 0;
  std::size_t vertices_ = 0;
  Rational rounding_{0};  // of the node at work
};

}  // namespace

Model evaluate_as_written(const SyntaxTree& tree, const ReadOptions& options) {
  Warnings warnings;
  ExactBuilder builder(tree, warnings, options);
  NodeWalk<ExactBuilder> walk(tree, builder, warnings, options.progress);
  Model model = builder.finish(walk.run());
  model.warnings = std::move(warnings).take();
  return model;
}

}  // namespace exactcsg::io::openscad
