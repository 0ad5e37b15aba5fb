// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mcnp/deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <utility>

#include "exactcsg/io/mesh/text_scanner.hpp"

namespace exactcsg::io::mcnp {

namespace {

constexpr std::string_view blanks = " \t\r";
constexpr std::size_t first_columns = 5;
constexpr std::size_t last_column = 128;
constexpr std::size_t tab_width = 8;

std::string quoted(std::string_view text) { return fmt::format("'{:.40}'", text); }

bool is_blank(std::string_view line) {
  return line.find_first_not_of(blanks) == std::string_view::npos;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

// The column, from 0, at which a byte of a line is shown.
std::size_t column_shown(std::string_view line, std::size_t at) {
  std::size_t column = 0;
  for (std::size_t i = 0; i < at; ++i) {
    column = line[i] == '\t' ? (column / tab_width + 1) * tab_width : column + 1;
  }
  return column;
}

bool is_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(blanks);
  if (first == std::string_view::npos || (line[first] != 'c' && line[first] != 'C')) return false;
  return column_shown(line, first) < first_columns &&
         (first + 1 == line.size() || blanks.find(line[first + 1]) != std::string_view::npos);
}

// FCn and SCn hold text, in which & is no continuation.
bool begins_remark(std::string_view card) {
  const std::size_t first = std::min(card.find_first_not_of(blanks), card.size());
  card = card.substr(first);
  return card.size() > 2 && (card[0] == 'f' || card[0] == 's') && card[1] == 'c' &&
         is_digit(card[2]);
}

class DeckReader {
 public:
  DeckReader(std::string_view text, const std::string& name)
      : text_(text), name_(std::make_shared<const std::string>(name)) {}

  Deck read() {
    check_text();
    read_title();
    read_block(deck_.cells);
    if (deck_.cells.empty()) fail(ErrorId::MissingValue, "no cell cards", "cell cards", 1);
    if (is_at_end() && !was_delimited_) {
      fail(ErrorId::TruncatedInput, "the end of the file in the cell cards",
           "a blank line and surface cards", 1);
    }
    read_block(deck_.surfaces);
    if (deck_.surfaces.empty()) {
      fail(is_at_end() && !was_delimited_ ? ErrorId::TruncatedInput : ErrorId::MissingValue,
           "no surface cards", "surface cards behind one blank line", 1);
    }
    read_block(deck_.data);
    return std::move(deck_);
  }

 private:
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected,
                         std::size_t column) const {
    throw Error(id, {std::move(found), std::move(expected), SourcePosition{*name_, line_, column}});
  }

  void check_text() {
    if (is_blank_text()) throw Error(ErrorId::EmptyFile, {"", "", SourcePosition{*name_}});
    const std::size_t zero = text_.find('\0');
    if (zero == std::string_view::npos) return;
    const std::string_view before = text_.substr(0, zero);
    line_ = 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
    const std::size_t begin = before.rfind('\n');
    fail(ErrorId::NotText, "a byte of value 0", "text",
         begin == std::string_view::npos ? zero + 1 : zero - begin);
  }
  bool is_blank_text() const {
    return text_.find_first_not_of(" \t\r\n") == std::string_view::npos;
  }

  bool is_at_end() const { return at_ >= text_.size(); }

  std::string_view next_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void read_title() {
    std::string_view line = next_line();
    if (lower_case(line.substr(line.find_first_not_of(blanks) == std::string_view::npos
                                   ? line.size()
                                   : line.find_first_not_of(blanks)))
            .starts_with("message:")) {
      while (!is_at_end() && !is_blank(line)) line = next_line();
      if (is_at_end()) {
        fail(ErrorId::TruncatedInput, "the end of the file in the message block",
             "a blank line and a title", 1);
      }
      line = next_line();
    }
    deck_.title = std::string(line);
  }

  // Up to a blank line or the end.
  void read_block(std::vector<Card>& cards) {
    was_delimited_ = false;
    bool goes_on = false;
    while (!is_at_end()) {
      const std::string_view line = next_line();
      if (is_blank(line)) {
        if (goes_on) fail(ErrorId::UnexpectedText, "a blank line behind &", "more of the card", 1);
        was_delimited_ = true;
        return;
      }
      if (!is_comment(line)) goes_on = read_line(line, cards, goes_on);
    }
    if (goes_on) {
      fail(ErrorId::TruncatedInput, "the end of the file behind &", "more of the card", 1);
    }
  }

