// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/solid/solid.hpp"

#include <gtest/gtest.h>

#include "exactcsg/support/error.hpp"

namespace exactcsg {
namespace {

AffineMap shift_x(const Rational& by) {
  AffineMap map = AffineMap::identity();
  map.m[0][3] = by;
  return map;
}

const StoredPolyhedron& polyhedron(const Solid& s) {
  return *std::get<ConvexPolytope>(s.primitive().shape).polyhedron;
}

TEST(ApplyToSolid, MapsEveryPrimitive) {
  const Solid box = Solid::primitive({make_box({0, 0, 0}, {1, 1, 1})});
  const Solid image = apply(shift_x(5), csg::subtract(box, Solid::full()));
  ASSERT_TRUE(image.is_compose());
  EXPECT_EQ(polyhedron(image.children()[0]).vertices[0], (Point3{5, 0, 0}));
  EXPECT_TRUE(image.children()[1].is_full());
  EXPECT_TRUE(same_handle(apply(AffineMap::identity(), box), box));
}

TEST(ApplyToSolid, MapsASharedPolyhedronOnce) {
  const Primitive box{make_box({0, 0, 0}, {1, 1, 1}), "first"};
  Primitive same = box;
  same.origin = "second";
  const Solid one = Solid::primitive(box);
  const Solid two = Solid::primitive(same);
  const Solid image =
      apply(shift_x(1), Solid::compose(csg::BooleanOperator::Union, {one, two, one}));
  const auto children = image.children();
  EXPECT_TRUE(same_handle(children[0], children[2]));
  EXPECT_EQ(&polyhedron(children[0]), &polyhedron(children[1]));
  EXPECT_EQ(children[1].primitive().origin, "second");
}

TEST(ApplyToSolid, AMillionDeepChain) {
  const Solid box = Solid::primitive({make_box({0, 0, 0}, {1, 1, 1})});
  Solid chain = box;
  for (int i = 0; i < 1000000; ++i) chain = csg::unite(std::move(chain), box);
  const Solid image = apply(shift_x(1), chain);
  EXPECT_EQ(image.primitive_count(), 1000001U);
}

TEST(ApplyToSolid, RefusesSingularMaps) {
  AffineMap flat = AffineMap::identity();
  flat.m[2][2] = 0;
  try {
    apply(flat, Solid::empty());
    FAIL() << "nothing was thrown";
  } catch (const Error& e) {
    EXPECT_EQ(e.id(), ErrorId::SingularMap);
  }
}

}  // namespace
}  // namespace exactcsg
