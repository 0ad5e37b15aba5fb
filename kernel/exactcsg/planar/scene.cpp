// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/planar/scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "exactcsg/number/common_denominator.hpp"
#include "exactcsg/number/exact_tiers.hpp"

namespace exactcsg::planar {

namespace {

constexpr std::size_t mantissa_bits = 53;
constexpr std::size_t safe_exponent = 900;
constexpr long moderate_exponent = 300;
// Differences of two such integers fit in 63 bits, determinants of differences in 128.
constexpr std::size_t scaled_bits = 61;

std::size_t bit_length(const Integer& value) { return mpz_sizeinbase(value.get_mpz_t(), 2); }

// Without error where the rational is a double.
CertifiedDouble certified(const Rational& value) {
  const mpz_srcptr numerator = value.get_num_mpz_t();
  const mpz_srcptr denominator = value.get_den_mpz_t();
  const std::size_t denominator_bits = mpz_sizeinbase(denominator, 2);
  if (mpz_sizeinbase(numerator, 2) <= mantissa_bits && denominator_bits <= safe_exponent &&
      mpz_scan1(denominator, 0) == denominator_bits - 1) {
    return {std::ldexp(mpz_get_d(numerator), -static_cast<int>(denominator_bits - 1)), 0};
  }
  return certified_double_of(value);
}

struct ApproximatePoint {
  double x, y;
  friend bool operator==(const ApproximatePoint&, const ApproximatePoint&) = default;
};
struct ApproximateHash {
  std::size_t operator()(const ApproximatePoint& p) const noexcept {
    const auto mixed = std::bit_cast<std::uint64_t>(p.x + 0.0) * 0x9e3779b97f4a7c15U ^
                       std::bit_cast<std::uint64_t>(p.y + 0.0);
    return static_cast<std::size_t>((mixed ^ mixed >> 32U) * 0x9e3779b97f4a7c15U);
  }
};

Sign cross_sign(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by) {
  return sign_of(static_cast<Int128>(ax) * by - static_cast<Int128>(ay) * bx);
}

CertifiedDouble cross(const CertifiedPoint& a, const CertifiedPoint& b) {
  return a[x_axis] * b[y_axis] - a[y_axis] * b[x_axis];
}

Integer integer_of(const Int128& value) {
  __extension__ using Wide = unsigned __int128;
  const bool negative = value < 0;
  const Wide magnitude = negative ? -static_cast<Wide>(value) : static_cast<Wide>(value);
  Integer result(static_cast<unsigned long>(magnitude >> 64U));
  result <<= 64U;
  result += static_cast<unsigned long>(magnitude & ~std::uint64_t{0});
  return negative ? Integer(-result) : result;
}

}  // namespace

struct Scene::Builder {
  Scene& scene;
  std::unordered_map<const PlanarFigure*, FigureIndex> figure_of;
  std::unordered_multimap<ApproximatePoint, PointIndex, ApproximateHash> point_of;
  std::vector<const PlanarFigure*> sources;

  FigureIndex number(const PlanarFigure& source) {
    const auto [known, added] =
        figure_of.emplace(&source, static_cast<FigureIndex>(sources.size()));
    if (added) sources.push_back(&source);
    return known->second;
  }

  // So that the greatest coordinate is a double of moderate size, by a power of two.
  void choose_magnification() {
    long exponent = std::numeric_limits<long>::min();
    for (const PlanarFigure* source : sources) {
      for (const auto& path : source->paths) {
        for (const Point2& p : path) {
          for (const Rational* value : {&p.x, &p.y}) {
            if (*value == 0) continue;
            exponent = std::max(exponent, static_cast<long>(bit_length(value->get_num())) -
                                              static_cast<long>(bit_length(value->get_den())));
          }
        }
      }
    }
    if (exponent == std::numeric_limits<long>::min()) return;
    if (std::abs(exponent) > moderate_exponent) scene.magnification_ = -exponent;
  }

  void add_figures() {
    for (FigureIndex f = 0; f < sources.size(); ++f) {
      Figure figure;
      figure.first_edge = static_cast<EdgeIndex>(scene.edges_.size());
      for (const auto& path : sources[f]->paths) {
        if (path.size() >= 3) add_path(path, f);
      }
      figure.edge_count = static_cast<std::uint32_t>(scene.edges_.size() - figure.first_edge);
      scene.figures_.push_back(figure);
    }
  }

  void add_path(const std::vector<Point2>& path, FigureIndex figure) {
    const PointIndex first = point(path[0]);
    PointIndex from = first;
    for (std::size_t i = 1; i <= path.size(); ++i) {
      const PointIndex to = i == path.size() ? first : point(path[i]);
      if (to != from) scene.edges_.push_back({from, to, figure, 0, {}, 0, {}});
      from = to;
    }
  }

