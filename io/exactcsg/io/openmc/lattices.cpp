// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/lattices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "exactcsg/domain/half_spaces.hpp"

namespace exactcsg::io::openmc {

namespace {

using Coordinates = domain::Coordinates<3>;

constexpr std::int64_t most_elements = 100'000'000;

// sqrt(3)/2 to the nearest double; a double is a rational.
const Rational& half_root_of_three() {
  static const Rational value = rational_of(std::numbers::sqrt3 / 2);
  return value;
}

Rational row_distance_of(const Lattice& lattice) {
  if (lattice.row_distance) return *lattice.row_distance;
  return half_root_of_three() * lattice.pitch[0];
}

std::int64_t count_of(const Field& word) {
  const std::int32_t value = word.integer();
  if (value <= 0) {
    word.fail(ErrorId::BadArgument, fmt::format("the count {}", value), "one above 0");
  }
  return value;
}

std::vector<Field> words_of(const Element& element, const char* name, std::size_t least,
                            std::size_t most) {
  const Field field = element.required(name);
  std::vector<Field> words = field.words();
  if (words.size() < least || words.size() > most) {
    const std::string wanted =
        least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
    field.fail(ErrorId::WrongCount, fmt::format("{} values of '{}'", words.size(), name), wanted);
  }
  return words;
}

Rational pitch_of(const Field& word) {
  Rational value = word.number();
  if (value <= 0) {
    word.fail(ErrorId::BadArgument, fmt::format("the pitch {:.40}", to_text(value)), "one above 0");
  }
  return value;
}

void check_size(const Field& field, std::initializer_list<std::int64_t> factors) {
  std::int64_t product = 1;
  for (const std::int64_t factor : factors) {
    if (factor > most_elements / product) {
      field.fail(ErrorId::TooLarge, "a lattice of more elements",
                 fmt::format("at most {}", most_elements));
    }
    product *= factor;
  }
}

void check_count(const Field& field, const std::vector<Field>& words, std::int64_t wanted) {
  const auto count = static_cast<std::size_t>(wanted);
  if (words.size() == count) return;
  (words.size() > count ? words[count] : field)
      .fail(ErrorId::WrongCount, fmt::format("{} universes", words.size()),
            fmt::format("{}", wanted));
}

void read_rectangular(const Element& element, LatticeText& text) {
  Lattice& lattice = text.lattice;
  const std::vector<Field> dimension = words_of(element, "dimension", 2, 3);
  lattice.has_layers = dimension.size() == 3;
  lattice.counts = {1, 1, 1};
  for (std::size_t i = 0; i < dimension.size(); ++i) lattice.counts[i] = count_of(dimension[i]);
  lattice.layers = lattice.counts[2];
  const auto& [columns, rows, layers] = lattice.counts;
  check_size(element.required("dimension"), {columns, rows, layers});
  const std::vector<Field> corner =
      words_of(element, "lower_left", dimension.size(), dimension.size());
  const std::vector<Field> pitch = words_of(element, "pitch", dimension.size(), dimension.size());
  for (std::size_t i = 0; i < dimension.size(); ++i) {
    lattice.origin[i] = corner[i].number();
    lattice.pitch[i] = pitch_of(pitch[i]);
  }
  const Field universes = element.required("universes");
  const std::vector<Field> words = universes.words();
  check_count(universes, words, columns * rows * layers);
  text.elements = words;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto width = static_cast<std::size_t>(columns);
    const auto height = static_cast<std::size_t>(rows);
    const std::size_t x = k % width;
    const std::size_t row = k / width % height;
    const std::size_t layer = k / width / height;
    text.elements[(layer * height + (height - 1 - row)) * width + x] = words[k];
  }
}

// Along the hexagon's rows, and across: the place of the element (i, a) in units that order it.
struct HexagonalRank {
  std::int64_t height;
  std::int64_t along;
};
HexagonalRank rank_of(LatticeKind kind, std::int64_t i, std::int64_t a) {
  return kind == LatticeKind::HexagonalY ? HexagonalRank{2 * a + i, i} : HexagonalRank{a, i};
}

std::vector<std::array<std::int64_t, 2>> hexagons(std::int64_t rings) {
  const std::int64_t reach = rings - 1;
  std::vector<std::array<std::int64_t, 2>> result;
  for (std::int64_t i = -reach; i <= reach; ++i) {
    for (std::int64_t a = std::max(-reach, -reach - i); a <= std::min(reach, reach - i); ++a) {
      result.push_back({i, a});
    }
  }
  return result;
}

// As OpenMC writes them.
std::vector<std::array<std::int64_t, 2>> hexagons_in_order_of_file(const Lattice& lattice) {
  std::vector<std::array<std::int64_t, 2>> result = hexagons(lattice.rings);
  std::sort(result.begin(), result.end(), [&](const auto& first, const auto& second) {
    const HexagonalRank f = rank_of(lattice.kind, first[0], first[1]);
    const HexagonalRank s = rank_of(lattice.kind, second[0], second[1]);
    return f.height != s.height ? f.height > s.height : f.along < s.along;
  });
  return result;
}

LatticeKind read_orientation(const Element& element) {
  const std::optional<Field> field = element.field("orientation");
  if (!field || field->stripped() == "y") return LatticeKind::HexagonalY;
  if (field->stripped() != "x") {
    field->fail(ErrorId::UnknownNode, fmt::format("the orientation '{:.40}'", field->stripped()),
                "x or y");
  }
  return LatticeKind::HexagonalX;
}

void read_hexagonal(const Element& element, LatticeText& text) {
  Lattice& lattice = text.lattice;
  lattice.kind = read_orientation(element);
  const Field rings = element.required("n_rings").word();
  lattice.rings = count_of(rings);
  const std::optional<Field> layers = element.field("n_axial");
  lattice.has_layers = layers.has_value();
  if (layers) lattice.layers = count_of(layers->word());
  check_size(rings, {3, lattice.rings, lattice.rings, lattice.layers});
  const std::size_t size = lattice.has_layers ? 3 : 2;
  const std::vector<Field> centre = words_of(element, "center", size, size);
  for (std::size_t i = 0; i < size; ++i) lattice.origin[i] = centre[i].number();
  const std::vector<Field> pitch = words_of(element, "pitch", size - 1, size - 1);
  lattice.pitch = {pitch_of(pitch[0]), pitch_of(pitch[0]), 0};
  if (lattice.has_layers) lattice.pitch[2] = pitch_of(pitch[1]);
  const auto order = hexagons_in_order_of_file(lattice);
  const Field universes = element.required("universes");
  const std::vector<Field> words = universes.words();
  check_count(universes, words, static_cast<std::int64_t>(order.size()) * lattice.layers);
  text.elements = words;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto& [i, a] = order[k % order.size()];
    const auto layer = static_cast<std::int64_t>(k / order.size());
    text.elements[element_index(lattice, {i, a, layer})] = words[k];
  }
}

