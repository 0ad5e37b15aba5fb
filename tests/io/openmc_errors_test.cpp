// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with OpenMC geometries: every text is refused by its id at the place that a person
// would point at. Lines and columns were counted by hand.

#include <gtest/gtest.h>

#include <string>

#include "exactcsg/io/openmc/model.hpp"
#include "io/malformed.hpp"

namespace exactcsg::io::openmc {
namespace {

using namespace std::string_literals;

using test::Malformed;

// One line for the surface or cell in question, after "<geometry>", so that it is line 2.
std::string with_line(const std::string& line, const std::string& rest = "") {
  return "<geometry>\n" + line + "\n<surface id=\"1\" type=\"sphere\" coeffs=\"0 0 0 1\"/>\n" +
         rest + "<cell id=\"1\" material=\"void\" region=\"-1\"/>\n</geometry>\n";
}
std::string with_surface(const std::string& type, const std::string& coefficients) {
  return with_line("<surface type=\"" + type + "\" id=\"2\" coeffs=\"" + coefficients + "\"/>");
}
std::string with_region(const std::string& region) {
  return with_line("<cell region=\"" + region + "\" id=\"2\" material=\"3\"/>");
}
// Universe 1 is there to be used.
std::string with_lattice(const std::string& line) {
  return with_line(line, "<cell id=\"9\" universe=\"1\" material=\"void\"/>\n");
}

// <surface type="..." id="2" coeffs="...: the coefficients begin at column 33 + the type's length.
// <cell region="...: the region begins at column 15.
const Malformed table[] = {
    // XML
    {"empty", "", ErrorId::EmptyFile, 0, 0},
    {"only_blanks", " \n\n", ErrorId::EmptyFile, 0, 0},
    {"no_xml", "1 2 3\n", ErrorId::NotText, 1, 1},
    {"zero_byte", "<geometry>\n<\0/>"s, ErrorId::NotText, 2, 2},
    {"wrong_end", "<geometry>\n<cell id=\"1\"></sell>\n</geometry>", ErrorId::UnexpectedText, 2,
     16},
    {"two_roots", "<geometry/>\n<geometry/>", ErrorId::UnexpectedText, 2, 1},
    {"text_behind", "<geometry></geometry>\nend", ErrorId::UnexpectedText, 2, 1},
    {"no_end", "<geometry>\n", ErrorId::TruncatedInput, 2, 1},
    {"open_attribute", "<geometry>\n<cell id=\"1", ErrorId::TruncatedInput, 2, 12},
    {"other_root", "<settings/>", ErrorId::UnknownNode, 1, 1},
    {"model_without_geometry", "<model>\n<materials/></model>", ErrorId::MissingValue, 1, 1},
    {"two_geometries",
     "<model><geometry>\n<cell id=\"1\" material=\"void\"/></geometry>\n<geometry/></model>",
     ErrorId::UnexpectedText, 3, 1},
    {"no_cells", "\n<geometry/>", ErrorId::MissingValue, 2, 1},
    {"unknown_element", with_line("<sell id=\"2\"/>"), ErrorId::UnknownNode, 2, 1},
    {"dagmc", with_line("<dagmc_universe id=\"2\"/>"), ErrorId::UnsupportedNode, 2, 1},
    {"text_between", with_line("surface"), ErrorId::UnexpectedText, 2, 1},
    {"attribute_twice", with_line("<surface id=\"2\" id=\"3\" type=\"x-plane\" coeffs=\"1\"/>"),
     ErrorId::UnexpectedText, 2, 17},
    // surfaces
    {"unknown_surface", with_surface("ball", "0 0 0 1"), ErrorId::UnknownNode, 2, 16},
    {"surface_without_type", with_line("<surface id=\"2\" coeffs=\"1\"/>"), ErrorId::MissingValue,
     2, 1},
    {"surface_without_id", with_line("<surface type=\"x-plane\" coeffs=\"1\"/>"),
     ErrorId::MissingValue, 2, 1},
    {"surface_without_coefficients", with_line("<surface id=\"2\" type=\"x-plane\"/>"),
     ErrorId::MissingValue, 2, 1},
    {"missing_coefficient", with_surface("sphere", "0 0 0"), ErrorId::WrongCount, 2, 39},
    {"too_many_coefficients", with_surface("sphere", "0 0 0 1 2"), ErrorId::WrongCount, 2, 47},
    {"no_coefficients", with_surface("sphere", ""), ErrorId::WrongCount, 2, 39},
    {"not_a_number", with_surface("sphere", "0 zero 0 1"), ErrorId::UnexpectedText, 2, 41},
    {"nan", with_surface("sphere", "nan 0 0 1"), ErrorId::NumberOutOfRange, 2, 39},
    {"infinity", with_surface("sphere", "0 0 0 inf"), ErrorId::NumberOutOfRange, 2, 45},
    {"huge_exponent", with_surface("x-plane", "1e99999"), ErrorId::NumberOutOfRange, 2, 40},
    {"too_large", with_surface("x-plane", "1e101"), ErrorId::NumberOutOfRange, 2, 40},
    {"fraction", with_surface("x-plane", "1/3"), ErrorId::UnexpectedText, 2, 40},
    {"negative_radius", with_surface("sphere", "0 0 0 -1"), ErrorId::BadArgument, 2, 45},
    {"negative_cylinder", with_surface("z-cylinder", "0 0 -1"), ErrorId::BadArgument, 2, 47},
    {"negative_slope", with_surface("z-cone", "0 0 0 -1"), ErrorId::BadArgument, 2, 45},
    {"zero_radius", with_surface("sphere", "0 0 0 0"), ErrorId::DegenerateSurface, 2, 39},
    {"zero_slope", with_surface("x-cone", "0 0 0 0"), ErrorId::DegenerateSurface, 2, 39},
    {"zero_normal", with_surface("plane", "0 0 0 1"), ErrorId::DegenerateSurface, 2, 38},
    {"quadric_of_a_line", with_surface("quadric", "1 1 0 0 0 0 0 0 0 0"),
     ErrorId::DegenerateSurface, 2, 40},
    {"quadric_of_nothing", with_surface("quadric", "1 1 1 0 0 0 0 0 0 1"),
     ErrorId::DegenerateSurface, 2, 40},
    {"quadric_of_a_double_plane", with_surface("quadric", "1 1 0 2 0 0 2 2 0 1"),
     ErrorId::DegenerateSurface, 2, 40},
    {"torus_with_negative_major_radius", with_surface("z-torus", "0 0 0 -5 1 1"),
     ErrorId::BadArgument, 2, 46},
    {"torus_with_zero_radius", with_surface("x-torus", "0 0 0 5 0 1"), ErrorId::DegenerateSurface,
     2, 40},
    {"torus_with_zero_radius_across", with_surface("y-torus", "0 0 0 5 1 0"),
     ErrorId::DegenerateSurface, 2, 40},
    {"torus_of_seven", with_surface("z-torus", "0 0 0 5 1 1 1"), ErrorId::WrongCount, 2, 52},
    {"torus_without_radius", with_surface("z-torus", "0 0 0 5 1"), ErrorId::WrongCount, 2, 40},
    {"torus_with_negative_radius", with_surface("z-torus", "0 0 0 5 -1 1"), ErrorId::BadArgument, 2,
     48},
    {"unknown_boundary",
     with_line("<surface boundary=\"mirror\" id=\"2\" type=\"x-plane\" coeffs=\"1\"/>"),
     ErrorId::UnknownNode, 2, 20},
    {"surface_id_zero", with_line("<surface id=\"0\" type=\"x-plane\" coeffs=\"1\"/>"),
     ErrorId::BadArgument, 2, 14},
    {"surface_id_text", with_line("<surface id=\"a\" type=\"x-plane\" coeffs=\"1\"/>"),
     ErrorId::UnexpectedText, 2, 14},
    {"surface_id_huge", with_line("<surface id=\"99999999999\" type=\"x-plane\" coeffs=\"1\"/>"),
     ErrorId::NumberOutOfRange, 2, 14},
    {"duplicate_surface",
     with_line("<surface id=\"2\" type=\"x-plane\" coeffs=\"1\"/>"
               "<surface id=\"2\" type=\"x-plane\" coeffs=\"1\"/>"),
     ErrorId::DuplicateId, 2, 57},
    // regions
    {"undefined_surface", with_region("-1 17"), ErrorId::UndefinedId, 2, 18},
    {"open_parenthesis", with_region("-1 (1"), ErrorId::UnexpectedText, 2, 18},
    {"closed_parenthesis", with_region("-1) 1"), ErrorId::UnexpectedText, 2, 17},
    {"empty_parentheses", with_region("-1 ()"), ErrorId::UnexpectedText, 2, 19},
    {"union_of_one", with_region("-1 |"), ErrorId::UnexpectedText, 2, 19},
    {"union_begins", with_region("| -1"), ErrorId::UnexpectedText, 2, 15},
    {"complement_of_nothing", with_region("-1 ~"), ErrorId::UnexpectedText, 2, 19},
    {"complement_of_union", with_region("-1 ~ | 1"), ErrorId::UnexpectedText, 2, 20},
    {"sign_alone", with_region("-1 - 1"), ErrorId::UnexpectedText, 2, 18},
    {"unknown_operator", with_region("-1 ^ 1"), ErrorId::UnexpectedText, 2, 18},
    {"surface_too_long", with_region("-12345678901234567890"), ErrorId::NumberOutOfRange, 2, 15},
    {"region_after_entity", with_region("-1 &#32; 17"), ErrorId::UndefinedId, 2, 24},
    {"region_on_lines", with_region("-1\n | 17"), ErrorId::UndefinedId, 3, 4},
    {"region_element", with_line("<cell id=\"2\" material=\"3\"><region> -1 x</region></cell>"),
     ErrorId::UnexpectedText, 2, 39},
    // cells
    {"cell_without_id", with_line("<cell material=\"void\"/>"), ErrorId::MissingValue, 2, 1},
    {"duplicate_cell", with_line("", "<cell id=\"1\" material=\"2\"/>\n"), ErrorId::DuplicateId, 5,
     11},
    {"material_and_fill", with_line("<cell id=\"2\" material=\"1\" fill=\"5\"/>"),
     ErrorId::BadArgument, 2, 33},
    {"neither_material_nor_fill", with_line("<cell id=\"2\" region=\"-1\"/>"),
     ErrorId::MissingValue, 2, 1},
    {"no_material", with_line("<cell id=\"2\" material=\" \"/>"), ErrorId::MissingValue, 2, 24},
    {"material_name", with_line("<cell id=\"2\" material=\"water\"/>"), ErrorId::UnexpectedText, 2,
     24},
    {"undefined_fill", with_line("<cell id=\"2\" fill=\"5\"/>"), ErrorId::UndefinedId, 2, 20},
    {"undefined_material",
     "<model><materials><material id=\"3\"/></materials><geometry>\n"
     "<cell id=\"1\" material=\"4\"/></geometry></model>",
     ErrorId::UndefinedId, 2, 24},
    {"translation_without_fill", with_line("<cell id=\"2\" translation=\"1 2 3\" material=\"1\"/>"),
     ErrorId::BadArgument, 2, 27},
    {"rotation_without_fill", with_line("<cell id=\"2\" rotation=\"1 2 3\" material=\"1\"/>"),
     ErrorId::BadArgument, 2, 24},
    {"short_translation", with_lattice("<cell id=\"2\" translation=\"1 2\" fill=\"1\"/>"),
     ErrorId::WrongCount, 2, 27},
    {"short_rotation", with_lattice("<cell id=\"2\" rotation=\"1 2\" fill=\"1\"/>"),
     ErrorId::WrongCount, 2, 24},
    {"singular_rotation",
     with_lattice("<cell id=\"2\" rotation=\"1 0 0 0 1 0 0 0 0\" fill=\"1\"/>"),
     ErrorId::SingularMap, 2, 24},
    {"endless_rotation", with_lattice("<cell id=\"2\" rotation=\"0 1e30 0\" fill=\"1\"/>"),
     ErrorId::NumberOutOfRange, 2, 26},
    // universes
    {"cyclic_fill",
     with_line(
         "<cell id=\"2\" universe=\"1\" fill=\"2\"/>\n<cell id=\"3\" universe=\"2\" fill=\"1\"/>"),
     ErrorId::CyclicFill, 3, 1},
    {"fill_with_itself", with_line("<cell id=\"2\" universe=\"1\" fill=\"1\"/>"),
     ErrorId::CyclicFill, 2, 1},
    {"cycle_through_a_lattice",
     with_line("<cell id=\"2\" universe=\"1\" fill=\"7\"/>\n<lattice id=\"7\" dimension=\"1 1\" "
               "lower_left=\"0 0\" pitch=\"1 1\" universes=\"1\"/>"),
     ErrorId::CyclicFill, 2, 1},
    {"two_roots_of_universes", with_line("<cell id=\"2\" universe=\"1\" material=\"1\"/>"),
     ErrorId::NoRootUniverse, 4, 1},
    // lattices
    {"few_entries",
     with_lattice("<lattice universes=\"1 1 1\" id=\"7\" dimension=\"2 2\" lower_left=\"0 0\" "
                  "pitch=\"1 1\"/>"),
     ErrorId::WrongCount, 2, 21},
    {"many_entries",
     with_lattice("<lattice universes=\"1 1 1\" id=\"7\" dimension=\"2 1\" lower_left=\"0 0\" "
                  "pitch=\"1 1\"/>"),
     ErrorId::WrongCount, 2, 25},
    {"undefined_entry",
     with_lattice("<lattice universes=\"1 5\" id=\"7\" dimension=\"2 1\" lower_left=\"0 0\" "
                  "pitch=\"1 1\"/>"),
     ErrorId::UndefinedId, 2, 23},
    {"undefined_outer",
     with_lattice("<lattice outer=\"5\" universes=\"1 1\" id=\"7\" dimension=\"2 1\" "
                  "lower_left=\"0 0\" pitch=\"1 1\"/>"),
     ErrorId::UndefinedId, 2, 17},
    {"no_dimension",
     with_lattice("<lattice universes=\"1\" id=\"7\" lower_left=\"0 0\" pitch=\"1 1\"/>"),
     ErrorId::MissingValue, 2, 1},
    {"zero_dimension",
     with_lattice("<lattice dimension=\"0 1\" universes=\"1\" id=\"7\" lower_left=\"0 0\" "
                  "pitch=\"1 1\"/>"),
     ErrorId::BadArgument, 2, 21},
    {"zero_pitch",
     with_lattice("<lattice pitch=\"1 0\" dimension=\"1 1\" universes=\"1\" id=\"7\" "
                  "lower_left=\"0 0\"/>"),
     ErrorId::BadArgument, 2, 19},
    {"short_corner",
     with_lattice("<lattice lower_left=\"0\" dimension=\"1 1\" universes=\"1\" id=\"7\" "
                  "pitch=\"1 1\"/>"),
     ErrorId::WrongCount, 2, 22},
    {"endless_lattice",
     with_lattice("<lattice dimension=\"2000000000 2000000000\" lower_left=\"0 0\" universes=\"1\" "
                  "id=\"7\" pitch=\"1 1\"/>"),
     ErrorId::TooLarge, 2, 21},
    {"duplicate_lattice",
     with_lattice("<lattice id=\"7\" dimension=\"1 1\" lower_left=\"0 0\" pitch=\"1 1\" "
                  "universes=\"1\"/>\n<lattice id=\"7\" dimension=\"1 1\" lower_left=\"0 0\" "
                  "pitch=\"1 1\" universes=\"1\"/>"),
     ErrorId::DuplicateId, 3, 14},
    {"few_hexagons",
     with_lattice("<hex_lattice universes=\"1 1 1\" id=\"7\" n_rings=\"2\" center=\"0 0\" "
                  "pitch=\"1\"/>"),
     ErrorId::WrongCount, 2, 25},
    {"no_rings", with_lattice("<hex_lattice universes=\"1\" id=\"7\" center=\"0 0\" pitch=\"1\"/>"),
     ErrorId::MissingValue, 2, 1},
    {"unknown_orientation",
     with_lattice("<hex_lattice orientation=\"z\" universes=\"1\" id=\"7\" n_rings=\"1\" "
                  "center=\"0 0\" pitch=\"1\"/>"),
     ErrorId::UnknownNode, 2, 27},
    {"flat_centre_of_layers",
     with_lattice(
         "<hex_lattice center=\"0 0\" universes=\"1\" id=\"7\" n_rings=\"1\" n_axial=\"1\" "
         "pitch=\"1 1\"/>"),
     ErrorId::WrongCount, 2, 22},
};

class MalformedGeometry : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedGeometry, IsRefusedByName) {
  test::expect_refusal(GetParam(), "geometry.xml", read_geometry);
}

INSTANTIATE_TEST_SUITE_P(Table, MalformedGeometry, testing::ValuesIn(table),
                         [](const auto& info) { return std::string(info.param.name); });

// The number that is asked for.
TEST(MalformedGeometryTable, HasAtLeastFortyRows) { EXPECT_GE(std::size(table), 40U); }

// A whole model, cut at every character before its end: nothing is taken for whole, and what is cut
// off is said to be (where only an element's name or a number is cut, XML sees no end either).
TEST(MalformedGeometryTable, CutAnywhere) {
  const std::string text =
      "<?xml version='1.0'?>\n<geometry>\n"
      "  <surface id=\"1\" type=\"sphere\" coeffs=\"0 0 0 1\" boundary=\"vacuum\"/>\n"
      "  <!-- a comment -->\n"
      "  <cell id=\"1\" universe=\"0\"><region>-1</region><fill>7</fill></cell>\n"
      "  <cell id=\"2\" universe=\"1\" material=\"void\"/>\n"
      "  <lattice id=\"7\"><dimension>1 1</dimension><lower_left>-1 -1</lower_left>"
      "<pitch>2 2</pitch><universes>\n1\n</universes></lattice>\n</geometry>";
  ASSERT_EQ(read_geometry(text, "whole").cells.size(), 2U);
  for (std::size_t end = 1; end < text.size(); ++end) {
    try {
      read_geometry(text.substr(0, end), "cut");
      FAIL() << "read although cut at " << end;
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), ErrorId::TruncatedInput) << end << ": " << error.what();
    }
  }
}

}  // namespace
}  // namespace exactcsg::io::openmc
