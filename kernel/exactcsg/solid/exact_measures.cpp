// SPDX-License-Identifier: Apache-2.0
// Volume, area and centre of mass as rationals.
//
// The cone from the origin over the triangle p, q, r has the volume det(p, q, r) / 6 and the first
// moments det(p, q, r) (p + q + r) / 24; a loop is a fan of triangles, in which parts outside the
// face cancel. Corners are integers over one common denominator each, so that a triangle costs
// integer products and one reduced fraction. The area of a face in n . x + d = 0 is that of its
// projection along a coordinate k with n_k != 0, times |n| / n_k.
//
// Where the coordinates have a short common denominator, the integer sums of measures.cpp are exact
// already. Elsewhere terms are added by divide and conquer, depth first: as soon as a partial sum
// is too long, the work ends, long before the long sums at the top are made. Faces are taken in the
// canonical order, in which neighbours are near each other: what they add has common denominators.

#include <algorithm>
#include <functional>
#include <utility>

#include "exactcsg/number/homogeneous.hpp"
#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/solid/measures.hpp"
#include "exactcsg/solid/scaled_vertices.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

struct TooLong {};

template <std::size_t N>
using Sums = std::array<Rational, N>;

std::size_t length(const Rational& r) {
  return std::max(mpz_sizeinbase(r.get_num_mpz_t(), 2), mpz_sizeinbase(r.get_den_mpz_t(), 2));
}

// term(i) for begin <= i < end, added up. Recursion is as deep as the logarithm of their number.
template <std::size_t N, class Term>
Sums<N> add_up(std::size_t begin, std::size_t end, std::size_t bit_limit, const Term& term) {
  if (end - begin == 1) return term(begin);
  const std::size_t middle = begin + (end - begin) / 2;
  Sums<N> sum = add_up<N>(begin, middle, bit_limit, term);
  const Sums<N> rest = add_up<N>(middle, end, bit_limit, term);
  for (std::size_t i = 0; i < N; ++i) {
    sum[i] += rest[i];
    if (length(sum[i]) > bit_limit) throw TooLong();
  }
  return sum;
}

const Integer& normal(const Plane& plane, std::size_t axis) {
  return axis == 0 ? plane.a : axis == 1 ? plane.b : plane.c;
}

// The coordinate that the normal leans to most.
std::size_t steepest_axis(const Plane& plane) {
  std::size_t k = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (mpz_cmpabs(normal(plane, i).get_mpz_t(), normal(plane, k).get_mpz_t()) > 0) k = i;
  }
  return k;
}

// Twice the area of the projection along a coordinate.
Rational projected_area(const Boundary& boundary, const BoundaryFace& face, std::size_t along,
                        std::size_t bit_limit) {
  const std::size_t u = (along + 1) % 3;
  const std::size_t v = (along + 2) % 3;
  Rational total;
  for (const auto& loop : face.loops) {
    const Point3& o = boundary.vertices[loop.front()];
    total += add_up<1>(0, loop.size(), bit_limit, [&](std::size_t i) {
      const Vector3 p = boundary.vertices[loop[i]] - o;
      const Vector3 q = boundary.vertices[loop[(i + 1) % loop.size()]] - o;
      return Sums<1>{
          Rational(coordinate(p, u) * coordinate(q, v) - coordinate(p, v) * coordinate(q, u))};
    })[0];
  }
  return total;
}

using HomogeneousPoint = Homogeneous<Integer>;

// The vertices, each brought to a common denominator when it is first asked for.
class HomogeneousVertices {
 public:
  explicit HomogeneousVertices(const Boundary& boundary)
      : boundary_(boundary), known_(boundary.vertices.size()) {}
  const Boundary& boundary() const { return boundary_; }

  const HomogeneousPoint& of(std::uint32_t vertex) {
    HomogeneousPoint& found = known_[vertex];
    if (found.w == 0) found = homogeneous_of(boundary_.vertices[vertex]);
    return found;
  }

 private:
  const Boundary& boundary_;
  std::vector<HomogeneousPoint> known_;
};

Integer determinant(const HomogeneousPoint& p, const HomogeneousPoint& q,
                    const HomogeneousPoint& r) {
  return p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) +
         p.z * (q.x * r.y - q.y * r.x);
}

Rational quotient(Integer numerator, Integer denominator) {
  Rational result;
  result.get_num() = std::move(numerator);
  result.get_den() = std::move(denominator);
  result.canonicalize();
  return result;
}

// Six volumes, and for N == 4 also 24 first moments, of the cone from the origin.
template <std::size_t N>
Sums<N> cone_over(const HomogeneousPoint& p, const HomogeneousPoint& q, const HomogeneousPoint& r) {
  Sums<N> sums;
  const Integer six_volumes = determinant(p, q, r);
  if (six_volumes == 0) return sums;
  const Integer scale = p.w * q.w * r.w;
  sums[0] = quotient(six_volumes, scale);
  for (std::size_t i = 1; i < N; ++i) {
    const auto axis = static_cast<Axis>(i - 1);
    const Integer sum = coordinate(p, axis) * q.w * r.w + coordinate(q, axis) * r.w * p.w +
                        coordinate(r, axis) * p.w * q.w;
    sums[i] = quotient(six_volumes * sum, scale * scale);
  }
  return sums;
}

