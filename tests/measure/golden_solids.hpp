// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The closed forms of data/curved/golden.json, held against proved bounds.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "exactcsg/measure/area.hpp"
#include "measure/curved_solids.hpp"

namespace exactcsg::measure::test {

inline nlohmann::json golden_solids() {
  std::ifstream file(std::string(EXACTCSG_SOURCE_DIR) + "/data/curved/golden.json");
  return nlohmann::json::parse(file)["solids"];
}

// A decimal of 20 digits: the number meant is within a unit of the last.
inline bool has_golden_value(const CertifiedMeasure& measure, const std::string& decimal) {
  const Rational value = *parse_rational(decimal);
  const Rational slack = value * Rational(1, 1'000'000'000) * Rational(1, 1'000'000'000);
  return measure.stop == StopReason::Width && measure.value.lower <= value + slack &&
         measure.value.upper >= value - slack;
}

}  // namespace exactcsg::measure::test
