// SPDX-License-Identifier: GPL-3.0-or-later
// A harness that can fail: every row plants one fault, and the verification must notice it and name
// the place. Faults are planted in the boundary that our evaluator would hand on, in the tree that
// the oracles read, in mesh files of every format, in golden files and in OpenSCAD's .nef3. The
// controls show that without the fault everything passes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/verify/golden.hpp"
#include "exactcsg/verify/mesh_comparison.hpp"
#include "exactcsg/verify/nef.hpp"
#include "exactcsg/verify/openscad.hpp"
#include "exactcsg/verify/process.hpp"
#include "exactcsg/verify/verify.hpp"
#include "samples.hpp"

namespace exactcsg::verify {
namespace {

using samples::box;
using samples::complaints;
using samples::plate;
using samples::plate_boundary;
using samples::soup_of;

struct Fault {
  std::string name;
  std::function<std::vector<Check>()> run;
  std::vector<std::string> places;  // every one of them is named by some failed check
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

// ---- faults in our boundary: what a broken evaluator would hand on
// -----------------------------------

std::vector<Check> verify_with(const Solid& solid, const Boundary& boundary) {
  VerifyOptions options;
  options.disabled = {"openscad", "laws"};
  options.sample_points = 60;
  return verify_boundary(samples::model_of(solid), boundary, options).checks;
}

std::uint32_t vertex_at(const Boundary& b, const Point3& p) {
  const std::vector<Point3> vertices = to_vector(b.vertices);
  const auto found = std::find(vertices.begin(), vertices.end(), p);
  EXPECT_NE(found, vertices.end());
  return static_cast<std::uint32_t>(found - vertices.begin());
}

std::size_t face_on(const Boundary& b, const Plane& plane) {
  for (std::size_t f = 0; f < b.faces.size(); ++f) {
    if (exact_plane(b, b.faces[f]) == plane) return f;
  }
  ADD_FAILURE() << "no face on that plane";
  return 0;
}

// The bottom z = 0, outward normal down; it has the hole as its second loop.
const Plane bottom{0, 0, -1, 0};
// The side x = 4.
const Plane right{1, 0, 0, -4};

void turn(std::vector<std::uint32_t>& loop) { std::reverse(loop.begin() + 1, loop.end()); }

Fault in_boundary(std::string name, std::function<void(Boundary&)> mutate,
                  std::vector<std::string> places) {
  return {std::move(name),
          [mutate = std::move(mutate)] {
            Boundary boundary = plate_boundary();
            mutate(boundary);
            return verify_with(plate(), boundary);
          },
          std::move(places)};
}

void move_vertex(Boundary& b, const Point3& from, const Point3& to) {
  const std::uint32_t v = vertex_at(b, from);
  std::vector<Point3> vertices = to_vector(b.vertices);
  vertices[v] = to;
  b.vertices = ExactPoints(vertices);
  b.approximate[v] = {nearest_double(to.x), nearest_double(to.y), nearest_double(to.z)};
}

// Puts a vertex into the middle of the edge and of the loops that use it, keeping the boundary's
// order.
void split_edge(Boundary& b, const Point3& from, const Point3& to) {
  const std::uint32_t u = vertex_at(b, from);
  const std::uint32_t v = vertex_at(b, to);
  const Point3 middle{(from.x + to.x) / 2, (from.y + to.y) / 2, (from.z + to.z) / 2};
  std::vector<Point3> vertices = to_vector(b.vertices);
  const auto place = std::upper_bound(vertices.begin(), vertices.end(), middle);
  const auto m = static_cast<std::uint32_t>(place - vertices.begin());
  const auto shifted = [&](std::uint32_t i) { return i >= m ? i + 1 : i; };
  vertices.insert(place, middle);
  b.vertices = ExactPoints(vertices);
  b.approximate.insert(
      b.approximate.begin() + m,
      {nearest_double(middle.x), nearest_double(middle.y), nearest_double(middle.z)});
  for (BoundaryEdge& edge : b.edges) edge = {shifted(edge.from), shifted(edge.to)};
  const std::uint32_t s = shifted(u);
  const std::uint32_t t = shifted(v);
  std::erase(b.edges, BoundaryEdge{std::min(s, t), std::max(s, t)});
  b.edges.push_back({std::min(s, m), std::max(s, m)});
  b.edges.push_back({std::min(t, m), std::max(t, m)});
  std::sort(b.edges.begin(), b.edges.end());
  for (BoundaryFace& face : b.faces) {
    for (auto& loop : face.loops) {
      std::vector<std::uint32_t> longer;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t a = shifted(loop[i]);
        const std::uint32_t c = shifted(loop[(i + 1) % loop.size()]);
        longer.push_back(a);
        if ((a == s && c == t) || (a == t && c == s)) longer.push_back(m);
      }
      std::rotate(longer.begin(), std::min_element(longer.begin(), longer.end()), longer.end());
      loop = std::move(longer);
    }
  }
}

std::vector<Fault> boundary_faults() {
  const Rational tiny(1, 1'000'000'000);
  return {
      in_boundary("face_flipped", [](Boundary& b) { turn(b.faces[face_on(b, right)].loops[0]); },
                  {"[4, 0, 0]"}),
      in_boundary("face_dropped",
                  [](Boundary& b) {
                    b.faces.erase(b.faces.begin() + static_cast<std::ptrdiff_t>(face_on(b, right)));
                  },
                  {"(4, 0, 0)", "face plane only in the oracle's: 1 x + 0 y + 0 z + -4"}),
      in_boundary("face_duplicated",
                  [](Boundary& b) { b.faces.push_back(b.faces[face_on(b, right)]); },
                  {"(4, 0, 0)"}),
      in_boundary("hole_loop_dropped",
                  [](Boundary& b) { b.faces[face_on(b, bottom)].loops.pop_back(); },
                  {"(1, 1, 0) - (1, 2, 0)"}),
      in_boundary("hole_loop_turned",
                  [](Boundary& b) { turn(b.faces[face_on(b, bottom)].loops[1]); },
                  {"(1, 1, 0) - (1, 2, 0)"}),
      in_boundary("plane_sign_wrong",
                  [](Boundary& b) {
                    for (auto& loop : b.faces[face_on(b, bottom)].loops) turn(loop);
                  },
                  {"face plane only in ours: 0 x + 0 y + 1 z + 0",
                   "walked 2 times forward and 0 times backward: (0, 0, 0) - (4, 0, 0)"}),
      in_boundary("plane_numbers_exchanged",
                  [](Boundary& b) {
                    std::swap(b.faces[face_on(b, right)].plane, b.faces[face_on(b, bottom)].plane);
                  },
                  {"not numbered by its first face"}),
      in_boundary("plane_number_out_of_range",
                  [](Boundary& b) { b.faces[face_on(b, right)].plane = b.plane_count; },
                  {"names plane"}),
      in_boundary("plane_of_no_face", [](Boundary& b) { ++b.plane_count; }, {"of no face"}),
      in_boundary(
          "face_on_another_plane",
          [](Boundary& b) { b.faces[face_on(b, right)].plane = b.faces[face_on(b, bottom)].plane; },
          {"(4, 0, 2) is not in the plane"}),
      in_boundary("vertex_moved_by_1e-9",
                  [tiny](Boundary& b) {
                    move_vertex(b, {4, 0, 0}, {4, 0, tiny});
                  },
                  {"vertex only in the oracle's: (4, 0, 0)"}),
      in_boundary(
          "vertex_moved_by_2^-200",
          [](Boundary& b) {
            move_vertex(b, {4, 0, 0}, {4 + Rational(1) / Rational(Integer(1) << 200), 0, 0});
          },
          {"vertex only in the oracle's: (4, 0, 0)"}),
      in_boundary("edge_dropped",
                  [](Boundary& b) {
                    const std::uint32_t u = vertex_at(b, {4, 0, 0});
                    std::erase_if(b.edges, [&](BoundaryEdge e) { return e.to == u; });
                  },
                  {"edge only in the oracle's: (0, 0, 0) - (4, 0, 0)"}),
      in_boundary("edge_invented",
                  [](Boundary& b) {
                    b.edges.push_back({vertex_at(b, {0, 0, 0}), vertex_at(b, {4, 3, 0})});
                    std::sort(b.edges.begin(), b.edges.end());
                  },
                  {"edge of no face: (0, 0, 0) - (4, 3, 0)", "edge only in ours"}),
      in_boundary("edge_split",
                  [](Boundary& b) {
                    split_edge(b, {0, 0, 0}, {4, 0, 0});
                  },
                  {"fewer than two directions meet: (2, 0, 0)", "vertex only in ours: (2, 0, 0)"}),
      in_boundary("vertices_exchanged",
                  [](Boundary& b) {
                    std::vector<Point3> vertices = to_vector(b.vertices);
                    std::swap(vertices[3], vertices[4]);
                    b.vertices = ExactPoints(vertices);
                  },
                  {"not sorted"}),
      in_boundary("vertex_used_wrongly",
                  [](Boundary& b) {
                    b.faces[face_on(b, right)].loops[0][1] = vertex_at(b, {0, 0, 0});
                  },
                  {"a side of a face is no edge of the boundary: (0, 0, 0) - (4, 3, 1)"}),
      in_boundary("index_out_of_range", [](Boundary& b) { b.faces[0].loops[0][0] = 1'000'000; },
                  {"names vertex 1000000"}),
      in_boundary("double_position_wrong",
                  [](Boundary& b) {
                    const std::uint32_t v = vertex_at(b, {4, 0, 0});
                    b.approximate[v][0] = std::nextafter(4.0, 5.0);
                  },
                  {"not the nearest: (4, 0, 0)"}),
      in_boundary("loop_rotated",
                  [](Boundary& b) {
                    auto& loop = b.faces[face_on(b, right)].loops[0];
                    std::rotate(loop.begin(), loop.begin() + 1, loop.end());
                  },
                  {"does not start at its smallest vertex"}),
      in_boundary("everything_inside_out",
                  [](Boundary& b) {
                    for (BoundaryFace& face : b.faces) {
                      for (auto& loop : face.loops) turn(loop);
                    }
                  },
                  {"boundary is inside out"}),
      in_boundary("everything_lost", [](Boundary& b) { b = Boundary{}; },
                  {"vertex only in the oracle's: (0, 0, 0)"}),
  };
}

// ---- faults of evaluation: a right boundary of a wrong tree
// ------------------------------------------

Fault evaluated_from(std::string name, std::function<Solid()> wrong,
                     std::vector<std::string> places) {
  return {std::move(name),
          [wrong = std::move(wrong)] { return verify_with(plate(), evaluate(wrong())); },
          std::move(places)};
}

Solid without_notch() {
  return samples::unite({samples::subtract({box({0, 0, 0}, {4, 3, 2}), box({1, 1, -1}, {2, 2, 3})}),
                         samples::pyramid(1, 3)});
}

// Two flush boxes whose common wall was kept, as an evaluator does that decides the tie of two
// coincident faces wrongly: right volume, wrong area.
std::vector<Check> wall_between_flush_boxes() {
  const Solid solid = samples::unite({box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})});
  Boundary left = evaluate(box({0, 0, 0}, {1, 1, 1}));
  const Boundary second = evaluate(box({1, 0, 0}, {2, 1, 1}));
  const auto n = static_cast<std::uint32_t>(left.vertices.size());
  const std::uint32_t planes = left.plane_count;
  left.vertices.append(ExactPoints(second.vertices));
  left.approximate.insert(left.approximate.end(), second.approximate.begin(),
                          second.approximate.end());
  left.plane_count += second.plane_count;
  for (const BoundaryEdge& e : second.edges) left.edges.push_back({e.from + n, e.to + n});
  for (BoundaryFace face : second.faces) {
    face.plane += planes;
    for (auto& loop : face.loops) {
      for (std::uint32_t& v : loop) v += n;
    }
    left.faces.push_back(face);
  }
  return verify_with(solid, left);
}

std::vector<Fault> evaluation_faults() {
  return {
      evaluated_from("operand_pruned_wrongly", without_notch,
                     {"vertex only in ours: (4, 3, 2)", "(3, 2, 1)"}),
      evaluated_from("operator_exchanged",
                     [] {
                       return samples::unite({samples::subtract({box({0, 0, 0}, {4, 3, 2}),
                                                                 box({1, 1, -1}, {2, 2, 3})}),
                                              box({3, 2, 1}, {5, 4, 3}), samples::pyramid(1, 3)});
                     },
                     {"vertex only in ours: (5, 2, 1)"}),
      evaluated_from("primitive_dropped",
                     [] {
                       return samples::subtract({box({0, 0, 0}, {4, 3, 2}),
                                                 box({1, 1, -1}, {2, 2, 3}),
                                                 box({3, 2, 1}, {5, 4, 3})});
                     },
                     {"(3/7, 3/7, 3)"}),
      evaluated_from("moved_by_1e-9",
                     [] {
                       AffineMap map = AffineMap::identity();
                       map.m[0][3] = Rational(1, 1'000'000'000);
                       return apply(map, plate());
                     },
                     {"vertex only in the oracle's: (0, 0, 0)"}),
      evaluated_from("hole_moved_by_1e-12",
                     [] { return plate(Rational(Integer(1), Integer(1'000'000'000'000))); },
                     {"vertex only in the oracle's: (1, 1, 0)"}),
      evaluated_from("mirrored",
                     [] {
                       AffineMap map = AffineMap::identity();
                       map.m[0][0] = -1;
                       map.m[0][3] = 4;
                       return apply(map, plate());
                     },
                     {"(1, 1, 0)"}),
      evaluated_from("complement_taken",
                     [] {
                       return samples::subtract({box({-9, -9, -9}, {9, 9, 9}), plate()});
                     },
                     {"vertex only in ours: (-9, -9, -9)"}),
      {"tie_of_coincident_faces",
       wall_between_flush_boxes,
       {"face plane only in ours: 1 x + 0 y + 0 z + -1", "(1, 0, 0)"}},
      // The oracle reads another tree than the one that was evaluated.
      {"oracle_given_another_tree",
       [] { return verify_with(without_notch(), plate_boundary()); },
       {"vertex only in the oracle's: (4, 3, 2)"}},
      {"tree_with_wrong_tessellation",
       [] {
         const auto prism = [](int n) {
           Polyhedron p;
           Facet top;
           Facet base;
           for (int i = 0; i < n; ++i) {
             const double angle = 6.283185307179586 * i / n;
             const Rational x = rational_of(std::cos(angle));
             const Rational y = rational_of(std::sin(angle));
             p.vertices.push_back({x, y, 0});
             p.vertices.push_back({x, y, 1});
             base.push_back(static_cast<std::uint32_t>(2 * (n - 1 - i)));
             top.push_back(static_cast<std::uint32_t>(2 * i + 1));
             const auto a = static_cast<std::uint32_t>(2 * i);
             const auto c = static_cast<std::uint32_t>(2 * ((i + 1) % n));
             p.facets.push_back({a, c, c + 1, a + 1});
           }
           p.facets.push_back(base);
           p.facets.push_back(top);
           return Solid::primitive({make_convex_polytope(std::move(p)), {}});
         };
         return verify_with(prism(12), evaluate(prism(13)));
       },
       {"vertex only in the oracle's: (-1, 1.2246467991473532e-16, 0)"}},
  };
}

// ---- faults in mesh files
// -------------------------------------------------------------------------------

std::vector<Check> compare(const io::PolygonSoup& soup) {
  return compare_with_soup(plate_boundary(), soup);
}

Fault in_soup(std::string name, std::function<void(io::PolygonSoup&)> mutate,
              std::vector<std::string> places) {
  return {std::move(name),
          [mutate = std::move(mutate)] {
            io::PolygonSoup soup = samples::rounded(soup_of(plate_boundary()), io::MeshFormat::Off,
                                                    samples::round_to_six_digits);
            mutate(soup);
            return compare(soup);
          },
          std::move(places)};
}

std::uint32_t vertex_near(const io::PolygonSoup& soup, double x, double y, double z) {
  std::uint32_t best = 0;
  double least = 1e300;
  for (std::uint32_t i = 0; i < soup.vertices.size(); ++i) {
    const Point3& p = soup.vertices[i];
    const double d = std::fabs(nearest_double(p.x) - x) + std::fabs(nearest_double(p.y) - y) +
                     std::fabs(nearest_double(p.z) - z);
    if (d < least) {
      least = d;
      best = i;
    }
  }
  return best;
}

// The plate with its hole moved, written in a format: the file of a model before a change.
Fault before_a_change(std::string name, const Rational& shift, io::MeshFormat format,
                      Rational (*round)(const Rational&), std::vector<std::string> places) {
  return {std::move(name),
          [shift, format, round] {
            return compare(samples::rounded(soup_of(evaluate(plate(shift))), format, round));
          },
          std::move(places)};
}

std::vector<Fault> mesh_faults() {
  return {
      in_soup("facet_flipped",
              [](io::PolygonSoup& s) { std::swap(s.facets[0][0], s.facets[0][1]); }, {"oriented"}),
      in_soup("facet_missing", [](io::PolygonSoup& s) { s.facets.pop_back(); }, {"open edge"}),
      in_soup("facet_twice", [](io::PolygonSoup& s) { s.facets.push_back(s.facets[0]); },
              {"open edge"}),
      in_soup("facet_twice_both_ways",
              [](io::PolygonSoup& s) {
                auto facet = s.facets[0];
                s.facets.push_back(facet);
                std::reverse(facet.begin(), facet.end());
                s.facets.push_back(facet);
              },
              {"manifold", "the area differs"}),
      in_soup("all_facets_twice_both_ways",
              [](io::PolygonSoup& s) {
                const auto facets = s.facets;
                for (auto facet : facets) {
                  s.facets.push_back(facet);
                  std::reverse(facet.begin(), facet.end());
                  s.facets.push_back(facet);
                }
              },
              {"manifold", "the area differs"}),
      in_soup("inside_out",
              [](io::PolygonSoup& s) {
                for (auto& facet : s.facets) std::reverse(facet.begin(), facet.end());
              },
              {"inside out"}),
      // The apex (3/7, 3/7, 3) is written 0.428571 0.428571 3: one unit in the last of six digits.
      in_soup("vertex_one_unit_in_the_last_of_six_digits",
              [](io::PolygonSoup& s) {
                s.vertices[vertex_near(s, 0.428571, 0.428571, 3)].x = *parse_rational("0.428572");
              },
              {"(0.42857142857142855, 0.42857142857142855, 3)"}),
      in_soup("corner_one_unit_in_the_last_of_six_digits",
              [](io::PolygonSoup& s) {
                s.vertices[vertex_near(s, 4, 0, 0)].x = *parse_rational("4.00001");
              },
              {"(4.0000099999999996, 0, 0)", "[4, 0, 0]"}),
      {"vertex_one_unit_in_the_last_place_of_binary_stl",
       [] {
         io::PolygonSoup soup = samples::rounded(
             soup_of(plate_boundary()), io::MeshFormat::StlBinary, samples::round_to_single);
         Point3& p = soup.vertices[vertex_near(soup, 4, 3, 0)];
         p.y = rational_of(static_cast<double>(std::nextafter(3.0F, 4.0F)));
         return compare(soup);
       },
       {"[4, 3, 0]"}},
      {"vertex_one_unit_in_the_last_place_of_a_double",
       [] {
         io::PolygonSoup soup = soup_of(plate_boundary());
         for (Point3& p : soup.vertices) {
           p = {rational_of(nearest_double(p.x)), rational_of(nearest_double(p.y)),
                rational_of(nearest_double(p.z))};
         }
         Point3& p = soup.vertices[vertex_near(soup, 4, 3, 0)];
         p.y = rational_of(std::nextafter(3.0, 4.0));
         return compare(soup);
       },
       {"[4, 3, 0]"}},
      in_soup("vertices_merged",
              [](io::PolygonSoup& s) {
                const Point3 to = s.vertices[vertex_near(s, 1, 1, 0)];
                s.vertices[vertex_near(s, 1, 2, 0)] = to;
              },
              {"[1, 2, 0]"}),
      in_soup("hole_filled_by_two_triangles",
              [](io::PolygonSoup& s) {
                const std::uint32_t a = vertex_near(s, 1, 1, 0);
                const std::uint32_t b = vertex_near(s, 2, 1, 0);
                const std::uint32_t c = vertex_near(s, 2, 2, 0);
                const std::uint32_t d = vertex_near(s, 1, 2, 0);
                s.facets.push_back({a, d, c});
                s.facets.push_back({a, c, b});
              },
              {"(1, 1, 0)"}),
      in_soup("scaled_by_1.0001",
              [](io::PolygonSoup& s) {
                for (Point3& p : s.vertices) p.x *= Rational(10001, 10000);
              },
              {"the volume differs", "[4, 0, 0]"}),
      in_soup("in_inches",
              [](io::PolygonSoup& s) {
                for (Point3& p : s.vertices) {
                  p = {p.x * 10 / 254, p.y * 10 / 254, p.z * 10 / 254};
                }
              },
              {"the volume differs", "[4, 0, 0]"}),
      in_soup("axes_exchanged",
              [](io::PolygonSoup& s) {
                for (Point3& p : s.vertices) std::swap(p.x, p.y);
                for (auto& facet : s.facets) std::reverse(facet.begin(), facet.end());
              },
              {"[4, 0, 0]"}),
      in_soup("a_part_missing",
              [](io::PolygonSoup& s) {
                s = samples::rounded(soup_of(evaluate(samples::subtract(
                                         {box({0, 0, 0}, {4, 3, 2}), box({1, 1, -1}, {2, 2, 3}),
                                          box({3, 2, 1}, {5, 4, 3})}))),
                                     io::MeshFormat::Off, samples::round_to_six_digits);
              },
              {"[0.428571429, 0.428571429, 3]"}),
      in_soup("empty_file", [](io::PolygonSoup& s) { s = {}; }, {"no facets", "[4, 0, 0]"}),
      before_a_change("hole_moved_by_0.1_off", Rational(1, 10), io::MeshFormat::Off,
                      samples::round_to_six_digits, {"[1, 1, 0]", "(1.1000000000000001, 1, 0)"}),
      before_a_change("hole_moved_by_0.1_binary_stl", Rational(1, 10), io::MeshFormat::StlBinary,
                      samples::round_to_single, {"[1, 1, 0]", "(1.1000000238418579, 1, 0)"}),
      before_a_change("hole_moved_by_0.0001_obj", Rational(1, 10000), io::MeshFormat::Obj,
                      samples::round_to_six_digits, {"[1, 1, 0]", "(1.0001, 1, 0)"}),
      before_a_change("hole_moved_by_0.1_ply", Rational(1, 10), io::MeshFormat::Ply,
                      samples::round_to_six_digits, {"[1, 1, 0]", "(1.1000000000000001, 1, 0)"}),
      before_a_change("hole_moved_by_0.1_ascii_stl", Rational(1, 10), io::MeshFormat::StlAscii,
                      samples::round_to_six_digits, {"[1, 1, 0]", "(1.1000000000000001, 1, 0)"}),
  };
}

// ---- faults in golden files
// -----------------------------------------------------------------------------

Fault in_golden(const std::string& field, std::function<void(GoldenEntry&)> mutate) {
  return {"golden_" + field,
          [mutate = std::move(mutate)] {
            GoldenFile golden;
            golden.models["plate"] = golden_entry(plate_boundary(), "closed form, see the test");
            mutate(golden.models["plate"]);
            return std::vector<Check>{check_golden(golden, "plate", plate_boundary())};
          },
          {field + ": ours"}};
}

std::vector<Fault> golden_faults() {
  return {
      in_golden("digest", [](GoldenEntry& e) { e.digest[5] = e.digest[5] == '0' ? '1' : '0'; }),
      in_golden("volume",
                [](GoldenEntry& e) { e.volume.back() = e.volume.back() == '1' ? '2' : '1'; }),
      in_golden("volume_exact", [](GoldenEntry& e) { e.volume_exact = "20"; }),
      in_golden("area", [](GoldenEntry& e) { e.area.back() = e.area.back() == '1' ? '2' : '1'; }),
      in_golden("vertices", [](GoldenEntry& e) { ++e.vertices; }),
      in_golden("edges", [](GoldenEntry& e) { --e.edges; }),
      in_golden("faces", [](GoldenEntry& e) { ++e.faces; }),
      in_golden("components", [](GoldenEntry& e) { ++e.components; }),
      in_golden("genus", [](GoldenEntry& e) { ++e.genus; }),
      {"golden_entry_missing",
       [] { return std::vector<Check>{check_golden({}, "plate", plate_boundary())}; },
       {"no entry 'plate'"}},
  };
}

// ---- faults in .nef3 files
// ------------------------------------------------------------------------------

// corner_cut.nef3 was written by OpenSCAD 2021.01 from corner_cut.csg: the cube [0,2]^3 less
// [1,3]^3.
std::string nef3_text() {
  std::ifstream in(EXACTCSG_SOURCE_DIR "/tests/verify/corner_cut.nef3");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

const Boundary& corner_cut() {
  static const Boundary boundary =
      evaluate(samples::subtract({box({0, 0, 0}, {2, 2, 2}), box({1, 1, 1}, {3, 3, 3})}));
  return boundary;
}

std::vector<Check> compare_nef3(const std::string& text) {
  return compare_with_nef3(corner_cut(), parse_nef3(text));
}

Fault in_nef3(std::string name, const std::string& from, const std::string& to,
              std::vector<std::string> places) {
  return {std::move(name),
          [from, to] {
            std::string text = nef3_text();
            const auto at = text.find(from);
            EXPECT_NE(at, std::string::npos);
            text.replace(at, from.size(), to);
            return compare_nef3(text);
          },
          std::move(places)};
}

std::vector<Fault> nef3_faults() {
  return {
      in_nef3("nef3_vertex_one_grid_unit", "| 1 1 1 1 }", "| 1048577 1048576 1048576 1048576 }",
              {"vertex only in ours: (1, 1, 1)", "(1048577/1048576, 1, 1)"}),
      in_nef3("nef3_vertex_far_off", "| 0 2 0 1 }", "| 0 3 0 1 }",
              {"vertex only in ours: (0, 2, 0)", "(0, 3, 0)"}),
      in_nef3("nef3_plane_sign", "| 1 0 0 -2 } 1", "| -1 0 0 2 } 1",
              {"face plane only in ours: 1 x + 0 y + 0 z + -2"}),
      in_nef3("nef3_plane_offset", "| 1 0 0 -2 } 1", "| 1 0 0 -3 } 1",
              {"face plane only in the oracle's: 1 x + 0 y + 0 z + -3"}),
      in_nef3("nef3_volume_unmarked", "1 { 11 } 1", "1 { 11 } 0",
              {"vertex only in ours: (0, 0, 0)"}),
  };
}

std::vector<Fault> all_faults() {
  std::vector<Fault> all;
  for (auto part :
       {boundary_faults(), evaluation_faults(), mesh_faults(), golden_faults(), nef3_faults()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

class SeededFault : public testing::TestWithParam<Fault> {};

TEST_P(SeededFault, IsCaughtAndLocated) {
  const std::vector<Check> checks = GetParam().run();
  const std::string text = complaints(checks);
  EXPECT_FALSE(text.empty()) << "the fault was not noticed";
  for (const std::string& place : GetParam().places) {
    EXPECT_NE(text.find(place), std::string::npos) << place << " is not named in\n" << text;
  }
}

std::string test_name(const testing::TestParamInfo<Fault>& info) {
  std::string name = info.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0 && c != '_'; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, SeededFault, testing::ValuesIn(all_faults()), test_name);

// ---- controls: without a fault everything passes
// --------------------------------------------------------

TEST(SeededFaultControls, AtLeastFortyFaults) { EXPECT_GE(all_faults().size(), 40U); }

TEST(SeededFaultControls, Boundary) {
  EXPECT_EQ(complaints(verify_with(plate(), plate_boundary())), "");
}

TEST(SeededFaultControls, MeshesOfEveryFormat) {
  const io::PolygonSoup exact = soup_of(plate_boundary());
  using enum io::MeshFormat;
  EXPECT_EQ(complaints(compare(samples::rounded(exact, Off, samples::round_to_six_digits))), "");
  EXPECT_EQ(complaints(compare(samples::rounded(exact, StlAscii, samples::round_to_six_digits))),
            "");
  EXPECT_EQ(complaints(compare(samples::rounded(exact, StlBinary, samples::round_to_single))), "");
  EXPECT_EQ(complaints(compare(samples::rounded(exact, Obj, samples::round_to_six_digits))), "");
  EXPECT_EQ(complaints(compare(samples::rounded(exact, Ply, samples::round_to_single))), "");
}

TEST(SeededFaultControls, Golden) {
  GoldenFile golden;
  golden.models["plate"] = golden_entry(plate_boundary(), "closed form");
  EXPECT_EQ(check_golden(golden, "plate", plate_boundary()).verdict, Verdict::Passed);
}

TEST(SeededFaultControls, Nef3) { EXPECT_EQ(complaints(compare_nef3(nef3_text())), ""); }

}  // namespace
}  // namespace exactcsg::verify