template <std::size_t N>
Sums<N> cone_over(HomogeneousVertices& vertices, const BoundaryFace& face, std::size_t bit_limit) {
  Sums<N> total;
  for (const auto& loop : face.loops) {
    const Sums<N> sums = add_up<N>(2, loop.size(), bit_limit, [&](std::size_t i) {
      return cone_over<N>(vertices.of(loop[0]), vertices.of(loop[i - 1]), vertices.of(loop[i]));
    });
    for (std::size_t i = 0; i < N; ++i) total[i] += sums[i];
  }
  return total;
}

std::size_t longest_denominator(const Boundary& boundary, const BoundaryFace& face) {
  std::size_t longest = 0;
  for (const std::uint32_t v : face.loops.front()) {
    longest = std::max(longest, denominator_bits(boundary.vertices.view(v)[0]));
  }
  return longest;
}

// Faces of short vertices keep partial sums short for a long time, so the others come first: where
// the volume is hopelessly long, these few nearly always say so.
void try_longest_faces(HomogeneousVertices& vertices, std::size_t bit_limit) {
  const Boundary& boundary = vertices.boundary();
  constexpr std::size_t some = 512;
  if (boundary.faces.size() <= some) return;
  std::vector<std::pair<std::size_t, std::size_t>> longest;
  longest.reserve(boundary.faces.size());
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    longest.emplace_back(longest_denominator(boundary, boundary.faces[f]), f);
  }
  std::partial_sort(longest.begin(), longest.begin() + some, longest.end(), std::greater<>());
  add_up<1>(0, some, bit_limit, [&](std::size_t i) {
    return cone_over<1>(vertices, boundary.faces[longest[i].second], bit_limit);
  });
}

std::optional<Rational> within(Rational value, std::size_t bit_limit) {
  if (length(value) > bit_limit) return std::nullopt;
  return value;
}

// The integer sums need few bits of "working precision" if they are exact.
constexpr int any_bits = 64;

}  // namespace

std::optional<Rational> exact_volume(const Boundary& boundary, std::size_t bit_limit) {
  if (boundary.empty()) return Rational(0);
  if (has_short_common_denominator(boundary)) {
    return within(enclose_volume(boundary, any_bits).lower, bit_limit);
  }
  try {
    HomogeneousVertices vertices(boundary);
    try_longest_faces(vertices, bit_limit);
    const Sums<1> sums = add_up<1>(0, boundary.faces.size(), bit_limit, [&](std::size_t f) {
      return cone_over<1>(vertices, boundary.faces[f], bit_limit);
    });
    return sums[0] / 6;
  } catch (const TooLong&) {
    return std::nullopt;
  }
}

std::optional<Rational> exact_area(const Boundary& boundary, std::size_t bit_limit) {
  std::vector<Plane> planes(boundary.plane_count);
  std::vector<Rational> stretch(boundary.plane_count);  // |n| / n_k
  for (const BoundaryFace& face : boundary.faces) {
    if (stretch[face.plane] != 0) continue;
    // One by one: nearly always the first says that there is no exact area.
    Plane& plane = planes[face.plane];
    plane = exact_plane(boundary, face);
    const Integer square = plane.a * plane.a + plane.b * plane.b + plane.c * plane.c;
    if (mpz_perfect_square_p(square.get_mpz_t()) == 0) return std::nullopt;
    stretch[face.plane] = Rational(Integer(sqrt(square)), normal(plane, steepest_axis(plane)));
    stretch[face.plane].canonicalize();
  }
  if (boundary.empty()) return Rational(0);
  if (has_short_common_denominator(boundary)) {
    const Enclosure area = enclose_area(boundary, any_bits);
    if (area.lower == area.upper) return within(area.lower, bit_limit);
  }
  try {
    return add_up<1>(0, boundary.faces.size(), bit_limit, [&](std::size_t f) {
      const BoundaryFace& face = boundary.faces[f];
      const std::size_t k = steepest_axis(planes[face.plane]);
      const Rational twice = projected_area(boundary, face, k, bit_limit);
      return Sums<1>{Rational(twice * stretch[face.plane] / 2)};
    })[0];
  } catch (const TooLong&) {
    return std::nullopt;
  }
}

std::optional<Point3> exact_centroid(const Boundary& boundary, std::size_t bit_limit) {
  if (boundary.empty()) throw Error(ErrorId::EmptySolid, {"the centre of mass of nothing", ""});
  if (has_short_common_denominator(boundary)) {
    const std::array<Enclosure, 3> centroid = enclose_centroid(boundary, any_bits);
    for (const Enclosure& c : centroid) {
      if (length(c.lower) > bit_limit) return std::nullopt;
    }
    return Point3{centroid[0].lower, centroid[1].lower, centroid[2].lower};
  }
  try {
    HomogeneousVertices vertices(boundary);
    const Sums<4> sums = add_up<4>(0, boundary.faces.size(), bit_limit, [&](std::size_t f) {
      return cone_over<4>(vertices, boundary.faces[f], bit_limit);
    });
    const Rational four_times = 4 * sums[0];
    return Point3{sums[1] / four_times, sums[2] / four_times, sums[3] / four_times};
  } catch (const TooLong&) {
    return std::nullopt;
  }
}

}  // namespace exactcsg
