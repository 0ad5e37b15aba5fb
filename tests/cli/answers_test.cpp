// SPDX-License-Identifier: GPL-3.0-or-later
// The command from outside: answers against closed forms, exit codes, what goes to stdout and what
// to stderr.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "cli/run_command.hpp"
#include "exactcsg/support/sanitizer.hpp"

namespace exactcsg::cli_test {
namespace {

using Json = nlohmann::json;

Json measure(const std::string& file, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"measure", file, "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Finished finished = run_command(arguments);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  return Json::parse(finished.out, nullptr, false);
}

// A cube of 3 less the corner cube of 1 at the origin: volume 26, area 54 (the notch hides and adds
// three unit squares); 8 - 1 + 7 vertices, 12 + 9 edges, 6 + 3 faces. Centre of mass by symmetry on
// the diagonal: (27 * 3/2 - 1/2) / 26 = 20/13.
constexpr const char* notched =
    "difference() {\n\tcube(size = [3, 3, 3], center = false);\n"
    "\tcube(size = [1, 1, 1], center = false);\n}\n";

TEST(Measure, JsonOfTheNotchedCube) {
  const Folder folder;
  const Json m = measure(folder.write("notched.csg", notched));
  EXPECT_EQ(m["schema"], "exactcsg.measure/1");
  EXPECT_EQ(m["volume"]["decimal"], "26");
  EXPECT_EQ(m["volume"]["exact"], "26");
  EXPECT_EQ(m["area"]["decimal"], "54");
  // 20/13 = 1.538461 538461 538461 ..., to 17 digits
  EXPECT_EQ(m["centroid"],
            Json({"1.5384615384615385", "1.5384615384615385", "1.5384615384615385"}));
  EXPECT_EQ(m["bounding_box"]["lower"], Json({"0", "0", "0"}));
  EXPECT_EQ(m["bounding_box"]["upper"], Json({"3", "3", "3"}));
  EXPECT_EQ(m["vertices"], 14);
  EXPECT_EQ(m["edges"], 21);
  EXPECT_EQ(m["faces"], 9);
  EXPECT_EQ(m["components"], 1);
  EXPECT_EQ(m["genus"], 0);
  EXPECT_EQ(m["primitives"], 2);
  EXPECT_TRUE(m["seconds"].is_number());
  EXPECT_TRUE(std::regex_match(m["digest"].get<std::string>(), std::regex("[0-9a-f]{64}")));
  for (const char* tier : {"symbolic", "double", "fixed", "unbounded"}) {
    EXPECT_TRUE(m["stats"]["tiers"][tier]["answers"].is_number_unsigned()) << tier;
  }
  EXPECT_TRUE(m["stats"]["cells"].is_number_unsigned());
  EXPECT_TRUE(m["stats"]["pieces"].is_number_unsigned());
}

// 20/13 again, with a number of digits that the user chose.
TEST(Measure, DigitsAreCorrectlyRounded) {
  const Folder folder;
  const std::string file = folder.write("notched.csg", notched);
  EXPECT_EQ(measure(file, {"--digits", "4"})["centroid"][0], "1.538");
  EXPECT_EQ(measure(file, {"--digits", "5"})["centroid"][0], "1.5385");
  EXPECT_EQ(measure(file, {"--digits", "40"})["centroid"][0],
            "1.538461538461538461538461538461538461538");
}

// A centred cube has its centre of mass at exactly 0, which no enclosure of positive width shows.
TEST(Measure, ZeroIsZero) {
  const Folder folder;
  const Json m = measure(folder.write("cube.csg", "cube(size = [1, 2, 3], center = true);\n"));
  EXPECT_EQ(m["centroid"], Json({"0", "0", "0"}));
  EXPECT_EQ(m["bounding_box"]["lower"], Json({"-0.5", "-1", "-1.5"}));
}

TEST(Measure, TheEmptySolid) {
  const Folder folder;
  const std::string file =
      folder.write("empty.csg",
                   "intersection() { cube(size = 1); multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0]]) "
                   "{ cube(size = 1); } }\n");
  const Json m = measure(file);
  EXPECT_EQ(m["volume"]["decimal"], "0");
  EXPECT_EQ(m["volume"]["exact"], "0");
  EXPECT_TRUE(m["centroid"].is_null());
  EXPECT_TRUE(m["bounding_box"].is_null());
  EXPECT_EQ(m["vertices"], 0);
}

// Menger sponge of level 1 with side 3: volume 27 * 20/27 = 20, area 9 * (2 * 20/9 + 4 * 8/9) = 72,
// genus 5 (closed forms).
TEST(Measure, MengerSponge) {
  const Json m = measure(model("menger_1"));
  EXPECT_EQ(m["volume"]["exact"], "20");
  EXPECT_EQ(m["area"]["decimal"], "72");
  EXPECT_EQ(m["genus"], 5);
}

// LAW boundary.1: the number of threads does not change the solid.
TEST(Measure, ThreadsDoNotMatter) {
  const Json one = measure(model("bracket"), {"--threads", "1"});
  const Json two = measure(model("bracket"), {"--threads", "2"});
  for (const char* key : {"digest", "volume", "area", "centroid", "vertices", "edges", "faces"}) {
    EXPECT_EQ(one[key], two[key]) << key;
  }
}

TEST(Measure, TextNamesEveryFigure) {
  const Folder folder;
  const Finished finished = run_command({"measure", folder.write("notched.csg", notched)});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.err, "");
  for (const char* row :
       {"volume           26\n", "area             54\n", "genus            0\n"}) {
    EXPECT_NE(finished.out.find(row), std::string::npos) << finished.out;
  }
}

// Several models: the answers that each alone has, in the order asked for.
TEST(Measure, SeveralModels) {
  const std::vector<std::string> files{model("bracket"), model("menger_1"), model("bracket")};
  const Finished finished = run_command({"measure", "--json", files[0], files[1], files[2]});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.err, "");
  std::istringstream lines(finished.out);
  for (const std::string& file : files) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    Json ours = Json::parse(line, nullptr, false);
    Json alone = measure(file);
    EXPECT_EQ(ours["model"], file);
    ours.erase("seconds");
    alone.erase("seconds");
    EXPECT_EQ(ours, alone);
  }
  EXPECT_EQ(lines.peek(), std::istringstream::traits_type::eof());
}

