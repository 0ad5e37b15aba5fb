// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/line_interning.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exactcsg/number/certified_double.hpp"
#include "exactcsg/solid/in_parallel_counting.hpp"
#include "exactcsg/solid/vertex_interning.hpp"

namespace exactcsg {

namespace {

using Certified3 = std::array<CertifiedDouble, 3>;

struct CertifiedPlane {
  Certified3 normal;
  CertifiedDouble offset;
};

CertifiedPlane certified(const Geometry& geometry, PlaneRef plane) {
  const Geometry::ApproximatePlane near = geometry.approximate(plane);
  return {{CertifiedDouble{near.a, near.normal_error}, CertifiedDouble{near.b, near.normal_error},
           CertifiedDouble{near.c, near.normal_error}},
          {near.d, near.offset_error}};
}

Certified3 direction_of(const CertifiedPlane& p, const CertifiedPlane& q) {
  const auto& m = p.normal;
  const auto& n = q.normal;
  return {m[1] * n[2] - m[2] * n[1], m[2] * n[0] - m[0] * n[2], m[0] * n[1] - m[1] * n[0]};
}

// Pluecker coordinates are unique up to scale, so quadratic terms over the squared direction are
// invariant; a fixed combination of them in general position is the key.
KeyInterval key_of(const Geometry& geometry, const LineSample& sample, std::uint32_t item) {
  const CertifiedPlane p = certified(geometry, sample.first);
  const CertifiedPlane q = certified(geometry, sample.second);
  const Certified3 d = direction_of(p, q);
  Certified3 m;
  for (std::size_t i = 0; i < 3; ++i) m[i] = q.offset * p.normal[i] - p.offset * q.normal[i];
  const CertifiedDouble squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const auto times = [](double factor, CertifiedDouble x) {
    return CertifiedDouble{factor, 0} * x;
  };
  const CertifiedDouble u = times(0.7390851332151607, d[0]) + times(0.5671432904097838, d[1]) +
                            times(0.3819660112501051, d[2]);
  const CertifiedDouble v = times(0.9159655941772190, m[0]) + times(0.6434105462883380, m[1]) +
                            times(0.2614972128476428, m[2]) + times(0.4749493799879206, d[0]) -
                            times(0.6180339887498949, d[1]) + times(0.8346268416740732, d[2]);
  const CertifiedDouble key = u * v / squared;
  return {key.lower(), key.upper(), item};
}

bool lies_on(const Geometry& geometry, const VertexRow& vertices, const LineSample& sample,
             const LineSample& line, TierStatistics& statistics) {
  if (sample.first == line.first && sample.second == line.second) return true;
  for (const std::uint32_t number : {sample.from, sample.to}) {
    const Vertex vertex = vertices[number];
    for (const PlaneRef plane : {line.first, line.second}) {
      if (geometry.side(vertex, plane, statistics) != Sign::Zero) return false;
    }
  }
  return true;
}

}  // namespace

InternedLines intern(const Geometry& geometry, const VertexRow& vertices,
                     std::span<const LineSample> samples, TierStatistics& statistics,
                     unsigned threads) {
  InternedLines result;
  result.number.resize(samples.size());
  std::vector<KeyInterval> keys(samples.size());
  in_parallel_parts(threads, samples.size(), [&](std::size_t i) {
    keys[i] = key_of(geometry, samples[i], static_cast<std::uint32_t>(i));
  });
  const Clusters clusters(std::move(keys), threads);
  const Parts& parts = clusters.parts();
  // By part, and numbered from 0 in each.
  std::vector<std::vector<LineSample>> distinct(parts.count());
  in_parallel_counting(
      threads, parts, statistics,
      [&](std::size_t part, std::size_t begin, std::size_t end, TierStatistics& tiers) {
        std::vector<LineSample>& lines = distinct[part];
        lines.reserve(end - begin);
        clusters.for_each(part, [&](std::span<const KeyInterval> cluster) {
          const auto first = static_cast<std::ptrdiff_t>(lines.size());
          for (const KeyInterval& key : cluster) {
            const auto known =
                std::find_if(lines.begin() + first, lines.end(), [&](const LineSample& line) {
                  return lies_on(geometry, vertices, samples[key.item], line, tiers);
                });
            result.number[key.item] = static_cast<std::uint32_t>(known - lines.begin());
            if (known == lines.end()) lines.push_back(samples[key.item]);
          }
        });
      });
  const std::vector<std::size_t> firsts = first_places(distinct);
  in_parallel(threads, parts, [&](std::size_t part, std::size_t, std::size_t) {
    const auto first = static_cast<std::uint32_t>(firsts[part]);
    for (const KeyInterval& key : clusters.part(part)) result.number[key.item] += first;
  });
  result.distinct = joined(threads, std::move(distinct));
  return result;
}

std::optional<Axis> axis_along(const Geometry& geometry, const LineSample& line) {
  const Certified3 d =
      direction_of(certified(geometry, line.first), certified(geometry, line.second));
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(d[i].value) > std::abs(d[best].value)) best = i;
  }
  if (!(std::abs(d[best].value) > d[best].error)) return std::nullopt;
  return static_cast<Axis>(best);
}

}  // namespace exactcsg
