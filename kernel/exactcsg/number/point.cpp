// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/point.hpp"

#include "exactcsg/number/products.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

std::strong_ordering ordering(int comparison) { return comparison <=> 0; }

void divide_by_common_factor(Plane& plane) {
  Integer factor = gcd(gcd(plane.a, plane.b), gcd(plane.c, plane.d));
  if (factor == 1) return;
  for (Integer* coefficient : {&plane.a, &plane.b, &plane.c, &plane.d}) {
    mpz_divexact(coefficient->get_mpz_t(), coefficient->get_mpz_t(), factor.get_mpz_t());
  }
}

std::string text_of(const Point3& p) {
  return '(' + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + ')';
}

using Row = std::array<Rational, 4>;

// The linear part's cofactor of row i, column j, with its sign.
Rational cofactor(const AffineMap& f, std::size_t i, std::size_t j) {
  const Row& r = f.m[(i + 1) % 3];
  const Row& s = f.m[(i + 2) % 3];
  const std::size_t k = (j + 1) % 3;
  const std::size_t l = (j + 2) % 3;
  Rational result;
  add_product(result, r[l], s[k]);
  result = -result;
  add_product(result, r[k], s[l]);
  return result;
}

}  // namespace

std::strong_ordering compare(const Point3& p, const Point3& q) {
  if (const int c = cmp(p.x, q.x); c != 0) return ordering(c);
  if (const int c = cmp(p.y, q.y); c != 0) return ordering(c);
  return ordering(cmp(p.z, q.z));
}

Vector3 operator-(const Point3& p, const Point3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
Point3 operator+(const Point3& p, const Vector3& v) { return {p.x + v.x, p.y + v.y, p.z + v.z}; }
Vector3 operator*(const Rational& s, const Vector3& v) { return {s * v.x, s * v.y, s * v.z}; }

Rational dot(const Vector3& u, const Vector3& v) { return u.x * v.x + u.y * v.y + u.z * v.z; }

Vector3 cross(const Vector3& u, const Vector3& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

void set_cross(std::array<Integer, 3>& result, const std::array<Integer, 3>& u,
               const std::array<Integer, 3>& v) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    mpz_mul(result[i].get_mpz_t(), u[j].get_mpz_t(), v[k].get_mpz_t());
    mpz_submul(result[i].get_mpz_t(), u[k].get_mpz_t(), v[j].get_mpz_t());
  }
}

AffineMap AffineMap::identity() {
  AffineMap map;
  for (std::size_t i = 0; i < 3; ++i) map.m[i][i] = 1;
  return map;
}

AffineMap operator*(const AffineMap& f, const AffineMap& g) {
  AffineMap product;
  for (std::size_t i = 0; i < 3; ++i) {
    const Row& row = f.m[i];
    for (std::size_t j = 0; j < 4; ++j) {
      Rational& entry = product.m[i][j];
      for (std::size_t k = 0; k < 3; ++k) add_product(entry, row[k], g.m[k][j]);
    }
    add_product(product.m[i][3], row[3], 1);
  }
  return product;
}

Point3 apply(const AffineMap& f, const Point3& p) {
  const auto coordinate = [&p](const Row& row) {
    Rational sum = row[3];
    add_product(sum, row[0], p.x);
    add_product(sum, row[1], p.y);
    add_product(sum, row[2], p.z);
    return sum;
  };
  return {coordinate(f.m[0]), coordinate(f.m[1]), coordinate(f.m[2])};
}

Rational determinant(const AffineMap& f) {
  Rational sum;
  for (std::size_t j = 0; j < 3; ++j) {
    if (sgn(f.m[0][j]) != 0) add_product(sum, f.m[0][j], cofactor(f, 0, j));
  }
  return sum;
}

AffineMap inverse(const AffineMap& f) {
  const Rational scale = 1 / determinant(f);
  AffineMap result;
  for (std::size_t i = 0; i < 3; ++i) {
    Row& row = result.m[i];
    for (std::size_t j = 0; j < 3; ++j) row[j] = cofactor(f, j, i) * scale;
    row[3] = -(row[0] * f.m[0][3] + row[1] * f.m[1][3] + row[2] * f.m[2][3]);
  }
  return result;
}

std::strong_ordering compare(const Plane& p, const Plane& q) {
  if (const int c = cmp(p.a, q.a); c != 0) return ordering(c);
  if (const int c = cmp(p.b, q.b); c != 0) return ordering(c);
  if (const int c = cmp(p.c, q.c); c != 0) return ordering(c);
  return ordering(cmp(p.d, q.d));
}

Plane opposite(const Plane& p) { return {-p.a, -p.b, -p.c, -p.d}; }

Plane make_plane(const Rational& a, const Rational& b, const Rational& c, const Rational& d) {
  if (a == 0 && b == 0 && c == 0) {
    throw Error(ErrorId::DegenerateHalfSpace,
                {"0 x + 0 y + 0 z + " + to_text(d) + " <= 0", "a normal that is not zero"});
  }
  const Integer common = lcm(lcm(a.get_den(), b.get_den()), lcm(c.get_den(), d.get_den()));
  const auto scaled = [&common](const Rational& value) {
    return Integer(value.get_num() * (common / value.get_den()));
  };
  Plane plane{scaled(a), scaled(b), scaled(c), scaled(d)};
  divide_by_common_factor(plane);
  return plane;
}

Plane plane_through(const Point3& p, const Point3& q, const Point3& r) {
  const Vector3 normal = cross(q - p, r - p);
  if (normal.x == 0 && normal.y == 0 && normal.z == 0) {
    throw Error(ErrorId::DegenerateFacet,
                {text_of(p) + ", " + text_of(q) + " and " + text_of(r) + " are collinear",
                 "three points that are not on one line"});
  }
  return make_plane(normal.x, normal.y, normal.z,
                    -(normal.x * p.x + normal.y * p.y + normal.z * p.z));
}

Sign side(const Plane& plane, const Point3& point) {
  return sign_of(Rational(plane.a * point.x + plane.b * point.y + plane.c * point.z + plane.d));
}

Plane apply(const AffineMap& f, const Plane& plane) {
  const Rational size = determinant(f);
  if (size == 0) {
    throw Error(ErrorId::SingularMap, {"a linear part of determinant 0", "an invertible map"});
  }
  // n.x + d = (n M^-1).(M x + t) + (d - (n M^-1).t), so that the image is {n M^-1, d - n M^-1 t}.
  // No sign changes: the value at the image of a point is the value at the point.
  const AffineMap back = inverse(f);
  const auto component = [&plane, &back](std::size_t j) {
    return Rational(plane.a * back.m[0][j] + plane.b * back.m[1][j] + plane.c * back.m[2][j]);
  };
  const Rational d = component(3) + plane.d;
  return make_plane(component(0), component(1), component(2), d);
}

}  // namespace exactcsg
