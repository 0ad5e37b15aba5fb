// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The workloads of the comparison of boundary evaluators, as trees of OpenSCAD's shapes: the same
// model can be had as a Solid (library calls) and as .csg text. Nothing depends on the machine or
// the standard library: random numbers are taken from the engine's bits, and every number of a
// model is a finite decimal, so that the text means exactly the same solid.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "exactcsg/csg/tree.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/io/openscad/tessellation.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"
#include "exactcsg/solid/solid.hpp"

namespace exactcsg::bench {

// A leaf as OpenSCAD writes it.
struct Shape {
  enum class Kind : unsigned char { Box, Sphere, Cylinder, Capsule, Mesh };
  Kind kind = Kind::Box;
  // Box: sides from the origin. Sphere: radius. Cylinder: radius, height. Capsule (the hull of two
  // spheres): radius, distance of the centres along z.
  std::array<Rational, 3> sizes{1, 1, 1};
  std::size_t fragments = 0;  // $fn
  std::shared_ptr<const Polyhedron> mesh{};
  AffineMap map = AffineMap::identity();
};

using Model = csg::BooleanTree<Shape>;

// What the result must be, where a closed form says so.
struct Expectation {
  std::optional<Rational> volume{};
  std::optional<Rational> area{};
  std::optional<std::array<std::uint64_t, 3>> counts{};  // vertices, edges, faces
  std::optional<std::int64_t> genus{};
};

struct Workload {
  Model model;
  Expectation expected;
};

// ---- numbers ----------------------------------------------------------------------------------

inline Integer power_of_ten(unsigned exponent) {
  Integer result;
  mpz_ui_pow_ui(result.get_mpz_t(), 10, exponent);
  return result;
}

// The nearest number with so many decimals.
inline Rational rounded(const Rational& value, unsigned decimals) {
  const Integer scale = power_of_ten(decimals);
  const Rational scaled = value * scale + Rational(1, 2);
  Integer floor;
  mpz_fdiv_q(floor.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  Rational result(floor, scale);
  result.canonicalize();
  return result;
}
inline Rational rounded(double value, unsigned decimals) {
  return rounded(rational_of(value), decimals);
}

// All digits. REQUIRES a denominator of powers of 2 and 5.
inline std::string decimal_text(const Rational& value) {
  const auto twos = mpz_scan1(value.get_den_mpz_t(), 0);
  Integer odd = value.get_den() >> twos;
  unsigned long fives = 0;
  for (; odd != 1; ++fives) {
    if (odd % 5 != 0) throw std::logic_error("no finite decimal");
    odd /= 5;
  }
  const auto decimals = static_cast<unsigned>(std::max<unsigned long>(twos, fives));
  const Rational scaled = value * power_of_ten(decimals);
  std::string digits = Integer(abs(scaled.get_num())).get_str();
  if (digits.size() <= decimals) digits.insert(0, decimals + 1 - digits.size(), '0');
  if (decimals > 0) digits.insert(digits.size() - decimals, 1, '.');
  return value < 0 ? "-" + digits : digits;
}

// Uniform in [0, 1), the same on every machine.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return std::ldexp(static_cast<double>(engine_() >> 11U), -53); }
  std::size_t below(std::size_t n) {
    return static_cast<std::size_t>((*this)() * static_cast<double>(n));
  }

 private:
  std::mt19937_64 engine_;
};

// ---- maps -------------------------------------------------------------------------------------

inline AffineMap translation(const Rational& x, const Rational& y, const Rational& z) {
  AffineMap map = AffineMap::identity();
  map.m[0][3] = x;
  map.m[1][3] = y;
  map.m[2][3] = z;
  return map;
}

inline AffineMap scaling(const Rational& x, const Rational& y, const Rational& z) {
  AffineMap map = AffineMap::identity();
  map.m[0][0] = x;
  map.m[1][1] = y;
  map.m[2][2] = z;
  return map;
}

inline AffineMap turned_about_z(const Rational& cosine, const Rational& sine) {
  AffineMap map = AffineMap::identity();
  map.m[0] = {cosine, -sine, 0, 0};
  map.m[1] = {sine, cosine, 0, 0};
  return map;
}

// By an angle about a unit vector, rounded to six decimals as OpenSCAD prints it (Rodrigues).
inline AffineMap turned(const std::array<double, 3>& axis, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto& [x, y, z] = axis;
  const std::array<std::array<double, 3>, 3> cross{{{0, -z, y}, {z, 0, -x}, {-y, x, 0}}};
  AffineMap map = AffineMap::identity();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double diagonal = i == j ? c : 0;
      map.m[i][j] = rounded(diagonal + s * cross[i][j] + (1 - c) * axis[i] * axis[j], 6);
    }
  }
  return map;
}

