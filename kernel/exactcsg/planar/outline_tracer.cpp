// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/planar/outline_tracer.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "exactcsg/support/error.hpp"

namespace exactcsg::planar {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

using Chain = std::vector<std::uint32_t>;  // boundary edges, each from the end of the last

class Tracer {
 public:
  Tracer(const Scene& scene, const BoundaryEdges& boundary)
      : scene_(scene), edges_(boundary.edges), vertices_(boundary.vertices) {}

  Outline trace() {
    find_leaving();
    find_next();
    find_loops();
    assign_holes();
    return number_points();
  }

 private:
  // The boundary of one connected piece of the set and one connected piece of its complement, as
  // the set's side sees it, cut into simple loops without vertices where it goes straight on.
  struct Walk {
    std::vector<Chain> loops;  // the outer one, if there is one, is the first
    bool has_outer = false;
    std::uint32_t component = none;
  };

  Sign turn(std::uint32_t a, std::uint32_t b) const {
    return scene_.turn(edges_[a].edge, edges_[b].edge) * edges_[a].way * edges_[b].way;
  }

  void find_leaving() {
    first_leaving_.assign(vertices_.size() + 1, 0);
    for (const BoundaryEdge& edge : edges_) ++first_leaving_[edge.from + 1];
    for (std::size_t v = 0; v < vertices_.size(); ++v) first_leaving_[v + 1] += first_leaving_[v];
    leaving_.resize(edges_.size());
    std::vector<std::uint32_t> filled(first_leaving_.begin(), first_leaving_.end() - 1);
    for (std::uint32_t e = 0; e < edges_.size(); ++e) leaving_[filled[edges_[e].from]++] = e;
  }

  std::uint32_t leaving_count(VertexIndex v) const {
    return first_leaving_[v + 1] - first_leaving_[v];
  }

  // 0: the direction's angle is in [0, pi), 1: in [pi, 2 pi).
  int half(std::uint32_t e, Sign way) const {
    const auto& direction = scene_.edges()[edges_[e].edge].direction;
    const Sign x = direction[x_axis] * way;
    const Sign y = direction[y_axis] * way;
    return y == Sign::Positive || (y == Sign::Zero && x == Sign::Positive) ? 0 : 1;
  }

  // The edge on which the set's sector at the end of each is left again: the first clockwise from
  // where the edge came from.
  void find_next() {
    for (VertexIndex v = 0; v < vertices_.size(); ++v) {
      if (leaving_count(v) < 2) continue;
      std::sort(leaving_.begin() + first_leaving_[v], leaving_.begin() + first_leaving_[v + 1],
                [&](std::uint32_t a, std::uint32_t b) {
                  const int half_a = half(a, edges_[a].way);
                  const int half_b = half(b, edges_[b].way);
                  return half_a != half_b ? half_a < half_b : turn(a, b) == Sign::Positive;
                });
    }
    next_.resize(edges_.size());
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      const VertexIndex v = edges_[e].to;
      if (leaving_count(v) == 0) {
        throw Error(ErrorId::InternalError, {"a planar boundary that ends", ""});
      }
      const auto begin = leaving_.begin() + first_leaving_[v];
      const auto end = leaving_.begin() + first_leaving_[v + 1];
      if (end - begin == 1) {
        next_[e] = *begin;
        continue;
      }
      const int back = half(e, -edges_[e].way);
      // The first that is not before the way back, counter-clockwise.
      const auto beyond = std::partition_point(begin, end, [&](std::uint32_t out) {
        const int half_out = half(out, edges_[out].way);
        return half_out != back ? half_out < back : turn(out, e) == Sign::Negative;
      });
      next_[e] = beyond == begin ? *(end - 1) : *(beyond - 1);
    }
  }

  void find_loops() {
    std::vector<bool> seen(edges_.size());
    position_.assign(vertices_.size(), none);
    for (std::uint32_t first = 0; first < edges_.size(); ++first) {
      if (seen[first]) continue;
      Chain chain;
      for (std::uint32_t e = first; !seen[e]; e = next_[e]) {
        seen[e] = true;
        chain.push_back(e);
      }
      Walk walk;
      split_into_simple(chain, walk.loops);
      for (Chain& loop : walk.loops) drop_straight_vertices(loop);
      const auto outer = std::find_if(walk.loops.begin(), walk.loops.end(),
                                      [&](const Chain& loop) { return is_outer(loop); });
      walk.has_outer = outer != walk.loops.end();
      if (walk.has_outer) std::iter_swap(walk.loops.begin(), outer);
      walks_.push_back(std::move(walk));
    }
  }

