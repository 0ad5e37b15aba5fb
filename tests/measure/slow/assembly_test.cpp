// SPDX-License-Identifier: GPL-3.0-or-later
// A fuel assembly of 17 x 17 pins in water: 868 regions and 867 cylinders, proved clean, and with
// defects of a millionth planted.

#include <gtest/gtest.h>

#include <chrono>

#include "exactcsg/domain/classify.hpp"
#include "exactcsg/measure/region_proof.hpp"
#include "measure/curved_solids.hpp"

namespace exactcsg::measure::test {
namespace {

constexpr int pins = 17;
const Rational millionth(1, 1'000'000);

std::size_t clad_of(int i, int j) { return static_cast<std::size_t>(3 * (pins * i + j) + 2); }

// Fuel, gap and clad of every pin, and the water. One pin's clad has a radius of its own, which the
// water does not know of.
struct Assembly {
  std::vector<Solid3> regions;
  Box<3> box{point(-11, -11, -1), point(11, 11, 1)};

  explicit Assembly(const Rational& radius_of_pin_5_7) {
    const Rational pitch(63, 50);
    const Rational fuel(41, 100);
    const Rational gap(209, 500);
    const Rational clad(19, 40);
    std::vector<Solid3> water{Solid3::full()};
    for (int i = 0; i < pins; ++i) {
      for (int j = 0; j < pins; ++j) {
        const Point<3> centre = point(Rational(pitch * (i - 8)), Rational(pitch * (j - 8)), 0);
        const auto pin = [&](const Rational& r) { return cylinder(2, Rational(r * r), centre); };
        const Rational outer = i == 5 && j == 7 ? radius_of_pin_5_7 : clad;
        regions.push_back(pin(fuel));
        regions.push_back(csg::subtract(pin(gap), pin(fuel)));
        regions.push_back(csg::subtract(pin(outer), pin(gap)));
        water.push_back(pin(clad));
      }
    }
    regions.push_back(Solid3::compose(csg::BooleanOperator::Difference, std::move(water)));
  }
  Proof disjoint(std::size_t witnesses = 1) const {
    ProofLimits limits;
    limits.witnesses = witnesses;
    return prove_disjoint(std::span<const Solid3>(regions), box, limits);
  }
  Proof cover() const { return prove_cover(std::span<const Solid3>(regions), box); }
};

const Rational nominal(19, 40);

TEST(Assembly, IsProvedCleanWithinSeconds) {
  const Assembly assembly(nominal);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(std::holds_alternative<Proved>(assembly.disjoint()));
  EXPECT_TRUE(std::holds_alternative<Proved>(assembly.cover()));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));  // about 4
}

TEST(Assembly, ACladThatIsAMillionthTooWideOverlapsTheWater) {
  const Assembly assembly(Rational(nominal + millionth));
  const Proof proof = assembly.disjoint(10);
  const auto& refuted = std::get<Refuted>(proof);
  ASSERT_EQ(refuted.witnesses.size(), 1U);
  EXPECT_TRUE(refuted.is_complete);
  EXPECT_EQ(refuted.witnesses[0].regions,
            (std::vector<std::size_t>{clad_of(5, 7), assembly.regions.size() - 1}));
  for (const std::size_t region : refuted.witnesses[0].regions) {
    EXPECT_EQ(classify(assembly.regions[region], refuted.witnesses[0].point), PointClass::In);
  }
  EXPECT_TRUE(std::holds_alternative<Proved>(assembly.cover()));
}

TEST(Assembly, ACladThatIsAMillionthTooNarrowLeavesAGap) {
  const Assembly assembly(Rational(nominal - millionth));
  EXPECT_TRUE(std::holds_alternative<Proved>(assembly.disjoint()));
  const Proof proof = assembly.cover();
  const auto& refuted = std::get<Refuted>(proof);
  ASSERT_EQ(refuted.witnesses.size(), 1U);
  for (const Solid3& region : assembly.regions) {
    EXPECT_EQ(classify(region, refuted.witnesses[0].point), PointClass::Out);
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
