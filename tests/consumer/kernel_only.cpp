// SPDX-License-Identifier: GPL-3.0-or-later
// The volume of a unit cube without the corner that the plane x + y + z = 1/2 cuts off: the corner
// is a tetrahedron with three edges of 1/2 at a right angle, (1/2)^3 / 6 = 1/48, so 47/48 remain.

#include <cstdio>

#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"

int main() {
  using namespace exactcsg;
  try {
    const Solid cube = Solid::primitive({make_box({0, 0, 0}, {1, 1, 1})});
    const Solid corner = Solid::primitive({make_half_space(1, 1, 1, Rational(-1, 2))});
    const Solid solid = csg::subtract(cube, corner);

    const auto volume = exact_volume(evaluate(solid));
    const bool on_cut =
        classify(solid, {Rational(1, 6), Rational(1, 6), Rational(1, 6)}) == PointClass::On;
    std::printf("volume %s\n", volume ? to_text(*volume).c_str() : "?");
    return volume == Rational(47, 48) && on_cut ? 0 : 1;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