// The number of hexagons in the columns before i, of a hexagon of so many rings.
std::int64_t hexagons_before(std::int64_t rings, std::int64_t i) {
  const std::int64_t reach = rings - 1;
  const std::int64_t columns = i + reach;  // of heights rings, rings + 1, ...
  if (i <= 0) return columns * rings + columns * (columns - 1) / 2;
  const std::int64_t after = reach - i + 1;  // column i and those behind it
  const std::int64_t all = 3 * rings * reach + 1;
  return all - (after * rings + after * (after - 1) / 2);
}

Integer floor_of(const Rational& value) {
  Integer result;
  mpz_fdiv_q(result.get_mpz_t(), value.get_num_mpz_t(), value.get_den_mpz_t());
  return result;
}

// Which of equal intervals that begin at multiples of 1 the value is in.
struct Interval {
  Integer index;
  bool is_on_boundary = false;
  std::optional<std::int64_t> element;  // the index, if it is below the count
  bool touches = false;                 // an element, at least with an end
};
Interval interval_of(const Rational& value, std::int64_t count) {
  Interval result{floor_of(value), value.get_den() == 1, std::nullopt, false};
  const auto size = static_cast<long>(count);
  if (result.index >= 0 && result.index < size) result.element = result.index.get_si();
  result.touches = value >= 0 && value <= size;
  return result;
}

// Along z, of lattices with layers: the layer, and z relative to its middle.
struct LayerPlace {
  Interval interval;
  Rational z;
};
LayerPlace layer_of(const Lattice& lattice, const Rational& z) {
  if (!lattice.has_layers) return {{0, false, 0, true}, z};
  const Rational low =
      lattice.is_hexagonal()
          ? Rational(lattice.origin[2] - lattice.pitch[2] * static_cast<long>(lattice.layers) / 2)
          : lattice.origin[2];
  const Rational above = z - low;
  Interval interval = interval_of(above / lattice.pitch[2], lattice.layers);
  Rational middle = above - lattice.pitch[2] * (interval.index + Rational(1, 2));
  return {std::move(interval), std::move(middle)};
}

