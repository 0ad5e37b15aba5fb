// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with MCNP input files: every text is refused by its id at the place that a person
// would point at. Lines and columns were counted by hand. And: whatever a text is, it is answered.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "io/malformed.hpp"
#include "io/mcnp_support.hpp"

namespace exactcsg::io::mcnp {
namespace {

using namespace std::string_literals;

using test::Malformed;

// The card in question is line 2 of the cells ...
std::string with_cell(const std::string& card, const std::string& data = "mode n\n") {
  return "t\n" + card + "\n5 0 -1\n6 0 1\n7 0 -1 u=4\n\n1 so 3\n2 px 1\n3 px -1\n4 cz 2\n" +
         "8 rpp 0 1 0 1 0 1\n9 trc 0 0 0 0 0 1 2 1\n\n" + data;
}
// ... line 5 of the surfaces ...
std::string with_surface(const std::string& card, const std::string& data = "mode n\n") {
  return "t\n1 0 -1\n2 0 1\n\n" + card + "\n1 so 3\n\n" + data;
}
// ... and line 6 of the data.
std::string with_data(const std::string& card) { return "t\n1 0 -1\n\n1 so 3\n\n" + card + "\n"; }
// Of a lattice cell "1 0 SIDES lat=...": the card itself is to blame, in line 2.
std::string with_lattice(const std::string& rest, const std::string& surfaces = "") {
  return "t\n1 0 " + rest + "\n2 0 -10 u=1\n3 0 -10 fill=2\n\n1 px 1\n2 px -1\n3 py 1\n4 py -1\n" +
         "5 pz 1\n6 pz -1\n7 p 1 1 0 2\n8 p 1 1 0 -2\n10 so 9\n" + surfaces + "\n";
}

const Malformed table[] = {
    // the file
    {"empty", "", ErrorId::EmptyFile, 0, 0},
    {"only_blanks", " \n\n", ErrorId::EmptyFile, 0, 0},
    {"zero_byte", "t\n1 0 -1\n2 \0"s, ErrorId::NotText, 3, 3},
    {"title_alone", "t\n", ErrorId::MissingValue, 1, 1},
    {"no_cells", "t\n\n1 so 3\n", ErrorId::MissingValue, 2, 1},
    {"ends_in_cells", "t\n1 0 -1\n", ErrorId::TruncatedInput, 2, 1},
    {"ends_before_surfaces", "t\n1 0 -1\n\n", ErrorId::TruncatedInput, 3, 1},
    {"two_blank_lines", "t\n1 0 -1\n\n\n1 so 3\n", ErrorId::MissingValue, 4, 1},
    {"ends_in_message", "message: x\n", ErrorId::TruncatedInput, 1, 1},
    {"continuation_of_nothing", "t\n      1 0 -1\n\n1 so 3\n", ErrorId::UnexpectedText, 2, 7},
    {"too_long", "t\n1 0 -1" + std::string(130, ' ') + "2\n\n1 so 3\n", ErrorId::UnexpectedText, 2,
     137},
    {"blank_behind_ampersand", "t\n1 0 -1 &\n\n1 so 3\n", ErrorId::UnexpectedText, 3, 1},
    {"ends_behind_ampersand", "t\n1 0 -1\n\n1 so &\n", ErrorId::TruncatedInput, 4, 1},
    // cells
    {"cell_without_number", with_cell("x 0 -1"), ErrorId::UnexpectedText, 2, 1},
    {"cell_zero", with_cell("0 0 -1"), ErrorId::BadArgument, 2, 1},
    {"cell_twice", with_cell("5 0 -1"), ErrorId::DuplicateId, 3, 1},
    {"cell_alone", with_cell("1"), ErrorId::MissingValue, 2, 2},
    {"cell_without_geometry", with_cell("1 0"), ErrorId::UnexpectedText, 2, 4},
    {"material_without_density", with_cell("1 4"), ErrorId::MissingValue, 2, 3},
    {"density_is_no_number", with_cell("1 4 (-1)"), ErrorId::UnexpectedText, 2, 5},
    {"negative_material", with_cell("1 -4 -1 -1"), ErrorId::BadArgument, 2, 3},
    {"undefined_surface", with_cell("1 0 -1 77"), ErrorId::UndefinedId, 2, 8},
    {"undefined_surface_of_a_cell", with_cell("1 0 -5001"), ErrorId::UndefinedId, 2, 5},
    {"undefined_complement", with_cell("1 0 #77"), ErrorId::UndefinedId, 2, 6},
    {"complement_of_itself", with_cell("1 0 -1 #1"), ErrorId::BadArgument, 2, 9},
    {"complement_in_moved_cell", with_cell("1 0 #5 trcl=(1 0 0)"), ErrorId::UnsupportedNode, 2, 6},
    {"open_parenthesis", with_cell("1 0 (-1 2"), ErrorId::UnexpectedText, 2, 5},
    {"closed_parenthesis", with_cell("1 0 -1) 2"), ErrorId::UnexpectedText, 2, 7},
    {"empty_parentheses", with_cell("1 0 () 2"), ErrorId::UnexpectedText, 2, 6},
    {"union_with_nothing", with_cell("1 0 -1:"), ErrorId::UnexpectedText, 2, 8},
    {"union_of_nothing", with_cell("1 0 :1"), ErrorId::UnexpectedText, 2, 5},
    {"complement_of_nothing", with_cell("1 0 #"), ErrorId::UnexpectedText, 2, 6},
    {"no_surface", with_cell("1 0 -1 ; 2"), ErrorId::UnexpectedText, 2, 8},
    {"bar_of_openmc", with_cell("1 0 -1 | 2"), ErrorId::UnexpectedText, 2, 8},
    {"many_digits", with_cell("1 0 -1234567890"), ErrorId::NumberOutOfRange, 2, 6},
    {"facet_that_is_not_there", with_cell("1 0 -8.7"), ErrorId::BadArgument, 2, 5},
    {"facet_of_no_body", with_cell("1 0 -1.1"), ErrorId::BadArgument, 2, 5},
    {"facet_zero", with_cell("1 0 -8.0"), ErrorId::UnexpectedText, 2, 7},
    {"facet_of_a_cone", with_cell("1 0 -9.1"), ErrorId::UnsupportedNode, 2, 5},
    {"like_nothing", with_cell("1 like but u=2"), ErrorId::UnexpectedText, 2, 3},
    {"like_undefined", with_cell("1 like 77 but u=2"), ErrorId::UndefinedId, 2, 8},
    {"like_later", with_cell("1 like 5 but u=2"), ErrorId::UnsupportedNode, 2, 8},
    {"two_universes", with_cell("1 0 -1 u=2 3"), ErrorId::WrongCount, 2, 12},
    {"universe_is_no_number", with_cell("1 0 -1 u=2.5"), ErrorId::UnexpectedText, 2, 10},
    {"no_universe", with_cell("1 0 -1 u="), ErrorId::MissingValue, 2, 8},
    {"lattice_three", with_cell("1 0 -1 lat=3"), ErrorId::BadArgument, 2, 12},
    {"star_of_no_use", with_cell("1 0 -1 *u=3"), ErrorId::UnknownNode, 2, 8},
    {"fill_undefined", with_cell("1 0 -1 fill=77"), ErrorId::UndefinedId, 2, 13},
    {"fill_zero", with_cell("1 0 -1 fill=0"), ErrorId::UndefinedId, 2, 13},
    {"fill_negative", with_cell("1 0 -1 fill=-4"), ErrorId::BadArgument, 2, 13},
    {"fill_with_too_many", with_cell("1 0 -1 fill=4 4"), ErrorId::WrongCount, 2, 15},
    {"fill_itself", with_cell("1 0 -1 u=9 fill=9"), ErrorId::CyclicFill, 2, 1},
    {"fill_array_without_lattice", with_cell("1 0 -1 fill=0:1 0:0 0:0 4 4"), ErrorId::BadArgument,
     2, 8},
    {"fill_with_two_ranges", with_cell("1 0 -1 lat=1 fill=0:1 0:0"), ErrorId::MissingValue, 2, 14},
    {"fill_with_a_range_turned_round", with_cell("1 0 -1 lat=1 fill=0:1 1:0 0:0 4 4"),
     ErrorId::BadArgument, 2, 23},
    {"fill_with_too_few", with_cell("1 0 -1 lat=1 fill=0:1 0:1 0:0 4 4 4"), ErrorId::WrongCount, 2,
     14},
    {"fill_with_a_jump", with_cell("1 0 -1 lat=1 fill=0:1 0:0 0:0 4 j"), ErrorId::BadArgument, 2,
     33},
    {"fill_too_large", with_cell("1 0 -1 lat=1 fill=0:99999 0:99999 0:0 4"), ErrorId::TooLarge, 2,
     14},
    {"undefined_transformation", with_cell("1 0 -1 trcl=3"), ErrorId::UndefinedId, 2, 13},
    {"empty_placement", with_cell("1 0 -1 trcl=()"), ErrorId::MissingValue, 2, 13},
    {"negative_material_of_a_parameter", with_cell("1 0 -1 mat=-3"), ErrorId::BadArgument, 2, 12},
    {"parameter_twice", with_cell("1 0 -1 u=4 u=5"), ErrorId::UnexpectedText, 2, 12},
    {"placement_twice", with_cell("1 0 -1 trcl=(1 0 0) *trcl=(1 0 0)"), ErrorId::UnexpectedText, 2,
     21},
    {"open_placement", with_cell("1 0 -1 trcl=(1 2 3"), ErrorId::UnexpectedText, 2, 13},
    {"two_transformations", with_cell("1 0 -1 fill=4 (1 0 0) trcl=(1 0 0)"),
     ErrorId::UnsupportedNode, 2, 13},
    {"no_cell_of_the_root", "t\n1 0 -1 u=1\n\n1 so 3\n", ErrorId::NoRootUniverse, 2, 1},
    {"read_card", "t\nread file=x\n\n1 so 3\n", ErrorId::UnsupportedNode, 2, 1},
    // lattices
    {"lattice_with_company", with_lattice("-1 2 -3 4 u=2 lat=1 fill=1\n9 0 -10 u=2"),
     ErrorId::BadArgument, 2, 1},
    {"lattice_of_slabs", with_lattice("-1 2 u=2 lat=1 fill=1"), ErrorId::UnsupportedNode, 2, 1},
    {"lattice_of_three_sides", with_lattice("-1 2 -3 u=2 lat=1 fill=1"), ErrorId::WrongCount, 2, 1},
    {"lattice_of_a_ball", with_lattice("-10 u=2 lat=1 fill=1"), ErrorId::BadArgument, 2, 1},
    {"lattice_of_a_union", with_lattice("-1:2 -3 4 u=2 lat=1 fill=1"), ErrorId::BadArgument, 2, 1},
    {"lattice_in_disorder", with_lattice("-1 -3 2 4 u=2 lat=1 fill=1"), ErrorId::BadArgument, 2, 1},
    {"lattice_turned_out", with_lattice("1 -2 -3 4 u=2 lat=1 fill=1"), ErrorId::BadArgument, 2, 1},
    {"lattice_askew", with_lattice("-1 2 -7 8 u=2 lat=1 fill=1"), ErrorId::UnsupportedNode, 2, 1},
    {"lattice_across_x_twice", with_lattice("-1 2 -1 2 u=2 lat=1 fill=1"), ErrorId::BadArgument, 2,
     1},
    {"lattice_with_layers_without_ends", with_lattice("-1 2 -3 4 u=2 lat=1 fill=0:0 0:0 0:1 1 1"),
     ErrorId::BadArgument, 2, 1},
    {"hexagons_of_four_sides", with_lattice("-1 2 -3 4 u=2 lat=2 fill=1"), ErrorId::WrongCount, 2,
     1},
    {"hexagons_of_a_box", with_lattice("-1 2 -3 4 -5 6 u=2 lat=2 fill=1"), ErrorId::UnsupportedNode,
     2, 1},
    {"hexagons_that_are_not_regular", with_lattice("-1 2 -7 8 -3 4 u=2 lat=2 fill=1"),
     ErrorId::UnsupportedNode, 2, 1},
    {"complement_of_a_lattice", with_lattice("-1 2 -3 4 u=2 lat=1 fill=1\n9 0 -10 #1"),
     ErrorId::UnsupportedNode, 3, 10},
    // 5000 rings round a row of two layers: 150 million hexagons of which 20000 are filled.
    {"hexagons_round_a_long_row",
     with_lattice("-11 u=2 lat=2 fill=0:9999 0:0 0:1 1 19999r", "11 rhp 0 0 -1 0 0 2 1 0 0\n"),
     ErrorId::TooLarge, 2, 1},
    // surfaces
    {"periodic_with_ten_digits", with_surface("2 -2147483648 px 1"), ErrorId::NumberOutOfRange, 5,
     3},
    {"surface_without_type", with_surface("2"), ErrorId::MissingValue, 5, 1},
    {"surface_without_number", with_surface("px 1"), ErrorId::UnexpectedText, 5, 1},
    {"surface_zero", with_surface("0 px 1"), ErrorId::BadArgument, 5, 1},
    {"surface_twice", with_surface("1 px 1"), ErrorId::DuplicateId, 6, 1},
    {"unknown_surface", with_surface("2 ball 1"), ErrorId::UnknownNode, 5, 3},
    {"type_of_openmc", with_surface("2 z-cylinder 0 0 1"), ErrorId::UnknownNode, 5, 3},
    {"missing_number", with_surface("2 s 0 0 0"), ErrorId::WrongCount, 5, 3},
    {"number_too_many", with_surface("2 so 1 2"), ErrorId::WrongCount, 5, 8},
    {"not_a_number", with_surface("2 so one"), ErrorId::UnexpectedText, 5, 6},
    {"nan", with_surface("2 so nan"), ErrorId::UnexpectedText, 5, 6},
    {"too_large", with_surface("2 px 1+101"), ErrorId::NumberOutOfRange, 5, 6},
    {"huge_exponent", with_surface("2 px 1e99999"), ErrorId::NumberOutOfRange, 5, 6},
    {"repetition_of_nothing", with_surface("2 px 3r"), ErrorId::UnexpectedText, 5, 6},
    {"interpolation_to_nothing", with_surface("2 p 1 2i"), ErrorId::MissingValue, 5, 7},
    {"logarithmic_interpolation", with_surface("2 p 1 2ilog 8"), ErrorId::UnsupportedNode, 5, 7},
    {"jumped_coefficient", with_surface("2 p 1 2j 4"), ErrorId::BadArgument, 5, 7},
    {"endless_repetition", with_surface("2 p 1 999999999r"), ErrorId::TooLarge, 5, 7},
    {"negative_radius", with_surface("2 so -1"), ErrorId::BadArgument, 5, 6},
    {"zero_radius", with_surface("2 cz 0"), ErrorId::DegenerateSurface, 5, 6},
    {"zero_normal", with_surface("2 p 0 0 0 1"), ErrorId::DegenerateSurface, 5, 5},
    {"points_on_a_line", with_surface("2 p 0 0 0 1 1 1 2 2 2"), ErrorId::DegenerateSurface, 5, 5},
    {"zero_slope", with_surface("2 kz 1 0"), ErrorId::DegenerateSurface, 5, 8},
    {"sheet_two", with_surface("2 kz 1 1 2"), ErrorId::BadArgument, 5, 10},
    {"nowhere_negative", with_surface("2 gq 1 1 1 0 0 0 0 0 0 1"), ErrorId::DegenerateSurface, 5,
     6},
    {"no_equation", with_surface("2 gq 9j"), ErrorId::BadArgument, 5, 6},
    {"inner_torus", with_surface("2 tz 0 0 0 -1 2 2"), ErrorId::UnsupportedNode, 5, 12},
    {"torus_without_section", with_surface("2 tz 0 0 0 3 0 2"), ErrorId::DegenerateSurface, 5, 14},
    {"points_on_parallel_planes", with_surface("2 y 1 2 1 3 3 4"), ErrorId::BadArgument, 5, 9},
    {"points_on_both_sheets", with_surface("2 x 5 4 3 0 -5 4"), ErrorId::BadArgument, 5, 5},
    {"one_point_and_a_half", with_surface("2 x 0 0 1"), ErrorId::WrongCount, 5, 3},
    {"rpp_turned_round", with_surface("2 rpp 1 0 0 1 0 1"), ErrorId::BadArgument, 5, 9},
    {"rpp_without_extent", with_surface("2 rpp 0 1 0 1 0 0"), ErrorId::UnsupportedNode, 5, 17},
    {"box_askew", with_surface("2 box 0 0 0 1 0 0 1 1 0 0 0 1"), ErrorId::BadArgument, 5, 19},
    {"cylinder_without_height", with_surface("2 rcc 0 0 0 0 0 0 1"), ErrorId::DegenerateSurface, 5,
     13},
    {"ellipsoid_by_foci", with_surface("2 ell 0 0 -2 0 0 2 6"), ErrorId::UnsupportedNode, 5, 20},
    {"cone_of_equal_radii", with_surface("2 trc 0 0 0 0 0 1 2 2"), ErrorId::BadArgument, 5, 21},
    {"side_of_two_corners",
     with_surface(
         "2 arb 0 0 0 2 0 0 2 2 0 0 2 0 1 1 3 0 0 0 0 0 0 0 0 0\n      1200 1250 2350 3450 "
         "4150 0"),
     ErrorId::BadArgument, 6, 7},
    {"side_that_is_not_flat",
     with_surface(
         "2 arb 0 0 0 2 0 0 2 2 1 0 2 0 1 1 3 0 0 0 0 0 0 0 0 0\n      1234 1250 2350 3450 "
         "4150 0"),
     ErrorId::NonPlanarFacet, 6, 7},
    {"undefined_tr", with_surface("2 7 px 1"), ErrorId::UndefinedId, 5, 3},
    {"torus_askew", with_surface("2 7 tx 0 0 0 3 1 1", "tr7 0 0 0 .6 .8 0 -.8 .6 0 0 0 1\n"),
     ErrorId::UnsupportedNode, 5, 3},
    {"periodic_ball", with_surface("2 -1 so 4"), ErrorId::BadArgument, 5, 6},
    {"periodic_with_nothing", with_surface("2 -7 px 4"), ErrorId::UndefinedId, 5, 3},
    {"reflecting_and_periodic", with_surface("*2 -1 px 4"), ErrorId::BadArgument, 5, 4},
    // data cards
    {"tr_twice", with_data("tr1 1 0 0\ntr1 1 0 0"), ErrorId::DuplicateId, 7, 1},
    {"tr_without_number", with_data("tr 1 0 0"), ErrorId::BadArgument, 6, 1},
    {"empty_tr", with_data("tr1"), ErrorId::MissingValue, 6, 1},
    {"tr_of_three_of_nine", with_data("tr1 1 0 0  1 0 0"), ErrorId::UnsupportedNode, 6, 12},
    {"tr_of_four_of_nine", with_data("tr1 1 0 0  1 0 0 0"), ErrorId::WrongCount, 6, 12},
    {"tr_of_fourteen", with_data("tr1 0 0 0 1 0 0 0 1 0 0 0 1 1 1"), ErrorId::WrongCount, 6, 31},
    {"tr_that_is_no_rotation", with_data("tr1 0 0 0 1 0 0 0 2 0 0 0 1"), ErrorId::BadArgument, 6,
     11},
    {"tr_with_m_of_two", with_data("tr1 0 0 0 1 0 0 0 1 0 0 0 1 2"), ErrorId::BadArgument, 6, 29},
    {"tr_of_no_numbers", with_data("tr1 a b c"), ErrorId::UnexpectedText, 6, 5},
    {"universes_as_data", with_data("u 1 2"), ErrorId::UnsupportedNode, 6, 1},
    {"vertical_format", with_data("#  imp:n vol\n1  1 2"), ErrorId::UnsupportedNode, 6, 1},
};

class MalformedDecks : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedDecks, AreRefusedWithTheirPlace) {
  test::expect_refusal(GetParam(), "file.mcnp", read_geometry);
}

INSTANTIATE_TEST_SUITE_P(Table, MalformedDecks, testing::ValuesIn(table),
                         [](const auto& info) { return std::string(info.param.name); });

// ---- LAW mcnp_reader.4
// ---------------------------------------------------------------------------

void expect_answer(const std::string& text) {
  try {
    const openmc::Model model = read_geometry(text, "file.mcnp");
    EXPECT_LT(model.root, model.universes.size());
    for (const openmc::Universe& universe : model.universes) EXPECT_FALSE(universe.cells.empty());
    for (const openmc::Lattice& lattice : model.lattices) {
      for (const openmc::Index element : lattice.elements) {
        ASSERT_LT(element, model.universes.size());
      }
    }
  } catch (const Error& error) {
    EXPECT_NE(describe(error.id()).exit_code, 3) << error.what();
  }
}

std::vector<std::string> all_decks() {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(deck_folder())) {
    if (!openmc::is_geometry_file(entry.path())) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return texts;
}

TEST(AnyText, ThatIsTheBeginningOfADeckIsAnswered) {
  const std::vector<std::string> texts = all_decks();
  ASSERT_GE(texts.size(), 8U);
  for (const std::string& text : texts) {
    for (std::size_t length = 0; length <= text.size(); ++length) {
      expect_answer(text.substr(0, length));
    }
  }
}

// Characters that mean something, put in the place of others or between them.
TEST(AnyText, ThatIsADeckWithFaultsIsAnswered) {
  const std::string characters = "0123456789 .-+:#()*&$=\ncjrmiuelat\t";
  const std::vector<std::string> texts = all_decks();
  std::mt19937 random(1);
  for (int n = 0; n < 3000; ++n) {
    std::string text = texts[random() % texts.size()];
    const unsigned faults = 1 + random() % 4;
    for (unsigned i = 0; i < faults; ++i) {
      const std::size_t at = random() % text.size();
      const char c = characters[random() % characters.size()];
      switch (random() % 3) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        default:
          text.erase(at, 1);
      }
    }
    expect_answer(text);
  }
}

}  // namespace
}  // namespace exactcsg::io::mcnp
