// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <chrono>
#include <random>
#include <set>

#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/facet_complex.hpp"
#include "exactcsg/verify/sampling.hpp"

namespace exactcsg::verify {
namespace {

using csg::BooleanOperator;

// Distinct subtrees of moderate size, in the order of a walk.
std::vector<Solid> subtrees_of(const Solid& solid, std::size_t primitive_limit) {
  constexpr std::size_t enough = 20'000;
  std::vector<Solid> result;
  std::set<const void*> seen;
  std::vector<const Solid*> pending{&solid};
  while (!pending.empty() && result.size() < enough) {
    const Solid* node = pending.back();
    pending.pop_back();
    if (node->is_empty() || node->is_full() || !seen.insert(node->identity()).second) continue;
    if (node->primitive_count() <= primitive_limit) result.push_back(*node);
    if (!node->is_compose()) continue;
    for (const Solid& child : node->children()) pending.push_back(&child);
  }
  return result;
}

Solid combine(BooleanOperator operation, const Solid& a, const Solid& b) {
  return Solid::compose(operation, {a, b});
}

struct Law {
  const char* name;
  std::vector<Solid> left;   // volumes that add up to
  std::vector<Solid> right;  // these; or, if `same`, one solid each with equal digests
  bool same = false;
};

std::vector<Law> laws_of(const Solid& a, const Solid& b, const Solid& box) {
  using enum BooleanOperator;
  const Solid both = combine(Union, a, b);
  const Solid common = combine(Intersection, a, b);
  const Solid rest = combine(Difference, a, b);
  return {
      {"v(A+B) + v(A*B) = v(A) + v(B)", {both, common}, {a, b}, false},
      {"v(A-B) + v(A*B) = v(A)", {rest, common}, {a}, false},
      {"A + A = A", {combine(Union, a, a)}, {a}, true},
      {"A * (A + B) = A", {combine(Intersection, a, both)}, {a}, true},
      {"A + (A * B) = A", {combine(Union, a, common)}, {a}, true},
      {"A - A is empty", {combine(Difference, a, a)}, {Solid::empty()}, true},
      {"box - (A + B) = (box - A) * (box - B)",
       {combine(Difference, box, both)},
       {combine(Intersection, combine(Difference, box, a), combine(Difference, box, b))},
       true},
      {"A ^ B = (A - B) + (B - A)",
       {combine(SymmetricDifference, a, b)},
       {combine(Union, rest, combine(Difference, b, a))},
       true},
  };
}

// A box round both, touching neither. nullopt: one of them is empty or unbounded.
std::optional<Solid> box_round(const Boundary& a, const Boundary& b) {
  const auto p = bounding_box(a);
  const auto q = bounding_box(b);
  if (!p || !q) return std::nullopt;
  const Point3 low{std::min(p->lower.x, q->lower.x) - 1, std::min(p->lower.y, q->lower.y) - 1,
                   std::min(p->lower.z, q->lower.z) - 1};
  const Point3 high{std::max(p->upper.x, q->upper.x) + 1, std::max(p->upper.y, q->upper.y) + 1,
                    std::max(p->upper.z, q->upper.z) + 1};
  return Solid::primitive({make_box(low, high), {}});
}

class LawRun {
 public:
  explicit LawRun(const LawOptions& options) : options_(options), random_(options.seed) {}

  std::vector<Check> run(const Solid& solid) {
    const std::vector<Solid> candidates = subtrees_of(solid, options_.primitive_limit);
    for (std::size_t i = 0; i < options_.samples && !candidates.empty() && in_time(); ++i) {
      const Solid& a = candidates[random_() % candidates.size()];
      const Solid& b = candidates[random_() % candidates.size()];
      try_pair(a, b);
    }
    Check total;
    total.oracle = "laws";
    total.name = "laws: pairs of subtrees";
    total.ours = fmt::format("{} laws hold", held_);
    total.theirs = fmt::format("{} tried", tried_);
    total.difference = std::to_string(tried_ - held_);
    total.bound = "0";
    total.mismatches = mismatches_.mismatches;
    total.mismatch_count = mismatches_.mismatch_count;
    total.verdict = tried_ != held_ ? Verdict::Failed
                    : tried_ == 0   ? Verdict::Skipped
                                    : Verdict::Passed;
    total.explanation = tried_ == 0 ? "no two bounded subtrees, or no time" : "";
    return {total};
  }

 private:
  bool in_time() const {
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - start_;
    return past.count() < options_.budget_seconds;
  }

  Boundary boundary_of(const Solid& solid) const {
    EvaluateOptions options;
    options.progress = options_.progress;
    return evaluate(solid, options);
  }

  void try_pair(const Solid& a, const Solid& b) {
    std::optional<Solid> box;
    try {
      box = box_round(boundary_of(a), boundary_of(b));
    } catch (const Error& error) {
      if (error.id() != ErrorId::UnboundedSolid) throw;
    }
    if (!box) return;
    for (const Law& law : laws_of(a, b, *box)) {
      if (!in_time()) return;
      ++tried_;
      const bool holds = law.same ? same(law.left.front(), law.right.front())
                                  : balances(volumes(law.left), volumes(law.right));
      if (holds) {
        ++held_;
      } else {
        complain(law, a, b);
      }
    }
  }

  bool same(const Solid& a, const Solid& b) const {
    return digest(boundary_of(a)) == digest(boundary_of(b));
  }

  std::vector<VolumeSum> volumes(const std::vector<Solid>& solids) const {
    std::vector<VolumeSum> result;
    result.reserve(solids.size());
    for (const Solid& solid : solids) result.push_back(volume_sum(boundary_of(solid)));
    return result;
  }

  void complain(const Law& law, const Solid& a, const Solid& b) {
    const auto p = bounding_box(boundary_of(a));
    const auto q = bounding_box(boundary_of(b));
    add_mismatch(mismatches_,
                 {fmt::format("{} does not hold for A of {} primitives from {} and B of {} "
                              "primitives from {}",
                              law.name, a.primitive_count(), describe(p->lower),
                              b.primitive_count(), describe(q->lower)),
                  {approximate(p->lower), approximate(p->upper)}});
  }

  const LawOptions& options_;
  std::mt19937_64 random_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::size_t tried_ = 0;
  std::size_t held_ = 0;
  Check mismatches_;
};

}  // namespace

std::vector<Check> check_laws(const Solid& solid, const LawOptions& options) {
  return LawRun(options).run(solid);
}

}  // namespace exactcsg::verify
