// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The closed forms of data/curved/golden.json, held against proved bounds.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/measure/area.hpp"
#include "measure/curved_solids.hpp"
#include "measure/curved_tori.hpp"

namespace exactcsg::measure::test {

// `kind`: "solids" of planes and quadrics (curved_solids.hpp), or "tori" (curved_tori.hpp).
inline nlohmann::json golden(const std::string& kind) {
  std::ifstream file(std::string(EXACTCSG_SOURCE_DIR) + "/data/curved/golden.json");
  return nlohmann::json::parse(file)[kind];
}

// A decimal of 20 digits: the number meant is within a unit of the last.
inline bool has_golden_value(const CertifiedMeasure& measure, const std::string& decimal) {
  const Rational value = *parse_rational(decimal);
  const Rational slack = value * Rational(1, 1'000'000'000) * Rational(1, 1'000'000'000);
  return measure.stop == StopReason::Width && measure.value.lower <= value + slack &&
         measure.value.upper >= value - slack;
}

template <class Known>
void expect_golden_volumes(const std::vector<Known>& all, const std::string& kind, double width) {
  const nlohmann::json entries = golden(kind);
  for (const Known& known : all) {
    EXPECT_TRUE(has_golden_value(volume(known.set, known.box, to_width(width)),
                                 entries.at(known.name).at("volume")))
        << known.name << " at " << width;
  }
}

// Of those whose areas are known.
template <class Known>
void expect_golden_areas(const std::vector<Known>& all, const std::string& kind, double width) {
  const nlohmann::json entries = golden(kind);
  for (const Known& known : all) {
    if (!known.area) continue;
    EXPECT_TRUE(has_golden_value(area(known.set, known.box, to_width(width)),
                                 entries.at(known.name).at("area")))
        << known.name << " at " << width;
  }
}

}  // namespace exactcsg::measure::test
