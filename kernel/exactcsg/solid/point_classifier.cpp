// SPDX-License-Identifier: Apache-2.0
// Classification of many points: the decomposition of the evaluator, retained as a gdt::Tree.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/decomposition.hpp"
#include "exactcsg/solid/local_form.hpp"
#include "exactcsg/solid/neighbourhood.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

// A cell that is not divided: the tree pruned to it over the local forms of its primitives.
struct RetainedCell {
  struct Root {
    PrimitiveIndex primitive;
    LocalPlace place;
  };
  PrunedTree tree;
  std::vector<Root> roots;  // ascending by primitive
  std::vector<LocalNode> nodes;

  LocalPlace root_of(PrimitiveIndex primitive) const {
    return std::lower_bound(roots.begin(), roots.end(), primitive,
                            [](const Root& root, PrimitiveIndex p) { return root.primitive < p; })
        ->place;
  }
};

using RetainedTree = gdt::Tree<RetainedCell, Division>;

struct RetainedTask {
  CellTask cell;
  std::optional<Division> division;
};

RetainedCell retain(const Scene& scene, const Decomposition& decomposition, CellTask& task) {
  RetainedCell cell;
  cell.tree = std::move(task.tree);
  std::vector<CellFacet> facets;
  decomposition.collect_facets(task, facets);
  TierStatistics statistics;
  for (std::size_t begin = 0; begin < facets.size();) {
    std::vector<FacetPolygon> polygons;
    std::size_t end = begin;
    for (; end < facets.size() && facets[end].primitive == facets[begin].primitive; ++end) {
      polygons.push_back(facets[end].polygon);
    }
    const PrimitiveIndex primitive = facets[begin].primitive;
    cell.roots.push_back(
        {primitive, scene.primitives[primitive].convex
                        ? append_convex_form(polygons, cell.nodes)
                        : append_mesh_form(scene.geometry, polygons, cell.nodes, statistics)});
    begin = end;
  }
  std::sort(cell.roots.begin(), cell.roots.end(),
            [](const auto& a, const auto& b) { return a.primitive < b.primitive; });
  return cell;
}

RetainedTree build(const Scene& scene, const EvaluateOptions& options) {
  const Decomposition decomposition(scene, options.facets_per_cell, options.progress);
  const auto prepared = [&](CellTask cell) {
    RetainedTask task{std::move(cell), std::nullopt};
    if (!decomposition.is_leaf(task.cell)) task.division = decomposition.choose_division(task.cell);
    return task;
  };
  const auto with = [&](const auto& executor) {
    return gdt::create(
        prepared(decomposition.root()), [](const RetainedTask& task) { return !task.division; },
        [&](RetainedTask& task) {
          std::vector<RetainedTask> children;
          for (CellTask& child : decomposition.divide(task.cell, *task.division)) {
            children.push_back(prepared(std::move(child)));
          }
          return children;
        },
        [&](RetainedTask&& task) { return retain(scene, decomposition, task.cell); },
        gdt::unlimited_depth, executor, [](RetainedTask&& task) { return *task.division; });
  };
  if (options.threads == 1) return with(skeleton::SequentialExecutor{});
  return with(skeleton::ParallelExecutor<>(options.threads));
}

// The point, exact and as certified doubles.
struct Query {
  explicit Query(const Point3& p) : exact(p), near{p.x.get_d(), p.y.get_d(), p.z.get_d()} {}

  const Rational& coordinate(Axis axis) const {
    return axis == Axis::X ? exact.x : axis == Axis::Y ? exact.y : exact.z;
  }
  // mpq_get_d truncates: off by less than a unit in the last place.
  double error(std::size_t axis) const { return 0x1p-52 * std::abs(near[axis]) + 0x1p-1000; }

  const Point3& exact;
  std::array<double, 3> near;
};

Sign compare_to_wall(const Query& query, const Division& division) {
  const double near = query.near[static_cast<std::size_t>(division.axis)];
  const double error = query.error(static_cast<std::size_t>(division.axis));
  if (near - error > division.position) return Sign::Positive;
  if (near + error < division.position) return Sign::Negative;
  return sign_of(cmp(query.coordinate(division.axis), rational_of(division.position)));
}

