// SPDX-License-Identifier: Apache-2.0
#pragma once

// Whether three half-spaces exclude each other of which two are bounded by planes, where no two of
// them do. [Exact]
//
// Planes p, q, r through one line, or parallel to one: their normals have a sum of 0 with positive
// factors; if the same sum of p, q and r is nowhere negative, not all of them are.
// Planes p, q and a quadric f: where p < 0 and q < 0, -p q < 0; if f - mu p q is nowhere negative
// in the box for some mu > 0, f is not below 0 there. That shows a plane that touches one nappe of
// a cone at its apex: p cuts off the other nappe.

#include <array>
#include <optional>
#include <utility>

#include "exactcsg/domain/surface_half_space.hpp"
#include "exactcsg/domain/vector.hpp"
#include "exactcsg/measure/local_region.hpp"
#include "exactcsg/measure/nonnegative_sum.hpp"

namespace exactcsg::measure::detail {

// Negative inside. nullopt of a torus, or of one nappe.
inline std::optional<domain::Quadric<3>> inside_polynomial(
    const domain::SurfaceHalfSpace& half_space) {
  const domain::HalfSpace<3>* quadric = half_space.quadric();
  if (quadric == nullptr || quadric->nappe()) return std::nullopt;
  return Rational(quadric->is_complement() ? -1 : 1) * quadric->polynomial();
}

inline bool exclude_each_other(const domain::LinearForm<3>& p, const domain::LinearForm<3>& q,
                               const domain::LinearForm<3>& r) {
  using domain::detail::scalar_product;
  using domain::detail::vector_product;
  const domain::Coordinates<3> of_p = vector_product(q.normal, r.normal);
  if (scalar_product(p.normal, of_p) != 0) return false;
  // All three products are multiples of one direction.
  const domain::Coordinates<3> of_q = vector_product(r.normal, p.normal);
  const domain::Coordinates<3> of_r = vector_product(p.normal, q.normal);
  for (std::size_t i = 0; i < 3; ++i) {
    if (of_p[i] == 0) continue;
    const Rational second = of_q[i] / of_p[i];
    const Rational third = of_r[i] / of_p[i];
    return second > 0 && third > 0 && p.constant + second * q.constant + third * r.constant >= 0;
  }
  return false;
}

inline bool exclude_each_other(const domain::SurfaceHalfSpace& a, const domain::SurfaceHalfSpace& b,
                               const domain::SurfaceHalfSpace& c, const Box3& box) {
  std::array<std::optional<domain::Quadric<3>>, 3> f{inside_polynomial(a), inside_polynomial(b),
                                                     inside_polynomial(c)};
  if (!f[0] || !f[1] || !f[2]) return false;
  // The one that is not linear last.
  for (std::size_t i = 0; i < 2; ++i) {
    if (!f[i]->is_linear()) std::swap(f[i], f[2]);
  }
  if (!f[0]->is_linear() || !f[1]->is_linear()) return false;
  const domain::LinearForm<3>& p = f[0]->linear();
  const domain::LinearForm<3>& q = f[1]->linear();
  if (f[2]->is_linear()) return exclude_each_other(p, q, f[2]->linear());
  const domain::Quadric<3> g = Rational(-1) * domain::product(p, q);
  const auto approximate = [&](const domain::Quadric<3>& polynomial) {
    return ApproximateQuadric(UnitSurface(unit_quadric(polynomial, box)), false);
  };
  return have_nonnegative_sum(*f[2], g, {approximate(*f[2]), approximate(g)}, box);
}

}  // namespace exactcsg::measure::detail
