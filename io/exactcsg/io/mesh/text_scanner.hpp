// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Words, counts and exact decimals of a text file, and errors that know their line and column.
// [Exact]

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "exactcsg/number/exact.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io {

// How finely the coordinates of a file are written: what its rounding bound is derived from.
struct CoordinateSurvey {
  int significant_digits = 0;  // of the longest decimal
  Rational largest = 0;        // magnitude

  void note(const Rational& value);
};
// Half a unit in the last place of `digits` decimal (or `bits` binary) digits at the largest
// magnitude. 0 if all coordinates are 0.
Rational half_decimal_unit(const Rational& largest, int digits);
Rational half_binary_unit(const Rational& largest, int bits);
// Of a text file. Writers use "%g" (6 digits) unless more are seen; OpenSCAD's rounds to float32
// first, so that is added wherever the digits do not exclude it.
Rational text_rounding_bound(const CoordinateSurvey& survey);

class TextScanner {
 public:
  // REQUIRES that `text` outlives the scanner. From `comment` on a line is skipped ('\0': none).
  TextScanner(std::string_view text, std::string file, char comment);

  // Both skip blanks and comments first; line ends are blanks to the first one only. A backslash at
  // the end of a line joins it to the next.
  bool at_end();
  bool at_line_end();
  // The next word, on this line or a later one. THROWS Error(TruncatedInput) at the end.
  std::string_view word(std::string_view expected);
  void skip_line();
  std::string_view rest_of_line();  // and goes to the next line

  // THROWS Error(TruncatedInput | UnexpectedText | NumberOutOfRange)
  Rational coordinate(CoordinateSurvey& survey);
  std::uint64_t count(std::string_view expected);
  void skip_number(std::string_view expected);  // any number, "nan" too
  // An index of one of `size` vertices. THROWS Error(UnknownVertex) if it is none.
  std::uint32_t index(std::size_t size);
  // The word, whatever its case.
  void keyword(std::string_view lower_case);

  // Errors about the last word, or about the present place if there is none yet.
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected) const;
  [[noreturn]] void unexpected(std::string_view found, std::string_view expected) const;

  std::size_t offset() const { return at_; }
  std::size_t size() const { return text_.size(); }

 private:
  SourcePosition position_of(std::size_t offset) const;
  // The length of the backslash, the blanks and the line end at this place; 0 if it is none.
  std::size_t joined_line(std::size_t at) const;

  std::string_view text_;
  std::string file_;
  char comment_;
  std::size_t at_ = 0;
  std::size_t word_at_ = 0;
};

bool equals_ignoring_case(std::string_view word, std::string_view lower_case);

// The exact value of a decimal, noted in the survey. THROWS as TextScanner::coordinate, without a
// position.
Rational parse_coordinate(std::string_view word, CoordinateSurvey& survey);

}  // namespace exactcsg::io
