// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/nearest_crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "exactcsg/number/orientation.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

DoubleBox box_around(const std::array<double, 3>& position, double error) {
  DoubleBox box{};
  for (std::size_t i = 0; i < 3; ++i) {
    // Widened by units in the last place, for the rounding of this very sum.
    const double slack = error + 0x1p-51 * std::abs(position[i]) + 0x1p-1000;
    box.lower[i] = position[i] - slack;
    box.upper[i] = position[i] + slack;
  }
  return box;
}

using Corners = std::vector<Point3>;

enum class Passes : unsigned char { Beside, Through, ByASide };

// How the line through p and q, which are not in one plane with the facet, passes a convex facet.
Passes passes(const Point3& p, const Point3& q, const Corners& corners) {
  bool left = false;
  bool right = false;
  bool meets_side = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Sign turn = orientation(p, q, corners[i], corners[i + 1 == corners.size() ? 0 : i + 1]);
    left |= turn == Sign::Positive;
    right |= turn == Sign::Negative;
    meets_side |= turn == Sign::Zero;
    if (left && right) return Passes::Beside;
  }
  return meets_side ? Passes::ByASide : Passes::Through;
}

// Where the plane of the corners is met, in parts of the way from p to q.
Rational crossing_parameter(const Point3& p, const Point3& q, const Corners& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Vector3 normal = cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    if (normal == Vector3{}) continue;
    return dot(normal, corners[0] - p) / dot(normal, q - p);
  }
  throw Error(ErrorId::InternalError, {"a facet without area", ""});
}

// A point near the middle of a facet; each attempt gives another.
Point3 aim(const Corners& corners, std::size_t attempt) {
  std::array<double, 3> target{};
  double total = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double weight = 1.0 + 0.37 * static_cast<double>((i * 7 + attempt * 5) % 11);
    target[0] += weight * corners[i].x.get_d();
    target[1] += weight * corners[i].y.get_d();
    target[2] += weight * corners[i].z.get_d();
    total += weight;
  }
  return {rational_of(target[0] / total), rational_of(target[1] / total),
          rational_of(target[2] / total)};
}

// The facets, those whose boxes' middles are near the point first: a short segment meets few
// others.
std::vector<std::size_t> by_distance(const Point3& point, const std::vector<DoubleBox>& bounds) {
  const std::array<double, 3> from{point.x.get_d(), point.y.get_d(), point.z.get_d()};
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(bounds.size());
  for (std::size_t f = 0; f < bounds.size(); ++f) {
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double middle = bounds[f].lower[i] + (bounds[f].upper[i] - bounds[f].lower[i]) / 2;
      squared += (middle - from[i]) * (middle - from[i]);
    }
    // Not a number, beyond the range of doubles: last.
    order.emplace_back(squared >= 0 ? squared : std::numeric_limits<double>::infinity(), f);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> result;
  result.reserve(order.size());
  for (const auto& [squared, f] : order) result.push_back(f);
  return result;
}

struct Crossing {
  Rational parameter;
  Membership before;  // where the segment comes from
};

}  // namespace

DoubleBox box_of(const Vertex& vertex) {
  return box_around({vertex.x, vertex.y, vertex.z}, vertex.error);
}

DoubleBox box_of(const Point3& point) {
  return box_around({point.x.get_d(), point.y.get_d(), point.z.get_d()}, 0);
}

DoubleBox box_of(const CornerView& corners) {
  DoubleBox box = box_of(corners.vertex(0));
  for (std::size_t i = 1; i < corners.size(); ++i) box = join(box, box_of(corners.vertex(i)));
  return box;
}

Membership nearest_crossing(const Point3& point, std::size_t facet_count,
                            const std::function<DoubleBox(std::size_t)>& bounds_of,
                            const std::function<std::vector<Point3>(std::size_t)>& corners_of) {
  constexpr std::size_t rounds = 8;
  std::vector<DoubleBox> bounds;
  bounds.reserve(facet_count);
  for (std::size_t f = 0; f < facet_count; ++f) bounds.push_back(bounds_of(f));
  const std::vector<std::size_t> targets = by_distance(point, bounds);
  for (std::size_t attempt = 0; attempt < rounds * facet_count; ++attempt) {
    // Beyond the target nothing matters if the target is behind the first crossing; going on a
    // little makes sure of that although the target is rounded.
    const Point3 target = aim(corners_of(targets[attempt % facet_count]), attempt / facet_count);
    const Point3 end = point + Rational(9, 8) * (target - point);
    const DoubleBox reach = join(box_of(point), box_of(end));
    std::optional<Crossing> nearest;
    bool degenerate = false;
    for (std::size_t f = 0; f < facet_count && !degenerate; ++f) {
      if (!meet(bounds[f], reach)) continue;
      const Corners corners = corners_of(f);
      const auto corner_at = [&](std::size_t i) -> const Point3& { return corners[i]; };
      const Sign here = side_of_polygon(corners.size(), corner_at, point);
      const Sign there = side_of_polygon(corners.size(), corner_at, end);
      if (here == Sign::Zero) {  // the point is in the facet's plane, but not in the facet
        degenerate = there == Sign::Zero;
        continue;
      }
      if (here == there) continue;
      const Passes passing = passes(point, end, corners);
      degenerate = passing == Passes::ByASide;
      if (passing != Passes::Through) continue;
      Rational parameter = crossing_parameter(point, end, corners);
      if (nearest && nearest->parameter < parameter) continue;
      nearest =
          Crossing{std::move(parameter), here == Sign::Positive ? Membership::Out : Membership::In};
    }
    if (nearest && !degenerate) return nearest->before;
  }
  throw Error(ErrorId::InternalError, {"no segment that crosses the mesh in general position", ""});
}

}  // namespace exactcsg
