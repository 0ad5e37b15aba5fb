// SPDX-License-Identifier: GPL-3.0-or-later
// MCNP input files from outside: every command that takes geometries takes them by their ending.
// What is expected follows from data/mcnp/README.md.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/run_command.hpp"

namespace exactcsg::cli_test {
namespace {

std::string deck(const std::string& name) {
  return std::string(EXACTCSG_SOURCE_DIR) + "/data/mcnp/" + name;
}

bool has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(Mcnp, CheckAnswersByItsExitCode) {
  const Finished clean = run_command({"check", deck("nozzle.inp")});
  EXPECT_EQ(clean.exit_code, 0) << clean.err;
  const Finished overlap = run_command({"check", deck("room_with_window_overlap.mcnp")});
  EXPECT_EQ(overlap.exit_code, 1) << overlap.err;
  EXPECT_TRUE(has(overlap.out, "\noverlap of cells 2, 3\n  exactly  (")) << overlap.out;
  const Finished gap = run_command({"check", deck("pin_cell_gap.mcnp")});
  EXPECT_EQ(gap.exit_code, 1) << gap.err;
  EXPECT_TRUE(has(gap.out, "\ngap between the cells of universe 0\n")) << gap.out;
}

// The elements are numbered as in the file.
TEST(Mcnp, ClassifySaysCellAndPath) {
  const Finished finished = run_command({"classify", deck("assembly_17x17.mcnp"), "--points", "-"},
                                        "0 0 0\n1.26 -2.52 0\n20 0 0\n");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  const std::string path = "universe 0 > cell 10 > universe 5 > cell 50 > lattice 50 ";
  EXPECT_EQ(finished.out, "In cell 5, material 3; " + path + "(0, 0) > universe 2 > cell 5\n" +
                              "In cell 1, material 1; " + path + "(1, -2) > universe 1 > cell 1\n" +
                              "In cell 99, material void; universe 0 > cell 99\n");
}

TEST(Mcnp, MeasureInfoContainsAndInterferenceTakeDecks) {
  EXPECT_TRUE(
      has(run_command({"info", deck("pin_cell.mcnp")}).out, "\ncells                  5\n"));
  const Finished measured = run_command({"measure", deck("pin_cell.mcnp"), "--width", "1e-3"});
  EXPECT_EQ(measured.exit_code, 0) << measured.err;
  EXPECT_TRUE(has(measured.out, "unbounded")) << measured.out;
  const std::string xml = std::string(EXACTCSG_SOURCE_DIR) + "/data/openmc/pin_cell.xml#1";
  EXPECT_EQ(run_command({"contains", xml, deck("pin_cell.mcnp#1")}).exit_code, 0);
  EXPECT_EQ(run_command({"contains", deck("pin_cell.mcnp#1"), xml}).exit_code, 0);
  EXPECT_EQ(run_command({"interference", xml, deck("pin_cell.mcnp#2")}).exit_code, 0);
  EXPECT_EQ(run_command({"interference", xml, deck("pin_cell.mcnp#1")}).exit_code, 1);
}

TEST(Mcnp, FaultsAreRefusedWithTheirPlace) {
  const Folder folder;
  const std::string file = folder / "wrong.i";
  std::ofstream(file) << "title\n1 0 -1\n\n1 ball 3\n";
  const Finished finished = run_command({"check", file});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_TRUE(has(finished.err, "wrong.i:4:3: error[E0103]")) << finished.err;
}

}  // namespace
}  // namespace exactcsg::cli_test
