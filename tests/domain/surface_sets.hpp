// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Sets of half-spaces of planes, quadrics and tori, for tests of neighbourhoods.

#include <utility>

#include "exactcsg/domain/classify.hpp"
#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::domain::test {

using Set = csg::BooleanTree<SurfaceHalfSpace>;

inline Set set(SurfaceHalfSpace half_space) { return Set::primitive(std::move(half_space)); }
// {normal x <= bound}
inline Set below(const Coordinates<3>& normal, const Rational& bound = 0) {
  return set(make_plane(normal, Rational(-bound)));
}

// Whether the neighbourhood of the point is one that is not decided.
inline bool is_refused(const Set& tree, const Point<3>& point) {
  try {
    classify(tree, point);
    return false;
  } catch (const Error& error) {
    return error.id() == ErrorId::UndecidedNeighbourhood;
  }
}

}  // namespace exactcsg::domain::test
