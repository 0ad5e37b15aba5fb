// SPDX-License-Identifier: GPL-3.0-or-later
// What is made of OpenSCAD's answers. A script stands in for OpenSCAD: it hands out prepared files
// and messages, so the tests need no OpenSCAD and see what it does rarely.
//
// membrane.nef3, .off and .stl were written by OpenSCAD 2021.01 from membrane.csg: the unit cube
// [1,2] x [-1,0] x [0,1], and the L of area 3 in which two solids touch along the plane x = 1; the
// two have the edge (1,0,0) - (1,0,1) in common. corner_cut.nef3 likewise.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "exactcsg/verify/membranes.hpp"
#include "exactcsg/verify/openscad.hpp"
#include "exactcsg/verify/process.hpp"
#include "exactcsg/verify/verify.hpp"
#include "samples.hpp"

namespace exactcsg::verify {
namespace {

namespace fs = std::filesystem;
using samples::complaints;

const fs::path prepared = EXACTCSG_SOURCE_DIR "/tests/verify";

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// A program that answers `-o x.nef3 -o x.off -o x.stl` with the files of a folder.
class StandIn {
 public:
  explicit StandIn(const std::string& message = {}) {
    std::ofstream out(program());
    out << "#!/bin/sh\n"
        << "while [ $# -gt 0 ]; do\n"
        << "  if [ \"$1\" = -o ]; then cp '" << folder_.path().string()
        << "'/answer.\"${2##*.}\" \"$2\"; shift; fi\n"
        << "  shift\n"
        << "done\n"
        << "echo '" << message << "' >&2\n";
    out.close();
    fs::permissions(program(), fs::perms::owner_all);
  }
  fs::path answer(const std::string& ending) const { return folder_.path() / ("answer" + ending); }
  void copy_answer(const fs::path& file) const { fs::copy_file(file, answer(file.extension())); }
  void write_source(const std::string& text) const { std::ofstream(source()) << text; }

  // The whole comparison of the source; its own boundary is evaluated as written.
  std::vector<Check> compare() const {
    const io::Model model = io::read_model(source());
    OpenScadOptions options;
    options.program = program().string();
    return compare_with_openscad(model, evaluate(model.solid), source(), options);
  }

 private:
  fs::path program() const { return folder_.path() / "openscad"; }
  fs::path source() const { return folder_.path() / "model.csg"; }
  TemporaryFolder folder_;
};

std::string skips(const std::vector<Check>& checks) {
  std::string text;
  for (const Check& check : checks) {
    if (check.verdict == Verdict::Skipped) text += check.name + ": " + check.explanation + "\n";
  }
  return text;
}

bool has_passed(const std::vector<Check>& checks, const std::string& name) {
  const Check* check = samples::find(checks, name);
  return check != nullptr && check->verdict == Verdict::Passed;
}

constexpr auto manifold_warning =
    "WARNING: Object may not be a valid 2-manifold and may need repair!";

// ---- membranes and doubted exports --------------------------------------------------------------

void prepare_membrane(const StandIn& openscad) {
  openscad.write_source(read_text(prepared / "membrane.csg"));
  for (const char* name : {"membrane.nef3", "membrane.off", "membrane.stl"}) {
    openscad.copy_answer(prepared / name);
  }
}

TEST(OpenScadExports, MembranesAreComparedAndLeftOut) {
  const StandIn openscad(manifold_warning);
  prepare_membrane(openscad);
  const auto checks = openscad.compare();
  EXPECT_EQ(complaints(checks) + skips(checks), "");
  const Check* membranes = samples::find(checks, "openscad 3: off: membranes");
  ASSERT_NE(membranes, nullptr);
  EXPECT_EQ(membranes->theirs, "10 facets of 6");  // both sides of the L of area 3
  EXPECT_TRUE(has_passed(checks, "openscad 3: stl: area"));
}

// It goes on without a file that it does not find, so its answer is about another model.
TEST(OpenScadExports, AreNotHeardWithoutTheFilesThatTheModelNames) {
  const StandIn openscad(R"(WARNING: Can'"'"'t open import file)");  // quoted for the shell
  prepare_membrane(openscad);
  const auto checks = openscad.compare();
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_EQ(checks[0].verdict, Verdict::Skipped);
  EXPECT_NE(checks[0].explanation.find("Can't open import file"), std::string::npos);
}

// The file lacks one side of the membrane, or has a facet of the solid too many: not a membrane.
TEST(OpenScadExports, HalfAMembraneIsNotLeftOut) {
  const FacetComplex complex = parse_nef3(read_text(prepared / "membrane.nef3"));
  io::PolygonSoup soup = io::read_polygon_soup(prepared / "membrane.off");
  WeldedMesh whole = weld(soup, 0);
  EXPECT_EQ(take_out_membranes(complex, whole, "x").verdict, Verdict::Passed);
  EXPECT_EQ(whole.facets.size(), 12U);  // of the cube
  soup.facets.erase(soup.facets.begin());
  WeldedMesh half = weld(soup, 0);
  EXPECT_EQ(take_out_membranes(complex, half, "x").verdict, Verdict::Failed);
}

TEST(OpenScadExports, ADoubtedExportThatDiffersIsSkippedInItsOwnRow) {
  const StandIn openscad(manifold_warning);
  prepare_membrane(openscad);
  fs::remove(openscad.answer(".off"));
  io::write_boundary(samples::plate_boundary(), openscad.answer(".off"));
  const auto checks = openscad.compare();
  EXPECT_EQ(complaints(checks), "");
  const Check* off = samples::find(checks, "openscad 3: off");
  ASSERT_NE(off, nullptr);
  EXPECT_EQ(off->verdict, Verdict::Skipped);
  EXPECT_NE(off->explanation.find("may not be a valid 2-manifold"), std::string::npos);
  EXPECT_NE(off->explanation.find("openscad 3: off: volume"), std::string::npos);
  EXPECT_EQ(samples::find(checks, "openscad 3: off: volume"), nullptr);  // never as passed
  EXPECT_TRUE(has_passed(checks, "openscad 3: stl: volume"));

  Report report;
  report.checks = checks;
  const std::vector<std::string> required{"openscad"};
  require_oracles(report, required);
  EXPECT_EQ(report.overall(), Verdict::Failed);  // LAW report.1
}

TEST(OpenScadExports, WithoutTheWarningADifferentExportFails) {
  const StandIn openscad;
  prepare_membrane(openscad);
  fs::remove(openscad.answer(".off"));
  io::write_boundary(samples::plate_boundary(), openscad.answer(".off"));
  EXPECT_NE(complaints(openscad.compare()).find("openscad 3: off: volume"), std::string::npos);
}

// ---- models that cannot be read under OpenSCAD's rounding ---------------------------------------

// A prism over an L whose faces of four and six corners are not planar once turned and cut, and a
// cube that crosses it.
constexpr auto tilted_prism = R"(union() {
multmatrix([[0.866025, -0.433013, 0.25, 0.1], [0.5, 0.75, -0.433013, 0.2],
            [0, 0.5, 0.866025, 0.3], [0, 0, 0, 1]]) {
polyhedron(points = [[0,0,0],[3,0,0],[3,1,0],[1,1,0],[1,2,0],[0,2,0],
                     [0,0,1],[3,0,1],[3,1,1],[1,1,1],[1,2,1],[0,2,1]],
           faces = [[0,1,2,3,4,5],[11,10,9,8,7,6],[6,7,1,0],[7,8,2,1],[8,9,3,2],[9,10,4,3],
                    [10,11,5,4],[11,6,0,5]]);
}
cube(size = [1, 1, 1], center = false);
})";

