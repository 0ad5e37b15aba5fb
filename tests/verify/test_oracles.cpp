// SPDX-License-Identifier: GPL-3.0-or-later
// Every comparison on its own: what it accepts, what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "exactcsg/support/error.hpp"
#include "exactcsg/support/sanitizer.hpp"
#include "exactcsg/verify/boundary_classifier.hpp"
#include "exactcsg/verify/facet_complex.hpp"
#include "exactcsg/verify/mesh_comparison.hpp"
#include "exactcsg/verify/nef.hpp"
#include "exactcsg/verify/openscad.hpp"
#include "exactcsg/verify/process.hpp"
#include "exactcsg/verify/sampling.hpp"
#include "samples.hpp"

namespace exactcsg::verify {
namespace {

using samples::box;
using samples::complaints;

// ---- exact sums
// ---------------------------------------------------------------------------------------

std::vector<Point3> cube_points(const Rational& side) {
  std::vector<Point3> points;
  for (int i = 0; i < 8; ++i) {
    points.push_back({side * (i & 1), side * (i >> 1 & 1), side * (i >> 2 & 1)});
  }
  return points;
}
const std::vector<Cycles> cube_cycles{{{0, 2, 3, 1}}, {{4, 5, 7, 6}}, {{0, 1, 5, 4}},
                                      {{2, 6, 7, 3}}, {{0, 4, 6, 2}}, {{1, 3, 7, 5}}};

VolumeSum cube_volume(const Rational& side) {
  std::vector<OrientedFace> faces;
  for (const Cycles& c : cube_cycles) faces.push_back({&c, 1});
  return sum_volume(cube_points(side), faces);
}

TEST(ExactSums, CubeOfSideOneThird) {  // closed form: side^3
  EXPECT_EQ(cube_volume(Rational(1, 3)).exact, Rational(1, 27));
}

TEST(ExactSums, ResiduesDecideWhereTheRationalIsTooLong) {
  const Rational tiny = 1 / Rational(Integer(1) << 20'000);
  const VolumeSum a = cube_volume(1 + tiny);
  const VolumeSum b = cube_volume(1 + 2 * tiny);
  ASSERT_FALSE(a.exact.has_value());
  EXPECT_EQ(a, cube_volume(1 + tiny));
  EXPECT_FALSE(a == b);  // they differ by 3 * 2^-20000
  EXPECT_EQ(a.decimal, "1");
}

TEST(ExactSums, Balances) {  // 3^3 + 4^3 + 5^3 = 6^3
  EXPECT_TRUE(balances({cube_volume(3), cube_volume(4), cube_volume(5)}, {cube_volume(6)}));
  EXPECT_FALSE(balances({cube_volume(3), cube_volume(4)}, {cube_volume(5)}));
}

// ---- processes
// ----------------------------------------------------------------------------------------

TEST(Process, GivesOutputAndMessages) {
  const ProcessResult r = run_program({"sh", "-c", "echo out; echo err >&2; exit 3"}, {}, {});
  EXPECT_EQ(r.end, ProcessEnd::Exited);
  EXPECT_EQ(r.status, 3);
  EXPECT_EQ(r.output, "out\n");
  EXPECT_EQ(r.messages, "err\n");
}

TEST(Process, ArgumentsAreNotInterpreted) {
  const ProcessResult r = run_program({"echo", "$(touch /tmp/never); *"}, {}, {});
  EXPECT_EQ(r.output, "$(touch /tmp/never); *\n");
}

TEST(Process, KillsWhatRunsOverTime) {
  ProcessLimits limits;
  limits.seconds = 0.3;
  const auto start = std::chrono::steady_clock::now();
  // The grandchild must die too, or the pipe would stay open for a minute.
  const ProcessResult r = run_program({"sh", "-c", "sleep 60 & sleep 60"}, {}, limits);
  EXPECT_EQ(r.end, ProcessEnd::OverTime);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(Process, SaysWhatIsNotInstalled) {
  EXPECT_EQ(run_program({"exactcsg-no-such-program"}, {}, {}).end, ProcessEnd::NotFound);
}

TEST(Process, ForkedWorkHandsBackTextOrItsError) {
  EXPECT_EQ(run_forked([] { return std::string(200'000, 'x'); }, {}).output.size(), 200'000U);
  const ProcessResult r = run_forked([]() -> std::string { throw std::runtime_error("no"); }, {});
  EXPECT_EQ(r.status, 1);
  EXPECT_EQ(r.messages, "no");
}

TEST(Process, MemoryIsLimited) {
  if (has_shadow_memory) GTEST_SKIP() << "sanitizers need address space of their own";
  ProcessLimits limits;
  limits.memory = std::size_t{1} << 30U;
  const ProcessResult r = run_forked(
      [] {
        std::vector<char> large(std::size_t{8} << 30U, 'x');
        return std::string(1, large[large.size() / 2]);
      },
      limits);
  EXPECT_EQ(r.messages, "out of memory");
}

// ---- Nef
// ------------------------------------------------------------------------------------------------

Solid turned_cube() {  // the unit cube centred at 0, turned about z by cos 3/5, sin 4/5
  AffineMap map = AffineMap::identity();
  map.m[0] = {Rational(3, 5), Rational(-4, 5), 0, 0};
  map.m[1] = {Rational(4, 5), Rational(3, 5), 0, 0};
  const Rational h(1, 2);
  return apply(map, box({-h, -h, -h}, {h, h, h}));
}
Solid centred_cube() {
  const Rational h(1, 2);
  return box({-h, -h, -h}, {h, h, h});
}

// The closed form 2 / (1 + cos + sin) for the intersection; the others follow from it.
TEST(Nef, TurnedCubes) {
  const auto volume = [](const Solid& s) { return *volume_sum(evaluate_nef(s).complex).exact; };
  EXPECT_EQ(volume(samples::intersect({centred_cube(), turned_cube()})), Rational(5, 6));
  EXPECT_EQ(volume(samples::unite({centred_cube(), turned_cube()})), Rational(7, 6));
  EXPECT_EQ(volume(samples::subtract({centred_cube(), turned_cube()})), Rational(1, 6));
  EXPECT_EQ(volume(Solid::compose(csg::BooleanOperator::SymmetricDifference,
                                  {centred_cube(), turned_cube()})),
            Rational(1, 3));
}

TEST(Nef, AgreesWithTheEvaluator) {
  for (const Solid& solid :
       {samples::plate(), samples::intersect({centred_cube(), turned_cube()}),
        // touching along an edge, at a vertex, and flush
        samples::unite({box({0, 0, 0}, {1, 1, 1}), box({1, 1, 0}, {2, 2, 1})}),
        samples::unite({box({0, 0, 0}, {1, 1, 1}), box({1, 1, 1}, {2, 2, 2})}),
        samples::unite({box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})}),
        // a cavity, and a shell inside a cavity
        samples::unite({samples::subtract({box({0, 0, 0}, {5, 5, 5}), box({1, 1, 1}, {4, 4, 4})}),
                        box({2, 2, 2}, {3, 3, 3})})}) {
    EXPECT_EQ(
        complaints(compare_exactly(evaluate(solid), evaluate_nef(solid).complex, "nef", "nef")),
        "");
  }
}

TEST(Nef, HalfSpaces) {  // the simplex x, y, z >= 0, x + y + z <= 1 has volume 1/6
  const auto half = [](int a, int b, int c, int d) {
    return Solid::primitive({make_half_space(a, b, c, d), {}});
  };
  const Solid simplex = samples::intersect(
      {half(-1, 0, 0, 0), half(0, -1, 0, 0), half(0, 0, -1, 0), half(1, 1, 1, -1)});
  EXPECT_EQ(volume_sum(evaluate_nef(simplex).complex).exact, Rational(1, 6));
  EXPECT_EQ(
      complaints(compare_exactly(evaluate(simplex), evaluate_nef(simplex).complex, "nef", "nef")),
      "");
  try {
    evaluate_nef(samples::intersect({half(-1, 0, 0, 0), half(0, -1, 0, 0)}));
    ADD_FAILURE() << "an unbounded solid was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::UnboundedSolid);
  }
}

Polyhedron box_polyhedron(const Point3& lower, const Point3& upper) {
  return to_polyhedron(*make_box(lower, upper).polyhedron);
}

void append(Polyhedron& to, const Polyhedron& from, bool reversed) {
  const auto n = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
  for (Facet facet : from.facets) {
    for (std::uint32_t& v : facet) v += n;
    if (reversed) std::reverse(facet.begin(), facet.end());
    to.facets.push_back(std::move(facet));
  }
}

// CGAL fills every bounded volume of a mesh: a hollow box would come out solid.
TEST(Nef, MeshWithACavity) {
  Polyhedron mesh = box_polyhedron({0, 0, 0}, {3, 3, 3});
  append(mesh, box_polyhedron({1, 1, 1}, {2, 2, 2}), true);
  const Solid solid = Solid::primitive({make_mesh(std::move(mesh)), {}});
  EXPECT_EQ(volume_sum(evaluate_nef(solid).complex).exact, Rational(26));
}

// Two boxes that share an edge, as one mesh: the edge carries four facets.
TEST(Nef, MeshWithAnEdgeOfFourFacets) {
  Polyhedron mesh = box_polyhedron({0, 0, 0}, {1, 1, 1});
  append(mesh, box_polyhedron({1, 1, 0}, {2, 2, 1}), false);
  const Solid solid = Solid::primitive({make_mesh_unchecked(std::move(mesh)), {}});
  const NefResult result = evaluate_nef(solid);
  EXPECT_EQ(volume_sum(result.complex).exact, Rational(2));
  EXPECT_EQ(canonical_sets(result.complex).vertices.size(), 14U);  // 8 + 8 - 2
}

TEST(Nef, LocatesPoints) {
  const std::vector<Point3> points{{Rational(1, 2), Rational(1, 2), Rational(1, 2)},
                                   {1, Rational(1, 2), Rational(1, 2)},
                                   {0, 0, 0},
                                   {2, 0, 0}};
  const std::vector<PointClass> expected{PointClass::In, PointClass::On, PointClass::On,
                                         PointClass::Out};
  EXPECT_EQ(evaluate_nef(box({0, 0, 0}, {1, 1, 1}), points).classes, expected);
}

TEST(Nef, ChildProcessGivesTheSame) {
  const NefOutcome outcome = run_nef(samples::plate(), {}, {});
  ASSERT_TRUE(outcome.answered) << outcome.reason;
  EXPECT_EQ(
      complaints(compare_exactly(samples::plate_boundary(), outcome.result.complex, "nef", "nef")),
      "");
}

TEST(Nef, OverBudgetIsSaid) {
  std::vector<Solid> parts;
  for (int i = 0; i < 2000; ++i) parts.push_back(box({i, 0, 0}, {i + 2, 1 + i % 7, 1 + i % 3}));
  NefLimits limits;
  limits.seconds = 0.2;
  const NefOutcome outcome = run_nef(samples::unite(std::move(parts)), {}, limits);
  EXPECT_FALSE(outcome.answered);
  EXPECT_EQ(outcome.reason, "over the budget of 0.2 s");
}

TEST(Nef, BrokenTextIsRefused) {
  EXPECT_THROW(deserialize_nef("v 1 2\nend\n"), Error);
  EXPECT_THROW(deserialize_nef("c 0 1 2\nend\n"), Error);
  EXPECT_THROW(deserialize_nef("v 1 2 3\n"), Error);  // no end
}

// ---- .nef3
// ----------------------------------------------------------------------------------------------

std::string corner_cut_text() {
  std::ifstream in(EXACTCSG_SOURCE_DIR "/tests/verify/corner_cut.nef3");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

TEST(Nef3File, CubeLessCube) {  // 2^3 - 1^3
  const FacetComplex complex = parse_nef3(corner_cut_text());
  EXPECT_EQ(volume_sum(complex).exact, Rational(7));
  EXPECT_EQ(complex.vertices.size(), 14U);
  EXPECT_TRUE(complex.membranes.empty());
}

TEST(Nef3File, CutShortAnywhereIsRefused) {
  const std::string text = corner_cut_text();
  for (std::size_t lines = 0; lines < 170; lines += 7) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < lines; ++i) at = text.find('\n', at) + 1;
    EXPECT_THROW(parse_nef3(text.substr(0, at)), Error) << lines << " lines";
  }
}

TEST(Nef3File, WildIndicesAreRefused) {
  std::string text = corner_cut_text();
  const std::string record = "0 { 1, 18 , , 0 | 1 0 0 -2 } 1";
  const auto at = text.find(record);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, record.size(), "0 { 1, 99999 , , 0 | 1 0 0 -2 } 1");
  EXPECT_THROW(parse_nef3(text), Error);
}

// ---- displacement bound
// ---------------------------------------------------------------------------------

TEST(DisplacementBound, CoversAGrownCube) {
  const Rational d(1, 1000);
  const auto bound = displacement_bound(box({0, 0, 0}, {1, 1, 1}), box({-d, -d, -d}, {1, 1, 1}));
  ASSERT_TRUE(bound.has_value());
  const Rational grown = 1 + d;
  EXPECT_GE(bound->volume, grown * grown * grown - 1);
  EXPECT_LE(bound->volume, Rational(1, 40));  // 2 * 6 * sqrt(3) / 1000 and a little: not vacuous
}

TEST(DisplacementBound, SameHandlesAreNotMoved) {
  const Solid plate = samples::plate();
  EXPECT_EQ(displacement_bound(plate, plate)->volume, 0);
}

TEST(DisplacementBound, OtherFormsAreNotCompared) {
  EXPECT_FALSE(displacement_bound(samples::plate(), box({0, 0, 0}, {1, 1, 1})).has_value());
}

// ---- sampling and laws
// ----------------------------------------------------------------------------------

TEST(BoundaryClassifier, KnownPoints) {
  const Boundary& plate = samples::plate_boundary();
  const BoundaryClassifier classify(plate);
  const Rational h(1, 2);
  EXPECT_EQ(classify({3 + h, 1, 1}), PointClass::In);
  EXPECT_EQ(classify({1 + h, 1 + h, 1}), PointClass::Out);                   // in the hole
  EXPECT_EQ(classify({1 + h, 1 + h, 0}), PointClass::Out);                   // in the hole's mouth
  EXPECT_EQ(classify({1, 1 + h, 1}), PointClass::On);                        // on the hole's wall
  EXPECT_EQ(classify({3, 3, 1 + h}), PointClass::On);                        // on the notch's edge
  EXPECT_EQ(classify({3 + h, 2 + h, 1 + h}), PointClass::Out);               // in the notch
  EXPECT_EQ(classify({Rational(3, 7), Rational(3, 7), 3}), PointClass::On);  // the apex
  EXPECT_EQ(classify({-5, 100, 3}), PointClass::Out);
}

TEST(Sampling, AllWaysAgree) {
  const Boundary& boundary = samples::plate_boundary();
  const auto points = sample_points(boundary, 300, 7);
  EXPECT_EQ(points.size(), 300U);
  EXPECT_EQ(points, sample_points(boundary, 300, 7));
  const auto fewer = sample_points(boundary, 50, 7);  // LAW sampling.1
  EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), points.begin()));
  EXPECT_EQ(complaints(check_sampling(samples::plate(), boundary, points, {})), "");
}

