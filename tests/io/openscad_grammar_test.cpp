// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "exactcsg/io/openscad/node_kind.hpp"
#include "exactcsg/io/openscad/syntax.hpp"

namespace exactcsg::io::openscad {
namespace {

SyntaxTree parsed(std::string_view text) { return parse(text, "x.csg", 1000); }

TEST(OpenscadGrammar, ReadsNodesArgumentsAndNesting) {
  const SyntaxTree tree =
      parsed("group() {\n\tcube(size = [1, 2, 3], center = true);\n\tsphere(r = .5e-3); }\n");
  ASSERT_EQ(tree.nodes.size(), 3U);
  EXPECT_EQ(tree.nodes[0].name, "group");
  EXPECT_EQ(tree.nodes[0].end, 3U);
  EXPECT_EQ(tree.nodes[1].name, "cube");
  EXPECT_EQ(tree.nodes[1].end, 2U);
  ASSERT_EQ(tree.nodes[1].argument_count, 2U);
  const Value& size = tree.values[tree.arguments[0].value];
  EXPECT_EQ(size.kind, Value::Kind::Vector);
  EXPECT_EQ(size.end, 4U);  // itself and three numbers
  EXPECT_EQ(tree.values[1].text, "1");
  EXPECT_TRUE(tree.values[tree.arguments[1].value].boolean);
  EXPECT_EQ(tree.values.back().text, ".5e-3");
}

TEST(OpenscadGrammar, NestsVectors) {
  const SyntaxTree tree = parsed("polyhedron([[1, [2]], [], 3]);");
  // Pre-order: outer, [1, [2]], 1, [2], 2, [], 3
  ASSERT_EQ(tree.values.size(), 7U);
  EXPECT_EQ(tree.values[0].end, 7U);
  EXPECT_EQ(tree.values[1].end, 5U);
  EXPECT_EQ(tree.values[3].end, 5U);
  EXPECT_EQ(tree.values[5].end, 6U);
}

TEST(OpenscadGrammar, ReadsEveryKindOfValue) {
  const SyntaxTree tree =
      parsed("color(true, false, undef, nan, -nan, inf, -inf, \"a\\\"b\", -1.5E+3, 1.);");
  using enum Value::Kind;
  const Value::Kind expected[] = {Boolean,   Boolean,   Undefined, Undefined, Undefined,
                                  Undefined, Undefined, Text,      Number,    Number};
  ASSERT_EQ(tree.values.size(), std::size(expected));
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_EQ(tree.values[i].kind, expected[i]);
  EXPECT_EQ(tree.values[7].text, "a\\\"b");
}

TEST(OpenscadGrammar, ReadsModifiersBeforeTheIndentation) {
  const SyntaxTree tree = parsed("%\tgroup();\n#%  cube();\n!sphere();\n*cube();");
  EXPECT_TRUE(tree.nodes[0].modifiers.background);
  EXPECT_TRUE(tree.nodes[1].modifiers.background);
  EXPECT_TRUE(tree.nodes[1].modifiers.highlight);
  EXPECT_TRUE(tree.nodes[2].modifiers.root);
  EXPECT_TRUE(tree.nodes[3].modifiers.disabled);
}

TEST(OpenscadGrammar, SkipsCommentsEmptyStatementsAndTrailingCommas) {
  EXPECT_EQ(parsed("\xef\xbb\xbf/* a */ ; cube(size = [1, 2,],) /**/ ; // end").nodes.size(), 1U);
}

// LAW syntax.1
TEST(OpenscadGrammar, KnowsLinesAndColumns) {
  const SyntaxTree tree = parsed("group() {\n\t  cube(size = 1,\n center = true);\n}\n");
  EXPECT_EQ(tree.position(tree.nodes[1].offset).line, 2U);
  EXPECT_EQ(tree.position(tree.nodes[1].offset).column, 4U);
  EXPECT_EQ(tree.position(tree.arguments[1].offset).line, 3U);
  EXPECT_EQ(tree.position(tree.arguments[1].offset).column, 2U);
}

// LAW syntax.2
TEST(OpenscadGrammar, NestsAMillionDeep) {
  constexpr std::size_t depth = 1'000'000;
  std::string text;
  for (std::size_t i = 0; i < depth; ++i) text += "group(){";
  text += "cube();";
  text.append(depth, '}');
  EXPECT_EQ(parse(text, "x.csg", depth).nodes.size(), depth + 1);
  try {
    parse(text, "x.csg", depth - 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::TooDeep);
  }
}

struct BadText {
  const char* text;
  ErrorId id;
  std::size_t line, column;
  const char* expected;  // part of what the message says was expected
};

class OpenscadBadText : public testing::TestWithParam<BadText> {};

TEST_P(OpenscadBadText, IsRefusedWithItsPosition) {
  const BadText& bad = GetParam();
  try {
    parsed(bad.text);
    FAIL() << "accepted: " << bad.text;
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), bad.id) << error.what();
    ASSERT_TRUE(error.details().position);
    EXPECT_EQ(error.details().position->file, "x.csg");
    EXPECT_EQ(error.details().position->line, bad.line) << error.what();
    EXPECT_EQ(error.details().position->column, bad.column) << error.what();
    EXPECT_THAT(error.details().expected, testing::HasSubstr(bad.expected));
  }
}

