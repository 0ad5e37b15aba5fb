// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/openscad.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/exact_sums.hpp"
#include "exactcsg/verify/mesh_comparison.hpp"
#include "exactcsg/verify/process.hpp"

namespace exactcsg::verify {
namespace {

namespace fs = std::filesystem;

Check named(const std::string& name) {
  Check check;
  check.oracle = "openscad";
  check.name = name;
  return check;
}

Check skipped(const std::string& name, std::string reason) {
  Check check = named(name);
  check.verdict = Verdict::Skipped;
  check.explanation = std::move(reason);
  return check;
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// The lines in which OpenSCAD says that it did something else than it was asked for.
std::string own_faults(const std::string& messages) {
  constexpr std::string_view signs[] = {"ERROR",     "not closed", "CGAL error",
                                        "assertion", "Can't open", "couldn't be opened"};
  std::string faults;
  std::istringstream in(messages);
  for (std::string line; std::getline(in, line);) {
    const bool bad = std::any_of(std::begin(signs), std::end(signs), [&](std::string_view sign) {
      return line.find(sign) != std::string::npos;
    });
    if (bad) faults += (faults.empty() ? "" : "; ") + line;
  }
  return faults;
}

// Said of mesh exports of solids whose surface touches itself or has membranes.
bool warns_of_exports(const std::string& messages) {
  return messages.find("may not be a valid 2-manifold") != std::string::npos;
}

bool says_empty(const std::string& messages) {
  return messages.find("top level object is empty") != std::string::npos;
}

std::string last_lines(const std::string& text) {
  constexpr std::size_t most = 400;
  return text.size() <= most ? text : "..." + text.substr(text.size() - most);
}

// Why a run gave no usable answer; empty if it did.
std::string unusable(const ProcessResult& run, const OpenScadOptions& options) {
  if (run.end == ProcessEnd::NotFound) return "'" + options.program + "' is not installed";
  if (run.end == ProcessEnd::OverTime) {
    return fmt::format("over the budget of {:g} s", options.budget_seconds);
  }
  if (run.end == ProcessEnd::Signalled) {
    return fmt::format("OpenSCAD was ended by signal {}: {}", run.status, last_lines(run.messages));
  }
  const std::string faults = own_faults(run.messages);
  if (!faults.empty()) return "OpenSCAD reports a fault of its own: " + last_lines(faults);
  if (run.status != 0 && !says_empty(run.messages)) {
    return fmt::format("OpenSCAD ended with status {}: {}", run.status, last_lines(run.messages));
  }
  return {};
}

class Runner {
 public:
  Runner(const OpenScadOptions& options, const fs::path& source) : options_(options) {
    source_ = fs::absolute(source);
    limits_.seconds = options.budget_seconds;
    limits_.memory = options.memory_limit;
    limits_.progress = options.progress;
  }

  // A .scad becomes a .csg first: the two routes of OpenSCAD differ, so both sides read the .csg.
  ProcessResult make_csg() {
    csg_ = folder_.path() / "model.csg";
    ProcessResult result = run({"--render", "-o", csg_.string(), source_.string()});
    const std::string text = read_text(csg_);
    if (text.find("import(") != text.npos || text.find("surface(") != text.npos) link_neighbours();
    return result;
  }
  void use_source_as_csg() { csg_ = source_; }

  ProcessResult export_all(bool exports) {
    std::vector<std::string> arguments{"--render=cgal", "-o", nef3().string()};
    if (exports) {
      for (const fs::path& file : {off(), stl()}) {
        arguments.push_back("-o");
        arguments.push_back(file.string());
      }
    }
    arguments.push_back(csg_.string());
    return run(std::move(arguments));
  }

  const fs::path& csg() const { return csg_; }
  fs::path nef3() const { return folder_.path() / "model.nef3"; }
  fs::path off() const { return folder_.path() / "model.off"; }
  fs::path stl() const { return folder_.path() / "model.stl"; }

 private:
  // The .csg names files relative to the source's folder, OpenSCAD looks for them beside the .csg.
  void link_neighbours() {
    std::error_code ignored;  // what cannot be linked is not found, which OpenSCAD says
    for (fs::directory_iterator entry(source_.parent_path(), ignored), end; entry != end;
         entry.increment(ignored)) {
      const fs::path link = folder_.path() / entry->path().filename();
      if (!fs::exists(link, ignored)) fs::create_symlink(entry->path(), link, ignored);
    }
  }

  ProcessResult run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), options_.program);
    return run_program(arguments, source_.parent_path(), limits_);
  }

  const OpenScadOptions& options_;
  ProcessLimits limits_;
  fs::path source_;
  fs::path csg_;
  TemporaryFolder folder_;
};

