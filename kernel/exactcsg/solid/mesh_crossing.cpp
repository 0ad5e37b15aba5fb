// SPDX-License-Identifier: Apache-2.0
// No two facets of a mesh meet in anything but common vertices and common edges.
//
// Two convex facets F and G in different planes meet along the line L of their planes: F cuts an
// interval from L, and so does G. Its ends are where F's outline passes through G's plane, and two
// such ends, on a segment pq of F and a segment rs of G, are ordered along L by the orientation of
// p, q, r, s (P. Guigue and O. Devillers, "Fast and robust triangle-triangle overlap test using
// orientation predicates", Journal of Graphics Tools 8, 2003): no point is ever constructed.
// Facets in one plane are disjoint, but for their outlines, if a side of one separates them.

#include <algorithm>
#include <optional>
#include <string>

#include "exactcsg/solid/box_pairs.hpp"
#include "exactcsg/solid/first_error.hpp"
#include "exactcsg/solid/polyhedron_check.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

namespace {

using Index = std::uint32_t;

// Where the outline of a facet meets the other facet's plane: on the segment from `low` (behind the
// plane or in it) to `high` (in front of it or in it), at `vertex` if that is a vertex.
struct Passage {
  Index low = 0;
  Index high = 0;
  std::optional<Index> vertex;
};

// The part of L that a facet covers, in the direction of (normal of F) x (normal of G).
struct Interval {
  Passage start;
  Passage end;
};

struct Situation {
  std::vector<Sign> signs;  // of the facet's vertices with respect to the other plane
  bool front = false;       // some vertex strictly in front
  bool behind = false;
  std::vector<std::size_t> on;  // positions in the facet of the vertices in the other plane
  std::vector<Index> along;     // vertices in a line, of a facet in the other's plane
};

bool contains(const Facet& facet, Index v) {
  return std::find(facet.begin(), facet.end(), v) != facet.end();
}

// A facet with what is known of its plane.
struct CheckedFacet {
  const Facet& facet;
  const FacetFrame& frame;
  const PolyhedronSigns::NearPlane& plane;
};

// True if doubles tell that all vertices of a facet that are not the other's lie strictly on one
// side of the other's plane: the facet meets that plane in a common vertex, in the side between two
// of them, which is the other's side as well if that is a triangle, or not at all.
bool surely_apart(const PolyhedronSigns& signs, const Facet& facet, const CheckedFacet& other) {
  Sign side = Sign::Zero;
  std::size_t common = 0;
  for (const Index v : facet) {
    if (contains(other.facet, v)) {
      ++common;
      continue;
    }
    const Sign sign = signs.certain_side(other.plane, v);
    if (sign == Sign::Zero || sign == -side) return false;
    side = sign;
  }
  return common < 2 || (common == 2 && other.facet.size() == 3);
}

void situate(const PolyhedronSigns& signs, const Facet& facet, const CheckedFacet& other,
             Situation& s) {
  s.signs.clear();
  s.on.clear();
  s.front = s.behind = false;
  const auto [a, b, c] = other.frame.corners;
  for (std::size_t k = 0; k < facet.size(); ++k) {
    const Index v = facet[k];
    Sign sign = Sign::Zero;
    if (!contains(other.facet, v)) {
      sign = signs.certain_side(other.plane, v);
      if (sign == Sign::Zero) sign = signs.orientation(a, b, c, v);
    }
    s.signs.push_back(sign);
    if (sign == Sign::Zero) s.on.push_back(k);
    s.front = s.front || sign == Sign::Positive;
    s.behind = s.behind || sign == Sign::Negative;
  }
}

class Pair {
 public:
  Pair(const PolyhedronSigns& signs, const CheckedFacet& f, const CheckedFacet& g, Situation& of_f,
       Situation& of_g)
      : signs_(signs),
        f_checked_(f),
        g_checked_(g),
        f_(f.facet),
        g_(g.facet),
        of_f_(of_f),
        of_g_(of_g) {}

  // True if they meet in common vertices and edges only.
  bool proper() {
    if (surely_apart(signs_, g_, f_checked_) || surely_apart(signs_, f_, g_checked_)) return true;
    if (side_separates(f_checked_, g_) || side_separates(g_checked_, f_)) return true;
    situate(signs_, g_, f_checked_, of_g_);
    if (of_g_.on.size() == g_.size()) return proper_in_one_plane();
    if (of_g_.on.empty() && of_g_.front != of_g_.behind) return true;
    situate(signs_, f_, g_checked_, of_f_);
    if (of_f_.on.empty() && of_f_.front != of_f_.behind) return true;
    return proper_across();
  }