// ---- shapes -----------------------------------------------------------------------------------

inline Model leaf(Shape shape) { return Model::primitive(std::move(shape)); }

inline Model box(const Rational& x, const Rational& y, const Rational& z, const AffineMap& map) {
  return leaf({Shape::Kind::Box, {x, y, z}, 0, {}, map});
}

inline Model united(std::vector<Model> parts) {
  return Model::compose(csg::BooleanOperator::Union, std::move(parts));
}

inline Model subtracted(Model body, std::vector<Model> tools) {
  tools.insert(tools.begin(), std::move(body));
  return Model::compose(csg::BooleanOperator::Difference, std::move(tools));
}

// OpenSCAD's sphere of radius 1 as triangles, rounded to multiples of 2^-36: $fn^2 triangles,
// about.
inline std::shared_ptr<const Polyhedron> sphere_of_triangles(std::size_t fragments) {
  io::openscad::ShapeCache cache;
  const io::openscad::IntegerPolyhedron& sphere = cache.sphere(fragments);
  Polyhedron result;
  result.vertices.reserve(sphere.vertices.size());
  const auto on_grid = [&](const Integer& numerator) {
    Rational value(numerator, sphere.denominator);
    value.canonicalize();
    return rational_of(std::ldexp(std::round(std::ldexp(nearest_double(value), 36)), -36));
  };
  for (const auto& v : sphere.vertices) {
    result.vertices.push_back({on_grid(v[0]), on_grid(v[1]), on_grid(v[2])});
  }
  for (const auto facet : sphere.facets.facets()) {
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      result.facets.push_back({facet[0], facet[i], facet[i + 1]});
    }
  }
  return std::make_shared<const Polyhedron>(std::move(result));
}

// ---- workloads --------------------------------------------------------------------------------

// 1. Each sphere meets about three others: a sphere of radius 2 round each centre holds three.
inline Workload spheres(std::size_t count) {
  RandomNumbers random(20251122);
  const double side = std::cbrt(static_cast<double>(count) * 4 / 3 * std::numbers::pi * 8.0 / 3.0);
  std::vector<Model> parts;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<Rational, 3> centre;
    for (Rational& coordinate : centre) coordinate = rounded(side * random(), 6);
    parts.push_back(leaf(
        {Shape::Kind::Sphere, {1, 1, 1}, 32, {}, translation(centre[0], centre[1], centre[2])}));
  }
  return {united(std::move(parts)), {}};
}

// 2. The sponge with side 3^level, less its square holes, each level's that lie in no hole of a
// level before. 20^level unit cubes remain, with 2 20^n + 4 8^n faces in sight. The genus obeys a
// linear recurrence with the roots 1, 8 and 20 (shares of the whole, of a face and of the volume).
inline Workload menger(std::size_t level) {
  long side = 1;
  for (std::size_t i = 0; i < level; ++i) side *= 3;
  const auto hole = [&](long x, long y, long width, std::vector<Model>& holes) {
    holes.push_back(box(width, width, side, translation(x, y, 0)));
    holes.push_back(box(width, side, width, translation(x, 0, y)));
    holes.push_back(box(side, width, width, translation(0, x, y)));
  };
  std::vector<Model> holes;
  std::vector<std::array<long, 2>> squares{{0, 0}};
  for (long width = side / 3; width > 0; width /= 3) {
    std::vector<std::array<long, 2>> smaller;
    for (const auto& [x, y] : squares) {
      for (long i = 0; i < 9; ++i) {
        const long at_x = x + i % 3 * width;
        const long at_y = y + i / 3 * width;
        if (i == 4) {
          hole(at_x, at_y, width, holes);
        } else {
          smaller.push_back({at_x, at_y});
        }
      }
    }
    squares = std::move(smaller);
  }
  const auto n = static_cast<unsigned long>(level);
  Integer twenty;
  Integer eight;
  mpz_ui_pow_ui(twenty.get_mpz_t(), 20, n);
  mpz_ui_pow_ui(eight.get_mpz_t(), 8, n);
  const Integer genus = (38 * eight + 21 * twenty - 59) / 133;
  return {subtracted(box(side, side, side, AffineMap::identity()), std::move(holes)),
          {Rational(twenty), Rational(2 * twenty + 4 * eight), {}, genus.get_si()}};
}

