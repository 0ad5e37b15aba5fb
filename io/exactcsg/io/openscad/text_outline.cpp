// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of operations in double are those of OpenSCAD 2021.01 and are part of the result.
#include "exactcsg/io/openscad/text_outline.hpp"

#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include <hb-ft.h>
#include <hb.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include FT_SFNT_NAMES_H
#include FT_TRUETYPE_IDS_H

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "exactcsg/support/error.hpp"

namespace exactcsg::io::openscad {

namespace {

namespace fs = std::filesystem;

// A line of size 1 in FreeType's units, 1/64 pixel of a device with 100 dots to the inch: OpenSCAD
// draws every text at this size and then scales it.
constexpr double unit = 1e5;
constexpr FT_UInt dots_per_inch = 100;
// Advances and boxes are divided by more (1024 instead of 1000): letters stand 2.4 % closer to one
// another than their font says.
constexpr double advance_unit = 102400;

constexpr std::string_view default_font = "Liberation Sans:style=Regular";

template <auto destroy>
struct Destroy {
  template <class T>
  void operator()(T* object) const {
    destroy(object);
  }
};
template <class T, auto destroy>
using Owned = std::unique_ptr<T, Destroy<destroy>>;

using FontConfiguration = Owned<FcConfig, FcConfigDestroy>;
using FontPattern = Owned<FcPattern, FcPatternDestroy>;
using FreeType = Owned<std::remove_pointer_t<FT_Library>, FT_Done_FreeType>;
using Face = Owned<std::remove_pointer_t<FT_Face>, FT_Done_Face>;
using ShapedFont = Owned<hb_font_t, hb_font_destroy>;
using Characters = Owned<hb_buffer_t, hb_buffer_destroy>;

[[noreturn]] void refuse_font(std::string_view asked, const std::string& why) {
  throw Error(ErrorId::FontUnavailable, {"text in '" + std::string(asked) + "', and " + why,
                                         "an outline font that fontconfig knows"});
}

const FcChar8* fontconfig_text(const std::string& text) {
  return reinterpret_cast<const FcChar8*>(text.c_str());  // NOLINT: bytes either way
}

std::string text_of(const FcChar8* text) {
  return reinterpret_cast<const char*>(text);  // NOLINT: bytes either way
}

// OpenSCAD's folders of fonts besides those that fontconfig's configuration names.
std::vector<fs::path> font_folders() {
  std::vector<fs::path> folders{"/usr/local/share/openscad/fonts", "/usr/share/openscad/fonts"};
  if (const char* const home = std::getenv("HOME")) folders.push_back(fs::path(home) / ".fonts");
  if (const char* const listed = std::getenv("OPENSCAD_FONT_PATH")) {
    std::string_view rest = listed;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(':'), rest.size());
      folders.push_back(fs::absolute(rest.substr(0, end)));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  std::erase_if(folders, [](const fs::path& folder) {
    std::error_code error;
    return !fs::is_directory(folder, error);
  });
  return folders;
}

FontConfiguration load_configuration() {
  FontConfiguration configuration(FcInitLoadConfig());
  if (!configuration) return configuration;
  for (const fs::path& folder : font_folders()) {
    FcConfigAppFontAddDir(configuration.get(), fontconfig_text(folder.string()));
  }
  if (FcConfigBuildFonts(configuration.get()) == FcFalse) configuration.reset();
  return configuration;
}

// All values of a pattern's property: a font has its names in several languages.
std::vector<std::string> values(const FontPattern& pattern, const char* property) {
  std::vector<std::string> texts;
  FcChar8* text = nullptr;
  for (int i = 0; FcPatternGetString(pattern.get(), property, i, &text) == FcResultMatch; ++i) {
    texts.push_back(text_of(text));
  }
  return texts;
}

// Of the values asked for, if there are any, one is there.
bool has_any_of(const FontPattern& found, const std::vector<std::string>& asked,
                const char* property) {
  if (asked.empty()) return true;
  for (const std::string& there : values(found, property)) {
    for (const std::string& one : asked) {
      if (FcStrCmpIgnoreCase(fontconfig_text(there), fontconfig_text(one)) == 0) return true;
    }
  }
  return false;
}

std::string first_value(const FontPattern& pattern, const char* property) {
  const auto texts = values(pattern, property);
  return texts.empty() ? std::string("?") : texts.front();
}

// As the font's table of names has it; only its ASCII characters, of one byte or two each.
std::string version_of(const Face& face) {
  constexpr FT_UShort version_string = 5;
  for (FT_UInt i = 0; i < FT_Get_Sfnt_Name_Count(face.get()); ++i) {
    FT_SfntName name;
    if (FT_Get_Sfnt_Name(face.get(), i, &name) != 0 || name.name_id != version_string) continue;
    std::string text;
    for (FT_UInt k = 0; k < name.string_len; ++k) {
      if (name.string[k] >= 0x20 && name.string[k] < 0x7f)
        text += static_cast<char>(name.string[k]);
    }
    if (!text.empty()) return text;
  }
  return "version not told";
}

bool try_charmap(const Face& face, FT_UShort platform, std::optional<FT_UShort> encoding) {
  for (FT_Int i = 0; i < face->num_charmaps; ++i) {
    const FT_CharMap map = face->charmaps[i];
    if (map->platform_id == platform && (!encoding || map->encoding_id == *encoding) &&
        FT_Set_Charmap(face.get(), map) == 0) {
      return true;
    }
  }
  return false;
}

// OpenSCAD's preferences.
void select_charmap(const Face& face) {
  if (FT_Select_Charmap(face.get(), FT_ENCODING_UNICODE) == 0) return;
  const bool selected = try_charmap(face, TT_PLATFORM_MICROSOFT, TT_MS_ID_UNICODE_CS) ||
                        try_charmap(face, TT_PLATFORM_ISO, TT_ISO_ID_10646) ||
                        try_charmap(face, TT_PLATFORM_APPLE_UNICODE, std::nullopt) ||
                        try_charmap(face, TT_PLATFORM_MICROSOFT, TT_MS_ID_SYMBOL_CS) ||
                        try_charmap(face, TT_PLATFORM_MACINTOSH, TT_MAC_ID_ROMAN) ||
                        try_charmap(face, TT_PLATFORM_ISO, TT_ISO_ID_8859_1) ||
                        try_charmap(face, TT_PLATFORM_ISO, TT_ISO_ID_7BIT_ASCII);
  static_cast<void>(selected);  // without one, every character is a missing one
}

// Fonts of symbols whose characters are on a page of their own, at 0xf000.
bool is_symbol_font(const Face& face) {
  if (face->charmap == nullptr || face->charmap->platform_id != TT_PLATFORM_MICROSOFT ||
      face->charmap->encoding_id != TT_MS_ID_SYMBOL_CS) {
    return false;
  }
  FT_UInt glyph = 0;
  const FT_ULong first = FT_Get_First_Char(face.get(), &glyph);
  return glyph != 0 && first >= 0xf000;
}

using Point = std::array<double, 2>;

// A glyph at its origin, in lines of size 1: its paths, and a box round their control points in the
// measure of advances.
struct Glyph {
  LetterPaths paths;
  std::size_t vertices = 0;
  double x_min = 0, x_max = 0, y_min = 0, y_max = 0;
};

// Gets an outline piece by piece from FreeType.
class GlyphPen {
 public:
  GlyphPen(LetterPaths& paths, std::size_t segments) : paths_(paths), segments_(segments) {}

