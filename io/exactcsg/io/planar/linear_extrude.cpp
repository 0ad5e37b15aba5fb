// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <unordered_map>

#include "exactcsg/io/planar/outline.hpp"
#include "exactcsg/io/planar/substitute.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"

namespace exactcsg::io {

namespace {

using Level = LinearExtrusion::Level;

bool is_identity(const Level& level) {
  return level.cosine == 1 && level.sine == 0 && level.scale[0] == 1 && level.scale[1] == 1;
}

// Turned first, then scaled, as OpenSCAD does.
Point2 apply(const Level& level, const Point2& p) {
  return {level.scale[0] * (level.cosine * p.x - level.sine * p.y),
          level.scale[1] * (level.sine * p.x + level.cosine * p.y)};
}

// The component's points under numbers of their own, and its loops and convex parts in them.
struct Section {
  std::vector<Point2> points;
  std::vector<PlanarLoop> loops;
  std::vector<PlanarLoop> parts;
  bool convex = false;
};

Section section_of(const Outline& outline, const OutlineComponent& component) {
  Section section;
  section.loops = component.loops;
  section.parts = convex_parts(outline, component);
  section.convex = component.convex;
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  for (PlanarLoop& loop : section.loops) {
    for (std::uint32_t& v : loop) {
      const auto [at, added] =
          number.try_emplace(v, static_cast<std::uint32_t>(section.points.size()));
      if (added) section.points.push_back(outline.points[v]);
      v = at->second;
    }
  }
  for (PlanarLoop& part : section.parts) {
    for (std::uint32_t& v : part) v = number.at(v);
  }
  return section;
}

// Vertices are added once a position and level; facets that collapse to a line or point are left
// out.
class Sweep {
 public:
  explicit Sweep(const Section& section) : section_(section) {}

  void begin(const Rational& z) {
    add_level(section_.points, z);
    for (const PlanarLoop& part : section_.parts) {
      Facet facet;
      for (auto v = part.rbegin(); v != part.rend(); ++v) facet.push_back(numbers_[*v]);
      polyhedron_.facets.push_back(std::move(facet));
    }
  }

  // Sides that are planar quadrilaterals: the sections are images of one another under scaling.
  void add_planar_level(const std::vector<Point2>& points, const Rational& z) {
    step(points, z);
    each_side([&](std::uint32_t a, std::uint32_t b) {
      add_facet({before_[a], before_[b], numbers_[b], numbers_[a]});
    });
  }

  // `choose(below_a, below_b, above_a, above_b, outer)`: split along the diagonal from below a to
  // above b, not from below b to above a.
  template <class Choose>
  void add_split_level(const std::vector<Point2>& points, const Rational& z, Choose&& choose) {
    const std::vector<Point2> below = points_;
    step(points, z);
    for (std::size_t loop = 0; loop < section_.loops.size(); ++loop) {
      each_side_of(section_.loops[loop], [&](std::uint32_t a, std::uint32_t b) {
        if (choose(below[a], below[b], points[a], points[b], loop == 0)) {
          add_facet({before_[a], before_[b], numbers_[b]});
          add_facet({before_[a], numbers_[b], numbers_[a]});
        } else {
          add_facet({before_[a], before_[b], numbers_[a]});
          add_facet({before_[b], numbers_[b], numbers_[a]});
        }
      });
    }
  }

  // The top's section is a segment of the line x = 0 or y = 0: facets that reach it get all of its
  // vertices between theirs, so that facets of both sides have the same edges.
  void subdivide_ridge() {
    std::vector<std::uint32_t> ridge(numbers_);
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
      return polyhedron_.vertices[a] < polyhedron_.vertices[b];
    };
    std::sort(ridge.begin(), ridge.end(), less);
    ridge.erase(std::unique(ridge.begin(), ridge.end()), ridge.end());
    std::unordered_map<std::uint32_t, std::size_t> place;
    for (std::size_t i = 0; i < ridge.size(); ++i) place.emplace(ridge[i], i);
    for (Facet& facet : polyhedron_.facets) {
      Facet refined;
      for (std::size_t i = 0; i < facet.size(); ++i) {
        refined.push_back(facet[i]);
        const auto from = place.find(facet[i]);
        const auto to = place.find(facet[(i + 1) % facet.size()]);
        if (from == place.end() || to == place.end()) continue;
        for (std::size_t k = from->second + 1; k < to->second; ++k) refined.push_back(ridge[k]);
        for (std::size_t k = from->second; k-- > to->second + 1;) refined.push_back(ridge[k]);
      }
      facet = std::move(refined);
    }
  }

