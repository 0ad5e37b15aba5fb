// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What files of golden values have in common: JSON of a schema, with one object for each model.

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "exactcsg/support/error.hpp"

namespace exactcsg::verify {

using GoldenJson = nlohmann::ordered_json;

[[noreturn]] void fail_golden(const std::filesystem::path& file, std::string found,
                              std::string expected);

// {"schema": ..., "models": {name: entry}} -> its models.
// THROWS Error(FileNotReadable | GoldenFile)
GoldenJson read_golden_models(const std::filesystem::path& file, const std::string& schema);

// THROWS Error(GoldenFile)
template <class Value>
Value golden_field(const std::filesystem::path& file, const std::string& name,
                   const GoldenJson& entry, const char* key) {
  if (!entry.is_object())
    fail_golden(file, fmt::format("entry '{}' is no object", name), "an object");
  const auto found = entry.find(key);
  if (found == entry.end()) {
    fail_golden(file, fmt::format("entry '{}' without '{}'", name, key),
                "every field of the schema");
  }
  try {
    return found->template get<Value>();
  } catch (const nlohmann::json::exception& e) {
    fail_golden(file, fmt::format("'{}' of entry '{}': {}", key, name, e.what()),
                "the schema's type");
  }
}

}  // namespace exactcsg::verify