  void draw(FT_Outline& outline) {
    FT_Outline_Funcs functions{};
    functions.move_to = [](const FT_Vector* to, void* pen) {
      return guarded(pen, [&](GlyphPen& p) { p.move_to(point(*to)); });
    };
    functions.line_to = [](const FT_Vector* to, void* pen) {
      return guarded(pen, [&](GlyphPen& p) { p.line_to(point(*to)); });
    };
    functions.conic_to = [](const FT_Vector* control, const FT_Vector* to, void* pen) {
      return guarded(pen, [&](GlyphPen& p) { p.conic_to(point(*control), point(*to)); });
    };
    functions.cubic_to = [](const FT_Vector* first, const FT_Vector* second, const FT_Vector* to,
                            void* pen) {
      return guarded(pen,
                     [&](GlyphPen& p) { p.cubic_to(point(*first), point(*second), point(*to)); });
    };
    const FT_Error failure = FT_Outline_Decompose(&outline, &functions, this);
    if (thrown_) std::rethrow_exception(thrown_);
    if (failure != 0) {
      throw Error(ErrorId::FontUnavailable, {"a glyph whose outline is damaged", ""});
    }
  }
  std::size_t vertices() const { return vertices_; }

 private:
  // No exception may pass through FreeType.
  template <class Action>
  static int guarded(void* pen, const Action& action) noexcept {
    auto& self = *static_cast<GlyphPen*>(pen);
    try {
      action(self);
      return 0;
    } catch (...) {
      self.thrown_ = std::current_exception();
      return 1;
    }
  }

