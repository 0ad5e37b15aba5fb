// SPDX-License-Identifier: Apache-2.0
#pragma once

// Proofs about regions in a box: do their interiors overlap, do they cover the box, does one
// contain the other? [Certified]; witnesses [Exact]
//
//   prove_disjoint(regions, box)   no point of the box is inside two regions
//   prove_cover(regions, box)      every point of the box is in a region
//   prove_disjoint(a, b, box)      they do not interfere
//   prove_contains(a, b, box)      b is a subset of a
//   prove_partition(regions, within, box)
//                                  every point of the box that is inside `within` is in exactly one
//                                  region: prove_disjoint and prove_cover in one
//   find_combinations(regions, within, box)
//                                  which sets of regions have points in common inside `within`
//
// "Every point" means all but a closed set without interior: sets that touch do not overlap.
//
// LAW region_proof.1  Proved: it is so.
// LAW region_proof.2  Refuted: each witness is a rational point of the open box, In (an inner
//                     point) for exactly the regions named, and Out for all others, or On their
//                     boundaries: at least two are named of prove_disjoint; of prove_cover none,
//                     and the point is Out for all; either of prove_partition. It is In `within`.
// LAW region_proof.3  Undecided: outside the cells there is no violation, and their volumes sum up
//                     to `volume`. It is what is left when the volume is negligible or a limit is
//                     reached.
// LAW region_proof.4  witnesses name different sets of regions. If `is_complete`, these are all the
//                     sets that violate the claim. If not, others may be found in the cells of
//                     `rest` only.
// LAW region_proof.5  find_combinations refutes the claim that there are no points: the witnesses
//                     name the sets of regions that points inside `within` are in, and are Out of
//                     the others.
//
// Method: the box is divided. In a cell, the regions are pruned, and what is left of them is a
// truth function of few distinct surfaces: if none of the combinations of their sides violates the
// claim, the cell is proved, however often it is divided by surfaces that regions share.
// Combinations of sides that exclude each other in the whole box are left out: f < 0 and g < 0 do
// if f + mu g >= 0 on the box for some mu > 0 (witness_search.hpp), which is what proves surfaces
// that touch; for some that exclude each other by threes, see exclusion_of_three.hpp. If a
// combination is left, points that may have it are tried; then the cell is divided. COST: O(cells
// (local nodes + 2^k)), k <= 10 local surfaces; an exact range (quadric.hpp) for every pair of
// surfaces that share a small cell.

#include <algorithm>
#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <set>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "exactcsg/measure/certified_measure.hpp"
#include "exactcsg/measure/exclusion_of_three.hpp"
#include "exactcsg/measure/local_region.hpp"
#include "exactcsg/measure/torus_exclusion.hpp"
#include "exactcsg/measure/witness_search.hpp"

namespace exactcsg::measure {

struct Proved {};

struct Witness {
  domain::Point<3> point;
  std::vector<std::size_t> regions;  // that it is In, ascending
};
struct Undecided {
  Rational volume;
  std::vector<domain::Box<3>> cells;  // the largest first
  StopReason stop = StopReason::Width;
};
struct Refuted {
  std::vector<Witness> witnesses;  // at least one
  bool is_complete = false;        // no other sets of regions violate the claim
  Undecided rest;                  // no cells if it is complete
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

// NoPoint: there is no point at all.
enum class Claim : unsigned char { Disjoint, Cover, Partition, NoPoint };

// The first's polynomial plus a multiple of the second's is nowhere negative in the box, so that
// their interiors have no common point there. REQUIRES no nappes, factor > 0.
inline bool exclude_each_other(const domain::HalfSpace<3>& a, const domain::HalfSpace<3>& b,
                               const Rational& factor, const Box3& box) {
  const auto polynomial = [](const domain::HalfSpace<3>& half_space) {
    return Rational(half_space.is_complement() ? -1 : 1) * half_space.polynomial();
  };
  return domain::is_nowhere_negative(polynomial(a) + factor * polynomial(b), box);
}

inline bool exclude_each_other(const domain::SurfaceHalfSpace& a, const domain::SurfaceHalfSpace& b,
                               const Rational& factor, const Box3& box) {
  return a.quadric() != nullptr && b.quadric() != nullptr &&
         exclude_each_other(*a.quadric(), *b.quadric(), factor, box);
}

template <SpatialDomain P>
class RegionProver {
 public:
  RegionProver(std::span<const csg::BooleanTree<P>> regions, const csg::BooleanTree<P>& within,
               const Box3& box, Claim claim, const ProofLimits& limits)
      : limits_(limits),
        claim_(claim),
        box_(box),
        locals_of_box_(locals(regions, within)),
        memberships_(table_) {
    if (limits_.progress != nullptr) limits_.progress->begin("prove", limits_.cells);
  }

