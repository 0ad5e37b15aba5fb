// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/coincidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "exactcsg/number/bucket_sort.hpp"

namespace exactcsg {

namespace {

constexpr double unit = 0x1p-53;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Above so many distinct planes with overlapping keys they are sorted exactly instead of compared
// one by one.
constexpr std::size_t many_representatives = 16;

// +1 or -1 if both planes are the same point set, 0 if not.
int compare_sense(const Plane& p, const Plane& q) {
  if (p == q) return 1;
  return p == opposite(q) ? -1 : 0;
}

// The same for planes that are known to coincide, from their doubles: the largest coefficients are
// at least 1/2 and their errors far less.
int sense_of_coincident(const ApproximatePlane& p, const ApproximatePlane& q) {
  return p.a * q.a + p.b * q.b + p.c * q.c > 0 ? 1 : -1;
}

class Classifier {
 public:
  Classifier(AddedPlanes& planes, const PointTable& points) : planes_(planes), points_(points) {
    classes_.resize(planes.size());
    for (std::uint32_t i = 0; i < planes.size(); ++i) classes_[i].first = i;
  }

  // `group` is ascending and holds every plane that may coincide with one of its planes.
  void classify(std::span<const std::uint32_t> group) {
    std::vector<std::uint32_t> representatives;
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (find_representative(group[k], representatives)) continue;
      if (representatives.size() == many_representatives) {
        classify_by_sorting(representatives, group.subspan(k));
        return;
      }
      representatives.push_back(group[k]);
    }
  }

  std::vector<PlaneClass> take() { return std::move(classes_); }

 private:
  bool find_representative(std::uint32_t plane, std::span<const std::uint32_t> representatives) {
    for (const std::uint32_t representative : representatives) {
      const int sense = coincide(representative, plane);
      if (sense == 0) continue;
      classes_[plane] = {representative, static_cast<signed char>(sense)};
      return true;
    }
    return false;
  }

  int coincide(std::uint32_t p, std::uint32_t q) {
    const ApproximatePlane& approximate_p = planes_.approximate(p);
    const ApproximatePlane& approximate_q = planes_.approximate(q);
    if (certainly_different(approximate_p, approximate_q)) return 0;
    // Exactly axis-parallel planes at exact positions: their doubles are the planes.
    if (exact_axis(approximate_p) && exact_axis(approximate_p) == exact_axis(approximate_q) &&
        approximate_p.offset_error == 0 && approximate_q.offset_error == 0) {
      const int sense = sense_of_coincident(approximate_p, approximate_q);
      return approximate_p.d == sense * approximate_q.d ? sense : 0;
    }
    const Plane& exact_p = planes_.exact(points_, p);
    if (planes_.knows_exact(q) || planes_.points(q).empty()) {
      return compare_sense(exact_p, planes_.exact(points_, q));
    }
    // Whether q's three points lie on p is cheaper to find than q's coprime coefficients.
    const auto corners = planes_.points(q).homogeneous(
        [this](PointId id) { return homogeneous_of(point_of(points_.exact(id))); });
    for (const Homogeneous<Integer>& point : corners) {
      const Integer value =
          exact_p.a * point.x + exact_p.b * point.y + exact_p.c * point.z + exact_p.d * point.w;
      if (value != 0) return 0;
    }
    return sense_of_coincident(approximate_p, approximate_q);
  }

  void classify_by_sorting(std::span<const std::uint32_t> representatives,
                           std::span<const std::uint32_t> rest) {
    const auto less = [](const Plane& p, const Plane& q) { return compare(p, q) < 0; };
    std::map<Plane, std::uint32_t, decltype(less)> known(less);
    for (const std::uint32_t i : representatives) known.emplace(planes_.exact(points_, i), i);
    for (const std::uint32_t i : rest) {
      const Plane& plane = planes_.exact(points_, i);
      if (const auto same = known.find(plane); same != known.end()) {
        classes_[i] = {same->second, 1};
      } else if (const auto reverse = known.find(opposite(plane)); reverse != known.end()) {
        classes_[i] = {reverse->second, -1};
      } else {
        known.emplace(plane, i);
      }
    }
  }

  AddedPlanes& planes_;
  const PointTable& points_;
  std::vector<PlaneClass> classes_;
};

}  // namespace

PlaneKey key_of(const ApproximatePlane& p) {
  // (quadratic form of the normal + d * linear form of the normal) / |normal|^2 with coefficients
  // that no design shares. Below: |a|, |b|, |c| <= 1, one of them >= 1/2, e and o the errors.
  const double form = 0.7390851332151607 * p.a * p.a + 0.2799876543210321 * p.b * p.b +
                      0.5671432904097838 * p.c * p.c + 0.9159655941772190 * p.a * p.b +
                      0.3275822918721811 * p.b * p.c + 0.6434105462883380 * p.c * p.a;
  const double factor =
      0.8346268416740732 * p.a + 0.5432589653429767 * p.b + 0.2614972128476428 * p.c;
  const double square = p.a * p.a + p.b * p.b + p.c * p.c;
  const double key = (form + p.d * factor) / square;
  const double e = p.normal_error;
  const double d = std::fabs(p.d);
  // form: six terms of at most 1 that change by at most 2 e + e^2 and round by at most 8 units.
  // factor: three such terms, at most 3, change 3 e, round by at most 12 units; one more for the
  // product with d, one for the sum. square: at most 3, changes by 6 e + 3 e^2, rounds by 9 units.
  const double numerator_error =
      12.1 * e + 60 * unit + d * (3.1 * e + 20 * unit) + 3.1 * p.offset_error;
  const double square_error = 6.1 * e + 12 * unit;
  // |n/s - N/S| <= (|n - N| + |N/S| |s - S|) / s, s >= 1/4 - 6.1 e > 0.24
  const double error =
      1.01 * ((numerator_error + std::fabs(key) * square_error) / 0.24 + 4 * unit * std::fabs(key));
  if (!(error < infinity)) return {-infinity, infinity};
  return {key - error, key + error};
}

namespace {

// By the lower ends of the keys, and by number.
void sort_by_key(std::vector<KeyedPlane>& keyed, unsigned threads) {
  const auto lower_end = [](const KeyedPlane& item) { return item.key.lower; };
  const DoubleBuckets buckets(keyed, lower_end, threads);
  sort_in_buckets(
      keyed, buckets.count(), [&](const KeyedPlane& item) { return buckets.of(lower_end(item)); },
      [](const KeyedPlane& k, const KeyedPlane& l) {
        return k.key.lower < l.key.lower || (k.key.lower == l.key.lower && k.plane < l.plane);
      },
      threads);
}

}  // namespace

std::vector<PlaneClass> coincidence_classes(AddedPlanes& planes, const PointTable& points,
                                            unsigned threads) {
  auto [keyed, remote] = planes.take_keys(points);
  sort_by_key(keyed, threads);

  Classifier classifier(planes, points);
  classifier.classify(remote);
  std::vector<std::uint32_t> group;
  for (std::size_t begin = 0; begin < keyed.size();) {
    double upper = keyed[begin].key.upper;
    std::size_t end = begin + 1;
    for (; end < keyed.size() && keyed[end].key.lower <= upper; ++end) {
      upper = std::max(upper, keyed[end].key.upper);
    }
    if (end - begin > 1) {
      group.clear();
      for (std::size_t k = begin; k < end; ++k) group.push_back(keyed[k].plane);
      std::sort(group.begin(), group.end());
      classifier.classify(group);
    }
    begin = end;
  }
  return classifier.take();
}

}  // namespace exactcsg
