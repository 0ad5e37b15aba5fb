// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The volume of a solid by sampling vertical lines, in doubles: a second opinion that shares the
// primitives' vertices with the evaluator and nothing else. It finds answers that are wrong by a
// thousandth or so, at any size. [Approximate]
//
// One line goes through a random place of each square of a grid. Primitives are closed and
// oriented, so crossings from below and from above alternate along a line.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <vector>

#include "bench/boundary/workloads.hpp"
#include "exactcsg/csg/membership.hpp"
#include "exactcsg/csg/prune.hpp"

namespace exactcsg::bench {

struct SampledVolume {
  double volume = 0;
  double standard_error = 0;  // from the differences of neighbouring squares: rather too large
};

inline std::vector<std::array<double, 3>> nearest_doubles(const ExactPoints& points) {
  std::vector<std::array<double, 3>> result;
  result.reserve(points.size());
  for (const Point3& p : points) {
    result.push_back({nearest_double(p.x), nearest_double(p.y), nearest_double(p.z)});
  }
  return result;
}

class LineSampling {
 public:
  // REQUIRES primitives that are polyhedra
  LineSampling(const Solid& solid, std::size_t lines_in_row)
      : solid_(solid), rows_(lines_in_row), crossings_(rows_ * rows_) {
    using Cursor = Solid::Cursor;
    std::vector<const Primitive*> primitives;
    const auto note = [&](Cursor node) {
      if (node.kind() != csg::NodeKind::Primitive) return;
      if (!numbers_.try_emplace(&node.primitive(), primitives.size()).second) return;
      primitives.push_back(&node.primitive());
    };
    csg::walk(
        solid.root(), [](Cursor) { return true; }, note, [](Cursor) {});
    for (const Primitive* primitive : primitives) bound(*polyhedron_of(*primitive));
    place_lines();
    for (std::size_t i = 0; i < primitives.size(); ++i) cross(*polyhedron_of(*primitives[i]), i);
  }

  SampledVolume operator()() {
    std::vector<double> lengths;
    for (auto& crossings : crossings_) lengths.push_back(length(crossings));
    const double square = width_[0] * width_[1];
    SampledVolume result;
    double squares = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      result.volume += lengths[i] * square;
      if (i % 2 == 0 && i + 1 < lengths.size()) {
        const double difference = lengths[i] - lengths[i + 1];
        squares += difference * difference;
      }
    }
    result.standard_error = std::sqrt(squares) * square;
    return result;
  }

 private:
  struct Crossing {
    double height;
    std::size_t primitive;
    bool enters;
  };

  void bound(const StoredPolyhedron& polyhedron) {
    for (const auto& p : nearest_doubles(polyhedron.vertices)) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        lower_[axis] = std::min(lower_[axis], p[axis]);
        upper_[axis] = std::max(upper_[axis], p[axis]);
      }
    }
  }

  void place_lines() {
    RandomNumbers random(1);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      width_[axis] = (upper_[axis] - lower_[axis]) / static_cast<double>(rows_);
    }
    for (std::size_t i = 0; i < rows_ * rows_; ++i) {
      const std::array<std::size_t, 2> square{i % rows_, i / rows_};
      std::array<double, 2> line{};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        line[axis] = lower_[axis] + (static_cast<double>(square[axis]) + random()) * width_[axis];
      }
      lines_.push_back(line);
    }
  }

  std::size_t square(double at, std::size_t axis) const {
    const double place = std::max(0.0, (at - lower_[axis]) / width_[axis]);
    return std::min(rows_ - 1, static_cast<std::size_t>(place));
  }

  void cross(const StoredPolyhedron& polyhedron, std::size_t primitive) {
    const auto points = nearest_doubles(polyhedron.vertices);
    for (const auto facet : polyhedron.facets) {
      for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
        cross({points[facet[0]], points[facet[i]], points[facet[i + 1]]}, primitive);
      }
    }
  }

  void cross(const std::array<std::array<double, 3>, 3>& triangle, std::size_t primitive) {
    const auto& a = triangle[0];
    const auto& b = triangle[1];
    const auto& c = triangle[2];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (area == 0) return;
    const auto range = [&](std::size_t axis) {
      const auto [low, high] = std::minmax({a[axis], b[axis], c[axis]});
      return std::array<std::size_t, 2>{square(low, axis), square(high, axis)};
    };
    const auto across = range(0);
    const auto along = range(1);
    for (std::size_t j = along[0]; j <= along[1]; ++j) {
      for (std::size_t i = across[0]; i <= across[1]; ++i) {
        const auto& line = lines_[j * rows_ + i];
        double height = 0;
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto& p = triangle[(k + 1) % 3];
          const auto& q = triangle[(k + 2) % 3];
          const double share =
              ((p[0] - line[0]) * (q[1] - line[1]) - (p[1] - line[1]) * (q[0] - line[0])) / area;
          inside = inside && share > 0;
          height += share * triangle[k][2];
        }
        if (inside) crossings_[j * rows_ + i].push_back({height, primitive, area < 0});
      }
    }
  }

  double length(std::vector<Crossing>& crossings) {
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.height < b.height; });
    std::unordered_map<std::size_t, int> depth;
    for (const Crossing& crossing : crossings) depth[crossing.primitive] = 0;
    const Solid local = csg::prune(solid_, [&](const Primitive& primitive) {
      return depth.count(numbers_.at(&primitive)) != 0 ? csg::Membership::Unknown
                                                       : csg::Membership::Out;
    });
    // Pruning copies handles of the same primitives, so their addresses stay.
    const auto is_inside = [&] {
      return csg::membership_of(local, [&](const Primitive& primitive) {
               return depth.at(numbers_.at(&primitive)) > 0 ? csg::Membership::In
                                                            : csg::Membership::Out;
             }) == csg::Membership::In;
    };
    double sum = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
      depth[crossings[i].primitive] += crossings[i].enters ? 1 : -1;
      if (is_inside()) sum += crossings[i + 1].height - crossings[i].height;
    }
    return sum;
  }

  const Solid& solid_;
  std::size_t rows_;
  std::unordered_map<const Primitive*, std::size_t> numbers_;
  std::array<double, 2> lower_{std::numeric_limits<double>::max(),
                               std::numeric_limits<double>::max()};
  std::array<double, 2> upper_{std::numeric_limits<double>::lowest(),
                               std::numeric_limits<double>::lowest()};
  std::array<double, 2> width_{};
  std::vector<std::array<double, 2>> lines_;
  std::vector<std::vector<Crossing>> crossings_;
};

}  // namespace exactcsg::bench