 private:
  bool proper_across() const {
    // F's outline runs from behind G's plane to its front where the interval starts, G's outline
    // where it ends (F in z = 0, G in y = 0, both counter-clockwise: L runs along -x).
    const Interval f = interval(f_, of_f_, true);
    const Interval g = interval(g_, of_g_, false);
    const Sign gap_after_f = order(f.end, g.start);
    const Sign gap_after_g = order_reversed(g.end, f.start);
    if (gap_after_f == Sign::Positive || gap_after_g == Sign::Positive) return true;
    if (gap_after_f == Sign::Zero) return common(f.end, g.start);
    if (gap_after_g == Sign::Zero) return common(f.start, g.end);
    // A whole interval in common. It is either one point of one of them ...
    if (is_point(f)) return contains(g_, *f.start.vertex);
    if (is_point(g)) return contains(f_, *g.start.vertex);
    // ... or must be a chain of common edges.
    const Passage& low = order(f.start, g.start) == Sign::Positive ? g.start : f.start;
    const Passage& high = order(f.end, g.end) == Sign::Negative ? g.end : f.end;
    if (!low.vertex || !high.vertex) return false;
    return common_chain(*low.vertex, *high.vertex);
  }

  // The sign of (position of y) - (position of x) along L, x on F and y on G.
  Sign order(const Passage& x, const Passage& y) const {
    if (x.vertex && y.vertex && *x.vertex == *y.vertex) return Sign::Zero;
    return signs_.orientation(x.low, x.high, y.low, y.high);
  }
  Sign order_reversed(const Passage& y, const Passage& x) const { return -order(x, y); }

  static bool common(const Passage& x, const Passage& y) {
    return x.vertex && y.vertex && *x.vertex == *y.vertex;
  }
  static bool is_point(const Interval& i) {
    return i.start.vertex && i.end.vertex && *i.start.vertex == *i.end.vertex;
  }

  Interval interval(const Facet& facet, const Situation& s, bool rising_starts) const {
    Interval result;
    const std::size_t n = facet.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = (k + 1) % n;
      const Sign a = s.signs[k];
      const Sign b = s.signs[next];
      if (a == b) continue;
      const bool rising = static_cast<int>(a) < static_cast<int>(b);
      Passage& passage = rising == rising_starts ? result.start : result.end;
      passage.low = rising ? facet[k] : facet[next];
      passage.high = rising ? facet[next] : facet[k];
      if (a == Sign::Zero) passage.vertex = facet[k];
      if (b == Sign::Zero) passage.vertex = facet[next];
    }
    return result;
  }

  // Both facets have the same consecutive vertices from v to w, along sides.
  bool common_chain(Index v, Index w) const {
    return same_chain(f_, g_, v, w) || same_chain(f_, g_, w, v);
  }
  // Walks F from v to w along its vertices in the common line and G from w to v.
  bool same_chain(const Facet& f, const Facet& g, Index v, Index w) const {
    const auto in_f = std::find(f.begin(), f.end(), v);
    const auto in_g = std::find(g.begin(), g.end(), v);
    if (in_f == f.end() || in_g == g.end()) return false;
    for (const bool same_direction : {false, true}) {
      std::size_t i = static_cast<std::size_t>(in_f - f.begin());
      std::size_t j = static_cast<std::size_t>(in_g - g.begin());
      while (true) {
        i = (i + 1) % f.size();
        j = same_direction ? (j + 1) % g.size() : (j + g.size() - 1) % g.size();
        if (f[i] != g[j] || f[i] == v) break;
        if (!straight_from(v, w, f[i])) break;
        if (f[i] == w) return true;
      }
    }
    return false;
  }
  bool straight_from(Index v, Index w, Index x) const {
    return x == w || signs_.collinear(v, w, x);
  }