TEST(Measure, OneOfSeveralIsRefused) {
  const Folder folder;
  const std::string good = folder.write("cube.csg", "cube(size = 2, center = false);\n");
  const std::string bad = folder.write("bad.csg", "cube(size = 2\n");
  const Finished finished = run_command({"measure", bad, folder / "none.csg", good});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_NE(finished.err.find("error[E0102]"), std::string::npos) << finished.err;
  EXPECT_NE(finished.err.find("error[E0002]"), std::string::npos) << finished.err;
  EXPECT_NE(finished.out.find("volume           8\n"), std::string::npos) << finished.out;
}

TEST(Classify, FacesEdgesVerticesInsideAndOutside) {
  const Folder folder;
  const std::string file = folder.write("notched.csg", notched);
  // On: a face, an edge, a corner, the notch's inner corner. Fractions and decimals mean
  // themselves: 1/3 lies on no face, 0.1 + a bit is in the notch.
  const std::string points =
      "2 2 2\n"
      "0.5 0.5 0.5\n"
      "3 1.5 1.5\n"
      "3 3 3/2\n"
      "# a comment, and a blank line\n\n"
      "  3\t3 3\r\n"
      "1 1 1\n"
      "1/3 1/3 1\n"
      "1/3 1/3 1.0000000000000000000000000001\n"
      "3.0000000000000000000000000001 1 1\n"
      "-1 1e-3 2";
  const std::string expected = "In\nOut\nOn\nOn\nOn\nOn\nOn\nIn\nOut\nOut\n";
  const std::string list = folder.write("points.txt", points);
  EXPECT_EQ(run_command({"classify", file, "--points", list}).out, expected);
  EXPECT_EQ(run_command({"classify", file, "--points", "-"}, points).out, expected);
  // One at a time: without the retained decomposition.
  EXPECT_EQ(run_command({"classify", file, "--points", "-"}, "1 1 1\n").out, "On\n");
}

