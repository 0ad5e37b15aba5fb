// SPDX-License-Identifier: GPL-3.0-or-later
// CSG trees as text. Expected values: the grammar of docs/format.md by hand, and the law that
// reading undoes writing.
#include "exactcsg/csg/text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "csg/chains.hpp"
#include "csg/random_tree.hpp"
#include "exactcsg/csg/attributed.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/number/exact.hpp"

namespace exactcsg::csg {
namespace {

using test::chain;
using test::chain_depth;
using test::random_tree;
using test::Side;
using test::TestTree;

const auto put_int = [](TextWriter& out, int i) { out.write(i); };
const auto get_int = [](TextReader& in) { return in.number<int>("a primitive"); };

// The least that the user's functions may be.
struct Minimal {
  int value;
};
enum class MinimalOperator { Only };
struct PutMinimal {
  const char* operator()(const Minimal&) { return "m"; }
};
struct GetMinimal {
  Minimal operator()(TextReader& in) { return {in.word("m") == "m" ? 1 : 0}; }
};
struct MinimalCode {
  char operator()(MinimalOperator) { return 'o'; }
  std::optional<MinimalOperator> operator()(char code) {
    return code == 'o' ? std::optional(MinimalOperator::Only) : std::nullopt;
  }
};
static_assert(PutsText<PutMinimal, Minimal> && GetsText<GetMinimal>);
static_assert(PutsText<decltype(put_int), int>);
static_assert(GetsOperator<MinimalCode> && GetsOperator<BooleanCodes>);
static_assert(!GetsOperator<GetMinimal> && !GetsText<MinimalCode>);
static_assert(std::same_as<decltype(from_text("", GetMinimal{}, MinimalCode{})),
                           Tree<Minimal, MinimalOperator>>);

TEST(Text, AnyPrimitivesAndOperators) {
  using T = Tree<Minimal, MinimalOperator>;
  const T tree = T::compose(MinimalOperator::Only, {T::full(), T::primitive({1})});
  EXPECT_EQ(to_text(tree, PutMinimal{}, MinimalCode{}), "(o full m)");
  EXPECT_EQ(from_text("(o full m)", GetMinimal{}, MinimalCode{}).node_count(), 3U);
}

// LAW csg.text.2
TEST(Text, BlanksAndCommentsChangeNothing) {
  const TestTree expected = subtract(TestTree::full(), unite(TestTree::primitive(1), {}));
  for (const char* text : {"(- full (+ 1 empty))", "( - full(+1 empty))",
                           "\n(-\tfull\r\n(+ # a comment (\n1 empty ) )#", "(-full(+ 1 empty))",
                           "# (\n  (- full (+ 1 empty))   \n"}) {
    EXPECT_EQ(from_text(text, get_int), expected) << text;
  }
  EXPECT_TRUE(from_text("empty", get_int).is_empty());
  EXPECT_TRUE(from_text(" full ", get_int).is_full());
  EXPECT_EQ(from_text("-7", get_int), TestTree::primitive(-7));
}

std::string error_of(std::string_view text) {
  try {
    from_text(text, get_int, BooleanCodes{}, "f");
  } catch (const Error& error) {
    const auto& position = error.details().position;
    return std::string(describe(error.id()).code) + " " + std::to_string(position->line) + ":" +
           std::to_string(position->column) + " " + error.details().found;
  }
  return "";
}

// Line and column counted by hand.
TEST(Text, ErrorsSayWhere) {
  EXPECT_EQ(error_of(""), "E0102 1:1 the end of the text");
  EXPECT_EQ(error_of("  \n # 1"), "E0102 2:5 the end of the text");
  EXPECT_EQ(error_of("(+ 1\n  2"), "E0102 2:4 the end of the text");
  EXPECT_EQ(error_of("(+ 1\n  (? 2))"), "E0101 2:4 '?'");
  EXPECT_EQ(error_of("(+)"), "E0101 1:3 ')'");
  EXPECT_EQ(error_of("("), "E0102 1:2 the end of the text");
  EXPECT_EQ(error_of(")"), "E0101 1:1 ')'");
  EXPECT_EQ(error_of("(+ 1 2) 3"), "E0101 1:9 '3'");
  EXPECT_EQ(error_of("(+ 1 x2)"), "E0101 1:6 'x2'");
  EXPECT_EQ(error_of("(+ 1 99999999999)"), "E0106 1:6 '99999999999'");
  EXPECT_EQ(error_of("(+ 1\n\n  [2])"), "E0101 3:3 '['");
  EXPECT_EQ(error_of("(+ 1 emptyish)"), "E0101 1:6 'emptyish'");
  // The bracket that was not closed is named.
  try {
    from_text("(+ 1\n (- 2 3)\n (& 4 5\n", get_int);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.details().expected, "what closes the bracket of line 3, column 2");
  }
}

// Errors of the user's own functions get the place too.
TEST(Text, ErrorsOfPrimitivesSayWhere) {
  const auto get_rational = [](TextReader& in) {
    const Rational value = in.parsed(parse_rational, "a rational");
    if (value == 0) throw Error(ErrorId::BadArgument, {"0", "another number"});
    return value;
  };
  const auto tree = from_text("(- 1/3 -2/7)", get_rational);
  EXPECT_EQ(tree.children()[1].primitive(), Rational(-2, 7));
  for (const char* text : {"(- 1/3\n one)", "(- 1/3\n 0)"}) {
    try {
      from_text(text, get_rational);
      FAIL();
    } catch (const Error& error) {
      ASSERT_TRUE(error.details().position.has_value());
      EXPECT_EQ(error.details().position->line, 2U);
      EXPECT_EQ(error.details().position->column, 2U);
    }
  }
}

// What could not be read back is not written.
TEST(Text, RefusesAmbiguousText) {
  const TestTree leaf = TestTree::primitive(1);
  for (const char* text : {"", " a", "(a", ")", "[", "]", "@", "#", "empty", "full 1"}) {
    EXPECT_THROW(to_text(leaf, [&](int) { return text; }), Error) << text;
  }
  EXPECT_EQ(to_text(leaf, [](int) { return "fuller (x)"; }), "fuller (x)");
  EXPECT_THROW(to_text(unite(leaf, leaf), put_int, [](BooleanOperator) { return '('; }), Error);
}

// LAW csg.text.1, on both memory layouts.
RC_GTEST_PROP(TextProperty, ReadingUndoesWriting, ()) {
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  const int depth = *rc::gen::inRange(0, 8);
  const TestTree tree = random_tree(random, depth, 1000);
  const std::string text = to_text(tree, put_int);
  RC_ASSERT(from_text(text, get_int) == tree);
  const auto flat = flatten(tree, [](int i) { return i; });
  RC_ASSERT(to_text(flat, put_int) == text);
  // Lines stay short, so that a column says something.
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    RC_ASSERT(end - from < TextWriter::line_width + 40);
    from = end + 1;
  }
}

