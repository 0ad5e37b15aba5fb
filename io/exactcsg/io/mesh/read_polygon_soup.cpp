// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <system_error>

#include "exactcsg/io/mesh/mesh_readers.hpp"

namespace exactcsg::io {

namespace {

using Reader = PolygonSoup (*)(std::string_view, const std::string&);

struct Ending {
  std::string_view text;
  Reader reader;
};
constexpr std::array<Ending, 4> endings = {
    {{".off", read_off}, {".stl", read_stl}, {".obj", read_obj}, {".ply", read_ply}}};

Reader reader_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const Ending& known : endings) {
    if (ending == known.text) return known.reader;
  }
  throw Error(ErrorId::UnknownFormat, {"the ending \"" + ending + "\"", ".off, .stl, .obj or .ply",
                                       SourcePosition{file.string()}});
}

std::string contents(const std::filesystem::path& file) {
  const auto refuse = [&](ErrorId id, const std::string& found) {
    throw Error(id, {found, "a mesh file", SourcePosition{file.string()}});
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) refuse(ErrorId::FileNotReadable, "no such file");
  if (!std::filesystem::is_regular_file(status)) {
    refuse(ErrorId::FileNotReadable, "not a regular file");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(ErrorId::FileNotReadable, "a file that may not be read");
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) refuse(ErrorId::FileNotReadable, "a file that cannot be read to its end");
  if (bytes.empty()) refuse(ErrorId::EmptyFile, "0 bytes");
  if (bytes.starts_with("PK\x03\x04")) refuse(ErrorId::UnknownFormat, "a zip archive");
  return bytes;
}

}  // namespace

PolygonSoup read_polygon_soup(const std::filesystem::path& file) {
  const Reader reader = reader_of(file);
  const std::string bytes = contents(file);
  PolygonSoup soup = reader(bytes, file.string());
  if (soup.vertices.size() > std::numeric_limits<std::uint32_t>::max() ||
      soup.facets.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorId::TooLarge,
                {"more than 2^32 vertices or facets", "", SourcePosition{file.string()}});
  }
  return soup;
}

}  // namespace exactcsg::io
