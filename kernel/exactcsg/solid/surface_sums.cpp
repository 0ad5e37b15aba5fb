// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/surface_sums.hpp"

#include <algorithm>
#include <utility>

namespace exactcsg {

namespace {

// Adds up in place: no temporary integers in the inner loop.
class SurfaceSummation {
 public:
  SurfaceSummation(const ScaledVertices& vertices, Wanted wanted, mp_bitcnt_t area_shift)
      : vertices_(vertices), wanted_(wanted) {
    sums_.area_shift = area_shift;
  }

  SurfaceSums of(const Boundary& boundary) {
    for (const BoundaryFace& face : boundary.faces) add_face(face);
    sums_.two_areas.error = cut_roots_;
    add_errors_of_vertices(sums_, vertices_, sides_);
    return std::move(sums_);
  }

 private:
  using Coordinates = std::array<Integer, 3>;

  void add_face(const BoundaryFace& face) {
    for (Integer& a : face_area_) a = 0;
    for (const auto& loop : face.loops) {
      add_loop(loop);
      sides_ += loop.size();
    }
    square_ = 0;
    for (const Integer& a : face_area_) {
      mpz_addmul(square_.get_mpz_t(), a.get_mpz_t(), a.get_mpz_t());
    }
    // That a number is no square is nearly always seen without its root.
    if (mpz_perfect_square_p(square_.get_mpz_t()) == 0) ++cut_roots_;
    square_ <<= 2 * sums_.area_shift;
    mpz_sqrt(root_.get_mpz_t(), square_.get_mpz_t());
    sums_.two_areas.value += root_;
  }

  // The fan of triangles first, first + u, first + v.
  void add_loop(const std::vector<std::uint32_t>& loop) {
    if (loop.size() < 3) return;
    set_coordinates(first_, vertices_, loop.front());
    loop_volume_ = 0;
    set_difference(u_, loop[1]);
    for (std::size_t k = 2; k < loop.size(); ++k) {
      set_difference(v_, loop[k]);
      set_cross(cross_, u_, v_);
      set_determinant();
      for (std::size_t i = 0; i < 3; ++i) face_area_[i] += cross_[i];
      loop_volume_ += determinant_;
      if (wanted_ == Wanted::Everything && sgn(determinant_) != 0) add_moments_beyond_first();
      u_.swap(v_);
    }
    sums_.six_volumes.value += loop_volume_;
    if (wanted_ == Wanted::Everything) add_moments_of_first();
  }

  // vertex - first
  void set_difference(Coordinates& result, std::uint32_t vertex) {
    set_coordinates(result, vertices_, vertex);
    for (std::size_t i = 0; i < 3; ++i) result[i] -= first_[i];
  }

  void set_determinant() {
    mpz_mul(determinant_.get_mpz_t(), first_[0].get_mpz_t(), cross_[0].get_mpz_t());
    for (std::size_t i = 1; i < 3; ++i) {
      mpz_addmul(determinant_.get_mpz_t(), first_[i].get_mpz_t(), cross_[i].get_mpz_t());
    }
  }

  // The tetrahedron origin, first, first + u, first + v has the moment det / 24 (3 first + u + v).
  void add_moments_beyond_first() {
    for (std::size_t i = 0; i < 3; ++i) {
      mpz_add(root_.get_mpz_t(), u_[i].get_mpz_t(), v_[i].get_mpz_t());
      mpz_addmul(sums_.moments[i].value.get_mpz_t(), determinant_.get_mpz_t(), root_.get_mpz_t());
    }
  }

  void add_moments_of_first() {
    loop_volume_ *= 3;
    for (std::size_t i = 0; i < 3; ++i) {
      mpz_addmul(sums_.moments[i].value.get_mpz_t(), first_[i].get_mpz_t(),
                 loop_volume_.get_mpz_t());
    }
  }

  const ScaledVertices& vertices_;
  Wanted wanted_;
  SurfaceSums sums_;
  std::uint64_t sides_ = 0;
  unsigned long cut_roots_ = 0;
  Coordinates face_area_;
  Coordinates first_;
  Coordinates u_;
  Coordinates v_;
  Coordinates cross_;
  Integer determinant_;
  Integer loop_volume_;
  Integer square_;
  Integer root_;
};

}  // namespace

SurfaceSums long_surface_sums(const Boundary& boundary, const ScaledVertices& vertices,
                              Wanted wanted, int bits) {
  // More bits for the roots, where the unit is coarse.
  const auto present = static_cast<int>(mpz_sizeinbase(vertices.largest.get_mpz_t(), 2));
  const auto area_shift = static_cast<mp_bitcnt_t>(std::max(0, bits - present));
  return SurfaceSummation(vertices, wanted, area_shift).of(boundary);
}

// Every coordinate and every difference of two is off by at most 1, and both the true and the cut
// ones are at most M + 1 in magnitude: a product of two is off by at most (M+1)^2 - M^2, of three
// by (M+1)^3 - M^3. A component of a cross product has two products, a determinant six, its
// moment six of four factors thrice; there are fewer triangles than sides.
void add_errors_of_vertices(SurfaceSums& sums, const ScaledVertices& vertices,
                            std::uint64_t side_count) {
  if (vertices.exact) return;
  const Integer& m = vertices.largest;
  const Integer n = m + 1;
  const Integer sides = static_cast<unsigned long>(side_count);
  const Integer two = n * n - m * m;
  const Integer three = n * n * n - m * m * m;
  const Integer four = n * n * n * n - m * m * m * m;
  // | |A| - |A'| | <= |A - A'| <= sqrt 3 times the largest component's error.
  sums.two_areas.error += (sides * 2 * 2 * two) << sums.area_shift;
  sums.six_volumes.error += sides * 6 * three;
  for (Bounded& moment : sums.moments) moment.error += sides * 18 * four;
}

}  // namespace exactcsg
