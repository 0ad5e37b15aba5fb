// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/domain/curve_region.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "exactcsg/support/error.hpp"

namespace exactcsg::domain {

namespace {

using Position = Coordinates<2>;

Position exact(const CurvePoint& p) { return {rational_of(p.x), rational_of(p.y)}; }

// visit(const Strip&) for the segments whose strips are not left out, with those above them, by
// is_out(const Strip&).
template <class IsOut, class Visit>
void for_each_segment(const StripTree& tree, const IsOut& is_out, const Visit& visit) {
  std::vector<StripTree::Node> pending{tree.root()};
  while (!pending.empty()) {
    const StripTree::Node node = pending.back();
    pending.pop_back();
    if (is_out(node.geometry())) continue;
    if (node.is_terminal()) {
      visit(node.terminal());
    } else {
      for (const StripTree::Node child : node.children()) pending.push_back(child);
    }
  }
}

std::array<Position, 4> corners(const Strip& strip) {
  const Position low = exact(strip.lower);
  const Position high = exact(strip.upper);
  return {low, Position{high[0], low[1]}, high, Position{low[0], high[1]}};
}

Position image(const AffineMap& map, const Position& p) {
  return apply(map, Point<2>(p)).coordinates();
}

// Is there a t from 0 to 1 at which p + t (q - p) is strictly between the bounds? REQUIRES p != q
bool meets_interior(const Box<2>& box, const Position& p, const Position& q) {
  Rational enters = 0;
  Rational leaves = 1;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Rational run = q[axis] - p[axis];
    const Rational& low = box.lower()[axis];
    const Rational& high = box.upper()[axis];
    if (run == 0) {
      if (p[axis] <= low || p[axis] >= high) return false;
      continue;
    }
    Rational first = (low - p[axis]) / run;
    Rational last = (high - p[axis]) / run;
    if (run < 0) std::swap(first, last);
    if (first >= 1 || last <= 0) return false;
    enters = std::max(enters, first);
    leaves = std::min(leaves, last);
  }
  return enters < leaves;
}

bool is_beside(const Box<2>& box, const std::array<Position, 4>& points) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto all = [&](const auto& holds) {
      return std::all_of(points.begin(), points.end(), holds);
    };
    if (all([&](const Position& p) { return p[axis] <= box.lower()[axis]; })) return true;
    if (all([&](const Position& p) { return p[axis] >= box.upper()[axis]; })) return true;
  }
  return false;
}

// The line as the plane of the curve sees it; its parameters are the same.
LineSection<2> seen_from_curve(const CurveRegion& region, const LineSection<2>& line) {
  const Position origin = image(region.way_back(), line.origin);
  const Position next = image(region.way_back(), line.at(1).coordinates());
  return {origin, {next[0] - origin[0], next[1] - origin[1]}, line.begin, line.end};
}

Rational side_of(const LineSection<2>& line, const Position& p) {
  return line.direction[0] * (p[1] - line.origin[1]) - line.direction[1] * (p[0] - line.origin[0]);
}

// REQUIRES p is on the line.
Rational parameter_of(const LineSection<2>& line, const Position& p) {
  const std::size_t axis = line.direction[0] != 0 ? 0 : 1;
  return (p[axis] - line.origin[axis]) / line.direction[axis];
}

bool is_beside(const LineSection<2>& line, const std::array<Position, 4>& points) {
  bool is_left = false;
  bool is_right = false;
  for (const Position& p : points) {
    const int side = sgn(side_of(line, p));
    is_left = is_left || side >= 0;
    is_right = is_right || side <= 0;
  }
  return !(is_left && is_right);
}

// Where the line meets the curve, strictly between its bounds; ends of what runs along it as well.
std::vector<Rational> meetings(const CurveRegion& region, const LineSection<2>& line) {
  std::vector<Rational> parameters;
  for_each_segment(
      region.curve(), [&](const Strip& strip) { return is_beside(line, corners(strip)); },
      [&](const Strip& segment) {
        const Position p = exact(segment.begin);
        const Position q = exact(segment.end);
        const Rational at_p = side_of(line, p);
        const Rational at_q = side_of(line, q);
        if (at_p * at_q > 0) return;
        if (at_p == at_q) {
          parameters.push_back(parameter_of(line, p));
          parameters.push_back(parameter_of(line, q));
          return;
        }
        const Rational t = at_p / (at_p - at_q);
        parameters.push_back(parameter_of(
            line, {Rational(p[0] + t * (q[0] - p[0])), Rational(p[1] + t * (q[1] - p[1]))}));
      });
  std::erase_if(parameters, [&](const Rational& t) {
    return (line.begin && t <= *line.begin) || (line.end && t >= *line.end);
  });
  std::sort(parameters.begin(), parameters.end());
  parameters.erase(std::unique(parameters.begin(), parameters.end()), parameters.end());
  return parameters;
}

}  // namespace

CurveRegion::CurveRegion(StripTree curve)
    : curve_(std::make_shared<const StripTree>(std::move(curve))) {
  if (is_closed(*curve_)) return;
  throw Error(ErrorId::BadArgument, {"an open curve", "one that ends where it begins"});
}

CurveRegion apply(const AffineMap& map, CurveRegion region) {
  if (determinant(map) == 0) throw Error(ErrorId::SingularMap, {"", ""});
  region.placement_ = map * region.placement_;
  region.way_back_ = inverse(region.placement_);
  return region;
}

PointClass classify(const CurveRegion& region, const Point<2>& point) {
  const PointClass found = classify(region.curve(), apply(region.way_back(), point));
  return region.is_complement() ? complement(found) : found;
}

csg::Membership classify(const CurveRegion& region, const Box<2>& box) {
  const auto placed = [&](const Strip& strip) {
    std::array<Position, 4> result = corners(strip);
    for (Position& p : result) p = image(region.placement(), p);
    return result;
  };
  bool meets = false;
  for_each_segment(
      region.curve(), [&](const Strip& strip) { return meets || is_beside(box, placed(strip)); },
      [&](const Strip& segment) {
        meets = meets_interior(box, image(region.placement(), exact(segment.begin)),
                               image(region.placement(), exact(segment.end)));
      });
  return meets ? csg::Membership::Unknown : membership(classify(region, box.centre()));
}

Section section(const CurveRegion& region, const LineSection<2>& line) {
  const LineSection<2> seen = seen_from_curve(region, line);
  Section result;
  for (Rational& t : meetings(region, seen)) result.crossings.push_back({std::move(t), 1});
  for (std::size_t i = 0; i <= result.crossings.size(); ++i) {
    const Rational t = detail::parameter_between(result.crossings, i, line.begin, line.end);
    result.between.push_back(classify(region, line.at(t)));
  }
  for (std::size_t i = 0; i < result.crossings.size(); ++i) {
    if (result.between[i] == result.between[i + 1]) result.crossings[i].multiplicity = 2;
  }
  return result;
}

}  // namespace exactcsg::domain
