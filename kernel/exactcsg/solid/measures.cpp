// SPDX-License-Identifier: Apache-2.0
// Enclosures of volume, area and centre of mass by integer sums over the faces' loops.
#include "exactcsg/solid/measures.hpp"

#include <algorithm>
#include <bit>

#include "exactcsg/solid/scaled_vertices.hpp"
#include "exactcsg/solid/surface_sums.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

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

}  // namespace

MeasureEnclosures enclose_measures(const Boundary& boundary, int bits, Wanted wanted) {
  if (boundary.empty()) return {{0, 0}, {0, 0}, std::nullopt};
  const int grid = grid_bits(boundary, bits);
  const ScaledVertices vertices = scale_vertices(boundary, grid);
  std::optional<SurfaceSums> short_sums = short_surface_sums(boundary, vertices, wanted, grid);
  const SurfaceSums sums =
      short_sums ? std::move(*short_sums) : long_surface_sums(boundary, vertices, wanted, grid);
  const Rational& unit = vertices.unit;
  MeasureEnclosures result;
  result.volume = at_least_zero(scaled(sums.six_volumes, unit * unit * unit / 6));
  Rational area_unit = unit * unit;
  mpq_div_2exp(area_unit.get_mpq_t(), area_unit.get_mpq_t(), sums.area_shift + 1);
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

Enclosure enclose_volume(const Boundary& boundary, int bits) {
  return enclose_measures(boundary, bits, Wanted::VolumeAndArea).volume;
}

Enclosure enclose_area(const Boundary& boundary, int bits) {
  return enclose_measures(boundary, bits, Wanted::VolumeAndArea).area;
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
