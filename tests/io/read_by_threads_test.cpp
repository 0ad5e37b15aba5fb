// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes read by several threads. Expected: what one thread reads, or says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/support/error.hpp"
#include "temporary_folder.hpp"

namespace exactcsg::io {
namespace {

constexpr std::size_t around = 80;
constexpr std::size_t across = 60;

// A torus of 9600 triangles; its vertex `moved` is pulled into the opposite side, through the
// others.
std::string torus(std::size_t moved) {
  constexpr double turn = 2 * std::numbers::pi;
  std::string text = fmt::format("OFF {} {} 0\n", around * across, 2 * around * across);
  for (std::size_t i = 0; i < around * across; ++i) {
    const double u = turn * static_cast<double>(i / across) / around;
    const double v = turn * static_cast<double>(i % across) / across;
    const double distance = i == moved ? -2 : 2 + std::cos(v);
    text += fmt::format("{:.6f} {:.6f} {:.6f}\n", distance * std::cos(u), distance * std::sin(u),
                        std::sin(v));
  }
  const auto index = [](std::size_t i, std::size_t j) { return i % around * across + j % across; };
  for (std::size_t i = 0; i < around; ++i) {
    for (std::size_t j = 0; j < across; ++j) {
      const std::size_t diagonal = index(i + 1, j + 1);
      text += fmt::format("3 {} {} {}\n", index(i, j), index(i + 1, j), diagonal);
      text += fmt::format("3 {} {} {}\n", index(i, j), diagonal, index(i, j + 1));
    }
  }
  return text;
}

ReadOptions by(unsigned threads) {
  ReadOptions options;
  options.threads = threads;
  return options;
}

TEST(ReadByThreads, GivesTheSameSolid) {
  const exactcsg::test::Folder folder;
  folder.write("torus.off", torus(around * across));
  const auto file = folder.write(
      "moved.csg",
      "multmatrix([[1, 0.5, 0, 0], [0, 1, 0, 0], [0, 0, 1, 7], [0, 0, 0, 1]]) {\n"
      "  import(file = \"torus.off\", layer = \"\", origin = [0, 0], scale = 1, convexity = 1);\n"
      "}\n");
  const std::string expected = digest(evaluate(read_model(file, by(1)).solid));
  for (const unsigned threads : {2U, 0U}) {
    EXPECT_EQ(digest(evaluate(read_model(file, by(threads)).solid)), expected);
  }
}

TEST(ReadByThreads, SaysTheSameOfAMeshThatMeetsItself) {
  const exactcsg::test::Folder folder;
  const auto file = folder.write("torus.off", torus(0));
  const auto refusal = [&](unsigned threads) -> std::string {
    try {
      read_model(file, by(threads));
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), ErrorId::SelfIntersectingMesh);
      return error.what();
    }
    return "";
  };
  const std::string expected = refusal(1);
  EXPECT_FALSE(expected.empty());
  for (const unsigned threads : {2U, 0U}) EXPECT_EQ(refusal(threads), expected);
}

}  // namespace
}  // namespace exactcsg::io
