// SPDX-License-Identifier: Apache-2.0
#pragma once

// Proofs about regions in a box: do their interiors overlap, do they cover the box, does one
// contain the other? [Certified]; witnesses [Exact]
//
//   prove_disjoint(regions, box)   no point of the box is inside two regions
//   prove_cover(regions, box)      every point of the box is in a region
//   prove_disjoint(a, b, box)      they do not interfere
//   prove_contains(a, b, box)      b is a subset of a
//
// "Every point" means all but a closed set without interior: sets that touch do not overlap.
//
// LAW region_proof.1  Proved: it is so.
// LAW region_proof.2  Refuted: each witness is a rational point of the open box, In (an inner
//                     point) for exactly the regions named, and Out for all others, or On their
//                     boundaries: at least two are named of prove_disjoint; of prove_cover none,
//                     and the point is Out for all.
// LAW region_proof.3  Undecided: outside the cells there is no violation, and their volumes sum up
//                     to `volume`. It is what is left when the volume is negligible or a limit is
//                     reached.
// LAW region_proof.4  witnesses name different sets of regions. If `is_complete`, these are all the
//                     sets that violate the claim.
//
// Method: the box is divided. In a cell, the regions are pruned, and what is left of them is a
// truth function of few distinct surfaces: if none of the combinations of their sides violates the
// claim, the cell is proved, however often it is divided by surfaces that regions share.
// Combinations of sides that exclude each other in the whole box are left out: f < 0 and g < 0 do
// if f + mu g >= 0 on the box for some mu > 0 (witness_search.hpp), which is what proves surfaces
// that touch. If a combination is left, points that may have it are tried; then the cell is
// divided. COST: O(cells (local nodes + 2^k)), k <= 10 local surfaces; an exact range (quadric.hpp)
// for every pair of surfaces that share a small cell.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "exactcsg/measure/certified_measure.hpp"
#include "exactcsg/measure/local_region.hpp"
#include "exactcsg/measure/witness_search.hpp"

namespace exactcsg::measure {

struct Proved {};

struct Witness {
  domain::Point<3> point;
  std::vector<std::size_t> regions;  // that it is In, ascending
};
struct Refuted {
  std::vector<Witness> witnesses;  // at least one
  bool is_complete = false;        // no other sets of regions violate the claim
};

struct Undecided {
  Rational volume;
  std::vector<domain::Box<3>> cells;  // the largest first
  StopReason stop = StopReason::Width;
};

using Proof = std::variant<Proved, Refuted, Undecided>;

struct ProofLimits {
  // The work ends when so much of the box's volume is undecided.
  double negligible_share = 1e-10;
  std::uint64_t cells = 1'000'000;
  std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt;
  Progress* progress = nullptr;
  // The work ends when so many witnesses are found.
  std::size_t witnesses = 1;
};

namespace detail {

enum class Claim : unsigned char { Disjoint, Cover };

template <SpatialDomain P>
class RegionProver {
 public:
  RegionProver(std::span<const csg::BooleanTree<P>> regions, const Box3& box, Claim claim,
               const ProofLimits& limits)
      : limits_(limits),
        claim_(claim),
        box_(box),
        locals_of_box_(locals(regions)),
        memberships_(table_) {
    if (limits_.progress != nullptr) limits_.progress->begin("prove", limits_.cells);
  }

  Proof run() {
    negligible_ = volume_of(box_) * rational_of(limits_.negligible_share);
    examine(box_, locals_of_box_);
    std::uint64_t looked_at_clock = 0;
    StopReason stop = StopReason::Width;
    while (!cells_.empty() && witnesses_.size() < limits_.witnesses) {
      if (undecided_ <= negligible_) break;
      if (count_ >= limits_.cells) stop = StopReason::Cells;
      if (limits_.progress != nullptr && limits_.progress->cancelled())
        stop = StopReason::Cancelled;
      if (limits_.deadline && count_ / cells_per_look_at_clock != looked_at_clock) {
        looked_at_clock = count_ / cells_per_look_at_clock;
        if (std::chrono::steady_clock::now() >= *limits_.deadline) stop = StopReason::Deadline;
      }
      if (stop != StopReason::Width) break;
      const Cell cell = cells_.top();
      cells_.pop();
      undecided_ -= cell.volume;
      const auto parts = divided(cell.box, cell.cut);
      examine(parts.first, *cell.locals);
      examine(parts.second, *cell.locals);
    }
    if (!witnesses_.empty()) return Refuted{std::move(witnesses_), cells_.empty()};
    if (cells_.empty()) return Proved{};
    Undecided result{undecided_, {}, stop};
    for (; !cells_.empty(); cells_.pop()) result.cells.push_back(cells_.top().box);
    return result;
  }

