// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/boundary_classifier.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/facet_complex.hpp"

namespace exactcsg::verify {
namespace {

// Rays (1, s, t) with small unrelated slopes: they rarely meet edges of designed models.
struct Direction {
  int s;
  int t;
};
constexpr int slope_unit = 1 << 20;
constexpr Direction directions[] = {{37'571, 61'283},   {-52'951, 29'983},  {71'881, -43'591},
                                    {-19'273, -67'219}, {93'257, 15'607},   {-83'401, 88'609},
                                    {11'057, -97'943},  {-64'189, -33'013}, {126'001, 118'903}};

struct Rectangle {
  double low[3] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  double high[3] = {-std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};
  void add(std::size_t k, double value, double slack) {
    low[k] = std::min(low[k], value - slack);
    high[k] = std::max(high[k], value + slack);
  }
  bool has(std::size_t k, double value) const { return low[k] <= value && value <= high[k]; }
};

enum class Place { Outside, Border, Inside };

// Where a point of the face's plane lies in the face, in the projection along axis `drop`.
Place locate(const Boundary& b, const BoundaryFace& face, const Point3& p, std::size_t drop) {
  const std::size_t u = (drop + 1) % 3;
  const std::size_t v = (drop + 2) % 3;
  const Rational pu = coordinate(p, u);
  const Rational pv = coordinate(p, v);
  bool inside = false;
  for (const auto& loop : face.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Point3& a = b.vertices[loop[i]];
      const Point3& c = b.vertices[loop[(i + 1) % loop.size()]];
      const Rational av = coordinate(a, v);
      const Rational cv = coordinate(c, v);
      const bool spans = (av <= pv && pv <= cv) || (cv <= pv && pv <= av);
      if (!spans) continue;
      const Rational au = coordinate(a, u);
      const Rational cu = coordinate(c, u);
      const Rational turn = (cu - au) * (pv - av) - (cv - av) * (pu - au);
      if (turn == 0 && ((au <= pu && pu <= cu) || (cu <= pu && pu <= au))) return Place::Border;
      if ((av > pv) == (cv > pv)) continue;
      // Left of an upward side, or right of a downward one: the side is crossed by the ray to +u.
      if ((turn > 0) == (cv > av)) inside = !inside;
    }
  }
  return inside ? Place::Inside : Place::Outside;
}

std::size_t dropped_axis(const Plane& plane) { return plane.c != 0 ? 2 : plane.b != 0 ? 1 : 0; }

Rational value_at(const Plane& plane, const Point3& p) {
  return plane.a * p.x + plane.b * p.y + plane.c * p.z + plane.d;
}

}  // namespace

struct BoundaryClassifier::Data {
  const Boundary& boundary;
  const std::vector<Plane> planes;
  double slack = 0;                             // of doubles, relative to the size of the model
  std::vector<Rectangle> boxes;                 // of each face in space
  std::vector<std::vector<Rectangle>> shadows;  // of each face along each direction

  explicit Data(const Boundary& b) : boundary(b), planes(exact_planes(b)) {
    double size = 0;
    for (const Point3& p : b.vertices) {
      for (const double c : approximate(p)) size = std::max(size, std::abs(c));
    }
    slack = size * 1e-12;
    for (const BoundaryFace& face : b.faces) {
      Rectangle box;
      std::vector<Rectangle> shadow(std::size(directions));
      for (const auto& loop : face.loops) {
        for (const std::uint32_t v : loop) {
          const auto p = verify::approximate(b.vertices[v]);
          for (std::size_t k = 0; k < 3; ++k) box.add(k, p[k], slack);
          for (std::size_t d = 0; d < std::size(directions); ++d) {
            const auto q = shadow_of(p, directions[d]);
            shadow[d].add(0, q[0], slack);
            shadow[d].add(1, q[1], slack);
          }
        }
      }
      boxes.push_back(box);
      shadows.push_back(std::move(shadow));
    }
  }

  static std::array<double, 2> shadow_of(const std::array<double, 3>& p, const Direction& d) {
    return {p[1] - p[0] * d.s / slope_unit, p[2] - p[0] * d.t / slope_unit};
  }

  bool is_on(const Point3& p, const std::array<double, 3>& at) const {
    for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
      if (!boxes[f].has(0, at[0]) || !boxes[f].has(1, at[1]) || !boxes[f].has(2, at[2])) continue;
      const BoundaryFace& face = boundary.faces[f];
      const Plane& plane = planes[face.plane];
      if (side(plane, p) != Sign::Zero) continue;
      if (locate(boundary, face, p, dropped_axis(plane)) != Place::Outside) return true;
    }
    return false;
  }

  // nullopt: the ray meets an edge, or runs in a face's plane.
  std::optional<bool> parity(const Point3& p, const std::array<double, 3>& at,
                             std::size_t d) const {
    const auto shadow = shadow_of(at, directions[d]);
    const Vector3 ray{Rational(slope_unit), Rational(directions[d].s), Rational(directions[d].t)};
    bool inside = false;
    for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
      const Rectangle& box = shadows[f][d];
      if (!box.has(0, shadow[0]) || !box.has(1, shadow[1]) || boxes[f].high[0] < at[0]) continue;
      const BoundaryFace& face = boundary.faces[f];
      const Plane& plane = planes[face.plane];
      const Rational speed = plane.a * ray.x + plane.b * ray.y + plane.c * ray.z;
      const Rational value = value_at(plane, p);
      if (speed == 0) {
        if (value == 0) return std::nullopt;
        continue;
      }
      const Rational time = -value / speed;
      if (time <= 0) continue;
      const Place place = locate(boundary, face, p + time * ray, dropped_axis(plane));
      if (place == Place::Border) return std::nullopt;
      if (place == Place::Inside) inside = !inside;
    }
    return inside;
  }
};

BoundaryClassifier::BoundaryClassifier(const Boundary& boundary)
    : data_(std::make_unique<const Data>(boundary)) {}
BoundaryClassifier::~BoundaryClassifier() = default;
BoundaryClassifier::BoundaryClassifier(BoundaryClassifier&&) noexcept = default;
BoundaryClassifier& BoundaryClassifier::operator=(BoundaryClassifier&&) noexcept = default;

PointClass BoundaryClassifier::operator()(const Point3& point) const {
  const auto at = approximate(point);
  if (data_->is_on(point, at)) return PointClass::On;
  for (std::size_t d = 0; d < std::size(directions); ++d) {
    if (const auto inside = data_->parity(point, at, d)) {
      return *inside ? PointClass::In : PointClass::Out;
    }
  }
  throw Error(ErrorId::InternalError, {"every ray from " + describe(point) + " meets an edge", ""});
}

}  // namespace exactcsg::verify
