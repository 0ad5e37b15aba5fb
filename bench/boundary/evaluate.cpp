// SPDX-License-Identifier: GPL-3.0-or-later
// One workload of the comparison of boundary evaluators in a process of its own:
//   boundary_evaluate solve NAME SIZE [THREADS]   a line of JSON: times, memory, figures, checks
//   boundary_evaluate change NAME SIZE [THREADS]  the same after one primitive of it was moved
//   boundary_evaluate csg NAME SIZE               the model for OpenSCAD
//   boundary_evaluate leaves NAME SIZE FILE       the model for bench/boundary/manifold.mjs
// The clock runs from the solid in memory to the canonical boundary with volume, area and digest.

#include <fmt/format.h>

#include <bit>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/boundary/line_sampling.hpp"
#include "bench/boundary/process_figures.hpp"
#include "bench/boundary/workloads.hpp"
#include "cli/allocator.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/figures.hpp"
#include "exactcsg/solid/incremental_evaluation.hpp"
#include "exactcsg/solid/scaled_vertices.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t longest_fraction = 256;  // bits of an exact volume that is looked for

Json tiers(const TierStatistics& statistics) {
  constexpr std::array<const char*, tier_count> names{"symbolic", "double", "fixed", "unbounded"};
  Json result;
  for (std::size_t i = 0; i < tier_count; ++i) {
    result[names[i]] = {{"answers", statistics.answers[i]}, {"zeros", statistics.zeros[i]}};
  }
  return result;
}

// What a result differs in from what is expected, and in what it was checked.
struct Verdict {
  std::vector<std::string> wrong;
  std::vector<std::string> checked;

  void check(const std::string& what, bool right) { (right ? checked : wrong).push_back(what); }
};

void check_closed_forms(const Boundary& boundary, const Expectation& expected, Verdict& verdict) {
  if (expected.volume) {
    verdict.check("volume", boundary.empty() ? *expected.volume == 0
                                             : exact_volume(boundary) == expected.volume);
  }
  if (expected.area) {
    verdict.check("area",
                  boundary.empty() ? *expected.area == 0 : exact_area(boundary) == expected.area);
  }
  if (expected.counts) {
    const std::array<std::uint64_t, 3> counts{boundary.vertices.size(), boundary.edges.size(),
                                              boundary.faces.size()};
    verdict.check("counts", counts == *expected.counts);
  }
  if (expected.genus) verdict.check("genus", topology(boundary).genus == *expected.genus);
}

// Five standard errors, each rather too large: chance does not get there.
void check_by_lines(const Solid& solid, double volume, Verdict& verdict) {
  const SampledVolume sampled = LineSampling(solid, 100)();
  verdict.check(fmt::format("lines within {:.1e}", sampled.standard_error / volume),
                std::abs(sampled.volume - volume) <= 5 * sampled.standard_error);
}

struct Answer {
  Boundary boundary;
  MeasuredFigures figures;
  std::string digest;
  double seconds = 0;
  Json phases;
};

Answer answer_of(const Solid& solid, const EvaluateOptions& options) {
  Answer answer;
  const Stopwatch clock;
  answer.boundary = evaluate(solid, options);
  const double evaluated = clock.seconds();
  const auto take_figures = [&] {
    const bool exactly = has_short_common_denominator(answer.boundary);
    answer.figures =
        measure(answer.boundary, 17, exactly ? longest_fraction : 0, Wanted::VolumeAndArea);
  };
  const auto take_digest = [&] { answer.digest = digest(answer.boundary); };
  in_parallel(options.threads, 2,
              [&](std::size_t which) { which == 0 ? take_figures() : take_digest(); });
  answer.seconds = clock.seconds();
  answer.phases = {{"evaluate", evaluated}, {"measure and digest", answer.seconds - evaluated}};
  return answer;
}