 private:
  struct Local {
    std::size_t region;
    LiteralTree tree;
  };
  using Locals = std::vector<Local>;
  struct Cell {
    Rational volume;
    Box3 box;
    AxisPlane cut;
    std::shared_ptr<const Locals> locals;
    friend bool operator<(const Cell& a, const Cell& b) { return a.volume < b.volume; }
  };
  using FlatRegion = csg::FlatTree<Literal, csg::BooleanOperator>;
  // Bit i is set where the point is in the i-th surface's half-space.
  using Sides = std::uint32_t;
  static constexpr std::size_t most_surfaces = 10;
  static constexpr std::size_t most_surfaces_of_pairs = 6;
  static constexpr std::size_t most_violations = 24;

  Locals locals(std::span<const csg::BooleanTree<P>> regions) {
    Locals result;
    for (const csg::BooleanTree<P>& region : regions) {
      result.push_back({result.size(), table_.add(region)});
    }
    return result;
  }

  bool is_violation(std::size_t regions) const {
    return claim_ == Claim::Disjoint ? regions >= 2 : regions == 0;
  }

  void examine(const Box3& box, const Locals& above) {
    ++count_;
    if (limits_.progress != nullptr) limits_.progress->advance();
    memberships_.enter(box);
    auto local = std::make_shared<Locals>();
    std::size_t full = 0;
    for (const Local& region : above) {
      LiteralTree tree = csg::prune(region.tree, memberships_);
      if (tree.is_empty()) continue;
      if (tree.is_full()) ++full;
      local->push_back({region.region, std::move(tree)});
    }
    if (claim_ == Claim::Disjoint ? local->size() < 2 : full > 0) return;
    // If the cell violates the claim as a whole, its centre does.
    try_point(box.centre(), *local);
    const auto surfaces = surfaces_of_all(*local);
    if (surfaces && is_proved(box, *local, *surfaces)) return;
    keep(box, std::move(local));
  }

  void keep(const Box3& box, std::shared_ptr<const Locals> local) {
    std::optional<AxisPlane> cut;
    DividingAxis axis(box);
    for (const Local& region : *local) {
      if (!cut) cut = axis_cut(table_, region.tree, box);
      axis.add(table_, region.tree, box);
    }
    Rational volume = volume_of(box);
    undecided_ += volume;
    cells_.push({std::move(volume), box, cut ? *cut : axis.bisector(box), std::move(local)});
  }

  std::optional<std::vector<std::uint32_t>> surfaces_of_all(const Locals& local) const {
    std::vector<std::uint32_t> all;
    for (const Local& region : local) {
      const auto some = surfaces_of(region.tree, most_surfaces);
      if (!some) return std::nullopt;
      all.insert(all.end(), some->begin(), some->end());
      std::sort(all.begin(), all.end());
      all.erase(std::unique(all.begin(), all.end()), all.end());
      if (all.size() > most_surfaces) return std::nullopt;
    }
    return all;
  }

  bool is_proved(const Box3& box, const Locals& local, const std::vector<std::uint32_t>& surfaces) {
    const std::optional<std::vector<Sides>> violations = violations_of(local, surfaces);
    if (!violations) return false;
    if (violations->empty()) return true;
    if constexpr (requires(const P& p) { local_polynomial(p, box); }) {
      if (surfaces.size() > most_surfaces_of_pairs) return false;
      return all_excluded(box, local, surfaces, *violations);
    }
    return false;
  }

