// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/domain/strip_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include "exactcsg/gdt/zip.hpp"
#include "exactcsg/number/certified_double.hpp"
#include "exactcsg/number/quadratic_number.hpp"

namespace exactcsg::domain {

namespace {

struct CertifiedPoint {
  CertifiedDouble x;
  CertifiedDouble y;
};

CertifiedPoint certified(const CurvePoint& p) { return {{p.x, 0}, {p.y, 0}}; }
CertifiedPoint operator-(const CertifiedPoint& p, const CertifiedPoint& q) {
  return {p.x - q.x, p.y - q.y};
}
CertifiedDouble dot(const CertifiedPoint& u, const CertifiedPoint& v) {
  return u.x * v.x + u.y * v.y;
}
CertifiedDouble cross(const CertifiedPoint& u, const CertifiedPoint& v) {
  return u.x * v.y - u.y * v.x;
}

// An upper bound of the square root. [Certified]
double root_above(double square) { return std::sqrt(square) * (1 + 0x1p-50) + 0x1p-500; }

// An upper bound of the distance of the point from the chord. [Certified]
double distance_from_chord(const Strip& strip, const CurvePoint& point) {
  const CertifiedPoint chord = certified(strip.end) - certified(strip.begin);
  const CertifiedPoint from_begin = certified(point) - certified(strip.begin);
  const CertifiedPoint from_end = certified(point) - certified(strip.end);
  const CertifiedDouble along = dot(chord, from_begin);
  const CertifiedDouble beyond = dot(chord, from_end);
  const double to_ends =
      root_above(std::min(dot(from_begin, from_begin).upper(), dot(from_end, from_end).upper()));
  // The foot of the perpendicular is certainly on the chord.
  if (along.lower() < 0 || beyond.upper() > 0) return to_ends;
  const CertifiedDouble area = cross(chord, from_begin);
  const CertifiedDouble square = area * area / dot(chord, chord);
  return std::isfinite(square.error) ? std::min(to_ends, root_above(square.upper())) : to_ends;
}

struct Part {
  std::uint32_t first;
  std::uint32_t last;
};

Strip describe(std::span<const CurvePoint> points, Part part) {
  const CurvePoint& begin = points[part.first];
  const CurvePoint& end = points[part.last];
  Strip strip{part.first, part.last, begin, end, begin, begin, {end.x - begin.x, end.y - begin.y}};
  if (strip.direction == CurvePoint{}) strip.direction = {1, 0};
  for (std::uint32_t i = part.first; i <= part.last; ++i) {
    const CurvePoint& p = points[i];
    strip.lower = {std::min(strip.lower.x, p.x), std::min(strip.lower.y, p.y)};
    strip.upper = {std::max(strip.upper.x, p.x), std::max(strip.upper.y, p.y)};
    const CertifiedPoint offset = certified(p) - certified(begin);
    const CertifiedDouble along = dot(certified(strip.direction), offset);
    const CertifiedDouble across = cross(certified(strip.direction), offset);
    strip.along_low = std::min(strip.along_low, along.lower());
    strip.along_high = std::max(strip.along_high, along.upper());
    strip.across_low = std::min(strip.across_low, across.lower());
    strip.across_high = std::max(strip.across_high, across.upper());
    if (part.last - part.first > 1) {
      strip.deviation = std::max(strip.deviation, distance_from_chord(strip, p));
    }
  }
  return strip;
}

void check(std::span<const CurvePoint> points) {
  if (points.size() < 2) {
    throw Error(ErrorId::BadArgument,
                {"a curve of " + std::to_string(points.size()) + " points", "at least two"});
  }
  if (points.size() > (std::size_t{1} << 30)) {
    throw Error(ErrorId::TooLarge, {"a curve of more than 2^30 points", ""});
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y)) {
      throw Error(ErrorId::BadArgument, {"point " + std::to_string(i), "finite coordinates"});
    }
    if (i > 0 && points[i] == points[i - 1]) {
      throw Error(ErrorId::BadArgument, {"point " + std::to_string(i) + " equal to the one before",
                                         "different points in succession"});
    }
  }
}

