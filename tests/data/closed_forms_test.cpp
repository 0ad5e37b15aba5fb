// SPDX-License-Identifier: GPL-3.0-or-later
// The models of data/openscad that have closed forms: exact volume as a rational, area to 30
// digits, counts and genus. Every expected value is derived in data/openscad/expected.json, and
// again below where it can be had from a formula.

#include "data/closed_forms.hpp"

#include <map>

namespace exactcsg::test {
namespace {

TEST_P(ClosedForm, AgreesWithTheDerivedValues) { compare_with_closed_form(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Models, ClosedForm, testing::ValuesIn(model_names(false)), name_of);

// Menger sponge of level n, side 3^n: V = (20/27)^n 27^n, A = (2 (20/9)^n + 4 (8/9)^n) 9^n.
TEST(ExpectedValues, OfTheSpongesFollowFromTheFormula) {
  long twenty = 1;
  long eight = 1;
  const long genus[] = {5, 81, 1409, 26433};
  for (int n = 1; n <= 4; ++n) {
    twenty *= 20;
    eight *= 8;
    const auto& entry = expected_models().at("menger_" + std::to_string(n));
    EXPECT_EQ(entry.at("volume").get<std::string>(), std::to_string(twenty));
    EXPECT_EQ(entry.at("area").get<std::string>(), std::to_string(2 * twenty + 4 * eight));
    EXPECT_EQ(entry.at("genus").get<long>(), genus[n - 1]);
  }
}

// The published sections of the unit square with its turns by the 3-4-5 angle, added up.
TEST(ExpectedValues, OfTheTurnedCubesAddUp) {
  Rational sum = 0;
  for (const char* section : {"5/6", "17/21", "185/231", "61/77", "4813/6083", "437/553"})
    sum += Rational(section);
  const auto& entry = expected_models().at("turned_cubes_growth");
  EXPECT_EQ(Rational(entry.at("volume").get<std::string>()), sum);
  EXPECT_EQ(Rational(entry.at("area").get<std::string>()), Rational(6 * sum));
}

// Every model has its source, and every source its model.
TEST(Models, ComeInPairs) {
  std::map<std::string, int> endings;
  for (const auto& entry : std::filesystem::directory_iterator(model_folder())) {
    if (entry.path().extension() == ".scad") endings[entry.path().stem()] += 1;
    if (entry.path().extension() == ".csg") endings[entry.path().stem()] += 2;
  }
  EXPECT_GE(endings.size(), 30U);
  for (const auto& [name, found] : endings) EXPECT_EQ(found, 3) << name;
}

TEST(Models, WithExpectedValuesExist) {
  for (const auto& [name, entry] : expected_models().items())
    EXPECT_TRUE(std::filesystem::exists(model_folder() / (name + ".csg"))) << name;
}

}  // namespace
}  // namespace exactcsg::test
