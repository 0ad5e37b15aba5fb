// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/skeleton/simulated_executor.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "exactcsg/skeleton/divacon.hpp"

namespace exactcsg::skeleton {
namespace {

// The number of leaves of a perfect tree.
int leaves_of(int depth, int degree, const auto& executor) {
  return divacon(
      depth, [](int d) { return d == 0; },
      [degree](int d) { return std::vector<int>(static_cast<std::size_t>(degree), d - 1); },
      [](int) { return 1; },
      [](std::span<int> r) {
        int sum = 0;
        for (const int n : r) sum += n;
        return sum;
      },
      executor);
}
TaskGraph graph_of(int depth, int degree) {
  TaskGraph graph;
  int leaves = 1;
  for (int i = 0; i < depth; ++i) leaves *= degree;
  EXPECT_EQ(leaves_of(depth, degree, SimulatedExecutor(graph, CallCount{})), leaves);
  return graph;
}

// LAW simulate.2, .4: a perfect binary tree of depth d has 2^(d + 1) - 1 problems, 2^d - 1 of them
// divided, and 2 d + 1 tasks on every path.
TEST(SimulatedExecutor, WorkAndSpanOfAPerfectTree) {
  for (int depth = 0; depth <= 10; ++depth) {
    const TaskGraph graph = graph_of(depth, 2);
    const std::uint64_t work = (std::uint64_t{2} << depth) - 1 + (std::uint64_t{1} << depth) - 1;
    EXPECT_EQ(graph.work(), work);
    EXPECT_EQ(graph.span(), static_cast<std::uint64_t>(2 * depth + 1));
    EXPECT_EQ(schedule(graph, 1).length, work);
    EXPECT_EQ(schedule(graph, 100'000).length, graph.span());
    EXPECT_EQ(schedule(graph, 1).speed_up(), 1.0);
  }
}

// n leaves below one root, on p workers: one after the other at the root, ceil(n / p) rounds
// between.
TEST(SimulatedExecutor, LeavesAreSharedEvenly) {
  for (const int leaves : {1, 2, 7, 64}) {
    const TaskGraph graph = graph_of(1, leaves);
    for (const int workers : {1, 2, 3, 8, 100}) {
      EXPECT_EQ(schedule(graph, static_cast<std::size_t>(workers)).length,
                static_cast<std::uint64_t>(2 + (leaves + workers - 1) / workers));
    }
  }
}

// A chain has no parallelism at all.
TEST(SimulatedExecutor, AChainIsNotSpedUp) {
  const TaskGraph graph = graph_of(1000, 1);
  EXPECT_EQ(graph.work(), graph.span());
  EXPECT_EQ(schedule(graph, 8).length, graph.work());
}

// LAW simulate.3 for random trees and costs. The clock is one that the callbacks advance.
TEST(SimulatedExecutor, SchedulesAreWithinGrahamsBound) {
  std::mt19937 random(3);
  for (int round = 0; round < 100; ++round) {
    std::uint64_t time = 0;
    std::uint64_t spent = 0;
    const auto spend = [&] {
      const std::uint64_t cost = random() % 100;
      time += cost;
      spent += cost;
    };
    TaskGraph graph;
    const auto clock = [&time] { return time; };
    divacon(
        7, [&](int depth) { return depth == 0 || random() % 6 == 0; },
        [&](int depth) {
          spend();
          return std::vector<int>(random() % 5, depth - 1);
        },
        [&](int) {
          spend();
          return 0;
        },
        [&](std::span<int>) {
          spend();
          return 0;
        },
        SimulatedExecutor(graph, clock));
    EXPECT_EQ(graph.work(), spent);
    for (const std::uint64_t workers : {1U, 2U, 3U, 7U, 64U}) {
      const auto [work, length] = schedule(graph, workers);
      EXPECT_EQ(work, spent);
      EXPECT_GE(length * workers, work);
      EXPECT_GE(length, graph.span());
      EXPECT_LE(length * workers, work + graph.span() * workers);
    }
    EXPECT_EQ(schedule(graph, 1).length, spent);
    EXPECT_EQ(schedule(graph, graph.problems().size() * 2).length, graph.span());
  }
}

// What an early out does not begin costs nothing.
TEST(SimulatedExecutor, RecordsWhatWasDone) {
  TaskGraph graph;
  divacon(
      0, [](int i) { return i > 0; },
      [](int) {
        return std::vector{1, 2, 3, 4};
      },
      [](int i) { return i; },
      EarlyOut{[](std::span<int> r) { return r.back(); }, [](int r) { return r == 2; }},
      SimulatedExecutor(graph, CallCount{}));
  EXPECT_EQ(graph.work(), 4U);  // the root, the leaves 1 and 2, combine
  EXPECT_EQ(schedule(graph, 2).length, 3U);
}

TEST(SimulatedExecutor, MeasuresTimeByDefault) {
  TaskGraph graph;
  EXPECT_EQ(leaves_of(10, 2, SimulatedExecutor(graph)), 1024);
  EXPECT_GE(graph.work(), graph.span());
  EXPECT_GE(schedule(graph, 2).speed_up(), 1.0);
}

TEST(SimulatedExecutor, NeedsAWorker) {
  try {
    schedule(TaskGraph{}, 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::BadArgument);
  }
}

}  // namespace
}  // namespace exactcsg::skeleton
