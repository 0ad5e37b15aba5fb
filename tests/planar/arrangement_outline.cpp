// SPDX-License-Identifier: GPL-3.0-or-later
#include "planar/arrangement_outline.hpp"

#include <CGAL/Arr_consolidated_curve_data_traits_2.h>
#include <CGAL/Arr_extended_dcel.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "exactcsg/io/planar/exact_kernel.hpp"
#include "planar/membership_network.hpp"

namespace exactcsg::test {

using io::exact_point;
using io::ExactKernel;
using io::ExactPoint2;
using io::point_of;

namespace {

// One arrangement of all edges of all figures; every edge knows the input edges that cover it, so
// coincident edges cancel by parity wherever they come from.
using EdgeTraits =
    CGAL::Arr_consolidated_curve_data_traits_2<CGAL::Arr_segment_traits_2<ExactKernel>,
                                               std::uint32_t>;
using VertexNumber = std::uint32_t;
using FaceNumber = std::uint32_t;
using Dcel = CGAL::Arr_extended_dcel<EdgeTraits, VertexNumber, bool, FaceNumber>;
using Arrangement = CGAL::Arrangement_2<EdgeTraits, Dcel>;
using Halfedge = Arrangement::Halfedge_handle;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

struct Overlay {
  Arrangement arrangement;
  std::vector<std::uint32_t> figure_of_edge;
  std::vector<std::vector<Halfedge>> leaving;  // of a face: its boundary's halfedges
  FaceNumber unbounded = 0;
};

void overlay(const std::vector<const PlanarFigure*>& figures, Overlay& result) {
  std::vector<EdgeTraits::Curve_2> curves;
  for (std::uint32_t figure = 0; figure < figures.size(); ++figure) {
    for (const auto& path : figures[figure]->paths) {
      if (path.size() < 3) continue;
      std::vector<ExactPoint2> points;
      points.reserve(path.size());
      for (const Point2& p : path) points.push_back(exact_point(p));
      for (std::size_t i = 0; i < path.size(); ++i) {
        const std::size_t next = (i + 1) % path.size();
        if (path[i] == path[next]) continue;
        const auto edge = static_cast<std::uint32_t>(result.figure_of_edge.size());
        result.figure_of_edge.push_back(figure);
        curves.emplace_back(
            CGAL::Arr_segment_traits_2<ExactKernel>::Curve_2(points[i], points[next]), edge);
      }
    }
  }
  Arrangement& arrangement = result.arrangement;
  CGAL::insert(arrangement, curves.begin(), curves.end());

  FaceNumber face_count = 0;
  for (auto face = arrangement.faces_begin(); face != arrangement.faces_end(); ++face) {
    if (face->is_unbounded()) result.unbounded = face_count;
    face->set_data(face_count++);
  }
  for (auto v = arrangement.vertices_begin(); v != arrangement.vertices_end(); ++v) {
    v->set_data(none);
  }
  result.leaving.resize(face_count);
  for (auto he = arrangement.halfedges_begin(); he != arrangement.halfedges_end(); ++he) {
    he->set_data(false);
    result.leaving[he->face()->data()].push_back(he);
  }
}

// Walks through all cells, switching the figures whose edges it crosses.
std::vector<bool> cells_inside(const Overlay& overlay, MembershipNetwork& network) {
  struct Step {
    FaceNumber face;
    Halfedge entered_by;
    std::size_t next;
  };
  const auto cross = [&](Halfedge he) {
    for (auto edge = he->curve().data().begin(); edge != he->curve().data().end(); ++edge) {
      network.toggle(overlay.figure_of_edge[*edge]);
    }
  };
  std::vector<bool> inside(overlay.leaving.size());
  std::vector<bool> seen(overlay.leaving.size());
  std::vector<Step> path{{overlay.unbounded, Halfedge(), 0}};
  seen[overlay.unbounded] = true;
  inside[overlay.unbounded] = network.value();
  while (!path.empty()) {
    Step& step = path.back();
    const auto& leaving = overlay.leaving[step.face];
    if (step.next == leaving.size()) {
      if (path.size() > 1) cross(step.entered_by);
      path.pop_back();
      continue;
    }
    const Halfedge he = leaving[step.next++];
    const FaceNumber beyond = he->twin()->face()->data();
    if (seen[beyond]) continue;
    seen[beyond] = true;
    cross(he);
    inside[beyond] = network.value();
    path.push_back({beyond, he, 0});
  }
  return inside;
}

// Connected pieces of the open set: cells joined across edges that are no boundary.
std::vector<std::uint32_t> pieces(const Overlay& overlay, const std::vector<bool>& inside,
                                  std::uint32_t& count) {
  std::vector<std::uint32_t> piece(inside.size(), none);
  count = 0;
  std::vector<FaceNumber> pending;
  for (FaceNumber start = 0; start < inside.size(); ++start) {
    if (!inside[start] || piece[start] != none) continue;
    piece[start] = count;
    pending.push_back(start);
    while (!pending.empty()) {
      const FaceNumber face = pending.back();
      pending.pop_back();
      for (const Halfedge he : overlay.leaving[face]) {
        const FaceNumber beyond = he->twin()->face()->data();
        if (!inside[beyond] || piece[beyond] != none) continue;
        piece[beyond] = count;
        pending.push_back(beyond);
      }
    }
    ++count;
  }
  return piece;
}

class Tracer {
 public:
  Tracer(Overlay& overlay, const std::vector<bool>& inside) : overlay_(overlay), inside_(inside) {}

