// SPDX-License-Identifier: Apache-2.0
#pragma once

// Point membership classification with exact neighbourhoods. [Exact]
//
// In: a ball round the point lies in the solid. Out: a ball round it lies in the complement.
// On: neither. Where several surfaces pass through the point, the cells that their planes cut from
// a small sphere are enumerated, each with an exact witness direction (Tilove; Requicha): pairwise
// On/On tables are wrong.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/domain/point_class.hpp"
#include "exactcsg/solid/evaluate.hpp"

namespace exactcsg {

// One point, without building anything: a traversal of the tree.
// COST: O(facets) filtered signs; neighbourhoods only of the primitives whose boundary has the
// point.
PointClass classify(const Solid& solid, const Point3& point);

// For many points: a retained decomposition (a gdt::Tree whose leaves hold the pruned tree and the
// facets of their cell). Safe to query from many threads.
class PointClassifier {
 public:
  explicit PointClassifier(const Solid& solid, const EvaluateOptions& options = {});
  ~PointClassifier();
  PointClassifier(PointClassifier&&) noexcept;
  PointClassifier& operator=(PointClassifier&&) noexcept;

  // LAW classify.1  equals classify(solid, point). COST: expected O(log facets).
  PointClass operator()(const Point3& point) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

// A point in exactly one of the two solids (In one and Out of the other), or nullopt if they are
// the same point set. Decides by canonical boundaries: LAW equal.1  nullopt iff the digests agree.
struct Difference {
  Point3 witness;
  bool in_first = false;
};
std::optional<Difference> find_difference(const Solid& first, const Solid& second,
                                          const EvaluateOptions& options = {});

// A point of the solid's interior; nullopt if it is empty.
std::optional<Point3> interior_point(const Solid& solid, const EvaluateOptions& options = {});
// The same, where the boundary is known. REQUIRES it is the solid's.
std::optional<Point3> interior_point(const Solid& solid, const Boundary& boundary);

}  // namespace exactcsg
