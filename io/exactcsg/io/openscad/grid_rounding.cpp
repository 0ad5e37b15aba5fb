// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/grid_rounding.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>
#include <set>
#include <utility>

#include "exactcsg/io/openscad/polyhedron.hpp"
#include "exactcsg/io/planar/planar.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io::openscad {

namespace {

constexpr double grid = 1.0 / 1048576.0;
constexpr double largest_cell = 9.0e18;  // what fits a cell's number

using Cell = std::array<std::int64_t, 3>;
using Loop = std::vector<std::uint32_t>;

// The cells around one, in the order in which OpenSCAD looks for an earlier point.
constexpr std::array<std::array<int, 3>, 26> neighbours{
    {{1, 0, 0},    {0, 1, 0},   {-1, 0, 0}, {0, -1, 0},  {0, 0, 1},  {0, 0, -1},  {1, 1, 0},
     {-1, 1, 0},   {-1, -1, 0}, {1, -1, 0}, {0, 1, 1},   {0, 1, -1}, {0, -1, 1},  {0, -1, -1},
     {1, 0, 1},    {1, 0, -1},  {-1, 0, 1}, {-1, 0, -1}, {1, -1, 1}, {-1, -1, 1}, {1, -1, -1},
     {-1, -1, -1}, {1, 1, 1},   {-1, 1, 1}, {1, 1, -1},  {-1, 1, -1}}};

class Grid {
 public:
  // The index of the point's cell, or of an earlier point's next to it.
  std::uint32_t align(const DoublePoint& p) {
    Cell cell{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double scaled = p[i] / grid;
      if (!(std::fabs(scaled) < largest_cell)) {
        throw Error(ErrorId::NumberOutOfRange, {"a coordinate beyond OpenSCAD's grid", ""});
      }
      cell[i] = static_cast<std::int64_t>(scaled);
    }
    if (const auto found = index_.find(cell); found != index_.end()) return found->second;
    for (const auto& step : neighbours) {
      const auto found = index_.find({cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]});
      if (found != index_.end()) return found->second;
    }
    const auto index = static_cast<std::uint32_t>(cells_.size());
    index_.emplace(cell, index);
    cells_.push_back(cell);
    return index;
  }

  // Consecutive equal vertices are one; fewer than three are nothing.
  Loop align(const std::vector<DoublePoint>& polygon) {
    Loop loop;
    for (const DoublePoint& p : polygon) loop.push_back(align(p));
    loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    if (loop.size() < 3) loop.clear();
    return loop;
  }

  const std::vector<Cell>& cells() const { return cells_; }

 private:
  std::map<Cell, std::uint32_t> index_;
  std::vector<Cell> cells_;
};

struct CutSoup {
  std::vector<Point3> points;
  std::vector<DoublePoint> doubles;  // the same
  std::vector<std::vector<Loop>> caps;
  std::vector<Loop> polygons;
};

CutSoup cut(const Soup& soup) {
  Grid cells;
  CutSoup result;
  for (const Cap& cap : soup.caps) {
    std::vector<Loop> loops;
    for (const auto& loop : cap.loops) {
      if (Loop aligned = cells.align(loop); !aligned.empty()) loops.push_back(std::move(aligned));
    }
    if (!loops.empty()) result.caps.push_back(std::move(loops));
  }
  for (const auto& polygon : soup.polygons) {
    if (Loop aligned = cells.align(polygon); !aligned.empty()) {
      result.polygons.push_back(std::move(aligned));
    }
  }
  const Rational size(1, 1048576);
  for (const Cell& cell : cells.cells()) {
    Point3 p;
    Rational* const coordinates[] = {&p.x, &p.y, &p.z};
    DoublePoint d{};
    for (std::size_t i = 0; i < 3; ++i) {
      *coordinates[i] = Rational(Integer(static_cast<long>(cell[i]))) * size;
      d[i] = static_cast<double>(cell[i]) * grid;
    }
    result.points.push_back(std::move(p));
    result.doubles.push_back(d);
  }
  return result;
}

DoublePoint minus(const DoublePoint& a, const DoublePoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const DoublePoint& a, const DoublePoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

DoublePoint newell_normal(const std::vector<DoublePoint>& points, const Loop& loop) {
  DoublePoint n{};
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const DoublePoint& p = points[loop[i]];
    const DoublePoint& q = points[loop[(i + 1) % loop.size()]];
    n[0] += (p[1] - q[1]) * (p[2] + q[2]);
    n[1] += (p[2] - q[2]) * (p[0] + q[0]);
    n[2] += (p[0] - q[0]) * (p[1] + q[1]);
  }
  return n;
}

// OpenSCAD's test that replaces an operand by its hull: closed, one piece, and across no edge does
// the neighbour bend outward by more than 0.1 degrees.
bool is_approximately_convex(const CutSoup& soup, const std::vector<Loop>& faces) {
  const double threshold = std::cos(.1 / 180 * std::numbers::pi);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> face_of_edge;
  std::vector<DoublePoint> normals;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Loop& face = faces[f];
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (!face_of_edge.emplace(std::pair(face[i], face[(i + 1) % face.size()]), f).second) {
        return false;
      }
    }
    normals.push_back(newell_normal(soup.doubles, face));
  }
  std::set<std::size_t> reached{0};
  std::queue<std::size_t> pending({0});
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Loop& face = faces[f];
    for (std::size_t i = 0; i < face.size(); ++i) {
      const auto twin = face_of_edge.find({face[(i + 1) % face.size()], face[i]});
      if (twin == face_of_edge.end()) return false;
      const Loop& other = faces[twin->second];
      const DoublePoint& u = normals[twin->second];
      const DoublePoint& v = normals[f];
      if (dot(u, minus(soup.doubles[face[(i + 2) % face.size()]], soup.doubles[other[0]])) > 0 &&
          dot(u, v) / std::sqrt(dot(u, u)) / std::sqrt(dot(v, v)) < threshold) {
        return false;
      }
    }
  }
  while (!pending.empty()) {
    const Loop& face = faces[pending.front()];
    pending.pop();
    for (std::size_t i = 0; i < face.size(); ++i) {
      const std::size_t other = face_of_edge.at({face[(i + 1) % face.size()], face[i]});
      if (reached.insert(other).second) pending.push(other);
    }
  }
  return reached.size() == faces.size();
}

