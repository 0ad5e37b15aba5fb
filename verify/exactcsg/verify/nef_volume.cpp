// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/nef_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "exactcsg/verify/volume_bounds.hpp"

namespace exactcsg::verify {

namespace {

// Equal bounds, or those of the 17 digits that a sum with a long denominator is known to.
Enclosure enclosure_of(const VolumeSum& sum) {
  if (sum.exact) return {*sum.exact, *sum.exact};
  const Rational value = *parse_rational(sum.decimal);
  const Rational error = abs(value) * rational_of(0x1p-50);
  return {Rational(value - error), Rational(value + error)};
}

}  // namespace

NefVolume nef_volume(const io::openmc::Model& model, const io::openmc::Region& region,
                     const domain::Box<3>& box, std::uint32_t segments, const NefLimits& limits,
                     const io::openmc::HalfSpaceRegion& window) {
  using Clock = std::chrono::steady_clock;
  if (const std::optional<std::string> reason =
          reason_not_faceted(model, region, segments, window)) {
    return {std::nullopt, *reason};
  }
  const auto start = Clock::now();
  const FacetedRegion facets = faceted(model, region, box, segments, window);
  Enclosure bounds;
  for (const bool is_upper : {false, true}) {
    NefLimits left = limits;
    left.seconds -= std::chrono::duration<double>(Clock::now() - start).count();
    if (left.seconds <= 0) {
      return {std::nullopt, fmt::format("over the budget of {:.3g} s", limits.seconds)};
    }
    const NefOutcome outcome = run_nef(is_upper ? facets.upper : facets.lower, {}, left);
    if (!outcome.answered) return {std::nullopt, outcome.reason};
    const Enclosure volume = enclosure_of(volume_sum(outcome.result.complex));
    if (facets.is_exact) return {volume, ""};
    (is_upper ? bounds.upper : bounds.lower) = is_upper ? volume.upper : volume.lower;
  }
  return {std::move(bounds), ""};
}

Check compare_with_nef(std::string name, const Enclosure& ours, const NefVolume& theirs) {
  Check check;
  check.oracle = "nef";
  check.name = std::move(name);
  check.ours = text_of(ours);
  if (!theirs.bounds) {
    check.verdict = Verdict::Skipped;
    check.explanation = theirs.reason;
    return check;
  }
  const Rational gap = gap_between(ours, *theirs.bounds);
  const double width = nearest_double(Rational(theirs.bounds->upper - theirs.bounds->lower));
  check.theirs = text_of(*theirs.bounds);
  check.difference = fmt::format("{:.2g}", nearest_double(gap));
  check.bound = fmt::format("0 (bounds {:.2g} wide)", width);
  if (gap > 0) {
    check.verdict = Verdict::Failed;
    check.explanation =
        "the proved bounds have no number in common with the volumes of polyhedra within the cell "
        "and round it";
  }
  return check;
}

}  // namespace exactcsg::verify
