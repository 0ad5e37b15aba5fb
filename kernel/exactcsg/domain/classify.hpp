// SPDX-License-Identifier: Apache-2.0
#pragma once

// Points, boxes and lines classified against CSG trees of half-spaces, or of other domains. [Exact]
//
// A tree stands for a regular closed set: Booleans are regularised.
//
// LAW classify.1  a point is In (Out) iff a ball round it lies in the set (in the complement), and
//                 On otherwise, also where boundaries coincide: it is decided by the cells of its
//                 neighbourhood (neighbourhood.hpp).
// LAW classify.2  a box that is In (Out) is a subset of the set (has no inner point in common with
//                 it). Unknown is conservative: mixed, or not told by the primitives one by one;
//                 the former if at most one occurrence of a primitive is mixed that matters.
// LAW classify.3  section(tree, line).between[i] is the class of the points between two crossings;
//                 the crossings are all those of the primitives, those that are equal added up, so
//                 that neighbouring classes may be the same. (simplified() leaves those out.)
// LAW classify.4  apply(m, tree) has at m(x) the class that tree has at x.
// THROWS Error(UndecidedNeighbourhood) for a point (or a line) where surfaces touch in a way that
// neighbourhood.hpp does not decide and on which the answer depends; never on lines and discs, nor
// on planes. Of primitives that are no half-spaces of the library, where several boundaries meet.
//
// REQUIRES for lines: no primitive is a doubly ruled surface.
//
// COST: O(nodes) classifications; the neighbourhood of k surfaces at most O(k^3) more traversals of
// what is left of the tree there.
//
// Source: Davy and Dew, section 3.2, example 1; Tilove; Requicha and Voelcker for On.

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/domain/half_space.hpp"
#include "exactcsg/domain/neighbourhood.hpp"
#include "exactcsg/domain/surface_half_space.hpp"
#include "exactcsg/domain/vector.hpp"

namespace exactcsg::domain {

namespace detail {

// The surfaces that pass through a point, each once, as germs see them.
template <std::size_t D>
class SurfacesAt {
 public:
  explicit SurfacesAt(const Point<D>& point) : point_(point) {}

  void add(const HalfSpace<D>& half_space) { quadrics_.push_back(&half_space.polynomial()); }
  void add(const Torus& torus) requires(D == 3) {
    if (find(torus) == nullptr) tori_.push_back({&torus, second_order(torus, point_)});
  }
  void add(const SurfaceHalfSpace& half_space) requires(D == 3) {
    half_space.visit([this](const auto& kind) { add(kind); });
  }

  std::vector<GermSurface<D>> all() {
    std::sort(quadrics_.begin(), quadrics_.end());
    quadrics_.erase(std::unique(quadrics_.begin(), quadrics_.end()), quadrics_.end());
    std::vector<GermSurface<D>> result;
    for (const Quadric<D>* f : quadrics_) result.push_back({f, nullptr});
    for (const TorusAt& torus : tori_) result.push_back({&torus.polynomial, torus.torus});
    return result;
  }

  // Of one primitive in the cell that the germ names.
  csg::Membership membership(const HalfSpace<D>& half_space, const Germ<D>& germ) const {
    Sign f = sign_along(half_space.polynomial(), germ);
    if (f == Sign::Zero) return csg::Membership::Unknown;
    if (f == Sign::Negative && half_space.nappe() &&
        half_space.nappe()->sign(point_) == Sign::Zero) {
      f = sign_along(*half_space.nappe(), germ);
    }
    return exactcsg::membership(complement_if(half_space.is_complement(), class_of(f)));
  }
  csg::Membership membership(const Torus& torus, const Germ<D>& germ) const requires(D == 3) {
    Sign f = sign_along(*find(torus), germ);
    if (torus.base().sign(point_) == Sign::Zero &&
        scalar_product(torus.base().gradient(point_.coordinates()), germ.direction) < 0) {
      f = Sign::Negative;  // at a tip, inwards
    }
    if (f == Sign::Zero) return csg::Membership::Unknown;
    return exactcsg::membership(complement_if(torus.is_complement(), class_of(f)));
  }
  csg::Membership membership(const SurfaceHalfSpace& half_space, const Germ<D>& germ) const
      requires(D == 3) {
    return half_space.visit([&](const auto& kind) { return membership(kind, germ); });
  }

 private:
  struct TorusAt {
    const Torus* torus;
    Quadric<D> polynomial;
  };
  Sign sign_along(const Quadric<D>& f, const Germ<D>& germ) const {
    return germ.sign(f, f.gradient(point_.coordinates()));
  }
  const Quadric<D>* find(const Torus& torus) const {
    for (const TorusAt& known : tori_) {
      if (known.torus->has_surface_of(torus)) return &known.polynomial;
    }
    return nullptr;
  }

