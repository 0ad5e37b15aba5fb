// SPDX-License-Identifier: GPL-3.0-or-later
// --fill and boundary --snap from outside, by closed forms.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/run_command.hpp"
#include "two_cubes.hpp"

namespace exactcsg::cli_test {
namespace {

using test::two_cubes;

TEST(Fill, SaysWhatIsInside) {
  const Folder folder;
  const std::string file = folder.write("cubes.off", two_cubes);
  const Finished refused = run_command({"measure", file});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("E0206"), std::string::npos);
  EXPECT_NE(refused.err.find("--fill"), std::string::npos);
  for (const auto& [rule, volume] :
       {std::pair{"nonzero", "15"}, std::pair{"positive", "15"}, std::pair{"even-odd", "14"}}) {
    const Finished filled = run_command({"measure", file, "--json", "--fill", rule});
    ASSERT_EQ(filled.exit_code, 0) << filled.err;
    EXPECT_EQ(nlohmann::json::parse(filled.out)["volume"]["exact"], volume);
    EXPECT_NE(filled.err.find(rule), std::string::npos) << filled.err;
  }
  EXPECT_EQ(run_command({"measure", file, "--fill", "winding"}).exit_code, 2);
  const std::string both = folder.write("both.csg",
                                        "union() {\n cube(size = 2);\n"
                                        " multmatrix([[1,0,0,1],[0,1,0,1],[0,0,1,1],[0,0,0,1]]) {\n"
                                        "  cube(size = 2);\n }\n}\n");
  EXPECT_EQ(run_command({"equal", file, both, "--fill", "nonzero"}).exit_code, 0);
  EXPECT_EQ(run_command({"equal", file, both, "--fill", "even-odd"}).exit_code, 1);
  const std::string mesh = folder / "filled.off";
  ASSERT_EQ(run_command({"boundary", file, "-o", mesh, "--fill", "nonzero"}).exit_code, 0);
  EXPECT_EQ(run_command({"equal", mesh, both}).exit_code, 0);
}

TEST(Snap, WritesASurfaceThatBoundsASolid) {
  const Folder folder;
  const std::string file = model("near_coplanar_turns");
  const Finished plain = run_command({"boundary", file, "-o", folder / "plain.stl"});
  EXPECT_NE(plain.err.find("bounds no solid"), std::string::npos) << plain.err;
  const Finished snapped = run_command({"boundary", file, "-o", folder / "out.stl", "--snap"});
  EXPECT_EQ(snapped.exit_code, 0) << snapped.err;
  EXPECT_NE(snapped.out.find("the rounded surface bounds a solid"), std::string::npos)
      << snapped.out;
  EXPECT_EQ(run_command({"measure", folder / "out.stl"}).exit_code, 0);
  EXPECT_EQ(
      run_command({"boundary", file, "-o", folder / "b.stl", "--snap", "--no-check"}).exit_code, 2);
}

TEST(Snap, WritesNothingOfABodyThatVanishes) {
  const Folder folder;
  const std::string file =
      folder.write("plate.csg",
                   "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,1000],[0,0,0,1]]) {\n"
                   "  cube(size = [1, 1, 1e-9]);\n}\n");
  const Finished refused = run_command({"boundary", file, "-o", folder / "out.stl", "--snap"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("E0201"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out.stl"));
}

}  // namespace
}  // namespace exactcsg::cli_test
