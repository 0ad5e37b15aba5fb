// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/box_pairs.hpp"

#include <cmath>

namespace exactcsg {

namespace {

using Index = std::uint32_t;

// ---- Hilbert's curve ----------------------------------------------------------------------------

constexpr unsigned axis_bits = 10;  // of a place, along each axis
constexpr unsigned octant_count = 8;

// How the curve passes a cube: it enters at a corner and leaves along an axis from there. A step
// says the number of an octant along the curve and how the curve passes that octant, from C.
// Hamilton, "Compact Hilbert indices", Dalhousie University CS-2006-07 (2006), section 2.
struct CurveStep {
  unsigned char digit;
  unsigned char state;
};
using CurveSteps = std::array<std::array<CurveStep, octant_count>, 3 * octant_count>;

constexpr CurveSteps make_curve_steps() {
  const auto rotated = [](unsigned value, unsigned by) {  // left, of three bits
    by %= 3;
    return ((value << by) | (value >> (3 - by))) & 7U;
  };
  const auto trailing_ones = [](unsigned value) {
    unsigned count = 0;
    for (; (value & 1U) != 0; value >>= 1U) ++count;
    return count;
  };
  CurveSteps steps{};
  for (unsigned entry = 0; entry < octant_count; ++entry) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned octant = 0; octant < octant_count; ++octant) {
        const unsigned gray = rotated(octant ^ entry, 3 - (axis + 1) % 3);
        const unsigned digit = gray ^ (gray >> 1U) ^ (gray >> 2U);
        const unsigned even = digit == 0 ? 0 : (digit - 1) / 2 * 2;
        const unsigned next_entry = entry ^ rotated(even ^ (even >> 1U), axis + 1);
        const unsigned turn =
            digit == 0 ? 0 : trailing_ones(digit % 2 == 0 ? digit - 1 : digit) % 3;
        steps[entry * 3 + axis][octant] = {
            static_cast<unsigned char>(digit),
            static_cast<unsigned char>(next_entry * 3 + (axis + turn + 1) % 3)};
      }
    }
  }
  return steps;
}
constexpr CurveSteps curve_steps = make_curve_steps();

// The bits of a number below 2^10, each followed by two zeros.
std::uint32_t spread(std::uint32_t value) {
  value = (value | (value << 16U)) & 0x030000ffU;
  value = (value | (value << 8U)) & 0x0300f00fU;
  value = (value | (value << 4U)) & 0x030c30c3U;
  return (value | (value << 2U)) & 0x09249249U;
}

std::uint32_t key_along_curve(const std::array<std::uint32_t, 3>& place) {
  const std::uint32_t octants =
      spread(place[0]) | (spread(place[1]) << 1U) | (spread(place[2]) << 2U);
  std::uint32_t key = 0;
  unsigned state = 0;
  for (unsigned shift = 3 * axis_bits; shift > 0;) {
    shift -= 3;
    const CurveStep step = curve_steps[state][(octants >> shift) & 7U];
    key = (key << 3U) | step.digit;
    state = step.state;
  }
  return key;
}

// ---- sorting ------------------------------------------------------------------------------------

struct Item {
  std::uint32_t key;
  Index box;
};

constexpr std::uint32_t last_key = (1U << (3 * axis_bits)) - 1;
// So many boxes with one key are sorted by finer keys.
constexpr std::size_t crowd = 64;
// Fewer are sorted faster by comparing than by counting digits.
constexpr std::size_t few = 256;

void sort_by_key(std::span<Item> items, std::vector<Item>& scratch) {
  if (items.size() < few) {
    std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
      return a.key != b.key ? a.key < b.key : a.box < b.box;
    });
    return;
  }
  constexpr std::size_t digits = 3;
  constexpr std::size_t values = std::size_t{1} << axis_bits;
  const auto digit_of = [](std::uint32_t key, std::size_t digit) {
    return (key >> (axis_bits * digit)) & (values - 1);
  };
  std::array<std::array<std::uint32_t, values>, digits> places{};
  for (const Item& item : items) {
    for (std::size_t d = 0; d < digits; ++d) ++places[d][digit_of(item.key, d)];
  }
  scratch.resize(std::max(scratch.size(), items.size()));
  std::span<Item> from = items;
  std::span<Item> to = std::span(scratch).first(items.size());
  for (std::size_t d = 0; d < digits; ++d) {
    std::uint32_t total = 0;
    for (std::uint32_t& place : places[d]) {
      const std::uint32_t count = place;
      place = total;
      total += count;
    }
    for (const Item& item : from) to[places[d][digit_of(item.key, d)]++] = item;
    std::swap(from, to);
  }
  std::copy(from.begin(), from.end(), items.begin());
}

// Half of the centre: nothing that is finite overflows, nor do differences.
std::array<double, 3> half_centre(const DoubleBox& box) {
  std::array<double, 3> centre{};
  for (std::size_t i = 0; i < 3; ++i) centre[i] = 0.25 * box.lower[i] + 0.25 * box.upper[i];
  return centre;
}

