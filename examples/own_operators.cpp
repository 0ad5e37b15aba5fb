// SPDX-License-Identifier: GPL-3.0-or-later
// A user's own primitives and operators: time tables. Primitives are intervals of the day in hours,
// operators are "also" and "but not"; a traverse asks whether a shop is open, another one collects
// when. Nothing in the library knows about time.

#include <iostream>
#include <string>

#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"

namespace {

using namespace exactcsg::csg;

struct Hours {
  double from, to;
};
enum class Schedule { Also, ButNot };
using TimeTable = Tree<Hours, Schedule>;

bool is_open(const TimeTable& table, double hour) {
  return traverse(
      table, hour, [](const Hours& h, double at) { return h.from <= at && at < h.to; },
      [](bool a, Schedule op, bool b) { return op == Schedule::Also ? a || b : a && !b; });
}

std::string sentence(const TimeTable& table) {
  return traverse(
      table,
      [](const Hours& h) {
        return std::to_string(static_cast<int>(h.from)) + " to " +
               std::to_string(static_cast<int>(h.to));
      },
      [](const std::string& a, Schedule op, const std::string& b) {
        return a + (op == Schedule::Also ? " and " : " except ") + b;
      });
}

}  // namespace

int main() {
  const auto hours = [](double from, double to) { return TimeTable::primitive({from, to}); };
  const TimeTable shop = TimeTable::compose(
      Schedule::Also,
      {TimeTable::compose(Schedule::ButNot, {hours(9, 18), hours(12, 13)}), hours(20, 22)});
  std::cout << "open " << sentence(shop) << '\n';
  for (const double hour : {8.5, 11.0, 12.5, 21.0}) {
    std::cout << "at " << hour << ": " << (is_open(shop, hour) ? "open" : "closed") << '\n';
  }
}