  void end() {
    for (const PlanarLoop& part : section_.parts) {
      Facet facet;
      for (const std::uint32_t v : part) facet.push_back(numbers_[v]);
      polyhedron_.facets.push_back(std::move(facet));
    }
  }

  Polyhedron take() { return std::move(polyhedron_); }

 private:
  void step(const std::vector<Point2>& points, const Rational& z) {
    before_ = std::move(numbers_);
    add_level(points, z);
  }

  void add_level(const std::vector<Point2>& points, const Rational& z) {
    points_ = points;
    numbers_.resize(points.size());
    std::vector<std::uint32_t> order(points.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
      const int x = cmp(points[a].x, points[b].x);
      return x != 0 ? x : cmp(points[a].y, points[b].y);
    };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return compare(a, b) < 0; });
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i == 0 || compare(order[i - 1], order[i]) != 0) {
        polyhedron_.vertices.push_back({points[order[i]].x, points[order[i]].y, z});
      }
      numbers_[order[i]] = static_cast<std::uint32_t>(polyhedron_.vertices.size() - 1);
    }
  }

  template <class F>
  void each_side_of(const PlanarLoop& loop, F&& visit) const {
    for (std::size_t i = 0; i < loop.size(); ++i) visit(loop[i], loop[(i + 1) % loop.size()]);
  }
  template <class F>
  void each_side(F&& visit) const {
    for (const PlanarLoop& loop : section_.loops) each_side_of(loop, visit);
  }

  void add_facet(Facet facet) {
    Facet distinct;
    for (const std::uint32_t v : facet) {
      if (std::find(distinct.begin(), distinct.end(), v) == distinct.end()) distinct.push_back(v);
    }
    if (distinct.size() >= 3) polyhedron_.facets.push_back(std::move(distinct));
  }

  const Section& section_;
  Polyhedron polyhedron_;
  std::vector<Point2> points_;          // of the present level
  std::vector<std::uint32_t> numbers_;  // of the present level's vertices
  std::vector<std::uint32_t> before_;   // of the level below
};

Solid prism(const Section& section, const Rational& lower, const Rational& upper,
            const Rational& scale) {
  Sweep sweep(section);
  sweep.begin(lower);
  std::vector<Point2> top = section.points;
  for (Point2& p : top) p = {scale * p.x, scale * p.y};
  sweep.add_planar_level(top, upper);
  if (scale != 0) sweep.end();
  // Every section between is a scaled copy of the outline: nothing can cross.
  if (section.convex) {
    return Solid::primitive({make_convex_polytope_unchecked(sweep.take())});
  }
  return Solid::primitive({make_mesh_unchecked(sweep.take())});
}

Solid prisms(const Outline& outline, const Rational& lower, const Rational& upper,
             const Rational& scale) {
  std::vector<Solid> members;
  for (const OutlineComponent& component : outline.components) {
    members.push_back(prism(section_of(outline, component), lower, upper, scale));
  }
  return unite_all(std::move(members));
}

// OpenSCAD 2021.01 compares the diagonals' lengths and calls them equal within ten parts in a
// million of their mean; then the direction of the twist and the sense of the loop decide, so that
// neighbouring quadrilaterals are split alike. Our test |p - q| 1e5 <= p + q of the squared lengths
// is the same one, up to the square of the tolerance. Below a ridge it takes the other diagonal.
struct DiagonalOfOpenScad {
  bool turns_back;
  bool below_ridge;

  static Rational squared_distance(const Point2& p, const Point2& q) {
    const Rational x = p.x - q.x;
    const Rational y = p.y - q.y;
    return x * x + y * y;
  }
  bool operator()(const Point2& below_a, const Point2& below_b, const Point2& above_a,
                  const Point2& above_b, bool outer) const {
    const Rational first = squared_distance(below_a, above_b);
    const Rational second = squared_distance(below_b, above_a);
    const Rational difference = first - second;
    const bool equal = abs(difference) * 100'000 <= first + second;
    const bool shorter_first = equal ? outer != turns_back : difference < 0;
    return shorter_first != below_ridge;
  }
};

// Below a ridge along x (or y), a triangle with a side on the ridge lies in a plane through the
// ridge, in which a whole side of the outline may lie too. The diagonal that puts it beside that
// side, not onto it, is the one from the corner whose horizontal (vertical) line towards the other
// corner leaves the figure.
struct DiagonalOutsideTheFigure {
  bool ridge_along_x;

  bool operator()(const Point2& below_a, const Point2& below_b, const Point2&, const Point2&,
                  bool) const {
    const Sign product = sign_of(cmp(below_b.x, below_a.x)) * sign_of(cmp(below_b.y, below_a.y));
    return product == (ridge_along_x ? Sign::Positive : Sign::Negative);
  }
};