// 3. A block less count x count cylinders, plus a block turned by 0.3, less turned cubes.
inline Workload drilled_block(std::size_t count) {
  RandomNumbers random(3);
  const auto n = static_cast<long>(count);
  std::vector<Model> cylinders;
  for (long i = 0; i < n * n; ++i) {
    cylinders.push_back(leaf({Shape::Kind::Cylinder,
                              {3, 22, 1},
                              32,
                              {},
                              translation(10 * (i % n) + 10, 10 * (i / n) + 10, -1)}));
  }
  const long side = 10 * (n + 1);
  Model plate = subtracted(box(side, side, 20, AffineMap::identity()), std::move(cylinders));
  const Rational half = rounded(static_cast<double>(side) / 2, 1);
  const AffineMap about_middle =
      translation(half, half, 5) * turned({0, 0, 1}, 0.3) * translation(-half / 2, -half / 4, 0);
  Model body = united({std::move(plate), box(half, half / 2, 20, about_middle)});
  std::vector<Model> cubes;
  const long cubes_in_row = std::max(1L, n / 3);
  for (long i = 0; i < cubes_in_row * cubes_in_row; ++i) {
    std::array<double, 3> axis{};
    double length = 0;
    for (double& component : axis) {
      component = random() + 0.1;
      length += component * component;
    }
    for (double& component : axis) component /= std::sqrt(length);
    const double pitch = static_cast<double>(side) / static_cast<double>(cubes_in_row);
    const auto along = [&](long at) {
      return rounded((static_cast<double>(at) + 0.3 + 0.4 * random()) * pitch, 3);
    };
    const Rational x = along(i % cubes_in_row);
    const Rational y = along(i / cubes_in_row);
    cubes.push_back(box(12, 12, 12,
                        translation(x, y, rounded(20 * random(), 3)) * turned(axis, 3 * random()) *
                            translation(-6, -6, -6)));
  }
  return {subtracted(std::move(body), std::move(cubes)), {}};
}

// 3. A block less capsules that lie along the meridians of a dome, on a spiral of equal areas; each
// meets its neighbours, the topmost and the lowest ones the block's faces.
inline Workload capsules_along_dome(std::size_t count) {
  const double number = static_cast<double>(count);
  const double radius = std::sqrt(number * 0.4);  // 2.5 units of the dome's area for a capsule
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const Rational half = rounded(1.1 * radius + 2, 3);
  std::vector<Model> capsules;
  for (std::size_t i = 0; i < count; ++i) {
    const double height = (static_cast<double>(i) + 0.5) / number;  // of the unit dome
    const double wide = std::sqrt(1 - height * height);
    const double longitude = golden * static_cast<double>(i);
    // z is turned to the meridian's direction: about the horizontal tangent, by the latitude.
    const std::array<double, 3> tangent{-std::sin(longitude), std::cos(longitude), 0};
    const AffineMap place =
        translation(rounded(radius * wide * std::cos(longitude), 6),
                    rounded(radius * wide * std::sin(longitude), 6), rounded(radius * height, 6));
    capsules.push_back(leaf({Shape::Kind::Capsule,
                             {Rational(1, 2), 2, 1},
                             16,
                             {},
                             place * turned(tangent, -std::asin(height))}));
  }
  const Rational top = rounded(radius - 0.25, 3);
  return {
      subtracted(box(2 * half, 2 * half, top, translation(-half, -half, 0)), std::move(capsules)),
      {}};
}