// The positions are counted by hand in the texts.
INSTANTIATE_TEST_SUITE_P(
    Texts, OpenscadBadText,
    testing::Values(BadText{"", ErrorId::EmptyFile, 0, 0, ""},
                    BadText{" \n", ErrorId::EmptyFile, 1, 1, "node"},
                    BadText{"// only a comment\n", ErrorId::EmptyFile, 1, 1, "node"},
                    BadText{"PK\x03\x04zip", ErrorId::NotText, 1, 1, "text"},
                    BadText{"cube();\n\x01", ErrorId::NotText, 2, 1, "text"},
                    BadText{"\x7f"
                            "ELF",
                            ErrorId::NotText, 1, 1, "text"},
                    BadText{"cube(size = [1, 2", ErrorId::TruncatedInput, 1, 18, "']'"},
                    BadText{"cube(size = [1,", ErrorId::TruncatedInput, 1, 16, "value"},
                    BadText{"cube(size = ", ErrorId::TruncatedInput, 1, 13, "value"},
                    BadText{"cube(center = fal", ErrorId::TruncatedInput, 1, 15, "value"},
                    BadText{"cube(center = true", ErrorId::TruncatedInput, 1, 19, "')'"},
                    BadText{"cube()", ErrorId::TruncatedInput, 1, 7, "';' or '{'"},
                    BadText{"cube", ErrorId::TruncatedInput, 1, 5, "'('"},
                    BadText{"%", ErrorId::TruncatedInput, 1, 1, "node"},
                    BadText{"group() {\n cube();\n", ErrorId::TruncatedInput, 3, 1,
                            "'group' of line 1"},
                    BadText{"color(\"red);", ErrorId::TruncatedInput, 1, 7, "end of the string"},
                    BadText{"cube(); /* open", ErrorId::TruncatedInput, 1, 9, "node"},
                    BadText{"cube(1 2);", ErrorId::UnexpectedText, 1, 8, "')'"},
                    BadText{"cube([1 2]);", ErrorId::UnexpectedText, 1, 9, "']'"},
                    BadText{"cube([1, foo]);", ErrorId::UnexpectedText, 1, 10, "value"},
                    BadText{"cube(1e);", ErrorId::UnexpectedText, 1, 8, "exponent"},
                    BadText{"cube(12abc);", ErrorId::UnexpectedText, 1, 6, "value"},
                    BadText{"cube(--1);", ErrorId::UnexpectedText, 1, 6, "value"},
                    BadText{"cube(size = );", ErrorId::UnexpectedText, 1, 13, "value"},
                    BadText{"cube(a = 1, , b = 2);", ErrorId::UnexpectedText, 1, 13, "value"},
                    BadText{"cube();}", ErrorId::UnexpectedText, 1, 8, "end of the file"},
                    BadText{"cube() sphere();", ErrorId::UnexpectedText, 1, 8, "';' or '{'"},
                    BadText{"[1];", ErrorId::UnexpectedText, 1, 1, "node"},
                    BadText{"cube(\xc3\xa9);", ErrorId::UnexpectedText, 1, 6, "value"}));

TEST(OpenscadGrammar, RefusesNulBytes) {
  try {
    parsed(std::string_view("cube();\0cube();", 15));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::NotText);
    EXPECT_EQ(error.details().position->column, 8U);
  }
}

TEST(OpenscadGrammar, RefusesVectorsNestedTooDeeply) {
  std::string text = "cube(";
  text.append(1'000'000, '[');
  try {
    parsed(text);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::TooDeep);
    EXPECT_EQ(error.details().position->column, 6U + vector_depth_limit);
  }
}

// Every prefix of a valid text is refused as truncated or unexpected, never accepted as a node, and
// never crashes.
TEST(OpenscadGrammar, RefusesEveryPrefix) {
  const std::string text =
      "difference(){cube(size=[1,2.5e1],center=true);color(\"r\\\"\",nan){sphere();}}";
  for (std::size_t length = 1; length < text.size(); ++length) {
    EXPECT_THROW(parsed(text.substr(0, length)), Error) << length;
  }
  EXPECT_EQ(parsed(text).nodes.size(), 4U);
}

TEST(OpenscadNodeKind, FindsEveryNodeAndSuggestsNearOnes) {
  for (const char* name : {"group", "color", "render"}) {
    EXPECT_EQ(find_node_kind(name), NodeKind::Group);
  }
  EXPECT_EQ(find_node_kind("cube"), NodeKind::Cube);
  EXPECT_EQ(find_node_kind("union"), NodeKind::Union);
  EXPECT_EQ(find_node_kind("multmatrix"), NodeKind::Multmatrix);
  for (const char* name : {"fill", "roof"}) {
    EXPECT_EQ(find_node_kind(name), NodeKind::Unsupported);
  }
  EXPECT_EQ(find_node_kind("cubes"), std::nullopt);
  EXPECT_THAT(suggest_node("cubes"), testing::HasSubstr("'cube'"));
  EXPECT_THAT(suggest_node("inersection"), testing::HasSubstr("'intersection'"));
  EXPECT_THAT(suggest_node("translate"), testing::HasSubstr(".scad"));
  EXPECT_THAT(suggest_node("xyzzy"), testing::Not(testing::HasSubstr("perhaps")));
}

}  // namespace
}  // namespace exactcsg::io::openscad