  Proof run() {
    negligible_ = volume_of(box_) * rational_of(limits_.negligible_share);
    examine(box_, locals_of_box_);
    StopReason stop = StopReason::Width;
    while (!cells_.empty() && witnesses_.size() < limits_.witnesses) {
      if (undecided_ <= negligible_) break;
      if (count_ >= limits_.cells) stop = StopReason::Cells;
      if (limits_.progress != nullptr && limits_.progress->cancelled())
        stop = StopReason::Cancelled;
      // One cell of many regions may take longer than many cells of few.
      if (limits_.deadline && std::chrono::steady_clock::now() >= *limits_.deadline) {
        stop = StopReason::Deadline;
      }
      if (stop != StopReason::Width) break;
      const Cell cell = cells_.top();
      cells_.pop();
      undecided_ -= cell.volume;
      const auto parts = divided(cell.box, cell.cut);
      examine(parts.first, *cell.locals);
      examine(parts.second, *cell.locals);
    }
    if (!witnesses_.empty()) drop_what_is_witnessed();
    const bool is_complete = cells_.empty();
    Undecided rest{undecided_, {}, stop};
    for (; !cells_.empty(); cells_.pop()) rest.cells.push_back(cells_.top().box);
    if (!witnesses_.empty()) return Refuted{std::move(witnesses_), is_complete, std::move(rest)};
    if (is_complete) return Proved{};
    return rest;
  }

 private:
  struct Local {
    std::size_t region;
    LiteralTree tree;
  };
  // What is left in a cell of `within` and of the regions that are not empty there.
  struct Locals {
    LiteralTree within;
    std::vector<Local> regions;
  };
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
  static constexpr std::size_t most_mixed_regions = 4;

  Locals locals(std::span<const csg::BooleanTree<P>> regions, const csg::BooleanTree<P>& within) {
    Locals result{table_.add(within), {}};
    for (const csg::BooleanTree<P>& region : regions) {
      result.regions.push_back({result.regions.size(), table_.add(region)});
    }
    return result;
  }

  bool is_violation(std::size_t regions) const {
    switch (claim_) {
      case Claim::Disjoint:
        return regions >= 2;
      case Claim::Cover:
        return regions == 0;
      case Claim::Partition:
        return regions != 1;
      case Claim::NoPoint:
        break;
    }
    return true;
  }
  bool is_new_violation(const std::vector<std::size_t>& regions) const {
    return is_violation(regions.size()) && !witnessed_.contains(regions);
  }

  // Whether points of a cell may violate the claim in a new way, whatever the surfaces do there.
  bool may_be_violated(const std::vector<Local>& regions) const {
    std::vector<std::size_t> inside;
    std::vector<std::size_t> mixed;
    for (const Local& region : regions) {
      (region.tree.is_full() ? inside : mixed).push_back(region.region);
    }
    if (claim_ == Claim::Cover && !inside.empty()) return false;
    if (claim_ == Claim::Disjoint && regions.size() < 2) return false;
    if (mixed.size() > most_mixed_regions) return true;
    for (std::size_t subset = 0; subset < (std::size_t{1} << mixed.size()); ++subset) {
      std::vector<std::size_t> tried = inside;
      for (std::size_t i = 0; i < mixed.size(); ++i) {
        if ((subset >> i & 1U) != 0) tried.push_back(mixed[i]);
      }
      std::sort(tried.begin(), tried.end());
      if (is_new_violation(tried)) return true;
    }
    return false;
  }