const Strip& strip_of(const StripTree::Node& node) {
  return node.is_terminal() ? node.terminal() : node.label();
}

Coordinates<2> exact(const CurvePoint& p) { return {rational_of(p.x), rational_of(p.y)}; }

Rational exact_cross(const Coordinates<2>& origin, const Coordinates<2>& p,
                     const Coordinates<2>& q) {
  return (p[0] - origin[0]) * (q[1] - origin[1]) - (p[1] - origin[1]) * (q[0] - origin[0]);
}

// Positive: the point is to the left of the way from a to b.
Sign orientation(const CurvePoint& a, const CurvePoint& b, const Point<2>& point) {
  const CertifiedPoint p{point.approximate()[0], point.approximate()[1]};
  const CertifiedDouble filter = cross(certified(b) - certified(a), p - certified(a));
  if (filter.value > filter.error) return Sign::Positive;
  if (-filter.value > filter.error) return Sign::Negative;
  return sign_of(exact_cross(exact(a), exact(b), point.coordinates()));
}

// The points that a strip surely does not contain.
bool is_certainly_outside(const Strip& strip, const CertifiedPoint& point) {
  if (point.x.upper() < strip.lower.x || point.x.lower() > strip.upper.x ||
      point.y.upper() < strip.lower.y || point.y.lower() > strip.upper.y) {
    return true;
  }
  const CertifiedPoint offset = point - certified(strip.begin);
  const CertifiedDouble along = dot(certified(strip.direction), offset);
  const CertifiedDouble across = cross(certified(strip.direction), offset);
  return along.upper() < strip.along_low || along.lower() > strip.along_high ||
         across.upper() < strip.across_low || across.lower() > strip.across_high;
}

bool is_above(const CurvePoint& p, const Point<2>& point) {
  const CertifiedDouble y = point.approximate()[1];
  if (p.y > y.upper()) return true;
  if (p.y < y.lower()) return false;
  return rational_of(p.y) > point[1];
}

struct RayCrossings {
  bool odd = false;
  bool on = false;
};

// Of the segment from a to b with the ray from the point to the right, which counts to what is
// below.
bool crosses_ray(const CurvePoint& a, const CurvePoint& b, const Point<2>& point) {
  const bool a_above = is_above(a, point);
  if (a_above == is_above(b, point)) return false;
  return orientation(a, b, point) == (a_above ? Sign::Negative : Sign::Positive);
}

bool is_on_segment(const CurvePoint& a, const CurvePoint& b, const Point<2>& point) {
  if (orientation(a, b, point) != Sign::Zero) return false;
  const Coordinates<2> p = exact(a);
  const Coordinates<2> q = exact(b);
  const auto between = [&](std::size_t axis) {
    return std::min(p[axis], q[axis]) <= point[axis] && point[axis] <= std::max(p[axis], q[axis]);
  };
  return between(0) && between(1);
}

// Where the strip does not contain the point, its part of the curve may be replaced by the chord:
// the strip is convex, so one can be moved into the other within it without passing through the
// point.
RayCrossings ray_crossings(const StripTree& tree, const Point<2>& point) {
  const CertifiedPoint p{point.approximate()[0], point.approximate()[1]};
  return gdt::traverse(
      tree, gdt::LeafTest{[&](const Strip& strip) { return is_certainly_outside(strip, p); }},
      [&](const Strip& strip) {
        return RayCrossings{
            crosses_ray(strip.begin, strip.end, point),
            strip.last - strip.first == 1 && is_on_segment(strip.begin, strip.end, point)};
      },
      [](std::span<RayCrossings> parts) {
        RayCrossings sum;
        for (const RayCrossings& part : parts) {
          sum = {sum.odd != part.odd, sum.on || part.on};
        }
        return sum;
      });
}

