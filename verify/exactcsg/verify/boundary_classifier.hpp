// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Point membership by a boundary alone: on a face, or by the parity of an exact ray. [Exact]
//
// COST: O(faces) comparisons of doubles a point, and exact arithmetic for the few faces whose
// shadow along the ray has the point. A ray that meets an edge or a vertex is given up for another
// direction.

#include <memory>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/classify.hpp"

namespace exactcsg::verify {

class BoundaryClassifier {
 public:
  explicit BoundaryClassifier(const Boundary& boundary);  // kept by reference
  ~BoundaryClassifier();
  BoundaryClassifier(BoundaryClassifier&&) noexcept;
  BoundaryClassifier& operator=(BoundaryClassifier&&) noexcept;

  PointClass operator()(const Point3& point) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace exactcsg::verify
