// SPDX-License-Identifier: Apache-2.0
#pragma once

// The cells of a decomposition tree that a ray passes, in the order in which it passes them.
// [Exact, if the arithmetic of Field is]
//
//   walk_ray(tree, cell, division, ray, visit) -> bool
//
// visit(const T&, const C&, const RayPart<Field>&) at every terminal; it returns nothing, or true
// to end the walk (at a hit, say), which is then what walk_ray returns.
//
// LAW ray.1  the parts are disjoint intervals of the parameter t >= 0, in ascending order, and
// their
//            union is that of the root's cell: every point of the ray is visited once, in the cell
//            that contains it (a cell has its lower faces, not its upper ones).
// REQUIRES the division makes disjoint parts whose union is the cell (LAW cell.1); Field is an
// ordered field, made from the coordinates of the cells. THROWS Error(BadArgument) if the direction
// is 0.
// COST: O(nodes passed * degree * dimension); memory O(depth * degree).
//
// Source: ours; Davy and Dew, sections 6.1 and 9, name it as what GEL cannot do.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/gdt/cell.hpp"
#include "exactcsg/gdt/path.hpp"
#include "exactcsg/gdt/tree.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::gdt {

// The points origin + t * direction, t >= 0.
template <class Field, std::size_t dimension>
struct Ray {
  Coordinates<Field, dimension> origin;
  Coordinates<Field, dimension> direction;
};

// The parameters from `begin` to `end`, with or without these two.
template <class Field>
struct RayPart {
  Field begin;
  Field end;
  bool has_begin;
  bool has_end;

  bool is_empty() const { return end < begin || (begin == end && !(has_begin && has_end)); }
  // Of disjoint parts that are not empty.
  friend bool operator<(const RayPart& a, const RayPart& b) {
    return a.begin < b.begin || (a.begin == b.begin && a.end < b.end);
  }
};

namespace detail {

template <class Field>
class RayClipper {
 public:
  void after(const Field& t, bool included) {
    if (t < part_.begin || (t == part_.begin && (included || !part_.has_begin))) return;
    part_.begin = t;
    part_.has_begin = included;
  }
  void before(const Field& t, bool included) {
    if (ends_ && (part_.end < t || (t == part_.end && (included || !part_.has_end)))) return;
    part_.end = t;
    part_.has_end = included;
    ends_ = true;
  }
  // REQUIRES before was called
  std::optional<RayPart<Field>> part() && {
    if (part_.is_empty()) return std::nullopt;
    return std::move(part_);
  }

 private:
  RayPart<Field> part_{Field(0), Field(0), true, true};
  bool ends_ = false;
};

}  // namespace detail

// The part of a ray in a cell; none if it misses it. REQUIRES a direction other than 0.
template <class Field, std::size_t dimension, BoxCell C>
std::optional<RayPart<Field>> clip(const Ray<Field, dimension>& ray, const C& cell) {
  detail::RayClipper<Field> clipper;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const Field& origin = ray.origin[axis];
    const Field& direction = ray.direction[axis];
    const Field lower(cell.lower[axis]);
    const Field upper(cell.upper[axis]);
    if (direction == 0) {
      if (origin < lower || !(origin < upper)) return std::nullopt;
      continue;
    }
    const bool rising = 0 < direction;
    const Field at_lower = (lower - origin) / direction;
    const Field at_upper = (upper - origin) / direction;
    clipper.after(rising ? at_lower : at_upper, rising);
    clipper.before(rising ? at_upper : at_lower, !rising);
  }
  return std::move(clipper).part();
}

template <class T, class N, BoxCell C, Divides<C, N> Division, class Field, std::size_t dimension,
          std::invocable<const T&, const C&, const RayPart<Field>&> Visit>
bool walk_ray(const Tree<T, N>& tree, C cell, const Division& division,
              const Ray<Field, dimension>& ray, Visit&& visit) {
  if (std::ranges::all_of(ray.direction, [](const Field& d) { return d == 0; })) {
    throw Error(ErrorId::BadArgument, {"a ray without direction", "a direction other than 0"});
  }
  struct Passage {
    C cell;
    RayPart<Field> part;
  };
  struct Candidate {
    std::size_t index;
    Passage passage;
  };
  std::optional<RayPart<Field>> whole = clip(ray, cell);
  if (!whole) return false;
  std::vector<Candidate> candidates;
  return follow(
      tree, Passage{std::move(cell), *std::move(whole)},
      [&](const Passage& from, const typename Tree<T, N>::Node& node, auto&& receive) {
        candidates.clear();
        for (std::size_t i = 0; i < node.degree(); ++i) {
          C child = division(from.cell, node.label(), i);
          if (auto part = clip(ray, child)) {
            candidates.push_back({i, {std::move(child), *std::move(part)}});
          }
        }
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
          return a.passage.part < b.passage.part;
        });
        for (Candidate& c : candidates) receive(c.index, std::move(c.passage));
      },
      [&](const T& terminal, const Passage& passage) {
        return detail::ends(visit, terminal, passage.cell, passage.part);
      });
}

}  // namespace exactcsg::gdt