  // Those of which there is no witness yet; nullopt if they are too many to be looked at one by
  // one.
  std::optional<std::vector<Sides>> violations_of(
      const Locals& local, const std::vector<std::uint32_t>& surfaces) const {
    std::vector<FlatRegion> regions;
    for (const Local& region : local) {
      regions.push_back(csg::flatten(region.tree, [&](const Literal& literal) {
        const auto at = std::lower_bound(surfaces.begin(), surfaces.end(), literal.surface);
        return Literal{static_cast<std::uint32_t>(at - surfaces.begin()), literal.is_complemented};
      }));
    }
    std::vector<Sides> violations;
    for (Sides sides = 0; sides < (Sides{1} << surfaces.size()); ++sides) {
      std::vector<std::size_t> inside;
      for (std::size_t i = 0; i < regions.size(); ++i) {
        const csg::Membership value = csg::membership_of(regions[i], [&](const Literal& literal) {
          const bool is_in = (sides >> literal.surface & 1U) != 0;
          return is_in != literal.is_complemented ? csg::Membership::In : csg::Membership::Out;
        });
        if (value == csg::Membership::In) inside.push_back(local[i].region);
      }
      if (!is_violation(inside.size()) || is_witnessed(inside)) continue;
      if (violations.size() == most_violations) return std::nullopt;
      violations.push_back(sides);
    }
    return violations;
  }

  // True if no combination of sides can occur. Tries points that may have them otherwise.
  bool all_excluded(const Box3& box, const Locals& local,
                    const std::vector<std::uint32_t>& surfaces,
                    const std::vector<Sides>& violations) {
    std::vector<UnitQuadric> polynomials;
    for (const std::uint32_t surface : surfaces) {
      const auto f = local_polynomial(table_[surface], box);
      if (!f) return false;
      polynomials.push_back(*f);
    }
    bool all = true;
    for (const Sides sides : violations) {
      if (is_excluded(box, local, surfaces, polynomials, sides)) continue;
      all = false;
      try_inside(box, local, polynomials, sides);
      if (witnesses_.size() >= limits_.witnesses) return false;
    }
    return all;
  }

  bool is_excluded(const Box3& box, const Locals& local, const std::vector<std::uint32_t>& surfaces,
                   const std::vector<UnitQuadric>& polynomials, Sides sides) {
    const auto is_in = [&](std::size_t i) { return (sides >> i & 1U) != 0; };
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      for (std::size_t j = i + 1; j < surfaces.size(); ++j) {
        const ApproximateQuadric f(polynomials[i], !is_in(i));
        const ApproximateQuadric g(polynomials[j], !is_in(j));
        const PairKey key{2 * surfaces[i] + is_in(i), 2 * surfaces[j] + is_in(j)};
        const auto known = exclusions_.find(key);
        if (known != exclusions_.end() && known->second) return true;
        const std::optional<Balance> middle = balance(f, g);
        if (middle && is_in_cell(middle->point)) try_point(global(box, middle->point), local);
        if (known == exclusions_.end()) {
          const bool excluded = exclude(key, f, g, middle);
          exclusions_.emplace(key, excluded);
          if (excluded) return true;
        }
      }
    }
    return false;
  }

  using PairKey = std::pair<std::uint32_t, std::uint32_t>;

  bool exclude(const PairKey& key, const ApproximateQuadric& f, const ApproximateQuadric& g,
               const std::optional<Balance>& middle) const {
    if (const auto factor = cancelling_factor(f, g)) {
      if (is_nowhere_negative(key, simple_fraction(*factor))) return true;
    }
    if (!middle || !(middle->factor > 0x1p-60 && middle->factor < 0x1p60)) return false;
    // Both are negative in the middle of a lens.
    if (f(middle->point) < -0x1p-30 * f.scale() && g(middle->point) < -0x1p-30 * g.scale()) {
      return false;
    }
    return is_nowhere_negative(key, simple_fraction(middle->factor)) ||
           is_nowhere_negative(key, rational_of(middle->factor));
  }

