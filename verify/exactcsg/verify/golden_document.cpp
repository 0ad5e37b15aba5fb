// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/golden_document.hpp"

#include <fstream>
#include <utility>

namespace exactcsg::verify {

void fail_golden(const std::filesystem::path& file, std::string found, std::string expected) {
  throw Error(ErrorId::GoldenFile,
              {std::move(found), std::move(expected), SourcePosition{file.string(), 0, 0}});
}

GoldenJson read_golden_models(const std::filesystem::path& file, const std::string& schema) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(ErrorId::FileNotReadable, {file.string(), "a golden file"});
  GoldenJson document;
  try {
    document = GoldenJson::parse(in);
  } catch (const nlohmann::json::exception& e) {
    fail_golden(file, e.what(), "JSON");
  }
  if (!document.is_object() || !document.contains("schema") || document["schema"] != schema) {
    fail_golden(file, "no schema of this kind of golden file",
                fmt::format("\"schema\": \"{}\"", schema));
  }
  if (!document.contains("models") || !document["models"].is_object()) {
    fail_golden(file, "no object 'models'", "\"models\": {name: entry}");
  }
  return document["models"];
}

}  // namespace exactcsg::verify
