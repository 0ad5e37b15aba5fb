// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/located_xml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "exactcsg/io/mesh/text_scanner.hpp"

namespace exactcsg::io::openmc {

namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

// Line ends stay as they are, so that places do; entities are counted by position_of.
constexpr unsigned int parse_options = pugi::parse_cdata | pugi::parse_escapes;

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  return text.size() <= longest ? fmt::format("'{}'", text)
                                : fmt::format("'{}...'", text.substr(0, longest));
}

}  // namespace

std::string_view Field::stripped() const {
  const std::size_t first = text_.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text_.substr(first, text_.find_last_not_of(blanks) - first + 1);
}

SourcePosition Field::position(std::size_t at) const {
  return file_->position_of(begin_, static_cast<std::size_t>(text_.data() - begin_) + at);
}

void Field::fail(ErrorId id, std::string found, std::string expected, std::size_t at) const {
  throw Error(id, {std::move(found), std::move(expected), position(at)});
}

std::vector<Field> Field::words() const {
  std::vector<Field> result;
  std::size_t at = text_.find_first_not_of(blanks);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(text_.find_first_of(blanks, at), text_.size());
    Field word = *this;
    word.text_ = text_.substr(at, end - at);
    result.push_back(word);
    at = text_.find_first_not_of(blanks, end);
  }
  return result;
}

Field Field::word() const {
  const std::vector<Field> all = words();
  if (all.size() != 1) {
    (all.size() < 2 ? *this : all[1])
        .fail(ErrorId::WrongCount, fmt::format("{} words", all.size()), "one");
  }
  return all.front();
}

Rational Field::number() const {
  try {
    CoordinateSurvey not_used;
    return parse_coordinate(text_, not_used);
  } catch (const Error& error) {
    throw error.at(position());
  }
}

std::int32_t Field::integer() const {
  const std::string_view digits = text_.starts_with('+') ? text_.substr(1) : text_;
  std::int32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    fail(ErrorId::NumberOutOfRange, quoted(text_), "an integer of 32 bits");
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    fail(ErrorId::UnexpectedText, quoted(text_), "an integer");
  }
  return value;
}

std::vector<Rational> Field::numbers() const {
  std::vector<Rational> result;
  for (const Field& word : words()) result.push_back(word.number());
  return result;
}

SourcePosition Element::position() const { return file_->position_of(node_.name() - 1); }

void Element::fail(ErrorId id, std::string found, std::string expected) const {
  throw Error(id, {std::move(found), std::move(expected), position()});
}

std::optional<Field> Element::field(const char* name) const {
  std::optional<Field> result;
  for (const pugi::xml_attribute attribute : node_.attributes()) {
    if (attribute.name() != std::string_view(name)) continue;
    if (result) {
      throw Error(ErrorId::UnexpectedText, {fmt::format("a second attribute '{}'", name), "one",
                                            file_->position_of(attribute.name())});
    }
    result.emplace(*file_, attribute.value());
  }
  if (result) return result;
  for (const pugi::xml_node child : node_.children(name)) {
    const Element element(*file_, child);
    if (result) {
      element.fail(ErrorId::UnexpectedText, fmt::format("a second element '{}'", name), "one");
    }
    const pugi::xml_node text = child.first_child();
    if (text && (text.next_sibling() || text.type() == pugi::node_element)) {
      element.fail(ErrorId::UnexpectedText, "elements or comments within the text",
                   "text in one piece");
    }
    result.emplace(*file_,
                   text ? std::string_view(text.value()) : std::string_view(child.name(), 0));
  }
  return result;
}

Field Element::required(const char* name) const {
  std::optional<Field> result = field(name);
  if (!result) {
    fail(ErrorId::MissingValue, fmt::format("<{}> without '{}'", node_.name(), name), "one");
  }
  return *result;
}

std::string Element::text_or_empty(const char* name) const {
  const std::optional<Field> found = field(name);
  return found ? std::string(found->stripped()) : std::string();
}