// The exact value, or its 17 digits and what they may be off by.
Enclosure enclosure_of(const VolumeSum& sum) {
  if (sum.exact) return {*sum.exact, *sum.exact};
  const Rational value = parse_rational(sum.decimal).value_or(Rational(0));
  const Rational error = abs(value) / Rational(Integer(10'000'000'000'000'000));
  return {value - error, value + error};
}

Check compare_as_written(const io::Model& model, const Boundary& boundary, const io::Model& gridded,
                         const FacetComplex& nef3) {
  Check check = named("openscad 2: as written");
  const auto bound = displacement_bound(model.solid, gridded.solid);
  Rational allowed;
  if (bound) {
    allowed = bound->volume;
    check.explanation = fmt::format(
        "bound: what moving {} of {} primitives by at most {:.3g} (OpenSCAD's grid of 2^-20) can "
        "sweep, from their areas",
        bound->moved_primitives, model.primitives, bound->largest_displacement);
  } else {
    const Boundary both = evaluate(
        Solid::compose(csg::BooleanOperator::SymmetricDifference, {model.solid, gridded.solid}));
    allowed = enclosure_of(volume_sum(both)).upper;
    check.explanation =
        "bound: the volume of the symmetric difference of the model and its reading under "
        "OpenSCAD's grid (the grid changed the form of the tree)";
  }
  const VolumeSum ours = volume_sum(boundary);
  const Enclosure a = enclosure_of(ours);
  const VolumeSum theirs = volume_sum(nef3);
  const Enclosure b = enclosure_of(theirs);
  const Rational difference = (b.lower + b.upper - a.lower - a.upper) / 2;
  check.ours = ours.decimal;
  check.theirs = theirs.decimal;
  check.difference = to_decimal(difference, 3);
  check.bound = to_decimal(allowed, 3);
  if (abs(difference) > allowed + (a.upper - a.lower) + (b.upper - b.lower)) {
    check.verdict = Verdict::Failed;
    check.explanation = fmt::format("volume differs by {}, more than the grid can explain; {}",
                                    check.difference, check.explanation);
  }
  if (!nef3.membranes.empty()) {
    check.explanation +=
        "; OpenSCAD's result has membranes without thickness (its Booleans are not regularised), "
        "which have no volume and are left out";
  }
  return check;
}

bool all_passed(const std::vector<Check>& checks) {
  return std::all_of(checks.begin(), checks.end(),
                     [](const Check& c) { return c.verdict == Verdict::Passed; });
}

// The export, and what it is held against.
struct Export {
  fs::path file;
  const FacetComplex* membranes = nullptr;
  Rational rounding{0};  // of the model's coordinates, see MeshComparisonOptions
};

std::string export_label(const fs::path& file) {
  return "openscad 3: " + file.extension().string().substr(1);
}

std::vector<Check> compare_export(const Boundary& boundary, const Export& exported) {
  MeshComparisonOptions options;
  options.oracle = "openscad";
  options.label = export_label(exported.file);
  options.model_rounding = exported.rounding;
  options.membranes = exported.membranes;
  return compare_with_mesh_file(boundary, exported.file, options);
}

// An export of a model that went through OpenSCAD's engine is on its grid; a lone primitive is not.
std::vector<Check> compare_export(const Boundary& boundary, const Boundary& gridded,
                                  const Export& exported) {
  std::vector<Check> checks = compare_export(gridded, exported);
  if (all_passed(checks)) return checks;
  std::vector<Check> plain = compare_export(boundary, exported);
  return all_passed(plain) ? plain : checks;
}

std::string failures_of(const std::vector<Check>& checks) {
  std::string text;
  for (const Check& check : checks) {
    if (check.verdict != Verdict::Failed) continue;
    text += text.empty() ? "" : "; ";
    text += check.name;
    if (!check.mismatches.empty()) text += ": " + check.mismatches.front().text;
  }
  return text;
}

// OpenSCAD itself doubts exports of solids whose surface touches itself. Where such a file differs,
// nobody knows whose fault that is: it has confirmed nothing.
std::vector<Check> unless_doubted(std::vector<Check> checks, const fs::path& file, bool doubted) {
  if (!doubted || all_passed(checks)) return checks;
  return {
      skipped(export_label(file),
              "OpenSCAD warns that this export may not be a valid 2-manifold, and it differs (" +
                  failures_of(checks) + ")")};
}

// Without a reading under OpenSCAD's rounding the exports are held against the model as written,
// with vertices displaced by what OpenSCAD can move a primitive's: in space less than one cell of
// 2^-20 by cutting, and one by joining neighbours; if they come from the plane, less than two cells
// of 2^-16. What passes agrees within that. What does not pass is undecided: vertices in which
// primitives cross may have moved further.
std::vector<Check> compare_export_without_grid(const Boundary& boundary, const Export& exported) {
  std::string failures;
  for (const int bits : {19, 15}) {
    Export displaced = exported;
    displaced.rounding += Rational(1, 1 << bits);
    std::vector<Check> checks = compare_export(boundary, displaced);
    if (!all_passed(checks)) {
      failures = failures_of(checks);
      continue;
    }
    for (Check& check : checks) {
      check.explanation +=
          fmt::format("{}OpenSCAD's grid may have moved vertices of primitives by 2^-{}",
                      check.explanation.empty() ? "" : "; ", bits);
    }
    return checks;
  }
  return {skipped(export_label(exported.file),
                  "undecided: OpenSCAD's grids may have moved vertices of primitives by 2^-15, and "
                  "vertices in which primitives cross further; beyond that the export differs from "
                  "the model as written (" +
                      failures + ")")};
}

std::vector<Check> empty_answer(const Boundary& boundary, const std::string& messages) {
  Check check = named("openscad 1: empty");
  check.ours = boundary.empty() ? "empty" : "not empty";
  check.theirs = "empty";
  check.bound = "0";
  if (!boundary.empty()) {
    check.verdict = Verdict::Failed;
    check.explanation = "OpenSCAD: " + last_lines(messages);
    add_mismatch(check, {"a vertex of our boundary", {approximate(boundary.vertices.front())}});
  }
  return {check};
}

void note(const OpenScadOptions& options, std::string text) {
  if (options.notes != nullptr) options.notes->push_back(std::move(text));
}

EvaluateOptions evaluate_options(const OpenScadOptions& options) {
  EvaluateOptions result;
  result.threads = options.threads;
  result.progress = options.progress;
  return result;
}

// nullopt: what OpenSCAD makes of the model depends on its triangulation; `refusal` says where.
std::optional<io::Model> read_on_grid(const io::Model& model, const fs::path& csg,
                                      const fs::path& folder, const OpenScadOptions& options,
                                      std::string& refusal) {
  io::ReadOptions read;
  read.folder = folder;
  read.rounding = io::Rounding::OpenScadGrid;
  read.progress = options.progress;
  read.threads = options.threads;
  try {
    return io::read_openscad_csg(read_text(csg), model.name, read);
  } catch (const Error& error) {
    if (error.id() != ErrorId::UnsupportedNode) throw;
    refusal = error.what();
    return std::nullopt;
  }
}

}  // namespace

std::vector<Check> compare_with_nef3(const Boundary& gridded, const FacetComplex& nef3) {
  std::vector<Check> checks = compare_exactly(gridded, nef3, "openscad", "openscad 1");
  if (!nef3.membranes.empty()) {
    for (Check& check : checks) {
      check.explanation += check.explanation.empty() ? "" : "; ";
      check.explanation += "OpenSCAD's membranes without thickness are left out";
    }
  }
  return checks;
}

std::vector<Check> compare_with_openscad(const io::Model& model, const Boundary& boundary,
                                         const fs::path& source, const OpenScadOptions& options) {
  const std::string ending = source.extension().string();
  if (ending != ".csg" && ending != ".scad") {
    return {skipped("openscad", source.empty() ? "the model's file is not known"
                                               : "the model is not an OpenSCAD file")};
  }
  Runner runner(options, source);
  if (ending == ".scad") {
    const ProcessResult run = runner.make_csg();
    const std::string reason = unusable(run, options);
    if (!reason.empty()) return {skipped("openscad", reason)};
    if (!fs::exists(runner.csg())) return empty_answer(boundary, run.messages);
  } else {
    runner.use_source_as_csg();
  }
  const ProcessResult run = runner.export_all(options.exports);
  const std::string reason = unusable(run, options);
  if (!reason.empty()) return {skipped("openscad", reason)};
  if (says_empty(run.messages)) return empty_answer(boundary, run.messages);
  if (!fs::exists(runner.nef3())) {
    return {skipped("openscad", "no .nef3 was made: " + last_lines(run.messages))};
  }

  FacetComplex nef3;
  try {
    nef3 = parse_nef3(read_text(runner.nef3()));
  } catch (const Error& error) {
    return {skipped("openscad", error.what())};
  }
  if (!nef3.membranes.empty()) {
    note(options,
         "OpenSCAD's result has membranes without thickness (its Booleans are not regularised); "
         "they have no volume and are left out of the comparison");
  }
  std::string refusal;
  const std::optional<io::Model> gridded =
      read_on_grid(model, runner.csg(), source.parent_path(), options, refusal);
  std::optional<Boundary> gridded_boundary;
  std::vector<Check> checks;
  if (gridded) {
    gridded_boundary = evaluate(gridded->solid, evaluate_options(options));
    checks = compare_with_nef3(*gridded_boundary, nef3);
    checks.push_back(compare_as_written(model, boundary, *gridded, nef3));
  } else {
    for (const char* name : {"openscad 1: equal", "openscad 2: as written"}) {
      checks.push_back(skipped(name, "not readable under OpenSCAD's rounding: " + refusal));
    }
  }
  if (!options.exports) return checks;
  for (const fs::path& file : {runner.off(), runner.stl()}) {
    const Export exported{file, &nef3, model.rounding_bound};
    std::vector<Check> more = gridded_boundary
                                  ? compare_export(boundary, *gridded_boundary, exported)
                                  : compare_export_without_grid(boundary, exported);
    more = unless_doubted(std::move(more), file, warns_of_exports(run.messages));
    checks.insert(checks.end(), more.begin(), more.end());
  }
  return checks;
}

}  // namespace exactcsg::verify