// A place, and whether its boundary is one of an element: outside there is none without an outer
// universe.
struct Search {
  LatticePlace place;
  bool touches_element = false;
};

Search place_in_rectangles(const Lattice& lattice, const Point& point) {
  LayerPlace layer = layer_of(lattice, point[2]);
  Search result{{}, layer.interval.touches};
  result.place.is_on_boundary = layer.interval.is_on_boundary;
  std::array<std::int64_t, 3> element{0, 0, layer.interval.element.value_or(0)};
  bool is_inside = layer.interval.element.has_value();
  Coordinates local;
  local[2] = std::move(layer.z);
  for (std::size_t i = 0; i < 2; ++i) {
    const Rational offset = point[i] - lattice.origin[i];
    const Interval interval = interval_of(offset / lattice.pitch[i], lattice.counts[i]);
    result.place.is_on_boundary = result.place.is_on_boundary || interval.is_on_boundary;
    result.touches_element = result.touches_element && interval.touches;
    is_inside = is_inside && interval.element;
    element[i] = interval.element.value_or(0);
    local[i] = offset - lattice.pitch[i] * (interval.index + Rational(1, 2));
  }
  result.place.local = std::move(local);
  if (is_inside) result.place.element = element;
  return result;
}

// Coordinates along i and a of a point relative to the lattice's centre, where hexagon (i, a) has
// its centre at (i, a).
struct SkewPoint {
  Rational i, a;
};

// Orientation x is y with the axes exchanged, and i with a.
SkewPoint skew_of(const Lattice& lattice, const Rational& x, const Rational& y) {
  const bool is_y = lattice.kind == LatticeKind::HexagonalY;
  Rational skew = (is_y ? x : y) / row_distance_of(lattice);
  Rational straight = (is_y ? y : x) / lattice.pitch[0] - skew / 2;
  return is_y ? SkewPoint{std::move(skew), std::move(straight)}
              : SkewPoint{std::move(straight), std::move(skew)};
}

// Whether a point is in the hexagon round (0, 0): twice its distance, along each of the three
// directions in which the neighbours are, in units of the pitch, is at most 1.
PointClass class_in_hexagon(const SkewPoint& p) {
  PointClass result = PointClass::In;
  for (const Rational& form :
       {Rational(2 * p.i + p.a), Rational(p.i + 2 * p.a), Rational(p.i - p.a)}) {
    const Rational distance = abs(form);
    if (distance > 1) return PointClass::Out;
    if (distance == 1) result = PointClass::On;
  }
  return result;
}

// Of the hexagon (i, a), relative to the lattice's centre.
std::array<Rational, 2> hexagon_centre(const Lattice& lattice, const Rational& i,
                                       const Rational& a) {
  const bool is_y = lattice.kind == LatticeKind::HexagonalY;
  Rational across = row_distance_of(lattice) * (is_y ? i : a);
  Rational straight = lattice.pitch[0] * (is_y ? Rational(a + i / 2) : Rational(i + a / 2));
  if (is_y) return {std::move(across), std::move(straight)};
  return {std::move(straight), std::move(across)};
}

bool is_hexagon_of(const Lattice& lattice, const Integer& i, const Integer& a) {
  const auto reach = static_cast<long>(lattice.rings - 1);
  return abs(i) <= reach && abs(a) <= reach && abs(Integer(i + a)) <= reach;
}

Search place_in_hexagons(const Lattice& lattice, const Point& point) {
  const Rational x = point[0] - lattice.origin[0];
  const Rational y = point[1] - lattice.origin[1];
  const SkewPoint skew = skew_of(lattice, x, y);
  const Integer low_i = floor_of(skew.i);
  const Integer low_a = floor_of(skew.a);
  const LayerPlace layer = layer_of(lattice, point[2]);
  Search result;
  result.place.is_on_boundary = layer.interval.is_on_boundary;
  // The nearest centre is at a corner of the parallelogram of centres that the point is in, since
  // its angles are 60 and 120 degrees.
  for (unsigned corner = 0; corner < 4; ++corner) {
    const Integer i = low_i + (corner & 1U);
    const Integer a = low_a + (corner >> 1U);
    const PointClass found = class_in_hexagon({Rational(skew.i - i), Rational(skew.a - a)});
    if (found == PointClass::Out) continue;
    const bool is_element = is_hexagon_of(lattice, i, a);
    result.place.is_on_boundary = result.place.is_on_boundary || found == PointClass::On;
    result.touches_element = result.touches_element || (is_element && layer.interval.touches);
    const auto centre = hexagon_centre(lattice, Rational(i), Rational(a));
    result.place.local = Coordinates{Rational(x - centre[0]), Rational(y - centre[1]), layer.z};
    if (is_element && layer.interval.element) {
      result.place.element = {i.get_si(), a.get_si(), *layer.interval.element};
    }
  }
  return result;
}

}  // namespace