HalfSpace above(const Rational& z) { return make_half_space(0, 0, -1, z); }
HalfSpace below(const Rational& z) { return make_half_space(0, 0, 1, -z); }

Solid slab(const Rational& lower, const Rational& upper) {
  return csg::intersect(Solid::primitive({above(lower)}), Solid::primitive({below(upper)}));
}

void check(const std::vector<Level>& levels) {
  for (std::size_t j = 0; j < levels.size(); ++j) {
    const Level& level = levels[j];
    const bool last = j + 1 == levels.size();
    for (const Rational& scale : level.scale) {
      if (scale < 0 || (scale == 0 && !last)) {
        throw Error(ErrorId::BadArgument,
                    {"scale " + to_text(scale), "a positive scale, or 0 at the top"});
      }
    }
  }
}

// The turn from one level to the next goes against OpenSCAD's positive twist, or there is none.
bool turns_back(const Level& from, const Level& to) {
  return from.cosine * to.sine - from.sine * to.cosine >= 0;
}

enum class RidgeDiagonals { OfOpenScad, OutsideTheFigure };

Polyhedron sweep_through(const Section& section, const std::vector<Level>& levels,
                         const LinearExtrusion& extrusion, RidgeDiagonals ridge_diagonals) {
  Sweep sweep(section);
  sweep.begin(extrusion.lower);
  Level before{1, 0, {1, 1}};
  const Rational height = extrusion.upper - extrusion.lower;
  const auto count = static_cast<unsigned long>(levels.size());
  for (std::size_t j = 0; j < levels.size(); ++j) {
    const Level& level = levels[j];
    std::vector<Point2> points = section.points;
    for (Point2& p : points) p = apply(level, p);
    const Rational z = extrusion.lower + height * static_cast<unsigned long>(j + 1) / count;
    const bool ridge = level.scale[0] == 0 || level.scale[1] == 0;
    if (ridge && ridge_diagonals == RidgeDiagonals::OutsideTheFigure) {
      sweep.add_split_level(points, z, DiagonalOutsideTheFigure{level.scale[0] != 0});
    } else {
      sweep.add_split_level(points, z, DiagonalOfOpenScad{turns_back(before, level), ridge});
    }
    before = level;
  }
  const auto& top = levels.back().scale;
  if (top[0] != 0 && top[1] != 0) {
    sweep.end();
  } else if (top[0] != 0 || top[1] != 0) {
    sweep.subdivide_ridge();
  }
  return sweep.take();
}

// OpenSCAD's choice of diagonals under a ridge can fold a side over onto its neighbour ("ears");
// where it does, the diagonals that cannot are taken.
Solid swept_solid(const Section& section, const std::vector<Level>& levels,
                  const LinearExtrusion& extrusion, const InsideRule& inside) {
  const auto& top = levels.back().scale;
  const bool ridge = (top[0] == 0) != (top[1] == 0);
  try {
    return Solid::primitive({make_mesh(
        sweep_through(section, levels, extrusion, RidgeDiagonals::OfOpenScad), inside.threads)});
  } catch (const Error& error) {
    if (error.id() != ErrorId::SelfIntersectingMesh || (!ridge && !inside.rule)) throw;
  }
  return solid_of_mesh(sweep_through(section, levels, extrusion, RidgeDiagonals::OutsideTheFigure),
                       inside);
}

}  // namespace

Solid linear_extrude(const PlanarTree& tree, const LinearExtrusion& extrusion,
                     const InsideRule& inside) {
  if (extrusion.lower >= extrusion.upper) return Solid::empty();
  std::vector<Level> levels = extrusion.levels;
  if (levels.empty()) levels.push_back({1, 0, extrusion.scale});
  check(levels);
  const bool straight = std::all_of(levels.begin(), levels.end(), is_identity);
  if (straight) {
    return substitute(tree, slab(extrusion.lower, extrusion.upper),
                      [&](const PlanarFigure& figure) {
                        return prisms(outline_of(figure), extrusion.lower, extrusion.upper, 1);
                      });
  }
  const Outline outline = outline_of(tree);
  if (levels.size() == 1 && levels[0].cosine == 1 && levels[0].sine == 0 &&
      levels[0].scale[0] == levels[0].scale[1]) {
    return prisms(outline, extrusion.lower, extrusion.upper, levels[0].scale[0]);
  }
  std::vector<Solid> members;
  for (const OutlineComponent& component : outline.components) {
    members.push_back(swept_solid(section_of(outline, component), levels, extrusion, inside));
  }
  return unite_all(std::move(members));
}

}  // namespace exactcsg::io
