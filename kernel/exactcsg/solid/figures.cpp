// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/figures.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>

#include "exactcsg/solid/numbered_sides.hpp"

namespace exactcsg {

namespace {

// Enclosures by precision, each computed once for all figures.
class Refinement {
 public:
  Refinement(const Boundary& boundary, Wanted wanted) : boundary_(boundary), wanted_(wanted) {}
  const Boundary& boundary() const { return boundary_; }
  const MeasureEnclosures& at(int bits) {
    const auto found = known_.find(bits);
    if (found != known_.end()) return found->second;
    return known_.emplace(bits, enclose_measures(boundary_, bits, wanted_)).first->second;
  }

 private:
  const Boundary& boundary_;
  Wanted wanted_;
  std::map<int, MeasureEnclosures> known_;
};

constexpr int maximal_bits = 5000;
constexpr std::size_t exact_bits_to_break_ties = 1U << 16U;

// Partial sums may be so much longer than the sum itself, as those of cooling_tower.csg are.
constexpr std::size_t longer_on_the_way = 16;

int first_bits_for(int digits) { return 32 + (digits * 10 + 2) / 3; }

// The enclosure, which is asked for anyway, is often exact already.
std::optional<Rational> volume_within(Refinement& refinement, int digits, std::size_t bit_limit) {
  const Enclosure& volume = refinement.at(first_bits_for(digits)).volume;
  std::optional<Rational> found = volume.lower;
  if (volume.lower != volume.upper) {
    found = exact_volume(refinement.boundary(), longer_on_the_way * bit_limit);
  }
  if (!found) return std::nullopt;
  const Rational& exact = *found;
  const std::size_t bits =
      std::max(mpz_sizeinbase(exact.get_num_mpz_t(), 2), mpz_sizeinbase(exact.get_den_mpz_t(), 2));
  if (bits > bit_limit) return std::nullopt;
  return exact;
}

using MaybeRational = std::function<std::optional<Rational>()>;

// `by_symmetry` is asked as soon as the digits are not decided, `exactly` after one more try.
std::string decide(Refinement& refinement, int digits, const std::string& name,
                   const std::function<Enclosure(const MeasureEnclosures&)>& figure,
                   const MaybeRational& by_symmetry, const MaybeRational& exactly,
                   std::vector<std::string>& unproved) {
  const int first_bits = first_bits_for(digits);
  bool tried = false;
  for (int bits = first_bits;; bits *= 2) {
    const Enclosure e = figure(refinement.at(bits));
    std::string lower = to_decimal(e.lower, digits);
    if (e.lower == e.upper || lower == to_decimal(e.upper, digits)) return lower;
    if (bits == first_bits) {
      if (const std::optional<Rational> exact = by_symmetry()) return to_decimal(*exact, digits);
    }
    // One undecided digit may be bad luck; twice, it is a tie or a zero, and exact sums decide.
    if (bits > first_bits && !tried) {
      tried = true;
      if (const std::optional<Rational> exact = exactly()) return to_decimal(*exact, digits);
    }
    if (bits > std::max(maximal_bits, 8 * digits)) {
      const Rational width = e.upper - e.lower;
      unproved.push_back(name + " is within " + to_decimal(width, 3) + " of this decimal");
      if (e.lower <= 0 && e.upper >= 0) return "0";
      return to_decimal((e.lower + e.upper) / 2, digits);
    }
  }
}

std::optional<Rational> no_symmetry() { return std::nullopt; }

// The map that mirrors some coordinates at a point: x -> 2 centre - x.
struct Mirror {
  std::array<bool, 3> coordinates{};
  Point3 twice_centre;

  Point3 operator()(const Point3& p) const {
    Point3 image = p;
    if (coordinates[0]) image.x = twice_centre.x - p.x;
    if (coordinates[1]) image.y = twice_centre.y - p.y;
    if (coordinates[2]) image.z = twice_centre.z - p.z;
    return image;
  }
  bool turns_inside_out() const { return (coordinates[0] != coordinates[1]) != coordinates[2]; }
};

// The lexicographic order of two points that round to p and q. Rounding to nearest is monotone:
// their coordinates, which the functions give, are compared only where the doubles are equal.
template <class ExactOfP, class ExactOfQ>
std::strong_ordering compare_rounded(const std::array<double, 3>& p, const std::array<double, 3>& q,
                                     ExactOfP exact_of_p, ExactOfQ exact_of_q) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p[axis] != q[axis]) {
      return p[axis] < q[axis] ? std::strong_ordering::less : std::strong_ordering::greater;
    }
    const std::strong_ordering order = compare(exact_of_p(axis), exact_of_q(axis));
    if (order != 0) return order;
  }
  return std::strong_ordering::equal;
}

// REQUIRES boundary.approximate
bool vertices_ascend(const Boundary& boundary) {
  const auto exact = [&](std::size_t i) {
    return [&boundary, i](std::size_t axis) { return boundary.vertices.view(i)[axis]; };
  };
  const auto descend = [&](std::size_t i) {
    return compare_rounded(boundary.approximate[i], boundary.approximate[i + 1], exact(i),
                           exact(i + 1)) > 0;
  };
  for (std::size_t i = 0; i + 1 < boundary.vertices.size(); ++i) {
    if (descend(i)) return false;
  }
  return true;
}

