// SPDX-License-Identifier: Apache-2.0
// The digest of a boundary. docs/digest.md describes the text that is hashed.
#include <nettle/sha2.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <compare>
#include <cstring>
#include <numeric>
#include <span>
#include <string>
#include <string_view>

#include "exactcsg/number/limbs.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/numbered_sides.hpp"

namespace exactcsg {

namespace {

// Of nettle: OpenSSL's would take longer to set up than a small solid takes to evaluate.
class Sha256 {
 public:
  Sha256() { sha256_init(&context_); }
  void add(std::string_view text) {
    sha256_update(&context_, text.size(), reinterpret_cast<const std::uint8_t*>(text.data()));
  }
  std::string hexadecimal() {
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> bytes{};
    sha256_digest(&context_, bytes.size(), bytes.data());
    std::string text;
    for (const std::uint8_t byte : bytes) {
      constexpr char digits[] = "0123456789abcdef";
      text += digits[byte >> 4U];
      text += digits[byte & 15U];
    }
    return text;
  }

 private:
  sha256_ctx context_{};
};

static_assert(std::endian::native == std::endian::little);

using Characters [[gnu::vector_size(16)]] = signed char;
using TwoLimbs [[gnu::vector_size(16)]] = mp_limb_t;

// The sixteen digits of a limb.
void write_limb(char* text, mp_limb_t value) {
  constexpr mp_limb_t low_halves = 0x0f0f0f0f0f0f0f0fU;
  const mp_limb_t bytes = __builtin_bswap64(value);  // as they are read: the first digits first
  const auto first = reinterpret_cast<Characters>(TwoLimbs{bytes >> 4U & low_halves, 0});
  const auto second = reinterpret_cast<Characters>(TwoLimbs{bytes & low_halves, 0});
  const Characters digits = __builtin_shufflevector(first, second, 0, 16, 1, 17, 2, 18, 3, 19, 4,
                                                    20, 5, 21, 6, 22, 7, 23);
  const Characters is_letter = digits > 9;  // -1 if so
  const Characters characters = digits + '0' + (is_letter & ('a' - '9' - 1));
  std::memcpy(text, &characters, sizeof characters);
}

// Numbers that are written often, as text that ends in a blank.
class NumberTexts {
 public:
  struct Text {
    static constexpr std::size_t capacity = 15;
    std::array<char, capacity> characters{};
    std::uint8_t length = 0;
  };

  explicit NumberTexts(std::size_t count) : texts_(count) {
    Text text = text_of(0);
    for (std::size_t i = 0; i < count; ++i) {
      texts_[i] = text;
      char& last = text.characters[text.length - std::size_t{2}];
      if (last == '9') {
        text = text_of(i + 1);
      } else {
        ++last;
      }
    }
  }
  std::size_t count() const { return texts_.size(); }
  void prefetch(std::size_t number) const { __builtin_prefetch(&texts_[number]); }
  const Text& operator[](std::size_t number) const { return texts_[number]; }

  static Text text_of(std::size_t number) {
    Text text;
    char* const begin = text.characters.data();
    char* const end = std::to_chars(begin, begin + Text::capacity - 1, number).ptr;
    *end = ' ';
    text.length = static_cast<std::uint8_t>(end + 1 - begin);
    return text;
  }

