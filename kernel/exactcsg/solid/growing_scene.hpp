// SPDX-License-Identifier: Apache-2.0
#pragma once

// A scene to which primitives are added. Internal to the incremental evaluation. [Exact]
//
// LAW growing.1  primitives, facets, points and planes keep their numbers when primitives are
// added, and with them tasks and pieces of boundary stay what they were, unless add says otherwise.

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "exactcsg/solid/box_pairs.hpp"
#include "exactcsg/solid/cell_solver.hpp"

namespace exactcsg {

// A scene whose tree is of no account, and what works in it.
struct WorkingScene {
  WorkingScene(Scene of, const EvaluateOptions& options);

  Scene scene;
  CellSolver solver;
  std::vector<DoubleBox> boxes;  // of each primitive, certified; infinite for half-spaces
  bool has_half_spaces = false;
};

// Copies share the scene.
class GrowingScene {
 public:
  explicit GrowingScene(const EvaluateOptions& options);

  const WorkingScene& now() const { return *scene_; }
  std::size_t size() const { return primitives_.size(); }
  std::optional<PrimitiveIndex> find(const Primitive& primitive) const;

  // Adds those that are not there yet. False: no longer are numbers what they were, or some
  // primitive reaches out of the root cell; restart() before going on.
  // THROWS Error(NumberOutOfRange) and then adds nothing. COST: O(1) a primitive that is there;
  // one new one, O(facets of all)
  bool add(std::span<const Primitive> primitives);
  // These alone, in a root cell with room to grow.
  void restart(std::span<const Primitive> primitives);

 private:
  struct PlaneLess {
    bool operator()(const Plane& p, const Plane& q) const;
  };
  struct Numbers {
    std::unordered_map<const StoredPolyhedron*, PrimitiveIndex> polyhedra;
    std::map<Plane, PrimitiveIndex, PlaneLess> half_spaces;
  };

  bool is_known(const Primitive& primitive) const { return find(primitive).has_value(); }
  void number(const Primitive& primitive, PrimitiveIndex index);
  std::shared_ptr<const WorkingScene> scene_of(const std::vector<Primitive>& primitives) const;
  bool fits(Scene& larger) const;

  EvaluateOptions options_;
  std::vector<Primitive> primitives_;
  Numbers numbers_;
  std::shared_ptr<const WorkingScene> scene_;
};

}  // namespace exactcsg