  void examine(const Box3& box, const Locals& above) {
    ++count_;
    if (limits_.progress != nullptr) limits_.progress->advance();
    memberships_.enter(box);
    auto local = std::make_shared<Locals>();
    local->within = csg::prune(above.within, memberships_);
    if (local->within.is_empty()) return;
    for (const Local& region : above.regions) {
      LiteralTree tree = csg::prune(region.tree, memberships_);
      if (!tree.is_empty()) local->regions.push_back({region.region, std::move(tree)});
    }
    if (!may_be_violated(local->regions)) return;
    // If the cell violates the claim as a whole, its centre does.
    try_point(box.centre(), *local);
    const auto surfaces = surfaces_of_all(*local);
    if (surfaces && is_proved(box, *local, *surfaces)) return;
    keep(box, std::move(local));
  }

  // Of the cells that are left, those whose only violations were found after they were looked at.
  void drop_what_is_witnessed() {
    std::priority_queue<Cell> left;
    undecided_ = 0;
    for (; !cells_.empty(); cells_.pop()) {
      const Cell& cell = cells_.top();
      if (!may_be_violated(cell.locals->regions)) continue;
      const auto surfaces = surfaces_of_all(*cell.locals);
      if (surfaces && is_proved(cell.box, *cell.locals, *surfaces)) continue;
      undecided_ += cell.volume;
      left.push(cell);
    }
    cells_ = std::move(left);
  }

  void keep(const Box3& box, std::shared_ptr<const Locals> local) {
    std::optional<AxisPlane> cut;
    DividingAxis axis(box);
    const auto consider = [&](const LiteralTree& tree) {
      if (!cut) cut = axis_cut(table_, tree, box);
      axis.add(table_, tree, box);
    };
    consider(local->within);
    for (const Local& region : local->regions) consider(region.tree);
    Rational volume = volume_of(box);
    undecided_ += volume;
    cells_.push({std::move(volume), box, cut ? *cut : axis.bisector(box), std::move(local)});
  }

  std::optional<std::vector<std::uint32_t>> surfaces_of_all(const Locals& local) const {
    std::vector<std::uint32_t> all;
    const auto add = [&](const LiteralTree& tree) {
      const auto some = surfaces_of(tree, most_surfaces);
      if (!some) return false;
      all.insert(all.end(), some->begin(), some->end());
      std::sort(all.begin(), all.end());
      all.erase(std::unique(all.begin(), all.end()), all.end());
      return all.size() <= most_surfaces;
    };
    if (!add(local.within)) return std::nullopt;
    for (const Local& region : local.regions) {
      if (!add(region.tree)) return std::nullopt;
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
    const auto flat = [&](const LiteralTree& tree) {
      return csg::flatten(tree, [&](const Literal& literal) {
        const auto at = std::lower_bound(surfaces.begin(), surfaces.end(), literal.surface);
        return Literal{static_cast<std::uint32_t>(at - surfaces.begin()), literal.is_complemented};
      });
    };
    const FlatRegion within = flat(local.within);
    std::vector<FlatRegion> regions;
    for (const Local& region : local.regions) regions.push_back(flat(region.tree));
    std::vector<Sides> violations;
    for (Sides sides = 0; sides < (Sides{1} << surfaces.size()); ++sides) {
      const auto is_in = [&](const FlatRegion& region) {
        return csg::membership_of(region, [&](const Literal& literal) {
                 const bool is_inside = (sides >> literal.surface & 1U) != 0;
                 return is_inside != literal.is_complemented ? csg::Membership::In
                                                             : csg::Membership::Out;
               }) == csg::Membership::In;
      };
      if (!is_in(within)) continue;
      std::vector<std::size_t> inside;
      for (std::size_t i = 0; i < regions.size(); ++i) {
        if (is_in(regions[i])) inside.push_back(local.regions[i].region);
      }
      if (!is_new_violation(inside)) continue;
      if (violations.size() == most_violations) return std::nullopt;
      violations.push_back(sides);
    }
    return violations;
  }

  // True if no combination of sides can occur. Tries points that may have them otherwise.
  bool all_excluded(const Box3& box, const Locals& local,
                    const std::vector<std::uint32_t>& surfaces,
                    const std::vector<Sides>& violations) {
    std::vector<UnitSurface> polynomials;
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
                   const std::vector<UnitSurface>& polynomials, Sides sides) {
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
          try_point_round_axis(key, box);
          const bool excluded = exclude(key, f, g, middle);
          exclusions_.emplace(key, excluded);
          if (excluded) return true;
        }
      }
    }
    return is_excluded_by_three(surfaces, sides);
  }