// 4. A sphere less the same sphere half a radius further on, as meshes.
inline Workload meshes(std::size_t fragments) {
  const auto sphere = sphere_of_triangles(fragments);
  const auto placed = [&](const AffineMap& map) {
    return leaf({Shape::Kind::Mesh, {1, 1, 1}, fragments, sphere, map});
  };
  return {subtracted(placed(AffineMap::identity()), {placed(translation(Rational(1, 2), 0, 0))}),
          {}};
}

// 5. Two unit cubes about the origin, one turned about z by 10^-exponent: cosine and sine to forty
// decimals. Each corner of one square reaches over a side of the other by h = (c + s - 1) / 2, as
// a right triangle over that side of the area h^2 r^2 / (2 s c), r^2 = c^2 + s^2.
inline Workload turned_cubes(std::size_t exponent) {
  const Rational angle(1, power_of_ten(static_cast<unsigned>(exponent)));
  Rational cosine = 0;
  Rational sine = 0;
  Rational term = 1;
  for (int i = 0; i < 16; ++i) {
    Rational& sum = i % 2 == 0 ? cosine : sine;
    sum += i % 4 < 2 ? term : Rational(-term);
    term *= angle / (i + 1);
  }
  cosine = rounded(cosine, 40);
  sine = rounded(sine, 40);
  const AffineMap centred = translation(Rational(-1, 2), Rational(-1, 2), Rational(-1, 2));
  const Rational reach = cosine + sine - 1;
  const Rational over = (cosine * cosine + sine * sine) * reach * reach / (2 * sine * cosine);
  return {united({box(1, 1, 1, centred), box(1, 1, 1, turned_about_z(cosine, sine) * centred)}),
          {Rational(1 + over), {}, std::array<std::uint64_t, 3>{32, 48, 18}, 0}};
}

// 6. The places of the unit cubes of a grid of side n in a random order: they are united one at a
// time and then subtracted one at a time in another random order.
struct CubeSequence {
  std::vector<std::array<int, 3>> united;
  std::vector<std::array<int, 3>> subtracted;
};

// x fastest, then y: both times in the same order.
inline CubeSequence cubes_in_grid_order(std::size_t side) {
  std::vector<std::array<int, 3>> places;
  const auto n = static_cast<int>(side);
  for (int i = 0; i < n * n * n; ++i) places.push_back({i % n, i / n % n, i / n / n});
  return {places, places};
}

inline CubeSequence shuffled_cubes(std::size_t side) {
  RandomNumbers random(6);
  const auto shuffled = [&] {
    std::vector<std::array<int, 3>> places = cubes_in_grid_order(side).united;
    for (std::size_t i = places.size(); i > 1; --i)
      std::swap(places[i - 1], places[random.below(i)]);
    return places;
  };
  CubeSequence sequence;
  sequence.united = shuffled();
  sequence.subtracted = shuffled();
  return sequence;
}

// THROWS std::invalid_argument
inline CubeSequence cube_sequence(const std::string& name, std::size_t side) {
  if (name == "cube_sequence") return cubes_in_grid_order(side);
  if (name == "shuffled_cubes") return shuffled_cubes(side);
  throw std::invalid_argument("no sequence \"" + name + "\"");
}
inline bool is_cube_sequence(const std::string& name) {
  return name == "cube_sequence" || name == "shuffled_cubes";
}

inline Model cube_at(const std::array<int, 3>& place) {
  return box(1, 1, 1, translation(place[0], place[1], place[2]));
}

// All operations as one tree, to be worked off in order.
inline Workload cubes_in_order(const CubeSequence& sequence) {
  std::vector<Model> operands;
  for (const auto& place : sequence.united) operands.push_back(cube_at(place));
  std::vector<Model> tools;
  for (const auto& place : sequence.subtracted) tools.push_back(cube_at(place));
  return {subtracted(united(std::move(operands)), std::move(tools)),
          {Rational(0), Rational(0), std::array<std::uint64_t, 3>{0, 0, 0}, 0}};
}