std::array<CertifiedPoint, 4> corners(const Strip& strip) {
  const CertifiedPoint d = certified(strip.direction);
  const CertifiedDouble square = dot(d, d);
  std::array<CertifiedPoint, 4> result;
  std::size_t i = 0;
  for (const double along : {strip.along_low, strip.along_high}) {
    for (const double across : {strip.across_low, strip.across_high}) {
      const CertifiedDouble s{along, 0};
      const CertifiedDouble t{across, 0};
      const CertifiedPoint begin = certified(strip.begin);
      result[i++] = {begin.x + (s * d.x - t * d.y) / square,
                     begin.y + (s * d.y + t * d.x) / square};
    }
  }
  return result;
}

// A side of the first strip separates the other's corners from it.
bool separates(const Strip& strip, const std::array<CertifiedPoint, 4>& others) {
  std::array<bool, 4> beyond{true, true, true, true};
  for (const CertifiedPoint& corner : others) {
    const CertifiedPoint offset = corner - certified(strip.begin);
    const CertifiedDouble along = dot(certified(strip.direction), offset);
    const CertifiedDouble across = cross(certified(strip.direction), offset);
    beyond[0] = beyond[0] && along.upper() < strip.along_low;
    beyond[1] = beyond[1] && along.lower() > strip.along_high;
    beyond[2] = beyond[2] && across.upper() < strip.across_low;
    beyond[3] = beyond[3] && across.lower() > strip.across_high;
  }
  return beyond[0] || beyond[1] || beyond[2] || beyond[3];
}

bool are_certainly_disjoint(const Strip& a, const Strip& b) {
  if (a.upper.x < b.lower.x || b.upper.x < a.lower.x || a.upper.y < b.lower.y ||
      b.upper.y < a.lower.y) {
    return true;
  }
  return separates(a, corners(b)) || separates(b, corners(a));
}

// Two segments of one line, from the greater of the lower ends to the lesser of the upper ones.
void add_overlap(const Strip& a, const Strip& b, std::vector<CurveMeeting>& result) {
  const auto [a_low, a_high] = std::minmax({exact(a.begin), exact(a.end)});
  const auto [b_low, b_high] = std::minmax({exact(b.begin), exact(b.end)});
  const Coordinates<2> low = std::max(a_low, b_low);
  const Coordinates<2> high = std::min(a_high, b_high);
  if (low <= high) result.push_back({a.first, b.first, low, high});
}

std::vector<CurveMeeting> meeting_of_segments(const Strip& a, const Strip& b) {
  std::vector<CurveMeeting> result;
  const Coordinates<2> p = exact(a.begin);
  const Coordinates<2> q = exact(a.end);
  const Coordinates<2> r = exact(b.begin);
  const Coordinates<2> s = exact(b.end);
  const Rational side_r = exact_cross(p, q, r);
  const Rational side_s = exact_cross(p, q, s);
  if (side_r == side_s) {  // parallel
    if (side_r == 0) add_overlap(a, b, result);
    return result;
  }
  const Rational t = side_r / (side_r - side_s);  // on b
  if (t < 0 || t > 1) return result;
  const Rational side_p = exact_cross(r, s, p);
  const Rational side_q = exact_cross(r, s, q);
  if (side_p * side_q > 0) return result;
  const Point<2> point(Rational(r[0] + t * (s[0] - r[0])), Rational(r[1] + t * (s[1] - r[1])));
  result.push_back({a.first, b.first, point, point});
  return result;
}

double size(const Strip& strip) {
  return std::max(strip.upper.x - strip.lower.x, strip.upper.y - strip.lower.y);
}

}  // namespace