  static Point point(const FT_Vector& vector) {
    return {static_cast<double>(vector.x) / unit, static_cast<double>(vector.y) / unit};
  }

  void move_to(const Point& to) {
    paths_.emplace_back();
    line_to(to);
  }
  void line_to(const Point& to) {
    add(to);
    at_ = to;
  }
  void conic_to(const Point& control, const Point& to) {
    curve_to(to, [&](std::size_t k, double a) {
      return at_[k] * std::pow(1 - a, 2) + control[k] * 2 * std::pow(1 - a, 1) * a +
             to[k] * std::pow(a, 2);
    });
  }
  void cubic_to(const Point& first, const Point& second, const Point& to) {
    curve_to(to, [&](std::size_t k, double a) {
      return at_[k] * std::pow(1 - a, 3) + first[k] * 3 * std::pow(1 - a, 2) * a +
             second[k] * 3 * std::pow(1 - a, 1) * std::pow(a, 2) + to[k] * std::pow(a, 3);
    });
  }
  // `coordinate(k, a)`: of the curve's point at the parameter a.
  template <class Coordinate>
  void curve_to(const Point& to, const Coordinate& coordinate) {
    const double step = 1.0 / static_cast<double>(segments_);
    for (std::size_t i = 1; i <= segments_; ++i) {
      const double a = static_cast<double>(i) * step;
      add({coordinate(0, a), coordinate(1, a)});
    }
    at_ = to;
  }
  void add(const Point& p) {
    paths_.back().push_back(p);
    if (++vertices_ > shape_vertex_limit) {
      throw Error(
          ErrorId::TooLarge,
          {"a letter of more than " + std::to_string(shape_vertex_limit) + " vertices", ""});
    }
  }

  LetterPaths& paths_;
  std::size_t segments_;
  std::size_t vertices_ = 0;
  Point at_{};
  std::exception_ptr thrown_;
};

// A font at the size at which every text is drawn.
class Font {
 public:
  Font(FT_Library library, const FontConfiguration& configuration, const std::string& asked)
      : asked_(asked) {
    const FontPattern found = match(configuration);
    file_ = first_value(found, FC_FILE);
    int index = 0;
    FcPatternGetInteger(found.get(), FC_INDEX, 0, &index);
    FT_Face face = nullptr;
    if (FT_New_Face(library, file_.c_str(), index, &face) != 0) {
      refuse_font(asked_, "the file '" + file_ + "' is no font that FreeType can read");
    }
    face_.reset(face);
    select_charmap(face_);
    if (!FT_IS_SCALABLE(face) || FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(unit),
                                                  dots_per_inch, dots_per_inch) != 0) {
      refuse_font(asked_, "the file '" + file_ + "' has no outlines");
    }
    shaped_.reset(hb_ft_font_create_referenced(face));
    name_ = first_value(found, FC_FAMILY) + ' ' + first_value(found, FC_STYLE) + ", " +
            version_of(face_);
  }

  FontFile description() const { return {asked_, name_, file_}; }
  // Not empty: another font than the one asked for.
  const std::string& remark() const { return remark_; }
  const Face& face() const { return face_; }
  hb_font_t* shaped() const { return shaped_.get(); }

  const Glyph& glyph(std::uint32_t index, std::size_t segments) {
    const auto [at, added] = glyphs_.try_emplace({index, segments});
    if (added) at->second = load(index, segments);
    return at->second;
  }

 private:
  FontPattern match(const FontConfiguration& configuration) {
    FontPattern pattern(FcNameParse(fontconfig_text(asked_)));
    if (!pattern) refuse_font(asked_, "this is no name of a font");
    const auto families = values(pattern, FC_FAMILY);
    const auto styles = values(pattern, FC_STYLE);
    FcPatternAddBool(pattern.get(), FC_OUTLINE, FcTrue);
    FcPatternAddBool(pattern.get(), FC_SCALABLE, FcTrue);
    FcConfigSubstitute(configuration.get(), pattern.get(), FcMatchPattern);
    FcDefaultSubstitute(pattern.get());
    FcResult result = FcResultNoMatch;
    FontPattern found(FcFontMatch(configuration.get(), pattern.get(), &result));
    if (!found || values(found, FC_FILE).empty()) {
      refuse_font(asked_, "no font is installed");
    }
    if (!has_any_of(found, families, FC_FAMILY) || !has_any_of(found, styles, FC_STYLE)) {
      remark_ = "there is no font '" + asked_ + "': fontconfig takes '" +
                first_value(found, FC_FAMILY) + ":style=" + first_value(found, FC_STYLE) +
                "' instead, as for OpenSCAD";
    }
    return found;
  }