Json solve_tree(const std::string& name, std::size_t size, unsigned threads) {
  const Workload workload = make_workload(name, size);
  const Stopwatch reading;
  const Solid solid = solid_of(workload.model, threads);  // checks meshes, places copies of shapes
  Json result;
  result["load"] = reading.seconds();

  EvaluateOptions options;
  options.threads = threads;
  Answer answer = answer_of(solid, options);
  result["peak_kilobytes"] = peak_kilobytes();
  for (int run = 1; run < runs_if_one_takes(answer.seconds); ++run) {
    Answer again = answer_of(solid, options);
    if (again.seconds < answer.seconds) answer = std::move(again);
  }
  const Boundary& boundary = answer.boundary;
  const MeasuredFigures& figures = answer.figures;
  result["digest"] = answer.digest;
  result["seconds"] = answer.seconds;
  result["phases"] = answer.phases;
  result["volume"] = figures.volume_decimal;
  result["area"] = figures.area_decimal;
  result["counts"] = {boundary.vertices.size(), boundary.edges.size(), boundary.faces.size()};
  const EvaluationStatistics& statistics = boundary.statistics;
  result["primitives"] = statistics.primitives;
  result["facets"] = statistics.facets;
  result["cells"] = {statistics.cells, statistics.evaluated_cells};
  result["tiers"] = tiers(statistics.tiers);

  Verdict verdict;
  check_closed_forms(boundary, workload.expected, verdict);
  if (!workload.expected.volume) {
    check_by_lines(solid, std::strtod(figures.volume_decimal.c_str(), nullptr), verdict);
  }
  result["checked"] = verdict.checked;
  result["wrong"] = verdict.wrong;
  return result;
}

// The cubes of a sequence that are there after so many operations, as one union.
Solid union_after(const CubeSequence& sequence, const std::vector<Primitive>& cubes,
                  std::size_t operations) {
  const std::size_t united = sequence.united.size();
  std::map<std::array<int, 3>, Solid> present;
  for (std::size_t i = 0; i < std::min(operations, united); ++i) {
    present.emplace(sequence.united[i], Solid::primitive(cubes[i]));
  }
  for (std::size_t i = united; i < operations; ++i) present.erase(sequence.subtracted[i - united]);
  std::vector<Solid> operands;
  for (const auto& [place, cube] : present) operands.push_back(cube);
  if (operands.empty()) return Solid::empty();
  return Solid::compose(csg::BooleanOperator::Union, std::move(operands));
}

// The operands in the order of the operations; a cube is one primitive both times.
std::vector<Primitive> operands_of(const CubeSequence& sequence) {
  PrimitiveMaker primitive_of;
  std::map<std::array<int, 3>, Primitive> known;
  std::vector<Primitive> cubes;
  for (const auto* places : {&sequence.united, &sequence.subtracted}) {
    for (const auto& place : *places) {
      auto found = known.find(place);
      if (found == known.end()) {
        found = known.emplace(place, primitive_of(cube_at(place).primitive())).first;
      }
      cubes.push_back(found->second);
    }
  }
  return cubes;
}

