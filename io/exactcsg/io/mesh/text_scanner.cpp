// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mesh/text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <utility>

namespace exactcsg::io {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Long or strange words are cut in messages.
std::string quoted(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text = "\"";
  for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > longest ? "...\"" : "\"");
}

bool is_not_finite(std::string_view word) {
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.remove_prefix(1);
  return equals_ignoring_case(word.substr(0, 3), "nan") ||
         equals_ignoring_case(word.substr(0, 3), "inf");
}

int significant_digits(std::string_view word) {
  int digits = 0;
  int zeros = 0;
  for (const char c : word) {
    if (c == 'e' || c == 'E') break;
    if (c == '0') {
      if (digits > 0) ++zeros;
    } else if (c >= '1' && c <= '9') {
      digits += zeros + 1;
      zeros = 0;
    }
  }
  return digits;
}

Rational power(unsigned base, int exponent) {
  Integer result;
  mpz_ui_pow_ui(result.get_mpz_t(), base, static_cast<unsigned>(std::abs(exponent)));
  return exponent < 0 ? Rational(Integer(1), result) : Rational(result);
}

// The largest e with base^e <= value. REQUIRES value > 0
int exponent_of(const Rational& value, unsigned base) {
  const auto bits = static_cast<long>(mpz_sizeinbase(value.get_num_mpz_t(), base)) -
                    static_cast<long>(mpz_sizeinbase(value.get_den_mpz_t(), base));
  int exponent = static_cast<int>(bits) + 1;
  while (power(base, exponent) > value) --exponent;
  return exponent;
}

Rational half_unit(const Rational& largest, unsigned base, int digits) {
  if (largest == 0) return 0;
  return power(base, exponent_of(largest, base) - digits + 1) / 2;
}

}  // namespace

void CoordinateSurvey::note(const Rational& value) {
  if (abs(value) > largest) largest = abs(value);
}

Rational half_decimal_unit(const Rational& largest, int digits) {
  return half_unit(largest, 10, digits);
}
Rational half_binary_unit(const Rational& largest, int bits) { return half_unit(largest, 2, bits); }

Rational text_rounding_bound(const CoordinateSurvey& survey) {
  constexpr int default_digits = 6;
  constexpr int float_digits = 9;  // write a float so that it is read back
  constexpr int float_bits = 24;
  const int digits = std::max(survey.significant_digits, default_digits);
  Rational bound = half_decimal_unit(survey.largest, digits);
  if (digits <= float_digits) bound += half_binary_unit(survey.largest, float_bits);
  return bound;
}

bool equals_ignoring_case(std::string_view word, std::string_view lower_case) {
  return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                    [](char a, char b) { return lower(a) == b; });
}

Rational parse_coordinate(std::string_view word, CoordinateSurvey& survey) {
  if (is_not_finite(word)) {
    throw Error(ErrorId::NumberOutOfRange, {quoted(word), "a finite coordinate"});
  }
  const auto value = word.find('/') == word.npos ? parse_rational(word) : std::nullopt;
  if (!value) throw Error(ErrorId::UnexpectedText, {quoted(word), "a coordinate"});
  static const Rational largest = power(10, 100);
  if (abs(*value) > largest) {
    throw Error(ErrorId::NumberOutOfRange, {quoted(word), "a magnitude of at most 1e100"});
  }
  survey.note(*value);
  survey.significant_digits = std::max(survey.significant_digits, significant_digits(word));
  return *value;
}

TextScanner::TextScanner(std::string_view text, std::string file, char comment)
    : text_(text), file_(std::move(file)), comment_(comment) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text_.starts_with(byte_order_mark)) at_ = byte_order_mark.size();
}

std::size_t TextScanner::joined_line(std::size_t at) const {
  if (text_[at] != '\\') return 0;
  std::size_t end = at + 1;
  while (end < text_.size() && is_blank(text_[end])) ++end;
  return end < text_.size() && text_[end] == '\n' ? end + 1 - at : 0;
}

bool TextScanner::at_line_end() {
  while (at_ < text_.size()) {
    const std::size_t step = is_blank(text_[at_]) ? 1 : joined_line(at_);
    if (step == 0) break;
    at_ += step;
  }
  if (at_ < text_.size() && comment_ != '\0' && text_[at_] == comment_) {
    at_ = std::min(text_.find('\n', at_), text_.size());
  }
  return at_ == text_.size() || text_[at_] == '\n';
}

bool TextScanner::at_end() {
  while (at_line_end() && at_ < text_.size()) ++at_;
  return at_ == text_.size();
}

std::string_view TextScanner::word(std::string_view expected) {
  if (at_end()) {
    word_at_ = at_;
    fail(ErrorId::TruncatedInput, "the end of the file", std::string(expected));
  }
  word_at_ = at_;
  while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n' &&
         !(comment_ != '\0' && text_[at_] == comment_) && joined_line(at_) == 0) {
    ++at_;
  }
  return text_.substr(word_at_, at_ - word_at_);
}

std::string_view TextScanner::rest_of_line() {
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  const std::string_view rest = text_.substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  return rest;
}

void TextScanner::skip_line() { rest_of_line(); }

Rational TextScanner::coordinate(CoordinateSurvey& survey) {
  const std::string_view text = word("a coordinate");
  try {
    return parse_coordinate(text, survey);
  } catch (const Error& error) {
    throw error.at(position_of(word_at_));
  }
}

std::uint64_t TextScanner::count(std::string_view expected) {
  const std::string_view text = word(expected);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) {
    fail(ErrorId::NumberOutOfRange, quoted(text), std::string(expected));
  }
  if (error != std::errc() || end != text.data() + text.size()) unexpected(text, expected);
  return value;
}

void TextScanner::skip_number(std::string_view expected) {
  const std::string_view text = word(expected);
  if (is_not_finite(text)) return;
  CoordinateSurvey ignored;
  try {
    parse_coordinate(text, ignored);
  } catch (const Error& error) {
    if (error.id() == ErrorId::UnexpectedText) unexpected(text, expected);
  }
}

std::uint32_t TextScanner::index(std::size_t size) {
  const std::string_view text = word("the number of a vertex");
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) {
    unexpected(text, "the number of a vertex");
  }
  if (error != std::errc() || value < 0 || static_cast<std::uint64_t>(value) >= size) {
    fail(ErrorId::UnknownVertex, "vertex " + std::string(text),
         "one of " + std::to_string(size) + " vertices");
  }
  return static_cast<std::uint32_t>(value);
}

void TextScanner::keyword(std::string_view lower_case) {
  const std::string_view text = word(lower_case);
  if (!equals_ignoring_case(text, lower_case)) unexpected(text, lower_case);
}

void TextScanner::fail(ErrorId id, std::string found, std::string expected) const {
  throw Error(id, {std::move(found), std::move(expected), position_of(word_at_)});
}

void TextScanner::unexpected(std::string_view found, std::string_view expected) const {
  // A word cut off by the end of the file is the file's fault, not the word's.
  const bool cut = word_at_ + found.size() == text_.size() && found.data() >= text_.data() &&
                   found.data() < text_.data() + text_.size();
  fail(cut ? ErrorId::TruncatedInput : ErrorId::UnexpectedText, quoted(found),
       std::string(expected));
}

SourcePosition TextScanner::position_of(std::size_t offset) const {
  const std::string_view before = text_.substr(0, offset);
  const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
  const std::size_t start = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
  return {file_, line + 1, offset - start + 1};
}

}  // namespace exactcsg::io
