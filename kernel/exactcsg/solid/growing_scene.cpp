// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/growing_scene.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <tuple>

namespace exactcsg {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Scene make_scene_of(const std::vector<Primitive>& primitives) {
  std::vector<Solid> leaves;
  leaves.reserve(primitives.size());
  for (const Primitive& primitive : primitives) leaves.push_back(Solid::primitive(primitive));
  Scene scene =
      make_scene(leaves.empty() ? Solid::empty()
                                : Solid::compose(csg::BooleanOperator::Union, std::move(leaves)));
  if (scene.primitives.size() != primitives.size()) {
    throw Error(ErrorId::InternalError, {"a scene with other primitives than were given", ""});
  }
  return scene;
}

bool contains(const Cell& outer, const Cell& inner) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (inner.lower[axis] < outer.lower[axis] || inner.upper[axis] > outer.upper[axis]) {
      return false;
    }
  }
  return true;
}

Cell widened(const Cell& cell) {
  Cell result = cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double margin = (cell.upper[axis] - cell.lower[axis]) / 2;
    result.lower[axis] = round_wall_position(cell.lower[axis] - margin);
    result.upper[axis] = round_wall_position(cell.upper[axis] + margin);
  }
  return result;
}

bool has_half_spaces(const Scene& scene) {
  return std::any_of(scene.primitives.begin(), scene.primitives.end(),
                     [](const ScenePrimitive& primitive) { return primitive.facet_count == 1; });
}

std::vector<DoubleBox> boxes_of(const Scene& scene) {
  constexpr DoubleBox everything{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  std::vector<DoubleBox> boxes(scene.primitives.size(), everything);
  for (PrimitiveIndex p = 0; p < boxes.size(); ++p) {
    if (scene.primitives[p].facet_count == 1) continue;  // a half-space
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes[p].lower[axis] = scene.bounds.primitives[axis][p].lower;
      boxes[p].upper[axis] = scene.bounds.primitives[axis][p].upper;
    }
  }
  return boxes;
}

bool same_facet(const SceneFacet& a, const SceneFacet& b) {
  return a.primitive == b.primitive && a.is_half_space == b.is_half_space && a.plane == b.plane &&
         a.first_corner == b.first_corner && a.corner_count == b.corner_count;
}

// REQUIRES corners of half-spaces
bool same_corner(const Corner& a, const Corner& b) {
  return a.side_plane == b.side_plane &&
         std::equal(std::begin(a.vertex.planes), std::end(a.vertex.planes),
                    std::begin(b.vertex.planes));
}

}  // namespace

WorkingScene::WorkingScene(Scene of, const EvaluateOptions& options)
    : scene(std::move(of)),
      solver(scene, options, CellUse::Changing),
      boxes(boxes_of(scene)),
      has_half_spaces(exactcsg::has_half_spaces(scene)) {}

bool GrowingScene::PlaneLess::operator()(const Plane& p, const Plane& q) const {
  return std::tie(p.a, p.b, p.c, p.d) < std::tie(q.a, q.b, q.c, q.d);
}

GrowingScene::GrowingScene(const EvaluateOptions& options)
    : options_(options), scene_(scene_of({})) {}

std::shared_ptr<const WorkingScene> GrowingScene::scene_of(
    const std::vector<Primitive>& primitives) const {
  return std::make_shared<const WorkingScene>(make_scene_of(primitives), options_);
}

std::optional<PrimitiveIndex> GrowingScene::find(const Primitive& primitive) const {
  const auto found_in = [](const auto& table, const auto& key) -> std::optional<PrimitiveIndex> {
    const auto found = table.find(key);
    if (found == table.end()) return std::nullopt;
    return found->second;
  };
  if (const StoredPolyhedron* polyhedron = polyhedron_of(primitive)) {
    return found_in(numbers_.polyhedra, polyhedron);
  }
  return found_in(numbers_.half_spaces, std::get<HalfSpace>(primitive.shape).plane);
}

void GrowingScene::number(const Primitive& primitive, PrimitiveIndex index) {
  if (const StoredPolyhedron* polyhedron = polyhedron_of(primitive)) {
    numbers_.polyhedra.emplace(polyhedron, index);
  } else {
    numbers_.half_spaces.emplace(std::get<HalfSpace>(primitive.shape).plane, index);
  }
}

// Whether what was made in the present scene is right in the larger one.
bool GrowingScene::fits(Scene& larger) const {
  const Scene& present = scene_->scene;
  if (present.primitives.empty()) return false;
  if (has_half_spaces(larger)) {
    // Their facets end at the walls of the root.
    if (larger.root.lower != present.root.lower || larger.root.upper != present.root.upper) {
      return false;
    }
  } else {
    if (!contains(present.root, larger.root)) return false;
    larger.root = present.root;
  }
  const auto begins_with = [](const auto& longer, const auto& shorter, const auto& same) {
    return std::equal(shorter.begin(), shorter.end(), longer.begin(),
                      longer.begin() + static_cast<std::ptrdiff_t>(shorter.size()), same);
  };
  return begins_with(larger.facets, present.facets, same_facet) &&
         begins_with(larger.corners, present.corners, std::equal_to<>()) &&
         begins_with(larger.half_space_corners, present.half_space_corners, same_corner);
}

bool GrowingScene::add(std::span<const Primitive> primitives) {
  if (std::all_of(primitives.begin(), primitives.end(),
                  [this](const Primitive& primitive) { return is_known(primitive); })) {
    return true;
  }
  GrowingScene larger = *this;
  for (const Primitive& primitive : primitives) {
    if (larger.is_known(primitive)) continue;
    larger.number(primitive, static_cast<PrimitiveIndex>(larger.primitives_.size()));
    larger.primitives_.push_back(primitive);
  }
  Scene scene = make_scene_of(larger.primitives_);
  const bool fitting = fits(scene);
  larger.scene_ = std::make_shared<const WorkingScene>(std::move(scene), options_);
  *this = std::move(larger);
  return fitting;
}

void GrowingScene::restart(std::span<const Primitive> primitives) {
  const Cell before = scene_->scene.root;
  primitives_.clear();
  numbers_ = {};
  for (const Primitive& primitive : primitives) {
    if (is_known(primitive)) continue;
    number(primitive, static_cast<PrimitiveIndex>(primitives_.size()));
    primitives_.push_back(primitive);
  }
  Scene scene = make_scene_of(primitives_);
  if (!has_half_spaces(scene)) {
    scene.root = contains(before, scene.root) ? before : widened(scene.root);
  }
  scene_ = std::make_shared<const WorkingScene>(std::move(scene), options_);
}

}  // namespace exactcsg
