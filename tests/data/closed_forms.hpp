// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What the closed form tests of the fast and of the slow tier share: the derived values of
// data/openscad/expected.json and the comparison of a model with them.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"

namespace exactcsg::test {

inline std::filesystem::path model_folder() {
  return std::filesystem::path(EXACTCSG_SOURCE_DIR) / "data" / "openscad";
}

inline const nlohmann::json& expected_models() {
  static const nlohmann::json models = [] {
    std::ifstream file(model_folder() / "expected.json");
    return nlohmann::json::parse(file).at("models");
  }();
  return models;
}

inline bool is_slow(const std::string& name) { return name == "menger_4"; }

inline std::vector<std::string> model_names(bool slow) {
  std::vector<std::string> names;
  for (const auto& [name, entry] : expected_models().items())
    if (is_slow(name) == slow) names.push_back(name);
  return names;
}

// The sum of terms "q" and "q*sqrt(n)", enclosed to about `bits` bits.
inline Enclosure enclose_terms(const std::string& text, unsigned bits) {
  Enclosure sum{0, 0};
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find('+', start), text.size());
    const std::string term = text.substr(start, end - start);
    start = end + 1;
    const std::size_t root = term.find("*sqrt(");
    const Rational factor(term.substr(0, root));
    if (root == std::string::npos) {
      sum.lower += factor;
      sum.upper += factor;
      continue;
    }
    // floor(sqrt(n 4^bits)) / 2^bits <= sqrt(n) < the same plus 2^-bits
    const Integer scale = Integer(1) << bits;
    const Integer radicand(term.substr(root + 6, term.size() - root - 7));
    const Integer floor_root = sqrt(Integer(radicand * scale * scale));
    sum.lower += factor * Rational(floor_root, scale);
    sum.upper += factor * Rational(Integer(floor_root + 1), scale);
  }
  sum.lower.canonicalize();
  sum.upper.canonicalize();
  return sum;
}

inline void compare_with_closed_form(const std::string& name) {
  const nlohmann::json& expected = expected_models().at(name);
  SCOPED_TRACE(name + ": " + expected.at("derivation").get<std::string>());
  const io::Model model = io::read_model(model_folder() / (name + ".csg"));
  const Boundary boundary = evaluate(model.solid);

  if (expected.contains("volume")) {
    const auto volume = exact_volume(boundary);
    ASSERT_TRUE(volume.has_value());
    EXPECT_EQ(*volume, Rational(expected.at("volume").get<std::string>()));
  }
  if (expected.contains("volume_near")) {
    const auto& near = expected.at("volume_near");
    const double value = std::stod(near.at("value").get<std::string>());
    const Enclosure volume = enclose_volume(boundary, 128);
    const double tolerance = near.at("relative").get<double>() * value;
    EXPECT_LE(nearest_double(volume.lower), value + tolerance);
    EXPECT_GE(nearest_double(volume.upper), value - tolerance);
    EXPECT_LE(volume.upper - volume.lower, rational_of(tolerance));
  }
  if (expected.contains("area")) {
    const std::string area = expected.at("area").get<std::string>();
    const int digits = 30;
    EXPECT_EQ(to_decimal([&](int bits) { return enclose_area(boundary, bits); }, digits),
              to_decimal([&](int bits) { return enclose_terms(area, static_cast<unsigned>(bits)); },
                         digits));
  }
  const Topology found = topology(boundary);
  const auto compare = [&](const char* key, auto value) {
    if (expected.contains(key)) {
      EXPECT_EQ(static_cast<std::int64_t>(value), expected.at(key).get<std::int64_t>()) << key;
    }
  };
  compare("vertices", found.vertices);
  compare("edges", found.edges);
  compare("faces", found.faces);
  compare("components", found.components);
  compare("cavities", found.cavities);
  compare("genus", found.genus);
}

class ClosedForm : public testing::TestWithParam<std::string> {};

inline std::string name_of(const testing::TestParamInfo<std::string>& info) { return info.param; }

}  // namespace exactcsg::test