// The images of the vertices, as indices, or nullopt if one of them is no vertex.
std::optional<std::vector<std::uint32_t>> image_of_vertices(const Boundary& boundary,
                                                            const Mirror& mirror) {
  if (boundary.approximate.size() != boundary.vertices.size()) return std::nullopt;
  if (!vertices_ascend(boundary)) return std::nullopt;
  std::vector<std::uint32_t> image;
  image.reserve(boundary.vertices.size());
  for (const Point3& vertex : boundary.vertices) {
    const Point3 target = mirror(vertex);
    const std::array<double, 3> near{nearest_double(target.x), nearest_double(target.y),
                                     nearest_double(target.z)};
    const PointView target_view = view_of(target);
    const auto precedes = [&](const std::array<double, 3>& candidate) {
      const auto v = static_cast<std::size_t>(&candidate - boundary.approximate.data());
      return compare_rounded(
                 candidate, near, [&](std::size_t axis) { return boundary.vertices.view(v)[axis]; },
                 [&](std::size_t axis) { return target_view[axis]; }) < 0;
    };
    const auto at = static_cast<std::size_t>(
        std::partition_point(boundary.approximate.begin(), boundary.approximate.end(), precedes) -
        boundary.approximate.begin());
    if (at == boundary.vertices.size() || compare(boundary.vertices.view(at), target_view) != 0) {
      return std::nullopt;
    }
    image.push_back(static_cast<std::uint32_t>(at));
  }
  return image;
}

// The mirror maps the solid to itself: its vertices are, and the sides of its faces plane by plane.
bool symmetric(const Boundary& boundary, const Mirror& mirror) {
  const auto image = image_of_vertices(boundary, mirror);
  if (!image) return false;
  std::vector<std::uint32_t> identity(boundary.vertices.size());
  std::iota(identity.begin(), identity.end(), 0U);
  return numbered_sides(boundary, identity) ==
         numbered_sides(boundary, *image,
                        mirror.turns_inside_out() ? SideDirection::Reversed : SideDirection::Kept);
}

// Coordinates of the centre of mass that a symmetry about the middle of the bounding box proves.
std::array<std::optional<Rational>, 3> centroid_by_symmetry(const Boundary& boundary,
                                                            const BoundingBox& box) {
  Mirror mirror;
  mirror.twice_centre = {box.lower.x + box.upper.x, box.lower.y + box.upper.y,
                         box.lower.z + box.upper.z};
  std::array<std::optional<Rational>, 3> known;
  for (unsigned pattern = 1; pattern < 8; ++pattern) {
    bool new_one = false;
    for (std::size_t i = 0; i < 3; ++i) {
      mirror.coordinates[i] = (pattern >> i & 1U) != 0;
      new_one = new_one || (mirror.coordinates[i] && !known[i]);
    }
    if (!new_one || !symmetric(boundary, mirror)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      if (mirror.coordinates[i]) known[i] = coordinate(mirror.twice_centre, i) / 2;
    }
  }
  return known;
}

// Enclosures never agree on a value that is itself a decimal, as zero is, and symmetric models are
// common: it is proved by symmetry where it can be.
class CentroidOracle {
 public:
  CentroidOracle(const Boundary& boundary, const BoundingBox& box)
      : boundary_(boundary), box_(box) {}

  std::optional<Rational> by_symmetry(std::size_t i) {
    if (!symmetric_) symmetric_ = centroid_by_symmetry(boundary_, box_);
    return (*symmetric_)[i];
  }
  std::optional<Rational> exactly(std::size_t i) {
    if (!tried_) {
      tried_ = true;
      exact_ = exact_centroid(boundary_, exact_bits_to_break_ties);
    }
    if (!exact_) return std::nullopt;
    return coordinate(*exact_, i);
  }

 private:
  const Boundary& boundary_;
  const BoundingBox& box_;
  std::optional<std::array<std::optional<Rational>, 3>> symmetric_;
  bool tried_ = false;
  std::optional<Point3> exact_;
};

}  // namespace

MeasuredFigures measure(const Boundary& boundary, int digits, std::size_t exact_bits,
                        Wanted wanted) {
  MeasuredFigures figures;
  figures.bounding_box = bounding_box(boundary);
  if (boundary.empty()) {
    figures.volume_decimal = figures.area_decimal = "0";
    if (exact_bits > 0) figures.exact_volume = 0;
    return figures;
  }
  Refinement refinement(boundary, wanted);
  if (exact_bits > 0) figures.exact_volume = volume_within(refinement, digits, exact_bits);
  if (figures.exact_volume) {
    figures.volume_decimal = to_decimal(*figures.exact_volume, digits);
  } else {
    figures.volume_decimal = decide(
        refinement, digits, "volume", [](const auto& m) { return m.volume; }, no_symmetry,
        [&] { return exact_volume(boundary, exact_bits_to_break_ties); }, figures.unproved);
  }
  figures.area_decimal = decide(
      refinement, digits, "area", [](const auto& m) { return m.area; }, no_symmetry,
      [&] { return exact_area(boundary, exact_bits_to_break_ties); }, figures.unproved);
  if (wanted == Wanted::VolumeAndArea) return figures;
  CentroidOracle oracle(boundary, *figures.bounding_box);
  figures.centroid_decimals.emplace();
  for (std::size_t i = 0; i < 3; ++i) {
    (*figures.centroid_decimals)[i] = decide(
        refinement, digits, std::string("centroid ") + "xyz"[i],
        [i](const auto& m) { return (*m.centroid)[i]; }, [&] { return oracle.by_symmetry(i); },
        [&] { return oracle.exactly(i); }, figures.unproved);
  }
  return figures;
}

}  // namespace exactcsg
