// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string>

#include "exactcsg/io/mcnp/reader.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::openmc {

namespace {

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool is_mcnp(const std::string& ending) {
  return ending == ".mcnp" || ending == ".inp" || ending == ".i";
}

}  // namespace

Model read_geometry_file(const std::filesystem::path& file) {
  const SourcePosition position{file.string()};
  if (std::filesystem::is_directory(file)) {
    throw Error(ErrorId::FileNotReadable, {"a directory", "a file", position});
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(ErrorId::FileNotReadable, {"", "", position});
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  if (text.empty()) throw Error(ErrorId::EmptyFile, {"", "", position});
  return is_mcnp(ending_of(file)) ? mcnp::read_geometry(text, file.string())
                                  : read_geometry(text, file.string());
}

bool is_geometry_file(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".xml" || is_mcnp(ending);
}

}  // namespace exactcsg::io::openmc