bool is_finite(const std::array<double, 3>& point) {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

// Gives the items keys within the box of their centres, the same scale along each axis; false if
// this tells none of them from another.
bool set_keys(std::span<Item> items, std::span<const DoubleBox> boxes) {
  constexpr double highest = std::numeric_limits<double>::max();
  std::array<double, 3> lower{highest, highest, highest};
  std::array<double, 3> upper{-highest, -highest, -highest};
  for (const Item& item : items) {
    const std::array<double, 3> centre = half_centre(boxes[item.box]);
    if (!is_finite(centre)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], centre[i]);
      upper[i] = std::max(upper[i], centre[i]);
    }
  }
  const double extent = std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]});
  constexpr double cells = 1U << axis_bits;
  const double scale = cells / extent;
  if (!(extent > 0 && scale > 0 && scale <= highest)) return false;
  for (Item& item : items) {
    const std::array<double, 3> centre = half_centre(boxes[item.box]);
    item.key = last_key;
    if (!is_finite(centre)) continue;
    std::array<std::uint32_t, 3> place{};
    for (std::size_t i = 0; i < 3; ++i) {
      place[i] = static_cast<std::uint32_t>(std::min((centre[i] - lower[i]) * scale, cells - 1));
    }
    item.key = key_along_curve(place);
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> order_along_curve(std::span<const DoubleBox> boxes) {
  std::vector<Item> items(boxes.size());
  for (Index i = 0; i < boxes.size(); ++i) items[i].box = i;
  std::vector<Item> scratch;
  std::vector<std::span<Item>> crowds{std::span(items)};
  while (!crowds.empty()) {
    const std::span<Item> some = crowds.back();
    crowds.pop_back();
    if (!set_keys(some, boxes)) continue;
    sort_by_key(some, scratch);
    for (auto begin = some.begin(); begin != some.end();) {
      const auto end =
          std::find_if(begin, some.end(), [&](const Item& item) { return item.key != begin->key; });
      const auto count = static_cast<std::size_t>(end - begin);
      if (count > crowd && count < some.size()) crowds.emplace_back(begin, end);
      begin = end;
    }
  }
  std::vector<std::uint32_t> order;
  order.reserve(items.size());
  for (const Item& item : items) order.push_back(item.box);
  return order;
}

BoxHierarchy::BoxHierarchy(std::span<const DoubleBox> boxes, std::span<const std::uint32_t> groups)
    : order_(order_along_curve(boxes)) {
  if (boxes.empty()) return;
  boxes_.reserve(boxes.size());
  for (const std::uint32_t i : order_) boxes_.push_back(boxes[i]);
  groups_.reserve(groups.size());
  if (!groups.empty()) {
    for (const std::uint32_t i : order_) groups_.push_back(groups[i]);
  }
  // Joins so many in a row, starting at `first`.
  const auto add_level = [&](std::size_t first, std::size_t count, std::size_t in_a_row,
                             std::vector<DoubleBox>& of_boxes,
                             std::vector<std::uint32_t>& of_groups) {
    level_begins_.push_back(nodes_.size());
    for (std::size_t begin = first; begin < first + count; begin += in_a_row) {
      const std::size_t end = std::min(begin + in_a_row, first + count);
      DoubleBox box = of_boxes[begin];
      for (std::size_t i = begin + 1; i < end; ++i) box = join(box, of_boxes[i]);
      nodes_.push_back(box);
      if (groups.empty()) continue;
      std::uint32_t group = of_groups[begin];
      for (std::size_t i = begin + 1; i < end; ++i) {
        if (of_groups[i] != group) group = several_groups;
      }
      node_groups_.push_back(group);
    }
  };
  const std::size_t leaves = (boxes.size() + leaf_size - 1) / leaf_size;
  nodes_.reserve(2 * leaves + 32);
  node_groups_.reserve(groups.empty() ? 0 : 2 * leaves + 32);
  add_level(0, boxes_.size(), leaf_size, boxes_, groups_);
  while (nodes_.size() - level_begins_.back() > 1) {
    const std::size_t below = level_begins_.back();
    add_level(below, nodes_.size() - below, 2, nodes_, node_groups_);
  }
  level_begins_.push_back(nodes_.size());
}

std::vector<BoxHierarchy::Search> BoxHierarchy::searches() const {
  constexpr std::size_t most_nodes = 128;
  constexpr std::size_t least_level = 4;  // of dozens of boxes
  std::vector<Search> result;
  if (boxes_.empty()) return result;
  std::size_t lowest = std::min(least_level, top_level());
  while (level_size(lowest) > most_nodes) ++lowest;
  add_searches_within(top_level(), 0, lowest, result);
  return result;
}

void BoxHierarchy::add_searches_within(std::size_t level, std::size_t node, std::size_t lowest,
                                       std::vector<Search>& result) const {
  if (level == lowest) {
    result.push_back({level, node, node});
    return;
  }
  const std::size_t first = 2 * node;
  add_searches_within(level - 1, first, lowest, result);
  if (first + 1 == level_size(level - 1)) return;
  add_searches_within(level - 1, first + 1, lowest, result);
  const DoubleBox* boxes = level_boxes(level - 1);
  if (meet(boxes[first], boxes[first + 1])) {
    add_searches_between(level - 1, first, first + 1, lowest, result);
  }
}

void BoxHierarchy::add_searches_between(std::size_t level, std::size_t a, std::size_t b,
                                        std::size_t lowest, std::vector<Search>& result) const {
  if (level == lowest) {
    result.push_back({level, a, b});
    return;
  }
  const DoubleBox* boxes = level_boxes(level - 1);
  const std::size_t end = std::min(2 * b + 2, level_size(level - 1));
  for (std::size_t i = 2 * a; i < 2 * a + 2; ++i) {
    for (std::size_t j = 2 * b; j < end; ++j) {
      if (meet(boxes[i], boxes[j])) add_searches_between(level - 1, i, j, lowest, result);
    }
  }
}

std::vector<std::uint32_t> GroupedBoxes::groups_of(std::size_t count,
                                                   std::span<const std::uint32_t> begins) {
  std::vector<std::uint32_t> groups(count);
  for (std::size_t g = 0; g < begins.size(); ++g) {
    const std::size_t end = g + 1 < begins.size() ? begins[g + 1] : count;
    std::fill(groups.begin() + begins[g], groups.begin() + static_cast<std::ptrdiff_t>(end),
              static_cast<std::uint32_t>(g));
  }
  return groups;
}

}  // namespace exactcsg
