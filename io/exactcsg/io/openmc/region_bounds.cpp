// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/region_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/domain/vector.hpp"
#include "exactcsg/measure/local_region.hpp"

namespace exactcsg::io::openmc {

namespace {

using Bounds = std::array<Extent, 3>;
using csg::BooleanOperator;

// Of the values that are there, the greater; else the one that is.
std::optional<Rational> greater(const std::optional<Rational>& a,
                                const std::optional<Rational>& b) {
  if (!a || !b) return a ? a : b;
  return std::max(*a, *b);
}
std::optional<Rational> less(const std::optional<Rational>& a, const std::optional<Rational>& b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

RegionBounds common(const RegionBounds& a, const RegionBounds& b) {
  if (!a || !b) return std::nullopt;
  Bounds result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = {greater((*a)[i].lower, (*b)[i].lower), less((*a)[i].upper, (*b)[i].upper)};
    const auto& [lower, upper] = result[i];
    if (lower && upper && *lower >= *upper) return std::nullopt;
  }
  return result;
}

Bounds bounds_of(const Model& model, const SurfaceSide& side) {
  const Surface& surface = model.surfaces[side.surface];
  Bounds result;
  if (const auto plane = plane_side(surface, side.is_positive)) {
    const auto is_zero = [&](std::size_t i) { return plane->normal[i] == 0; };
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_zero(i) || !is_zero((i + 1) % 3) || !is_zero((i + 2) % 3)) continue;
      const Rational place = plane->offset / plane->normal[i];
      (plane->normal[i] > 0 ? result[i].upper : result[i].lower) = place;
    }
  } else if (!side.is_positive) {
    for (std::size_t i = 0; i < 3; ++i) result[i] = inside_extent(surface, i);
  }
  return result;
}

Rational determinant_of(const domain::Coordinates<3>& a, const domain::Coordinates<3>& b,
                        const domain::Coordinates<3>& c) {
  return domain::detail::scalar_product(a, domain::detail::vector_product(b, c));
}

// The least upper bound of direction x that the planes imply. By Farkas and Caratheodory: the
// direction is a sum of at most three normals with factors of at least 0, and the bound the same
// sum of offsets. Normals without an offset stand in where fewer than three are needed: their
// factor must be 0.
std::optional<Rational> upper_bound(const std::vector<PlaneSide>& planes,
                                    const domain::Coordinates<3>& direction) {
  std::vector<const PlaneSide*> all;
  for (const PlaneSide& plane : planes) all.push_back(&plane);
  std::array<PlaneSide, 3> stand_ins;
  for (std::size_t i = 0; i < 3; ++i) {
    if (direction[i] != 0) continue;
    stand_ins[i].normal[i] = 1;
    all.push_back(&stand_ins[i]);
  }
  std::optional<Rational> best;
  const auto is_plane = [&](std::size_t i) { return i < planes.size(); };
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      for (std::size_t k = j + 1; k < all.size(); ++k) {
        const auto& a = all[i]->normal;
        const auto& b = all[j]->normal;
        const auto& c = all[k]->normal;
        const Rational whole = determinant_of(a, b, c);
        if (whole == 0) continue;
        const Rational first = determinant_of(direction, b, c) / whole;
        const Rational second = determinant_of(a, direction, c) / whole;
        const Rational third = determinant_of(a, b, direction) / whole;
        if (first < 0 || second < 0 || third < 0) continue;
        if ((!is_plane(j) && second != 0) || (!is_plane(k) && third != 0)) continue;
        best = less(best, Rational(first * all[i]->offset + second * all[j]->offset +
                                   third * all[k]->offset));
      }
    }
  }
  return best;
}

bool is_slanted(const PlaneSide& plane) {
  return std::count(plane.normal.begin(), plane.normal.end(), Rational(0)) < 2;
}

// Of an intersection of which some operands are planes: what these and the bounds known so far
// imply together.
RegionBounds tightened(const Model& model, const Region& region, RegionBounds bounds) {
  constexpr std::size_t most_planes = 30;
  if (!bounds || !region.is_compose() || region.operation() != BooleanOperator::Intersection) {
    return bounds;
  }
  std::vector<PlaneSide> planes;
  for (const Region& operand : region.children()) {
    if (!operand.is_primitive()) continue;
    const SurfaceSide& side = operand.primitive();
    auto plane = plane_side(model.surfaces[side.surface], side.is_positive);
    if (plane && is_slanted(*plane)) planes.push_back(std::move(*plane));
  }
  if (planes.empty() || planes.size() > most_planes) return bounds;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto add = [&](const std::optional<Rational>& place, int sign) {
      if (!place) return;
      PlaneSide plane;
      plane.normal[i] = sign;
      plane.offset = sign * *place;
      planes.push_back(std::move(plane));
    };
    add((*bounds)[i].upper, 1);
    add((*bounds)[i].lower, -1);
  }
  Bounds implied;
  for (std::size_t i = 0; i < 3; ++i) {
    domain::Coordinates<3> direction;
    direction[i] = 1;
    implied[i].upper = upper_bound(planes, direction);
    direction[i] = -1;
    if (const auto below = upper_bound(planes, direction)) implied[i].lower = Rational(-*below);
  }
  return common(bounds, implied);
}