std::vector<Element> Element::children() const {
  std::vector<Element> result;
  for (const pugi::xml_node child : node_.children()) {
    if (child.type() == pugi::node_element) {
      result.emplace_back(*file_, child);
    } else {
      const std::string_view text = Field(*file_, child.value()).stripped();
      throw Error(ErrorId::UnexpectedText,
                  {quoted(text), "elements only", file_->position_of(text.data())});
    }
  }
  return result;
}

void Element::for_each_field_besides(
    std::initializer_list<std::string_view> known,
    const std::function<void(std::string_view, SourcePosition)>& visit) const {
  const auto check = [&](const char* name) {
    if (std::find(known.begin(), known.end(), std::string_view(name)) == known.end()) {
      visit(name, file_->position_of(name));
    }
  };
  for (const pugi::xml_attribute attribute : node_.attributes()) check(attribute.name());
  for (const Element& child : children()) check(child.node_.name());
}

LocatedXml::LocatedXml(std::string_view text, std::string name)
    : text_(text), buffer_(text), name_(std::move(name)), lines_{0} {
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') lines_.push_back(i + 1);
  }
  check_text();
  const pugi::xml_parse_result result = document_.load_buffer_inplace(
      buffer_.data(), buffer_.size(), parse_options, pugi::encoding_utf8);
  if (!result) fail_to_parse(result);
  for (const pugi::xml_node other : document_.children()) {
    if (other.type() == pugi::node_element && other != document_.document_element()) {
      Element(*this, other).fail(ErrorId::UnexpectedText, "a second element at the top", "one");
    }
  }
  // pugixml passes over what follows the last element.
  const std::size_t behind = text_.find_first_not_of(blanks, text_.find_last_of('>') + 1);
  if (behind != std::string::npos) {
    throw Error(ErrorId::UnexpectedText,
                {"text behind the last element", "the end of the file", position_at(behind)});
  }
}

Element LocatedXml::root() const { return {*this, document_.document_element()}; }

// What pugixml passes over without a word.
void LocatedXml::check_text() const {
  std::size_t first = text_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  first = text_.find_first_not_of(blanks, first);
  if (first == std::string::npos) throw Error(ErrorId::EmptyFile, {"", "", SourcePosition{name_}});
  const std::size_t zero = text_.find('\0');
  if (zero != std::string::npos) {
    throw Error(ErrorId::NotText, {"a zero byte", "XML in UTF-8", position_at(zero)});
  }
  if (text_[first] != '<') {
    throw Error(ErrorId::NotText,
                {quoted(std::string_view(text_).substr(first, 20)), "XML", position_at(first)});
  }
}

void LocatedXml::fail_to_parse(const pugi::xml_parse_result& result) const {
  const std::size_t last = text_.find_last_not_of(blanks);
  const std::size_t at =
      std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)), text_.size());
  // An unfinished piece is reported where it begins: nothing finished it. (In place, pugixml ends
  // at the last character.)
  if (at >= last || result.status == pugi::status_no_document_element ||
      text_.find('>', at) == std::string::npos) {
    throw Error(ErrorId::TruncatedInput,
                {"the end of the file", result.description(), position_at(text_.size())});
  }
  throw Error(ErrorId::UnexpectedText, {result.description(), "well-formed XML", position_at(at)});
}

SourcePosition LocatedXml::position_of(const char* parsed, std::size_t after) const {
  auto offset = static_cast<std::size_t>(parsed - buffer_.data());
  // An entity is several characters of the file and one of the parsed text (of the ASCII ones).
  for (; after > 0 && offset < text_.size(); --after) {
    const std::size_t end = text_[offset] == '&' ? text_.find(';', offset) : offset;
    offset = end == std::string::npos ? offset + 1 : end + 1;
  }
  return position_at(offset);
}

SourcePosition LocatedXml::position_at(std::size_t offset) const {
  const auto next = std::upper_bound(lines_.begin(), lines_.end(), offset);
  const auto line = static_cast<std::size_t>(next - lines_.begin());
  return {name_, line, offset - lines_[line - 1] + 1};
}

}  // namespace exactcsg::io::openmc
