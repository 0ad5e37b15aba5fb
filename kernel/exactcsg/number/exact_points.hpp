// SPDX-License-Identifier: Apache-2.0
#pragma once

// A sequence of exact points that is built once and then read: the limbs of all coordinates lie one
// after the other in a few blocks. [Exact]
//
// A point is a record of limbs: a header, and for each coordinate the numerator's limbs and, unless
// the denominator is a power of two, those of the denominator. Denominators that coordinates share
// are not shared: in meeting points of planes that come from doubles they rarely are equal (they
// differ by small factors, which would have to be multiplied again).
//
// LAW points.1  p[i] is the point that was appended as number i, in lowest terms.
// LAW points.2  p == q iff they have the same size and equal points at equal places.
// COST: a point takes 16 bytes and its limbs (8 bytes each), and no heap block of its own. Views,
// comparisons and moves allocate nothing; a copy shares the blocks and takes 8 bytes a point.

#include <compare>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/number/point.hpp"
#include "exactcsg/number/rational_view.hpp"

namespace exactcsg {

// A point as it lies in memory. Lasts as long as the points that it is one of, wherever they are
// moved.
class PointRecord {
 public:
  PointRecord() = default;
  PointView view() const;
  // Where the limbs begin, to ask memory for them ahead.
  const void* address() const { return record_; }

  friend bool operator==(PointRecord p, PointRecord q);

 private:
  friend class ExactPoints;
  explicit PointRecord(const mp_limb_t* record) : record_(record) {}
  const mp_limb_t* record_ = nullptr;
};

class ExactPoints {
 public:
  // Gives points by value.
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = Point3;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = Point3;

    Iterator() = default;
    Iterator(const ExactPoints& points, std::size_t i) : points_(&points), i_(i) {}
    Point3 operator*() const { return (*points_)[i_]; }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    Iterator operator++(int) { return {*points_, i_++}; }
    friend bool operator==(const Iterator&, const Iterator&) = default;

   private:
    const ExactPoints* points_ = nullptr;
    std::size_t i_ = 0;
  };
  using value_type = Point3;
  using iterator = Iterator;
  using const_iterator = Iterator;

  ExactPoints() = default;
  ExactPoints(std::initializer_list<Point3> points)
      : ExactPoints(std::span(points.begin(), points.size())) {}
  explicit ExactPoints(std::span<const Point3> points);

  std::size_t size() const { return records_.size(); }
  bool empty() const { return records_.empty(); }
  Point3 operator[](std::size_t i) const { return point_of(view(i)); }
  Point3 front() const { return (*this)[0]; }
  Point3 back() const { return (*this)[size() - 1]; }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }
  // Of limbs that last as long as the points, wherever they are moved.
  PointView view(std::size_t i) const { return record(i).view(); }
  PointRecord record(std::size_t i) const { return PointRecord(records_[i]); }

  void reserve(std::size_t points) { records_.reserve(points); }
  void push_back(const Point3& point) { push_back(view_of(point)); }
  void push_back(const PointView& point);
  // The points of `others` after those that are here. COST: 8 bytes a point: blocks are taken over
  void append(ExactPoints&& others);
  // Point i becomes what was point order[i]. REQUIRES numbers of points; blocks are kept, so that
  // passes are fastest where the order is nearly the one in which points were appended.
  void reorder(std::span<const std::uint32_t> order);

  friend bool operator==(const ExactPoints& p, const ExactPoints& q);

 private:
  mp_limb_t* allocate(std::size_t limbs);

  std::vector<const mp_limb_t*> records_;
  std::vector<std::shared_ptr<const mp_limb_t[]>> blocks_;
  std::size_t block_size_ = 0;
  // At the end of the last block. A block that is shared with a copy is not written to any more.
  mp_limb_t* free_ = nullptr;
  std::size_t free_count_ = 0;
};

std::vector<Point3> to_vector(const ExactPoints& points);

// Of a point that is gone afterwards, as points[i] is.
inline Rational coordinate(Point3&& p, std::size_t axis) {
  return std::move(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
}

}  // namespace exactcsg
