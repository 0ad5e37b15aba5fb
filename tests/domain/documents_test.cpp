// SPDX-License-Identifier: GPL-3.0-or-later
// docs/adding-a-primitive.md shows the code that there is.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "exactcsg/domain/half_spaces.hpp"

namespace exactcsg::domain {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(std::filesystem::path(EXACTCSG_SOURCE_DIR) / file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Documents, TheExampleOfAPrimitiveIsItsCode) {
  const std::string document = text_of("docs/adding-a-primitive.md");
  const std::string code = text_of("kernel/exactcsg/domain/ellipsoid.hpp") +
                           text_of("kernel/exactcsg/domain/half_spaces.hpp") +
                           text_of("tests/domain/rows.hpp");
  const std::string begin = "```cpp\n";
  std::size_t blocks = 0;
  for (auto at = document.find(begin); at != std::string::npos; at = document.find(begin, at)) {
    at += begin.size();
    const auto end = document.find("```", at);
    ASSERT_NE(end, std::string::npos);
    const std::string block = document.substr(at, end - at);
    EXPECT_NE(code.find(block), std::string::npos) << block;
    at = end + 3;
    ++blocks;
  }
  EXPECT_EQ(blocks, 4U);
}

TEST(Ellipsoids, AreWhatTheirNameSays) {
  const HalfSpace<2> ellipse = make_ellipsoid<2>({1, 0}, {4, 9});
  EXPECT_EQ(classify(ellipse, Point<2>(3, 0)), PointClass::On);
  EXPECT_EQ(classify(ellipse, Point<2>(1, 3)), PointClass::On);
  EXPECT_EQ(classify(ellipse, Box<2>({3, -5}, {4, 5})), csg::Membership::Out);
  EXPECT_THROW(make_ellipsoid<2>({1, 0}, {4, 0}), Error);
}

}  // namespace
}  // namespace exactcsg::domain
