// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/number/coincidence.hpp"
#include "exactcsg/number/geometry_data.hpp"
#include "exactcsg/number/prepared_plane.hpp"

namespace exactcsg {

namespace {

struct Incidence {
  PointId point;
  std::uint32_t plane;  // as added
};

}  // namespace

struct Geometry::Builder::State {
  std::vector<std::shared_ptr<const void>> owners;
  PointTable points;
  AddedPlanes planes;
  std::vector<Incidence> incidences;
  std::vector<PointsOnPlanes> rows;  // further ones

  // visit(point, added plane)
  template <class Visit>
  void for_each_incidence(const Visit& visit) const {
    for (const Incidence& incidence : incidences) visit(incidence.point, incidence.plane);
    for (const PointsOnPlanes& on : rows) {
      for (std::size_t row = 0; row + 1 < on.begins.size(); ++row) {
        const std::uint32_t plane =
            on.first_plane +
            (on.of_rows.empty() ? static_cast<std::uint32_t>(row) : on.of_rows[row]);
        for (std::uint32_t i = on.begins[row]; i < on.begins[row + 1]; ++i) {
          visit(on.points[on.corners[i]], plane);
        }
      }
    }
  }
};

namespace {

// The rows of value v hold r where the rows of `table` hold v in row r. Ascending.
SparseTable transposed(const SparseTable& table, std::size_t rows) {
  SparseTable result;
  result.begin.assign(rows + 1, 0);
  for (const std::uint32_t value : table.values) ++result.begin[value + 1];
  for (std::size_t i = 1; i <= rows; ++i) result.begin[i] += result.begin[i - 1];
  result.values.resize(table.values.size());
  std::vector<std::uint32_t> next(result.begin.begin(), result.begin.end() - 1);
  for (std::uint32_t row = 0; row + 1 < table.begin.size(); ++row) {
    for (const std::uint32_t value : table.row(row)) result.values[next[value]++] = row;
  }
  return result;
}

// Sorts each row and keeps each value once.
void make_rows_ascend(SparseTable& table) {
  // Rows only become shorter: they are moved to the front in place.
  std::uint32_t* const values = table.values.data();
  std::uint32_t written = 0;
  std::uint32_t read = 0;
  for (std::size_t row = 0; row + 1 < table.begin.size(); ++row) {
    const std::uint32_t end = table.begin[row + 1];
    table.begin[row] = written;
    std::uint32_t ascending = read + 1;
    while (ascending < end && values[ascending - 1] < values[ascending]) ++ascending;
    std::uint32_t kept = end;
    if (ascending < end) {
      std::sort(values + read, values + end);
      kept = static_cast<std::uint32_t>(std::unique(values + read, values + end) - values);
    }
    if (written != read) std::copy(values + read, values + kept, values + written);
    written += kept - read;
    read = end;
  }
  table.begin.back() = written;
  table.values.resize(written);
}

// Incidences come plane by plane mostly, so that counting once sorts them.
// for_each_incidence(visit) calls visit(point, added plane).
template <class ForEachIncidence>
void fill_incidences(const ForEachIncidence& for_each_incidence, Geometry::Data& data) {
  SparseTable& table = data.planes_of_points;
  std::vector<std::uint32_t>& begin = table.begin;
  begin.assign(data.points.size() + 1, 0);
  // Each place is where the row before begins, until it has been filled.
  std::uint32_t* const count = begin.data() + 1;
  for_each_incidence(
      [count](PointId point, std::uint32_t) { ++count[static_cast<std::size_t>(point)]; });
  std::uint32_t sum = 0;
  for (std::size_t i = 1; i < begin.size(); ++i) sum += std::exchange(begin[i], sum);
  table.values.resize(sum);
  for_each_incidence([&](PointId point, std::uint32_t plane) {
    table.values[count[static_cast<std::size_t>(point)]++] =
        data.of_added[plane].plane.table_index();
  });
  make_rows_ascend(table);
  data.points_of_planes = transposed(table, data.planes.size());
}

}  // namespace

Geometry::Builder::Builder() : state_(std::make_unique<State>()) {}
Geometry::Builder::~Builder() = default;

PointId Geometry::Builder::add_point(const Point3& point) { return state_->points.intern(point); }

void Geometry::Builder::add_owner(std::shared_ptr<const void> owner) {
  state_->owners.push_back(std::move(owner));
}

void Geometry::Builder::add_owned_points(const ExactPoints& points,
                                         std::span<const HashedPoint> hashed,
                                         std::span<PointId> ids) {
  state_->points.intern_lasting(points, hashed, ids);
}

Point3 Geometry::Builder::point(PointId id) const { return point_of(state_->points.exact(id)); }

std::uint32_t Geometry::Builder::add_plane(PointId p, PointId q, PointId r) {
  const PointTable& points = state_->points;
  const std::array<Point3, 3> exact{point(p), point(q), point(r)};
  const std::uint32_t index =
      add_plane(prepared_plane({exact[0], points.approximate(p)}, {exact[1], points.approximate(q)},
                               {exact[2], points.approximate(r)}),
                p, q, r);
  for (const PointId id : {p, q, r}) add_incidence(id, index);
  return index;
}

std::uint32_t Geometry::Builder::add_plane(PreparedPlane plane, PointId p, PointId q, PointId r) {
  return state_->planes.add(std::move(plane), {p, q, r});
}

std::uint32_t Geometry::Builder::add_plane(PreparedPlane plane, PointId p, PointId q, Axis axis) {
  return state_->planes.add(std::move(plane), {p, q, axis});
}

std::uint32_t Geometry::Builder::add_plane(const Plane& plane) {
  return state_->planes.add(prepared_plane(plane), {});
}

void Geometry::Builder::reserve(std::size_t points, std::size_t planes) {
  state_->points.reserve(points);
  state_->planes.reserve(planes);
}

void Geometry::Builder::add_incidence(PointId point, std::uint32_t added_plane) {
  state_->incidences.push_back({point, added_plane});
}

void Geometry::Builder::add_incidences(const PointsOnPlanes& rows) { state_->rows.push_back(rows); }

Geometry Geometry::Builder::build() && {
  State& state = *state_;
  const std::vector<PlaneClass> classes = coincidence_classes(state.planes, state.points);
  auto data = std::make_unique<Data>();
  data->of_added.resize(classes.size());
  std::vector<std::uint32_t> firsts;
  for (std::uint32_t i = 0; i < classes.size(); ++i) {
    if (classes[i].first == i) {
      data->of_added[i].plane = PlaneRef::of_table(static_cast<std::uint32_t>(firsts.size()));
      firsts.push_back(i);
    } else {
      data->of_added[i] = {data->of_added[classes[i].first].plane, classes[i].sense};
    }
  }
  data->planes = PlaneTable(std::move(state.planes), firsts);
  data->points = std::move(state.points);
  data->points.close();
  data->owners = std::move(state.owners);
  data->homogeneous_points = LazyTable<Homogeneous<Integer>>(data->points.size());
  fill_incidences([&state](const auto& visit) { state.for_each_incidence(visit); }, *data);
  state_.reset();
  return Geometry(std::move(data));
}

}  // namespace exactcsg