 private:
  std::vector<Text> texts_;
};

// The text that is hashed, handed on in pieces: one buffer, no string a number.
class HashedText {
 public:
  HashedText& operator<<(std::string_view text) {
    reserve(text.size());
    std::copy(text.begin(), text.end(), end());
    used_ += text.size();
    return *this;
  }
  // The first coordinates, `common` of them, are those of the point before, whose text is copied.
  void add_point(const PointView& point, std::size_t common) {
    // A digit more than limbs need, a sign or a separator each.
    std::size_t longest = 0;
    for (const RationalView& number : point) {
      longest += digits_of_limb * (number.numerator.size() + number.denominator.size() + 1) +
                 number.exponent / 4 + 4;
    }
    if (!has_room(longest)) common = 0;  // it is not there any more
    reserve(longest);
    char* const begin = end();
    char* to = begin;
    if (common > 0) to = std::copy_n(last_point_, ends_[common - 1], to);
    last_point_ = begin;
    for (std::size_t i = common; i < 3; ++i) {
      to = write(to, point[i]);
      *to++ = i == 2 ? '\n' : ' ';
      ends_[i] = to - begin;
    }
    used_ = static_cast<std::size_t>(to - buffer_.data());
  }
  // Numbers of one line.
  template <std::size_t n>
  void add_line(const std::array<const NumberTexts::Text*, n>& numbers) {
    reserve(n * sizeof(NumberTexts::Text));
    char* to = end();
    for (const NumberTexts::Text* number : numbers) {
      // Its length, too, as one move of 16 bytes.
      std::memcpy(to, number, sizeof *number);
      to += number->length;
    }
    to[-1] = '\n';
    used_ = static_cast<std::size_t>(to - buffer_.data());
  }
  std::string digest() {
    flush();
    return hash_.hexadecimal();
  }

 private:
  static constexpr std::size_t digits_of_limb = GMP_NUMB_BITS / 4;

  // These write to where there is room, and return where it goes on. (Members would be read again
  // after every character, which may be theirs for all the compiler knows.)
  static char* write(char* to, LimbSpan number) {
    std::size_t limb = number.size();
    if (limb == 0) {
      *to++ = '0';
      return to;
    }
    --limb;
    // Without its leading zeros.
    const auto digits = (static_cast<std::size_t>(std::bit_width(number[limb])) + 3) / 4;
    write_limb(to, number[limb] << 4 * (digits_of_limb - digits));
    to += digits;
    while (limb > 0) {
      write_limb(to, number[--limb]);
      to += digits_of_limb;
    }
    return to;
  }
  static char* write(char* to, const RationalView& number) {
    if (number.negative) *to++ = '-';
    to = write(to, number.numerator);
    if (!number.has_binary_denominator()) {
      *to++ = '/';
      return write(to, number.denominator);
    }
    if (number.exponent == 0) return to;
    *to++ = '/';
    *to++ = "1248"[number.exponent % 4];
    return std::fill_n(to, number.exponent / 4, '0');
  }

  char* end() { return buffer_.data() + used_; }
  bool has_room(std::size_t size) const { return buffer_.size() - used_ >= size; }
  void reserve(std::size_t size) {
    if (has_room(size)) return;
    flush();
    if (buffer_.size() < size) buffer_.resize(size);
  }
  void flush() {
    hash_.add({buffer_.data(), used_});
    used_ = 0;
  }

  Sha256 hash_;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 16U);
  std::size_t used_ = 0;
  const char* last_point_ = nullptr;
  std::array<std::ptrdiff_t, 3> ends_{};  // of its coordinates, counted from its begin
};

// How a vertex follows another one.
struct Step {
  std::strong_ordering order = std::strong_ordering::equal;  // of the first to the second
  std::size_t common = 3;                                    // first coordinates that are equal
};

Step step_between(const PointView& first, const PointView& second) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::strong_ordering order = compare(first[axis], second[axis]);
    if (order != 0) return {order, axis};
  }
  return {};
}

// Rounding to nearest is monotone: only equal doubles leave the order open.
Step step_between(const PointView& first, const PointView& second,
                  const std::array<double, 3>& near_first,
                  const std::array<double, 3>& near_second) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (near_first[axis] != near_second[axis]) {
      return {near_first[axis] < near_second[axis] ? std::strong_ordering::less
                                                   : std::strong_ordering::greater,
              axis};
    }
    if (equal(first[axis], second[axis])) continue;
    return {compare(first[axis], second[axis]), axis};
  }
  return {};
}