TEST(Classify, MalformedPointsArePlaced) {
  const Folder folder;
  const std::string file = folder.write("cube.csg", "cube(size = 1);\n");
  const struct {
    const char* text;
    const char* place;
  } cases[] = {
      {"0 0 0\n1 2\n", ":2:4: error[E0101]"},       {"0 0 x\n", ":1:5: error[E0101]"},
      {"0 0 0 0\n", ":1:7: error[E0101]"},          {"\n\n1,2,3\n", ":3:1: error[E0101]"},
      {"0 nan 0\n", ":1:3: error[E0101]"},          {"0 0 inf\n", ":1:5: error[E0101]"},
      {"1/0 0 0\n", ":1:1: error[E0101]"},          {"0 1e99999 0\n", ":1:3: error[E0106]"},
      {"0 0 1e5000000000\n", ":1:5: error[E0106]"},
  };
  for (const auto& [text, place] : cases) {
    const std::string list = folder.write("points.txt", text);
    const Finished finished = run_command({"classify", file, "--points", list});
    EXPECT_EQ(finished.exit_code, 2) << text;
    EXPECT_EQ(finished.out, "") << text;
    EXPECT_NE(finished.err.find(list + place), std::string::npos) << text << finished.err;
  }
  EXPECT_EQ(run_command({"classify", file, "--points", folder / "none"}).exit_code, 2);
}

// The same L-shaped block twice: as a difference and as a union of three boxes (by eye: what
// remains of 2 x 2 x 1 after the corner 1 x 1 x 1 is gone).
// The point that a command prints, as classify takes it.
std::string witness_of(const std::string& output) {
  std::smatch match;
  if (!std::regex_search(output, match, std::regex("exactly +\\((.*)\\)"))) return "no witness";
  std::string point = match[1];
  point.erase(std::remove(point.begin(), point.end(), ','), point.end());
  return point;
}

TEST(Equal, TwoWaysToWriteOneSolid) {
  const Folder folder;
  const std::string first =
      folder.write("a.csg", "difference() { cube(size = [2, 2, 1]); cube(size = [1, 1, 1]); }\n");
  const std::string second = folder.write(
      "b.csg",
      "union() { multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(size = [1, 2, 1]); "
      "}\n"
      "multmatrix([[1,0,0,0],[0,1,0,1],[0,0,1,0],[0,0,0,1]]) { cube(size = [1, 1, 1]); } }\n");
  const Finished finished = run_command({"equal", first, second});
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
}

// A cut of 1e-9 is a difference, and the witness shows where: below the top, above the cut.
TEST(Equal, ACutOfOneBillionth) {
  const Folder folder;
  const std::string first = folder.write("a.csg", "cube(size = [1, 1, 1]);\n");
  const std::string second = folder.write("b.csg", "cube(size = [1, 1, 0.999999999]);\n");
  const Finished finished = run_command({"equal", first, second});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.out.find("a point lies in " + first + " and outside " + second),
            std::string::npos)
      << finished.out;
  // The witness, given back to classify, is as claimed.
  const std::string point = witness_of(finished.out);
  EXPECT_EQ(run_command({"classify", first, "--points", "-"}, point).out, "In\n");
  EXPECT_EQ(run_command({"classify", second, "--points", "-"}, point).out, "Out\n");
  // The other way round it lies in the second.
  const Finished turned = run_command({"equal", second, first});
  EXPECT_EQ(turned.exit_code, 1);
  EXPECT_NE(turned.out.find("a point lies in " + first), std::string::npos);
}

// Unit cubes, the second moved along x.
std::string moved_cube(const Folder& folder, const std::string& name, const std::string& by) {
  return folder.write(name, "multmatrix([[1,0,0," + by +
                                "],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(size = [1, 1, 1]); }\n");
}

TEST(Interference, TouchingIsNone) {
  const Folder folder;
  const std::string one = moved_cube(folder, "a.csg", "0");
  const Finished touching = run_command({"interference", one, moved_cube(folder, "b.csg", "1")});
  EXPECT_EQ(touching.exit_code, 0) << touching.out;
  EXPECT_EQ(touching.out, "no interference: at most the boundaries meet\n");
}

