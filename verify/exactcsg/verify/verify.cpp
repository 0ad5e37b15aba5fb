// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/version.hpp"
#include "exactcsg/verify/boundary_check.hpp"
#include "exactcsg/verify/facet_complex.hpp"
#include "exactcsg/verify/golden.hpp"
#include "exactcsg/verify/mesh_comparison.hpp"
#include "exactcsg/verify/nef.hpp"
#include "exactcsg/verify/openscad.hpp"
#include "exactcsg/verify/sampling.hpp"

namespace exactcsg::verify {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_pictured_edges = 20'000;
constexpr double sampling_seconds = 10;
constexpr std::size_t most_nef_points = 200;  // each costs Nef a ray

void append(Report& report, std::vector<Check> checks) {
  for (Check& check : checks) report.checks.push_back(std::move(check));
}

// Cancellation and our own limits end the run; anything else that an oracle throws is its verdict.
bool ends_the_run(const Error& error) {
  return error.id() == ErrorId::Cancelled || error.id() == ErrorId::TimeLimit;
}

Check one_check(const std::string& oracle, Verdict verdict, std::string explanation) {
  Check check;
  check.oracle = oracle;
  check.name = oracle;
  check.verdict = verdict;
  check.explanation = std::move(explanation);
  return check;
}

class Verification {
 public:
  Verification(const io::Model& model, const Boundary& boundary, const VerifyOptions& options)
      : model_(model), boundary_(boundary), options_(options) {
    const auto known = oracle_names();
    for (const auto* list : {&options.required, &options.disabled}) {
      for (const std::string& name : *list) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
          throw Error(ErrorId::BadArgument,
                      {"oracle '" + name + "'", fmt::format("one of {}", fmt::join(known, ", "))});
        }
      }
    }
  }

  Report run() {
    const auto start = std::chrono::steady_clock::now();
    report_.model = model_.name;
    report_.library = version;
    for (const io::Warning& warning : model_.warnings) {
      report_.notes.push_back(
          fmt::format("{}:{}: {}", warning.position.line, warning.position.column, warning.text));
    }
    bool usable = true;
    guarded("boundary", [&] { usable = run_boundary(); });
    if (usable) {
      guarded("nef", [&] { run_nef_oracle(); });
      guarded("openscad", [&] { run_openscad(); });
      if (!options_.against.empty()) guarded("against", [&] { run_against(); });
      guarded("sampling", [&] { run_sampling(); });
      guarded("laws", [&] { run_laws(); });
      if (options_.golden) guarded("golden", [&] { run_golden(); });
    }
    require_oracles(report_, options_.required);
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - start;
    report_.seconds = past.count();
    return std::move(report_);
  }

 private:
  bool enabled(const std::string& oracle) const {
    return std::find(options_.disabled.begin(), options_.disabled.end(), oracle) ==
           options_.disabled.end();
  }

  void guarded(const std::string& oracle, const std::function<void()>& work) {
    if (!enabled(oracle)) return;
    if (options_.progress != nullptr) {
      options_.progress->begin("verify", 0);
      options_.progress->check();
    }
    try {
      work();
    } catch (const Error& error) {
      if (ends_the_run(error)) throw;
      report_.checks.push_back(one_check(oracle, Verdict::Failed, error.what()));
    }
  }

  // False: the boundary is so broken that nothing else can index into it.
  bool run_boundary() {
    Check laws = check_boundary_laws(boundary_);
    const bool indices_hold = laws.verdict == Verdict::Passed || indices_are_in_range();
    report_.checks.push_back(std::move(laws));
    if (!indices_hold) return false;
    append(report_, check_measures(boundary_));
    report_.digest = digest(boundary_);
    for (std::size_t e = 0; e < std::min(boundary_.edges.size(), most_pictured_edges); ++e) {
      const BoundaryEdge& edge = boundary_.edges[e];
      report_.edges.push_back(
          {approximate(boundary_.vertices[edge.from]), approximate(boundary_.vertices[edge.to])});
    }
    return true;
  }

  bool indices_are_in_range() const {
    const std::size_t n = boundary_.vertices.size();
    for (const BoundaryEdge& edge : boundary_.edges) {
      if (edge.from >= n || edge.to >= n) return false;
    }
    for (const BoundaryFace& face : boundary_.faces) {
      if (face.plane >= boundary_.plane_count || face.loops.empty()) return false;
      for (const auto& loop : face.loops) {
        if (loop.empty()) return false;
        for (const std::uint32_t v : loop) {
          if (v >= n) return false;
        }
      }
    }
    return true;
  }

  void run_nef_oracle() {
    const auto points =
        sample_points(boundary_, std::min(options_.sample_points, most_nef_points), options_.seed);
    NefLimits limits;
    limits.seconds = options_.budget_seconds;
    limits.memory = options_.memory_limit;
    limits.progress = options_.progress;
    NefOutcome outcome = run_nef(model_.solid, points, limits);
    if (!outcome.answered) {
      report_.checks.push_back(one_check("nef", Verdict::Skipped, outcome.reason));
      return;
    }
    append(report_, compare_exactly(boundary_, outcome.result.complex, "nef", "nef"));
    nef_classes_ = std::move(outcome.result.classes);
  }

  void run_openscad() {
    OpenScadOptions options;
    options.program = options_.openscad;
    options.budget_seconds = options_.budget_seconds;
    options.memory_limit = options_.memory_limit;
    options.threads = options_.threads;
    options.progress = options_.progress;
    options.notes = &report_.notes;
    append(report_, compare_with_openscad(model_, boundary_, options_.source, options));
  }

  // A file may have been made by OpenSCAD, whose engine rounds its input to a grid: then it is an
  // export of the model as OpenSCAD reads it.
  void run_against() {
    for (const fs::path& file : options_.against) {
      MeshComparisonOptions options;
      options.label = "against " + file.filename().string();
      options.model_rounding = model_.rounding_bound;
      std::vector<Check> checks = compare_with_mesh_file(boundary_, file, options);
      if (!all_passed(checks)) {
        if (const Boundary* gridded = gridded_boundary()) {
          options.label += " (OpenSCAD's grid)";
          std::vector<Check> again = compare_with_mesh_file(*gridded, file, options);
          if (all_passed(again)) checks = std::move(again);
        }
      }
      append(report_, std::move(checks));
    }
  }

  static bool all_passed(const std::vector<Check>& checks) {
    return std::all_of(checks.begin(), checks.end(),
                       [](const Check& c) { return c.verdict == Verdict::Passed; });
  }

  const Boundary* gridded_boundary() {
    const std::string ending = options_.source.extension().string();
    if (gridded_ || (ending != ".csg" && ending != ".scad")) return gridded_ ? &*gridded_ : nullptr;
    io::ReadOptions read;
    read.rounding = io::Rounding::OpenScadGrid;
    read.progress = options_.progress;
    read.threads = options_.threads;
    try {
      gridded_ = evaluate(io::read_model(options_.source, read).solid, evaluate_options());
    } catch (const Error& error) {
      if (ends_the_run(error)) throw;
      return nullptr;
    }
    return &*gridded_;
  }

  EvaluateOptions evaluate_options() const {
    EvaluateOptions options;
    options.threads = options_.threads;
    options.progress = options_.progress;
    return options;
  }

  void run_sampling() {
    // The points that Nef classified are the first of these.
    const auto points = sample_points(boundary_, options_.sample_points, options_.seed);
    append(report_, check_sampling(model_.solid, boundary_, points, nef_classes_,
                                   std::min(sampling_seconds, options_.budget_seconds)));
  }

  void run_laws() {
    LawOptions options;
    options.samples = options_.law_samples;
    options.seed = options_.seed;
    options.budget_seconds = std::min(options.budget_seconds, options_.budget_seconds);
    options.progress = options_.progress;
    append(report_, check_laws(model_.solid, options));
  }

  void run_golden() {
    const std::string name =
        options_.golden_name.empty() ? fs::path(model_.name).stem().string() : options_.golden_name;
    report_.checks.push_back(check_golden(read_golden(*options_.golden), name, boundary_));
  }

  const io::Model& model_;
  const Boundary& boundary_;
  const VerifyOptions& options_;
  Report report_;
  std::vector<PointClass> nef_classes_;
  std::optional<Boundary> gridded_;
};

}  // namespace

std::vector<std::string> oracle_names() {
  return {"boundary", "nef", "openscad", "against", "sampling", "laws", "golden"};
}

Report verify_boundary(const io::Model& model, const Boundary& boundary,
                       const VerifyOptions& options) {
  return Verification(model, boundary, options).run();
}

Report verify_model(const io::Model& model, const VerifyOptions& options) {
  EvaluateOptions evaluation;
  evaluation.threads = options.threads;
  evaluation.progress = options.progress;
  return verify_boundary(model, evaluate(model.solid, evaluation), options);
}

}  // namespace exactcsg::verify