// Adds the vertices as they are. Whether they ascend; else what is added is of no use.
bool add_ascending(HashedText& text, const Boundary& boundary) {
  const bool has_doubles = boundary.approximate.size() == boundary.vertices.size();
  PointView last;
  for (std::size_t i = 0; i < boundary.vertices.size(); ++i) {
    const PointView next = boundary.vertices.view(i);
    Step step{std::strong_ordering::less, 0};
    if (i > 0) {
      step = has_doubles
                 ? step_between(last, next, boundary.approximate[i - 1], boundary.approximate[i])
                 : step_between(last, next);
    }
    if (step.order > 0) return false;
    text.add_point(next, step.common);
    last = next;
  }
  return true;
}

// The vertices in lexicographic order.
std::vector<std::uint32_t> sorted_vertices(const Boundary& boundary) {
  std::vector<std::uint32_t> order(boundary.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return compare(boundary.vertices.view(i), boundary.vertices.view(j)) < 0;
  });
  return order;
}

std::vector<std::uint32_t> inverse_of(const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> rank(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) rank[order[k]] = k;
  return rank;
}

bool are_in_order(std::span<const BoundaryEdge> edges) {
  return std::ranges::all_of(edges, [](const BoundaryEdge& e) { return e.from <= e.to; }) &&
         std::ranges::is_sorted(edges);
}

std::vector<BoundaryEdge> renamed_edges(const Boundary& boundary,
                                        std::span<const std::uint32_t> rename) {
  std::vector<BoundaryEdge> edges;
  edges.reserve(boundary.edges.size());
  for (const BoundaryEdge& e : boundary.edges) {
    edges.push_back(
        {std::min(rename[e.from], rename[e.to]), std::max(rename[e.from], rename[e.to])});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// How far ahead the texts of numbers are asked for.
constexpr std::size_t lines_ahead = 16;
constexpr std::size_t planes_ahead = 4;  // most have few sides

}  // namespace

std::string digest(const Boundary& boundary) {
  HashedText text;
  const auto section = [&text](std::string_view name, std::size_t count) {
    text << name << " " << std::to_string(count) << "\n";
  };
  const auto begin_vertices = [&] {
    text << "exactcsg.boundary/3\n";
    section("vertices", boundary.vertices.size());
  };
  std::vector<std::uint32_t> rank(boundary.vertices.size());
  begin_vertices();
  const bool ascend = add_ascending(text, boundary);
  if (ascend) {
    std::iota(rank.begin(), rank.end(), 0U);
  } else {
    text = HashedText();
    begin_vertices();
    const std::vector<std::uint32_t> order = sorted_vertices(boundary);
    for (const std::uint32_t v : order) text.add_point(boundary.vertices.view(v), 0);
    rank = inverse_of(order);
  }

  const NumberTexts numbers(rank.size());
  std::vector<BoundaryEdge> renamed;
  std::span<const BoundaryEdge> edges = boundary.edges;
  if (!ascend || !are_in_order(edges)) {
    renamed = renamed_edges(boundary, rank);
    edges = renamed;
  }
  section("edges", edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i + lines_ahead < edges.size()) numbers.prefetch(edges[i + lines_ahead].to);
    text.add_line<2>({&numbers[edges[i].from], &numbers[edges[i].to]});
  }

  const NumberedSides sides = numbered_sides(boundary, rank);
  section("planes", sides.planes().size());
  section("sides", sides.count());
  for (std::size_t plane = 0; plane < sides.planes().size(); ++plane) {
    const NumberTexts::Text plane_text =
        plane < numbers.count() ? numbers[plane] : NumberTexts::text_of(plane);
    if (plane + planes_ahead < sides.planes().size()) {
      const SidesOfPlane ahead = sides.planes()[plane + planes_ahead];
      for (const Side side : ahead.first(std::min(ahead.size(), lines_ahead))) {
        numbers.prefetch(side.to());
      }
    }
    for (const Side side : sides.planes()[plane]) {
      text.add_line<3>({&plane_text, &numbers[side.from()], &numbers[side.to()]});
    }
  }
  return text.digest();
}

}  // namespace exactcsg