  Glyph load(std::uint32_t index, std::size_t segments) const {
    if (FT_Load_Glyph(face_.get(), index, FT_LOAD_DEFAULT) != 0 ||
        face_->glyph->format != FT_GLYPH_FORMAT_OUTLINE) {
      refuse_font(asked_,
                  "glyph " + std::to_string(index) + " of the file '" + file_ + "' has no outline");
    }
    FT_Outline& outline = face_->glyph->outline;
    Glyph glyph;
    GlyphPen pen(glyph.paths, segments);
    pen.draw(outline);
    glyph.vertices = pen.vertices();
    FT_BBox box;
    FT_Outline_Get_CBox(&outline, &box);
    // OpenSCAD asks for the box of whole pixels.
    const auto down = [](FT_Pos value) { return static_cast<double>(value & -64) / advance_unit; };
    const auto up = [](FT_Pos value) {
      return static_cast<double>((value + 63) & -64) / advance_unit;
    };
    glyph.x_min = down(box.xMin);
    glyph.x_max = up(box.xMax);
    glyph.y_min = down(box.yMin);
    glyph.y_max = up(box.yMax);
    return glyph;
  }

  std::string asked_;
  std::string file_;
  std::string name_;
  std::string remark_;
  Face face_;
  ShapedFont shaped_;
  std::map<std::pair<std::uint32_t, std::size_t>, Glyph> glyphs_;
};

// OpenSCAD's: curves of letters are short.
std::size_t segments_of(const TextShape& shape) {
  return std::max<std::size_t>(fragments(shape.size, shape.fineness) / 8 + 1, 2);
}

std::string trimmed(std::string_view text) {
  constexpr std::string_view white = " \t\n\v\f\r";
  const std::size_t first = text.find_first_not_of(white);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(white) - first + 1));
}

// One character of the text and the byte at which it begins.
struct Character {
  std::uint32_t code;
  std::uint32_t byte;
};
constexpr std::uint32_t not_utf8 = 0xffffffff;  // no character has this number

std::vector<Character> characters_of(const std::string& text) {
  const Characters buffer(hb_buffer_create());
  hb_buffer_set_replacement_codepoint(buffer.get(), not_utf8);
  const auto length = static_cast<int>(text.size());
  hb_buffer_add_utf8(buffer.get(), text.data(), length, 0, length);
  if (hb_buffer_allocation_successful(buffer.get()) == 0) throw std::bad_alloc();
  unsigned int count = 0;
  const hb_glyph_info_t* const infos = hb_buffer_get_glyph_infos(buffer.get(), &count);
  std::vector<Character> characters;
  characters.reserve(count);
  for (unsigned int i = 0; i < count; ++i) {
    characters.push_back({infos[i].codepoint, infos[i].cluster});
  }
  return characters;
}

bool says_nothing(hb_script_t script) {
  return script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED ||
         script == HB_SCRIPT_UNKNOWN || script == HB_SCRIPT_INVALID;
}

// The script given, or the only one that the characters have.
hb_script_t script_of(const TextShape& shape, const std::vector<Character>& characters) {
  const hb_script_t given = hb_script_from_string(shape.script.c_str(), -1);
  if (given != HB_SCRIPT_INVALID) return given;
  hb_script_t script = HB_SCRIPT_INVALID;
  for (const Character& character : characters) {
    const std::uint32_t code = character.code == not_utf8 ? 0xfffd : character.code;
    const hb_script_t one = hb_unicode_script(hb_unicode_funcs_get_default(), code);
    if (says_nothing(one)) continue;
    if (script == HB_SCRIPT_INVALID) {
      script = one;
    } else if (script != one) {
      return HB_SCRIPT_UNKNOWN;
    }
  }
  return script;
}

