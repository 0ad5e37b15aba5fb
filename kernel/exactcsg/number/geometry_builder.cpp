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

struct Entry {
  std::uint32_t row;
  std::uint32_t value;
};

// Each row ascending and without repetition.
SparseTable table_of(const std::vector<Entry>& entries, std::size_t rows) {
  SparseTable table;
  std::vector<std::uint32_t>& begin = table.begin;
  std::vector<std::uint32_t>& values = table.values;
  begin.assign(rows + 1, 0);
  for (const Entry& entry : entries) ++begin[entry.row + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  values.resize(entries.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (const Entry& entry : entries) values[next[entry.row]++] = entry.value;
  // Rows only become shorter: they are moved to the front in place.
  std::uint32_t written = 0;
  std::uint32_t row_begin = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint32_t row_end = begin[row + 1];
    const auto first = values.begin() + row_begin;
    std::sort(first, values.begin() + row_end);
    const auto last = std::unique(first, values.begin() + row_end);
    const auto out = std::copy(first, last, values.begin() + written);
    begin[row] = written;
    written = static_cast<std::uint32_t>(out - values.begin());
    row_begin = row_end;
  }
  begin.back() = written;
  values.resize(written);
  return table;
}

void fill_incidences(const std::vector<Incidence>& incidences, Geometry::Data& data) {
  std::vector<Entry> entries;
  entries.reserve(incidences.size());
  for (const Incidence& i : incidences) {
    entries.push_back(
        {static_cast<std::uint32_t>(i.point), data.of_added[i.plane].plane.table_index()});
  }
  data.planes_of_points = table_of(entries, data.points.size());
  for (Entry& entry : entries) std::swap(entry.row, entry.value);
  data.points_of_planes = table_of(entries, data.planes.size());
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
  data->owners = std::move(state.owners);
  data->homogeneous_points = LazyTable<Homogeneous<Integer>>(data->points.size());
  fill_incidences(state.incidences, *data);
  state_.reset();
  return Geometry(std::move(data));
}

}  // namespace exactcsg
