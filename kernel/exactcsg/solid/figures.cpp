// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/figures.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace exactcsg {

namespace {

// Enclosures by precision, each computed once for all figures.
class Refinement {
 public:
  explicit Refinement(const Boundary& boundary) : boundary_(boundary) {}
  const MeasureEnclosures& at(int bits) {
    const auto found = known_.find(bits);
    if (found != known_.end()) return found->second;
    return known_.emplace(bits, enclose_measures(boundary_, bits)).first->second;
  }

 private:
  const Boundary& boundary_;
  std::map<int, MeasureEnclosures> known_;
};

// Below this, an undecided digit is bad luck; above, it is a tie or a zero, and exact sums decide.
constexpr int patient_bits = 600;
constexpr int maximal_bits = 5000;
constexpr std::size_t exact_bits_to_break_ties = 1U << 16U;

std::string decide(Refinement& refinement, int digits, const std::string& name,
                   const std::function<Enclosure(const MeasureEnclosures&)>& figure,
                   const std::function<std::optional<Rational>()>& exactly,
                   std::vector<std::string>& unproved) {
  bool tried = false;
  for (int bits = 32 + (digits * 10 + 2) / 3;; bits *= 2) {
    const Enclosure e = figure(refinement.at(bits));
    std::string lower = to_decimal(e.lower, digits);
    if (e.lower == e.upper || lower == to_decimal(e.upper, digits)) return lower;
    if (bits > std::max(patient_bits, 4 * digits) && !tried) {
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

using Signs = std::array<int, 3>;

Point3 mirrored(const Point3& p, const Signs& signs) {
  return {signs[0] * p.x, signs[1] * p.y, signs[2] * p.z};
}

// The solid is mapped to itself by changing the signs of coordinates: its vertices are, and the
// sides of its faces with their planes.
bool symmetric(const Boundary& boundary, const Signs& signs) {
  const auto less = [](const Point3& p, const Point3& q) { return compare(p, q) < 0; };
  if (!std::is_sorted(boundary.vertices.begin(), boundary.vertices.end(), less)) return false;
  std::vector<std::uint32_t> image(boundary.vertices.size());
  for (std::size_t v = 0; v < image.size(); ++v) {
    const Point3 target = mirrored(boundary.vertices[v], signs);
    const auto at =
        std::lower_bound(boundary.vertices.begin(), boundary.vertices.end(), target, less);
    if (at == boundary.vertices.end() || !(*at == target)) return false;
    image[v] = static_cast<std::uint32_t>(at - boundary.vertices.begin());
  }
  const auto plane_less = [](const Plane& p, const Plane& q) { return compare(p, q) < 0; };
  if (!std::is_sorted(boundary.planes.begin(), boundary.planes.end(), plane_less)) return false;
  const bool mirrors = signs[0] * signs[1] * signs[2] < 0;
  std::vector<std::array<std::uint32_t, 3>> sides;
  std::vector<std::array<std::uint32_t, 3>> images;
  for (const BoundaryFace& face : boundary.faces) {
    const Plane& p = boundary.planes[face.plane];
    const Plane target{signs[0] * p.a, signs[1] * p.b, signs[2] * p.c, p.d};
    const auto at =
        std::lower_bound(boundary.planes.begin(), boundary.planes.end(), target, plane_less);
    if (at == boundary.planes.end() || !(*at == target)) return false;
    const auto plane = static_cast<std::uint32_t>(at - boundary.planes.begin());
    for (const auto& loop : face.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::uint32_t from = loop[k];
        const std::uint32_t to = loop[(k + 1) % loop.size()];
        sides.push_back({face.plane, from, to});
        images.push_back({plane, image[mirrors ? to : from], image[mirrors ? from : to]});
      }
    }
  }
  std::sort(sides.begin(), sides.end());
  std::sort(images.begin(), images.end());
  return sides == images;
}

// Coordinates of the centre of mass that a symmetry about the origin proves to be zero.
std::array<bool, 3> zero_by_symmetry(const Boundary& boundary) {
  std::array<bool, 3> zero{};
  for (unsigned pattern = 1; pattern < 8; ++pattern) {
    Signs signs{};
    bool new_one = false;
    for (std::size_t i = 0; i < 3; ++i) {
      signs[i] = (pattern >> i & 1U) != 0 ? -1 : 1;
      new_one = new_one || (signs[i] < 0 && !zero[i]);
    }
    if (!new_one || !symmetric(boundary, signs)) continue;
    for (std::size_t i = 0; i < 3; ++i) zero[i] = zero[i] || signs[i] < 0;
  }
  return zero;
}

// Zero is the one value on which enclosures never agree, and symmetric models are common: prove it
// by symmetry where it can be.
class CentroidOracle {
 public:
  explicit CentroidOracle(const Boundary& boundary) : boundary_(boundary) {}
  std::optional<Rational> coordinate(std::size_t i) {
    if (!zero_) zero_ = zero_by_symmetry(boundary_);
    if ((*zero_)[i]) return Rational(0);
    if (!tried_) {
      tried_ = true;
      exact_ = exact_centroid(boundary_, exact_bits_to_break_ties);
    }
    if (!exact_) return std::nullopt;
    return i == 0 ? exact_->x : i == 1 ? exact_->y : exact_->z;
  }

 private:
  const Boundary& boundary_;
  std::optional<std::array<bool, 3>> zero_;
  bool tried_ = false;
  std::optional<Point3> exact_;
};

}  // namespace

MeasuredFigures measure(const Boundary& boundary, int digits, std::size_t exact_bits) {
  MeasuredFigures figures;
  figures.bounding_box = bounding_box(boundary);
  figures.exact_volume = exact_volume(boundary, exact_bits);
  if (boundary.empty()) {
    figures.volume_decimal = figures.area_decimal = "0";
    return figures;
  }
  Refinement refinement(boundary);
  if (figures.exact_volume) {
    figures.volume_decimal = to_decimal(*figures.exact_volume, digits);
  } else {
    figures.volume_decimal = decide(
        refinement, digits, "volume", [](const auto& m) { return m.volume; },
        [&] { return exact_volume(boundary, exact_bits_to_break_ties); }, figures.unproved);
  }
  figures.area_decimal = decide(
      refinement, digits, "area", [](const auto& m) { return m.area; },
      [&] { return exact_area(boundary, exact_bits_to_break_ties); }, figures.unproved);
  CentroidOracle oracle(boundary);
  figures.centroid_decimals.emplace();
  for (std::size_t i = 0; i < 3; ++i) {
    (*figures.centroid_decimals)[i] = decide(
        refinement, digits, std::string("centroid ") + "xyz"[i],
        [i](const auto& m) { return (*m.centroid)[i]; }, [&] { return oracle.coordinate(i); },
        figures.unproved);
  }
  return figures;
}

}  // namespace exactcsg
