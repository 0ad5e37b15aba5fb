// SPDX-License-Identifier: GPL-3.0-or-later
// docs/errors.md against the catalogue in the code: every error is documented, as it is, and
// nothing else. After a change of the catalogue: EXACTCSG_UPDATE_DOCS=1
// build/release/tests/test_layers

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>

#include "exactcsg/support/error.hpp"
#include "layers/source_rules.hpp"

namespace exactcsg::house {
namespace {

constexpr std::string_view begin_mark = "<!-- begin of the generated table -->\n";
constexpr std::string_view end_mark = "<!-- end of the generated table -->\n";

std::string table() {
  std::string text = "| code | exit | what is wrong | what to do |\n| --- | --- | --- | --- |\n";
  for (const ErrorDescription& error : error_catalogue()) {
    text.append("| ").append(error.code).append(" | ").append(std::to_string(error.exit_code));
    text.append(" | ").append(error.title).append(" | ").append(error.remedy).append(" |\n");
  }
  return text;
}

TEST(ErrorCatalogue, TheDocumentedTableIsTheCatalogue) {
  const std::filesystem::path file = std::filesystem::path(EXACTCSG_SOURCE_DIR) / "docs/errors.md";
  const std::string text = read_text(file);
  const auto begin = text.find(begin_mark);
  const auto end = text.find(end_mark);
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  const auto first = begin + begin_mark.size();
  if (std::getenv("EXACTCSG_UPDATE_DOCS") != nullptr) {
    std::ofstream(file) << text.substr(0, first) << table() << text.substr(end);
    return;
  }
  EXPECT_EQ(text.substr(first, end - first), table())
      << "the catalogue changed: run this test with EXACTCSG_UPDATE_DOCS=1 and commit "
         "docs/errors.md";
}

// Scripts rely on codes: "E" and four digits, ascending, so that none is used twice.
TEST(ErrorCatalogue, CodesAreWellFormedAndAscending) {
  std::string before;
  for (const ErrorDescription& error : error_catalogue()) {
    const std::string code(error.code);
    EXPECT_EQ(code.size(), 5U);
    EXPECT_EQ(code.front(), 'E');
    EXPECT_TRUE(std::all_of(code.begin() + 1, code.end(),
                            [](unsigned char c) { return std::isdigit(c) != 0; }));
    EXPECT_LT(before, code);
    before = code;
  }
}

// Exit codes of the command: 2 input or usage trouble, 3 a fault of ours, E09xx only.
TEST(ErrorCatalogue, ExitCodesFollowTheBlocks) {
  for (const ErrorDescription& error : error_catalogue()) {
    EXPECT_EQ(error.exit_code, error.code.substr(0, 3) == "E09" ? 3 : 2) << error.code;
    EXPECT_EQ(&describe(error.id), &error) << error.code;
    EXPECT_FALSE(error.title.empty());
    EXPECT_FALSE(error.remedy.empty());
  }
}

}  // namespace
}  // namespace exactcsg::house