  bool is_excluded_by_three(const std::vector<std::uint32_t>& surfaces, Sides sides) {
    if constexpr (std::convertible_to<P, domain::SurfaceHalfSpace>) {
      const auto literal = [&](std::size_t i) { return 2 * surfaces[i] + (sides >> i & 1U); };
      for (std::size_t i = 0; i < surfaces.size(); ++i) {
        for (std::size_t j = i + 1; j < surfaces.size(); ++j) {
          for (std::size_t k = j + 1; k < surfaces.size(); ++k) {
            const TripleKey key{literal(i), literal(j), literal(k)};
            const auto [known, is_new] = exclusions_of_three_.try_emplace(key, false);
            if (is_new) {
              known->second =
                  exclude_each_other(inside(key[0]), inside(key[1]), inside(key[2]), box_);
            }
            if (known->second) return true;
          }
        }
      }
    }
    return false;
  }
  using TripleKey = std::array<std::uint32_t, 3>;

  // What a literal of a key says.
  P inside(std::uint32_t literal) const {
    return literal % 2 == 1 ? table_[literal / 2] : complement(table_[literal / 2]);
  }

  using PairKey = std::pair<std::uint32_t, std::uint32_t>;

  // Thin lenses all round a torus are met by few cells' centres.
  void try_point_round_axis(const PairKey& key, const Box3& box) {
    if constexpr (std::convertible_to<P, domain::SurfaceHalfSpace>) {
      const auto point = point_round_axis(inside(key.first), inside(key.second), box.centre());
      if (point && is_inside(box_, *point)) try_point(*point, locals_of_box_);
    }
  }
  static bool is_inside(const Box3& box, const domain::Point<3>& point) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (point[i] <= box.lower()[i] || point[i] >= box.upper()[i]) return false;
    }
    return true;
  }

  bool exclude(const PairKey& key, const ApproximateQuadric& f, const ApproximateQuadric& g,
               const std::optional<Balance>& middle) const {
    if constexpr (std::convertible_to<P, domain::SurfaceHalfSpace>) {
      if (exclude_round_axis(inside(key.first), inside(key.second), box_)) return true;
    }
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
    return exclude_each_other(inside(key.first), inside(key.second), factor, box_);
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

  void try_inside(const Box3& box, const Locals& local, const std::vector<UnitSurface>& polynomials,
                  Sides sides) {
    std::vector<ApproximateQuadric> negative;
    for (std::size_t i = 0; i < polynomials.size(); ++i) {
      negative.emplace_back(polynomials[i], (sides >> i & 1U) == 0);
    }
    const Position x = pushed_inside(negative);
    if (is_in_cell(x)) try_point(global(box, x), local);
    for (std::size_t i = 0; i < polynomials.size(); ++i) {
      const Position low = low_point(polynomials[i], !is_negative(sides, i));
      if (!all_negative(polynomials, sides, low)) continue;
      // Away from the walls, as far as it goes.
      for (double away = 0x1p-3; away > 0x1p-45; away *= 0x1p-3) {
        Position inside = low;
        for (double& coordinate : inside) coordinate *= 1 - away;
        if (!all_negative(polynomials, sides, inside)) continue;
        try_point(global(box, inside), local);
        break;
      }
    }
  }
  static bool is_negative(Sides sides, std::size_t i) { return (sides >> i & 1U) != 0; }
  // As far as doubles tell.
  static bool all_negative(const std::vector<UnitSurface>& polynomials, Sides sides,
                           const Position& x) {
    const UnitSurface::Vector at{exactly(x[0]), exactly(x[1]), exactly(x[2])};
    for (std::size_t i = 0; i < polynomials.size(); ++i) {
      const double value = polynomials[i](at).value;
      if (!((is_negative(sides, i) ? value : -value) < 0)) return false;
    }
    return true;
  }

  // Records the point if it is a violation of a new kind.
  // REQUIRES it is in the open cell of the locals.
  void try_point(const domain::Point<3>& point, const Locals& local) {
    const auto membership_at = [&](const LiteralTree& tree) {
      return csg::membership_of(tree, [&](const Literal& literal) {
        return domain::detail::complement_if(literal.is_complemented,
                                             membership(classify(table_[literal.surface], point)));
      });
    };
    if (membership_at(local.within) != csg::Membership::In) return;
    std::vector<std::size_t> inside;
    bool is_on_boundary = false;
    for (const Local& region : local.regions) {
      const csg::Membership value = membership_at(region.tree);
      if (value == csg::Membership::In) inside.push_back(region.region);
      is_on_boundary = is_on_boundary || value == csg::Membership::Unknown;
    }
    if (is_on_boundary && (inside.empty() || claim_ == Claim::NoPoint)) return;
    if (!is_new_violation(inside) || witnesses_.size() == limits_.witnesses) return;
    witnessed_.insert(inside);
    witnesses_.push_back({point, std::move(inside)});
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
  std::map<TripleKey, bool> exclusions_of_three_;
  std::vector<Witness> witnesses_;
  std::set<std::vector<std::size_t>> witnessed_;
  std::uint64_t count_ = 0;
};

}  // namespace detail

