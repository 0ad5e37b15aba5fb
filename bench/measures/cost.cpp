// SPDX-License-Identifier: GPL-3.0-or-later
// What proved bounds cost: cells and time against width, and random points for comparison. Prints
// docs/measure-cost.md. `./dev bench measures` runs it.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "exactcsg/io/openmc/region_bounds.hpp"
#include "exactcsg/measure/area.hpp"
#include "exactcsg/verify/monte_carlo.hpp"
#include "measure/curved_solids.hpp"
#include "measure/curved_tori.hpp"

namespace exactcsg {
namespace {

using measure::test::KnownSolid;
using measure::test::KnownTorus;
using measure::test::to_width;

template <class Work>
double seconds_of(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Cost {
  std::uint64_t cells;
  double seconds;
};
struct Row {
  std::string name;
  std::vector<Cost> costs;
};

template <class Measure>
Row row_of(const std::string& name, const std::vector<double>& widths, Measure&& measure) {
  Row row{name, {}};
  for (const double width : widths) {
    measure::CertifiedMeasure result;
    const double seconds = seconds_of([&] { result = measure(width); });
    row.costs.push_back({result.cells, seconds});
  }
  return row;
}

void print_table(const std::vector<double>& widths, const std::vector<Row>& rows) {
  std::string header = "| solid |";
  std::string line = "| --- |";
  for (const double width : widths) {
    header += fmt::format(" {:.0e} |", width);
    line += " --- |";
  }
  fmt::print("{}\n{}\n", header, line);
  for (const Row& row : rows) {
    std::string text = "| " + row.name + " |";
    for (const Cost& cost : row.costs)
      text += fmt::format(" {} / {:.3f} s |", cost.cells, cost.seconds);
    fmt::print("{}\n", text);
  }
}

// Both axes logarithmic; a letter for each solid.
void print_plot(const std::vector<double>& widths, const std::vector<Row>& rows) {
  constexpr int lines_per_decade = 3;
  constexpr std::size_t columns_per_width = 8;
  constexpr int decades = 7;
  std::vector<std::string> grid(decades * lines_per_decade + 1,
                                std::string(columns_per_width * widths.size(), ' '));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t w = 0; w < widths.size(); ++w) {
      const double height = std::log10(static_cast<double>(rows[r].costs[w].cells));
      const auto line = static_cast<std::size_t>(
          std::clamp(std::lround(height * lines_per_decade), 0L, long{decades * lines_per_decade}));
      std::size_t column = w * columns_per_width;
      while (grid[line][column] != ' ' && column + 1 < (w + 1) * columns_per_width) ++column;
      grid[line][column] = static_cast<char>('a' + static_cast<int>(r));
    }
  }
  fmt::print("\n```\ncells\n");
  for (std::size_t line = grid.size(); line-- > lines_per_decade;) {
    fmt::print("{:>6} |{}\n",
               line % lines_per_decade == 0 ? fmt::format("1e{}", line / lines_per_decade) : "",
               grid[line]);
  }
  std::string axis(8, ' ');
  for (const double width : widths) axis += fmt::format("{:<8.0e}", width);
  fmt::print("{}width\n", axis);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    fmt::print("  {} {}\n", static_cast<char>('a' + static_cast<int>(r)), rows[r].name);
  }
  fmt::print("```\n");
}

template <class Known>
Row row_of_area(const Known& known, const std::vector<double>& widths) {
  return row_of(known.name, widths,
                [&](double width) { return measure::area(known.set, known.box, to_width(width)); });
}

void print_solids() {
  const std::vector<double> widths{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};
  std::vector<Row> volumes;
  std::vector<Row> areas;
  for (const KnownSolid& known : measure::test::known_solids()) {
    volumes.push_back(row_of(known.name, widths, [&](double width) {
      return measure::volume(known.set, known.box, to_width(width));
    }));
    if (known.area) areas.push_back(row_of_area(known, widths));
  }
  const std::vector<double> torus_widths{1e-3, 1e-6, 1e-9};
  std::vector<Row> torus_areas;
  for (const KnownTorus& known : measure::test::known_tori()) {
    if (known.area) torus_areas.push_back(row_of_area(known, torus_widths));
  }
  fmt::print("## Volumes\n\n");
  print_table(widths, volumes);
  print_plot(widths, volumes);
  fmt::print("\n## Areas\n\n");
  print_table(widths, areas);
  print_plot(widths, areas);
  fmt::print("\n");
  print_table(torus_widths, torus_areas);
}

void print_comparison(const std::string& name) {
  constexpr double width = 1e-4;
  constexpr double many = 1e8;
  constexpr std::uint64_t points = 400'000;
  const io::openmc::Model model =
      io::openmc::read_geometry_file(EXACTCSG_SOURCE_DIR "/data/openmc/" + name + ".xml");
  io::openmc::VolumeLimits limits;
  limits.relative_width = width;
  const double certified = seconds_of([&] { io::openmc::measure_volumes(model, limits); });
  const domain::Box<3> box = io::openmc::box_of_root(model);
  verify::SamplingBox sampling{};
  for (std::size_t i = 0; i < 3; ++i) {
    sampling.lower[i] = nearest_double(box.lower()[i]);
    sampling.upper[i] = nearest_double(box.upper()[i]);
  }
  std::vector<verify::SampledVolume> sampled;
  const double seconds =
      seconds_of([&] { sampled = verify::sample_volumes(model, sampling, points, 1); });
  double worst = 0;
  for (const verify::SampledVolume& volume : sampled) {
    if (volume.hits > 0) worst = std::max(worst, volume.deviation / volume.estimate);
  }
  const double more = many / static_cast<double>(points);
  fmt::print("| {} | {:.3f} s | {:.2f} s | {:.0f} s | {:.1e} |\n", name, certified, seconds,
             seconds * more, 6 * worst / std::sqrt(more));
}

void print_document() {
  fmt::print(
      "<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n"
      "<!-- Written by ./dev bench measures. -->\n"
      "# What proved bounds cost\n\n"
      "Cells of the decomposition and time on one core, against the relative width asked for. "
      "Solids:\n"
      "`tests/measure/curved_solids.hpp`.\n\n");
  print_solids();
  fmt::print(
      "\n## Against random points\n\n"
      "Volumes of all cells with all instances, to a proved relative width of 1e-4; and as many\n"
      "random points as are often taken, 1e8, by the same program in plain doubles: measured for\n"
      "400 000 and extrapolated. Their last column is six standard deviations of the worst cell,\n"
      "relative, after all of them: an estimate, no proof.\n\n"
      "| model | proved 1e-4 | 4e5 points | 1e8 points (extrapolated) | their width |\n"
      "| --- | --- | --- | --- | --- |\n");
  for (const char* name : {"pin_cell", "assembly_17x17"}) print_comparison(name);
}

}  // namespace
}  // namespace exactcsg

int main() {
  exactcsg::print_document();
  return 0;
}
