// SPDX-License-Identifier: GPL-3.0-or-later
// The proved volumes of the models of data/openmc against those of data/openmc/golden.json, which
// make_golden.py computes by closed forms. Every model has an entry, and every entry a model.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "exactcsg/verify/golden_geometry.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg {
namespace {

const std::string folder = std::string(EXACTCSG_SOURCE_DIR) + "/data/openmc/";

std::vector<std::string> models() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class OpenMcGolden : public testing::TestWithParam<std::string> {};

TEST_P(OpenMcGolden, VolumesAreThoseOfTheClosedForms) {
  const io::openmc::Model model = io::openmc::read_geometry_file(folder + GetParam() + ".xml");
  io::openmc::VolumeLimits limits;
  limits.relative_width = 1e-4;
  verify::Report report;
  report.checks =
      verify::check_golden(verify::read_golden_geometries(folder + "golden.json"), GetParam(),
                           model, io::openmc::measure_volumes(model, limits));
  EXPECT_EQ(report.count(verify::Verdict::Passed), report.checks.size()) << render_text(report);
  EXPECT_GE(report.checks.size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(Models, OpenMcGolden, testing::ValuesIn(models()),
                         [](const auto& info) { return info.param; });

TEST(OpenMcGoldenFile, EveryEntryHasAModel) {
  const std::vector<std::string> names = models();
  for (const auto& entry : verify::read_golden_geometries(folder + "golden.json")) {
    EXPECT_TRUE(std::binary_search(names.begin(), names.end(), entry.first)) << entry.first;
  }
}

}  // namespace
}  // namespace exactcsg