  bool is_nowhere_negative(const PairKey& key, const Rational& factor) const {
    const auto side = [&](std::uint32_t literal) {
      const domain::HalfSpace<3>& half_space = table_[literal / 2];
      const bool is_negated = (literal % 2 == 1) == half_space.is_complement();
      return Rational(is_negated ? -1 : 1) * half_space.polynomial();
    };
    return domain::range(side(key.first) + factor * side(key.second), box_).minimum >= 0;
  }

  static bool is_in_cell(const Position& x) {
    return std::all_of(x.begin(), x.end(), [](double c) { return std::abs(c) < 1; });
  }
  static domain::Point<3> global(const Box3& box, const Position& x) {
    domain::Coordinates<3> result;
    for (std::size_t i = 0; i < 3; ++i) {
      const Rational half = (box.upper()[i] - box.lower()[i]) / 2;
      result[i] = box.lower()[i] + half + half * rational_of(x[i]);
    }
    return result;
  }

  void try_inside(const Box3& box, const Locals& local, const std::vector<UnitQuadric>& polynomials,
                  Sides sides) {
    std::vector<ApproximateQuadric> negative;
    for (std::size_t i = 0; i < polynomials.size(); ++i) {
      negative.emplace_back(polynomials[i], (sides >> i & 1U) == 0);
    }
    const Position x = pushed_inside(negative);
    if (is_in_cell(x)) try_point(global(box, x), local);
  }

  bool is_witnessed(const std::vector<std::size_t>& regions) const {
    return std::any_of(witnesses_.begin(), witnesses_.end(),
                       [&](const Witness& known) { return known.regions == regions; });
  }

  // Records the point if it is a violation of a new kind.
  // REQUIRES it is in the open cell of the locals.
  void try_point(const domain::Point<3>& point, const Locals& local) {
    std::vector<std::size_t> inside;
    for (const Local& region : local) {
      const csg::Membership value = csg::membership_of(region.tree, [&](const Literal& literal) {
        return domain::detail::complement_if(literal.is_complemented,
                                             membership(classify(table_[literal.surface], point)));
      });
      if (value == csg::Membership::In) inside.push_back(region.region);
      if (claim_ == Claim::Cover && value != csg::Membership::Out) return;
    }
    if (!is_violation(inside.size()) || is_witnessed(inside)) return;
    if (witnesses_.size() < limits_.witnesses) witnesses_.push_back({point, std::move(inside)});
  }

  const ProofLimits& limits_;
  Claim claim_;
  Box3 box_;
  SurfaceTable<P> table_;
  Locals locals_of_box_;
  LocalMemberships<P> memberships_;
  std::priority_queue<Cell> cells_;
  Rational undecided_;
  Rational negligible_;
  std::map<PairKey, bool> exclusions_;
  std::vector<Witness> witnesses_;
  std::uint64_t count_ = 0;
};

}  // namespace detail

template <SpatialDomain P>
Proof prove_disjoint(std::span<const csg::BooleanTree<P>> regions, const domain::Box<3>& box,
                     const ProofLimits& limits = {}) {
  return detail::RegionProver<P>(regions, box, detail::Claim::Disjoint, limits).run();
}

template <SpatialDomain P>
Proof prove_disjoint(const csg::BooleanTree<P>& a, const csg::BooleanTree<P>& b,
                     const domain::Box<3>& box, const ProofLimits& limits = {}) {
  const std::array regions{a, b};
  return prove_disjoint<P>(std::span<const csg::BooleanTree<P>>(regions), box, limits);
}

template <SpatialDomain P>
Proof prove_cover(std::span<const csg::BooleanTree<P>> regions, const domain::Box<3>& box,
                  const ProofLimits& limits = {}) {
  return detail::RegionProver<P>(regions, box, detail::Claim::Cover, limits).run();
}

// A witness is a point of the interior of b that is Out of a.
template <SpatialDomain P>
Proof prove_contains(const csg::BooleanTree<P>& a, const csg::BooleanTree<P>& b,
                     const domain::Box<3>& box, const ProofLimits& limits = {}) {
  const std::array regions{a, csg::complement(b)};
  return prove_cover<P>(std::span<const csg::BooleanTree<P>>(regions), box, limits);
}

}  // namespace exactcsg::measure
