// SPDX-License-Identifier: Apache-2.0
// Bounds, for D = 1 or 2 digits of 60 bits a coordinate, coordinates below 2^b, b = 60 D - 2, and
// fewer than 2^28 sides in all:
//   a difference of two coordinates has digits below 2^60 in magnitude, a sum of three coordinates
//   below 2^62; neither needs carries;
//   a component of a cross product is below 2^(2b + 1) = 2^(120 D - 3): 2 D digits. A column of it
//   is a sum of 2 D products of digits, below 2^122; a determinant is below 2^(3b + 3) = 2^(180 D -
//   3): 3 D digits; sums over the sides have at most 28 bits more: one more digit, or the last
//   column of 128 bits.
#include <bit>
#include <cmath>
#include <vector>

#include "exactcsg/number/digits.hpp"
#include "exactcsg/solid/faces_ahead.hpp"
#include "exactcsg/solid/surface_sums.hpp"

namespace exactcsg {

namespace {

constexpr std::uint64_t most_sides = std::uint64_t{1} << 28U;
constexpr int root_bits = 120;

// |true - value * 2^exponent| <= error * 2^exponent
struct ScaledRoot {
  UnsignedInt128 value = 0;
  int exponent = 0;
};
constexpr unsigned long root_error = 5;

// The root of (high, middle, 0), digits to the base 2^64, high of 128 bits: off by less than 2.1 or
// 1.1, downwards or upwards. (The division step of P. Zimmermann, Karatsuba Square Root, 1999,
// without its correction.) REQUIRES 2^124 <= high < 2^126
UnsignedInt128 root_of(UnsignedInt128 high, std::uint64_t middle) {
  const double estimate = std::sqrt(static_cast<double>(static_cast<std::uint64_t>(high >> 64U)));
  auto root = static_cast<std::uint64_t>(estimate * 0x1p32);
  auto rest = static_cast<Int128>(high - static_cast<UnsignedInt128>(root) * root);
  // One step of Newton's iteration, from 50 bits to all but the last.
  const double step = static_cast<double>(static_cast<std::int64_t>(rest >> 16)) * 0x1p15 /
                      static_cast<double>(root);
  root += static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
  rest = static_cast<Int128>(high - static_cast<UnsignedInt128>(root) * root);
  for (; rest < 0; --root) rest += 2 * static_cast<Int128>(root) - 1;
  for (; rest > 2 * static_cast<Int128>(root); ++root) rest -= 2 * static_cast<Int128>(root) + 1;
  const UnsignedInt128 dividend = (static_cast<UnsignedInt128>(rest) << 64U) | middle;
  return (static_cast<UnsignedInt128>(root) << 64U) + dividend / (2 * root);
}

// floor(value / 2^position), if position >= 0. REQUIRES digits >= 0 and that the result is below
// 2^126
template <std::size_t n>
UnsignedInt128 window(const Digits<n>& value, int position) {
  const auto digit = [&](int i) -> UnsignedInt128 {
    return i < static_cast<int>(n)
               ? static_cast<std::uint64_t>(value.digit[static_cast<std::size_t>(i)])
               : 0;
  };
  if (position < 0) {
    return (digit(0) | digit(1) << digit_bits | digit(2) << (2 * digit_bits)) << -position;
  }
  const int first = position / digit_bits;
  const int rest = position % digit_bits;
  UnsignedInt128 result = digit(first) >> rest | digit(first + 1) << (digit_bits - rest) |
                          digit(first + 2) << (2 * digit_bits - rest);
  if (3 * digit_bits - rest < 128) result |= digit(first + 3) << (3 * digit_bits - rest);
  return result;
}

// The length of a vector of digits that are >= 0. REQUIRES that it is not 0
//
// The components are cut to 126 bits in all, by less than 2^position: then the length of what is
// left is smaller by at most sqrt 3, and by twice that in units of the root if it is scaled by 2.
template <std::size_t n>
ScaledRoot length_of(const std::array<Digits<n>, 3>& vector) {
  std::size_t top = n - 1;
  std::int64_t leading = 0;
  for (;; --top) {
    leading = vector[0].digit[top] | vector[1].digit[top] | vector[2].digit[top];
    if (leading != 0) break;
  }
  const int length = static_cast<int>(top) * digit_bits +
                     static_cast<int>(std::bit_width(static_cast<std::uint64_t>(leading)));
  ScaledRoot root;
  root.exponent = length - 126;
  // (a 2^64 + b)^2 = a^2 2^128 + 2 a b 2^64 + b^2
  UnsignedInt128 high = 0;
  UnsignedInt128 twice_middle = 0;
  UnsignedInt128 low = 0;
  for (const Digits<n>& component : vector) {
    const UnsignedInt128 cut = window(component, root.exponent);
    const auto a = static_cast<std::uint64_t>(cut >> 64U);
    const auto b = static_cast<std::uint64_t>(cut);
    high += static_cast<UnsignedInt128>(a) * a;
    twice_middle += static_cast<UnsignedInt128>(a) * b;
    const UnsignedInt128 square = static_cast<UnsignedInt128>(b) * b;
    low += square;
    high += low < square ? 1 : 0;
  }
  const UnsignedInt128 middle = twice_middle << 65U;
  low += middle;
  high += (twice_middle >> 63U) + (low < middle ? 1 : 0);
  if (high < static_cast<UnsignedInt128>(1) << 124U) {
    high = high << 2U | low >> 126U;
    low <<= 2U;
    --root.exponent;
  }
  root.value = root_of(high, static_cast<std::uint64_t>(low >> 64U));
  return root;
}

// Sums of roots of one exponent each, so that nothing is cut off.
template <int lowest, int highest>
class RootSums {
 public:
  void add(const ScaledRoot& root) {
    Sum& sum = sums_[static_cast<std::size_t>(root.exponent - lowest)];
    sum.low += static_cast<std::uint64_t>(root.value);
    sum.high += static_cast<std::uint64_t>(root.value >> 64U);
    ++sum.count;
  }
  // Adds to the areas, in parts that are small enough.
  void add_to(SurfaceSums& sums) const {
    std::size_t first = 0;
    while (first < sums_.size() && sums_[first].count == 0) ++first;
    const int shift = std::max(0, -(lowest + static_cast<int>(first)));
    sums.area_shift = static_cast<mp_bitcnt_t>(shift);
    sums.two_areas.value <<= sums.area_shift;
    for (std::size_t i = first; i < sums_.size(); ++i) {
      if (sums_[i].count == 0) continue;
      const auto exponent = static_cast<mp_bitcnt_t>(lowest + static_cast<int>(i) + shift);
      const Integer value = (integer_of(static_cast<Int128>(sums_[i].high)) << 64) +
                            integer_of(static_cast<Int128>(sums_[i].low));
      sums.two_areas.value += value << exponent;
      sums.two_areas.error += Integer(sums_[i].count * root_error) << exponent;
    }
  }

