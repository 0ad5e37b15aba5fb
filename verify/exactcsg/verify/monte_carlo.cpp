// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/monte_carlo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string_view>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/membership.hpp"

namespace exactcsg::verify {

namespace {

using namespace io::openmc;
using Position = std::array<double, 3>;

// f of the format's description: negative on the side "-id".
class PlainSurface {
 public:
  explicit PlainSurface(const Surface& surface) : type_(surface.type) {
    for (const Rational& c : surface.coefficients) c_.push_back(c.get_d());
    axis_ = type_.empty() || type_[0] < 'x' || type_[0] > 'z'
                ? 0
                : static_cast<std::size_t>(type_[0] - 'x');
    kind_ = type_.find('-') == 1 ? type_.substr(2) : type_;
    is_aligned_ = kind_ != type_;
  }

  double operator()(const Position& p) const {
    if (kind_ == "plane") return is_aligned_ ? p[axis_] - c_[0] : plane(p);
    if (kind_ == "sphere") {
      return square(p[0] - c_[0]) + square(p[1] - c_[1]) + square(p[2] - c_[2]) - square(c_[3]);
    }
    if (kind_ == "cylinder") return cylinder(p);
    if (kind_ == "cone") return cone(p);
    if (kind_ == "torus") return torus(p);
    return quadric(p);
  }

 private:
  static double square(double x) { return x * x; }
  double plane(const Position& p) const {
    return c_[0] * p[0] + c_[1] * p[1] + c_[2] * p[2] - c_[3];
  }
  double quadric(const Position& p) const {
    const auto& [x, y, z] = p;
    return c_[0] * x * x + c_[1] * y * y + c_[2] * z * z + c_[3] * x * y + c_[4] * y * z +
           c_[5] * x * z + c_[6] * x + c_[7] * y + c_[8] * z + c_[9];
  }
  double cylinder(const Position& p) const {
    double sum = -square(c_[2]);
    std::size_t next = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (i != axis_) sum += square(p[i] - c_[next++]);
    }
    return sum;
  }
  double cone(const Position& p) const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += (i == axis_ ? -c_[3] : 1.0) * square(p[i] - c_[i]);
    }
    return sum;
  }
  double torus(const Position& p) const {
    double across = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (i != axis_) across += square(p[i] - c_[i]);
    }
    return square((p[axis_] - c_[axis_]) / c_[4]) + square((std::sqrt(across) - c_[3]) / c_[5]) - 1;
  }

  std::string_view type_;
  std::string_view kind_;
  std::size_t axis_ = 0;
  bool is_aligned_ = false;
  std::vector<double> c_;
};