  // True if the next line belongs to the same card.
  bool read_line(std::string_view line, std::vector<Card>& cards, bool goes_on) {
    std::string_view text = line.substr(0, line.find('$'));
    const std::size_t last = text.find_last_not_of(blanks);
    if (last == std::string_view::npos) return goes_on;
    text = text.substr(0, last + 1);
    if (column_shown(text, last) >= last_column) {
      fail(ErrorId::UnexpectedText, "text behind column 128", "a card that goes on in another line",
           last + 1);
    }
    const std::size_t first = text.find_first_not_of(blanks);
    const bool is_continuation = goes_on || column_shown(text, first) >= first_columns;
    if (is_continuation && cards.empty()) {
      fail(ErrorId::UnexpectedText, "a line that begins behind column 5",
           "a card, which begins in the first five columns", first + 1);
    }
    if (!is_continuation) cards.emplace_back(name_);
    const bool is_remark = begins_remark(is_continuation ? cards.back().text() : lower_case(text));
    const bool ends_open =
        !is_remark && text.back() == '&' &&
        (text.size() == 1 || blanks.find(text[text.size() - 2]) != std::string_view::npos);
    if (ends_open) text.remove_suffix(1);
    cards.back().add_line(text.substr(std::min(first, text.size())), line_, first + 1);
    return ends_open;
  }

  std::string_view text_;
  std::shared_ptr<const std::string> name_;
  Deck deck_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  bool was_delimited_ = false;
};

// What Fortran takes for a number, with an exponent as everybody writes it; empty: none.
std::string standard_number(std::string_view text) {
  std::string result;
  std::size_t at = 0;
  const auto take_digits = [&] {
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return text.substr(begin, at - begin);
  };
  const auto is_sign = [&] { return at < text.size() && (text[at] == '+' || text[at] == '-'); };
  if (is_sign() && text[at++] == '-') result += '-';
  const std::string_view whole = take_digits();
  result += whole.empty() ? "0" : whole;
  std::string_view fraction;
  if (at < text.size() && text[at] == '.') {
    ++at;
    fraction = take_digits();
    if (!fraction.empty()) (result += '.') += fraction;
  }
  if (whole.empty() && fraction.empty()) return {};
  if (at == text.size()) return result;
  const bool has_letter = text[at] == 'e' || text[at] == 'd';
  if (has_letter) ++at;
  if (!has_letter && !is_sign()) return {};
  result += 'e';
  if (is_sign()) result += text[at++];
  const std::string_view exponent = take_digits();
  if (exponent.empty() || at != text.size()) return {};
  return result += exponent;
}

}  // namespace

void Card::add_line(std::string_view text, std::size_t line, std::size_t column) {
  if (!text_.empty()) text_ += ' ';
  pieces_.push_back({text_.size(), line, column});
  std::string lower = lower_case(text);
  std::replace(lower.begin(), lower.end(), '\t', ' ');
  text_ += lower;
}

SourcePosition Card::position(std::size_t at) const {
  const auto behind =
      std::upper_bound(pieces_.begin(), pieces_.end(), at,
                       [](std::size_t offset, const Piece& piece) { return offset < piece.begin; });
  const Piece& piece = *std::prev(behind);
  return {*file_, piece.line, piece.column + at - piece.begin};
}

void Card::fail(ErrorId id, std::string found, std::string expected, std::size_t at) const {
  throw Error(id, {std::move(found), std::move(expected), position(at)});
}

Deck read_deck(std::string_view text, const std::string& name) {
  return DeckReader(text, name).read();
}

