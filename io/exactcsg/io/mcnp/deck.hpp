// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// An MCNP input file as cards that know their lines and columns, and the numbers on them. [Exact]
//
// The file: a message block if it begins with "message:", up to a blank line; a title; cell cards,
// a blank line, surface cards, a blank line, data cards, up to a blank line or the end. A card
// begins in the first five columns, and goes on in lines that do not and in the line behind a line
// that ends with " &". Comments: lines with a c in the first five columns and a blank behind it;
// from $ to the end of any line. Upper and lower case are the same; a tab goes to the next of
// columns 9, 17, ... What stands behind column 128 is refused.
//
// Source: the user's manuals of MCNP (5 and 6), chapter on the form of the input file.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactcsg/number/exact.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io::mcnp {

// One card without its comments, in lower case, blanks for tabs and between its lines.
class Card {
 public:
  explicit Card(std::shared_ptr<const std::string> file) : file_(std::move(file)) {}
  void add_line(std::string_view text, std::size_t line, std::size_t column);

  std::string_view text() const { return text_; }
  SourcePosition position(std::size_t at = 0) const;
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected,
                         std::size_t at = 0) const;

 private:
  struct Piece {
    std::size_t begin;  // in the text
    std::size_t line;
    std::size_t column;
  };
  std::shared_ptr<const std::string> file_;
  std::string text_;
  std::vector<Piece> pieces_;
};

struct Deck {
  std::string title;
  std::vector<Card> cells;
  std::vector<Card> surfaces;
  std::vector<Card> data;
};

// THROWS Error(EmptyFile | NotText | UnexpectedText | TruncatedInput | MissingValue)
Deck read_deck(std::string_view text, const std::string& name);

// A part of a card's text.
struct Word {
  std::string text;
  std::size_t at = 0;
};

// What blanks and = separate; ( ) and, if asked for, : are words of their own.
std::vector<Word> words_of(const Card& card, std::size_t from, std::size_t to,
                           bool splits_colons = false);

// As Fortran reads it: "1.5", "-.5", "1e3", "1.5+3", "1d-3".
// THROWS Error(UnexpectedText | NumberOutOfRange)
Rational number_of(const Card& card, const Word& word);
std::int32_t integer_of(const Card& card, const Word& word);
bool is_number(std::string_view text);

// A number of a list. nullopt: jumped over.
struct Entry {
  std::optional<Rational> value;
  Word word;
};

// Numbers with the abbreviations nR (the last one n times more), nI (n between this and the next,
// evenly), xM (x times the last one) and nJ (n jumped over).
class EntryList {
 public:
  EntryList(const Card& card, std::size_t most) : card_(card), most_(most) {}
  // THROWS Error(UnexpectedText | BadArgument | TooLarge | UnsupportedNode), and those of numbers
  void add(const Word& word);
  // THROWS Error(MissingValue) if an interpolation has no end.
  std::vector<Entry> finish();
  std::size_t size() const { return entries_.size(); }

 private:
  const Rational& last(const Word& word) const;
  void make_room(std::size_t count, const Word& word) const;
  void add_number(const Word& word, Rational value);

  const Card& card_;
  std::size_t most_;
  std::vector<Entry> entries_;
  std::optional<Word> interpolation_;
  std::size_t between_ = 0;
};

std::vector<Entry> entries_of(const Card& card, const std::vector<Word>& words, std::size_t from,
                              std::size_t most = 1000);
// All of them. THROWS Error(BadArgument) if one is jumped over.
std::vector<Rational> values_of(const Card& card, const std::vector<Entry>& entries);

}  // namespace exactcsg::io::mcnp