LatticeText read_lattice(const Element& element) {
  LatticeText text;
  text.lattice.id = element.required("id").word().integer();
  text.lattice.name = element.text_or_empty("name");
  text.lattice.position = element.position();
  if (element.name() == "hex_lattice") {
    read_hexagonal(element, text);
  } else {
    read_rectangular(element, text);
  }
  if (const auto outer = element.field("outer")) text.outer = outer->word();
  return text;
}

std::size_t element_index(const Lattice& lattice, const std::array<std::int64_t, 3>& element) {
  const auto& [first, second, layer] = element;
  if (!lattice.is_hexagonal()) {
    return static_cast<std::size_t>((layer * lattice.counts[1] + second) * lattice.counts[0] +
                                    first);
  }
  const std::int64_t reach = lattice.rings - 1;
  const std::int64_t all = 3 * lattice.rings * reach + 1;
  const std::int64_t within =
      hexagons_before(lattice.rings, first) + second - std::max(-reach, -reach - first);
  return static_cast<std::size_t>(layer * all + within);
}

Coordinates centre_of(const Lattice& lattice, const std::array<std::int64_t, 3>& element) {
  const auto steps = [&](std::int64_t count) { return Rational(static_cast<long>(count)); };
  const Rational half(1, 2);
  Coordinates centre = lattice.origin;
  if (lattice.is_hexagonal()) {
    const auto offset = hexagon_centre(lattice, steps(element[0]), steps(element[1]));
    centre[0] += offset[0];
    centre[1] += offset[1];
    if (lattice.has_layers) {
      centre[2] += lattice.pitch[2] * (steps(element[2]) - steps(lattice.layers - 1) / 2);
    }
    return centre;
  }
  for (std::size_t axis = 0; axis < (lattice.has_layers ? 3U : 2U); ++axis) {
    centre[axis] += lattice.pitch[axis] * (steps(element[axis]) + half);
  }
  return centre;
}

ElementShape element_shape(const Lattice& lattice) {
  const Rational half(1, 2);
  ElementShape shape;
  for (std::size_t i = 0; i < 3; ++i) shape.half_extent[i] = half * lattice.pitch[i];
  if (!lattice.is_hexagonal()) {
    shape.sides = HalfSpaceRegion::full();
    return shape;
  }
  const bool is_y = lattice.kind == LatticeKind::HexagonalY;
  const std::size_t across = is_y ? 0 : 1;
  const std::size_t straight = 1 - across;
  const Rational step = row_distance_of(lattice);
  shape.half_extent[across] = Rational(2, 3) * step;
  // The forms of class_in_hexagon in the coordinates.
  const auto side = [&](const Rational& along_across, const Rational& along_straight) {
    domain::Coordinates<3> normal;
    normal[across] = along_across;
    normal[straight] = along_straight;
    return HalfSpaceRegion::primitive(domain::make_plane(normal, -1));
  };
  const Rational slope = Rational(3, 2) / step;
  const Rational one = 1 / lattice.pitch[0];
  std::vector<HalfSpaceRegion> sides;
  for (const int sign : {1, -1}) {
    sides.push_back(side(sign * slope, sign * one));
    sides.push_back(side(sign * slope, -sign * one));
    sides.push_back(side(0, 2 * sign * one));
  }
  shape.sides = HalfSpaceRegion::compose(csg::BooleanOperator::Intersection, std::move(sides));
  return shape;
}

namespace {

std::int64_t counted(const Integer& value) {
  if (!value.fits_slong_p() || abs(value) > Integer(1) << 60U) {
    throw Error(ErrorId::TooLarge, {"a lattice with outer that is seen over 2^60 elements", ""});
  }
  return value.get_si();
}

// Widens the range so that it has both the floor of the value and the one after it.
void include(ElementRange& range, std::size_t axis, const Rational& value, bool is_first) {
  const std::int64_t below = counted(floor_of(value));
  range.first[axis] = is_first ? below : std::min(range.first[axis], below);
  range.last[axis] = is_first ? below + 2 : std::max(range.last[axis], below + 2);
}

}  // namespace