std::vector<Word> words_of(const Card& card, std::size_t from, std::size_t to, bool splits_colons) {
  const std::string_view text = card.text().substr(0, to);
  const auto is_separator = [](char c) { return c == ' ' || c == '=' || c == '\r'; };
  const auto is_alone = [&](char c) { return c == '(' || c == ')' || (splits_colons && c == ':'); };
  std::vector<Word> words;
  for (std::size_t at = from; at < text.size();) {
    if (is_separator(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at + 1;
    if (!is_alone(text[at])) {
      while (end < text.size() && !is_separator(text[end]) && !is_alone(text[end])) ++end;
    }
    words.push_back({std::string(text.substr(at, end - at)), at});
    at = end;
  }
  return words;
}

bool is_number(std::string_view text) { return !standard_number(text).empty(); }

Rational number_of(const Card& card, const Word& word) {
  const std::string standard = standard_number(word.text);
  if (standard.empty()) {
    card.fail(ErrorId::UnexpectedText, quoted(word.text), "a number", word.at);
  }
  try {
    CoordinateSurvey not_used;
    return parse_coordinate(standard, not_used);
  } catch (const Error& error) {
    throw error.at(card.position(word.at));
  }
}

std::int32_t integer_of(const Card& card, const Word& word) {
  const std::string_view digits =
      word.text.starts_with('+') ? std::string_view(word.text).substr(1) : word.text;
  std::int32_t value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  constexpr std::int64_t greatest = 999'999'999;
  if (error == std::errc::result_out_of_range || std::abs(std::int64_t{value}) > greatest) {
    card.fail(ErrorId::NumberOutOfRange, quoted(word.text), "at most nine digits", word.at);
  }
  if (error != std::errc() || stop != end) {
    card.fail(ErrorId::UnexpectedText, quoted(word.text), "an integer", word.at);
  }
  return value;
}

void EntryList::make_room(std::size_t count, const Word& word) const {
  if (count <= most_ && entries_.size() <= most_ - count) return;
  card_.fail(ErrorId::TooLarge, "a list of more numbers", fmt::format("at most {}", most_),
             word.at);
}

const Rational& EntryList::last(const Word& word) const {
  if (entries_.empty() || !entries_.back().value || interpolation_) {
    card_.fail(ErrorId::UnexpectedText, quoted(word.text) + " without a number before it",
               "a number", word.at);
  }
  return *entries_.back().value;
}

void EntryList::add_number(const Word& word, Rational value) {
  if (interpolation_) {
    const Rational first = *entries_.back().value;
    const Rational step = (value - first) / Rational(static_cast<unsigned long>(between_ + 1));
    for (std::size_t i = 1; i <= between_; ++i) {
      entries_.push_back(
          {Rational(first + step * Rational(static_cast<unsigned long>(i))), *interpolation_});
    }
    interpolation_.reset();
  }
  entries_.push_back({std::move(value), word});
}

void EntryList::add(const Word& word) {
  const std::string& text = word.text;
  const std::size_t letters = std::min(text.find_first_not_of("+-.0123456789"), text.size());
  const std::string_view kind = std::string_view(text).substr(letters);
  const bool is_abbreviation =
      kind == "r" || kind == "i" || kind == "m" || kind == "j" || kind == "log" || kind == "ilog";
  if (!is_abbreviation) {
    make_room(1, word);
    return add_number(word, number_of(card_, word));
  }
  if (kind == "log" || kind == "ilog") {
    card_.fail(ErrorId::UnsupportedNode, quoted(text) + ", whose numbers are irrational",
               "the numbers themselves", word.at);
  }
  const Word factor{text.substr(0, letters), word.at};
  if (kind == "m") {
    make_room(1, word);
    Rational product = last(word) * number_of(card_, factor);
    entries_.push_back({std::move(product), word});
    return;
  }
  const std::int32_t count = letters == 0 ? 1 : integer_of(card_, factor);
  if (count <= 0) {
    card_.fail(ErrorId::BadArgument, quoted(text), "a count above 0", word.at);
  }
  const auto size = static_cast<std::size_t>(count);
  make_room(size, word);
  if (kind == "r") {
    const Rational value = last(word);
    for (std::size_t i = 0; i < size; ++i) entries_.push_back({value, word});
  } else if (kind == "i") {
    last(word);
    make_room(size + 1, word);
    interpolation_ = word;
    between_ = size;
  } else {
    if (interpolation_) {
      card_.fail(ErrorId::UnexpectedText, quoted(text) + " behind an interpolation", "a number",
                 word.at);
    }
    for (std::size_t i = 0; i < size; ++i) entries_.push_back({std::nullopt, word});
  }
}

std::vector<Entry> EntryList::finish() {
  if (interpolation_) {
    card_.fail(ErrorId::MissingValue, quoted(interpolation_->text) + " without a number behind it",
               "a number", interpolation_->at);
  }
  return std::exchange(entries_, {});
}

std::vector<Entry> entries_of(const Card& card, const std::vector<Word>& words, std::size_t from,
                              std::size_t most) {
  EntryList list(card, most);
  for (std::size_t i = from; i < words.size(); ++i) list.add(words[i]);
  return list.finish();
}

std::vector<Rational> values_of(const Card& card, const std::vector<Entry>& entries) {
  std::vector<Rational> values;
  for (const Entry& entry : entries) {
    if (!entry.value) {
      card.fail(ErrorId::BadArgument, "a number that is jumped over", "a number", entry.word.at);
    }
    values.push_back(*entry.value);
  }
  return values;
}

}  // namespace exactcsg::io::mcnp