TEST(Sampling, AnotherSolidIsNoticed) {
  const Boundary& boundary = samples::plate_boundary();
  const auto points = sample_points(boundary, 100, 7);
  EXPECT_NE(complaints(check_sampling(box({0, 0, 0}, {4, 3, 2}), boundary, points, {})), "");
}

TEST(Laws, HoldOnSubtrees) {
  LawOptions options;
  options.samples = 4;
  const auto checks = check_laws(samples::plate(), options);
  EXPECT_EQ(checks.front().verdict, Verdict::Passed) << complaints(checks);
}

// ---- mesh files
// -----------------------------------------------------------------------------------------

// A cube whose one side is cut in two while its neighbours are not: T-junctions without gaps.
TEST(MeshComparison, TJunctionsAreClosed) {
  io::PolygonSoup soup;
  soup.vertices = cube_points(1);
  const Rational h(1, 2);
  soup.vertices.push_back({h, 0, 0});  // 8
  soup.vertices.push_back({h, 1, 0});  // 9
  soup.facets = {{0, 2, 9, 8}, {8, 9, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                 {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  const auto checks = compare_with_soup(evaluate(box({0, 0, 0}, {1, 1, 1})), soup);
  EXPECT_EQ(complaints(checks), "");
  EXPECT_NE(samples::find(checks, "against: closed")->explanation.find("2 T-junctions"),
            std::string::npos);
}

TEST(MeshComparison, VerticesWeldedByRoundingAreAllowed) {
  // Two corners 1e-7 apart become one in six digits: a facet vanishes, the rest closes up.
  const Rational tiny(1, 10'000'000);
  Polyhedron p;
  p.vertices = {{1, 1, 1}, {3, 1, 1}, {1, 3, 1}, {1, 1, 3}, {1 + tiny, 1, 3}};
  p.facets = {{0, 2, 1}, {0, 1, 4, 3}, {0, 3, 2}, {1, 2, 4}, {2, 3, 4}};
  const Boundary boundary = evaluate(Solid::primitive({make_convex_polytope(std::move(p)), {}}));
  const auto soup = samples::rounded(samples::soup_of(boundary), io::MeshFormat::Off,
                                     samples::round_to_six_digits);
  EXPECT_EQ(complaints(compare_with_soup(boundary, soup)), "");
}

// Two pits, one in either face of an edge, end 1e-7 before the edge: between each tip and the edge
// the triangulation must have a sliver, and in six digits both tips become the same point of the
// edge. The file's ridge passes through that point, on diagonals of the model's faces.
Solid edge_between_pits(const Rational& gap) {
  const auto pit = [&](bool in_the_top) {  // so flat that the two do not meet
    Polyhedron p;
    p.vertices = {{3 - gap, 3, 3}, {2, 4, 3}, {2, 2, 3}, {2, 3, Rational(5, 2)}};
    p.facets = {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 3}};
    if (!in_the_top) {
      for (Point3& point : p.vertices) std::swap(point.x, point.z);
      for (auto& facet : p.facets) std::reverse(facet.begin(), facet.end());
    }
    return Solid::primitive({make_convex_polytope(std::move(p)), {}});
  };
  return samples::subtract({box({1, 1, 1}, {3, 5, 3}), pit(true), pit(false)});
}

io::PolygonSoup in_six_digits(const Boundary& boundary) {
  return samples::rounded(samples::soup_of(boundary), io::MeshFormat::Off,
                          samples::round_to_six_digits);
}

TEST(MeshComparison, SliversOnEitherSideOfAnEdgeAreAllowed) {
  const Rational gap(1, 10'000'000);
  const Boundary boundary = evaluate(edge_between_pits(gap));
  const io::PolygonSoup soup = in_six_digits(boundary);
  EXPECT_EQ(complaints(compare_with_soup(boundary, soup)), "");
  // Other programs leave out the facets without area: their neighbours meet in the tip.
  io::PolygonSoup without_slivers = soup;
  std::erase_if(without_slivers.facets, [&](const std::vector<std::uint32_t>& f) {
    return cross(soup.vertices[f[1]] - soup.vertices[f[0]],
                 soup.vertices[f[2]] - soup.vertices[f[0]]) == Vector3{0, 0, 0};
  });
  EXPECT_EQ(soup.facets.size() - without_slivers.facets.size(), 2U);
  EXPECT_EQ(complaints(compare_with_soup(boundary, without_slivers)), "");
}

TEST(MeshComparison, PitsAHundredthFromAnEdgeAreNotThoseBesideIt) {
  const Boundary boundary = evaluate(edge_between_pits(Rational(1, 10'000'000)));
  const auto soup = in_six_digits(evaluate(edge_between_pits(Rational(1, 100))));
  const std::string text = complaints(compare_with_soup(boundary, soup));
  EXPECT_NE(text.find("sharp edge of the file that the model does not have: (2, "),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("2.99"), std::string::npos) << text;
}

// Floor and ceiling become one, and so do their diagonals: four facets at an edge that is none.
TEST(MeshComparison, CavityThinnerThanRoundingIsAllowed) {
  const Rational thickness(1, 10'000'000);
  const Boundary boundary = evaluate(
      samples::subtract({box({1, 1, 1}, {5, 5, 5}), box({2, 2, 3}, {4, 4, 3 + thickness})}));
  EXPECT_EQ(complaints(compare_with_soup(boundary, in_six_digits(boundary))), "");
}

// As in an STL file: every facet has its own vertices, and there are no others.
io::PolygonSoup with_own_vertices(const io::PolygonSoup& soup) {
  io::PolygonSoup result;
  result.format = soup.format;
  for (const auto& facet : soup.facets) {
    auto& corners = result.facets.emplace_back();
    for (const std::uint32_t v : facet) {
      corners.push_back(static_cast<std::uint32_t>(result.vertices.size()));
      result.vertices.push_back(soup.vertices[v]);
    }
  }
  return result;
}

// Every facet of the needle loses a corner. Programs differ in whether they write what is left.
TEST(MeshComparison, NeedleThinnerThanRoundingIsAllowed) {
  const Rational thickness(1, 10'000'000);
  const Boundary boundary = evaluate(samples::unite(
      {box({1, 1, 1}, {5, 5, 5}), box({2, 2, 4}, {2 + thickness, 2 + thickness, 7})}));
  io::PolygonSoup soup = in_six_digits(boundary);
  EXPECT_EQ(complaints(compare_with_soup(boundary, soup)), "");
  std::erase_if(soup.facets, [&](const std::vector<std::uint32_t>& f) {
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
      return soup.vertices[a] == soup.vertices[b];
    };
    return same(f[0], f[1]) || same(f[1], f[2]) || same(f[2], f[0]);
  });
  soup = with_own_vertices(soup);
  EXPECT_EQ(std::count_if(soup.vertices.begin(), soup.vertices.end(),
                          [](const Point3& p) { return p.z == 7; }),
            0);
  EXPECT_EQ(complaints(compare_with_soup(boundary, soup)), "");
}

TEST(MeshComparison, ThickNeedleMustBeThere) {
  const Boundary boundary = evaluate(
      samples::unite({box({1, 1, 1}, {5, 5, 5}), box({2, 2, 4}, {Rational(201, 100), 3, 7})}));
  const auto soup = in_six_digits(evaluate(box({1, 1, 1}, {5, 5, 5})));
  EXPECT_NE(complaints(compare_with_soup(boundary, soup)).find("[2, 2, 7]"), std::string::npos);
}

TEST(MeshComparison, OwnNonManifoldEdgesAreAllowed) {
  const Boundary boundary =
      evaluate(samples::unite({box({0, 0, 0}, {1, 1, 1}), box({1, 1, 0}, {2, 2, 1})}));
  EXPECT_EQ(complaints(compare_with_soup(boundary, samples::soup_of(boundary))), "");
}

// The edge of the wedge lies in a face of the box: in the boundary it has two faces, and yet four
// facets of a conforming mesh meet there. Edges may also touch along a part of them.
TEST(MeshComparison, EdgesThatTouchFacesAndEdgesAreAllowed) {
  Polyhedron wedge;
  wedge.vertices = {{1, 1, 0}, {2, 0, 0}, {2, 2, 0}, {1, 1, 1}, {2, 0, 1}, {2, 2, 1}};
  wedge.facets = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  const Solid touching = samples::unite(
      {box({0, 0, 0}, {1, 2, 1}), Solid::primitive({make_convex_polytope(wedge), {}})});
  const Boundary boundary = evaluate(touching);
  io::PolygonSoup soup;
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 1}, {1, 0, 1},
                   {1, 1, 1}, {1, 2, 1}, {0, 2, 1}, {2, 0, 0}, {2, 2, 0}, {2, 0, 1}, {2, 2, 1}};
  soup.facets = {{0, 4, 3, 2, 1}, {5, 6, 7, 8, 9}, {0, 1, 6, 5},     {1, 2, 7, 6},
                 {2, 3, 8, 7},    {3, 4, 9, 8},    {4, 0, 5, 9},     {2, 11, 10},
                 {7, 12, 13},     {2, 10, 12, 7},  {10, 11, 13, 12}, {11, 2, 7, 13}};
  EXPECT_EQ(complaints(compare_with_soup(boundary, soup)), "");
  // A fin on that edge, of two facets without thickness, is none of the model's.
  soup.vertices.push_back({1, 1, 2});
  soup.facets.push_back({2, 7, 14});
  soup.facets.push_back({7, 2, 14});
  EXPECT_NE(complaints(compare_with_soup(boundary, soup)).find("6 facets at an edge: (1, 1, 0)"),
            std::string::npos);

  const Boundary shifted =
      evaluate(samples::unite({box({0, 0, 0}, {1, 1, 2}), box({1, 1, 1}, {2, 2, 3})}));
  EXPECT_EQ(complaints(compare_with_soup(shifted, samples::soup_of(shifted))), "");
}

TEST(MeshComparison, UnreadableFileFails) {
  const auto checks = compare_with_mesh_file(samples::plate_boundary(), "/no/such/file.stl");
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_EQ(checks.front().verdict, Verdict::Failed);
}

TEST(MeshComparison, OwnWriterPassesInEveryFormat) {
  const TemporaryFolder folder;
  for (const char* name : {"plate.off", "plate.stl", "plate.obj", "plate.ply"}) {
    const auto file = folder.path() / name;
    io::write_boundary(samples::plate_boundary(), file);
    EXPECT_EQ(complaints(compare_with_mesh_file(samples::plate_boundary(), file)), "") << name;
  }
}

}  // namespace
}  // namespace exactcsg::verify