// REQUIRES not the root of a union.
RegionBounds bounds_of_term(const Model& model, const Region& region) {
  RegionBounds bounds = csg::traverse(
      region, [&](const SurfaceSide& side) { return RegionBounds(bounds_of(model, side)); },
      [](const RegionBounds& a, BooleanOperator operation, const RegionBounds& b) {
        if (operation == BooleanOperator::Intersection) return common(a, b);
        return operation == BooleanOperator::Difference ? a : hull(a, b);
      },
      csg::FullEmptyResult{RegionBounds(Bounds{}), RegionBounds()});
  return tightened(model, region, std::move(bounds));
}

[[noreturn]] void throw_no_boundary(std::string found) {
  throw Error(ErrorId::UnboundedSolid, {std::move(found), "a box, with --box"});
}

// No surface varies along the axis, no fill is turned, and no lattice divides it.
bool is_the_same_along(const Model& model, std::size_t axis) {
  const domain::Box<3> unit(Point(-1, -1, -1), Point(1, 1, 1));
  for (const Surface& surface : model.surfaces) {
    if (measure::detail::variations(surface.negative, unit)[axis] != 0) return false;
  }
  for (const Cell& cell : model.cells) {
    for (std::size_t i = 0; i < 3 && cell.to_fill; ++i) {
      if (i != axis && (cell.to_fill->m[i][axis] != 0 || cell.to_fill->m[axis][i] != 0)) {
        return false;
      }
    }
  }
  return std::none_of(model.lattices.begin(), model.lattices.end(),
                      [&](const Lattice& lattice) { return axis != 2 || lattice.has_layers; });
}

}  // namespace

RegionBounds hull(const RegionBounds& a, const RegionBounds& b) {
  if (!a || !b) return a ? a : b;
  Bounds result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Extent& first = (*a)[i];
    const Extent& second = (*b)[i];
    if (first.lower && second.lower) result[i].lower = std::min(*first.lower, *second.lower);
    if (first.upper && second.upper) result[i].upper = std::max(*first.upper, *second.upper);
  }
  return result;
}

RegionBounds bounds_of(const Model& model, const Region& region) {
  if (!region.is_compose() || region.operation() != BooleanOperator::Union) {
    return bounds_of_term(model, region);
  }
  RegionBounds bounds;
  for (const Region& term : region.children()) bounds = hull(bounds, bounds_of_term(model, term));
  return bounds;
}

std::optional<domain::Box<3>> cut(const domain::Box<3>& box, const RegionBounds& bounds) {
  if (!bounds) return std::nullopt;
  domain::Coordinates<3> lower = box.lower().coordinates();
  domain::Coordinates<3> upper = box.upper().coordinates();
  for (std::size_t i = 0; i < 3; ++i) {
    lower[i] = *greater(lower[i], (*bounds)[i].lower);
    upper[i] = *less(upper[i], (*bounds)[i].upper);
    if (lower[i] >= upper[i]) return std::nullopt;
  }
  return domain::Box<3>(lower, upper);
}

domain::Box<3> box_of_root(const Model& model) {
  RegionBounds bounds;
  std::array<Extent, 3> of_surfaces;
  bool has_boundary = false;
  for (const Index cell : model.universes[model.root].cells) {
    const Region& region = model.cells[cell].region;
    bounds = hull(bounds, bounds_of(model, region));
    csg::for_each_primitive(region, [&](const SurfaceSide& side) {
      has_boundary =
          has_boundary || model.surfaces[side.surface].boundary != Boundary::Transmission;
      const Bounds inside = bounds_of(model, SurfaceSide{side.surface, false});
      for (std::size_t i = 0; i < 3; ++i) {
        for (const auto& place : {inside[i].lower, inside[i].upper}) {
          of_surfaces[i].lower = less(of_surfaces[i].lower, place);
          of_surfaces[i].upper = greater(of_surfaces[i].upper, place);
        }
      }
    });
  }
  if (!has_boundary && !model.fills_space)
    throw_no_boundary("no surface of the root's cells has a boundary condition");
  if (!bounds) bounds.emplace();
  domain::Coordinates<3> lower;
  domain::Coordinates<3> upper;
  for (std::size_t i = 0; i < 3; ++i) {
    std::optional<Rational>& low = (*bounds)[i].lower;
    std::optional<Rational>& high = (*bounds)[i].upper;
    if (!low) low = of_surfaces[i].lower;
    if (!high) high = of_surfaces[i].upper;
    if (!low && !high && is_the_same_along(model, i)) {
      low = Rational(-1);
      high = Rational(1);
    }
    if (!low || !high || *low >= *high) {
      throw_no_boundary(fmt::format("the root has no bounds along {}", "xyz"[i]));
    }
    const Rational margin = (*high - *low) / 32;
    lower[i] = *low - margin;
    upper[i] = *high + margin;
  }
  return {lower, upper};
}

}  // namespace exactcsg::io::openmc