  void build() {
    choose_magnification();
    add_figures();
    scale();
    for (Edge& edge : scene.edges_) find_direction(edge);
    number_segments();
    for (FigureIndex f = 0; f < sources.size(); ++f) {
      Figure& figure = scene.figures_[f];
      if (sources[f]->paths.size() == 1) figure.shape = shape_of(figure);
    }
  }

  void number_segments() {
    std::unordered_map<std::uint64_t, SegmentIndex> known;
    known.reserve(scene.edges_.size());
    for (Edge& edge : scene.edges_) {
      const auto [least, greatest] = std::minmax(edge.from, edge.to);
      const std::uint64_t key = std::uint64_t{least} << 32U | greatest;
      edge.segment = known.try_emplace(key, static_cast<SegmentIndex>(known.size())).first->second;
    }
    scene.segment_count_ = known.size();
  }

  void find_direction(Edge& edge) const {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      edge.vector[axis] = scene.points_[edge.to][axis] - scene.points_[edge.from][axis];
      edge.direction[axis] = scene.compare(edge.to, edge.from, axis);
    }
    const double dx = std::abs(edge.vector[x_axis].value);
    const double dy = std::abs(edge.vector[y_axis].value);
    const bool is_upright =
        edge.direction[x_axis] == Sign::Zero || (edge.direction[y_axis] != Sign::Zero && dy > dx);
    edge.long_axis = is_upright ? y_axis : x_axis;
  }

  PointIndex point(const Point2& given) {
    if (scene.magnification_ == 0) return add_point(given);
    scene.magnified_.push_back(scene.multiplied(given, scene.magnification_));
    return add_point(scene.magnified_.back());
  }

  PointIndex add_point(const Point2& p) {
    const CertifiedPoint near{certified(p.x), certified(p.y)};
    const ApproximatePoint key{near[0].value, near[1].value};
    const auto [begin, end] = point_of.equal_range(key);
    for (auto known = begin; known != end; ++known) {
      const CertifiedPoint& other = scene.points_[known->second];
      const bool exact = near[0].error == 0 && near[1].error == 0;
      if (exact && other[0].error == 0 && other[1].error == 0) return known->second;
      if (scene.exact_point(known->second) == p) return known->second;
    }
    const auto index = static_cast<PointIndex>(scene.points_.size());
    scene.points_.push_back(near);
    scene.exact_points_.push_back(&p);
    point_of.emplace(key, index);
    return index;
  }

  // Strictly convex: all turns to one side, and once round (the direction of x, or where that is
  // Zero of y, changes exactly twice).
  Shape shape_of(const Figure& figure) const {
    const std::uint32_t n = figure.edge_count;
    if (n < 3) return Shape::Any;
    const auto edge_at = [&](std::uint32_t i) { return figure.first_edge + i % n; };
    const auto rightward = [&](EdgeIndex e) {
      const auto& direction = scene.edges_[e].direction;
      return (direction[x_axis] != Sign::Zero ? direction[x_axis] : direction[y_axis]) ==
             Sign::Positive;
    };
    const Sign side = scene.turn(edge_at(0), edge_at(1));
    std::uint32_t changes = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      if (i != 0 && scene.turn(edge_at(i), edge_at(i + 1)) != side) return Shape::Any;
      if (rightward(edge_at(i)) != rightward(edge_at(i + 1))) ++changes;
    }
    if (side == Sign::Zero || changes != 2) return Shape::Any;
    return side == Sign::Positive ? Shape::ConvexCounterClockwise : Shape::ConvexClockwise;
  }

  void scale() {
    Integer& common = scene.denominator_;
    for (const Point2* p : scene.exact_points_) {
      for (const Rational* value : {&p->x, &p->y}) {
        make_multiple(common, value->get_den());
        if (mpz_sizeinbase(common.get_mpz_t(), 2) > scaled_bits) return;
      }
    }
    Integer scaled;
    scene.scaled_.reserve(scene.points_.size());
    for (const Point2* p : scene.exact_points_) {
      auto& point = scene.scaled_.emplace_back();
      for (std::size_t axis = 0; axis < 2; ++axis) {
        set_scaled(scaled, axis == x_axis ? p->x : p->y, common);
        if (mpz_sizeinbase(scaled.get_mpz_t(), 2) > scaled_bits) return scene.scaled_.clear();
        point[axis] = scaled.get_si();
      }
    }
  }
};

