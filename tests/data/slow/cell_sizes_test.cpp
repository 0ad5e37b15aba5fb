// SPDX-License-Identifier: GPL-3.0-or-later
// LAW boundary.1 on real models: the boundary does not depend on the cells. In cells of other sizes
// other facets are cut, in other places, and other coincidences are noticed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/evaluate.hpp"

namespace exactcsg::test {
namespace {

std::vector<std::string> models() {
  std::vector<std::string> result;
  for (const auto& file :
       std::filesystem::directory_iterator(EXACTCSG_SOURCE_DIR "/data/openscad")) {
    if (file.path().extension() == ".csg") result.push_back(file.path().stem().string());
  }
  std::sort(result.begin(), result.end());
  return result;
}

class CellSizes : public ::testing::TestWithParam<std::string> {};

TEST_P(CellSizes, DoNotChangeTheBoundary) {
  const std::string file = EXACTCSG_SOURCE_DIR "/data/openscad/" + GetParam() + ".csg";
  const Solid solid = io::read_model(file).solid;
  const std::string expected = digest(evaluate(solid));
  for (const std::size_t size : {6, 11, 17, 31, 70}) {
    EvaluateOptions options;
    options.facets_per_cell = size;
    EXPECT_EQ(digest(evaluate(solid, options)), expected) << size << " facets a cell";
  }
}

INSTANTIATE_TEST_SUITE_P(OfData, CellSizes, ::testing::ValuesIn(models()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace exactcsg::test
