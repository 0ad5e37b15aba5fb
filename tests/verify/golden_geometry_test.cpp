// SPDX-License-Identifier: GPL-3.0-or-later
// Golden values of geometries: what passes, what fails, what is refused. Expected values: the
// volume of a box of 1 x 1 x 2, and of a ball by its closed form.

#include "exactcsg/verify/golden_geometry.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/verify_geometry.hpp"
#include "temporary_folder.hpp"

namespace exactcsg::verify {
namespace {

// A box, a ball beside it, of two materials one an instance, and all that is outside.
io::openmc::Model model() {
  return io::openmc::read_geometry(
      "<geometry><surface id='1' type='x-plane' coeffs='0'/>"
      "<surface id='2' type='x-plane' coeffs='1'/><surface id='3' type='y-plane' coeffs='0'/>"
      "<surface id='4' type='y-plane' coeffs='1'/><surface id='5' type='z-plane' coeffs='0'/>"
      "<surface id='6' type='z-plane' coeffs='2'/>"
      "<surface id='7' type='sphere' coeffs='5 0 0 1'/>"
      "<cell id='1' material='1' region='1 -2 3 -4 5 -6'/>"
      "<cell id='2' material='1 void' region='-7'/>"
      "<cell id='3' material='void' region='7 ~(1 -2 3 -4 5 -6)'/></geometry>",
      "box_and_ball.xml");
}

class GoldenGeometry : public testing::Test {
 protected:
  std::string write(const std::string& text) const { return folder_.write("golden.json", text); }
  std::string write_entry(const std::string& cells, const std::string& materials) const {
    return write(
        R"({"schema": "exactcsg.geometry_golden/1", "models": {"box_and_ball": {"cells": {)" +
        cells + R"(}, "materials": {)" + materials + "}}}}");
  }
  static Report report(const std::filesystem::path& golden) {
    VerifyGeometryOptions options;
    options.relative_width = 1e-4;
    options.disabled = {"sampling", "nef"};
    options.golden = golden;
    return verify_geometry(model(), options);
  }

 private:
  const test::Folder folder_;
};

std::string value(const std::string& name, const std::string& volume) {
  return "\"" + name + "\": {\"volume\": " + volume + ", \"form\": \"a closed form\"}";
}
const std::string right_cells = value("1", "\"2\"") + "," +
                                value("2", R"(["4.1887902", "4.1887903"])") + "," +
                                value("3", "null");
const std::string right_materials =
    value("void", "null") + "," + value("1", "\"4/2\"") + "," + value("1, void", R"(["4", "5"])");

TEST_F(GoldenGeometry, RightValuesPass) {
  const Report found = report(write_entry(right_cells, right_materials));
  EXPECT_EQ(found.count(Verdict::Passed), 6U) << render_text(found);
  EXPECT_EQ(found.checks[1].explanation, "known by: a closed form");
}

TEST_F(GoldenGeometry, WrongAndMissingValuesFail) {
  const auto failures = [&](const std::string& cells, const std::string& materials) {
    const Report found = report(write_entry(cells, materials));
    std::string names;
    for (const Check& check : found.checks) {
      if (check.verdict == Verdict::Failed) names += check.name + ";";
    }
    return names;
  };
  const auto cells = [](const char* one, const char* ball, const char* outside) {
    return value("1", one) + "," + value("2", ball) + "," + value("3", outside);
  };
  EXPECT_EQ(failures(cells("\"2.0000001\"", "\"4.188790205\"", "null"), right_materials),
            "golden: cell 1;");
  EXPECT_EQ(failures(cells("\"2\"", "\"4.25\"", "null"), right_materials), "golden: cell 2;");
  EXPECT_EQ(failures(cells("\"2\"", "null", "\"7\""), right_materials),
            "golden: cell 2;golden: cell 3;");
  EXPECT_EQ(failures(value("2", "\"4.188790205\""), right_materials),
            "golden: cell 1;golden: cell 3;");
  EXPECT_EQ(failures(right_cells + "," + value("4", "\"1\""), right_materials), "golden: cell 4;");
  EXPECT_EQ(failures(right_cells, value("1", "\"2\"") + "," + value("void", "null")),
            "golden: material 1, void;");
}

TEST_F(GoldenGeometry, AModelWithoutAnEntryFails) {
  const Report found = report(write(R"({"schema": "exactcsg.geometry_golden/1", "models": {}})"));
  ASSERT_EQ(found.checks.size(), 1U);
  EXPECT_EQ(found.checks[0].verdict, Verdict::Failed);
  EXPECT_NE(found.checks[0].explanation.find("box_and_ball"), std::string::npos);
}

TEST_F(GoldenGeometry, FilesThatAreWrongAreRefused) {
  const std::string head = R"({"schema": "exactcsg.geometry_golden/1", "models": )";
  for (const std::string& text : {
           std::string("{"),
           std::string("[]"),
           std::string(R"({"schema": "exactcsg.golden/1", "models": {}})"),
           head + "[]}",
           head + R"({"m": 1}})",
           head + R"({"m": {"cells": {}}}})",
           head + R"({"m": {"cells": {"1": {"volume": "1"}}, "materials": {}}}})",
           head + R"({"m": {"cells": {"1": {"form": ""}}, "materials": {}}}})",
           head + R"({"m": {"cells": {"1": {"volume": 1, "form": ""}}, "materials": {}}}})",
           head + R"({"m": {"cells": {"1": {"volume": "one", "form": ""}}, "materials": {}}}})",
           head + R"({"m": {"cells": {"1": {"volume": ["1"], "form": ""}}, "materials": {}}}})",
           head +
               R"({"m": {"cells": {"1": {"volume": ["2", "1"], "form": ""}}, "materials": {}}}})",
       }) {
    try {
      report(write(text));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), ErrorId::GoldenFile) << text;
    }
  }
}

}  // namespace
}  // namespace exactcsg::verify
