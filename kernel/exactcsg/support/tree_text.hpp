// SPDX-License-Identifier: Apache-2.0
#pragma once

// Reading and writing the texts of trees: words, numbers and brackets, and errors that know their
// line and column. csg/text.hpp and gdt/text.hpp say what the brackets mean; docs/format.md has the
// grammar. [Exact]
//
// A word ends at a blank, at one of ( ) [ ] @ and at #, which begins a comment up to the end of the
// line. Blanks (space, tab, line ends) separate words and mean nothing else.
//
// LAW text.1  number<I>() after write(i) gives i, for integers and floating-point numbers.
// LAW text.2  a position counts lines and columns (bytes) from 1.
// COST: O(length) in all; a position costs O(text before it), and is found for errors only.

#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace detail {

enum class CharacterKind : unsigned char { OfWord, Blank, Delimiter };

inline constexpr auto character_kinds = [] {
  std::array<CharacterKind, 256> kinds{};
  for (const char c : {' ', '\t', '\n', '\r', '\v', '\f'}) {
    kinds[static_cast<unsigned char>(c)] = CharacterKind::Blank;
  }
  for (const char c : {'(', ')', '[', ']', '@', '#', '\0'}) {
    kinds[static_cast<unsigned char>(c)] = CharacterKind::Delimiter;
  }
  return kinds;
}();

constexpr CharacterKind kind_of(char c) noexcept {
  return character_kinds[static_cast<unsigned char>(c)];
}

}  // namespace detail

template <class T>
concept TextNumber = std::is_arithmetic_v<T> && !std::same_as<T, bool> && !std::same_as<T, char>;

class TextReader {
 public:
  // REQUIRES that the text outlives the reader. The name of the file is for errors only.
  explicit TextReader(std::string_view text, std::string file = {})
      : begin_(text.data()),
        at_(text.data()),
        end_(text.data() + text.size()),
        token_(at_),
        file_(std::move(file)) {}

  // The next character that is not a blank, without taking it; '\0' at the end.
  char peek() {
    for (; at_ != end_; ++at_) {
      if (*at_ == '#') {
        while (at_ + 1 != end_ && at_[1] != '\n') ++at_;
      } else if (detail::kind_of(*at_) != detail::CharacterKind::Blank) {
        break;
      }
    }
    token_ = at_;
    return at_ == end_ ? '\0' : *at_;
  }
  bool at_end() { return peek() == '\0' && at_ == end_; }

  // Takes the next character that is not a blank. THROWS Error(TruncatedInput)
  char character(std::string_view expected) {
    if (at_end()) fail_at_end(expected);
    return *at_++;
  }
  // Takes the next word if it is this one.
  bool take(std::string_view whole_word) {
    if (!std::string_view(at_, remaining()).starts_with(whole_word)) return false;
    const char* const after = at_ + whole_word.size();
    if (after != end_ && detail::kind_of(*after) == detail::CharacterKind::OfWord) return false;
    at_ = after;
    return true;
  }
  // THROWS Error(TruncatedInput | UnexpectedText) if there is none.
  std::string_view word(std::string_view expected) {
    peek();
    while (at_ != end_ && detail::kind_of(*at_) == detail::CharacterKind::OfWord) ++at_;
    if (at_ == token_) unexpected(expected);
    return {token_, static_cast<std::size_t>(at_ - token_)};
  }
  // THROWS also Error(NumberOutOfRange)
  template <TextNumber T>
  T number(std::string_view expected = "a number") {
    const std::string_view digits = word(expected);
    T value{};
    const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) {
      fail(ErrorId::NumberOutOfRange, quoted(digits), "a number that its type can hold");
    }
    if (error != std::errc() || rest != digits.data() + digits.size()) {
      fail(ErrorId::UnexpectedText, quoted(digits), std::string(expected));
    }
    return value;
  }

  // A word that parse(string_view) -> optional<T> understands, as parse_rational does.
  template <class Parse>
  auto parsed(Parse&& parse, std::string_view expected) {
    const std::string_view text = word(expected);
    if (auto value = parse(text)) return *std::move(value);
    fail(ErrorId::UnexpectedText, quoted(text), std::string(expected));
  }

  // Of what was last looked at.
  SourcePosition position() const { return position_of(offset()); }
  std::size_t offset() const noexcept { return static_cast<std::size_t>(token_ - begin_); }
  SourcePosition position_of(std::size_t offset) const {
    SourcePosition position{file_, 1, offset + 1};
    for (std::size_t i = 0; i < offset; ++i) {
      if (begin_[i] != '\n') continue;
      ++position.line;
      position.column = offset - i;
    }
    return position;
  }
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected) const {
    throw Error(id, {std::move(found), std::move(expected), position()});
  }
  // Error about the character that comes next.
  [[noreturn]] void unexpected(std::string_view expected) {
    if (at_end()) fail_at_end(expected);
    fail(ErrorId::UnexpectedText, quoted({at_, 1}), std::string(expected));
  }

  // Error about what was last looked at.
  [[noreturn]] void unexpected_token(std::string_view expected) const {
    fail(ErrorId::UnexpectedText, quoted({token_, static_cast<std::size_t>(at_ - token_)}),
         std::string(expected));
  }
  // Error at the end of the text about a bracket before it.
  [[noreturn]] void not_closed(std::size_t offset_of_bracket) const {
    const SourcePosition opened = position_of(offset_of_bracket);
    fail_at_end("what closes the bracket of line " + std::to_string(opened.line) + ", column " +
                std::to_string(opened.column));
  }

  static std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

 private:
  [[noreturn]] void fail_at_end(std::string_view expected) const {
    fail(ErrorId::TruncatedInput, "the end of the text", std::string(expected));
  }
  std::size_t remaining() const noexcept { return static_cast<std::size_t>(end_ - at_); }

  const char* begin_;
  const char* at_;
  const char* end_;
  const char* token_;  // where what was last looked at begins
  std::string file_;
};