class PlainGeometry {
 public:
  explicit PlainGeometry(const Model& model) : model_(model) {
    for (const Surface& surface : model.surfaces) surfaces_.emplace_back(surface);
    for (const Cell& cell : model.cells) {
      regions_.push_back(csg::flatten(cell.region, [](const SurfaceSide& side) { return side; }));
    }
    for (const Cell& cell : model.cells) {
      std::array<std::array<double, 4>, 3> map{};
      for (std::size_t i = 0; cell.to_fill && i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) map[i][j] = cell.to_fill->m[i][j].get_d();
      }
      maps_.push_back(map);
    }
    for (const Lattice& lattice : model.lattices) lattices_.emplace_back(lattice);
  }

  // count(cell) for every cell that has the point inside.
  template <class Count>
  void visit(Position p, Count&& count) const {
    std::optional<std::size_t> universe = model_.root;
    while (universe) {
      std::optional<Index> entered;
      for (const Index cell : model_.universes[*universe].cells) {
        if (!contains(cell, p)) continue;
        count(cell);
        if (!entered) entered = cell;
      }
      universe.reset();
      if (!entered) return;
      const Cell& cell = model_.cells[*entered];
      if (cell.fill == FillKind::Material) return;
      if (cell.to_fill) p = mapped(maps_[*entered], p);
      universe = cell.fill == FillKind::Universe ? std::optional<std::size_t>(cell.filled_with)
                                                 : lattices_[cell.filled_with].enter(p);
    }
  }

 private:
  // Rectangles or hexagons in doubles; elements by their own search.
  class PlainLattice {
   public:
    explicit PlainLattice(const Lattice& lattice) : lattice_(&lattice) {
      for (std::size_t i = 0; i < 3; ++i) {
        origin_[i] = lattice.origin[i].get_d();
        pitch_[i] = lattice.pitch[i].get_d();
      }
    }
    // The universe there, and p relative to the element's centre.
    std::optional<std::size_t> enter(Position& p) const {
      std::array<std::int64_t, 3> element{};
      if (lattice_->has_layers) {
        const double low = lattice_->is_hexagonal()
                               ? origin_[2] - pitch_[2] * static_cast<double>(lattice_->layers) / 2
                               : origin_[2];
        element[2] = step(p[2], low, pitch_[2]);
      }
      if (lattice_->is_hexagonal()) {
        enter_hexagon(p, element);
      } else {
        for (std::size_t i = 0; i < 2; ++i) element[i] = step(p[i], origin_[i], pitch_[i]);
      }
      if (!is_inside(element)) {
        return lattice_->outer ? std::optional<std::size_t>(*lattice_->outer) : std::nullopt;
      }
      return lattice_->elements[position(element)];
    }

   private:
    static std::int64_t step(double& x, double low, double pitch) {
      const double index = std::floor((x - low) / pitch);
      x -= low + pitch * (index + 0.5);
      return static_cast<std::int64_t>(index);
    }
    // The nearest of the centres round the point.
    void enter_hexagon(Position& p, std::array<std::int64_t, 3>& element) const {
      const bool is_y = lattice_->kind == LatticeKind::HexagonalY;
      const double across = (is_y ? p[0] - origin_[0] : p[1] - origin_[1]) / pitch_[0];
      const double straight = (is_y ? p[1] - origin_[1] : p[0] - origin_[0]) / pitch_[0];
      const double half_root = lattice_->row_distance ? lattice_->row_distance->get_d() / pitch_[0]
                                                      : std::numbers::sqrt3 / 2;
      double least = HUGE_VAL;
      Position local{};
      const double column = std::round(across / half_root);
      for (double k = column - 1; k <= column + 1; ++k) {
        const double l = std::round(straight - k / 2);
        const double x = across - half_root * k;
        const double y = straight - l - k / 2;
        if (x * x + y * y >= least) continue;
        least = x * x + y * y;
        const auto first = static_cast<std::int64_t>(k);
        const auto second = static_cast<std::int64_t>(l);
        element = {is_y ? first : second, is_y ? second : first, element[2]};
        local = {(is_y ? x : y) * pitch_[0], (is_y ? y : x) * pitch_[0], p[2]};
      }
      p = local;
    }
    bool is_inside(const std::array<std::int64_t, 3>& e) const {
      if (e[2] < 0 || e[2] >= lattice_->layers) return false;
      if (lattice_->is_hexagonal()) {
        return std::max({std::abs(e[0]), std::abs(e[1]), std::abs(e[0] + e[1])}) < lattice_->rings;
      }
      return e[0] >= 0 && e[0] < lattice_->counts[0] && e[1] >= 0 && e[1] < lattice_->counts[1];
    }
    // Counts the elements before it, as Lattice::elements is said to be ordered: layers, then rows
    // along x; of hexagons the columns i, each from its least a.
    std::size_t position(const std::array<std::int64_t, 3>& e) const {
      if (!lattice_->is_hexagonal()) {
        return static_cast<std::size_t>((e[2] * lattice_->counts[1] + e[1]) * lattice_->counts[0] +
                                        e[0]);
      }
      const std::int64_t reach = lattice_->rings - 1;
      std::int64_t before = e[2] * (3 * lattice_->rings * reach + 1);
      for (std::int64_t i = -reach; i < e[0]; ++i) before += 2 * reach + 1 - std::abs(i);
      return static_cast<std::size_t>(before + e[1] - std::max(-reach, -reach - e[0]));
    }

    const Lattice* lattice_;
    Position origin_{};
    Position pitch_{};
  };

  bool contains(Index cell, const Position& p) const {
    const csg::Membership value = csg::membership_of(regions_[cell], [&](const SurfaceSide& side) {
      return (surfaces_[side.surface](p) > 0) == side.is_positive ? csg::Membership::In
                                                                  : csg::Membership::Out;
    });
    return value == csg::Membership::In;
  }
  static Position mapped(const std::array<std::array<double, 4>, 3>& map, const Position& p) {
    Position result{};
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = map[i][0] * p[0] + map[i][1] * p[1] + map[i][2] * p[2] + map[i][3];
    }
    return result;
  }

  const Model& model_;
  std::vector<PlainSurface> surfaces_;
  std::vector<csg::FlatTree<SurfaceSide, csg::BooleanOperator>> regions_;
  std::vector<std::array<std::array<double, 4>, 3>> maps_;
  std::vector<PlainLattice> lattices_;
};

SampledVolume volume_of(std::uint64_t hits, std::uint64_t points, double box) {
  const auto n = static_cast<double>(points);
  const double share = static_cast<double>(hits) / n;
  const double counted = std::clamp(share, 1 / n, 1 - 1 / n);
  return {share * box, box * std::sqrt(counted * (1 - counted) / n), hits};
}

}  // namespace

std::vector<SampledVolume> sample_volumes(const Model& model, const SamplingBox& box,
                                          std::uint64_t points, std::uint64_t seed,
                                          Progress* progress) {
  constexpr std::uint64_t points_per_look = 4096;
  const PlainGeometry geometry(model);
  std::vector<std::uint64_t> hits(model.cells.size());
  std::mt19937_64 random(seed);
  std::array<std::uniform_real_distribution<double>, 3> along;
  double volume = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    along[i] = std::uniform_real_distribution<double>(box.lower[i], box.upper[i]);
    volume *= box.upper[i] - box.lower[i];
  }
  if (progress != nullptr) progress->begin("sample", points);
  for (std::uint64_t k = 0; k < points; ++k) {
    Position p{};
    for (std::size_t i = 0; i < 3; ++i) p[i] = along[i](random);
    geometry.visit(p, [&](Index cell) { ++hits[cell]; });
    if (progress != nullptr && k % points_per_look == 0) {
      progress->advance(points_per_look);
      progress->check();
    }
  }
  std::vector<SampledVolume> result;
  for (const std::uint64_t count : hits) result.push_back(volume_of(count, points, volume));
  return result;
}

}  // namespace exactcsg::verify
