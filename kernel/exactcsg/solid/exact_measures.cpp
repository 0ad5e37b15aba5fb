// SPDX-License-Identifier: Apache-2.0
// Volume, area and centre of mass as rationals.
//
// A face in n . q + d = 0 (q from a vertex o of the solid) projected along a coordinate k with
// n_k != 0 has the signed area A_k; its cone from o has the volume -d / (3 n_k) A_k, its area is
// A_k |n| / n_k, and the first moments of its cone are -d / (4 n_k) times those of the projection.
// So all sums are sums of products of two or three coordinates.
//
// Where the coordinates have a short common denominator, the integer sums of measures.cpp are exact
// already. Elsewhere terms are added by divide and conquer, depth first: as soon as a partial sum
// is too long, the work ends, long before the long sums at the top are made; so planes are computed
// one by one, since those of all faces are more work than all the rest. Faces are taken in the
// canonical order, in which neighbours are near each other: what they add has common denominators.

#include <algorithm>
#include <utility>

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

// A plane with its coefficients by coordinate and the constant with respect to the reference.
struct LocalPlane {
  std::array<const Integer*, 3> normal;
  Rational offset;
  std::size_t k = 0;
};

LocalPlane local_plane(const Plane& plane, const Point3& reference) {
  LocalPlane local{{&plane.a, &plane.b, &plane.c},
                   plane.a * reference.x + plane.b * reference.y + plane.c * reference.z + plane.d,
                   0};
  for (std::size_t i = 1; i < 3; ++i) {
    if (mpz_cmpabs(local.normal[i]->get_mpz_t(), local.normal[local.k]->get_mpz_t()) > 0) {
      local.k = i;
    }
  }
  return local;
}

// Twice the projected area and six times the first moments of the projection, in coordinates
// k + 1 and k + 2, from the reference.
template <std::size_t N>
Sums<N> projected_sums(const Boundary& boundary, const BoundaryFace& face, std::size_t k,
                       std::size_t bit_limit) {
  const Point3& o = boundary.vertices.front();
  const std::size_t u = (k + 1) % 3;
  const std::size_t v = (k + 2) % 3;
  Sums<N> total;
  for (const auto& loop : face.loops) {
    const Sums<N> sums = add_up<N>(0, loop.size(), bit_limit, [&](std::size_t i) {
      const Vector3 p = boundary.vertices[loop[i]] - o;
      const Vector3 q = boundary.vertices[loop[(i + 1) % loop.size()]] - o;
      Sums<N> term;
      term[0] = coordinate(p, u) * coordinate(q, v) - coordinate(p, v) * coordinate(q, u);
      if constexpr (N == 3) {
        term[1] = term[0] * (coordinate(p, u) + coordinate(q, u));
        term[2] = term[0] * (coordinate(p, v) + coordinate(q, v));
      }
      return term;
    });
    for (std::size_t i = 0; i < N; ++i) total[i] += sums[i];
  }
  return total;
}

Rational face_volume(const Boundary& boundary, const BoundaryFace& face, std::size_t bit_limit) {
  const Plane exact = exact_plane(boundary, face);
  const LocalPlane plane = local_plane(exact, boundary.vertices.front());
  if (plane.offset == 0) return 0;
  const Sums<1> sums = projected_sums<1>(boundary, face, plane.k, bit_limit);
  return -plane.offset * sums[0] / (6 * *plane.normal[plane.k]);
}

// Volume and first moments of the cone from the reference.
Sums<4> face_moments(const Boundary& boundary, const BoundaryFace& face, std::size_t bit_limit) {
  const Plane exact = exact_plane(boundary, face);
  const LocalPlane plane = local_plane(exact, boundary.vertices.front());
  if (plane.offset == 0) return {};
  const std::size_t k = plane.k;
  const std::size_t u = (k + 1) % 3;
  const std::size_t v = (k + 2) % 3;
  const Sums<3> sums = projected_sums<3>(boundary, face, k, bit_limit);
  const Rational area = sums[0] / 2;
  std::array<Rational, 3> first;
  first[u] = sums[1] / 6;
  first[v] = sums[2] / 6;
  first[k] = -(*plane.normal[u] * first[u] + *plane.normal[v] * first[v] + plane.offset * area) /
             *plane.normal[k];
  const Rational height = -plane.offset / *plane.normal[k];
  return {height * area / 3, height * first[0] / 4, height * first[1] / 4, height * first[2] / 4};
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
    return add_up<1>(0, boundary.faces.size(), bit_limit, [&](std::size_t f) {
      return Sums<1>{face_volume(boundary, boundary.faces[f], bit_limit)};
    })[0];
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
    const LocalPlane local = local_plane(plane, boundary.vertices.front());
    stretch[face.plane] = Rational(Integer(sqrt(square)), *local.normal[local.k]);
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
      const std::size_t k = local_plane(planes[face.plane], boundary.vertices.front()).k;
      const Sums<1> sums = projected_sums<1>(boundary, face, k, bit_limit);
      return Sums<1>{Rational(sums[0] * stretch[face.plane] / 2)};
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
    const Sums<4> sums = add_up<4>(0, boundary.faces.size(), bit_limit, [&](std::size_t f) {
      return face_moments(boundary, boundary.faces[f], bit_limit);
    });
    const Point3& o = boundary.vertices.front();
    return Point3{o.x + sums[1] / sums[0], o.y + sums[2] / sums[0], o.z + sums[3] / sums[0]};
  } catch (const TooLong&) {
    return std::nullopt;
  }
}

}  // namespace exactcsg
