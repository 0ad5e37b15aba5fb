// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMC geometries from outside: classify and info. The places of the points follow from
// data/openmc/README.md.

#include <gtest/gtest.h>

#include <filesystem>

#include "cli/run_command.hpp"

namespace exactcsg::cli_test {
namespace {

std::string geometry(const std::string& name) {
  return std::string(EXACTCSG_SOURCE_DIR) + "/data/openmc/" + name + ".xml";
}

TEST(OpenMc, ClassifySaysCellAndPath) {
  const Finished finished =
      run_command({"classify", geometry("assembly_17x17"), "--points", "-"},
                  "# instrument tube, pin, between two elements, outside\n0 0 0\n1.26 0 0\n"
                  "0.63 0.1 0\n20 0 0\n");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(
      finished.out,
      "In cell 5, material 3; universe 0 > cell 10 > lattice 50 (8, 8) > universe 2 > cell 5\n"
      "In cell 1, material 1; universe 0 > cell 10 > lattice 50 (9, 8) > universe 1 > cell 1\n"
      "On the boundary of an element; universe 0 > cell 10 > lattice 50\n"
      "Gap; universe 0\n");
  EXPECT_EQ(finished.err, "");
}

TEST(OpenMc, ClassifyNamesOverlapsAndSharedBoundaries) {
  const Finished finished =
      run_command({"classify", geometry("assembly_17x17_overlap"), "--points", "-"},
                  "-1.7349995 0 0\n0.475 0 0\n");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.out,
            "Overlap of cells 143, 144; universe 0\nOn cells 145, 1000; universe 0\n");
}

TEST(OpenMc, CheckAnswersByItsExitCode) {
  const Finished clean = run_command({"check", geometry("assembly_17x17")});
  EXPECT_EQ(clean.exit_code, 0) << clean.err;
  EXPECT_NE(clean.out.find("\nclean: proved, "), std::string::npos) << clean.out;
  const Finished defect = run_command({"check", geometry("assembly_17x17_overlap")});
  EXPECT_EQ(defect.exit_code, 1) << defect.err;
  EXPECT_NE(defect.out.find("\noverlap of cells 143, 144\n  exactly  ("), std::string::npos)
      << defect.out;
  EXPECT_EQ(run_command({"check", geometry("pin_cell"), "--box", "0,0,0,1,1"}).exit_code, 2);
  EXPECT_EQ(run_command({"check", geometry("pin_cell"), "--box", "0,0,0,1,1,x"}).exit_code, 2);
  EXPECT_EQ(run_command({"check", geometry("pin_cell"), "--report", "report.pdf"}).exit_code, 2);
}

TEST(OpenMc, CheckLooksIntoTheBoxAndWritesReports) {
  const Folder folder;
  const std::string json = folder / "report.json";
  const std::string junit = folder / "report.xml";
  // The gap of pin_cell_missing_cell lies between the radii 0.4096 and 0.418.
  const Finished finished =
      run_command({"check", geometry("pin_cell_missing_cell"), "--box", "0.45,-0.1,-1,0.5,0.1,1",
                   "--report", json, "--report", junit});
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  EXPECT_TRUE(std::filesystem::exists(json));
  EXPECT_TRUE(std::filesystem::exists(junit));
}

TEST(OpenMc, InfoCounts) {
  const Finished finished = run_command({"info", geometry("turned_units")});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  for (const char* line : {"surfaces               9\n", "cells                  6\n",
                           "  of a universe        3\n", "rotations, rounded     1\n"}) {
    EXPECT_NE(finished.out.find(line), std::string::npos) << line << finished.out;
  }
}

TEST(OpenMc, ErrorsHaveTheirPlaceAndWarningsGoToStandardError) {
  const Folder folder;
  const std::string wrong = folder.write(
      "wrong.xml", "<geometry>\n<cell id=\"1\" material=\"1\" region=\"-7\"/></geometry>");
  const Finished refused = run_command({"info", wrong});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_NE(refused.err.find(wrong + ":2:35: error[E0110]: "), std::string::npos) << refused.err;
  const std::string odd =
      folder.write("odd.xml", "<geometry><cell id=\"1\" material=\"1\" regoin=\"-7\"/></geometry>");
  const Finished warned = run_command({"info", odd});
  EXPECT_EQ(warned.exit_code, 0);
  EXPECT_NE(warned.err.find(odd + ":1:37: warning: 'regoin' is not read"), std::string::npos)
      << warned.err;
  EXPECT_EQ(run_command({"info", folder / "none.xml"}).exit_code, 2);
}

}  // namespace
}  // namespace exactcsg::cli_test