 private:
  struct Sum {
    UnsignedInt128 low = 0;
    UnsignedInt128 high = 0;
    unsigned long count = 0;
  };
  std::array<Sum, highest - lowest + 1> sums_{};
};

template <std::size_t D, Wanted wanted>
class ShortSummation {
 public:
  explicit ShortSummation(const ScaledVertices& vertices) : vertices_(vertices) {}

  SurfaceSums of(const Boundary& boundary) {
    for (std::size_t i = 0; i < boundary.faces.size(); ++i) {
      ask_for_faces_after(boundary.faces, i, [&](std::uint32_t vertex) {
        const mp_limb_t* const begin = vertices_.of(vertex);
        __builtin_prefetch(begin);
        __builtin_prefetch(begin + 3 * D - 1);  // in the next cache line, perhaps
      });
      add_face(boundary.faces[i]);
    }
    SurfaceSums sums;
    sums.six_volumes.value = integer_of(six_volumes_);
    for (std::size_t i = 0; i < 3; ++i) sums.moments[i].value = integer_of(moments_[i]);
    sums.two_areas.value = integer_of(whole_areas_) + whole_roots_;
    roots_.add_to(sums);
    return sums;
  }

 private:
  using Coordinates = std::array<Digits<D>, 3>;
  using Area = std::array<Digits<2 * D + 1>, 3>;

  void add_face(const BoundaryFace& face) {
    if (face.loops.size() == 1) {
      add_area(area_of_loop(face.loops.front()));
      return;
    }
    std::array<DigitColumns<2 * D + 1>, 3> sums;
    for (const auto& loop : face.loops) {
      const Area area = area_of_loop(loop);
      for (std::size_t i = 0; i < 3; ++i) add(sums[i], area[i]);
    }
    Area area;
    for (std::size_t i = 0; i < 3; ++i) area[i] = digits_of<2 * D + 1>(sums[i]);
    add_area(area);
  }

  Coordinates coordinates(std::uint32_t vertex) const {
    const mp_limb_t* from = vertices_.of(vertex);
    Coordinates result;
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = digits_of_limbs<D>(from + i * D);
    }
    return result;
  }

  static Coordinates difference(const Coordinates& p, const Coordinates& q) {
    return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  }

  // The doubled vector area; adds to volume and moments.
  Area area_of_loop(const std::vector<std::uint32_t>& loop) {
    if (loop.size() < 3) return {};
    const Coordinates first = coordinates(loop.front());
    std::array<DigitColumns<2 * D + 1>, 3> sums;
    if constexpr (wanted == Wanted::Everything) {
      add_triangles(loop, first, sums);
    } else {
      add_quadrilaterals(loop, first, sums);
    }
    Area area;
    for (std::size_t i = 0; i < 3; ++i) area[i] = digits_of<2 * D + 1>(sums[i]);
    if (wanted == Wanted::VolumeAndArea) add(six_volumes_, digits_of<3 * D + 1>(dot(first, area)));
    return area;
  }

  using AreaSums = std::array<DigitColumns<2 * D + 1>, 3>;

  // Columns of the area grow by less than 2^122 with each product, those of the moments by 2^123.
  void carry_in_time(AreaSums& sums) {
    if ((++pending_ & 7U) != 0) return;
    for (DigitColumns<2 * D + 1>& sum : sums) carry(sum);
    for (DigitColumns<4 * D>& moment : moments_) carry(moment);
  }

