// SPDX-License-Identifier: Apache-2.0
// Enclosures of volume, area and centre of mass by integer sums over the faces' loops.
//
// A loop v_0 ... v_n of a face is the fan of the triangles v_0, v_i, v_(i+1), signed: their cross
// products add up to the doubled vector area, and v_0 . (cross product) to six times the volume
// (divergence theorem, cones from the origin).
#include "exactcsg/solid/measures.hpp"

#include <algorithm>
#include <bit>

#include "exactcsg/solid/scaled_vertices.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

enum class Wanted { VolumeAndArea, Everything };

// Integers in powers of the unit, each with a bound on its error: |true - value| <= error.
struct Bounded {
  Integer value = 0;
  Integer error = 0;
};

struct SurfaceSums {
  Bounded six_volumes;
  Bounded two_areas;               // in parts of 2^-area_shift
  std::array<Bounded, 3> moments;  // 24 times the integral of the coordinate over the solid
};

// Adds up in place: no temporary integers in the inner loop.
class SurfaceSummation {
 public:
  // area_shift: more bits for square roots, where the unit is coarse
  SurfaceSummation(const ScaledVertices& vertices, Wanted wanted, mp_bitcnt_t area_shift)
      : vertices_(vertices), wanted_(wanted), area_shift_(area_shift) {}

  SurfaceSums of(const Boundary& boundary) {
    for (const BoundaryFace& face : boundary.faces) add_face(face);
    set_errors();
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
    square_ <<= 2 * area_shift_;
    mpz_sqrt(root_.get_mpz_t(), square_.get_mpz_t());
    sums_.two_areas.value += root_;
  }

  // The fan of triangles first, first + u, first + v.
  void add_loop(const std::vector<std::uint32_t>& loop) {
    if (loop.size() < 3) return;
    const Coordinates& first = vertices_.coordinates[loop.front()];
    loop_volume_ = 0;
    set_difference(u_, vertices_.coordinates[loop[1]], first);
    for (std::size_t k = 2; k < loop.size(); ++k) {
      set_difference(v_, vertices_.coordinates[loop[k]], first);
      set_cross(cross_, u_, v_);
      set_determinant(first);
      for (std::size_t i = 0; i < 3; ++i) face_area_[i] += cross_[i];
      loop_volume_ += determinant_;
      if (wanted_ == Wanted::Everything && sgn(determinant_) != 0) add_moments_beyond_first();
      u_.swap(v_);
    }
    sums_.six_volumes.value += loop_volume_;
    if (wanted_ == Wanted::Everything) add_moments_of_first(first);
  }

  static void set_difference(Coordinates& result, const Coordinates& p, const Coordinates& q) {
    for (std::size_t i = 0; i < 3; ++i) {
      mpz_sub(result[i].get_mpz_t(), p[i].get_mpz_t(), q[i].get_mpz_t());
    }
  }

  void set_determinant(const Coordinates& first) {
    mpz_mul(determinant_.get_mpz_t(), first[0].get_mpz_t(), cross_[0].get_mpz_t());
    for (std::size_t i = 1; i < 3; ++i) {
      mpz_addmul(determinant_.get_mpz_t(), first[i].get_mpz_t(), cross_[i].get_mpz_t());
    }
  }

  // The tetrahedron origin, first, first + u, first + v has the moment det / 24 (3 first + u + v).
  void add_moments_beyond_first() {
    for (std::size_t i = 0; i < 3; ++i) {
      mpz_add(root_.get_mpz_t(), u_[i].get_mpz_t(), v_[i].get_mpz_t());
      mpz_addmul(sums_.moments[i].value.get_mpz_t(), determinant_.get_mpz_t(), root_.get_mpz_t());
    }
  }

  void add_moments_of_first(const Coordinates& first) {
    loop_volume_ *= 3;
    for (std::size_t i = 0; i < 3; ++i) {
      mpz_addmul(sums_.moments[i].value.get_mpz_t(), first[i].get_mpz_t(),
                 loop_volume_.get_mpz_t());
    }
  }

  // Every coordinate and every difference of two is off by at most 1, and both the true and the cut
  // ones are at most M + 1 in magnitude: a product of two is off by at most (M+1)^2 - M^2, of three
  // by (M+1)^3 - M^3. A component of a cross product has two products, a determinant six, its
  // moment six of four factors thrice; there are fewer triangles than sides.
  void set_errors() {
    sums_.two_areas.error = cut_roots_;
    if (vertices_.exact) return;
    const Integer& m = vertices_.largest;
    const Integer n = m + 1;
    const Integer sides = static_cast<unsigned long>(sides_);
    const Integer two = n * n - m * m;
    const Integer three = n * n * n - m * m * m;
    const Integer four = n * n * n * n - m * m * m * m;
    // | |A| - |A'| | <= |A - A'| <= sqrt 3 times the largest component's error.
    sums_.two_areas.error += (sides * 2 * 2 * two) << area_shift_;
    sums_.six_volumes.error = sides * 6 * three;
    for (Bounded& moment : sums_.moments) moment.error = sides * 18 * four;
  }

