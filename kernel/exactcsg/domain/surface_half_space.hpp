// SPDX-License-Identifier: Apache-2.0
#pragma once

// A half-space of a quadric or of a torus: one primitive for trees of both. [Exact]
//
// LAW surface_half_space.1  it answers what the half-space answers that it holds.

#include <utility>
#include <variant>

#include "exactcsg/domain/torus.hpp"

namespace exactcsg::domain {

class SurfaceHalfSpace {
 public:
  static constexpr std::size_t dimension = 3;

  SurfaceHalfSpace(HalfSpace<3> half_space) : kind_(std::move(half_space)) {}
  SurfaceHalfSpace(Torus torus) : kind_(std::move(torus)) {}

  // nullptr if it is the other.
  const HalfSpace<3>* quadric() const noexcept { return std::get_if<HalfSpace<3>>(&kind_); }
  const Torus* torus() const noexcept { return std::get_if<Torus>(&kind_); }

  template <class Visitor>
  decltype(auto) visit(Visitor&& visitor) const {
    return std::visit(std::forward<Visitor>(visitor), kind_);
  }

  friend SurfaceHalfSpace complement(const SurfaceHalfSpace& half_space) {
    return half_space.visit([](const auto& kind) { return SurfaceHalfSpace(complement(kind)); });
  }
  // As written, not as a point set.
  friend bool operator==(const SurfaceHalfSpace&, const SurfaceHalfSpace&) = default;

 private:
  std::variant<HalfSpace<3>, Torus> kind_;
};

inline PointClass classify(const SurfaceHalfSpace& half_space, const Point<3>& point,
                           TierStatistics* statistics = nullptr) {
  return half_space.visit([&](const auto& kind) { return classify(kind, point, statistics); });
}
inline csg::Membership classify(const SurfaceHalfSpace& half_space, const Box<3>& box) {
  return half_space.visit([&](const auto& kind) { return classify(kind, box); });
}
inline Section section(const SurfaceHalfSpace& half_space, const LineSection<3>& line) {
  return half_space.visit([&](const auto& kind) { return section(kind, line); });
}
// THROWS Error(SingularMap)
inline SurfaceHalfSpace apply(const AffineMap& map, const SurfaceHalfSpace& half_space) {
  return half_space.visit([&](const auto& kind) { return SurfaceHalfSpace(apply(map, kind)); });
}

static_assert(Domain<SurfaceHalfSpace>);

}  // namespace exactcsg::domain