hb_direction_t direction_of(const TextShape& shape, hb_script_t script) {
  hb_direction_t direction = hb_direction_from_string(shape.direction.c_str(), -1);
  if (direction == HB_DIRECTION_INVALID) direction = hb_script_get_horizontal_direction(script);
  if (direction == HB_DIRECTION_INVALID) {
    throw Error(ErrorId::BadArgument,
                {"direction = '" + shape.direction + "' of a script that is written either way",
                 "'ltr', 'rtl', 'ttb' or 'btt'"});
  }
  return direction;
}

std::string code_of(std::uint32_t character) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string text;
  for (int shift = 20; shift >= 0; shift -= 4) {
    const std::uint32_t digit = (character >> static_cast<unsigned>(shift)) & 15U;
    if (!text.empty() || digit != 0 || shift < 16) text += digits[digit];
  }
  return "U+" + text;
}

// The line of glyphs that the characters become.
class Line {
 public:
  Line(const TextShape& shape, Font& font, std::vector<std::string>& remarks)
      : characters_(characters_of(shape.text)), buffer_(hb_buffer_create()) {
    const bool valid = std::none_of(characters_.begin(), characters_.end(),
                                    [](const Character& c) { return c.code == not_utf8; });
    const bool symbols = is_symbol_font(font.face());
    if (!valid) {
      remarks.push_back(symbols ? "the text is not valid UTF-8: it is empty, as in OpenSCAD"
                                : "the text is not valid UTF-8: what is wrong is drawn as U+FFFD, "
                                  "as in OpenSCAD");
      if (symbols) return;
    }
    const hb_script_t script = script_of(shape, characters_);
    const hb_direction_t direction = direction_of(shape, script);
    const hb_script_t given = hb_script_from_string(shape.script.c_str(), -1);
    hb_buffer_set_direction(buffer_.get(), direction);
    hb_buffer_set_script(buffer_.get(), says_nothing(script) ? given : script);
    hb_buffer_set_language(buffer_.get(), hb_language_from_string(shape.language.c_str(), -1));
    if (symbols) {
      hb_buffer_set_content_type(buffer_.get(), HB_BUFFER_CONTENT_TYPE_UNICODE);
      for (const Character& c : characters_) {
        hb_buffer_add(buffer_.get(), c.code < 0x100 ? 0xf000 + c.code : c.code, c.byte);
      }
    } else {
      const auto length = static_cast<int>(shape.text.size());
      hb_buffer_add_utf8(buffer_.get(), shape.text.data(), length, 0, length);
    }
    hb_shape(font.shaped(), buffer_.get(), nullptr, 0);
    if (hb_buffer_allocation_successful(buffer_.get()) == 0) throw std::bad_alloc();
    infos_ = hb_buffer_get_glyph_infos(buffer_.get(), &count_);
    positions_ = hb_buffer_get_glyph_positions(buffer_.get(), &count_);
    tell_missing(remarks);
  }

  std::size_t size() const { return count_; }
  std::uint32_t glyph(std::size_t i) const { return infos_[i].codepoint; }
  Point offset(std::size_t i) const {
    return {positions_[i].x_offset / advance_unit, positions_[i].y_offset / advance_unit};
  }
  Point advance(std::size_t i) const {
    return {positions_[i].x_advance / advance_unit, positions_[i].y_advance / advance_unit};
  }
  bool is_horizontal() const {
    return HB_DIRECTION_IS_HORIZONTAL(hb_buffer_get_direction(buffer_.get()));
  }

 private:
  void tell_missing(std::vector<std::string>& remarks) const {
    std::set<std::uint32_t> missing;
    for (std::size_t i = 0; i < count_; ++i) {
      if (infos_[i].codepoint != 0) continue;
      const auto at =
          std::lower_bound(characters_.begin(), characters_.end(), infos_[i].cluster,
                           [](const Character& c, std::uint32_t byte) { return c.byte < byte; });
      if (at != characters_.end()) missing.insert(at->code == not_utf8 ? 0xfffd : at->code);
    }
    if (missing.empty()) return;
    constexpr std::size_t shown = 8;
    std::string text = "the font has no glyph for";
    std::size_t told = 0;
    for (const std::uint32_t character : missing) {
      text += (told == 0 ? " " : ", ") + (told == shown ? "others" : code_of(character));
      if (told++ == shown) break;
    }
    remarks.push_back(text + ": its sign for missing characters is drawn, as in OpenSCAD");
  }

