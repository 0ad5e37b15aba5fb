// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Golden values: a JSON file of digests, figures and counts per model, with a word on how each
// value is known. A missing entry is a failure, never a fresh recording. [Exact]
//
// {"schema": "exactcsg.golden/1", "models": {"bracket": {"digest": ..., "volume": decimal,
//  "volume_exact": fraction or null, "area": decimal, "vertices": ..., "edges": ..., "faces": ...,
//  "components": ..., "genus": ..., "source": how the values are known}}}

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct GoldenEntry {
  std::string digest;
  std::string volume;                       // 17 significant digits, correctly rounded
  std::optional<std::string> volume_exact;  // where it has at most 1000 characters
  std::string area;                         // 17 significant digits, correctly rounded
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t faces = 0;
  std::uint64_t components = 0;
  std::int64_t genus = 0;
  std::string source;  // "closed form (20/27)^2", "nef, equal rational"
  friend bool operator==(const GoldenEntry&, const GoldenEntry&) = default;
};

struct GoldenFile {
  std::map<std::string, GoldenEntry> models;
};

GoldenEntry golden_entry(const Boundary& boundary, std::string source);

// THROWS Error(FileNotReadable | GoldenFile): not JSON, wrong schema, a field missing or of the
// wrong type (its name is in the message).
GoldenFile read_golden(const std::filesystem::path& file);
// THROWS Error(FileNotWritable)
void write_golden(const GoldenFile& golden, const std::filesystem::path& file);

// LAW golden.1  passes iff the file has the entry and every field but `source` is equal; every
// field that differs is a mismatch that names it.
Check check_golden(const GoldenFile& golden, const std::string& name, const Boundary& boundary);

}  // namespace exactcsg::verify
