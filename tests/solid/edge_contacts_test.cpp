// SPDX-License-Identifier: GPL-3.0-or-later
// Expected: the segments intersected pair by pair in rational numbers.
#include "exactcsg/solid/edge_contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "exactcsg/number/exact.hpp"

namespace exactcsg {
namespace {

struct Segment {
  Point3 from;
  Point3 to;
};

// LAW edge_contacts.1: the point that segments of different directions have in common.
std::optional<Point3> common_point(const Segment& a, const Segment& b) {
  const Vector3 u = a.to - a.from;
  const Vector3 v = b.to - b.from;
  const Vector3 w = b.from - a.from;
  const Vector3 normal = cross(u, v);
  if (normal == Vector3{0, 0, 0} || dot(normal, w) != 0) return std::nullopt;
  const Rational square = dot(normal, normal);
  const Rational s = dot(cross(w, v), normal) / square;
  const Rational t = dot(cross(w, u), normal) / square;
  if (s < 0 || s > 1 || t < 0 || t > 1) return std::nullopt;
  return Point3{a.from.x + s * u.x, a.from.y + s * u.y, a.from.z + s * u.z};
}

// Segments between points of a small grid, on which contacts of all kinds abound.
class Segments {
 public:
  Segments(std::mt19937& random, std::size_t count) {
    std::uniform_int_distribution<int> coordinate(0, 3);
    const auto point = [&] {
      return Point3{coordinate(random), coordinate(random), coordinate(random) / 3};
    };
    Geometry::Builder builder;
    while (segments_.size() < count) {
      const Segment s{point(), point()};
      const Point3 p = point();
      const Point3 q = point();
      const Vector3 along = s.to - s.from;
      if (dot(cross(along, p - s.from), q - s.from) == 0) continue;  // or the planes are one
      segments_.push_back(s);
      const std::array<std::uint32_t, 2> ends{number_of(s.from), number_of(s.to)};
      const auto add_plane = [&](const Point3& third) {
        return builder.add_plane(builder.add_point(s.from), builder.add_point(s.to),
                                 builder.add_point(third));
      };
      added_.push_back({add_plane(p), add_plane(q)});
      EdgeSpan span;
      span.line = static_cast<std::uint32_t>(spans_.size());
      span.from = std::min(ends[0], ends[1]);
      span.to = std::max(ends[0], ends[1]);
      // The first ones are of two primitives, the others of none.
      if (spans_.size() < count / 2) span.primitive = spans_.size() < count / 4 ? 0 : 1;
      spans_.push_back(span);
    }
    std::vector<PointId> ids;
    for (const Point3& p : points_) ids.push_back(builder.add_point(p));
    geometry_.emplace(std::move(builder).build());
    vertices_.emplace(*geometry_);
    for (const PointId id : ids) vertices_->push_back(geometry_->vertex(id));
    for (std::size_t i = 0; i < spans_.size(); ++i) {
      spans_[i].planes = {geometry_->plane(added_[i][0]).plane,
                          geometry_->plane(added_[i][1]).plane};
    }
  }

  std::vector<EdgeContact> contacts(unsigned threads) const {
    TierStatistics statistics;
    return edge_contacts(*geometry_, *vertices_, spans_, statistics, threads, nullptr);
  }

  using Pair = std::array<std::uint32_t, 2>;

  std::map<Pair, Point3> expected() const {
    std::map<Pair, Point3> result;
    for (std::uint32_t i = 0; i < spans_.size(); ++i) {
      for (std::uint32_t j = 0; j < i; ++j) {
        const EdgeSpan& a = spans_[i];
        const EdgeSpan& b = spans_[j];
        if (a.primitive != EdgeSpan::no_primitive && a.primitive == b.primitive) continue;
        if (a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to) continue;
        if (const auto point = common_point(segments_[i], segments_[j])) result[{j, i}] = *point;
      }
    }
    return result;
  }