// An overlap of 1e-9 in one direction, of 1 in the others.
TEST(Interference, OfOneBillionth) {
  const Folder folder;
  const std::string one = moved_cube(folder, "a.csg", "0");
  const std::string two = moved_cube(folder, "b.csg", "0.999999999");
  const Finished finished = run_command({"interference", one, two});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.out.find("of volume 1e-09;"), std::string::npos) << finished.out;
  const std::string point = witness_of(finished.out);
  EXPECT_EQ(run_command({"classify", one, "--points", "-"}, point).out, "In\n");
  EXPECT_EQ(run_command({"classify", two, "--points", "-"}, point).out, "In\n");
}

TEST(Contains, ASolidThatReachesTheBoundary) {
  const Folder folder;
  const std::string cube = folder.write("cube.csg", "cube(size = [3, 3, 3]);\n");
  const std::string inside = folder.write("notched.csg", notched);
  EXPECT_EQ(run_command({"contains", cube, inside}).exit_code, 0);
  EXPECT_EQ(run_command({"contains", cube, cube}).exit_code, 0);
  // What lies outside is the notch: a unit cube.
  const Finished not_contained = run_command({"contains", inside, cube});
  EXPECT_EQ(not_contained.exit_code, 1);
  EXPECT_NE(not_contained.out.find("of volume 1;"), std::string::npos) << not_contained.out;
  const std::string point = witness_of(not_contained.out);
  EXPECT_EQ(run_command({"classify", cube, "--points", "-"}, point).out, "In\n");
  EXPECT_EQ(run_command({"classify", inside, "--points", "-"}, point).out, "Out\n");
}

// What is written is read back as the same solid: integers are exact in every format.
TEST(BoundaryFile, ReadsBackAsTheSameSolid) {
  const Folder folder;
  const std::string file = folder.write("notched.csg", notched);
  for (const char* name : {"out.off", "out.stl", "out.obj", "out.ply"}) {
    const std::string mesh = folder / name;
    const Finished written = run_command({"boundary", file, "-o", mesh});
    EXPECT_EQ(written.exit_code, 0) << written.err;
    const Finished same = run_command({"equal", file, mesh});
    EXPECT_EQ(same.exit_code, 0) << name << same.out << same.err;
  }
}

// Doubles keep two plates apart whose gap is 1e-9 at x = 1000, single precision does not: their
// facing sides fall together there.
TEST(BoundaryFile, SaysWhatRoundingMadeOfTheSurface) {
  const Folder folder;
  const std::string file =
      folder.write("gap.csg",
                   "cube(size = [1000, 1, 1]);\n"
                   "multmatrix([[1,0,0,1000.000000001],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {\n"
                   "  cube(size = [1, 1, 1]);\n}\n");
  const Finished exact = run_command({"boundary", file, "-o", folder / "gap.off"});
  EXPECT_EQ(exact.exit_code, 0) << exact.err;
  EXPECT_NE(exact.out.find("the rounded surface bounds a solid, in 2 pieces"), std::string::npos);
  const Finished single = run_command({"boundary", file, "-o", folder / "gap.stl"});
  EXPECT_EQ(single.exit_code, 0) << single.err;
  EXPECT_NE(single.err.find("warning: the rounded surface"), std::string::npos) << single.err;
  const Finished unchecked =
      run_command({"boundary", file, "-o", folder / "gap.stl", "--no-check"});
  EXPECT_EQ(unchecked.err.find("the rounded surface"), std::string::npos) << unchecked.err;
}

