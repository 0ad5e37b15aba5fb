// SPDX-License-Identifier: Apache-2.0
#pragma once

// What a point can be of a regular closed set. [Exact]

#include "exactcsg/csg/boolean_operator.hpp"

namespace exactcsg {

// In: a ball round the point lies in the set. Out: a ball round it lies in the complement. On:
// neither.
enum class PointClass : unsigned char { Out, On, In };

constexpr PointClass complement(PointClass value) {
  switch (value) {
    case PointClass::Out:
      return PointClass::In;
    case PointClass::In:
      return PointClass::Out;
    case PointClass::On:
      break;
  }
  return PointClass::On;
}

// As far as the point alone tells of the points round it: On is Unknown.
constexpr csg::Membership membership(PointClass value) {
  switch (value) {
    case PointClass::Out:
      return csg::Membership::Out;
    case PointClass::In:
      return csg::Membership::In;
    case PointClass::On:
      break;
  }
  return csg::Membership::Unknown;
}

}  // namespace exactcsg
