// SPDX-License-Identifier: Apache-2.0
#pragma once

// The distinct surfaces of the primitives of one or several trees, numbered, and the trees over
// these numbers: who asks something of a surface in a cell asks once. [Exact]
//
// LAW surface_table.1  the literal of p has the points of table[literal.surface], or of the closure
//                      of its complement if it is complemented.
// LAW surface_table.2  half-spaces that are equal as point sets, or closed complements of each
//                      other, have one surface if their polynomials are proportional, or they are
//                      tori. Primitives of other types have one each.
// COST: O(distinct nodes) for a tree, each primitive O(log surfaces) comparisons.

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "exactcsg/csg/tree.hpp"
#include "exactcsg/domain/surface_half_space.hpp"

namespace exactcsg::measure {

// A domain of space.
template <class P>
concept SpatialDomain = domain::Domain<P> && P::dimension == 3;

struct Literal {
  std::uint32_t surface = 0;
  bool is_complemented = false;
  friend bool operator==(const Literal&, const Literal&) = default;
};

using LiteralTree = csg::BooleanTree<Literal>;

namespace detail {

inline void append_coefficients(const domain::Quadric<3>& f, std::vector<Rational>& result) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) result.push_back(f.square()[i][j]);
  }
  result.insert(result.end(), f.linear().normal.begin(), f.linear().normal.end());
  result.push_back(f.linear().constant);
}

// Divided by the magnitude of the first that is not 0. True if that is negative.
inline bool normalise(std::vector<Rational>& coefficients) {
  Rational leading;
  for (const Rational& coefficient : coefficients) {
    if (leading == 0) leading = coefficient;
    if (leading != 0) break;
  }
  if (leading == 0) return false;
  const Rational scale = abs(leading);
  for (Rational& coefficient : coefficients) coefficient /= scale;
  return leading < 0;
}

struct SurfaceKey {
  std::vector<Rational> coefficients;
  bool is_reversed = false;  // the half-space is the complement of the one that the key names
};

inline SurfaceKey surface_key(const domain::HalfSpace<3>& half_space) {
  SurfaceKey key;
  append_coefficients(half_space.polynomial(), key.coefficients);
  const bool is_negative = normalise(key.coefficients);
  key.is_reversed = half_space.is_complement();
  if (half_space.nappe()) {  // one nappe is no complement of another
    std::vector<Rational> nappe;
    append_coefficients(*half_space.nappe(), nappe);
    normalise(nappe);
    key.coefficients.insert(key.coefficients.end(), nappe.begin(), nappe.end());
  } else if (is_negative) {
    for (Rational& coefficient : key.coefficients) coefficient = -coefficient;
    key.is_reversed = !key.is_reversed;
  }
  return key;
}

// Base and radicand are those of one surface only (torus.hpp). One coefficient more than any
// quadric has.
inline SurfaceKey surface_key(const domain::Torus& torus) {
  SurfaceKey key;
  append_coefficients(torus.base(), key.coefficients);
  append_coefficients(torus.radicand(), key.coefficients);
  key.coefficients.emplace_back(1);
  key.is_reversed = torus.is_complement();
  return key;
}
inline SurfaceKey surface_key(const domain::SurfaceHalfSpace& half_space) {
  return half_space.visit([](const auto& kind) { return surface_key(kind); });
}

}  // namespace detail

template <SpatialDomain P>
class SurfaceTable {
 public:
  Literal add(const P& primitive) {
    if constexpr (requires { detail::surface_key(primitive); }) {
      detail::SurfaceKey key = detail::surface_key(primitive);
      const auto [entry, is_new] =
          known_.try_emplace(std::move(key.coefficients),
                             Entry{static_cast<std::uint32_t>(surfaces_.size()), key.is_reversed});
      if (is_new) surfaces_.push_back(primitive);
      return {entry->second.surface, key.is_reversed != entry->second.is_reversed};
    } else {
      surfaces_.push_back(primitive);
      return {static_cast<std::uint32_t>(surfaces_.size() - 1), false};
    }
  }
  LiteralTree add(const csg::BooleanTree<P>& tree) {
    return csg::map(tree, [this](const P& primitive) { return add(primitive); });
  }

  std::size_t size() const noexcept { return surfaces_.size(); }
  const P& operator[](std::uint32_t surface) const noexcept { return surfaces_[surface]; }

 private:
  struct Entry {
    std::uint32_t surface;
    bool is_reversed;
  };
  std::vector<P> surfaces_;
  std::map<std::vector<Rational>, Entry> known_;
};

// What the surfaces of a table are in one box, each classified at most once.
template <SpatialDomain P>
class LocalMemberships {
 public:
  explicit LocalMemberships(const SurfaceTable<P>& table)
      : table_(table), known_(table.size()), asked_(table.size()) {}

  void enter(const domain::Box<3>& box) {
    box_ = &box;
    ++turn_;
  }
  // REQUIRES the box entered last lives.
  csg::Membership operator()(const Literal& literal) {
    csg::Membership& known = known_[literal.surface];
    if (asked_[literal.surface] != turn_) {
      known = classify(table_[literal.surface], *box_);
      asked_[literal.surface] = turn_;
    }
    return domain::detail::complement_if(literal.is_complemented, known);
  }

 private:
  const SurfaceTable<P>& table_;
  const domain::Box<3>* box_ = nullptr;
  std::vector<csg::Membership> known_;
  std::vector<std::uint64_t> asked_;
  std::uint64_t turn_ = 0;
};

}  // namespace exactcsg::measure
