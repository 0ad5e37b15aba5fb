// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// XML elements and their fields that know their line and column (pugixml keeps none).
//
// A field is an attribute or a child element of that name; the attribute wins. pugixml parses in
// place, so that a name or value is found by its address, and its place in the file from that.

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "exactcsg/number/exact.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io::openmc {

class LocatedXml;

// Text and the place where it stands. Words are what blanks separate.
class Field {
 public:
  // `text` is the whole of what was parsed in one piece.
  Field(const LocatedXml& file, std::string_view text)
      : file_(&file), begin_(text.data()), text_(text) {}

  std::string_view text() const { return text_; }
  std::string_view stripped() const;
  SourcePosition position(std::size_t at = 0) const;
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected,
                         std::size_t at = 0) const;

  std::vector<Field> words() const;
  // The whole text as one word. THROWS Error(WrongCount) if it is not one.
  Field word() const;
  // These two REQUIRE a word. THROWS Error(UnexpectedText | NumberOutOfRange)
  Rational number() const;
  std::int32_t integer() const;
  std::vector<Rational> numbers() const;

 private:
  const LocatedXml* file_;
  const char* begin_;      // of the piece that the text is part of
  std::string_view text_;  // part of the parsed buffer
};

class Element {
 public:
  Element(const LocatedXml& file, pugi::xml_node node) : file_(&file), node_(node) {}

  std::string_view name() const { return node_.name(); }
  SourcePosition position() const;  // of its "<"
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected) const;

  // THROWS Error(UnexpectedText) if it is given twice, or is a child element with others inside.
  std::optional<Field> field(const char* name) const;
  // THROWS Error(MissingValue)
  Field required(const char* name) const;
  std::string text_or_empty(const char* name) const;

  std::vector<Element> children() const;
  // visit(name, position) for every field whose name is not in the list.
  void for_each_field_besides(
      std::initializer_list<std::string_view> known,
      const std::function<void(std::string_view, SourcePosition)>& visit) const;

 private:
  const LocatedXml* file_;
  pugi::xml_node node_;
};

class LocatedXml {
 public:
  // THROWS Error(EmptyFile | NotText | UnexpectedText | TruncatedInput)
  LocatedXml(std::string_view text, std::string name);
  LocatedXml(const LocatedXml&) = delete;
  LocatedXml& operator=(const LocatedXml&) = delete;

  Element root() const;
  // REQUIRES that it points into the parsed buffer; `after` more characters on, as parsed.
  SourcePosition position_of(const char* parsed, std::size_t after = 0) const;

 private:
  SourcePosition position_at(std::size_t offset) const;
  void check_text() const;
  [[noreturn]] void fail_to_parse(const pugi::xml_parse_result& result) const;

  std::string text_;    // as given
  std::string buffer_;  // parsed in place
  std::string name_;
  std::vector<std::size_t> lines_;  // where they begin
  pugi::xml_document document_;
};

}  // namespace exactcsg::io::openmc