  const Point<D>& point_;
  std::vector<const Quadric<D>*> quadrics_;
  std::vector<TorusAt> tori_;
};

// Primitives whose neighbourhoods are known.
template <class P>
concept HasGerms = (P::dimension == 2 || P::dimension == 3) &&
                   requires(SurfacesAt<P::dimension>& surfaces, const P& primitive) {
  surfaces.add(primitive);
};

// REQUIRES every primitive of the tree is On at the point
template <HasGerms P>
PointClass classify_neighbourhood(const csg::BooleanTree<P>& tree,
                                  const Point<P::dimension>& point) {
  SurfacesAt<P::dimension> surfaces(point);
  csg::for_each_primitive(tree, [&](const P& primitive) { surfaces.add(primitive); });
  const std::vector<GermSurface<P::dimension>> all = surfaces.all();
  auto [germs, complete] = germs_at(point, std::span<const GermSurface<P::dimension>>(all));
  bool has_in = false;
  bool has_out = false;
  for (const Germ<P::dimension>& germ : germs) {
    const csg::Membership value = csg::membership_of(
        tree, [&](const P& primitive) { return surfaces.membership(primitive, germ); });
    complete = complete && value != csg::Membership::Unknown;
    has_in = has_in || value == csg::Membership::In;
    has_out = has_out || value == csg::Membership::Out;
    if (has_in && has_out) return PointClass::On;
  }
  if (complete) return has_in ? PointClass::In : PointClass::Out;
  throw Error(ErrorId::UndecidedNeighbourhood,
              {std::to_string(all.size()) + " surfaces that touch", ""});
}

}  // namespace detail

template <Domain P>
PointClass classify(const csg::BooleanTree<P>& tree, const Point<P::dimension>& point) {
  const auto solve = [&](const P& primitive) { return membership(classify(primitive, point)); };
  csg::Membership known = csg::membership_of(tree, solve);
  if (known == csg::Membership::Unknown) {
    const auto local = csg::prune(tree, solve);
    if (local.primitive_count() == 1) return PointClass::On;  // it, or its complement
    if (!local.is_empty() && !local.is_full()) {
      if constexpr (detail::HasGerms<P>) {
        return detail::classify_neighbourhood(local, point);
      } else {
        throw Error(ErrorId::UndecidedNeighbourhood, {"several boundaries in one point", ""});
      }
    }
    known = local.is_full() ? csg::Membership::In : csg::Membership::Out;
  }
  return known == csg::Membership::In ? PointClass::In : PointClass::Out;
}

template <Domain P>
csg::Membership classify(const csg::BooleanTree<P>& tree, const Box<P::dimension>& box) {
  return csg::membership_of(tree, [&](const P& primitive) { return classify(primitive, box); });
}

template <Domain P>
Section section(const csg::BooleanTree<P>& tree, const LineSection<P::dimension>& line) {
  Section result;
  auto& crossings = result.crossings;
  csg::for_each_primitive(tree, [&](const P& primitive) {
    for (Crossing& crossing : section(primitive, line).crossings) {
      crossings.push_back(std::move(crossing));
    }
  });
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.parameter < b.parameter; });
  std::size_t count = 0;
  for (Crossing& crossing : crossings) {
    if (count > 0 && crossings[count - 1].parameter == crossing.parameter) {
      crossings[count - 1].multiplicity += crossing.multiplicity;
    } else {
      // A crossing is not moved onto itself.
      if (&crossings[count] != &crossing) crossings[count] = std::move(crossing);
      ++count;
    }
  }
  crossings.resize(count);
  for (std::size_t i = 0; i <= count; ++i) {
    const Rational inside = detail::parameter_between(crossings, i, line.begin, line.end);
    result.between.push_back(classify(tree, line.at(inside)));
  }
  return result;
}

// Without the crossings that have one class on both sides.
inline Section simplified(const Section& section) {
  Section result{{}, {section.between.front()}};
  for (std::size_t i = 0; i < section.crossings.size(); ++i) {
    if (section.between[i + 1] == result.between.back()) continue;
    result.crossings.push_back(section.crossings[i]);
    result.between.push_back(section.between[i + 1]);
  }
  return result;
}

template <Domain P>
csg::BooleanTree<P> apply(const AffineMap& map, const csg::BooleanTree<P>& tree) {
  return csg::map(tree, [&](const P& primitive) { return apply(map, primitive); });
}

}  // namespace exactcsg::domain