TEST(BoundaryFile, NothingIsLeftBehindByAFailure) {
  const Folder folder;
  const std::string file = folder.write("cube.csg", "cube(size = 1);\n");
  EXPECT_EQ(run_command({"boundary", file, "-o", folder / "out.step"}).exit_code, 2);
  EXPECT_EQ(run_command({"boundary", file, "-o", folder / "none/out.off"}).exit_code, 2);
  std::filesystem::create_directory(folder / "folder.off");
  const Finished finished = run_command({"boundary", file, "-o", folder / "folder.off"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_NE(finished.err.find("error[E0003]"), std::string::npos) << finished.err;
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(Edges, SvgAndJson) {
  const Folder folder;
  const std::string file = folder.write("notched.csg", notched);
  EXPECT_EQ(run_command({"edges", file, "-o", folder / "e.json"}).exit_code, 0);
  const Json edges = Json::parse(read_text(folder / "e.json"));
  EXPECT_EQ(edges["schema"], "exactcsg.edges/1");
  EXPECT_EQ(edges["vertices"].size(), 14U);
  EXPECT_EQ(edges["edges"].size(), 21U);
  EXPECT_EQ(run_command({"edges", file, "-o", folder / "e.svg"}).exit_code, 0);
  const std::string svg = read_text(folder / "e.svg");
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  // Each edge once in each of four views. The folder's name, which is random, comes before.
  const auto drawing = svg.begin() + static_cast<std::ptrdiff_t>(svg.find("<path"));
  EXPECT_EQ(std::count(drawing, svg.end(), 'M'), 4 * 21);
  EXPECT_EQ(run_command({"edges", file, "-o", folder / "e.png"}).exit_code, 2);
}

TEST(Golden, RecordThenCheckThenAChange) {
  const Folder folder;
  folder.write("notched.csg", notched);
  const std::string golden = folder / "golden.json";
  // A missing file is a failure, never a fresh recording.
  EXPECT_EQ(run_command({"golden", "check", golden}).exit_code, 2);
  const Finished recorded =
      run_command({"golden", "record", golden, "--source", "closed form 27 - 1"});
  EXPECT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_EQ(run_command({"golden", "check", golden}).exit_code, 0);
  // One digit of the record changed.
  std::string text = read_text(golden);
  const auto at = text.find("\"26\"");
  ASSERT_NE(at, std::string::npos) << text;
  folder.write("golden.json", text.replace(at, 4, "\"27\""));
  EXPECT_EQ(run_command({"golden", "check", golden}).exit_code, 1);
  EXPECT_EQ(run_command({"golden", "record", golden, "--source", "again"}).exit_code, 0);
  // A model without an entry, and an entry without a model.
  const std::string other = folder.write("other.csg", "cube(size = 1);\n");
  EXPECT_EQ(run_command({"golden", "check", golden}).exit_code, 1);
  EXPECT_EQ(run_command({"golden", "check", golden, other}).exit_code, 1);
  EXPECT_EQ(run_command({"golden", "check", golden, folder / "notched.csg"}).exit_code, 0);
  std::filesystem::remove(other);
  std::filesystem::remove(folder / "notched.csg");
  EXPECT_EQ(run_command({"golden", "check", golden}).exit_code, 1);
}

TEST(Info, CountsWhatTheFileHolds) {
  const Folder folder;
  const Finished finished = run_command({"info", folder.write("notched.csg", notched)});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_TRUE(std::regex_search(finished.out, std::regex("primitives +2\n"))) << finished.out;
  EXPECT_TRUE(std::regex_search(finished.out, std::regex("differences +1\n"))) << finished.out;
  EXPECT_TRUE(std::regex_search(finished.out, std::regex("facets of primitives +12\n")))
      << finished.out;
}

TEST(Info, NamesTheFontsOfText) {
  const Folder folder;
  const Finished finished = run_command(
      {"info", folder.write("word.csg", "linear_extrude(height = 1) { text(text = \"a\"); }\n")});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_TRUE(std::regex_search(
      finished.out, std::regex("font +Liberation Sans:style=Regular: Liberation Sans Regular, "
                               "Version .*LiberationSans-Regular.ttf\n")))
      << finished.out;
}

TEST(Usage, WrongCommandLinesExitWith2) {
  const Folder folder;
  const std::string file = folder.write("cube.csg", "cube(size = 1);\n");
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"measur", file},
      {"measure"},
      {"measure", file, "--digits", "0"},
      {"measure", file, "--digits", "many"},
      {"measure", file, "--jsn"},
      {"info", file, file},
      {"measure", file, "--threads", "-1"},
      {"measure", file, "--time-limit", "-1"},
      {"measure", file, "--memory-limit", "much"},
      {"classify", file},
      {"equal", file},
      {"boundary", file},
      {"edges", file},
      {"golden"},
      {"golden", "forget", file},
      {"verify", file, "--require", "oracle_of_delphi"},
      {"verify", file, "--budget", "-3"},
  };
  for (const auto& arguments : wrong) {
    const Finished finished = run_command(arguments);
    EXPECT_EQ(finished.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_EQ(finished.out, "") << testing::PrintToString(arguments);
    EXPECT_NE(finished.err.find("error[E0001]"), std::string::npos)
        << testing::PrintToString(arguments) << finished.err;
  }
}

TEST(Usage, HelpAndVersionGoToStdout) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"verify", "--help"}, {"--version"}}) {
    const Finished finished = run_command(arguments);
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_NE(finished.out, "");
    EXPECT_EQ(finished.err, "");
  }
  EXPECT_TRUE(std::regex_match(run_command({"--version"}).out,
                               std::regex("exactcsg [0-9]+\\.[0-9]+\\.[0-9]+\n")));
}

