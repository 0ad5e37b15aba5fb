// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/support/error.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "exactcsg/support/progress.hpp"

namespace exactcsg {
namespace {

TEST(ErrorCatalogue, CodesAreUniqueAndAscendWithinTheirBlock) {
  std::set<std::string_view> codes;
  std::string block;
  std::string previous;
  std::set<std::string> finished;
  for (const ErrorDescription& description : error_catalogue()) {
    const std::string code(description.code);
    EXPECT_TRUE(codes.insert(description.code).second) << code;
    if (code.substr(0, 3) != block) {
      EXPECT_TRUE(finished.insert(code.substr(0, 3)).second) << code << " is apart from its block";
      block = code.substr(0, 3);
    } else {
      EXPECT_LT(previous, code);
    }
    previous = code;
  }
  EXPECT_FALSE(codes.empty());
}

TEST(ErrorCatalogue, EveryLineIsComplete) {
  std::size_t index = 0;
  for (const ErrorDescription& description : error_catalogue()) {
    const std::string code(description.code);
    ASSERT_EQ(code.size(), 5U) << code;
    EXPECT_EQ(code[0], 'E');
    EXPECT_EQ(code.find_first_not_of("0123456789", 1), std::string::npos) << code;
    EXPECT_FALSE(description.title.empty()) << code;
    EXPECT_FALSE(description.remedy.empty()) << code;
    EXPECT_GE(description.exit_code, 1) << code;
    EXPECT_LE(description.exit_code, 3) << code;
    // E09xx are our own faults, and only they exit with 3.
    EXPECT_EQ(code.substr(0, 3) == "E09", description.exit_code == 3) << code;
    EXPECT_EQ(static_cast<std::size_t>(description.id), index++);
    EXPECT_EQ(describe(description.id).code, description.code);
  }
}

TEST(Error, SaysWhatWhereAndWhatToDo) {
  const Error error(ErrorId::OpenMesh, {"3 facets at an edge", "2 facets", {}});
  const ErrorDescription& description = describe(ErrorId::OpenMesh);
  EXPECT_EQ(std::string(error.what()), "error[" + std::string(description.code) +
                                           "]: " + std::string(description.title) +
                                           ": found 3 facets at an edge, expected 2 facets; " +
                                           std::string(description.remedy));
  const Error placed = error.at({"part.csg", 12, 3});
  EXPECT_EQ(std::string(placed.what()).find("part.csg:12:3: error["), 0U);
  EXPECT_EQ(placed.id(), ErrorId::OpenMesh);
  EXPECT_EQ(std::string(placed.at({"other.csg", 1, 1}).what()), placed.what());
  EXPECT_EQ(std::string(error.at({"part.csg", 0, 0}).what()).find("part.csg: error["), 0U);
}

TEST(Progress, ThrowsOnceCancelled) {
  Progress progress;
  progress.begin("decompose", 10);
  progress.advance(3);
  EXPECT_EQ(progress.done(), 3U);
  EXPECT_NO_THROW(progress.check());
  progress.cancel(ErrorId::TimeLimit);
  try {
    progress.check();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::TimeLimit);
  }
}

}  // namespace
}  // namespace exactcsg