// LAW text.1: numbers come back as they were.
RC_GTEST_PROP(TextProperty, NumbersComeBack, (double x, std::int64_t i)) {
  using Number = std::pair<double, std::int64_t>;
  using T = BooleanTree<Number>;
  const auto put_both = [](TextWriter& out, const Number& n) {
    out.write(n.first);
    out.separate();
    out.write(n.second);
  };
  const auto get_both = [](TextReader& in) {
    const auto first = in.number<double>();
    return Number(first, in.number<std::int64_t>());
  };
  const T tree = unite(T::primitive({x, i}), T::primitive({1 / (x + 0.5), -i / 2}));
  RC_ASSERT(from_text(to_text(tree, put_both), get_both) == tree);
}

// Attributed trees: attributes before their nodes, none at Empty and Full.
using Numbered = AttributedTree<int, BooleanOperator, std::int64_t>;
const auto put_number = [](TextWriter& out, std::int64_t n) { out.write(n); };
const auto get_number = [](TextReader& in) { return in.number<std::int64_t>("an attribute"); };

Numbered random_numbers(std::mt19937& random, const TestTree& tree) {
  return attribute(
      tree, [&](int) { return static_cast<std::int64_t>(random()); },
      [](std::int64_t a, BooleanOperator, std::int64_t b) { return a - b; },
      FullEmptyResult{std::int64_t{1}, std::int64_t{0}});
}

TEST(Text, AttributedTrees) {
  const Numbered tree =
      from_text("@1 (- @-2 7 full @3 (+ @4 8 empty))", get_int, BooleanCodes{}, get_number);
  EXPECT_EQ(attribute_of(tree), 1);
  EXPECT_EQ(attribute_of(tree.children()[0]), -2);
  EXPECT_EQ(tree.children()[0].primitive().value, 7);
  EXPECT_EQ(attribute_of(tree.children()[2].children()[0]), 4);
  EXPECT_EQ(without_attributes(tree), from_text("(- 7 full (+ 8 empty))", get_int));
  EXPECT_EQ(to_text(tree, put_int, BooleanCodes{}, put_number),
            "@1 (- @-2 7 full @3 (+ @4 8 empty))");
  // The functions for plain trees serve too, and leave the attributes out.
  EXPECT_EQ(to_text(tree, put_int), "(- 7 full (+ 8 empty))");
}

TEST(Text, ErrorsOfAttributedTreesSayWhere) {
  const auto error = [](std::string_view text) -> std::string {
    try {
      from_text(text, get_int, BooleanCodes{}, get_number);
    } catch (const Error& e) {
      const auto& position = e.details().position;
      return std::string(describe(e.id()).code) + " " + std::to_string(position->line) + ":" +
             std::to_string(position->column);
    }
    return "";
  };
  EXPECT_EQ(error("@1 5"), "");
  EXPECT_EQ(error("5"), "E0101 1:1");
  EXPECT_EQ(error("@1"), "E0102 1:3");
  EXPECT_EQ(error("@1 @2 5"), "E0101 1:4");
  EXPECT_EQ(error("@1 empty"), "E0101 1:4");
  EXPECT_EQ(error("@1 (+ @2 3\n 4)"), "E0101 2:2");
  EXPECT_EQ(error("@1 (+ @2 3 @4)"), "E0101 1:14");
  EXPECT_EQ(error("@x 5"), "E0101 1:2");
  EXPECT_EQ(error("@1 (+ @2 3"), "E0102 1:11");
}

RC_GTEST_PROP(TextProperty, ReadingUndoesWritingOfAttributes, ()) {
  std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
  const Numbered tree = random_numbers(random, random_tree(random, *rc::gen::inRange(0, 8), 1000));
  const std::string text = to_text(tree, put_int, BooleanCodes{}, put_number);
  RC_ASSERT(from_text(text, get_int, BooleanCodes{}, get_number) == tree);
}

// A chain of a million operators, on either side.
TEST(Text, AMillionDeep) {
  for (const Side side : {Side::Left, Side::Right, Side::Single}) {
    const auto tree = chain(chain_depth, BooleanOperator::Difference, side, 7);
    EXPECT_TRUE(from_text(to_text(tree, put_int), get_int) == tree);
    if (side != Side::Right) continue;
    std::mt19937 random(1);
    const auto numbered = random_numbers(random, tree);
    const auto text = to_text(numbered, put_int, BooleanCodes{}, put_number);
    EXPECT_TRUE(from_text(text, get_int, BooleanCodes{}, get_number) == numbered);
  }
}

}  // namespace
}  // namespace exactcsg::csg
