// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/neighbourhood.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

struct IntegerVector {
  Integer x, y, z;
};

IntegerVector normal(const Plane& plane) { return {plane.a, plane.b, plane.c}; }

IntegerVector cross(const IntegerVector& u, const IntegerVector& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

Sign side(const IntegerVector& u, const IntegerVector& v) {
  return sign_of(Integer(u.x * v.x + u.y * v.y + u.z * v.z));
}

class Neighbourhood {
 public:
  Neighbourhood(std::span<const Plane> planes,
                const std::function<Membership(std::span<const Sign>)>& membership)
      : membership_(membership), along_(planes.size()), sides_(planes.size()) {
    for (const Plane& plane : planes) normals_.push_back(normal(plane));
  }

  PointClass classify() {
    if (normals_.empty()) {
      ask();
    } else if (normals_.size() == 1) {
      for (const Sign s : {Sign::Positive, Sign::Negative}) {
        sides_[0] = s;
        ask();
      }
    }
    for (std::size_t i = 0; i < normals_.size() && !decided(); ++i) {
      for (std::size_t j = i + 1; j < normals_.size() && !decided(); ++j) {
        visit_line(cross(normals_[i], normals_[j]));
      }
    }
    if (in_ && out_) return PointClass::On;
    return in_ ? PointClass::In : PointClass::Out;
  }

 private:
  bool decided() const { return in_ && out_; }

  void ask() { (membership_(sides_) == Membership::In ? in_ : out_) = true; }

  // The cells at both ends of a line: between the planes that contain it.
  void visit_line(const IntegerVector& line) {
    std::vector<std::size_t> containing;
    for (std::size_t k = 0; k < normals_.size(); ++k) {
      along_[k] = side(normals_[k], line);
      if (along_[k] == Sign::Zero) containing.push_back(k);
    }
    for (const std::size_t k : containing) {
      const IntegerVector within = cross(normals_[k], line);
      std::vector<Sign> turn(normals_.size(), Sign::Zero);
      std::vector<Sign> off(normals_.size(), Sign::Zero);
      for (const std::size_t m : containing) {
        turn[m] = side(normals_[m], within);
        off[m] = side(normals_[m], normals_[k]);
      }
      for (const Sign end : {Sign::Positive, Sign::Negative}) {
        for (const Sign direction : {Sign::Positive, Sign::Negative}) {
          for (const Sign leave : {Sign::Positive, Sign::Negative}) {
            for (std::size_t m = 0; m < normals_.size(); ++m) {
              sides_[m] = along_[m] != Sign::Zero ? along_[m] * end
                          : turn[m] != Sign::Zero ? turn[m] * direction
                                                  : off[m] * leave;
            }
            ask();
            if (decided()) return;
          }
        }
      }
    }
  }

  const std::function<Membership(std::span<const Sign>)>& membership_;
  std::vector<IntegerVector> normals_;
  std::vector<Sign> along_;
  std::vector<Sign> sides_;
  bool in_ = false;
  bool out_ = false;
};

}  // namespace

PointClass classify_neighbourhood(
    std::span<const Plane> planes_through_point,
    const std::function<Membership(std::span<const Sign> sides)>& membership) {
  return Neighbourhood(planes_through_point, membership).classify();
}

}  // namespace exactcsg