StripTree make_strip_tree(std::span<const CurvePoint> points) {
  check(points);
  return gdt::create_multi_resolution(
      Part{0, static_cast<std::uint32_t>(points.size() - 1)},
      [](const Part& part) { return part.last - part.first == 1; },
      [](const Part& part) {
        const std::uint32_t middle = part.first + (part.last - part.first) / 2;
        return std::array{Part{part.first, middle}, Part{middle, part.last}};
      },
      [points](const Part& part) { return describe(points, part); });
}

const Strip& root_strip(const StripTree& tree) { return strip_of(tree.root()); }

Enclosure length(const StripTree& tree, int bits) {
  // n segments, each within 2^-(bits + log2 n)
  int bits_of_count = 1;
  while ((tree.terminals().size() >> static_cast<unsigned>(bits_of_count)) != 0) ++bits_of_count;
  return gdt::traverse(
      tree,
      [&](const Strip& segment) {
        const Coordinates<2> p = exact(segment.begin);
        const Coordinates<2> q = exact(segment.end);
        const Rational x = q[0] - p[0];
        const Rational y = q[1] - p[1];
        return enclose(QuadraticNumber(0, 1, Rational(x * x + y * y)), bits + bits_of_count);
      },
      [](std::span<Enclosure> parts) {
        Enclosure sum;
        for (const Enclosure& part : parts) {
          sum.lower += part.lower;
          sum.upper += part.upper;
        }
        return sum;
      });
}

PointClass classify(const StripTree& tree, const Point<2>& point) {
  if (!is_closed(tree)) {
    throw Error(ErrorId::BadArgument, {"an open curve", "one that ends where it begins"});
  }
  const RayCrossings crossings = ray_crossings(tree, point);
  if (crossings.on) return PointClass::On;
  return crossings.odd ? PointClass::In : PointClass::Out;
}

bool contains(const StripTree& tree, const Point<2>& point) {
  return ray_crossings(tree, point).on;
}

std::vector<CurveMeeting> intersection(const StripTree& first, const StripTree& second) {
  using Pair = gdt::Pair<StripTree, StripTree>;
  using Meetings = std::vector<CurveMeeting>;
  auto result = gdt::zip(
      first, second,
      [](const Pair& pair) {
        const Strip& a = strip_of(pair.first);
        const Strip& b = strip_of(pair.second);
        const bool both_terminal = pair.first.is_terminal() && pair.second.is_terminal();
        if (both_terminal || are_certainly_disjoint(a, b)) return gdt::Split::Neither;
        if (pair.first.is_terminal()) return gdt::Split::Second;
        if (pair.second.is_terminal()) return gdt::Split::First;
        return size(a) >= size(b) ? gdt::Split::First : gdt::Split::Second;
      },
      [](const Pair& pair) -> Meetings {
        if (!pair.first.is_terminal() || !pair.second.is_terminal()) return {};
        const Strip& a = pair.first.terminal();
        const Strip& b = pair.second.terminal();
        return are_certainly_disjoint(a, b) ? Meetings() : meeting_of_segments(a, b);
      },
      [](std::span<Meetings> parts) {
        Meetings all = std::move(parts.front());
        for (Meetings& part : parts.subspan(1)) {
          all.insert(all.end(), std::move_iterator(part.begin()), std::move_iterator(part.end()));
        }
        return all;
      });
  std::sort(result.begin(), result.end(), [](const CurveMeeting& a, const CurveMeeting& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  return result;
}

std::vector<std::uint32_t> simplified(const StripTree& tree, double tolerance) {
  using Numbers = std::vector<std::uint32_t>;
  auto result = gdt::traverse(
      tree, gdt::LeafTest{[&](const Strip& strip) { return strip.deviation <= tolerance; }},
      [](const Strip& strip) { return Numbers{strip.last}; },
      [](std::span<Numbers> parts) {
        Numbers all = std::move(parts.front());
        for (const Numbers& part : parts.subspan(1))
          all.insert(all.end(), part.begin(), part.end());
        return all;
      });
  result.insert(result.begin(), 0);
  return result;
}

}  // namespace exactcsg::domain
