// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMC geometries from outside: measure, interference and contains. Expected values: closed forms
// and the distances of balls and cubes.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "cli/run_command.hpp"

namespace exactcsg::cli_test {
namespace {

using Json = nlohmann::json;

std::string geometry(const std::string& name) {
  return std::string(EXACTCSG_SOURCE_DIR) + "/data/openmc/" + name + ".xml";
}

// A ball of material 1 in void: cells 1 and 2.
std::string ball(const std::string& centre_and_radius) {
  return "<geometry><surface id='1' type='sphere' coeffs='" + centre_and_radius +
         "'/><surface id='2' type='sphere' coeffs='0 0 0 9' boundary='vacuum'/>"
         "<cell id='1' material='1' region='-1'/><cell id='2' material='void' region='1 -2'/>"
         "<cell id='3' material='void' region='2'/></geometry>";
}

TEST(MeasureGeometry, PrintsCellsAndMaterials) {
  const Finished finished = run_command({"measure", geometry("assembly_17x17")});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.err, "");
  EXPECT_NE(finished.out.find("\n1          1                    264 "), std::string::npos)
      << finished.out;
  EXPECT_NE(finished.out.find("material "), std::string::npos);
}

TEST(MeasureGeometry, WritesBoundsAsJson) {
  const Finished finished =
      run_command({"measure", geometry("pin_cell"), "--width", "1e-8", "--json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  const Json document = Json::parse(finished.out);
  EXPECT_EQ(document["schema"], "exactcsg.measure_geometry/1");
  const Json& fuel = document["cells"][0];
  EXPECT_EQ(fuel["id"], 1);
  EXPECT_EQ(fuel["instances"], 1);
  EXPECT_EQ(fuel["stop"], "width");
  const double lower = std::stod(fuel["volume"]["lower"].get<std::string>());
  const double upper = std::stod(fuel["volume"]["upper"].get<std::string>());
  const double expected = 20 * std::numbers::pi * 0.4096 * 0.4096;
  EXPECT_LE(lower, expected * (1 + 1e-15));
  EXPECT_GE(upper, expected * (1 - 1e-15));
  EXPECT_LE(upper - lower, 1.001e-8 * lower);
  EXPECT_EQ(document["materials"][0]["materials"][0], "void");
}

TEST(MeasureGeometry, UnboundedCellsAreSaidToBe) {
  const Folder folder;
  const Finished finished =
      run_command({"measure", folder.write("ball.xml", ball("0 0 0 1")), "--json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  const Json document = Json::parse(finished.out);
  EXPECT_EQ(document["cells"][2]["bounded"], false);
  EXPECT_TRUE(document["cells"][2]["volume"].is_null());
  EXPECT_EQ(document["cells"][0]["bounded"], true);
}

// A limit: bounds that hold, a warning, and exit code 1.
TEST(MeasureGeometry, ALimitGivesTheBoundsReached) {
  const Folder folder;
  const Finished finished = run_command({"measure", folder.write("ball.xml", ball("0 0 0 1")),
                                         "--width", "1e-30", "--time-limit", "1", "--json"});
  EXPECT_EQ(finished.exit_code, 1) << finished.err;
  EXPECT_NE(finished.err.find("a limit was reached"), std::string::npos) << finished.err;
  const Json cell = Json::parse(finished.out)["cells"][0];
  EXPECT_NE(cell["stop"], "width");
  const double expected = 4 * std::numbers::pi / 3;
  EXPECT_LE(std::stod(cell["volume"]["lower"].get<std::string>()), expected * (1 + 1e-15));
  EXPECT_GE(std::stod(cell["volume"]["upper"].get<std::string>()), expected * (1 - 1e-15));
}

constexpr const char* unit_cube = "cube(size = [1, 1, 1], center = false);\n";

// The ball touches the cube in its corner at (1, 0, 0); one moved by 1e-6 reaches into it.
TEST(CurvedInterference, TouchingIsNone) {
  const Folder folder;
  const std::string cube = folder.write("cube.csg", unit_cube);
  const std::string touching = folder.write("touching.xml", ball("2 0 0 1"));
  const Finished none = run_command({"interference", cube, touching});
  EXPECT_EQ(none.exit_code, 0) << none.err;
  EXPECT_EQ(none.out, "no interference: at most the boundaries meet\n");
  const std::string nearer = folder.write("nearer.xml", ball("1.999999 0.5 0.5 1"));
  const Finished some = run_command({"interference", nearer, cube});
  EXPECT_EQ(some.exit_code, 1) << some.err;
  EXPECT_EQ(some.out.find("interference: a part of "), 0U) << some.out;
  EXPECT_NE(some.out.find("exactly"), std::string::npos);
}

// The cube's corners are at sqrt(3)/2 = 0.866 from its centre.
TEST(CurvedInterference, ABallContainsACube) {
  const Folder folder;
  const std::string cube = folder.write("cube.csg", unit_cube);
  const std::string large = folder.write("large.xml", ball("0.5 0.5 0.5 0.867"));
  const std::string small = folder.write("small.xml", ball("0.5 0.5 0.5 0.865"));
  EXPECT_EQ(run_command({"contains", large, cube}).exit_code, 0);
  EXPECT_EQ(run_command({"contains", small, cube}).exit_code, 1);
  EXPECT_EQ(run_command({"contains", cube, large}).exit_code, 1);
  EXPECT_EQ(run_command({"contains", large, small}).exit_code, 0);
}

TEST(CurvedInterference, ACellIsNamedAfterTheFile) {
  const Folder folder;
  const std::string model = folder.write("ball.xml", ball("0 0 0 1"));
  // The ball and the void round it touch; both lie in the whole vacuum boundary's ball.
  EXPECT_EQ(run_command({"interference", model + "#1", model + "#2"}).exit_code, 0);
  EXPECT_EQ(run_command({"interference", model, model + "#1"}).exit_code, 1);
  EXPECT_EQ(run_command({"contains", model, model + "#1"}).exit_code, 0);
  const Finished unknown = run_command({"contains", model + "#7", model});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("E0110"), std::string::npos) << unknown.err;
  // Cell 3 is unbounded, and so is what it has in common with itself.
  const Finished unbounded = run_command({"interference", model + "#3", model + "#3"});
  EXPECT_EQ(unbounded.exit_code, 2);
  EXPECT_NE(unbounded.err.find("E0301"), std::string::npos) << unbounded.err;
}

// Pins of the assembly, by instances: fuel and cladding are apart; the lattice's cell holds both.
TEST(CurvedInterference, InstancesAreAllThere) {
  const std::string model = geometry("assembly_17x17");
  EXPECT_EQ(run_command({"interference", model + "#1", model + "#3"}).exit_code, 0);
  EXPECT_EQ(run_command({"contains", model + "#10", model + "#3"}).exit_code, 0);
}

// A tetrahedron with a face pushed in: a mesh that is not convex has no tree of half-spaces.
TEST(CurvedInterference, AMeshThatIsNotConvexIsRefused) {
  const Folder folder;
  const std::string mesh = folder.write(
      "notch.csg",
      "polyhedron(points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4], [0.5, 0.5, 0.5]], faces = "
      "[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 4], [3, 2, 4], [2, 1, 4]], convexity = 2);\n");
  const Finished finished =
      run_command({"interference", mesh, folder.write("ball.xml", ball("0 0 0 1"))});
  EXPECT_EQ(finished.exit_code, 2) << finished.out;
  EXPECT_NE(finished.err.find("E0207"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace exactcsg::cli_test