  std::vector<Character> characters_;
  Characters buffer_;
  unsigned int count_ = 0;
  const hb_glyph_info_t* infos_ = nullptr;
  const hb_glyph_position_t* positions_ = nullptr;
};

// Where the line begins, by its alignment.
Point start_of(const TextShape& shape, const Line& line, Font& font, std::size_t segments) {
  double width = 0;
  double ascent = 0;
  double descent = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Glyph& glyph = font.glyph(line.glyph(i), segments);
    if (line.is_horizontal()) {
      width += line.advance(i)[0] * shape.spacing;
      ascent = std::max(ascent, std::max(0.0, glyph.y_max));
      descent = std::max(descent, std::max(0.0, -glyph.y_min));
    } else {
      width = std::max(width, glyph.x_max - glyph.x_min);
      ascent += line.advance(i)[1] * shape.spacing;
    }
  }
  Point start{0, 0};
  if (shape.horizontal == HorizontalAlignment::Right) start[0] = -width;
  if (shape.horizontal == HorizontalAlignment::Center) start[0] = -width / 2.0;
  if (shape.vertical == VerticalAlignment::Top) start[1] = -ascent;
  if (shape.vertical == VerticalAlignment::Center) start[1] = descent / 2.0 - ascent / 2.0;
  if (shape.vertical == VerticalAlignment::Bottom) start[1] = descent;
  return start;
}

}  // namespace

class TextOutlines::Library {
 public:
  TextOutline outline(const TextShape& shape) {
    TextOutline result;
    if (shape.text.size() > text_byte_limit) {
      throw Error(ErrorId::TooLarge, {"a text of " + std::to_string(shape.text.size()) + " bytes",
                                      "at most " + std::to_string(text_byte_limit)});
    }
    const std::size_t segments = segments_of(shape);
    if (shape.text.empty()) return result;
    Font& font = find(shape.font, result.remarks);
    const Line line(shape, font, result.remarks);
    const Point start = start_of(shape, line, font, segments);
    Point pen{0, 0};
    std::size_t vertices = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Glyph& glyph = font.glyph(line.glyph(i), segments);
      const Point by = line.offset(i);
      const Point from{start[0] + by[0], start[1] + by[1]};
      vertices += glyph.vertices;
      if (vertices > shape_vertex_limit) {
        throw Error(
            ErrorId::TooLarge,
            {"a text of more than " + std::to_string(shape_vertex_limit) + " vertices", ""});
      }
      if (!glyph.paths.empty()) {
        LetterPaths& letter = result.letters.emplace_back(glyph.paths);
        for (auto& path : letter) {
          for (Point& p : path) {
            for (std::size_t k = 0; k < 2; ++k) p[k] = shape.size * (p[k] + from[k] + pen[k]);
          }
        }
      }
      for (std::size_t k = 0; k < 2; ++k) pen[k] += line.advance(i)[k] * shape.spacing;
    }
    return result;
  }

  const std::vector<FontFile>& used() const { return used_; }

 private:
  Font& find(const std::string& asked, std::vector<std::string>& remarks) {
    std::string name = trimmed(asked);
    if (name.empty()) name = default_font;
    const auto known = fonts_.find(name);
    if (known != fonts_.end()) return known->second;
    open(name);
    Font& font = fonts_.try_emplace(name, library_.get(), configuration_, name).first->second;
    if (!font.remark().empty()) remarks.push_back(font.remark());
    used_.push_back(font.description());
    return font;
  }

  void open(const std::string& asked) {
    if (!configuration_) configuration_ = load_configuration();
    if (!configuration_) refuse_font(asked, "fontconfig has no configuration that can be used");
    if (library_) return;
    FT_Library library = nullptr;
    if (FT_Init_FreeType(&library) != 0) refuse_font(asked, "FreeType cannot be used");
    library_.reset(library);
  }

  FontConfiguration configuration_;
  FreeType library_;
  std::map<std::string, Font> fonts_;  // closed before the library
  std::vector<FontFile> used_;
};

TextOutlines::TextOutlines() : library_(std::make_unique<Library>()) {}
TextOutlines::~TextOutlines() = default;

TextOutline TextOutlines::outline(const TextShape& shape) { return library_->outline(shape); }

const std::vector<FontFile>& TextOutlines::fonts() const { return library_->used(); }

}  // namespace exactcsg::io::openscad