Scene::Scene(const PlanarTree& tree) {
  Builder builder{*this, {}, {}, {}};
  tree_ = csg::flatten(tree, [&](const PlanarFigure& figure) { return builder.number(figure); });
  builder.build();
}

Point2 Scene::multiplied(const Point2& point, long exponent) {
  Point2 result = point;
  for (Rational* value : {&result.x, &result.y}) {
    const auto shift = static_cast<mp_bitcnt_t>(std::abs(exponent));
    (exponent < 0 ? mpq_div_2exp : mpq_mul_2exp)(value->get_mpq_t(), value->get_mpq_t(), shift);
  }
  return result;
}

Point2 Scene::given(Point2 point) const {
  return magnification_ == 0 ? std::move(point) : multiplied(point, -magnification_);
}

Sign Scene::compare(PointIndex p, std::size_t axis, double position) const {
  if (const auto sign = certain_order(points_[p][axis], {position, 0})) return *sign;
  const Point2& exact = exact_point(p);
  return sign_of(cmp(axis == x_axis ? exact.x : exact.y, Rational(position)));
}

Sign Scene::compare(PointIndex p, PointIndex q, std::size_t axis) const {
  if (!scaled_.empty()) {
    const std::int64_t a = scaled_[p][axis];
    const std::int64_t b = scaled_[q][axis];
    return sign_of(static_cast<int>(a > b) - static_cast<int>(a < b));
  }
  if (const auto sign = certain_order(points_[p][axis], points_[q][axis])) return *sign;
  const Point2& a = exact_point(p);
  const Point2& b = exact_point(q);
  return sign_of(axis == x_axis ? cmp(a.x, b.x) : cmp(a.y, b.y));
}

Sign Scene::orientation(EdgeIndex edge, PointIndex point) const {
  const Edge& e = edges_[edge];
  if (!scaled_.empty()) {
    const auto& a = scaled_[e.from];
    const auto& b = scaled_[e.to];
    const auto& p = scaled_[point];
    return cross_sign(b[0] - a[0], b[1] - a[1], p[0] - a[0], p[1] - a[1]);
  }
  const CertifiedPoint& a = points_[e.from];
  const CertifiedPoint& p = points_[point];
  const CertifiedPoint offset{p[0] - a[0], p[1] - a[1]};
  if (const auto sign = certain_sign(cross(e.vector, offset))) return *sign;
  return exact_orientation(edge, exact_point(point));
}

Sign Scene::orientation(EdgeIndex edge, const CertifiedPoint& near, const Point2& point) const {
  const Edge& e = edges_[edge];
  const CertifiedPoint& a = points_[e.from];
  const CertifiedPoint offset{near[0] - a[0], near[1] - a[1]};
  if (const auto sign = certain_sign(cross(e.vector, offset))) return *sign;
  return exact_orientation(edge, point);
}

Sign Scene::exact_orientation(EdgeIndex edge, const Point2& point) const {
  const Point2& a = exact_point(edges_[edge].from);
  const Point2& b = exact_point(edges_[edge].to);
  const Rational left = (b.x - a.x) * (point.y - a.y);
  const Rational right = (b.y - a.y) * (point.x - a.x);
  return sign_of(cmp(left, right));
}

Sign Scene::turn(EdgeIndex e, EdgeIndex g) const {
  const Edge& first = edges_[e];
  const Edge& second = edges_[g];
  if (!scaled_.empty()) {
    const auto& a = scaled_[first.from];
    const auto& b = scaled_[first.to];
    const auto& c = scaled_[second.from];
    const auto& d = scaled_[second.to];
    return cross_sign(b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]);
  }
  if (const auto sign = certain_sign(cross(first.vector, second.vector))) return *sign;
  const Point2& a = exact_point(first.from);
  const Point2& b = exact_point(first.to);
  const Point2& c = exact_point(second.from);
  const Point2& d = exact_point(second.to);
  const Rational left = (b.x - a.x) * (d.y - c.y);
  const Rational right = (b.y - a.y) * (d.x - c.x);
  return sign_of(cmp(left, right));
}

CertifiedDouble Scene::at_wall(EdgeIndex edge, const Wall& wall) const {
  const Edge& e = edges_[edge];
  const std::size_t other = 1 - wall.axis;
  const CertifiedPoint& a = points_[e.from];
  if (e.direction[other] == Sign::Zero) return a[other];
  const CertifiedDouble position{wall.position, 0};
  return a[other] + (position - a[wall.axis]) * (e.vector[other] / e.vector[wall.axis]);
}