inline Workload cube_sequence(std::size_t side) {
  return cubes_in_order(cubes_in_grid_order(side));
}
inline Workload cube_sequence_shuffled(std::size_t side) {
  return cubes_in_order(shuffled_cubes(side));
}

// Volume and area after each of the operations, counted on the grid: cubes, and faces in sight.
struct GridFigures {
  long volume = 0;
  long area = 0;
};

inline std::vector<GridFigures> expected_figures(const CubeSequence& sequence, std::size_t side) {
  const auto n = static_cast<int>(side);
  std::vector<bool> filled(side * side * side, false);
  const auto index = [n](int x, int y, int z) {
    return static_cast<std::size_t>((z * n + y) * n + x);
  };
  const auto neighbours = [&](const std::array<int, 3>& place) {
    long count = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        auto at = place;
        at[axis] += step;
        if (at[axis] >= 0 && at[axis] < n && filled[index(at[0], at[1], at[2])]) ++count;
      }
    }
    return count;
  };
  std::vector<GridFigures> figures;
  GridFigures now;
  const auto step = [&](const std::array<int, 3>& place, int sign) {
    filled[index(place[0], place[1], place[2])] = sign > 0;
    now.volume += sign;
    now.area += sign * (6 - 2 * neighbours(place));
    figures.push_back(now);
  };
  for (const auto& place : sequence.united) step(place, 1);
  for (const auto& place : sequence.subtracted) step(place, -1);
  return figures;
}

struct NamedGenerator {
  const char* name;
  Workload (*make)(std::size_t size);
};

inline constexpr std::array<NamedGenerator, 8> generators{
    {{"spheres", spheres},
     {"menger", menger},
     {"drilled_block", drilled_block},
     {"capsules", capsules_along_dome},
     {"meshes", meshes},
     {"turned_cubes", turned_cubes},
     {"cube_sequence", cube_sequence},
     {"shuffled_cubes", cube_sequence_shuffled}}};

// THROWS std::invalid_argument
inline Workload make_workload(const std::string& name, std::size_t size) {
  for (const NamedGenerator& generator : generators) {
    if (generator.name == name) return generator.make(size);
  }
  throw std::invalid_argument("no workload \"" + name + "\"");
}

// ---- as a solid -------------------------------------------------------------------------------

// Makes primitives of shapes, like shapes of one polyhedron.
class PrimitiveMaker {
 public:
  // threads: as in EvaluateOptions
  explicit PrimitiveMaker(unsigned threads = 1) : threads_(threads) {}

  Primitive operator()(const Shape& shape) {
    const auto& [a, b, c] = shape.sizes;
    switch (shape.kind) {
      case Shape::Kind::Box:
        return polytope(cache_.box(), shape.map * scaling(a, b, c));
      case Shape::Kind::Sphere:
        return polytope(cache_.sphere(shape.fragments), shape.map * scaling(a, a, a));
      case Shape::Kind::Cylinder:
        return polytope(cache_.cylinder(shape.fragments), shape.map * scaling(a, a, b));
      case Shape::Kind::Capsule:
        return polytope(capsule(shape), shape.map);
      case Shape::Kind::Mesh:
        return apply(shape.map, Primitive{mesh(shape.mesh)}, threads_);
    }
    throw std::logic_error("a shape of no kind");
  }

 private:
  static Primitive polytope(const io::openscad::IntegerPolyhedron& unit, const AffineMap& map) {
    return {io::openscad::place_polytope(map, unit)};
  }

  // The hull of a sphere and its image above: the sphere with its upper rings moved up. Its middle
  // rings have the same radius, since there is an even number of rings.
  const io::openscad::IntegerPolyhedron& capsule(const Shape& shape) {
    const auto key = std::tuple(shape.sizes[0], shape.sizes[1], shape.fragments);
    const auto found = capsules_.find(key);
    if (found != capsules_.end()) return found->second;
    const AffineMap scaled = scaling(shape.sizes[0], shape.sizes[0], shape.sizes[0]);
    Polyhedron hull = io::openscad::place(scaled, cache_.sphere(shape.fragments));
    for (Point3& vertex : hull.vertices) {
      if (vertex.z > 0) vertex.z += shape.sizes[1];
    }
    return capsules_.emplace(key, io::openscad::with_common_denominator(hull)).first->second;
  }