io::PolygonSoup moved(io::PolygonSoup soup, const Rational& shift) {
  for (Point3& p : soup.vertices) p.x += shift;
  return soup;
}

void write_off(const io::PolygonSoup& soup, const fs::path& file) {
  std::ofstream out(file);
  out << "OFF " << soup.vertices.size() << ' ' << soup.facets.size() << " 0\n";
  for (const Point3& p : soup.vertices) {
    out << fmt::format("{:.6g} {:.6g} {:.6g}\n", nearest_double(p.x), nearest_double(p.y),
                       nearest_double(p.z));
  }
  for (const auto& facet : soup.facets) {
    out << facet.size();
    for (const std::uint32_t v : facet) out << ' ' << v;
    out << '\n';
  }
}

// OpenSCAD's exports are the model's own boundary here, each vertex moved by `shift` along x.
std::vector<Check> compare_tilted_prism(const Rational& shift) {
  const StandIn openscad;
  openscad.write_source(tilted_prism);
  openscad.copy_answer(prepared / "corner_cut.nef3");  // only has to be readable
  const auto soup = samples::soup_of(evaluate(io::read_openscad_csg(tilted_prism, "x.csg").solid));
  write_off(moved(soup, shift), openscad.answer(".off"));
  const Boundary cube = evaluate(samples::box({0, 0, 0}, {1, 1, 1}));
  io::write_boundary(cube, openscad.answer(".stl"));
  return openscad.compare();
}

TEST(OpenScadWithoutGrid, TheExportsAreComparedAllTheSame) {
  const auto checks = compare_tilted_prism(Rational(1, 1 << 20));
  EXPECT_EQ(complaints(checks), "");
  for (const char* name : {"openscad 1: equal", "openscad 2: as written"}) {
    const Check* check = samples::find(checks, name);
    ASSERT_NE(check, nullptr);
    EXPECT_EQ(check->verdict, Verdict::Skipped);
    EXPECT_NE(check->explanation.find("E0104"), std::string::npos) << check->explanation;
  }
  for (const char* what :
       {"closed", "manifold", "oriented", "volume", "area", "vertices", "edges"}) {
    EXPECT_TRUE(has_passed(checks, std::string("openscad 3: off: ") + what)) << what;
  }
}

TEST(OpenScadWithoutGrid, WhatDiffersIsUndecided) {
  const auto checks = compare_tilted_prism(Rational(1, 10));
  EXPECT_EQ(complaints(checks), "");
  for (const char* name : {"openscad 3: off", "openscad 3: stl"}) {  // moved; another solid
    const Check* check = samples::find(checks, name);
    ASSERT_NE(check, nullptr) << name;
    EXPECT_EQ(check->verdict, Verdict::Skipped);
    EXPECT_NE(check->explanation.find("undecided"), std::string::npos) << check->explanation;
  }
  EXPECT_EQ(std::count_if(checks.begin(), checks.end(),
                          [](const Check& c) { return c.verdict == Verdict::Passed; }),
            0);
}

}  // namespace
}  // namespace exactcsg::verify