  bool proper_in_one_plane() const {
    for (const auto& [facet, other] :
         {std::pair{&f_checked_, &g_checked_}, std::pair{&g_checked_, &f_checked_}}) {
      const Facet& vertices = facet->facet;
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Index a = vertices[k];
        const Index b = vertices[k + 1 == vertices.size() ? 0 : k + 1];
        if (!separates(a, b, facet->frame, other->facet)) continue;
        return proper_along(a, b);
      }
    }
    return false;
  }

  Sign turn(const FacetFrame& frame, Index a, Index b, Index v) const {
    if (v == a || v == b) return Sign::Zero;
    return signs_.turn(frame.dropped, a, b, v) * frame.sign;
  }

  // True if the upright plane through a side has the facet, which touches it there only, on one
  // side and the other one, but for common vertices, strictly on the other side.
  bool side_separates(const CheckedFacet& checked, const Facet& other) const {
    const Facet& facet = checked.facet;
    for (std::size_t k = 0; k < facet.size(); ++k) {
      const Index a = facet[k];
      const Index b = facet[k + 1 == facet.size() ? 0 : k + 1];
      const bool strictly = std::all_of(other.begin(), other.end(), [&](Index v) {
        return v == a || v == b || turn(checked.frame, a, b, v) == Sign::Negative;
      });
      if (strictly) return true;
    }
    return false;
  }

  bool separates(Index a, Index b, const FacetFrame& frame, const Facet& other) const {
    return std::all_of(other.begin(), other.end(),
                       [&](Index v) { return turn(frame, a, b, v) != Sign::Positive; });
  }

  // Both facets lie on different sides of the line ab: what they have in common is in it.
  bool proper_along(Index a, Index b) const {
    const std::vector<Index>& on_f = along(f_, a, b, of_f_);
    const std::vector<Index>& on_g = along(g_, a, b, of_g_);
    if (on_f.empty() || on_g.empty()) return true;
    // A single vertex is all that one of them has in the line.
    if (on_f.size() == 1 && contains(on_g, on_f[0])) return true;
    if (on_g.size() == 1 && contains(on_f, on_g[0])) return true;
    CoordinateIndex coordinate = 0;
    while (signs_.compare(coordinate, a, b) == Sign::Zero) ++coordinate;
    const auto later = [&](Index v, Index w) {
      return v == w ? Sign::Zero : signs_.compare(coordinate, v, w);
    };
    const auto [f_low, f_high] = extremes(on_f, later);
    const auto [g_low, g_high] = extremes(on_g, later);
    const Index low = later(f_low, g_low) == Sign::Positive ? g_low : f_low;
    const Index high = later(f_high, g_high) == Sign::Negative ? g_high : f_high;
    const Sign length = later(low, high);
    if (length == Sign::Negative) return true;
    if (length == Sign::Zero) return contains(f_, low) && contains(g_, low);
    return common_chain(low, high);
  }

  const std::vector<Index>& along(const Facet& facet, Index a, Index b, Situation& s) const {
    s.along.clear();
    for (const Index v : facet) {
      if (turn(f_checked_.frame, a, b, v) == Sign::Zero) s.along.push_back(v);
    }
    return s.along;
  }

  template <class Later>
  static std::pair<Index, Index> extremes(const std::vector<Index>& vertices, const Later& later) {
    std::pair<Index, Index> result{vertices.front(), vertices.front()};
    for (const Index v : vertices) {
      if (later(v, result.first) == Sign::Positive) result.first = v;
      if (later(result.second, v) == Sign::Positive) result.second = v;
    }
    return result;
  }

  const PolyhedronSigns& signs_;
  const CheckedFacet& f_checked_;
  const CheckedFacet& g_checked_;
  const Facet& f_;
  const Facet& g_;
  Situation& of_f_;
  Situation& of_g_;
};

}  // namespace

std::vector<DoubleBox> facet_boxes(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                                   unsigned threads) {
  std::vector<DoubleBox> boxes(polyhedron.facets.size());
  in_parallel_parts(threads, boxes.size(), [&](std::size_t f) {
    const Facet& facet = polyhedron.facets[f];
    DoubleBox box{signs.approximate(facet.front()), signs.approximate(facet.front())};
    for (const Index v : facet) box = join(box, {signs.approximate(v), signs.approximate(v)});
    for (std::size_t i = 0; i < 3; ++i) {
      // Twice the error: the subtraction itself rounds.
      box.lower[i] -= 2 * signs.coordinate_error();
      box.upper[i] += 2 * signs.coordinate_error();
    }
    boxes[f] = box;
  });
  return boxes;
}

namespace {

// What tells of most pairs of triangles by one or two products that they are proper: as
// surely_apart, from a few numbers in a row for each facet.
class Triangles {
 public:
  Triangles(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
            const std::vector<FacetFrame>& frames, unsigned threads)
      : signs_(signs), frames_(frames), corners_(frames.size()), planes_(frames.size()) {
    in_parallel_parts(threads, frames.size(), [&](std::size_t f) {
      const auto [a, b, c] = frames[f].corners;
      planes_[f] = signs.near_plane(a, b, c);
      const Facet& facet = polyhedron.facets[f];
      if (facet.size() == 3) corners_[f] = {facet[0], facet[1], facet[2]};
    });
  }

  const PolyhedronSigns::NearPlane& plane(Index facet) const { return planes_[facet]; }