  const PolyhedralMesh& mesh(const std::shared_ptr<const Polyhedron>& polyhedron) {
    const auto found = meshes_.find(polyhedron.get());
    if (found != meshes_.end()) return found->second;
    return meshes_.emplace(polyhedron.get(), make_mesh(*polyhedron, threads_)).first->second;
  }

  unsigned threads_;
  io::openscad::ShapeCache cache_;
  std::map<std::tuple<Rational, Rational, std::size_t>, io::openscad::IntegerPolyhedron> capsules_;
  std::map<const Polyhedron*, PolyhedralMesh> meshes_;
};

inline Solid solid_of(const Model& model, unsigned threads = 1) {
  return csg::map(model, PrimitiveMaker(threads));
}

// ---- as text ----------------------------------------------------------------------------------

inline void write_shape(std::string& out, const Shape& shape) {
  const auto number = [](const Rational& value) { return decimal_text(value); };
  out += "multmatrix([";
  for (const auto& row : shape.map.m) {
    out += fmt::format("[{}, {}, {}, {}], ", number(row[0]), number(row[1]), number(row[2]),
                       number(row[3]));
  }
  out += "[0, 0, 0, 1]]) { ";
  const Rational& a = shape.sizes[0];
  const Rational& b = shape.sizes[1];
  const Rational& c = shape.sizes[2];
  const auto sphere = [&] {
    return fmt::format("sphere($fn = {}, $fa = 12, $fs = 2, r = {});", shape.fragments, number(a));
  };
  switch (shape.kind) {
    case Shape::Kind::Box:
      out += fmt::format("cube(size = [{}, {}, {}], center = false); }}\n", number(a), number(b),
                         number(c));
      return;
    case Shape::Kind::Sphere:
      out += sphere() + " }\n";
      return;
    case Shape::Kind::Cylinder:
      out += fmt::format(
          "cylinder($fn = {}, $fa = 12, $fs = 2, h = {}, r1 = {}, r2 = {}, center = false); }}\n",
          shape.fragments, number(b), number(a), number(a));
      return;
    case Shape::Kind::Capsule:
      out += fmt::format(
          "hull() {{ {} multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, {}], [0, 0, 0, 1]]) {{ "
          "{} }} "
          "}} }}\n",
          sphere(), number(b), sphere());
      return;
    case Shape::Kind::Mesh:
      break;
  }
  out += "polyhedron(points = [";
  const char* separator = "";
  for (const Point3& p : shape.mesh->vertices) {
    out += fmt::format("{}[{}, {}, {}]", std::exchange(separator, ", "), number(p.x), number(p.y),
                       number(p.z));
  }
  out += "], faces = [";
  separator = "";
  for (const Facet& f : shape.mesh->facets) {
    // OpenSCAD's faces are clockwise seen from outside.
    out += fmt::format("{}[{}, {}, {}]", std::exchange(separator, ", "), f[2], f[1], f[0]);
  }
  out += "], convexity = 2); }\n";
}

inline std::string csg_of(const Model& model) {
  using Cursor = Model::Cursor;
  std::string out;
  csg::walk(
      model.root(),
      [&](Cursor node) {
        switch (node.operation()) {
          case csg::BooleanOperator::Union:
            out += "union() {\n";
            return true;
          case csg::BooleanOperator::Intersection:
            out += "intersection() {\n";
            return true;
          case csg::BooleanOperator::Difference:
            out += "difference() {\n";
            return true;
          case csg::BooleanOperator::SymmetricDifference:
            break;
        }
        throw std::invalid_argument("OpenSCAD has no symmetric difference");
      },
      [&](Cursor node) {
        if (node.kind() == csg::NodeKind::Full) throw std::invalid_argument("no Full in OpenSCAD");
        if (node.kind() == csg::NodeKind::Primitive) write_shape(out, node.primitive());
      },
      [&](Cursor) { out += "}\n"; });
  return out;
}

}  // namespace exactcsg::bench