  Point3 position(const Vertex& vertex) const { return geometry_->exact_point(vertex); }
  const VertexRow& vertices() const { return *vertices_; }
  const Geometry& geometry() const { return *geometry_; }
  const Point3& point(std::uint32_t number) const { return points_[number]; }
  bool is_end(std::uint32_t span, const Point3& point) const {
    return segments_[span].from == point || segments_[span].to == point;
  }

 private:
  std::uint32_t number_of(const Point3& point) {
    const auto known = std::find(points_.begin(), points_.end(), point);
    if (known != points_.end()) return static_cast<std::uint32_t>(known - points_.begin());
    points_.push_back(point);
    return static_cast<std::uint32_t>(points_.size() - 1);
  }

  std::vector<Segment> segments_;
  std::vector<std::array<std::uint32_t, 2>> added_;
  std::vector<EdgeSpan> spans_;
  std::vector<Point3> points_;  // by vertex number
  std::optional<Geometry> geometry_;
  std::optional<VertexRow> vertices_;
};

TEST(EdgeContacts, AreThePointsThatSegmentsHaveInCommon) {
  std::mt19937 random(3);
  std::size_t ends = 0;
  std::size_t middles = 0;
  for (int round = 0; round < 60; ++round) {
    const Segments segments(random, 24);
    std::map<Segments::Pair, Point3> found;
    for (const EdgeContact& contact : segments.contacts(1)) {
      const Segments::Pair pair{std::min(contact.a, contact.b), std::max(contact.a, contact.b)};
      const Point3 position = segments.position(contact.point);
      EXPECT_TRUE(found.emplace(pair, position).second);
      const bool is_end =
          segments.is_end(contact.a, position) || segments.is_end(contact.b, position);
      ASSERT_EQ(contact.end.has_value(), is_end);
      if (contact.end) {
        EXPECT_EQ(segments.point(*contact.end), position);
      }
      ++(is_end ? ends : middles);
    }
    ASSERT_EQ(found, segments.expected()) << round;
  }
  EXPECT_GT(ends, 100);
  EXPECT_GT(middles, 100);
}

TEST(EdgeContacts, DoNotDependOnThreads) {
  std::mt19937 random(4);
  const Segments segments(random, 400);
  const std::vector<EdgeContact> one = segments.contacts(1);
  const std::vector<EdgeContact> three = segments.contacts(3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].a, three[i].a);
    EXPECT_EQ(one[i].b, three[i].b);
  }
}

// Contacts of different pairs in one point have different approximations of it.
TEST(VertexFinder, FindsTheSameVertexForEqualPositions) {
  std::mt19937 random(5);
  const Segments segments(random, 60);
  VertexRow middles(segments.geometry());
  for (const EdgeContact& contact : segments.contacts(1)) {
    if (!contact.end) middles.push_back(contact.point);
  }
  ASSERT_GT(middles.size(), 20);
  TierStatistics statistics;
  const VertexFinder equals(segments.geometry(), middles);
  const VertexFinder ends(segments.geometry(), segments.vertices());
  std::map<std::array<Rational, 3>, std::uint32_t> first;
  for (std::size_t i = 0; i < middles.size(); ++i) {
    const Vertex middle = middles[i];
    const Point3 position = segments.position(middle);
    const auto found = equals.find(middle, middles, statistics);
    ASSERT_TRUE(found);
    EXPECT_EQ(segments.position(middles[*found]), position);
    EXPECT_EQ(first.emplace(std::array{position.x, position.y, position.z}, *found).first->second,
              *found);
    const auto end = ends.find(middle, segments.vertices(), statistics);
    bool is_known = false;
    for (std::size_t v = 0; v < segments.vertices().size(); ++v) {
      is_known = is_known || segments.position(segments.vertices()[v]) == position;
    }
    ASSERT_EQ(end.has_value(), is_known);
    if (end) {
      EXPECT_EQ(segments.point(*end), position);
    }
  }
  EXPECT_LT(first.size(), middles.size());
}

}  // namespace
}  // namespace exactcsg