Sign side_of(const Geometry& geometry, PlaneRef plane, const Query& query) {
  const Geometry::ApproximatePlane near = geometry.approximate(plane);
  const auto [x, y, z] = query.near;
  const double value = near.a * x + near.b * y + near.c * z + near.d;
  // Coefficients are at most 1 in magnitude. Operands are off by the plane's errors and by
  // query.error; four products and three sums round by at most 7u of the sum of magnitudes.
  const double magnitude = std::abs(x) + std::abs(y) + std::abs(z);
  const double bound = near.normal_error * magnitude * (1 + 0x1p-40) + near.offset_error +
                       query.error(0) + query.error(1) + query.error(2) +
                       0x1p-49 * (magnitude + std::abs(near.d)) + 0x1p-1000;
  if (value > bound) return Sign::Positive;
  if (value < -bound) return Sign::Negative;
  return side(geometry.exact_plane_value(plane), query.exact);
}

// In or Out by walking the local form, Unknown as soon as a plane through the point matters.
template <class SideOf>
Membership walk(const RetainedCell& cell, LocalPlace place, SideOf side_of) {
  while (!place.is_decided()) {
    const LocalNode& node = cell.nodes[place.node()];
    switch (side_of(node.plane)) {
      case Sign::Zero:
        return Membership::Unknown;
      case Sign::Positive:
        place = node.positive;
        break;
      case Sign::Negative:
        place = node.negative;
        break;
    }
  }
  return place.membership();
}

template <class SideOf>
Membership membership(const RetainedCell& cell, SideOf side_of) {
  return csg::membership_of(cell.tree, [&](PrimitiveIndex primitive) {
    return walk(cell, cell.root_of(primitive), side_of);
  });
}

PointClass classify_in(const Geometry& geometry, const RetainedCell& cell, const Query& query) {
  const Membership around =
      membership(cell, [&](PlaneRef plane) { return side_of(geometry, plane, query); });
  if (around == Membership::In) return PointClass::In;
  if (around == Membership::Out) return PointClass::Out;
  std::vector<PlaneRef> through;
  for (const LocalNode& node : cell.nodes) {
    if (side_of(geometry, node.plane, query) == Sign::Zero) through.push_back(node.plane);
  }
  std::sort(through.begin(), through.end());
  through.erase(std::unique(through.begin(), through.end()), through.end());
  std::vector<Plane> planes;
  planes.reserve(through.size());
  for (const PlaneRef plane : through) planes.push_back(geometry.exact_plane_value(plane));
  return classify_neighbourhood(planes, [&](std::span<const Sign> sides) {
    return membership(cell, [&](PlaneRef plane) {
      const auto place = std::lower_bound(through.begin(), through.end(), plane);
      if (place != through.end() && *place == plane) {
        return sides[static_cast<std::size_t>(place - through.begin())];
      }
      return side_of(geometry, plane, query);
    });
  });
}

}  // namespace

struct PointClassifier::Data {
  Solid solid;
  Scene scene;
  RetainedTree cells;
};

PointClassifier::PointClassifier(const Solid& solid, const EvaluateOptions& options) {
  Scene scene = make_scene(solid);
  RetainedTree cells = build(scene, options);
  data_ = std::make_unique<const Data>(Data{solid, std::move(scene), std::move(cells)});
}

PointClassifier::~PointClassifier() = default;
PointClassifier::PointClassifier(PointClassifier&&) noexcept = default;
PointClassifier& PointClassifier::operator=(PointClassifier&&) noexcept = default;

PointClass PointClassifier::operator()(const Point3& point) const {
  const Query query(point);
  const Cell& root = data_->scene.root;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Axis>(axis);
    // Outside the root cell, or in a wall between cells, no single cell knows all around the point.
    if (compare_to_wall(query, {a, root.lower[axis]}) != Sign::Positive ||
        compare_to_wall(query, {a, root.upper[axis]}) != Sign::Negative) {
      return classify(data_->solid, point);
    }
  }
  auto node = data_->cells.root();
  while (!node.is_terminal()) {
    const Sign side = compare_to_wall(query, node.label());
    if (side == Sign::Zero) return classify(data_->solid, point);
    node = node.child(side == Sign::Negative ? 0 : 1);
  }
  return classify_in(data_->scene.geometry, node.terminal(), query);
}

}  // namespace exactcsg