  // True only if both are triangles that meet in common vertices and edges only.
  bool surely_proper(Index f, Index g) const {
    const Corners& p = corners_[f];
    const Corners& q = corners_[g];
    if (p[0] == p[1] || q[0] == q[1]) return false;
    unsigned common_p = 0;  // a bit for each corner
    unsigned common_q = 0;
    for (unsigned i = 0; i < 3; ++i) {
      for (unsigned j = 0; j < 3; ++j) {
        const unsigned same = p[i] == q[j] ? 1 : 0;
        common_p |= same << i;
        common_q |= same << j;
      }
    }
    if (common_p == all_corners) return false;
    if (lies_off(q, common_q, planes_[f]) || lies_off(p, common_p, planes_[g])) return true;
    return have_edge(common_p) && is_beyond_edge(f, common_p, q[lone_corner(common_q)]);
  }

 private:
  using Corners = std::array<Index, 3>;  // all the same: not a triangle
  static constexpr unsigned all_corners = 7;

  static bool have_edge(unsigned common) { return (common & (common - 1)) != 0; }
  // REQUIRES two bits
  static unsigned lone_corner(unsigned common) { return (all_corners ^ common) >> 1U; }

  bool lies_off(const Corners& corners, unsigned common,
                const PolyhedronSigns::NearPlane& plane) const {
    Sign side = Sign::Zero;
    for (unsigned i = 0; i < 3; ++i) {
      if ((common >> i & 1U) != 0) continue;
      const Sign sign = signs_.certain_side(plane, corners[i]);
      if (sign == Sign::Zero || sign == -side) return false;
      side = sign;
    }
    return true;
  }

  // Whether the upright plane through the common edge has a triangle and a point on either side.
  bool is_beyond_edge(Index f, unsigned common, Index point) const {
    const Corners& corners = corners_[f];
    const unsigned lone = lone_corner(common);
    const Sign turn =
        signs_.turn(frames_[f].dropped, corners[(lone + 1) % 3], corners[(lone + 2) % 3], point);
    return turn * frames_[f].sign == Sign::Negative;
  }

  const PolyhedronSigns& signs_;
  const std::vector<FacetFrame>& frames_;
  std::vector<Corners> corners_;
  std::vector<PolyhedronSigns::NearPlane> planes_;
};

// visit(search, f, g) for every pair of facets, the smaller number first, that is not proper, by
// the number of the search that finds it. What a search throws first is thrown on.
template <class Visit>
void for_each_improper_pair(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                            const std::vector<FacetFrame>& frames, const BoxHierarchy& hierarchy,
                            std::span<const BoxHierarchy::Search> searches, unsigned threads,
                            Visit visit) {
  const Triangles triangles(polyhedron, signs, frames, threads);
  in_parallel_to_first_error(threads, searches.size(), [&](std::size_t search) {
    Situation of_f;
    Situation of_g;
    hierarchy.for_each_pair(searches[search], [&](Index i, Index j) {
      if (triangles.surely_proper(i, j)) return;
      const Index f = std::min(i, j);
      const Index g = std::max(i, j);
      const CheckedFacet first{polyhedron.facets[f], frames[f], triangles.plane(f)};
      const CheckedFacet second{polyhedron.facets[g], frames[g], triangles.plane(g)};
      if (!Pair(signs, first, second, of_f, of_g).proper()) visit(search, f, g);
    });
  });
}

}  // namespace

void check_crossings(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                     const std::vector<FacetFrame>& frames, const BoxHierarchy& hierarchy,
                     unsigned threads) {
  for_each_improper_pair(
      polyhedron, signs, frames, hierarchy, hierarchy.searches(), threads,
      [&](std::size_t, Index f, Index g) {
        throw Error(ErrorId::SelfIntersectingMesh,
                    {describe_facet(polyhedron, f) + " and " + describe_facet(polyhedron, g),
                     "facets that meet in common vertices and edges only"});
      });
}

std::vector<std::array<std::uint32_t, 2>> improper_pairs(const Polyhedron& polyhedron,
                                                         const PolyhedronSigns& signs,
                                                         const std::vector<FacetFrame>& frames,
                                                         unsigned threads) {
  const BoxHierarchy hierarchy(facet_boxes(polyhedron, signs, threads));
  const std::vector<BoxHierarchy::Search> searches = hierarchy.searches();
  std::vector<std::vector<std::array<Index, 2>>> found(searches.size());
  for_each_improper_pair(polyhedron, signs, frames, hierarchy, searches, threads,
                         [&](std::size_t search, Index f, Index g) {
                           found[search].push_back({f, g});
                         });
  std::vector<std::array<Index, 2>> pairs = joined(threads, std::move(found));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace exactcsg