// Every intermediate result is evaluated and measured; some are compared with full evaluations of
// the cubes that are there, after the clock was stopped.
Json solve_sequence(const std::string& name, std::size_t side, unsigned threads) {
  const CubeSequence sequence = cube_sequence(name, side);
  const std::vector<GridFigures> expected = expected_figures(sequence, side);
  const std::vector<Primitive> cubes = operands_of(sequence);
  EvaluateOptions options;
  options.threads = threads;
  Json result;
  Verdict verdict;
  TierStatistics statistics;
  std::vector<std::string> digests;
  double apply_seconds = 0;
  double merge_seconds = 0;
  bool is_empty = false;
  const Stopwatch clock;
  IncrementalEvaluation design(Solid::empty(), options);
  design.announce(std::span(cubes).first(sequence.united.size()));
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    const Stopwatch step;
    if (i < sequence.united.size()) {
      design.unite(cubes[i]);
    } else {
      design.subtract(cubes[i]);
    }
    const double applied = step.seconds();
    const Boundary boundary = design.boundary();
    apply_seconds += applied;
    merge_seconds += step.seconds() - applied;
    const MeasuredFigures figures = measure(boundary, 17, longest_fraction, Wanted::VolumeAndArea);
    digests.push_back(digest(boundary));
    statistics += boundary.statistics.tiers;
    is_empty = boundary.empty();
    if (figures.volume_decimal != std::to_string(expected[i].volume) ||
        figures.area_decimal != std::to_string(expected[i].area)) {
      verdict.wrong.push_back(fmt::format("after operation {}", i));
      break;
    }
  }
  const double seconds = clock.seconds();
  result["seconds"] = seconds;
  result["phases"] = {{"apply", apply_seconds},
                      {"merge", merge_seconds},
                      {"measure, digest", seconds - apply_seconds - merge_seconds}};
  result["peak_kilobytes"] = peak_kilobytes();
  result["load"] = 0;
  result["volume"] = "0";
  result["area"] = "0";
  result["digest"] = digests.back();
  verdict.check("empty at the end", is_empty);
  verdict.checked.push_back(fmt::format("volume and area {} times", digests.size()));
  const std::size_t stride = std::max<std::size_t>(1, digests.size() / 20);
  std::size_t compared = 0;
  bool equal = true;
  for (std::size_t i = stride - 1; i < digests.size(); i += stride) {
    equal &= digests[i] == digest(evaluate(union_after(sequence, cubes, i + 1), options));
    ++compared;
  }
  verdict.check(fmt::format("{} digests by full evaluation", compared), equal);
  result["tiers"] = tiers(statistics);
  result["checked"] = verdict.checked;
  result["wrong"] = verdict.wrong;
  return result;
}

// A primitive in the middle of the tree is moved a little, thrice: what an evaluation that is kept
// takes for that, and a full one.
Json solve_change(const std::string& name, std::size_t size, unsigned threads) {
  EvaluateOptions options;
  options.threads = threads;
  IncrementalEvaluation design(solid_of(make_workload(name, size).model, threads), options);
  design.boundary();
  const Occurrence moved{design.occurrence_count() / 2};
  Json result;
  bool equal = true;
  for (const long thousandths : {100, 37, -51}) {
    const Rational by = Rational(thousandths) / 1000;
    const Primitive primitive = apply(translation(by, by, 0), design.primitive(moved));
    const Stopwatch clock;
    const UpdateStatistics update = design.replace(moved, primitive);
    const double changed = clock.seconds();
    const Boundary boundary = design.boundary();
    const double merged = clock.seconds();
    const Boundary full = evaluate(design.solid(), options);
    const double evaluated = clock.seconds();
    equal &= digest(boundary) == digest(full);
    result["changes"].push_back({{"change", changed},
                                 {"merge", merged - changed},
                                 {"full evaluation", evaluated - merged},
                                 {"cells", update.cells},
                                 {"renewed", update.renewed_cells},
                                 {"all", update.everything}});
  }
  result["wrong"] = equal ? Json::array() : Json::array({"digest"});
  return result;
}

// ---- for other programs -----------------------------------------------------------------------

// Shapes of one kind and size are one leaf, placed by maps.
class LeafWriter {
 public:
  explicit LeafWriter(const std::string& file) : binary_(file + ".bin", std::ios::binary) {}

  Json number_of(const Shape& shape) {
    Shape unplaced = shape;
    unplaced.map = AffineMap::identity();
    const std::string key =
        fmt::format("{} {} {} {} {} {}", static_cast<int>(shape.kind), to_text(shape.sizes[0]),
                    to_text(shape.sizes[1]), to_text(shape.sizes[2]), shape.fragments,
                    static_cast<const void*>(shape.mesh.get()));
    const auto [found, added] = numbers_.try_emplace(key, leaves_.size());
    if (added) leaves_.push_back(write(*polyhedron_of(primitive_of_(unplaced))));
    return found->second;
  }

  Json leaves() const { return leaves_; }