template <SpatialDomain P>
Proof prove_disjoint(std::span<const csg::BooleanTree<P>> regions, const domain::Box<3>& box,
                     const ProofLimits& limits = {}) {
  return detail::RegionProver<P>(regions, csg::BooleanTree<P>::full(), box, detail::Claim::Disjoint,
                                 limits)
      .run();
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
  return detail::RegionProver<P>(regions, csg::BooleanTree<P>::full(), box, detail::Claim::Cover,
                                 limits)
      .run();
}

template <SpatialDomain P>
Proof prove_partition(std::span<const csg::BooleanTree<P>> regions,
                      const csg::BooleanTree<P>& within, const domain::Box<3>& box,
                      const ProofLimits& limits = {}) {
  return detail::RegionProver<P>(regions, within, box, detail::Claim::Partition, limits).run();
}

template <SpatialDomain P>
Proof find_combinations(std::span<const csg::BooleanTree<P>> regions,
                        const csg::BooleanTree<P>& within, const domain::Box<3>& box,
                        const ProofLimits& limits = {}) {
  return detail::RegionProver<P>(regions, within, box, detail::Claim::NoPoint, limits).run();
}

// A witness is a point of the interior of b that is Out of a.
template <SpatialDomain P>
Proof prove_contains(const csg::BooleanTree<P>& a, const csg::BooleanTree<P>& b,
                     const domain::Box<3>& box, const ProofLimits& limits = {}) {
  const std::array regions{a, csg::complement(b)};
  return prove_cover<P>(std::span<const csg::BooleanTree<P>>(regions), box, limits);
}

}  // namespace exactcsg::measure
