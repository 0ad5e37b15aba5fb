// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/golden_geometry.hpp"

#include <algorithm>
#include <utility>

#include "exactcsg/verify/golden_document.hpp"
#include "exactcsg/verify/volume_bounds.hpp"

namespace exactcsg::verify {

namespace {

constexpr const char* schema = "exactcsg.geometry_golden/1";

using namespace io::openmc;

class EntryReader {
 public:
  explicit EntryReader(const std::filesystem::path& file) : file_(file) {}

  GoldenGeometry geometry(const std::string& model, const GoldenJson& value) const {
    return {volumes(model, value, "cells"), volumes(model, value, "materials")};
  }

 private:
  std::map<std::string, GoldenVolume> volumes(const std::string& model, const GoldenJson& value,
                                              const char* kind) const {
    const auto entries = golden_field<GoldenJson>(file_, model, value, kind);
    std::map<std::string, GoldenVolume> result;
    for (const auto& [name, entry] : entries.items()) {
      const std::string place = fmt::format("{}: {}: {}", model, kind, name);
      result.emplace(name, GoldenVolume{volume(place, entry),
                                        golden_field<std::string>(file_, place, entry, "form")});
    }
    return result;
  }

  std::optional<Enclosure> volume(const std::string& place, const GoldenJson& entry) const {
    const auto value = golden_field<GoldenJson>(file_, place, entry, "volume");
    if (value.is_null()) return std::nullopt;
    if (value.is_string()) {
      const Rational exact = number(place, value);
      return Enclosure{exact, exact};
    }
    if (!value.is_array() || value.size() != 2) {
      fail_golden(file_, fmt::format("'volume' of entry '{}'", place),
                  "a number as text, two of them, or null");
    }
    Enclosure bounds{number(place, value[0]), number(place, value[1])};
    if (bounds.lower > bounds.upper) {
      fail_golden(file_, fmt::format("'volume' of entry '{}'", place), "the smaller number first");
    }
    return bounds;
  }

  Rational number(const std::string& place, const GoldenJson& value) const {
    std::optional<Rational> result;
    if (value.is_string()) result = parse_rational(value.get<std::string>());
    if (!result)
      fail_golden(file_, fmt::format("'volume' of entry '{}'", place), "a number as text");
    return *result;
  }

  const std::filesystem::path& file_;
};

Check golden_check(const std::string& name) {
  Check check;
  check.oracle = "golden";
  check.name = "golden: " + name;
  return check;
}

Check failed(Check check, std::string explanation) {
  check.verdict = Verdict::Failed;
  check.explanation = std::move(explanation);
  return check;
}

Check compared(const std::string& name, const VisibleVolume& ours, const GoldenVolume& golden) {
  Check check = golden_check(name);
  check.ours = ours.volume ? text_of(*ours.volume) : "unbounded";
  check.theirs = golden.volume ? text_of(*golden.volume) : "unbounded";
  check.explanation = "known by: " + golden.form;
  if (!ours.volume || !golden.volume) {
    if (ours.volume || golden.volume) check.verdict = Verdict::Failed;
    return check;
  }
  const Rational gap = gap_between(*ours.volume, *golden.volume);
  const Rational width = ours.volume->upper - ours.volume->lower;
  check.difference = fmt::format("{:.2g}", nearest_double(gap));
  check.bound = fmt::format("0 (bounds {:.2g} wide)", nearest_double(width));
  if (gap > 0) check.verdict = Verdict::Failed;
  return check;
}

using NamedVolumes = std::vector<std::pair<std::string, const VisibleVolume*>>;

void compare_all(const std::string& kind, const NamedVolumes& ours,
                 const std::map<std::string, GoldenVolume>& golden, std::vector<Check>& checks) {
  for (const auto& [name, volume] : ours) {
    const std::string text = fmt::format("{} {}", kind, name);
    const auto found = golden.find(name);
    checks.push_back(found != golden.end() ? compared(text, *volume, found->second)
                                           : failed(golden_check(text),
                                                    "the golden file has no value: a missing "
                                                    "value is a failure"));
  }
  for (const auto& entry : golden) {
    const std::string& name = entry.first;
    if (std::any_of(ours.begin(), ours.end(), [&](const auto& mine) { return mine.first == name; }))
      continue;
    checks.push_back(failed(golden_check(fmt::format("{} {}", kind, name)),
                            "the golden file has a value, and the model nothing of this name"));
  }
}

}  // namespace

GoldenGeometries read_golden_geometries(const std::filesystem::path& file) {
  GoldenGeometries result;
  const GoldenJson models = read_golden_models(file, schema);
  for (const auto& [name, value] : models.items()) {
    result.emplace(name, EntryReader(file).geometry(name, value));
  }
  return result;
}

std::vector<Check> check_golden(const GoldenGeometries& golden, const std::string& name,
                                const Model& model, const GeometryVolumes& volumes) {
  const auto found = golden.find(name);
  if (found == golden.end()) {
    return {failed(
        golden_check(name),
        fmt::format("the golden file has no entry '{}': a missing value is a failure", name))};
  }
  NamedVolumes cells;
  for (std::size_t i = 0; i < model.cells.size(); ++i) {
    cells.emplace_back(std::to_string(model.cells[i].id), &volumes.cells[i]);
  }
  NamedVolumes materials;
  for (const MaterialVolume& material : volumes.materials) {
    materials.emplace_back(text_of_materials(material.materials), &material.visible);
  }
  std::vector<Check> checks;
  compare_all("cell", cells, found->second.cells, checks);
  compare_all("material", materials, found->second.materials, checks);
  return checks;
}

}  // namespace exactcsg::verify