  Outline trace() {
    std::uint32_t piece_count = 0;
    const auto piece = pieces(overlay_, inside_, piece_count);
    std::vector<std::vector<PlanarLoop>> loops(piece_count);
    Arrangement& arrangement = overlay_.arrangement;
    for (auto he = arrangement.halfedges_begin(); he != arrangement.halfedges_end(); ++he) {
      if (he->data() || !is_boundary(he)) continue;
      split_into_simple(follow(he), loops[piece[he->face()->data()]]);
    }
    Outline outline;
    for (auto& piece_loops : loops) {
      for (PlanarLoop& loop : piece_loops) drop_straight_vertices(loop);
      const auto outer = std::find_if(piece_loops.begin(), piece_loops.end(),
                                      [&](const PlanarLoop& loop) { return is_outer(loop); });
      if (outer == piece_loops.end()) {
        throw Error(ErrorId::InternalError, {"a planar component without an outer loop", ""});
      }
      std::iter_swap(piece_loops.begin(), outer);
      const bool convex = piece_loops.size() == 1 && is_strictly_convex(piece_loops[0]);
      outline.components.push_back({std::move(piece_loops), convex});
    }
    number_used_points(outline);
    return outline;
  }

 private:
  bool is_boundary(Halfedge he) const {
    return inside_[he->face()->data()] && !inside_[he->twin()->face()->data()];
  }

  // The boundary halfedges of the open set's piece to their left, from one to the next in the same
  // sector of the set round their common vertex.
  PlanarLoop follow(Halfedge start) {
    PlanarLoop loop;
    Halfedge he = start;
    do {
      he->set_data(true);
      auto source = he->source();
      if (source->data() == none) {
        source->set_data(static_cast<std::uint32_t>(points_.size()));
        points_.push_back(source->point());
        boundary_edges_.push_back(0);
      }
      ++boundary_edges_[source->data()];
      loop.push_back(source->data());
      he = he->next();
      while (!is_boundary(he)) he = he->twin()->next();
    } while (he != start);
    return loop;
  }

  // A loop may pass a vertex several times (a hole that touches the outer boundary there): cut it
  // into loops that do not.
  void split_into_simple(const PlanarLoop& loop, std::vector<PlanarLoop>& result) {
    position_.resize(points_.size(), none);
    PlanarLoop path;
    for (const std::uint32_t v : loop) {
      if (position_[v] != none) {
        const auto from = path.begin() + position_[v];
        PlanarLoop simple(from, path.end());
        for (const std::uint32_t u : simple) position_[u] = none;
        path.erase(from, path.end());
        result.push_back(std::move(simple));
      }
      position_[v] = static_cast<std::uint32_t>(path.size());
      path.push_back(v);
    }
    for (const std::uint32_t u : path) position_[u] = none;
    result.push_back(std::move(path));
  }

  void drop_straight_vertices(PlanarLoop& loop) const {
    PlanarLoop kept;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t before = loop[(i + loop.size() - 1) % loop.size()];
      const std::uint32_t after = loop[(i + 1) % loop.size()];
      if (boundary_edges_[loop[i]] > 1 ||
          !CGAL::collinear(points_[before], points_[loop[i]], points_[after])) {
        kept.push_back(loop[i]);
      }
    }
    loop = std::move(kept);
  }

  // The loop is simple, so it turns at its lowest vertex as it turns as a whole.
  bool is_outer(const PlanarLoop& loop) const {
    const auto lowest = std::min_element(loop.begin(), loop.end(), [&](auto a, auto b) {
      return CGAL::lexicographically_xy_smaller(points_[a], points_[b]);
    });
    const auto at = static_cast<std::size_t>(lowest - loop.begin());
    return CGAL::left_turn(points_[loop[(at + loop.size() - 1) % loop.size()]], points_[loop[at]],
                           points_[loop[(at + 1) % loop.size()]]);
  }

  // The loop is simple and counter-clockwise.
  bool is_strictly_convex(const PlanarLoop& loop) const {
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (!CGAL::left_turn(points_[loop[i]], points_[loop[(i + 1) % n]],
                           points_[loop[(i + 2) % n]])) {
        return false;
      }
    }
    return true;
  }

  void number_used_points(Outline& outline) const {
    std::vector<std::uint32_t> number(points_.size(), none);
    for (OutlineComponent& component : outline.components) {
      for (PlanarLoop& loop : component.loops) {
        for (std::uint32_t& v : loop) {
          if (number[v] == none) {
            number[v] = static_cast<std::uint32_t>(outline.points.size());
            outline.points.push_back(point_of(points_[v]));
          }
          v = number[v];
        }
      }
    }
  }

  Overlay& overlay_;
  const std::vector<bool>& inside_;
  std::vector<ExactPoint2> points_;
  std::vector<std::uint32_t> boundary_edges_;  // that start at the point
  std::vector<std::uint32_t> position_;        // of a point in the path being split
};

}  // namespace

Outline arrangement_outline(const PlanarTree& tree) {
  MembershipNetwork network(tree);
  if (network.value()) throw Error(ErrorId::UnboundedSolid, {"an unbounded planar set", ""});
  Overlay cells;
  overlay(network.figures(), cells);
  const std::vector<bool> inside = cells_inside(cells, network);
  return Tracer(cells, inside).trace();
}

}  // namespace exactcsg::test
