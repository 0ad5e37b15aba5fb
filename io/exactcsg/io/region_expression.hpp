// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Regions as codes of particle transport write them: from the strongest, parentheses, complement,
// a blank or nothing (intersection), union. [Exact]
//
// By hand and not by the grammar library that reads .csg: that one recurses, and three operators on
// one level of text are one loop over a stack of open parentheses.
// LAW region_expression.1  the tree is that of these precedences; of one operand nothing is made.
// LAW region_expression.2  no text is too deep: nothing here recurses.
//
// What the codes differ in is their Language:
//   Tree                       a csg::BooleanTree
//   blanks                     the characters that separate
//   complement, alternative    the characters of complement and union
//   operand_names, end_name    for messages: what may be an operand, where the text ends
//   operand(text, at, follows_complement) -> Tree
//                              the operand at `at`, which is then behind it
//   complement_of(Tree) -> Tree
//   fail(found, expected, at)  throws Error(UnexpectedText) of a place in the text

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactcsg/csg/tree.hpp"

namespace exactcsg::io {

template <class Language>
class RegionExpression {
 public:
  using Tree = typename Language::Tree;

  // The text from `begin` on. REQUIRES that the language outlives this
  RegionExpression(const Language& language, std::string_view text, std::size_t begin = 0)
      : language_(language), text_(text), at_(begin), open_(1) {}

  // Once. THROWS Error(UnexpectedText), and what the language throws
  Tree parse() {
    while (at_ < text_.size()) take_token();
    if (open_.size() > 1) {
      language_.fail("a parenthesis that is not closed", "')'", open_.back().offset);
    }
    return closed();
  }

 private:
  // What is within a pair of parentheses that is open, or within none.
  struct Level {
    std::size_t offset = 0;       // of the parenthesis
    std::vector<Tree> terms;      // of the union, finished
    std::vector<Tree> factors;    // of the intersection at work
    std::size_t complements = 0;  // before the next operand
    bool awaits_operand = false;  // behind a complement or a union
  };

  void take_token() {
    Level& level = open_.back();
    const char c = text_[at_];
    if (c == '(') {
      open_.push_back({at_, {}, {}, 0, false});
    } else if (c == ')') {
      if (open_.size() == 1) language_.fail("')' without '('", "as many of both", at_);
      Tree inner = closed();
      open_.pop_back();
      add(std::move(inner));
    } else if (c == Language::complement) {
      ++level.complements;
      level.awaits_operand = true;
    } else if (c == Language::alternative) {
      finish_term();
      level.awaits_operand = true;
    } else if (Language::blanks.find(c) == std::string_view::npos) {
      add(language_.operand(text_, at_, level.complements > 0));
      return;
    }
    ++at_;
  }

  void add(Tree operand) {
    Level& level = open_.back();
    if (std::exchange(level.complements, 0) % 2 == 1) {
      operand = language_.complement_of(std::move(operand));
    }
    level.factors.push_back(std::move(operand));
    level.awaits_operand = false;
  }

  void finish_term() {
    Level& level = open_.back();
    if (level.factors.empty() || level.awaits_operand) {
      language_.fail(at_ < text_.size() ? "'" + std::string(1, text_[at_]) + '\''
                                        : std::string(Language::end_name),
                     std::string(Language::operand_names), at_);
    }
    level.terms.push_back(compose(csg::BooleanOperator::Intersection, level.factors));
  }

  Tree closed() {
    finish_term();
    return compose(csg::BooleanOperator::Union, open_.back().terms);
  }

  static Tree compose(csg::BooleanOperator operation, std::vector<Tree>& operands) {
    Tree result = operands.size() == 1 ? std::move(operands.front())
                                       : Tree::compose(operation, std::move(operands));
    operands.clear();
    return result;
  }

  const Language& language_;
  std::string_view text_;
  std::size_t at_;
  std::vector<Level> open_;
};

}  // namespace exactcsg::io
