// SPDX-License-Identifier: Apache-2.0
#pragma once

// Half-spaces bounded by a plane. [Exact]

#include "exactcsg/domain/half_space.hpp"

namespace exactcsg::domain {

// {p : normal . p + constant <= 0}. THROWS Error(DegenerateHalfSpace) if the normal is 0.
inline HalfSpace<3> make_plane(const Coordinates<3>& normal, const Rational& constant) {
  LinearForm<3> form{normal, constant};
  if (form.is_constant()) {
    throw Error(ErrorId::DegenerateHalfSpace, {"the plane's normal (0, 0, 0)", ""});
  }
  return HalfSpace<3>(Quadric<3>(std::move(form)));
}

}  // namespace exactcsg::domain