[[noreturn]] void refuse(const char* what) {
  throw Error(ErrorId::UnsupportedNode,
              {what, "something that OpenSCAD's rounding leaves certain"});
}

Vector3 normal_of(const std::vector<Point3>& points, const Loop& loop) {
  Vector3 sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vector3 part =
        cross(points[loop[i]] - points[loop[0]], points[loop[i + 1]] - points[loop[0]]);
    sum = {sum.x + part.x, sum.y + part.y, sum.z + part.z};
  }
  return sum;
}

// The convex pieces of a planar cap, as loops of the same vertices.
std::vector<Loop> split_cap(const std::vector<Point3>& points, const std::vector<Loop>& loops) {
  Vector3 normal{0, 0, 0};
  for (const Loop& loop : loops) {
    const Vector3 part = normal_of(points, loop);
    normal = {normal.x + part.x, normal.y + part.y, normal.z + part.z};
  }
  const Point3& origin = points[loops[0][0]];
  for (const Loop& loop : loops) {
    for (const std::uint32_t v : loop) {
      if (exactcsg::dot(normal, points[v] - origin) != 0) {
        if (loops.size() == 1 && loops[0].size() == 3) break;
        refuse("the cap of an extrusion that is not planar on the grid");
      }
    }
  }
  const Rational x = abs(normal.x);
  const Rational y = abs(normal.y);
  const Rational z = abs(normal.z);
  const int axis = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
  const bool flip = (axis == 2 ? normal.z : axis == 1 ? normal.y : normal.x) < 0;
  const auto project = [&](const Point3& p) {
    Point2 q = axis == 2 ? Point2{p.x, p.y} : axis == 1 ? Point2{p.z, p.x} : Point2{p.y, p.z};
    if (flip) std::swap(q.x, q.y);
    return q;
  };
  PlanarFigure figure;
  std::map<std::pair<Rational, Rational>, std::uint32_t> index;
  for (const Loop& loop : loops) {
    auto& path = figure.paths.emplace_back();
    for (const std::uint32_t v : loop) {
      const Point2 q = project(points[v]);
      index.emplace(std::pair(q.x, q.y), v);
      path.push_back(q);
    }
  }
  std::vector<Loop> pieces;
  for (const auto& part : convex_parts(figure)) {
    Loop& piece = pieces.emplace_back();
    for (const Point2& q : part) {
      const auto found = index.find(std::pair(q.x, q.y));
      if (found == index.end()) refuse("the cap of an extrusion that crosses itself on the grid");
      piece.push_back(found->second);
    }
  }
  return pieces;
}

}  // namespace

double determinant(const DoubleMap& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

Soup transformed(const DoubleMap& map, Soup soup) {
  const bool mirrors = determinant(map) < 0;
  const auto move = [&](std::vector<DoublePoint>& polygon) {
    for (DoublePoint& p : polygon) {
      DoublePoint q{};
      for (std::size_t i = 0; i < 3; ++i) {
        q[i] = ((map[i][0] * p[0] + map[i][1] * p[1]) + map[i][2] * p[2]) + map[i][3];
      }
      p = q;
    }
    if (mirrors) std::reverse(polygon.begin(), polygon.end());
  };
  for (Cap& cap : soup.caps) {
    for (auto& loop : cap.loops) move(loop);
  }
  for (auto& polygon : soup.polygons) move(polygon);
  return soup;
}

std::vector<DoublePoint> cut_corners(const Soup& soup) { return cut(soup).doubles; }

Solid cut_to_grid(const Soup& soup) {
  CutSoup cut_soup = cut(soup);
  if (cut_soup.points.size() < 4) return Solid::empty();
  bool convex = soup.convexity == Soup::Convexity::Known;
  if (!convex) {
    std::vector<Loop> faces = cut_soup.polygons;
    bool holes = false;
    for (const auto& cap : cut_soup.caps) {
      holes = holes || cap.size() != 1;
      faces.push_back(cap[0]);
    }
    convex = !holes && !faces.empty() && is_approximately_convex(cut_soup, faces);
  }
  if (convex) return hull(std::span<const Point3>(cut_soup.points));

  FacedPoints polyhedron;
  polyhedron.faces = std::move(cut_soup.polygons);
  for (const Loop& face : polyhedron.faces) {
    if (face.size() == 3) continue;
    const Vector3 normal = normal_of(cut_soup.points, face);
    for (const std::uint32_t v : face) {
      if (exactcsg::dot(normal, cut_soup.points[v] - cut_soup.points[face[0]]) != 0) {
        refuse("a face of a polyhedron that is not planar on the grid");
      }
    }
  }
  for (const auto& cap : cut_soup.caps) {
    for (Loop& piece : split_cap(cut_soup.points, cap))
      polyhedron.faces.push_back(std::move(piece));
  }
  polyhedron.points = std::move(cut_soup.points);
  return Solid::primitive(make_polyhedron(polyhedron, [](const std::string&) {}));
}

}  // namespace exactcsg::io::openscad