// Warnings go to stderr, and --quiet takes them away; the answer is the same.
TEST(Usage, WarningsAndQuiet) {
  const Folder folder;
  const std::string file = folder.write("odd.csg", "cube(size = [1, 1, 1], colour = \"red\");\n");
  const Finished loud = run_command({"measure", file, "--json"});
  const Finished quiet = run_command({"measure", file, "--json", "--quiet"});
  EXPECT_EQ(loud.exit_code, 0);
  EXPECT_NE(loud.err.find(file + ":1:24: warning: "), std::string::npos) << loud.err;
  EXPECT_EQ(quiet.err, "");
  EXPECT_EQ(Json::parse(loud.out)["digest"], Json::parse(quiet.out)["digest"]);
}

// A model that takes longer than a hundredth of a second is given up with the error of the limit.
TEST(Limits, Time) {
  const auto start = std::chrono::steady_clock::now();
  const Finished finished = run_command({"measure", model("menger_4"), "--time-limit", "0.01"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_EQ(finished.out, "");
  EXPECT_NE(finished.err.find("error[E0803]"), std::string::npos) << finished.err;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(Limits, Memory) {
  if (has_shadow_memory) GTEST_SKIP() << "sanitizers need address space of their own";
  const Finished finished = run_command({"measure", model("menger_4"), "--memory-limit", "24M"});
  EXPECT_EQ(finished.exit_code, 2) << finished.err;
  EXPECT_EQ(finished.out, "");
  EXPECT_NE(finished.err.find("error[E0805]"), std::string::npos) << finished.err;
}

TEST(Verify, AGreenAndARedVerdict) {
  const Folder folder;
  const std::string file = folder.write("notched.csg", notched);
  const std::string mesh = folder / "notched.stl";
  ASSERT_EQ(run_command({"boundary", file, "-o", mesh}).exit_code, 0);
  const std::string json = folder / "report.json";
  const Finished green = run_command({"verify", file, "--against", mesh, "--require", "nef",
                                      "--without", "openscad", "--report", json, "--report",
                                      folder / "report.xml", "--report", folder / "report.html"});
  EXPECT_EQ(green.exit_code, 0) << green.out << green.err;
  EXPECT_EQ(Json::parse(read_text(json))["schema"], "exactcsg.verify/1");
  EXPECT_NE(read_text(folder / "report.xml").find("<testsuite"), std::string::npos);
  EXPECT_NE(read_text(folder / "report.html").find("<html"), std::string::npos);
  // The mesh of another model: the notch is a little deeper. The place is named.
  const std::string changed = folder.write(
      "changed.csg", "difference() { cube(size = [3, 3, 3]); cube(size = [1, 1, 1.0625]); }\n");
  const std::string other = folder / "changed.stl";
  ASSERT_EQ(run_command({"boundary", changed, "-o", other}).exit_code, 0);
  const Finished red =
      run_command({"verify", file, "--against", other, "--without", "openscad,nef"});
  EXPECT_EQ(red.exit_code, 1) << red.out;
  EXPECT_NE(red.out.find("1.0625"), std::string::npos) << red.out;
}

}  // namespace
}  // namespace exactcsg::cli_test
