// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/number/coincidence.hpp"
#include "exactcsg/number/geometry_data.hpp"
#include "exactcsg/number/prepared_plane.hpp"
#include "exactcsg/support/in_parallel.hpp"

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

// The rows of value v hold r where the rows of `table` hold v in row r. Ascending. Each of a few
// tasks takes the values of a range out of all of them: looking at one takes less than moving it.
SparseTable transposed(const SparseTable& table, std::size_t rows, unsigned threads) {
  SparseTable result;
  std::vector<std::uint32_t>& begin = result.begin;
  begin.assign(rows + 1, 0);
  const std::size_t ranges = threads == 1 ? 1 : 4;
  const auto for_each_value = [&](const auto& visit) {
    in_parallel(threads, ranges, [&](std::size_t range) {
      const auto first = static_cast<std::uint32_t>(rows * range / ranges);
      const auto count = static_cast<std::uint32_t>(rows * (range + 1) / ranges) - first;
      for (std::uint32_t row = 0; row + 1 < table.begin.size(); ++row) {
        for (const std::uint32_t value : table.row(row)) {
          if (value - first < count) visit(value, row);
        }
      }
    });
  };
  // Each place is where the row before begins, until it has been filled.
  std::uint32_t* const place = begin.data() + 1;
  for_each_value([place](std::uint32_t value, std::uint32_t) { ++place[value]; });
  std::exclusive_scan(place, place + rows, place, 0U);
  result.values.resize(table.values.size());
  for_each_value(
      [&](std::uint32_t value, std::uint32_t row) { result.values[place[value]++] = row; });
  return result;
}

// Sorts each of these rows and keeps each value once. Rows only become shorter: they are moved to
// the front of the place of all. Returns where the last one ends.
std::uint32_t make_rows_ascend(SparseTable& table, std::size_t first, std::size_t last) {
  std::uint32_t* const values = table.values.data();
  std::uint32_t written = table.begin[first];
  std::uint32_t read = written;
  for (std::size_t row = first; row < last; ++row) {
    const std::uint32_t end = table.begin[row + 1];
    if (row != first) table.begin[row] = written;  // the first one stays: others read where it is
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
  return written;
}

// Puts the canonical planes in the place of the added ones, each once and ascending.
void make_canonical(const std::vector<OrientedPlaneRef>& of_added, SparseTable& table,
                    unsigned threads) {
  const Parts parts(table.begin.size() - 1);
  std::vector<std::uint32_t> ends(parts.count());
  in_parallel(threads, parts, [&](std::size_t part, std::size_t first, std::size_t last) {
    for (std::uint32_t i = table.begin[first]; i < table.begin[last]; ++i) {
      table.values[i] = of_added[table.values[i]].plane.table_index();
    }
    ends[part] = make_rows_ascend(table, first, last);
  });
  std::uint32_t written = 0;
  for (std::size_t part = 0; part < parts.count(); ++part) {
    const std::uint32_t begin = table.begin[parts.begin(part)];
    if (written != begin) {
      std::copy(table.values.data() + begin, table.values.data() + ends[part],
                table.values.data() + written);
      for (std::size_t row = parts.begin(part); row < parts.end(part); ++row) {
        table.begin[row] -= begin - written;
      }
    }
    written += ends[part] - begin;
  }
  table.begin.back() = written;
  table.values.resize(written);
}

// The planes of each point, as added. Incidences come plane by plane mostly, so that counting once
// sorts them. for_each_incidence(visit) calls visit(point, added plane).
template <class ForEachIncidence>
SparseTable added_planes_of_points(std::size_t points, const ForEachIncidence& for_each_incidence) {
  SparseTable table;
  std::vector<std::uint32_t>& begin = table.begin;
  begin.assign(points + 1, 0);
  // Each place is where the row before begins, until it has been filled.
  std::uint32_t* const place = begin.data() + 1;
  for_each_incidence(
      [place](PointId point, std::uint32_t) { ++place[static_cast<std::size_t>(point)]; });
  std::uint32_t sum = 0;
  for (std::size_t i = 1; i < begin.size(); ++i) sum += std::exchange(begin[i], sum);
  table.values.resize(sum);
  for_each_incidence([&](PointId point, std::uint32_t plane) {
    table.values[place[static_cast<std::size_t>(point)]++] = plane;
  });
  return table;
}

// Numbers the distinct planes in the order in which they were added. Returns the first of each.
std::vector<std::uint32_t> number_distinct(const std::vector<PlaneClass>& classes,
                                           std::vector<OrientedPlaneRef>& of_added) {
  of_added.resize(classes.size());
  std::vector<std::uint32_t> firsts;
  for (std::uint32_t i = 0; i < classes.size(); ++i) {
    if (classes[i].first == i) {
      of_added[i].plane = PlaneRef::of_table(static_cast<std::uint32_t>(firsts.size()));
      firsts.push_back(i);
    } else {
      of_added[i] = {of_added[classes[i].first].plane, classes[i].sense};
    }
  }
  return firsts;
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

std::uint32_t Geometry::Builder::add_planes(std::size_t count, unsigned threads) {
  return state_->planes.add_unset(count, threads);
}

void Geometry::Builder::set_plane(std::uint32_t added, PreparedPlane plane, PointId p, PointId q,
                                  PointId r) {
  state_->planes.set(added, std::move(plane), {p, q, r});
}

void Geometry::Builder::set_plane(std::uint32_t added, PreparedPlane plane, PointId p, PointId q,
                                  Axis axis) {
  state_->planes.set(added, std::move(plane), {p, q, axis});
}

void Geometry::Builder::reserve(std::size_t points, std::size_t planes) {
  state_->points.reserve(points);
  state_->planes.reserve(planes);
}

void Geometry::Builder::add_incidence(PointId point, std::uint32_t added_plane) {
  state_->incidences.push_back({point, added_plane});
}

void Geometry::Builder::add_incidences(const PointsOnPlanes& rows) { state_->rows.push_back(rows); }

Geometry Geometry::Builder::build(unsigned threads) && {
  State& state = *state_;
  auto data = std::make_unique<Data>();
  std::vector<PlaneClass> classes;
  in_parallel(threads, 2, [&](std::size_t task) {
    if (task == 0) {
      classes = coincidence_classes(state.planes, state.points, threads);
    } else {
      data->planes_of_points = added_planes_of_points(
          state.points.size(), [&state](const auto& visit) { state.for_each_incidence(visit); });
    }
  });
  const std::vector<std::uint32_t> firsts = number_distinct(classes, data->of_added);
  const std::size_t points = state.points.size();
  in_parallel(threads, 3, [&](std::size_t task) {
    if (task == 0) {
      make_canonical(data->of_added, data->planes_of_points, threads);
      data->points_of_planes = transposed(data->planes_of_points, firsts.size(), threads);
    } else if (task == 1) {
      data->planes = PlaneTable(std::move(state.planes), firsts);
      data->points = std::move(state.points);
      data->points.close();
    } else {
      data->homogeneous_points = LazyTable<Homogeneous<Integer>>(points);
    }
  });
  data->owners = std::move(state.owners);
  state_.reset();
  return Geometry(std::move(data));
}

}  // namespace exactcsg
