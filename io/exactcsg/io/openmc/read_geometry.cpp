// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "exactcsg/io/openmc/lattices.hpp"
#include "exactcsg/io/openmc/located_xml.hpp"
#include "exactcsg/io/openmc/region.hpp"
#include "exactcsg/io/openmc/surfaces.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/io/openscad/degree_trigonometry.hpp"

namespace exactcsg::io::openmc {

namespace {

using Table = std::unordered_map<Id, Index>;

std::optional<Index> find(const Table& table, Id id) {
  const auto found = table.find(id);
  return found == table.end() ? std::optional<Index>() : found->second;
}

// Rz(psi) Ry(theta) Rx(phi), its sines and cosines rounded to doubles and the products exact; the
// inverse of a rotation is its transpose.
std::array<std::array<Rational, 3>, 3> rotation_of(const std::vector<Field>& words) {
  std::array<Rational, 3> sine;
  std::array<Rational, 3> cosine;
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = nearest_double(words[i].number());
    const double s = openscad::sine_of_degrees(angle);
    const double c = openscad::cosine_of_degrees(angle);
    if (!(s >= -1 && s <= 1 && c >= -1 && c <= 1)) {
      words[i].fail(ErrorId::NumberOutOfRange, "an angle of more turns than doubles can tell",
                    "degrees of magnitude below 1e18");
    }
    sine[i] = rational_of(s);
    cosine[i] = rational_of(c);
  }
  const auto& [sphi, stheta, spsi] = sine;
  const auto& [cphi, ctheta, cpsi] = cosine;
  return {{{ctheta * cpsi, sphi * stheta * cpsi - cphi * spsi, cphi * stheta * cpsi + sphi * spsi},
           {ctheta * spsi, sphi * stheta * spsi + cphi * cpsi, cphi * stheta * spsi - sphi * cpsi},
           {-stheta, sphi * ctheta, cphi * ctheta}}};
}

class GeometryReader {
 public:
  GeometryReader(const LocatedXml& file, std::string name) : root_(file.root()) {
    model_.name = std::move(name);
  }

  Model read() {
    const Element geometry = find_geometry();
    std::vector<Element> cells;
    std::vector<Element> lattices;
    for (const Element& child : geometry.children()) {
      if (child.name() == "surface") {
        add_surface(child);
      } else if (child.name() == "cell") {
        cells.push_back(child);
      } else if (child.name() == "lattice" || child.name() == "hex_lattice") {
        lattices.push_back(child);
      } else if (child.name() == "dagmc_universe") {
        child.fail(ErrorId::UnsupportedNode, "a universe of meshes (DAGMC)", "cells and surfaces");
      } else {
        child.fail(ErrorId::UnknownNode, fmt::format("<{:.40}>", child.name()),
                   "surface, cell, lattice or hex_lattice");
      }
    }
    if (cells.empty()) geometry.fail(ErrorId::MissingValue, "a geometry without cells", "<cell>");
    for (const Element& cell : cells) add_cell(cell);
    for (const Element& lattice : lattices) add_lattice(lattice);
    resolve_fills();
    resolve_lattices();
    refuse_cycles(model_);
    choose_root(geometry);
    return std::move(model_);
  }

 private:
  // <geometry>, or the one within <model>, whose <materials> say which ones there are.
  Element find_geometry() {
    if (root_.name() == "geometry") return root_;
    if (root_.name() != "model") {
      root_.fail(ErrorId::UnknownNode, fmt::format("<{:.40}>", root_.name()),
                 "<geometry> or <model>");
    }
    std::optional<Element> geometry;
    for (const Element& child : root_.children()) {
      if (child.name() == "materials") read_materials(child);
      if (child.name() != "geometry") continue;
      if (geometry) child.fail(ErrorId::UnexpectedText, "a second <geometry>", "one");
      geometry = child;
    }
    if (!geometry) root_.fail(ErrorId::MissingValue, "a model without <geometry>", "one");
    return *geometry;
  }

  void read_materials(const Element& materials) {
    knows_materials_ = true;
    for (const Element& material : materials.children()) {
      if (material.name() != "material") continue;
      materials_.insert(material.required("id").word().integer());
    }
  }

  void warn(std::string text, SourcePosition position) {
    model_.warnings.push_back({std::move(text), std::move(position)});
  }
  void warn_of_unknown(const Element& element, std::initializer_list<std::string_view> known) {
    element.for_each_field_besides(known, [&](std::string_view name, SourcePosition position) {
      warn(fmt::format("'{:.40}' is not read", name), std::move(position));
    });
  }

