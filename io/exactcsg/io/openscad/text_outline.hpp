// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Text as OpenSCAD 2021.01 draws it: the font that fontconfig finds, shaped by HarfBuzz, outlines
// by FreeType, curves cut into segments. All numbers are the doubles that OpenSCAD computes, in its
// order of operations. This is the only place that knows these three libraries.
//
// LAW text.1  with the same fonts, libraries, environment and locale the paths are those that
//             OpenSCAD hands to its clipping library, coordinate by coordinate.
// LAW text.2  of a text whose letters do not influence one another (no kerning, no ligatures) the
//             letters are those of its parts, each moved by the advance of those before it.
// Source: OpenSCAD's src/text.cc, src/FreetypeRenderer.cc, src/DrawingCallback.cc, src/FontCache.cc
// (2021.01): learnt from, not copied.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/io/openscad/tessellation.hpp"

namespace exactcsg::io::openscad {

// No text may have more bytes than this: most letters have at least three vertices.
constexpr std::size_t text_byte_limit = shape_vertex_limit;

enum class HorizontalAlignment : std::uint8_t { Left, Center, Right };
enum class VerticalAlignment : std::uint8_t { Baseline, Bottom, Center, Top };

// What a text node asks for. Empty direction and script: found out from the characters; empty font:
// OpenSCAD's default.
struct TextShape {
  std::string text;  // in UTF-8
  double size = 10;
  double spacing = 1;
  std::string font;
  std::string direction;
  std::string language = "en";
  std::string script;
  HorizontalAlignment horizontal = HorizontalAlignment::Left;
  VerticalAlignment vertical = VerticalAlignment::Baseline;
  Fineness fineness;
};

// Closed paths with a direction: inside is where their winding number is not 0.
using LetterPaths = std::vector<std::vector<std::array<double, 2>>>;

struct TextOutline {
  std::vector<LetterPaths> letters;  // those that have an outline, in their order on the line
  // What the user should know: another font than the one asked for (said once a font), characters
  // that it does not have, bytes that are not UTF-8.
  std::vector<std::string> remarks;
};

// The fonts of this machine, opened when first needed. One object is for one thread at a time;
// several are independent.
class TextOutlines {
 public:
  TextOutlines();
  TextOutlines(const TextOutlines&) = delete;
  TextOutlines& operator=(const TextOutlines&) = delete;
  ~TextOutlines();

  // THROWS Error(FontUnavailable) if no outline font can be found or read;
  // Error(BadArgument) if neither the node nor the characters tell the direction;
  // Error(TooLarge) beyond text_byte_limit or shape_vertex_limit.
  // COST: O(length of the text), and once a font and letter what FreeType takes for it; the
  // first call loads fontconfig's configuration.
  TextOutline outline(const TextShape& shape);

  // Those that outlines came from so far, in the order of their first use.
  const std::vector<FontFile>& fonts() const;

 private:
  class Library;
  std::unique_ptr<Library> library_;
};

}  // namespace exactcsg::io::openscad