class TextWriter {
 public:
  // Beyond this many columns a blank between two words is a line end.
  static constexpr std::size_t line_width = 100;

  void write(char c) { text_ += c; }
  void write(std::string_view text) { text_ += text; }
  template <TextNumber T>
  void write(T number) {
    std::array<char, 128> digits;
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    text_.append(digits.data(), result.ptr);
  }
  // A blank, unless nothing needs to be separated here.
  void separate() {
    constexpr std::string_view separators = " \n([@";
    if (text_.empty() || separators.find(text_.back()) != std::string_view::npos) return;
    if (text_.size() - line_begin_ < line_width) {
      text_ += ' ';
    } else {
      text_ += '\n';
      line_begin_ = text_.size();
    }
  }

  std::size_t size() const noexcept { return text_.size(); }
  std::string_view written_since(std::size_t size) const {
    return std::string_view(text_).substr(size);
  }
  std::string take() && { return std::move(text_); }

 private:
  std::string text_;
  std::size_t line_begin_ = 0;
};

// A function that writes a value: value -> text, or (writer, value).
template <class F, class T>
concept PutsText = std::is_invocable_v<F&, TextWriter&, const T&> ||
    std::is_invocable_r_v<std::string_view, F&, const T&>;

// A function that reads a value, taking from the reader exactly what the other one wrote.
template <class F>
concept GetsText =
    std::invocable<F&, TextReader&> && !std::is_void_v<std::invoke_result_t<F&, TextReader&>>;

template <GetsText F>
using TextValue = std::remove_cvref_t<std::invoke_result_t<F&, TextReader&>>;

namespace detail {

// REQUIRES the text is not empty, and begins neither with a blank nor with one of `reserved`: what
// follows could not be told from the format's own text. THROWS Error(BadArgument)
template <class F, class T>
requires PutsText<F, T>
void put_text(TextWriter& out, F& put, const T& value, std::string_view reserved) {
  out.separate();
  const std::size_t before = out.size();
  if constexpr (std::is_invocable_v<F&, TextWriter&, const T&>) {
    put(out, value);
  } else {
    out.write(std::string_view(put(value)));
  }
  const std::string_view text = out.written_since(before);
  if (text.empty() || kind_of(text[0]) == CharacterKind::Blank ||
      reserved.find(text[0]) != std::string_view::npos) {
    throw Error(ErrorId::BadArgument,
                {"the text " + TextReader::quoted(text),
                 "text that does not begin with a blank or one of " + std::string(reserved)});
  }
}

// Errors of the user's function are told where they happened.
template <GetsText F>
TextValue<F> get_text(TextReader& in, F& get) {
  try {
    return get(in);
  } catch (const Error& error) {
    throw error.at(in.position());
  }
}

}  // namespace detail

// The whole text is what get(reader) reads. THROWS Error(UnexpectedText) if something follows.
template <GetsText F>
TextValue<F> read_whole(std::string_view text, std::string file, F&& get) {
  TextReader in(text, std::move(file));
  TextValue<F> value = get(in);
  if (!in.at_end()) in.unexpected("the end of the text");
  return value;
}

}  // namespace exactcsg