  // A walk may pass a vertex several times (a hole that touches the outer boundary there): cut it
  // into loops that do not.
  void split_into_simple(const Chain& chain, std::vector<Chain>& loops) {
    Chain path;
    const auto begin = [&](std::uint32_t e) -> std::uint32_t& { return position_[edges_[e].from]; };
    for (const std::uint32_t e : chain) {
      if (begin(e) != none) {
        const auto from = path.begin() + begin(e);
        Chain loop(from, path.end());
        for (const std::uint32_t other : loop) begin(other) = none;
        path.erase(from, path.end());
        loops.push_back(std::move(loop));
      }
      begin(e) = static_cast<std::uint32_t>(path.size());
      path.push_back(e);
    }
    for (const std::uint32_t e : path) begin(e) = none;
    loops.push_back(std::move(path));
  }

  void drop_straight_vertices(Chain& loop) const {
    Chain kept;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t before = loop[(i + loop.size() - 1) % loop.size()];
      const bool straight =
          edges_[before].edge == edges_[loop[i]].edge || turn(before, loop[i]) == Sign::Zero;
      if (leaving_count(edges_[loop[i]].from) > 1 || !straight) kept.push_back(loop[i]);
    }
    loop = std::move(kept);
  }

  const Point2& exact(VertexIndex v) {
    if (exact_.empty()) {
      exact_.resize(vertices_.size());
      near_.resize(vertices_.size());
    }
    if (!exact_[v]) exact_[v] = exact_vertex(scene_, vertices_[v]);
    return *exact_[v];
  }
  const CertifiedPoint& near(VertexIndex v) {
    if (exact_.empty() || !near_[v]) {
      const Point2& point = exact(v);
      near_[v] = vertices_[v].kind == PieceEnd::Kind::Point
                     ? scene_.point(vertices_[v].first)
                     : CertifiedPoint{certified_double_of(point.x), certified_double_of(point.y)};
    }
    return *near_[v];
  }

  // By x, then by y.
  Sign compare(VertexIndex a, VertexIndex b) {
    if (a == b) return Sign::Zero;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (const auto sign = certain_order(near(a)[axis], near(b)[axis])) {
        if (*sign != Sign::Zero) return *sign;
        continue;
      }
      const int order = axis == x_axis ? cmp(exact(a).x, exact(b).x) : cmp(exact(a).y, exact(b).y);
      if (order != 0) return sign_of(order);
    }
    return Sign::Zero;
  }

  std::size_t least_vertex(const Chain& loop) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < loop.size(); ++i) {
      if (compare(edges_[loop[i]].from, edges_[loop[least]].from) == Sign::Negative) least = i;
    }
    return least;
  }

  // The loop is simple, so it turns at its least vertex as it turns as a whole.
  bool is_outer(const Chain& loop) {
    const std::size_t least = least_vertex(loop);
    return turn(loop[(least + loop.size() - 1) % loop.size()], loop[least]) == Sign::Positive;
  }

  bool is_strictly_convex(const Chain& loop) const {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (turn(loop[i], loop[(i + 1) % loop.size()]) != Sign::Positive) return false;
    }
    return true;
  }

  // A walk without an outer loop bounds holes of the component that is just to the left of its
  // least vertex: that of the next boundary edge below there, which bounds it as well.
  void assign_holes() {
    std::uint32_t components = 0;
    std::vector<std::uint32_t> holes;
    for (std::uint32_t w = 0; w < walks_.size(); ++w) {
      if (walks_[w].has_outer) {
        walks_[w].component = components++;
      } else {
        holes.push_back(w);
      }
    }
    component_count_ = components;
    if (holes.empty()) return;
    if (components == 1) {
      for (const std::uint32_t w : holes) walks_[w].component = 0;
      return;
    }
    sweep();
    for (const std::uint32_t w : holes) {
      if (walks_[w].component == none) {
        throw Error(ErrorId::InternalError, {"a planar component without an outer loop", ""});
      }
    }
  }

  // A side of a loop, from its lesser end to its greater.
  struct Side {
    VertexIndex lesser, greater;
    EdgeIndex edge;
    Sign way;  // of the edge, from lesser to greater
    std::uint32_t walk;
  };

  Sign side_of(const Side& side, VertexIndex v) {
    return scene_.orientation(side.edge, near(v), exact(v)) * side.way;
  }

  // Of sides that do not cross, and that one line x = c meets.
  bool is_below(const Side& a, const Side& b) {
    if (compare(a.lesser, b.lesser) != Sign::Negative) {
      const Sign position = a.lesser == b.lesser ? Sign::Zero : side_of(b, a.lesser);
      if (position != Sign::Zero) return position == Sign::Negative;
      return scene_.turn(a.edge, b.edge) * a.way * b.way == Sign::Positive;
    }
    const Sign position = side_of(a, b.lesser);
    if (position != Sign::Zero) return position == Sign::Positive;
    return scene_.turn(a.edge, b.edge) * a.way * b.way == Sign::Positive;
  }

  void sweep() {
    std::vector<Side> sides;
    std::vector<VertexIndex> stops;
    std::vector<std::vector<std::uint32_t>> beginning(vertices_.size());
    std::vector<std::vector<std::uint32_t>> ending(vertices_.size());
    std::vector<std::uint32_t> least_of(vertices_.size(), none);  // the walk without component
    for (std::uint32_t w = 0; w < walks_.size(); ++w) {
      VertexIndex least = none;
      for (const Chain& loop : walks_[w].loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const BoundaryEdge& edge = edges_[loop[i]];
          const VertexIndex to = edges_[loop[(i + 1) % loop.size()]].from;
          const bool ascends = compare(edge.from, to) == Sign::Negative;
          Side side{ascends ? edge.from : to, ascends ? to : edge.from, edge.edge,
                    ascends ? edge.way : -edge.way, w};
          const auto index = static_cast<std::uint32_t>(sides.size());
          for (const VertexIndex v : {side.lesser, side.greater}) {
            if (beginning[v].empty() && ending[v].empty()) stops.push_back(v);
            (v == side.lesser ? beginning : ending)[v].push_back(index);
          }
          sides.push_back(side);
          if (least == none || compare(edge.from, least) == Sign::Negative) least = edge.from;
        }
      }
      if (walks_[w].component == none) least_of[least] = w;
    }
    std::sort(stops.begin(), stops.end(),
              [&](VertexIndex a, VertexIndex b) { return compare(a, b) == Sign::Negative; });
    const auto below = [&](std::uint32_t a, std::uint32_t b) {
      return a != b && is_below(sides[a], sides[b]);
    };
    std::set<std::uint32_t, decltype(below)> present(below);
    std::vector<decltype(present)::iterator> place(sides.size(), present.end());
    for (const VertexIndex v : stops) {
      for (const std::uint32_t side : ending[v]) present.erase(place[side]);
      if (const std::uint32_t w = least_of[v]; w != none) {
        // The lowest of the sides that begin here has the same neighbour below.
        const std::uint32_t lowest =
            *std::min_element(beginning[v].begin(), beginning[v].end(), below);
        const auto above = present.lower_bound(lowest);
        if (above != present.begin())
          walks_[w].component = walks_[sides[*std::prev(above)].walk].component;
      }
      for (const std::uint32_t side : beginning[v]) place[side] = present.insert(side).first;
    }
  }

  Outline number_points() {
    Outline outline;
    outline.components.resize(component_count_);
    std::vector<std::uint32_t> number(vertices_.size(), none);
    const auto numbered = [&](const Chain& chain) {
      PlanarLoop loop;
      loop.reserve(chain.size());
      for (const std::uint32_t e : chain) {
        const VertexIndex v = edges_[e].from;
        if (number[v] == none) {
          number[v] = static_cast<std::uint32_t>(outline.points.size());
          outline.points.push_back(scene_.given(exact(v)));
        }
        loop.push_back(number[v]);
      }
      return loop;
    };
    for (const bool outer : {true, false}) {
      for (const Walk& walk : walks_) {
        if (walk.has_outer != outer) continue;
        OutlineComponent& component = outline.components[walk.component];
        if (outer) component.convex = walk.loops.size() == 1 && is_strictly_convex(walk.loops[0]);
        if (!outer) component.convex = false;
        for (const Chain& loop : walk.loops) component.loops.push_back(numbered(loop));
      }
    }
    return outline;
  }

  const Scene& scene_;
  const std::vector<BoundaryEdge>& edges_;
  const std::vector<PieceEnd>& vertices_;
  std::vector<std::uint32_t> first_leaving_;  // of a vertex, in leaving_
  std::vector<std::uint32_t> leaving_;        // of one vertex: counter-clockwise
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t>
      position_;  // of the edge that leaves the vertex, in the path being cut
  std::vector<Walk> walks_;
  std::uint32_t component_count_ = 0;
  std::vector<std::optional<Point2>> exact_;
  std::vector<std::optional<CertifiedPoint>> near_;
};

}  // namespace

Outline trace_outline(const Scene& scene, const BoundaryEdges& boundary) {
  return Tracer(scene, boundary).trace();
}

}  // namespace exactcsg::planar
