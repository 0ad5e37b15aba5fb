// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "exactcsg/number/coincidence.hpp"
#include "exactcsg/number/geometry_data.hpp"

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

// REQUIRES that equal values of a row lie side by side.
void remove_repetitions(SparseTable& table) {
  // Rows only become shorter: they are moved to the front in place.
  std::uint32_t written = 0;
  std::uint32_t read = 0;
  for (std::size_t row = 0; row + 1 < table.begin.size(); ++row) {
    table.begin[row] = written;
    for (; read < table.begin[row + 1]; ++read) {
      const std::uint32_t value = table.values[read];
      if (written == table.begin[row] || table.values[written - 1] != value) {
        table.values[written++] = value;
      }
    }
  }
  table.begin.back() = written;
  table.values.resize(written);
}

// Counting thrice sorts both tables.
void fill_incidences(const std::vector<Incidence>& incidences, Geometry::Data& data) {
  const auto plane_of = [&data](const Incidence& incidence) {
    return data.of_added[incidence.plane].plane.table_index();
  };
  SparseTable points_of_planes;
  std::vector<std::uint32_t>& begin = points_of_planes.begin;
  begin.assign(data.planes.size() + 1, 0);
  for (const Incidence& incidence : incidences) ++begin[plane_of(incidence) + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  points_of_planes.values.resize(incidences.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (const Incidence& incidence : incidences) {
    points_of_planes.values[next[plane_of(incidence)]++] =
        static_cast<std::uint32_t>(incidence.point);
  }
  data.planes_of_points = transposed(points_of_planes, data.points.size());
  remove_repetitions(data.planes_of_points);
  data.points_of_planes = transposed(data.planes_of_points, data.planes.size());
}

}  // namespace

Geometry::Builder::Builder() : state_(std::make_unique<State>()) {}
Geometry::Builder::~Builder() = default;

PointId Geometry::Builder::add_point(const Point3& point) { return state_->points.intern(point); }

void Geometry::Builder::add_owner(std::shared_ptr<const void> owner) {
  state_->owners.push_back(std::move(owner));
}

PointId Geometry::Builder::add_owned_point(const Point3& point, const HashedPoint& hashed) {
  return state_->points.intern_lasting(point, hashed);
}

const Point3& Geometry::Builder::point(PointId id) const { return state_->points.exact(id); }

Vertex Geometry::Builder::vertex(PointId id) const { return state_->points.vertex(id); }

std::uint32_t Geometry::Builder::add_plane(PointId p, PointId q, PointId r) {
  const std::uint32_t index = state_->planes.add(state_->points, {p, q, r});
  for (const PointId id : {p, q, r}) add_incidence(id, index);
  return index;
}

std::uint32_t Geometry::Builder::add_plane(const Plane& plane) { return state_->planes.add(plane); }

void Geometry::Builder::add_incidence(PointId point, std::uint32_t added_plane) {
  state_->incidences.push_back({point, added_plane});
}

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
  data->planes = PlaneTable(state.planes, firsts);
  data->points = std::move(state.points);
  data->points.close();
  data->owners = std::move(state.owners);
  data->homogeneous_points = LazyTable<Homogeneous<Integer>>(data->points.size());
  fill_incidences(state.incidences, *data);
  state_.reset();
  return Geometry(std::move(data));
}

}  // namespace exactcsg