  static DigitColumns<2 * D - 1> cross_component(const Coordinates& u, const Coordinates& v,
                                                 std::size_t i) {
    return difference_of_products(u[(i + 1) % 3], v[(i + 2) % 3], u[(i + 2) % 3], v[(i + 1) % 3]);
  }

  void add_triangles(const std::vector<std::uint32_t>& loop, const Coordinates& first,
                     AreaSums& sums) {
    Coordinates last = coordinates(loop[1]);
    Coordinates u = difference(last, first);
    for (std::size_t k = 2; k < loop.size(); ++k) {
      const Coordinates next = coordinates(loop[k]);
      const Coordinates v = difference(next, first);
      std::array<Digits<2 * D>, 3> cross;
      for (std::size_t i = 0; i < 3; ++i) {
        const DigitColumns<2 * D - 1> component = cross_component(u, v, i);
        add(sums[i], component);
        cross[i] = digits_of<2 * D>(component);
      }
      add_cone(cross, first, last, next);
      carry_in_time(sums);
      last = next;
      u = v;
    }
  }

  // The triangles f, p, q and f, q, r have together (p - f) x (q - f) + (q - f) x (r - f)
  // = (q - f) x (r - p): one product for two of them.
  void add_quadrilaterals(const std::vector<std::uint32_t>& loop, const Coordinates& first,
                          AreaSums& sums) {
    Coordinates p = coordinates(loop[1]);
    for (std::size_t k = 2; k < loop.size(); k += 2) {
      const Coordinates q = coordinates(loop[k]);
      // After the last triangle comes one without area: r = f.
      const Coordinates r = k + 1 < loop.size() ? coordinates(loop[k + 1]) : first;
      const Coordinates u = difference(q, first);
      const Coordinates v = difference(r, p);
      for (std::size_t i = 0; i < 3; ++i) add(sums[i], cross_component(u, v, i));
      carry_in_time(sums);
      p = r;
    }
  }

  // The tetrahedron origin, p, q, r has six times the volume det and the moment det / 24 (p + q +
  // r).
  void add_cone(const std::array<Digits<2 * D>, 3>& cross, const Coordinates& p,
                const Coordinates& q, const Coordinates& r) {
    const Digits<3 * D> determinant = digits_of<3 * D>(dot(p, cross));
    add(six_volumes_, determinant);
    for (std::size_t i = 0; i < 3; ++i) {
      add_product(moments_[i], determinant, p[i] + q[i] + r[i]);
    }
  }

  void add_area(const Area& area) {
    const Area size{magnitude(area[0]), magnitude(area[1]), magnitude(area[2])};
    std::array<bool, 3> zero{};
    for (std::size_t i = 0; i < 3; ++i) zero[i] = size[i].digit == Digits<2 * D + 1>().digit;
    if (zero[1] && zero[2]) {
      add(whole_areas_, size[0]);
    } else if (zero[2] && zero[0]) {
      add(whole_areas_, size[1]);
    } else if (zero[0] && zero[1]) {
      add(whole_areas_, size[2]);
    } else if (!vertices_.exact || !add_whole_root(size)) {
      roots_.add(length_of(size));
    }
  }

  bool add_whole_root(const Area& area) {
    const Integer square = integer_of(dot(area, area));
    if (mpz_perfect_square_p(square.get_mpz_t()) == 0) return false;
    whole_roots_ += sqrt(square);
    return true;
  }

  const ScaledVertices& vertices_;
  unsigned pending_ = 0;
  DigitColumns<3 * D + 1> six_volumes_;
  std::array<DigitColumns<4 * D>, 3> moments_;
  DigitColumns<2 * D + 1> whole_areas_;
  Integer whole_roots_;
  RootSums<-126, (2 * static_cast<int>(D) + 1) * digit_bits + 2> roots_;
};

template <std::size_t D>
SurfaceSums sums_of(const Boundary& boundary, const ScaledVertices& vertices, Wanted wanted) {
  if (wanted == Wanted::Everything) {
    return ShortSummation<D, Wanted::Everything>(vertices).of(boundary);
  }
  return ShortSummation<D, Wanted::VolumeAndArea>(vertices).of(boundary);
}

std::uint64_t count_sides(const Boundary& boundary) {
  std::uint64_t count = 0;
  for (const BoundaryFace& face : boundary.faces) {
    for (const auto& loop : face.loops) count += loop.size();
  }
  return count;
}

}  // namespace

std::optional<SurfaceSums> short_surface_sums(const Boundary& boundary,
                                              const ScaledVertices& vertices, Wanted wanted,
                                              int bits) {
  const std::uint64_t sides = count_sides(boundary);
  if (vertices.width > 2 || bits > root_bits || sides >= most_sides) return std::nullopt;
  SurfaceSums sums = vertices.width == 1 ? sums_of<1>(boundary, vertices, wanted)
                                         : sums_of<2>(boundary, vertices, wanted);
  add_errors_of_vertices(sums, vertices, sides);
  return sums;
}

}  // namespace exactcsg
