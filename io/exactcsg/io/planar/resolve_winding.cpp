// SPDX-License-Identifier: GPL-3.0-or-later
// One arrangement of all edges. Crossing an edge from its left to its right takes 1 from the
// winding number, so the numbers of all cells follow from that outside, 0. The cells inside, each
// with its whole boundary, are a figure under the even-odd rule: what two of them share cancels.
#include <CGAL/Arr_consolidated_curve_data_traits_2.h>
#include <CGAL/Arr_extended_dcel.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>

#include <cstdint>
#include <optional>
#include <utility>

#include "exactcsg/io/planar/exact_kernel.hpp"
#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

namespace {

using Segments = CGAL::Arr_segment_traits_2<ExactKernel>;
using EdgeTraits = CGAL::Arr_consolidated_curve_data_traits_2<Segments, std::uint32_t>;
using WindingNumber = std::optional<std::int64_t>;
using Arrangement =
    CGAL::Arrangement_2<EdgeTraits, CGAL::Arr_face_extended_dcel<EdgeTraits, WindingNumber>>;
using Circulator = Arrangement::Ccb_halfedge_circulator;

// Calls `visit` with the halfedges of each part of the face's boundary.
template <class Visit>
void for_each_boundary(Arrangement::Face_handle face, const Visit& visit) {
  for (auto outer = face->outer_ccbs_begin(); outer != face->outer_ccbs_end(); ++outer) {
    visit(Circulator(*outer));
  }
  for (auto inner = face->inner_ccbs_begin(); inner != face->inner_ccbs_end(); ++inner) {
    visit(Circulator(*inner));
  }
}

template <class Visit>
void for_each_halfedge(Circulator start, const Visit& visit) {
  Circulator at = start;
  do {
    visit(at);
  } while (++at != start);
}

}  // namespace

PlanarFigure resolve_winding(const std::vector<std::vector<Point2>>& paths) {
  std::vector<EdgeTraits::Curve_2> curves;
  std::vector<bool> goes_right;  // or straight up
  for (const auto& path : paths) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Point2& p = path[i];
      const Point2& q = path[(i + 1) % path.size()];
      if (p == q) continue;
      const auto edge = static_cast<std::uint32_t>(goes_right.size());
      goes_right.push_back(p.x < q.x || (p.x == q.x && p.y < q.y));
      curves.emplace_back(Segments::Curve_2(exact_point(p), exact_point(q)), edge);
    }
  }
  Arrangement arrangement;
  CGAL::insert(arrangement, curves.begin(), curves.end());

  PlanarFigure cells;
  std::vector<Arrangement::Face_handle> pending{arrangement.unbounded_face()};
  pending.front()->set_data(0);
  while (!pending.empty()) {
    const Arrangement::Face_handle face = pending.back();
    pending.pop_back();
    const std::int64_t here = *face->data();
    for_each_boundary(face, [&](Circulator start) {
      std::vector<Point2> corners;
      for_each_halfedge(start, [&](Circulator he) {
        if (here != 0) corners.push_back(point_of(he->source()->point()));
        const Arrangement::Face_handle beyond = he->twin()->face();
        if (beyond->data()) return;
        const bool rightward = he->direction() == CGAL::ARR_LEFT_TO_RIGHT;
        std::int64_t winding = here;
        const auto& edges = he->curve().data();
        for (auto edge = edges.begin(); edge != edges.end(); ++edge) {
          winding += goes_right[*edge] == rightward ? -1 : 1;
        }
        beyond->set_data(winding);
        pending.push_back(beyond);
      });
      if (!corners.empty()) cells.paths.push_back(std::move(corners));
    });
  }
  return resolve(PlanarTree::primitive(std::move(cells)));
}

}  // namespace exactcsg::io
