// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/region.hpp"

#include <fmt/format.h>

#include <utility>

namespace exactcsg::io::openmc {

namespace {

using csg::BooleanOperator;

// Of one operand nothing is composed.
Region compose(BooleanOperator operation, std::vector<Region>& operands) {
  Region result = operands.size() == 1 ? std::move(operands.front())
                                       : Region::compose(operation, std::move(operands));
  operands.clear();
  return result;
}

Region complement_of(Region region) {
  if (!region.is_primitive()) return csg::complement(std::move(region));
  SurfaceSide side = region.primitive();
  side.is_positive = !side.is_positive;
  return Region::primitive(side);
}

// By hand and not by the grammar library that reads .csg: that one recurses, and three operators on
// one level of text are one loop over a stack of open parentheses.
class RegionParser {
 public:
  RegionParser(const Field& field, const std::function<std::optional<Index>(Id)>& surface_of)
      : field_(field), text_(field.text()), surface_of_(surface_of), open_(1) {}

  Region parse() {
    if (field_.stripped().empty()) return Region::full();
    while (at_ < text_.size()) take_token();
    if (open_.size() > 1) {
      fail("a parenthesis that is not closed", "')'", open_.back().offset);
    }
    return closed();
  }

 private:
  // What is within a pair of parentheses that is open, or within none.
  struct Level {
    std::size_t offset = 0;       // of the parenthesis
    std::vector<Region> terms;    // of the union, finished
    std::vector<Region> factors;  // of the intersection at work
    bool complements_next = false;
    bool awaits_operand = false;  // after ~ and |
  };

  [[noreturn]] void fail(std::string found, std::string expected, std::size_t at) const {
    field_.fail(ErrorId::UnexpectedText, std::move(found), std::move(expected), at);
  }

  void take_token() {
    Level& level = open_.back();
    switch (text_[at_]) {
      case ' ':
      case '\t':
      case '\r':
      case '\n':
        break;
      case '(':
        open_.push_back({at_, {}, {}, false, false});
        break;
      case ')': {
        if (open_.size() == 1) fail("')' without '('", "as many of both", at_);
        Region inner = closed();
        open_.pop_back();
        add(std::move(inner));
        break;
      }
      case '~':
        level.complements_next = !level.complements_next;
        level.awaits_operand = true;
        break;
      case '|':
        finish_term();
        level.awaits_operand = true;
        break;
      default:
        add(surface());
        return;
    }
    ++at_;
  }

  void add(Region operand) {
    Level& level = open_.back();
    if (std::exchange(level.complements_next, false)) operand = complement_of(std::move(operand));
    level.factors.push_back(std::move(operand));
    level.awaits_operand = false;
  }

  void finish_term() {
    Level& level = open_.back();
    if (level.factors.empty() || level.awaits_operand) {
      const std::string found =
          at_ < text_.size() ? fmt::format("'{}'", text_[at_]) : std::string("the end");
      fail(found, "a surface or a parenthesis", at_);
    }
    level.terms.push_back(compose(BooleanOperator::Intersection, level.factors));
  }

  Region closed() {
    finish_term();
    return compose(BooleanOperator::Union, open_.back().terms);
  }

  Region surface() {
    const std::size_t begin = at_;
    const bool is_negative = text_[at_] == '-';
    if (is_negative || text_[at_] == '+') ++at_;
    const std::size_t digits = at_;
    at_ = std::min(text_.find_first_not_of("0123456789", digits), text_.size());
    if (at_ == digits) {
      fail(fmt::format("'{}'", text_.substr(begin, digits - begin + 1)),
           "the number of a surface, an operator or a parenthesis", begin);
    }
    constexpr std::size_t most_digits = 9;
    const std::string number(text_.substr(digits, at_ - digits));
    if (number.size() > most_digits) {
      field_.fail(ErrorId::NumberOutOfRange, fmt::format("'{:.40}'", number), "at most nine digits",
                  begin);
    }
    const std::optional<Index> index = surface_of_(std::stoi(number));
    if (!index) {
      field_.fail(ErrorId::UndefinedId, fmt::format("surface {}", number), "the id of a <surface>",
                  begin);
    }
    return Region::primitive({*index, !is_negative});
  }

  const Field& field_;
  std::string_view text_;
  const std::function<std::optional<Index>(Id)>& surface_of_;
  std::vector<Level> open_;
  std::size_t at_ = 0;
};

}  // namespace

Region parse_region(const Field& text, const std::function<std::optional<Index>(Id)>& surface_of) {
  return RegionParser(text, surface_of).parse();
}

}  // namespace exactcsg::io::openmc