  const ScaledVertices& vertices_;
  Wanted wanted_;
  mp_bitcnt_t area_shift_;
  SurfaceSums sums_;
  std::uint64_t sides_ = 0;
  unsigned long cut_roots_ = 0;
  Coordinates face_area_;
  Coordinates u_;
  Coordinates v_;
  Coordinates cross_;
  Integer determinant_;
  Integer loop_volume_;
  Integer square_;
  Integer root_;
};

Enclosure scaled(const Bounded& sum, const Rational& factor) {
  return {(sum.value - sum.error) * factor, (sum.value + sum.error) * factor};
}

Enclosure at_least_zero(Enclosure e) {
  if (e.lower < 0) e.lower = 0;
  return e;
}

// origin + unit * moments / (4 six_volumes), or the bounding cube where the volume is not known to
// be positive.
Enclosure centroid_coordinate(const Bounded& moment, const Bounded& six_volumes,
                              const Rational& origin, const ScaledVertices& vertices) {
  const Integer low = 4 * (six_volumes.value - six_volumes.error);
  const Integer high = 4 * (six_volumes.value + six_volumes.error);
  const Integer most = vertices.largest + 1;
  Rational lower = 0;
  Rational upper = most;
  if (low > 0) {
    // The moments are not negative, all coordinates being in [0, most].
    const Integer least_moment = std::max<Integer>(0, moment.value - moment.error);
    lower = Rational(least_moment, high);
    lower.canonicalize();
    Rational largest(Integer(moment.value + moment.error), low);
    largest.canonicalize();
    if (largest < upper) upper = largest;
  }
  return {origin + vertices.unit * lower, origin + vertices.unit * upper};
}

// Enough more bits that the sums over all sides keep `bits` of them.
int grid_bits(const Boundary& boundary, int bits) {
  return bits + static_cast<int>(std::bit_width(boundary.edges.size())) + 4;
}

MeasureEnclosures enclose(const Boundary& boundary, int bits, Wanted wanted) {
  if (boundary.empty()) return {{0, 0}, {0, 0}, std::nullopt};
  const int grid = grid_bits(boundary, bits);
  const ScaledVertices vertices = scale_vertices(boundary, grid);
  const auto present = static_cast<int>(mpz_sizeinbase(vertices.largest.get_mpz_t(), 2));
  const auto area_shift = static_cast<mp_bitcnt_t>(std::max(0, grid - present));
  const SurfaceSums sums = SurfaceSummation(vertices, wanted, area_shift).of(boundary);
  const Rational& unit = vertices.unit;
  MeasureEnclosures result;
  result.volume = at_least_zero(scaled(sums.six_volumes, unit * unit * unit / 6));
  Rational area_unit = unit * unit;
  mpq_div_2exp(area_unit.get_mpq_t(), area_unit.get_mpq_t(), area_shift + 1);
  result.area = at_least_zero(scaled(sums.two_areas, area_unit));
  if (wanted == Wanted::Everything) {
    const std::array<Rational, 3> origin{vertices.origin.x, vertices.origin.y, vertices.origin.z};
    result.centroid.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
      (*result.centroid)[i] =
          centroid_coordinate(sums.moments[i], sums.six_volumes, origin[i], vertices);
    }
  }
  return result;
}

}  // namespace

Enclosure enclose_volume(const Boundary& boundary, int bits) {
  return enclose(boundary, bits, Wanted::VolumeAndArea).volume;
}

Enclosure enclose_area(const Boundary& boundary, int bits) {
  return enclose(boundary, bits, Wanted::VolumeAndArea).area;
}

MeasureEnclosures enclose_measures(const Boundary& boundary, int bits) {
  return enclose(boundary, bits, Wanted::Everything);
}

std::array<Enclosure, 3> enclose_centroid(const Boundary& boundary, int bits) {
  const MeasureEnclosures all = enclose_measures(boundary, bits);
  if (!all.centroid) throw Error(ErrorId::EmptySolid, {"the centre of mass of nothing", ""});
  return *all.centroid;
}

std::optional<BoundingBox> bounding_box(const Boundary& boundary) {
  if (boundary.vertices.empty()) return std::nullopt;
  const CoordinateRange x = coordinate_range(boundary, 0);
  const CoordinateRange y = coordinate_range(boundary, 1);
  const CoordinateRange z = coordinate_range(boundary, 2);
  return BoundingBox{{x.lowest, y.lowest, z.lowest}, {x.highest, y.highest, z.highest}};
}

}  // namespace exactcsg
