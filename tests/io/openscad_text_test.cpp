// SPDX-License-Identifier: GPL-3.0-or-later
// Text: against OpenSCAD itself, run on the same words, and by laws that hold for every font. The
// fonts are those of the package fonts-liberation, which the tests need
// (cmake/debian-packages.txt).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "temporary_folder.hpp"

namespace exactcsg::io {
namespace {

using testing::Field;
using testing::HasSubstr;

Model model_of(const std::string& arguments, Rounding rounding = Rounding::AsWritten) {
  ReadOptions options;
  options.rounding = rounding;
  return read_openscad_csg("linear_extrude(height = 1) { text(" + arguments + "); }\n", "x.csg",
                           options);
}
Boundary boundary_of(const std::string& arguments) { return evaluate(model_of(arguments).solid); }
Rational area(const std::string& arguments) { return *exact_volume(boundary_of(arguments)); }
// Left, right, bottom, top.
std::array<Rational, 4> extents(const std::string& arguments) {
  const auto box = bounding_box(boundary_of(arguments));
  if (!box) {
    ADD_FAILURE() << "empty: " << arguments;
    return {};
  }
  return {box->lower.x, box->upper.x, box->lower.y, box->upper.y};
}

ErrorId refusal(const std::string& arguments) {
  try {
    model_of(arguments);
  } catch (const Error& error) {
    EXPECT_TRUE(error.details().position) << error.what();
    return error.id();
  }
  ADD_FAILURE() << "accepted: " << arguments;
  return ErrorId::InternalError;
}

// Laws of sums of doubles hold to the rounding of these sums.
void expect_near(const Rational& found, const Rational& expected) {
  const Rational difference = abs(found - expected);
  EXPECT_LE(difference, Rational(1, 1'000'000'000'000)) << found.get_d() << " " << expected.get_d();
}

// --- against OpenSCAD

bool has_openscad() { return std::system("openscad --version >/dev/null 2>&1") == 0; }  // NOLINT

using Corner = std::tuple<Rational, Rational, Rational>;

// The vertices of a Nef polyhedron in CGAL's text: `12 { ... | x y z w } 1`.
std::set<Corner> corners_of_nef(const std::string& file) {
  std::ifstream in(file);
  std::size_t count = 0;
  std::string line;
  while (std::getline(in, line) && !line.starts_with("halfedges")) {
    if (line.starts_with("vertices")) count = std::stoul(line.substr(8));
  }
  std::set<Corner> corners;
  while (corners.size() < count && std::getline(in, line)) {
    const std::size_t bar = line.find('|');
    if (bar == std::string::npos) continue;
    std::istringstream numbers(line.substr(bar + 1));
    Integer x, y, z, w;
    numbers >> x >> y >> z >> w;
    Rational corner[] = {Rational(x, w), Rational(y, w), Rational(z, w)};
    for (Rational& c : corner) c.canonicalize();
    corners.emplace(corner[0], corner[1], corner[2]);
  }
  EXPECT_GT(count, 0U);
  return corners;
}

// What is in the one set alone, as decimals.
std::string without(const std::set<Corner>& set, const std::set<Corner>& other) {
  std::ostringstream text;
  text.precision(10);
  for (const Corner& corner : set) {
    if (other.contains(corner)) continue;
    const auto& [x, y, z] = corner;
    text << '(' << x.get_d() << ", " << y.get_d() << ", " << z.get_d() << ") ";
  }
  return text.str();
}

class TextLikeOpenScad : public testing::TestWithParam<const char*> {};

// The corners are those of OpenSCAD's own export, all of them and to the last bit.
TEST_P(TextLikeOpenScad, HasItsCorners) {
  if (!has_openscad()) GTEST_SKIP() << "openscad is not installed";
  const exactcsg::test::Folder folder;
  const std::string source = folder.write(
      "model.csg", std::string("linear_extrude(height = 1) { text(") + GetParam() + "); }\n");
  const std::string answer = folder / "model.nef3";
  const std::string command =
      "openscad --render=cgal -o '" + answer + "' '" + source + "' >/dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT

  const Boundary ours = evaluate(model_of(GetParam(), Rounding::OpenScadGrid).solid);
  std::set<Corner> found;
  for (const Point3& p : ours.vertices) found.emplace(p.x, p.y, p.z);
  const std::set<Corner> expected = corners_of_nef(answer);
  EXPECT_EQ(found.size(), expected.size());
  EXPECT_EQ(without(found, expected), "");
  EXPECT_EQ(without(expected, found), "");
  // As written there is no other rounding than that of the clipping library.
  const Rational exact = area(GetParam());
  const Rational rounded = *exact_volume(ours);
  EXPECT_LE(abs(exact - rounded), Rational(1, 100)) << exact.get_d() << ' ' << rounded.get_d();
}

INSTANTIATE_TEST_SUITE_P(
    OpenscadText, TextLikeOpenScad,
    testing::Values(R"(text = "Ao8%")", R"(text = "sg", size = 12.3, $fn = 64)",
                    R"(text = "AV To", size = 0.7, font = "Liberation Serif:style=Bold Italic")",
                    R"(text = "fi fl", font = "Liberation Mono", spacing = 1.37)",
                    R"(text = "Tp", halign = "right", valign = "top")",
                    R"(text = "ljq", halign = "center", valign = "center", size = 7)",
                    R"(text = "jq", valign = "bottom", spacing = 0.9, size = 33)",
                    R"(text = "up", size = -3, halign = "center", valign = "top")",
                    R"(text = "over", spacing = 0.4)", R"(text = "back", spacing = -1)",
                    R"(text = "all", spacing = 0)",
                    R"(text = "dw", direction = "ttb", halign = "center", valign = "top")",
                    R"(text = "up", direction = "btt", halign = "right", valign = "bottom")",
                    R"(text = "dw", direction = "ttb", valign = "center", spacing = 1.2)",
                    R"(text = "left", direction = "rtl")",
                    "text = \"\xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d\"",
                    "text = \"\xd0\x9a\xd0\xb8\xd1\x80\", language = \"sr\", script = \"Cyrl\"",
                    "text = \"e\xcc\x81 a\xcc\x8a\"", "text = \"- \xff\xc3z\"",
                    "text = \"l \xe1\x9a\xa0\", direction = \"ltr\"",
                    R"(text = "un", font = "Nobody Has This", halign = "middle", valign = "of it")",
                    R"(text = "\x41\u00e9\U01d6a8\q\\ \" .")", "text = \"l\ni \\n \\t\"",
                    R"("pos", 5, "Liberation Sans:style=Bold")"));

// --- laws

TEST(OpenscadText, CountsHolesAndPieces) {
  // Of a sphere's kind with as many handles as the letter has holes.
  const auto expect = [](const std::string& letters, std::uint64_t pieces, std::int64_t holes) {
    const Topology found = topology(boundary_of("text = \"" + letters + "\""));
    EXPECT_EQ(found.components, pieces) << letters;
    EXPECT_EQ(found.genus, holes) << letters;
  };
  expect("l", 1, 0);
  expect("o", 1, 1);
  expect("8", 1, 2);
  expect("i", 2, 0);
  expect("%", 3, 2);
  expect("io8", 4, 3);
}

// A hyphen is a rectangle.
TEST(OpenscadText, HasTheAreaOfARectangle) {
  const auto [left, right, bottom, top] = extents(R"(text = "-", size = 7)");
  EXPECT_EQ(area(R"(text = "-", size = 7)"), (right - left) * (top - bottom));
  EXPECT_GT(left, 0);
  EXPECT_GT(bottom, 0);
}

// An em has 1/0.72 of the size: OpenSCAD sets type at 100 dots to the inch. In this font an em has
// 2048 units, the capital H is 1409 high, and each letter of the Mono has an advance of 1229, of
// which OpenSCAD takes 1000/1024; the hinting moves to whole pixels, 2170 to the em.
TEST(OpenscadText, IsAsLargeAsItsFontSays) {
  const Rational em = Rational(10) / Rational(72, 100);
  const Rational pixel = em / 2170;
  EXPECT_LE(abs(extents(R"(text = "H")")[3] - em * 1409 / 2048), pixel);
  const auto one = extents(R"(text = "l", font = "Liberation Mono")");
  const auto three = extents(R"(text = "  l", font = "Liberation Mono")");
  EXPECT_LE(abs(three[0] - one[0] - 2 * em * 1229 / 2048 * 1000 / 1024), 2 * pixel);
}

TEST(OpenscadText, IsScaledByItsSize) {
  const std::string words = R"(text = "size", $fn = 8)";
  expect_near(area(words + ", size = 20"), area(words + ", size = 5") * 16);
  expect_near(area(words + ", size = -5"), area(words + ", size = 5"));
  const auto small = extents(words + ", size = 5");
  const auto mirrored = extents(words + ", size = -5");
  EXPECT_EQ(mirrored[0], -small[1]);
  EXPECT_EQ(mirrored[3], -small[2]);
}

// The letters o and l influence one another by nothing but their advances.
TEST(OpenscadText, AddsAdvances) {
  const auto left_of = [](const std::string& before, const std::string& spacing) {
    return extents("text = \"" + before + "l\", spacing = " + spacing)[1];
  };
  const Rational alone = left_of("", "1");
  const Rational advance = left_of("o", "1") - alone;
  EXPECT_GT(advance, 5);
  expect_near(left_of("oo", "1") - alone, 2 * advance);
  expect_near(left_of("ooooo", "1") - alone, 5 * advance);
  expect_near(left_of("oo", "1.5") - alone, 3 * advance);
  EXPECT_EQ(left_of("lll", "0"), alone);
  expect_near(area(R"(text = "olo")"), 2 * area(R"(text = "o")") + area(R"(text = "l")"));
}

TEST(OpenscadText, KernsPairs) {
  const auto width = [](const std::string& letters) {
    const auto box = extents("text = \"" + letters + "\"");
    return Rational(box[1] - box[0]);
  };
  const Rational loose = width("A") + width("V");
  EXPECT_LT(width("AV"), loose);
  EXPECT_GE(width("AH"), width("A") + width("H"));
}

// The line has the advances' width; a letter does not fill its own.
TEST(OpenscadText, IsAlignedByHalfItsWidth) {
  const std::string words = R"(text = "oll")";
  const Rational advance =
      extents(R"(text = "olll")")[1] - extents(R"(text = "oll")")[1];  // of an l
  const Rational o_advance = extents(R"(text = "ooll")")[1] - extents(words)[1];
  const Rational width = o_advance + 2 * advance;
  const auto left = extents(words);
  const auto middle = extents(words + R"(, halign = "center")");
  const auto right = extents(words + R"(, halign = "right")");
  expect_near(middle[0], left[0] - width / 2);
  expect_near(right[0], left[0] - width);
  expect_near(right[1], left[1] - width);

  // By the letters' height above and below the baseline, in OpenSCAD's measure and whole pixels.
  const Rational pixel = Rational(10) / Rational(72, 100) / 2170;
  const auto baseline = extents(R"(text = "lg")");
  const Rational above = baseline[3] * 1000 / 1024;
  const Rational below = -baseline[2] * 1000 / 1024;
  const auto moved_up = [&](const std::string& alignment) {
    return Rational(extents(R"(text = "lg", valign = ")" + alignment + '"')[3] - baseline[3]);
  };
  EXPECT_EQ(moved_up("baseline"), 0);
  EXPECT_LE(abs(moved_up("top") + above), pixel);
  EXPECT_LE(abs(moved_up("center") - (below - above) / 2), pixel);
  EXPECT_LE(abs(moved_up("bottom") - below), pixel);
}

// 8 fragments a segment, and one more segment. Between a parabola and n chords over equal steps of
// its parameter there is an nth part of the nth part of what one chord leaves.
TEST(OpenscadText, CutsCurvesByFragments) {
  const auto vertices = [](const std::string& fineness) {
    return boundary_of(R"(text = "o", size = 10)" + fineness).vertices.size();
  };
  EXPECT_EQ(vertices(", $fn = 8"), vertices(", $fn = 15"));
  EXPECT_EQ(vertices(", $fn = 30"), vertices(""));
  const Rational two = area(R"(text = "o", $fn = 8)");
  const Rational four = area(R"(text = "o", $fn = 24)");
  const Rational eight = area(R"(text = "o", $fn = 56)");
  EXPECT_NE(two, four);
  expect_near(four - two, 4 * (eight - four));
}

TEST(OpenscadText, IsEmptyWithoutInk) {
  for (const char* const words : {R"(text = "")", "", R"(text = "  ")", R"(text = "a", size = 0)",
                                  R"(font = "Liberation Mono")", "text = undef"}) {
    EXPECT_TRUE(model_of(words).solid.is_empty()) << words;
    EXPECT_TRUE(model_of(words, Rounding::OpenScadGrid).solid.is_empty()) << words;
  }
}

TEST(OpenscadText, IsAPlanarFigureLikeOthers) {
  const auto volume = [](const std::string& text) {
    return *exact_volume(evaluate(read_openscad_csg(text, "x.csg").solid));
  };
  const Rational whole = area(R"(text = "o")");
  EXPECT_EQ(volume(R"(linear_extrude(height = 1) { difference() {
      square(size = [20, 20]); text(text = "o", halign = "left"); } })"),
            400 - whole + volume(R"(linear_extrude(height = 1) { difference() {
      text(text = "o"); square(size = [20, 20]); } })"));
  EXPECT_EQ(volume(R"(linear_extrude(height = 1) {
      multmatrix([[2, 1, 0, 5], [0, -3, 0, 1]]) { text(text = "o"); } })"),
            6 * whole);
}