  void enter(Table& table, const Field& word, Index index, std::string_view what) {
    const Id id = word.integer();
    if (!table.emplace(id, index).second) {
      word.fail(ErrorId::DuplicateId, fmt::format("a second {} {}", what, id), "another id");
    }
  }

  void add_surface(const Element& element) {
    warn_of_unknown(element,
                    {"id", "name", "type", "boundary", "coeffs", "periodic_surface_id", "albedo"});
    Surface surface = read_surface(element);
    enter(surfaces_, element.required("id").word(), static_cast<Index>(model_.surfaces.size()),
          "surface");
    model_.surfaces.push_back(std::move(surface));
  }

  void add_cell(const Element& element) {
    warn_of_unknown(
        element, {"id", "name", "universe", "fill", "material", "region", "temperature", "density",
                  "translation", "rotation", "volume", "virtual_lattice", "triso_particles"});
    Cell cell;
    const auto index = static_cast<Index>(model_.cells.size());
    const Field id = element.required("id").word();
    enter(cells_, id, index, "cell");
    cell.id = id.integer();
    cell.name = element.text_or_empty("name");
    cell.position = element.position();
    const std::optional<Field> region = element.field("region");
    cell.region = region
                      ? parse_region(*region, [&](Id surface) { return find(surfaces_, surface); })
                      : Region::full();
    const std::optional<Field> universe = element.field("universe");
    cell.universe = universe_index(universe ? universe->word().integer() : 0);
    model_.universes[cell.universe].cells.push_back(index);
    read_contents(element, cell);
    read_map(element, cell);
    model_.cells.push_back(std::move(cell));
  }

  Index universe_index(Id id) {
    const auto [entry, is_new] =
        universes_.emplace(id, static_cast<Index>(model_.universes.size()));
    if (is_new) model_.universes.push_back({id, {}});
    return entry->second;
  }

  void read_contents(const Element& element, Cell& cell) {
    const std::optional<Field> material = element.field("material");
    const std::optional<Field> fill = element.field("fill");
    if (material && fill) {
      fill->fail(ErrorId::BadArgument, "a cell with both material and fill", "one of them");
    }
    if (!material && !fill) {
      element.fail(ErrorId::MissingValue, "a cell with neither material nor fill", "one of them");
    }
    if (fill) {
      fills_.emplace_back(static_cast<Index>(model_.cells.size()), fill->word());
      return;
    }
    const std::vector<Field> words = material->words();
    if (words.empty()) material->fail(ErrorId::MissingValue, "no material", "an id or void");
    for (const Field& word : words) cell.materials.push_back(material_of(word));
  }

  std::optional<Id> material_of(const Field& word) const {
    if (word.text() == "void") return std::nullopt;
    const Id id = word.integer();
    if (knows_materials_ && !materials_.contains(id)) {
      word.fail(ErrorId::UndefinedId, fmt::format("material {}", id), "the id of a <material>");
    }
    return id;
  }

  // local = matrix (global - translation)
  void read_map(const Element& element, Cell& cell) {
    const std::optional<Field> translation = element.field("translation");
    const std::optional<Field> rotation = element.field("rotation");
    if (!translation && !rotation) return;
    if (!element.field("fill")) {
      (translation ? *translation : *rotation)
          .fail(ErrorId::BadArgument, "a cell that is moved but has no fill",
                "a translation or rotation of a filled cell");
    }
    AffineMap map = AffineMap::identity();
    if (rotation) read_rotation(*rotation, cell, map);
    if (translation) {
      const std::vector<Rational> offset = translation->numbers();
      if (offset.size() != 3) {
        translation->fail(ErrorId::WrongCount, fmt::format("{} numbers", offset.size()), "3");
      }
      for (auto& row : map.m) {
        for (std::size_t j = 0; j < 3; ++j) row[3] -= row[j] * offset[j];
      }
    }
    cell.to_fill = std::move(map);
  }

