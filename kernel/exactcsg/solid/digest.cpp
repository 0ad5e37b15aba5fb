// SPDX-License-Identifier: Apache-2.0
// The digest of a boundary. docs/digest.md describes the text that is hashed.
#include <nettle/sha2.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <numeric>
#include <string>
#include <string_view>

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

// The text that is hashed, handed on in pieces: one buffer, no string a number.
class HashedText {
 public:
  HashedText& operator<<(std::string_view text) {
    reserve(text.size());
    std::copy(text.begin(), text.end(), buffer_.begin() + static_cast<std::ptrdiff_t>(used_));
    used_ += text.size();
    return *this;
  }
  HashedText& operator<<(char character) {
    reserve(1);
    buffer_[used_++] = character;
    return *this;
  }
  HashedText& operator<<(std::uint64_t number) {
    constexpr std::size_t longest = 20;
    reserve(longest);
    used_ = static_cast<std::size_t>(
        std::to_chars(buffer_.data() + used_, buffer_.data() + buffer_.size(), number).ptr -
        buffer_.data());
    return *this;
  }
  HashedText& operator<<(const Integer& number) {
    constexpr std::size_t digits_of_limb = GMP_NUMB_BITS / 4;
    std::size_t limb = mpz_size(number.get_mpz_t());
    if (limb == 0) return *this << '0';
    if (number < 0) *this << '-';
    reserve(digits_of_limb * limb);
    const mp_limb_t* const limbs = mpz_limbs_read(number.get_mpz_t());
    --limb;
    add_hexadecimal(limbs[limb], (static_cast<std::size_t>(std::bit_width(limbs[limb])) + 3) / 4);
    while (limb > 0) add_hexadecimal(limbs[--limb], digits_of_limb);
    return *this;
  }
  HashedText& operator<<(const Rational& number) {
    *this << number.get_num();
    return number.get_den() == 1 ? *this : *this << '/' << number.get_den();
  }
  std::string digest() {
    flush();
    return hash_.hexadecimal();
  }

 private:
  // REQUIRES that there is room
  void add_hexadecimal(mp_limb_t value, std::size_t digits) {
    char* const text = buffer_.data() + used_;
    for (std::size_t i = digits; i > 0; value >>= 4U) text[--i] = "0123456789abcdef"[value & 15U];
    used_ += digits;
  }
  void reserve(std::size_t size) {
    if (buffer_.size() - used_ >= size) return;
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
};

// rank[i]: the place of item i in sorted order.
template <class Item, class Less>
std::vector<std::uint32_t> sorted_order(const std::vector<Item>& items, Less less) {
  std::vector<std::uint32_t> order(items.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!std::is_sorted(items.begin(), items.end(), less)) {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t i, std::uint32_t j) { return less(items[i], items[j]); });
  }
  return order;
}

std::vector<std::uint32_t> inverse_of(const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> rank(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) rank[order[k]] = k;
  return rank;
}

}  // namespace

std::string digest(const Boundary& boundary) {
  HashedText text;
  const auto section = [&text](std::string_view name, std::size_t count) {
    text << name << ' ' << std::uint64_t{count} << '\n';
  };
  text << "exactcsg.boundary/3\n";
  section("vertices", boundary.vertices.size());
  const std::vector<std::uint32_t> order = sorted_order(
      boundary.vertices, [](const Point3& p, const Point3& q) { return compare(p, q) < 0; });
  for (const std::uint32_t v : order) {
    const Point3& p = boundary.vertices[v];
    text << p.x << ' ' << p.y << ' ' << p.z << '\n';
  }

  const std::vector<std::uint32_t> rank = inverse_of(order);
  std::vector<BoundaryEdge> edges;
  edges.reserve(boundary.edges.size());
  for (const BoundaryEdge& e : boundary.edges) {
    edges.push_back({std::min(rank[e.from], rank[e.to]), std::max(rank[e.from], rank[e.to])});
  }
  if (!std::is_sorted(edges.begin(), edges.end())) std::sort(edges.begin(), edges.end());
  section("edges", edges.size());
  for (const BoundaryEdge& e : edges) {
    text << std::uint64_t{e.from} << ' ' << std::uint64_t{e.to} << '\n';
  }

  const std::vector<NumberedSide> sides = numbered_sides(boundary, rank);
  section("planes", sides.empty() ? 0 : std::size_t{sides.back()[0]} + 1);
  section("sides", sides.size());
  for (const auto& [plane, from, to] : sides) {
    text << std::uint64_t{plane} << ' ' << std::uint64_t{from} << ' ' << std::uint64_t{to} << '\n';
  }
  return text.digest();
}

}  // namespace exactcsg