Rational Scene::exact_at_wall(EdgeIndex edge, const Wall& wall) const {
  const Point2& a = exact_point(edges_[edge].from);
  const Point2& b = exact_point(edges_[edge].to);
  const Rational position(wall.position);
  if (wall.axis == x_axis) return a.y + (position - a.x) * (b.y - a.y) / (b.x - a.x);
  return a.x + (position - a.y) * (b.x - a.x) / (b.y - a.y);
}

Sign Scene::compare_at_wall(EdgeIndex edge, const Wall& wall, CertifiedDouble near,
                            double position) const {
  if (const auto sign = certain_sign(near - CertifiedDouble{position, 0})) return *sign;
  const Sign sign = sign_of(cmp(exact_at_wall(edge, wall), Rational(position)));
  if (sign != Sign::Zero) return sign;
  // At y = d + epsilon' the edge is at x = c + slope epsilon', which is below c + epsilon; at
  // x = c + epsilon it is at y = d + slope epsilon, above d + epsilon' if it ascends.
  if (wall.axis == y_axis) return Sign::Negative;
  return slope(edge) == Sign::Positive ? Sign::Positive : Sign::Negative;
}

Sign Scene::order_at_wall(EdgeIndex e, CertifiedDouble near_e, EdgeIndex g, CertifiedDouble near_g,
                          const Wall& wall) const {
  if (const auto sign = certain_sign(near_e - near_g)) return *sign;
  const Edge& first = edges_[e];
  const Edge& second = edges_[g];
  // Which is the greater one after all meetings of the lines, along the wall's axis.
  const Sign ways = first.direction[wall.axis] * second.direction[wall.axis];
  const Sign turned = turn(g, e) * ways;
  const Sign beyond = wall.axis == x_axis ? turned : -turned;
  if (beyond == Sign::Zero) {
    const Sign side = orientation(e, second.from) * first.direction[wall.axis];
    return wall.axis == x_axis ? -side : side;
  }
  for (const PointIndex p : {first.from, first.to}) {
    if (p != second.from && p != second.to) continue;
    return compare(p, wall.axis, wall.position) == Sign::Positive ? -beyond : beyond;
  }
  const Sign sign = sign_of(cmp(exact_at_wall(e, wall), exact_at_wall(g, wall)));
  return sign != Sign::Zero ? sign : beyond;
}

CertifiedPoint Scene::crossing(EdgeIndex e, EdgeIndex g) const {
  const Edge& first = edges_[e];
  const Edge& second = edges_[g];
  const CertifiedPoint& a = points_[first.from];
  const CertifiedPoint& b = points_[second.from];
  const CertifiedPoint offset{b[0] - a[0], b[1] - a[1]};
  const CertifiedDouble along = cross(offset, second.vector) / cross(first.vector, second.vector);
  return {a[0] + along * first.vector[0], a[1] + along * first.vector[1]};
}

Point2 Scene::exact_crossing(EdgeIndex e, EdgeIndex g) const {
  const Edge& first = edges_[e];
  const Edge& second = edges_[g];
  Point2 result;
  if (!scaled_.empty()) {
    const auto& a = scaled_[first.from];
    const auto& b = scaled_[first.to];
    const auto& c = scaled_[second.from];
    const auto& d = scaled_[second.to];
    const std::array<std::int64_t, 2> u{b[0] - a[0], b[1] - a[1]};
    const std::array<std::int64_t, 2> v{d[0] - c[0], d[1] - c[1]};
    const std::array<std::int64_t, 2> w{c[0] - a[0], c[1] - a[1]};
    const auto determinant = [](const auto& p, const auto& q) {
      return integer_of(static_cast<Int128>(p[0]) * q[1] - static_cast<Int128>(p[1]) * q[0]);
    };
    const Integer along = determinant(w, v);
    const Integer whole = determinant(u, v);
    const Integer common = whole * denominator_;
    result.x = Rational(a[0] * whole + along * u[0], common);
    result.y = Rational(a[1] * whole + along * u[1], common);
    result.x.canonicalize();
    result.y.canonicalize();
    return result;
  }
  const Point2& a = exact_point(first.from);
  const Point2& b = exact_point(first.to);
  const Point2& c = exact_point(second.from);
  const Point2& d = exact_point(second.to);
  const Point2 u{b.x - a.x, b.y - a.y};
  const Point2 v{d.x - c.x, d.y - c.y};
  const Point2 w{c.x - a.x, c.y - a.y};
  const Rational along = (w.x * v.y - w.y * v.x) / (u.x * v.y - u.y * v.x);
  return {a.x + along * u.x, a.y + along * u.y};
}

}  // namespace exactcsg::planar