ElementRange elements_near(const Lattice& lattice, const domain::Box<3>& box) {
  ElementRange range{{0, 0, 0}, {1, 1, 1}};
  const auto& low = box.lower();
  const auto& high = box.upper();
  const auto between = [&](std::size_t axis, const Rational& origin) {
    const auto bound = [&](const Rational& x) {
      return Rational((x - origin) / lattice.pitch[axis]);
    };
    range.first[axis] = counted(floor_of(bound(low[axis])));
    range.last[axis] = counted(-floor_of(Rational(-bound(high[axis]))));
  };
  if (lattice.has_layers) {
    between(2, lattice.is_hexagonal()
                   ? Rational(lattice.origin[2] -
                              lattice.pitch[2] * static_cast<long>(lattice.layers) / 2)
                   : lattice.origin[2]);
  }
  if (!lattice.is_hexagonal()) {
    for (std::size_t axis = 0; axis < 2; ++axis) between(axis, lattice.origin[axis]);
    return range;
  }
  // The nearest centre is at a corner of the parallelogram of centres that a point is in.
  bool is_first = true;
  for (const Rational& x : {low[0], high[0]}) {
    for (const Rational& y : {low[1], high[1]}) {
      const SkewPoint skew =
          skew_of(lattice, Rational(x - lattice.origin[0]), Rational(y - lattice.origin[1]));
      include(range, 0, skew.i, is_first);
      include(range, 1, skew.a, is_first);
      is_first = false;
    }
  }
  return range;
}

bool is_element_of(const Lattice& lattice, const std::array<std::int64_t, 3>& element) {
  const auto& [first, second, layer] = element;
  if (layer < 0 || layer >= lattice.layers) return false;
  if (lattice.is_hexagonal()) return is_hexagon_of(lattice, Integer(first), Integer(second));
  return first >= 0 && first < lattice.counts[0] && second >= 0 && second < lattice.counts[1];
}

namespace {

// Those of the lattice itself.
ElementRange all_elements(const Lattice& lattice) {
  if (!lattice.is_hexagonal()) return {{0, 0, 0}, lattice.counts};
  const std::int64_t reach = lattice.rings - 1;
  return {{-reach, -reach, 0}, {reach + 1, reach + 1, lattice.layers}};
}

void check_count(const ElementRange& range) {
  std::int64_t product = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t count = range.last[i] - range.first[i];
    if (count <= 0) return;
    if (count > most_elements / product) {
      throw Error(ErrorId::TooLarge, {"a lattice with outer that is seen over more elements",
                                      fmt::format("at most {}", most_elements)});
    }
    product *= count;
  }
}

ElementRange common(const ElementRange& a, const ElementRange& b) {
  ElementRange result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.first[i] = std::max(a.first[i], b.first[i]);
    result.last[i] = std::min(a.last[i], b.last[i]);
  }
  return result;
}

}  // namespace

void for_each_element(
    const Lattice& lattice, const std::optional<domain::Box<3>>& box,
    const std::function<void(const std::array<std::int64_t, 3>& element, Index universe,
                             const domain::Coordinates<3>& centre)>& visit) {
  ElementRange range = all_elements(lattice);
  if (box) {
    const ElementRange near = elements_near(lattice, *box);
    range = lattice.outer ? near : common(near, range);
  }
  check_count(range);
  for (std::int64_t layer = range.first[2]; layer < range.last[2]; ++layer) {
    for (std::int64_t second = range.first[1]; second < range.last[1]; ++second) {
      for (std::int64_t first = range.first[0]; first < range.last[0]; ++first) {
        const std::array<std::int64_t, 3> element{first, second, layer};
        const bool is_inside = is_element_of(lattice, element);
        if (!is_inside && !(box && lattice.outer)) continue;
        visit(element,
              is_inside ? lattice.elements[element_index(lattice, element)] : *lattice.outer,
              centre_of(lattice, element));
      }
    }
  }
}

LatticePlace place_in(const Lattice& lattice, const Point& point) {
  Search found = lattice.is_hexagonal() ? place_in_hexagons(lattice, point)
                                        : place_in_rectangles(lattice, point);
  LatticePlace& place = found.place;
  place.is_on_boundary = place.is_on_boundary && (found.touches_element || lattice.outer);
  place.universe =
      place.element ? lattice.elements[element_index(lattice, *place.element)] : lattice.outer;
  return std::move(place);
}

}  // namespace exactcsg::io::openmc