  static void read_rotation(const Field& field, Cell& cell, AffineMap& map) {
    const std::vector<Field> words = field.words();
    if (words.size() == 9) {
      for (std::size_t k = 0; k < 9; ++k) map.m[k / 3][k % 3] = words[k].number();
      if (determinant(map) == 0) words.front().fail(ErrorId::SingularMap, "a rotation", "");
      return;
    }
    if (words.size() != 3) {
      field.fail(ErrorId::WrongCount, fmt::format("{} numbers", words.size()),
                 "three angles or a matrix of nine");
    }
    const auto turned = rotation_of(words);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) map.m[i][j] = turned[j][i];
    }
    // Quarter turns are exact.
    cell.has_rounded_rotation = std::any_of(words.begin(), words.end(), [](const Field& word) {
      return Rational(word.number() / 90).get_den() != 1;
    });
  }

  void add_lattice(const Element& element) {
    warn_of_unknown(element, {"id", "name", "dimension", "lower_left", "pitch", "outer",
                              "universes", "n_rings", "n_axial", "orientation", "center"});
    LatticeText text = read_lattice(element);
    enter(lattices_, element.required("id").word(), static_cast<Index>(lattice_texts_.size()),
          "lattice");
    lattice_texts_.push_back(std::move(text));
  }

  // Among universes first, then among lattices.
  void resolve_fills() {
    for (const auto& [cell, word] : fills_) {
      const Id id = word.integer();
      Cell& filled = model_.cells[cell];
      if (const auto universe = find(universes_, id)) {
        filled.fill = FillKind::Universe;
        filled.filled_with = *universe;
      } else if (const auto lattice = find(lattices_, id)) {
        filled.fill = FillKind::Lattice;
        filled.filled_with = *lattice;
      } else {
        word.fail(ErrorId::UndefinedId, fmt::format("universe {}", id),
                  "the id of a universe or lattice");
      }
    }
  }

  Index defined_universe(const Field& word) const {
    const Id id = word.integer();
    const std::optional<Index> index = find(universes_, id);
    if (!index) {
      word.fail(ErrorId::UndefinedId, fmt::format("universe {}", id), "the universe of some cell");
    }
    return *index;
  }

  void resolve_lattices() {
    for (LatticeText& text : lattice_texts_) {
      for (const Field& word : text.elements) {
        text.lattice.elements.push_back(defined_universe(word));
      }
      if (text.outer) text.lattice.outer = defined_universe(*text.outer);
      model_.lattices.push_back(std::move(text.lattice));
    }
  }

  // The one universe that nothing is filled with.
  void choose_root(const Element& geometry) {
    std::vector<bool> is_used(model_.universes.size(), false);
    for (const Cell& cell : model_.cells) {
      if (cell.fill == FillKind::Universe) is_used[cell.filled_with] = true;
    }
    for (const Lattice& lattice : model_.lattices) {
      for (const Index universe : lattice.elements) is_used[universe] = true;
      if (lattice.outer) is_used[*lattice.outer] = true;
    }
    const auto root = std::find(is_used.begin(), is_used.end(), false);
    if (root == is_used.end()) {
      geometry.fail(ErrorId::NoRootUniverse, "none: every universe fills something", "one");
    }
    model_.root = static_cast<Index>(root - is_used.begin());
    const auto second = std::find(std::next(root), is_used.end(), false);
    if (second == is_used.end()) return;
    const Universe& other = model_.universes[static_cast<std::size_t>(second - is_used.begin())];
    throw Error(ErrorId::NoRootUniverse, {fmt::format("universes {} and {} fill nothing",
                                                      model_.universes[model_.root].id, other.id),
                                          "one such", model_.cells[other.cells.front()].position});
  }

  Element root_;
  Model model_;
  Table surfaces_, cells_, universes_, lattices_;
  std::unordered_set<Id> materials_;
  bool knows_materials_ = false;
  std::vector<std::pair<Index, Field>> fills_;  // cells with a fill, and what it says
  std::vector<LatticeText> lattice_texts_;
};

}  // namespace

std::vector<Index> universes_in(const Model& model, const Cell& cell) {
  if (cell.fill == FillKind::Material) return {};
  if (cell.fill == FillKind::Universe) return {cell.filled_with};
  const Lattice& lattice = model.lattices[cell.filled_with];
  std::vector<Index> universes = lattice.elements;
  if (lattice.outer) universes.push_back(*lattice.outer);
  std::sort(universes.begin(), universes.end());
  universes.erase(std::unique(universes.begin(), universes.end()), universes.end());
  return universes;
}

std::string label_of(const Surface& surface) {
  return surface.label.empty() ? std::to_string(surface.id) : surface.label;
}

HalfSpaceRegion half_spaces(const Model& model, const Region& region) {
  return csg::map(region, [&](const SurfaceSide& side) {
    const HalfSpace& negative = model.surfaces[side.surface].negative;
    return side.is_positive ? complement(negative) : negative;
  });
}

Model read_geometry(std::string_view text, std::string name) {
  const LocatedXml file(text, name);
  return GeometryReader(file, std::move(name)).read();
}

}  // namespace exactcsg::io::openmc
