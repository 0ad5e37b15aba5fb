// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/golden.hpp"

#include <fmt/format.h>

#include <fstream>

#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/measures.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/golden_document.hpp"

namespace exactcsg::verify {
namespace {

using Json = GoldenJson;

constexpr const char* schema = "exactcsg.golden/1";
constexpr int digits = 17;
constexpr std::size_t longest_fraction = 1000;

GoldenEntry entry_of(const std::filesystem::path& file, const std::string& name,
                     const Json& value) {
  GoldenEntry entry;
  entry.digest = golden_field<std::string>(file, name, value, "digest");
  entry.volume = golden_field<std::string>(file, name, value, "volume");
  const auto exact = golden_field<Json>(file, name, value, "volume_exact");
  if (!exact.is_null()) {
    entry.volume_exact = golden_field<std::string>(file, name, value, "volume_exact");
  }
  entry.area = golden_field<std::string>(file, name, value, "area");
  entry.vertices = golden_field<std::uint64_t>(file, name, value, "vertices");
  entry.edges = golden_field<std::uint64_t>(file, name, value, "edges");
  entry.faces = golden_field<std::uint64_t>(file, name, value, "faces");
  entry.components = golden_field<std::uint64_t>(file, name, value, "components");
  entry.genus = golden_field<std::int64_t>(file, name, value, "genus");
  entry.source = golden_field<std::string>(file, name, value, "source");
  return entry;
}

Json json_of(const GoldenEntry& entry) {
  return {{"digest", entry.digest},
          {"volume", entry.volume},
          {"volume_exact", entry.volume_exact ? Json(*entry.volume_exact) : Json(nullptr)},
          {"area", entry.area},
          {"vertices", entry.vertices},
          {"edges", entry.edges},
          {"faces", entry.faces},
          {"components", entry.components},
          {"genus", entry.genus},
          {"source", entry.source}};
}

}  // namespace

GoldenEntry golden_entry(const Boundary& boundary, std::string source) {
  GoldenEntry entry;
  entry.digest = digest(boundary);
  const std::optional<Rational> exact = exact_volume(boundary);
  if (exact) {
    entry.volume = to_decimal(*exact, digits);
    std::string text = to_text(*exact);
    if (text.size() <= longest_fraction) entry.volume_exact = std::move(text);
  } else {
    entry.volume = to_decimal([&](int bits) { return enclose_volume(boundary, bits); }, digits);
  }
  entry.area = boundary.empty()
                   ? "0"
                   : to_decimal([&](int bits) { return enclose_area(boundary, bits); }, digits);
  const Topology counts = topology(boundary);
  entry.vertices = counts.vertices;
  entry.edges = counts.edges;
  entry.faces = counts.faces;
  entry.components = counts.components;
  entry.genus = counts.genus;
  entry.source = std::move(source);
  return entry;
}

GoldenFile read_golden(const std::filesystem::path& file) {
  GoldenFile golden;
  const Json models = read_golden_models(file, schema);
  for (const auto& [name, value] : models.items()) {
    golden.models.emplace(name, entry_of(file, name, value));
  }
  return golden;
}

void write_golden(const GoldenFile& golden, const std::filesystem::path& file) {
  Json models = Json::object();
  for (const auto& [name, entry] : golden.models) models[name] = json_of(entry);
  std::ofstream out(file, std::ios::binary);
  out << Json{{"schema", schema}, {"models", std::move(models)}}.dump(2) << "\n";
  out.flush();
  if (!out) throw Error(ErrorId::FileNotWritable, {file.string(), "a writable file"});
}

Check check_golden(const GoldenFile& golden, const std::string& name, const Boundary& boundary) {
  Check check;
  check.oracle = "golden";
  check.name = "golden: " + name;
  check.bound = "0 (equal)";
  const auto found = golden.models.find(name);
  if (found == golden.models.end()) {
    check.verdict = Verdict::Failed;
    check.theirs = "no entry";
    check.explanation = fmt::format(
        "the golden file has no entry '{}': a missing value is a failure; record it with 'exactcsg "
        "golden record' once it is known by other means",
        name);
    return check;
  }
  const GoldenEntry& expected = found->second;
  const GoldenEntry ours = golden_entry(boundary, expected.source);
  check.ours = ours.digest.substr(0, 12);
  check.theirs = expected.digest.substr(0, 12);
  check.explanation = "known by: " + expected.source;
  const auto compare = [&](const char* key, const std::string& a, const std::string& b) {
    if (a != b) add_mismatch(check, {fmt::format("{}: ours {}, golden {}", key, a, b), {}});
  };
  compare("digest", ours.digest, expected.digest);
  compare("volume", ours.volume, expected.volume);
  compare("volume_exact", ours.volume_exact.value_or("null"),
          expected.volume_exact.value_or("null"));
  compare("area", ours.area, expected.area);
  compare("vertices", std::to_string(ours.vertices), std::to_string(expected.vertices));
  compare("edges", std::to_string(ours.edges), std::to_string(expected.edges));
  compare("faces", std::to_string(ours.faces), std::to_string(expected.faces));
  compare("components", std::to_string(ours.components), std::to_string(expected.components));
  compare("genus", std::to_string(ours.genus), std::to_string(expected.genus));
  return check;
}

}  // namespace exactcsg::verify