// LAW: several threads may read models with text at once.
TEST(OpenscadText, IsTheSameOnSeveralThreads) {
  const std::string words = R"(text = "many at once", font = "Liberation Serif")";
  const std::string expected = digest(boundary_of(words));
  std::array<std::string, 4> found;
  std::vector<std::thread> threads;
  for (std::string& one : found) {
    threads.emplace_back([&one, &words] { one = digest(boundary_of(words)); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::string& one : found) EXPECT_EQ(one, expected);
}

// --- what the user is told

TEST(OpenscadText, NamesTheFontsItTook) {
  const Model model = read_openscad_csg(
      R"(linear_extrude(1) { text("a"); text("b", font = "Liberation Mono"); text("c"); })",
      "x.csg");
  ASSERT_EQ(model.fonts.size(), 2U);
  EXPECT_EQ(model.fonts[0].asked, "Liberation Sans:style=Regular");
  EXPECT_THAT(model.fonts[0].name, testing::MatchesRegex("Liberation Sans Regular, Version .*"));
  EXPECT_THAT(model.fonts[0].file, testing::EndsWith("LiberationSans-Regular.ttf"));
  EXPECT_THAT(model.fonts[1].file, testing::EndsWith("LiberationMono-Regular.ttf"));
  EXPECT_TRUE(model.warnings.empty());
}

TEST(OpenscadText, TellsWhatIsNotAsAskedFor) {
  const auto warned = [](const std::string& arguments, const std::string& text) {
    EXPECT_THAT(model_of(arguments).warnings,
                testing::Contains(Field(&Warning::text, HasSubstr(text))))
        << arguments;
  };
  warned(R"(text = "a", font = "Nobody Has This")", "there is no font 'Nobody Has This'");
  warned(R"(text = "a", font = "Liberation Sans:style=Heavy")", "there is no font");
  warned("text = \"a\xe1\x9a\xa0\", direction = \"ltr\"", "no glyph for U+16A0");
  warned("text = \"a\xff\"", "not valid UTF-8");
  warned(R"(text = "a", halign = "middle")", "halign = 'middle' is not known: 'left' counts");
  warned(R"(text = "a", valign = "middle")", "valign = 'middle' is not known: 'baseline' counts");
  warned(R"(text = "a", colour = "red")", "no argument 'colour'");
}

TEST(OpenscadText, IsRefusedByName) {
  EXPECT_EQ(refusal("text = 5"), ErrorId::BadArgument);
  EXPECT_EQ(refusal(R"(text = "a", font = [1])"), ErrorId::BadArgument);
  EXPECT_EQ(refusal(R"(text = "a", size = "big")"), ErrorId::BadArgument);
  EXPECT_EQ(refusal(R"(text = "a", size = 1e101)"), ErrorId::NumberOutOfRange);
  EXPECT_EQ(refusal(R"(text = "a", $fn = 1e9)"), ErrorId::TooLarge);
  EXPECT_EQ(refusal(R"(text = "a", direction = "invalid", script = "Runr")"), ErrorId::BadArgument);
}

// Two million bytes are shaped, and refused for their vertices before any is made exact.
TEST(OpenscadText, IsRefusedBeyondItsLimits) {
  EXPECT_EQ(refusal("text = \"" + std::string(1'000'000, 'a') + '"'), ErrorId::TooLarge);
  EXPECT_EQ(refusal("text = \"" + std::string(2'000'001, ' ') + '"'), ErrorId::TooLarge);
  EXPECT_TRUE(model_of("text = \"" + std::string(1'000'000, ' ') + '"').solid.is_empty());
}

// The environment while it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    const char* const before = std::getenv(name);
    if (before != nullptr) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(OpenscadText, WithoutAnyFontIsRefused) {
  const exactcsg::test::Folder folder;
  const Variable no_fonts(
      "FONTCONFIG_FILE",
      folder.write("fonts.conf",
                   "<?xml version=\"1.0\"?>\n"
                   "<!DOCTYPE fontconfig SYSTEM \"fonts.dtd\">\n<fontconfig/>\n"));
  const Variable home("HOME", folder.path().string());
  EXPECT_EQ(refusal(R"(text = "a")"), ErrorId::FontUnavailable);
  EXPECT_TRUE(model_of(R"(text = "")").solid.is_empty());
  // OpenSCAD's own variable brings them back.
  const Variable own("OPENSCAD_FONT_PATH", "/usr/share/fonts/truetype/liberation");
  EXPECT_EQ(model_of(R"(text = "a")").fonts.size(), 1U);
}

}  // namespace
}  // namespace exactcsg::io
