// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/exact_points.hpp"

#include <algorithm>
#include <array>

namespace exactcsg {

namespace {

static_assert(GMP_NUMB_BITS == 64);

// Blocks grow up to 32 kB, so that little is left unused at the end of many short sequences.
constexpr std::size_t smallest_block = 128;
constexpr std::size_t largest_block = 4096;

// What a header says of a coordinate: `denominator` is its exponent, or its number of limbs.
struct Shape {
  bool negative = false;
  bool binary_denominator = false;
  std::uint64_t numerator = 0;
  std::uint64_t denominator = 0;
};

using Shapes = std::array<Shape, 3>;

// A limb holds the shapes of three coordinates of ordinary length; else its highest bit is set, and
// a limb for each coordinate follows.
constexpr unsigned short_numerator_bits = 9;
constexpr unsigned short_denominator_bits = 10;
constexpr unsigned short_shape_bits = 2 + short_numerator_bits + short_denominator_bits;
static_assert(3 * short_shape_bits == 63);
constexpr unsigned long_size_bits = 31;
constexpr mp_limb_t long_header = mp_limb_t{1} << 63U;

mp_limb_t packed(const Shape& shape, unsigned numerator_bits) {
  return shape.denominator << (2 + numerator_bits) | shape.numerator << 2U |
         (shape.binary_denominator ? 2U : 0U) | (shape.negative ? 1U : 0U);
}

Shape unpacked(mp_limb_t bits, unsigned numerator_bits, unsigned denominator_bits) {
  const auto low = [](mp_limb_t value, unsigned count) {
    return value & ((mp_limb_t{1} << count) - 1);
  };
  return {(bits & 1U) != 0, (bits & 2U) != 0, low(bits >> 2U, numerator_bits),
          low(bits >> (2 + numerator_bits), denominator_bits)};
}

Shape shape_of(const RationalView& value) {
  const bool binary = value.has_binary_denominator();
  return {value.negative, binary, value.numerator.size(),
          binary ? value.exponent : value.denominator.size()};
}

bool are_short(const Shapes& shapes) {
  const auto& [x, y, z] = shapes;
  return (x.numerator | y.numerator | z.numerator) >> short_numerator_bits == 0 &&
         (x.denominator | y.denominator | z.denominator) >> short_denominator_bits == 0;
}

std::size_t limbs_of(const Shape& shape) {
  return shape.numerator + (shape.binary_denominator ? 0 : shape.denominator);
}

std::size_t limbs_of(const Shapes& shapes) {
  return limbs_of(shapes[0]) + limbs_of(shapes[1]) + limbs_of(shapes[2]);
}

bool has_long_header(const mp_limb_t* record) { return (*record & long_header) != 0; }

const mp_limb_t* numbers_of(const mp_limb_t* record) {
  return record + (has_long_header(record) ? 4 : 1);
}

Shape short_shape(mp_limb_t header, unsigned axis) {
  return unpacked(header >> (axis * short_shape_bits), short_numerator_bits,
                  short_denominator_bits);
}

Shape long_shape(const mp_limb_t* record, unsigned axis) {
  return unpacked(record[axis + 1], long_size_bits, long_size_bits);
}

Shape shape_of(const mp_limb_t* record, unsigned axis) {
  return has_long_header(record) ? long_shape(record, axis) : short_shape(*record, axis);
}

Shapes shapes_of(const mp_limb_t* record) {
  return {shape_of(record, 0), shape_of(record, 1), shape_of(record, 2)};
}

}  // namespace

ExactPoints::ExactPoints(std::span<const Point3> points) {
  reserve(points.size());
  for (const Point3& point : points) push_back(point);
}

mp_limb_t* ExactPoints::allocate(std::size_t limbs) {
  const bool is_own = !blocks_.empty() && blocks_.back().use_count() == 1;
  if (!is_own || free_count_ < limbs) {
    block_size_ = std::clamp(2 * block_size_, smallest_block, largest_block);
    const std::size_t size = std::max(block_size_, limbs);
    std::shared_ptr<mp_limb_t[]> block(new mp_limb_t[size]);
    mp_limb_t* const begin = block.get();
    blocks_.push_back(std::move(block));
    free_ = begin;
    free_count_ = size;
  }
  mp_limb_t* const result = free_;
  free_ += limbs;
  free_count_ -= limbs;
  return result;
}

PointView PointRecord::view() const {
  const mp_limb_t* const record = record_;
  const mp_limb_t* limbs = numbers_of(record);
  const auto next = [&](const Shape& shape) {
    const mp_limb_t* const numerator = limbs;
    const mp_limb_t* const denominator = numerator + shape.numerator;
    limbs = denominator + (shape.binary_denominator ? 0 : shape.denominator);
    return RationalView{{numerator, denominator},
                        {denominator, limbs},
                        shape.binary_denominator ? shape.denominator : 0,
                        shape.negative};
  };
  // Initialised in this order.
  if (has_long_header(record)) {
    return {next(long_shape(record, 0)), next(long_shape(record, 1)), next(long_shape(record, 2))};
  }
  const mp_limb_t header = *record;
  return {next(short_shape(header, 0)), next(short_shape(header, 1)), next(short_shape(header, 2))};
}

void ExactPoints::push_back(const PointView& view) {
  const Shapes shapes{shape_of(view[0]), shape_of(view[1]), shape_of(view[2])};
  const bool short_header = are_short(shapes);
  mp_limb_t* to = allocate((short_header ? 1 : 4) + limbs_of(shapes));
  records_.push_back(to);
  mp_limb_t& header = *to++;
  header = short_header ? 0 : long_header;
  for (unsigned i = 0; i < 3; ++i) {
    if (short_header) {
      header |= packed(shapes[i], short_numerator_bits) << (i * short_shape_bits);
    } else {
      *to++ = packed(shapes[i], long_size_bits);
    }
  }
  // Loops instead of calls: there are few limbs.
  for (const RationalView& value : view) {
    for (const mp_limb_t limb : value.numerator) *to++ = limb;
    for (const mp_limb_t limb : value.denominator) *to++ = limb;
  }
}

void ExactPoints::append(ExactPoints&& others) {
  records_.insert(records_.end(), others.records_.begin(), others.records_.end());
  if (!others.blocks_.empty()) {
    blocks_.insert(blocks_.end(), others.blocks_.begin(), others.blocks_.end());
    free_ = others.free_;
    free_count_ = others.free_count_;
  }
  others = {};
}

void ExactPoints::reorder(std::span<const std::uint32_t> order) {
  std::vector<const mp_limb_t*> records;
  records.reserve(order.size());
  for (const std::uint32_t i : order) records.push_back(records_[i]);
  records_ = std::move(records);
}

namespace {

// Numbers have one form each, and so have records.
bool equal_records(const mp_limb_t* a, const mp_limb_t* b) {
  if (a == b) return true;
  if (*a != *b) return false;  // before more of the header is read: it is of the same length now
  const mp_limb_t* const numbers = numbers_of(a);
  if (!std::equal(a, numbers, b)) return false;
  return std::equal(numbers, numbers + limbs_of(shapes_of(a)), b + (numbers - a));
}

}  // namespace

bool operator==(PointRecord p, PointRecord q) { return equal_records(p.record_, q.record_); }

bool operator==(const ExactPoints& p, const ExactPoints& q) {
  return std::equal(p.records_.begin(), p.records_.end(), q.records_.begin(), q.records_.end(),
                    equal_records);
}

std::vector<Point3> to_vector(const ExactPoints& points) {
  std::vector<Point3> result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result.push_back(points[i]);
  return result;
}

}  // namespace exactcsg
