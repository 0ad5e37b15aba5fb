// SPDX-License-Identifier: GPL-3.0-or-later
// Cards, cells, universes and lattices: which cell a point is in, as the manual's rules say it of
// decks small enough to be followed by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "exactcsg/io/mcnp/deck.hpp"
#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "exactcsg/io/openmc/point_location.hpp"
#include "io/mcnp_support.hpp"

namespace exactcsg::io::mcnp {
namespace {

using openmc::Model;
using openmc::Point;
using openmc::PointVerdict;
using testing::ElementsAre;
using testing::HasSubstr;

// "universe 0 > cell 3: cell 3", "gap in ...", "boundary"
std::string where(const Model& model, const Point& point) {
  const openmc::Location location = openmc::locate(model, point);
  if (location.verdict == PointVerdict::OnBoundary) return "boundary";
  if (location.verdict == PointVerdict::InGap) return "gap";
  if (location.verdict == PointVerdict::InOverlap) return "overlap";
  return "cell " + std::to_string(model.cells[location.cells.front()].id);
}

// ---- cards -----------------------------------------------------------------------------------

TEST(Cards, AreJoinedAndStrippedOfComments) {
  const Deck deck = read_deck(
      "Message: x\nmore\n\nTITLE\n1 0 -1  $ a comment\n     imp:n=1\nC comment\n 2 0 &  $ another\n"
      "1 IMP:N=0\n\n  1\tSO 5\nc\n\nMODE n\nm1 1001 1\n\nafter the end\n",
      "f");
  EXPECT_EQ(deck.title, "TITLE");
  ASSERT_EQ(deck.cells.size(), 2U);
  EXPECT_EQ(deck.cells[0].text(), "1 0 -1 imp:n=1");
  EXPECT_EQ(deck.cells[1].text(), "2 0  1 imp:n=0");
  ASSERT_EQ(deck.surfaces.size(), 1U);
  EXPECT_EQ(deck.surfaces[0].text(), "1 so 5");
  EXPECT_EQ(deck.data.size(), 2U);
  // "imp:n=0" begins in line 9, column 3.
  const SourcePosition position = deck.cells[1].position(deck.cells[1].text().find("imp"));
  EXPECT_EQ(position.line, 9U);
  EXPECT_EQ(position.column, 3U);
}

TEST(Cards, MayEndInCarriageReturnsAndWithoutDataCards) {
  const Model model = read_geometry("t\r\n1 0 -1\r\n2 0 1\r\n\r\n1 so 5\r\n", "f");
  EXPECT_EQ(where(model, {0, 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {6, 0, 0}), "cell 2");
}

// The text of FCn and SCn may end in &, which does not swallow the next card.
TEST(Cards, OfTextHaveNoContinuationSign) {
  const Deck deck = read_deck("t\n1 0 -1\n\n1 so 5\n\nfc4 this &\ntr1 1 0 0\n", "f");
  ASSERT_EQ(deck.data.size(), 2U);
  EXPECT_EQ(deck.data[1].text(), "tr1 1 0 0");
}

TEST(Numbers, AreThoseOfFortran) {
  Card card(std::make_shared<const std::string>("f"));
  card.add_line("1.5+3 1d-3 -.5 5. 1e2 +2.5-1 7", 1, 1);
  const auto words = words_of(card, 0, card.text().size());
  EXPECT_THAT(values_of(card, entries_of(card, words, 0)),
              ElementsAre(1500, Rational(1, 1000), Rational(-1, 2), 5, 100, Rational(1, 4), 7));
}

TEST(Numbers, MayBeAbbreviated) {
  Card card(std::make_shared<const std::string>("f"));
  card.add_line("1 2r 3i 9 2m r .5m", 1, 1);
  const auto words = words_of(card, 0, card.text().size());
  EXPECT_THAT(values_of(card, entries_of(card, words, 0)),
              ElementsAre(1, 1, 1, 3, 5, 7, 9, 18, 18, 9));
  Card jumps(std::make_shared<const std::string>("f"));
  jumps.add_line("1 2j 4 j", 1, 1);
  const auto entries = entries_of(jumps, words_of(jumps, 0, jumps.text().size()), 0);
  ASSERT_EQ(entries.size(), 5U);
  EXPECT_FALSE(entries[1].value || entries[2].value || entries[4].value);
}

// ---- cells -----------------------------------------------------------------------------------

// Inside ball 1, slab 2 to 3: truth tables by hand at x = 0 (in the slab), 3, 6.
TEST(Regions, FollowTheOrderOfOperators) {
  const std::string surfaces = "1 so 4\n2 px -1\n3 px 1\n";
  const struct {
    const char* region;
    const char* at_0;
    const char* at_3;
    const char* at_6;
  } cases[] = {
      {"-1", "cell 1", "cell 1", "gap"},        {"1", "gap", "gap", "cell 1"},
      {"-1 2 -3", "cell 1", "gap", "gap"},      {"-1(2 -3)", "cell 1", "gap", "gap"},
      {"2 -3:3 -1", "cell 1", "cell 1", "gap"}, {"-1 (2 -3:3)", "cell 1", "cell 1", "gap"},
      {"(-1:2) 3", "gap", "cell 1", "cell 1"},  {"#(2 -3)", "gap", "cell 1", "cell 1"},
      {"#(2 -3) -1", "gap", "cell 1", "gap"},   {"-1 # ( 2 -3 )", "gap", "cell 1", "gap"},
      {"#(-1:#(2))", "gap", "gap", "cell 1"},   {"+3 -1", "gap", "cell 1", "gap"},
  };
  for (const auto& c : cases) {
    const Model model = model_of(c.region, surfaces);
    EXPECT_EQ(where(model, {0, 0, 0}), c.at_0) << c.region;
    EXPECT_EQ(where(model, {3, 0, 0}), c.at_3) << c.region;
    EXPECT_EQ(where(model, {6, 0, 0}), c.at_6) << c.region;
  }
}

TEST(Regions, TakeComplementsOfCells) {
  const Model model =
      read_geometry(deck_of("3 0 #1 #2\n1 0 -1\n2 0 -2 #1\n", "1 so 1\n2 so 2\n"), "text");
  EXPECT_EQ(where(model, {0, 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {Rational(3, 2), 0, 0}), "cell 2");
  EXPECT_EQ(where(model, {3, 0, 0}), "cell 3");
}

// Not surface 1, at whose positive side the middle is not.
TEST(Regions, TakeTwoComplementsOfACellForTheCell) {
  const Model model = read_geometry(deck_of("3 0 ##1\n1 0 -1 u=5\n", "1 so 1\n"), "text");
  EXPECT_EQ(where(model, {0, 0, 0}), "cell 3");
  EXPECT_EQ(where(model, {3, 0, 0}), "gap");
}

TEST(Regions, MayBeNestedWithoutEnd) {
  constexpr std::size_t depth = 40'000;
  std::string cell = "1 0 ";
  for (std::size_t i = 0; i < depth; ++i) cell += (i % 50 == 0) ? " &\n#(" : "#(";
  cell += "-1";
  for (std::size_t i = 0; i < depth; ++i) cell += (i % 50 == 0) ? " &\n)" : ")";
  const Model model = read_geometry(deck_of(cell + "\n", "1 so 1\n"), "text");
  EXPECT_EQ(class_at(model, {0, 0, 0}), PointClass::In);
}

TEST(Cells, ThatAreLikeOthersTakeTheirCardAndChangeIt) {
  const Model model = read_geometry(
      deck_of("1 5 -2.5 -1 imp:n=1 u=1\n2 like 1 but u=2 mat=7 rho=-3\n3 0 -2 fill=1\n"
              "4 0 2 fill=2\n9 like 2 but trcl=(5 0 0) mat=0\n",
              "1 so 1\n2 px 0\n"),
      "text");
  ASSERT_EQ(model.cells.size(), 5U);
  EXPECT_THAT(model.cells[0].materials, ElementsAre(std::optional<openmc::Id>(5)));
  EXPECT_THAT(model.cells[1].materials, ElementsAre(std::optional<openmc::Id>(7)));
  EXPECT_THAT(model.cells[4].materials, ElementsAre(std::optional<openmc::Id>()));
  EXPECT_EQ(where(model, {Rational(-1, 2), 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {Rational(1, 2), 0, 0}), "cell 2");
  EXPECT_EQ(where(model, {5, 0, 0}), "cell 9");
}

// Surface 1 of cell 2, which is moved, is 2001.
TEST(Cells, ThatAreMovedHaveSurfacesOfTheirOwn) {
  const Model model = read_geometry(
      deck_of("1 0 -1\n2 like 1 but trcl=(5 0 0)\n3 0 1 2001 -3\n4 0 3\n", "1 so 1\n3 so 9\n"),
      "text");
  EXPECT_EQ(where(model, {0, 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {5, 0, 0}), "cell 2");
  EXPECT_EQ(where(model, {Rational(5, 2), 0, 0}), "cell 3");
  EXPECT_EQ(where(model, {10, 0, 0}), "cell 4");
}

TEST(Cells, WithoutImportanceAreCells) {
  const Model model =
      read_geometry(deck_of("1 0 -1 imp:n,p=1\n2 0 1 imp:n,p=0\n", "1 so 1\n"), "text");
  EXPECT_EQ(where(model, {2, 0, 0}), "cell 2");
  EXPECT_TRUE(model.fills_space);
  EXPECT_TRUE(model.warnings.empty());
}

TEST(Cells, WarnOfParametersAndDataCardsThatMcnpDoesNotHave) {
  const Model model = read_geometry(
      deck_of("1 0 -1 imq:n=1 vol=3 wwn1:n=2 tmp=2.5-8\n", "1 so 1\n", "mode n\nxyz 1 2\nf4:n 1\n"),
      "text");
  ASSERT_EQ(model.warnings.size(), 2U);
  EXPECT_THAT(model.warnings[0].text, HasSubstr("xyz"));
  EXPECT_THAT(model.warnings[1].text, HasSubstr("imq"));
  EXPECT_EQ(model.warnings[1].position.line, 2U);
  EXPECT_EQ(model.warnings[1].position.column, 8U);
}

// The universe's origin is at (10, 0, 0), and its x axis along y.
TEST(Fills, AreMovedAndTurned) {
  const std::string cells = "1 0 -1 u=1\n2 0 1 u=1\n5 0 -5 ";
  const std::string surfaces = "1 sx 2 1\n5 so 99\n";
  const Model by_list = read_geometry(
      deck_of(cells + "fill=1 (10 0 0  0 1 0  -1 0 0  0 0 1)\n6 0 5\n", surfaces), "text");
  const Model by_degrees = read_geometry(
      deck_of(cells + "*fill=1(10 0 0  90 0 90  180 90 90  90 90 0)\n6 0 5\n", surfaces), "text");
  const Model by_number = read_geometry(
      deck_of(cells + "fill=1 (7)\n6 0 5\n", surfaces, "tr7 10 0 0  0 1 0  -1 0 0  0 0 1\n"),
      "text");
  for (const Model& model : {by_list, by_degrees, by_number}) {
    EXPECT_EQ(where(model, {10, 2, 0}), "cell 1");
    EXPECT_EQ(where(model, {2, 0, 0}), "cell 2");
    EXPECT_EQ(where(model, {12, 0, 0}), "cell 2");
  }
}

// Without a transformation of its own the fill has that of the cell.
TEST(Fills, FollowTheCellThatTheyAreIn) {
  const Model model = read_geometry(
      deck_of("1 0 -1 u=1\n2 0 1 u=1\n5 0 -5 fill=1 trcl=(10 0 0)\n6 0 #5\n", "1 so 1\n5 so 3\n"),
      "text");
  EXPECT_EQ(where(model, {10, 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {12, 0, 0}), "cell 2");
  EXPECT_EQ(where(model, {0, 0, 0}), "cell 6");
}

// ---- lattices --------------------------------------------------------------------------------

// Universes 1 to 6 are full of their own cells; cell 9 shows the lattice in a big ball.
std::string lattice_deck(const std::string& lattice_cell, const std::string& surfaces,
                         const std::string& data = "mode n\n") {
  std::string cells;
  for (int u = 1; u <= 6; ++u) {
    cells += std::to_string(u) + " 0 -900:900 u=" + std::to_string(u) + "\n";
  }
  return deck_of(cells + "20 8 -1 " + lattice_cell + "\n9 0 -901 fill=7\n10 0 901\n",
                 "900 px 0\n901 so 1000\n" + surfaces + "\n", data);
}

// Across the first side is (1, 0, 0), the first index varies fastest.
TEST(Lattices, CountElementsFromTheFirstSide) {
  const Model model =
      read_geometry(lattice_deck("-1 2 -3 4 u=7 lat=1 fill=0:2 -1:0 0:0  1 2 3  4 5 6",
                                 "1 px 1\n2 px -1\n3 py 2\n4 py -2"),
                    "text");
  EXPECT_EQ(where(model, {0, -4, 0}), "cell 1");
  EXPECT_EQ(where(model, {2, -4, 0}), "cell 2");
  EXPECT_EQ(where(model, {4, -4, 0}), "cell 3");
  EXPECT_EQ(where(model, {0, 0, 0}), "cell 4");
  EXPECT_EQ(where(model, {2, 0, 50}), "cell 5");
  EXPECT_EQ(where(model, {4, 0, -50}), "cell 6");
  EXPECT_EQ(where(model, {6, 0, 0}), "gap");
  EXPECT_EQ(where(model, {-2, 0, 0}), "gap");
  EXPECT_EQ(where(model, {1, 0, 0}), "boundary");
  const openmc::Location location = openmc::locate(model, {4, -4, 0});
  EXPECT_THAT(openmc::path_text(model, location.path), HasSubstr("lattice 20 (2, -1)"));
}

// The other way round: across side 1 is x < 0; and y before x.
TEST(Lattices, CountElementsAsTheSidesAreOrdered) {
  const Model model =
      read_geometry(lattice_deck("3 -4 2 -1 u=7 lat=1 fill=0:2 0:1 0:0  1 2 3  4 5 6",
                                 "1 px 1\n2 px -1\n3 py -2\n4 py 2"),
                    "text");
  EXPECT_EQ(where(model, {0, 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {0, -4, 0}), "cell 2");
  EXPECT_EQ(where(model, {0, -8, 0}), "cell 3");
  EXPECT_EQ(where(model, {-2, 0, 0}), "cell 4");
  EXPECT_EQ(where(model, {-2, -8, 0}), "cell 6");
  const openmc::Location location = openmc::locate(model, {-2, -8, 0});
  EXPECT_THAT(openmc::path_text(model, location.path), HasSubstr("lattice 20 (2, 1)"));
}

// A body gives its facets in their order; three pairs make layers, also from above.
TEST(Lattices, MayHaveLayersAndBeGivenByBodies) {
  for (const char* sides : {"-1", "-11 12 -13 14 -15 16"}) {
    const Model model = read_geometry(
        lattice_deck(std::string(sides) + " u=7 lat=1 fill=0:0 0:1 -1:1  1 2  3 4  5 6",
                     "1 rpp -1 1 -1 1 -1 1\n11 px 1\n12 px -1\n13 py 1\n14 py -1\n15 pz 1\n16 pz "
                     "-1"),
        "text");
    EXPECT_EQ(where(model, {0, 0, -2}), "cell 1");
    EXPECT_EQ(where(model, {0, 2, -2}), "cell 2");
    EXPECT_EQ(where(model, {0, 0, 0}), "cell 3");
    EXPECT_EQ(where(model, {0, 2, 2}), "cell 6");
    EXPECT_EQ(where(model, {0, 0, 4}), "gap");
  }
}

// Without an end along x: the frame of the lattice is turned, the universes are not.
TEST(Lattices, MayGoOnForEverAlongAnyAxis) {
  const std::string cells =
      "1 0 -1 u=1\n2 0 1 u=1\n3 0 -11 12 -13 14 u=7 lat=1 fill=0:1 0:0 0:0  1 4\n"
      "4 0 -1:1 u=4\n9 0 -901 fill=7\n10 0 901\n";
  // In each element a ball that is off its middle, at x = 5.
  const Model model = read_geometry(
      deck_of(cells, "1 s 5 0 0 0.5\n901 so 99\n11 pz 1\n12 pz -1\n13 py 1\n14 py -1\n"), "text");
  EXPECT_EQ(where(model, {5, 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {5, 0, 2}), "cell 4");
  EXPECT_EQ(where(model, {0, 0, 0}), "cell 2");
  EXPECT_EQ(where(model, {0, 5, 0}), "gap");
}

// The origin of an element's universe is where that of (0, 0, 0) is in it, not at its middle.
TEST(Lattices, NeedNotHaveTheOriginInTheMiddle) {
  const Model model = read_geometry(
      deck_of("1 0 -1 u=1\n2 0 1 u=1\n20 0 -11 12 -13 14 u=7 lat=1 fill=0:1 0:0 0:0 1 1\n"
              "9 0 -901 fill=7\n10 0 901\n",
              "1 c/z 1 1 0.5\n901 so 99\n11 px 4\n12 px 0\n13 py 4\n14 py 0\n"),
      "text");
  EXPECT_EQ(where(model, {1, 1, 0}), "cell 1");
  EXPECT_EQ(where(model, {5, 1, 0}), "cell 1");
  EXPECT_EQ(where(model, {2, 2, 0}), "cell 2");
  EXPECT_EQ(where(model, {-1, 1, 0}), "gap");
}

TEST(Lattices, MayBeFilledWithTheirOwnMaterialWithNothingAndWithMovedUniverses) {
  const Model model =
      read_geometry(lattice_deck("-1 2 -3 4 u=7 lat=1 fill=0:3 0:0 0:0  1 7 0 5 (0 0 1)",
                                 "1 px 1\n2 px -1\n3 py 1\n4 py -1"),
                    "text");
  EXPECT_EQ(where(model, {Rational(1, 2), 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {2, 0, 0}), "cell 20");
  EXPECT_EQ(where(model, {4, 0, 0}), "gap");
  EXPECT_EQ(where(model, {Rational(13, 2), 0, 0}), "cell 5");
}

TEST(Lattices, FilledWithOneUniverseAreInfinite) {
  const Model model = read_geometry(
      lattice_deck("-1 2 -3 4 u=7 lat=1 fill=3", "1 px 1\n2 px -1\n3 py 1\n4 py -1"), "text");
  EXPECT_EQ(where(model, {Rational(1, 2), 0, 0}), "cell 3");
  EXPECT_EQ(where(model, {Rational(801, 2), 77, 5}), "boundary");
  EXPECT_EQ(where(model, {Rational(801, 2) + Rational(1, 4), 76, 5}), "cell 3");
}

TEST(Lattices, MayBeMovedAndTurned) {
  const Model model = read_geometry(
      lattice_deck(
          "-1 2 -3 4 u=7 lat=1 fill=0:2 0:0 0:0  1 2 3  trcl=(10 0 0  0 1 0  -1 0 0  0 0 1)",
          "1 px 1\n2 px -1\n3 py 2\n4 py -2"),
      "text");
  EXPECT_EQ(where(model, {10 - 1, Rational(1, 2), 0}), "cell 1");
  EXPECT_EQ(where(model, {10, Rational(5, 2), 0}), "cell 2");
  EXPECT_EQ(where(model, {10, Rational(9, 2), 0}), "cell 3");
  EXPECT_EQ(where(model, {12, 0, 0}), "boundary");
  EXPECT_EQ(where(model, {13, 0, 0}), "gap");
}

// Of a hexagon across x: (1,0) at (2,0), (0,1) at (1, sqrt 3), (-1,1) at (-1, sqrt 3).
TEST(HexagonalLattices, CountElementsRoundTheirFirstSide) {
  const std::string planes =
      "11 px 1\n12 px -1\n13 p 1 1.7320508 0 2\n14 p 1 1.7320508 0 -2\n"
      "15 p -1 1.7320508 0 2\n16 p -1 1.7320508 0 -2\n17 pz 3\n18 pz -3";
  const Model model = read_geometry(
      lattice_deck("-11 12 -13 14 -15 16 u=7 lat=2 fill=-1:1 -1:1 0:0  1 2 3  4 5 6  6 4 2",
                   planes),
      "text");
  const Rational h(173205, 100000);
  const Rational x(1, 10);  // beside the planes px 0 of the universes
  EXPECT_EQ(where(model, {x, 0, 0}), "cell 5");
  EXPECT_EQ(where(model, {2 + x, 0, 0}), "cell 6");
  EXPECT_EQ(where(model, {-2 + x, 0, 0}), "cell 4");
  EXPECT_EQ(where(model, {1 + x, h, 0}), "cell 4");    // (0, 1)
  EXPECT_EQ(where(model, {-1 + x, h, 0}), "cell 6");   // (-1, 1)
  EXPECT_EQ(where(model, {-1 + x, -h, 0}), "cell 2");  // (0, -1)
  EXPECT_EQ(where(model, {1 + x, -h, 0}), "cell 3");   // (1, -1)
  EXPECT_EQ(where(model, {3 + x, h, 0}), "cell 2");    // (1, 1)
  EXPECT_EQ(where(model, {-3 + x, -h, 0}), "cell 1");  // (-1, -1)
  EXPECT_EQ(where(model, {x, 2 * h, 0}), "gap");
  EXPECT_TRUE(model.warnings.empty());
  const openmc::Location location = openmc::locate(model, {-1 + x, h, 0});
  EXPECT_THAT(openmc::path_text(model, location.path), HasSubstr("lattice 20 (-1, 1)"));
}

// A prism along x by its body, with layers; its first vector is along z.
TEST(HexagonalLattices, MayBeGivenByBodies) {
  const Model model = read_geometry(
      lattice_deck("-11 u=7 lat=2 fill=0:1 0:0 0:1  1 2  3 4", "11 rhp 0 0 0  4 0 0  0 0 1"),
      "text");
  EXPECT_EQ(where(model, {2, 0, 0}), "cell 1");
  EXPECT_EQ(where(model, {2, 0, 2}), "cell 2");
  EXPECT_EQ(where(model, {6, 0, 0}), "cell 3");
  EXPECT_EQ(where(model, {6, 0, 2}), "cell 4");
  EXPECT_EQ(where(model, {-2, 0, 0}), "gap");
  EXPECT_EQ(where(model, {2, 2, Rational(1, 4)}), "gap");
}

TEST(HexagonalLattices, ThatAreNotQuiteRegularAreMadeSoWithAWarning) {
  const std::string nearly =
      "11 px 1\n12 px -1\n13 p 0.5 0.86603 0 1\n14 p 0.5 0.86603 0 -1.00001\n"
      "15 p -0.5 0.86603 0 1\n16 p -0.5 0.86603 0 -1.00001";
  const Model model =
      read_geometry(lattice_deck("-11 12 -13 14 -15 16 u=7 lat=2 fill=1", nearly), "text");
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_THAT(model.warnings.front().text, HasSubstr("corners move"));
}

// ---- the same in OpenMC's words ----------------------------------------------------------------

struct Twin {
  const char* name;
  Point reach;                      // points from -reach to reach
  std::vector<openmc::Id> outside;  // cells that OpenMC's model has no need of
};
void PrintTo(const Twin& t, std::ostream* stream) { *stream << t.name; }

const Twin twins[] = {
    {"pin_cell", {1, 1, 12}, {9}},
    {"assembly_17x17", {11, 11, 200}, {99}},
    {"hexagonal_core", {26, 26, 52}, {99}},
    {"turned_units", {15, 15, 15}, {99}},
    {"room_with_window", {300, 300, 300}, {9}},
};

class Twins : public testing::TestWithParam<Twin> {
 protected:
  Model deck = read_deck_file(GetParam().name + std::string(".mcnp"));
  Model xml = openmc::read_geometry_file(std::string(EXACTCSG_SOURCE_DIR) + "/data/openmc/" +
                                         GetParam().name + ".xml");
};

// Cells have the same numbers in both files.
TEST_P(Twins, HaveTheSameCellsAtRandomPoints) {
  const Twin& twin = GetParam();
  std::mt19937 random(7);
  std::uniform_int_distribution<long> thousandths(-1000, 1000);
  const openmc::PointLocator in_deck(deck);
  const openmc::PointLocator in_xml(xml);
  std::size_t inside = 0;
  for (int n = 0; n < 4000; ++n) {
    const auto coordinate = [&](std::size_t i) {
      return Rational(twin.reach[i] * Rational(thousandths(random), 1000));
    };
    const Point point(coordinate(0), coordinate(1), coordinate(2));
    const openmc::Location first = in_deck(point);
    const openmc::Location second = in_xml(point);
    if (second.verdict == PointVerdict::InGap) {
      ASSERT_EQ(first.verdict, PointVerdict::InCell);
      EXPECT_EQ(deck.cells[first.cells.front()].id, twin.outside.front());
      continue;
    }
    if (second.verdict == PointVerdict::OnBoundary) {
      EXPECT_EQ(first.verdict, PointVerdict::OnBoundary);
      continue;
    }
    ASSERT_EQ(second.verdict, PointVerdict::InCell);
    ASSERT_EQ(first.verdict, PointVerdict::InCell);
    EXPECT_EQ(deck.cells[first.cells.front()].id, xml.cells[second.cells.front()].id);
    ++inside;
  }
  EXPECT_GT(inside, 300U);
}

// The bounds of each material's volume have values in common, and are close.
TEST_P(Twins, HaveTheSameVolumes) {
  openmc::VolumeLimits limits;
  limits.relative_width = 1e-4;
  const auto first = openmc::measure_volumes(deck, limits);
  const auto second = openmc::measure_volumes(xml, limits);
  std::size_t compared = 0;
  for (const auto& material : second.materials) {
    if (material.materials == openmc::Materials{std::nullopt}) continue;  // also outside
    for (const auto& other : first.materials) {
      if (other.materials != material.materials) continue;
      ASSERT_TRUE(material.visible.volume && other.visible.volume);
      const Rational slack = material.visible.volume->upper * rational_of(1e-12);
      EXPECT_LE(other.visible.volume->lower, Rational(material.visible.volume->upper + slack));
      EXPECT_GE(other.visible.volume->upper, Rational(material.visible.volume->lower - slack));
      ++compared;
    }
  }
  EXPECT_GE(compared, 2U);
}

INSTANTIATE_TEST_SUITE_P(Table, Twins, testing::ValuesIn(twins));

}  // namespace
}  // namespace exactcsg::io::mcnp