 private:
  Json write(const StoredPolyhedron& polyhedron) {
    std::vector<std::array<double, 3>> points = nearest_doubles(polyhedron.vertices);
    std::vector<std::uint32_t> triangles;
    for (const auto facet : polyhedron.facets) {
      for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
        triangles.insert(triangles.end(), {facet[0], facet[i], facet[i + 1]});
      }
    }
    if (triangles.size() % 2 != 0) triangles.push_back(0);  // the next doubles stay aligned
    Json leaf{{"at", offset_}, {"vertices", points.size()}, {"indices", triangles.size()}};
    append(points.data(), points.size() * sizeof(points[0]));
    append(triangles.data(), triangles.size() * sizeof(triangles[0]));
    leaf["indices"] = 3 * (triangles.size() / 3);
    return leaf;
  }

  void append(const void* data, std::size_t size) {
    binary_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    offset_ += size;
  }

  PrimitiveMaker primitive_of_;
  std::ofstream binary_;
  std::size_t offset_ = 0;
  std::map<std::string, std::size_t> numbers_;
  Json leaves_ = Json::array();
};

Json placed(const Shape& shape, LeafWriter& writer) {
  Json map = Json::array();
  for (const auto& row : shape.map.m) {
    for (const Rational& entry : row) map.push_back(nearest_double(entry));
  }
  return {{"leaf", writer.number_of(shape)}, {"map", map}};
}

// FILE.json: the leaves' places in FILE.bin, and the tree in postfix order; FILE.bin: vertices as
// doubles, then triangles as 32-bit integers, in the byte order of the machine.
void write_leaves(const std::string& name, std::size_t size, const std::string& file) {
  static_assert(std::endian::native == std::endian::little);
  using Cursor = Model::Cursor;
  const Workload workload = make_workload(name, size);
  LeafWriter writer(file);
  Json program = Json::array();
  csg::walk(
      workload.model.root(), [](Cursor) { return true; },
      [&](Cursor node) { program.push_back(placed(node.primitive(), writer)); },
      [&](Cursor node) {
        const bool is_union = node.operation() == csg::BooleanOperator::Union;
        program.push_back({{"operation", is_union ? "union" : "difference"},
                           {"operands", node.tree().children().size()}});
      });
  Json document{{"program", program}, {"leaves", writer.leaves()}};
  if (is_cube_sequence(name)) {
    // After each operation, in the order of the program's primitives.
    for (const GridFigures& figures : expected_figures(cube_sequence(name, size), size)) {
      document["expected"].push_back({figures.volume, figures.area});
    }
  }
  std::ofstream(file + ".json") << document.dump();
}

int usage() {
  fmt::print(stderr, "boundary_evaluate solve|change|csg|leaves NAME SIZE [THREADS|FILE]\n");
  return 2;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 3) return usage();
  const std::string& command = arguments[0];
  const std::string& name = arguments[1];
  const std::size_t size = std::stoul(arguments[2]);
  if (command == "csg") {
    std::cout << csg_of(make_workload(name, size).model);
  } else if (command == "leaves" && arguments.size() > 3) {
    write_leaves(name, size, arguments[3]);
  } else if (command == "solve" || command == "change") {
    const auto threads =
        arguments.size() > 3 ? static_cast<unsigned>(std::stoul(arguments[3])) : 1U;
    if (command == "change") {
      const Json changes = solve_change(name, size, threads);
      std::cout << changes.dump() << std::endl;
      return changes["wrong"].empty() ? 0 : 1;
    }
    const Json result = is_cube_sequence(name) ? solve_sequence(name, size, threads)
                                               : solve_tree(name, size, threads);
    std::cout << result.dump() << std::endl;
    return result["wrong"].empty() ? 0 : 1;
  } else {
    return usage();
  }
  return 0;
}

}  // namespace
}  // namespace exactcsg::bench

int main(int count, char** values) {
  exactcsg::cli::use_huge_pages();
  try {
    return exactcsg::bench::run({values + 1, values + count});
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
