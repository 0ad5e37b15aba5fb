// SPDX-License-Identifier: Apache-2.0
#pragma once

// CSG trees as text, "(+ (- full a) b)", written and read by a single call. [Exact]
//
//   to_text(tree, put_primitive [, put_operator]) -> string
//   from_text(text, get_primitive [, get_operator [, file]]) -> Tree<P, O>
//   put(writer, tree, put_primitive [, put_operator])      inside a larger text: see gdt/text.hpp
//   get(reader, get_primitive [, get_operator]) -> Tree<P, O>
//
// put_primitive(const P&) -> text, or put_primitive(TextWriter&, const P&);
// get_primitive(TextReader&)
// -> P. put_operator(O) -> char, get_operator(char) -> optional<O>; without them the operators are
// the Boolean ones, as BooleanCodes writes them.
//
// LAW csg.text.1  from_text(to_text(tree)) == tree if get_primitive(put_primitive(p)) == p and
//                 get_operator(put_operator(o)) == o. (What was shared is written again each time.)
// LAW csg.text.2  the grammar is that of docs/format.md; blanks and comments change nothing.
// THROWS put: Error(BadArgument) if the text of a primitive or operator could be taken for
// something else. get: Error(UnexpectedText | TruncatedInput | ...) with line and column, and what
// the user's functions throw, which gets them too if it is an Error. No recursion. COST: O(length
// of the text).
//
// Source: Davy and Dew, section 3.5 (CSGget, CSGput); the grammar is ours.

#include <concepts>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/csg/tree_concept.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/tree_text.hpp"

namespace exactcsg::csg {

// + union, & intersection, - difference, ^ symmetric difference
struct BooleanCodes {
  static constexpr std::string_view codes = "+&-^";
  constexpr char operator()(BooleanOperator op) const noexcept {
    return codes[static_cast<std::size_t>(op)];
  }
  constexpr std::optional<BooleanOperator> operator()(char code) const noexcept {
    const std::size_t index = codes.find(code);
    if (index == std::string_view::npos) return std::nullopt;
    return static_cast<BooleanOperator>(index);
  }
};

// get_operator(char) -> optional of the operators' type
template <class F>
concept GetsOperator = requires(F& function, char code) {
  typename std::invoke_result_t<F&, char>::value_type;
  {static_cast<bool>(function(code))};
  {*function(code)};
};

namespace detail {

inline constexpr std::string_view empty_word = "empty";
inline constexpr std::string_view full_word = "full";
inline constexpr std::string_view reserved_for_nodes = "()[]@#";

template <class O, class PutOperator>
void put_operator_code(TextWriter& out, const O& operation, PutOperator& put_operator) {
  const char code = put_operator(operation);
  if (exactcsg::detail::kind_of(code) != exactcsg::detail::CharacterKind::OfWord) {
    throw Error(ErrorId::BadArgument,
                {"the operator " + TextReader::quoted({&code, 1}), "no blank or bracket"});
  }
  out.separate();
  out.write('(');
  out.write(code);
}

template <class P, class PutPrimitive>
void put_primitive_text(TextWriter& out, const P& primitive, PutPrimitive& put_primitive) {
  const std::size_t before = out.size();
  exactcsg::detail::put_text(out, put_primitive, primitive, reserved_for_nodes);
  TextReader written(out.written_since(before));
  written.peek();
  if (written.take(empty_word) || written.take(full_word)) {
    throw Error(ErrorId::BadArgument, {"a primitive written as 'empty' or 'full'", "another word"});
  }
}

template <class F>
auto get_operator_code(TextReader& in, F& get_operator) {
  const char code = in.character("an operator");
  if (const auto operation = get_operator(code)) return *operation;
  in.fail(ErrorId::UnexpectedText, TextReader::quoted({&code, 1}), "an operator");
}

// The composed nodes that are not closed yet, and the trees that wait to become operands.
template <class P, class O>
class OpenNodes {
 public:
  bool none() const noexcept { return open_.empty(); }
  void open(O operation, std::size_t offset) {
    open_.push_back({std::move(operation), done_.size(), offset});
  }
  void add(Tree<P, O> operand) { done_.push_back(std::move(operand)); }
  // REQUIRES !none(), these two
  bool has_operands() const noexcept { return done_.size() > open_.back().first_operand; }
  std::size_t last_offset() const noexcept { return open_.back().offset; }
  // REQUIRES has_operands()
  void close() {
    const auto first = done_.begin() + static_cast<std::ptrdiff_t>(open_.back().first_operand);
    std::vector<Tree<P, O>> operands(std::make_move_iterator(first),
                                     std::make_move_iterator(done_.end()));
    done_.erase(first, done_.end());
    done_.push_back(Tree<P, O>::compose(std::move(open_.back().operation), std::move(operands)));
    open_.pop_back();
  }
  // REQUIRES none(), and that one tree was made
  Tree<P, O> take() { return std::move(done_.back()); }

 private:
  struct Open {
    O operation;
    std::size_t first_operand;
    std::size_t offset;
  };
  std::vector<Open> open_;
  std::vector<Tree<P, O>> done_;
};

}  // namespace detail

template <ReadableTree T, class PutPrimitive, class PutOperator = BooleanCodes>
requires PutsText<PutPrimitive, typename T::Primitive> &&
    std::is_invocable_r_v<char, PutOperator&, typename T::Operator>
void put(TextWriter& out, const T& tree, PutPrimitive&& put_primitive,
         PutOperator&& put_operator = {}) {
  walk(
      tree.root(),
      [&](auto node) {
        detail::put_operator_code(out, node.operation(), put_operator);
        return true;
      },
      [&](auto node) {
        if (node.kind() == NodeKind::Primitive) {
          return detail::put_primitive_text(out, node.primitive(), put_primitive);
        }
        out.separate();
        out.write(node.kind() == NodeKind::Full ? detail::full_word : detail::empty_word);
      },
      [&](auto) { out.write(')'); });
}

template <GetsText GetPrimitive, GetsOperator GetOperator = BooleanCodes,
          class P = TextValue<GetPrimitive>,
          class O = typename std::invoke_result_t<GetOperator&, char>::value_type>
Tree<P, O> get(TextReader& in, GetPrimitive&& get_primitive, GetOperator&& get_operator = {}) {
  detail::OpenNodes<P, O> nodes;
  do {
    const char next = in.peek();
    if (next == '(') {
      const std::size_t offset = in.offset();
      in.character("(");
      nodes.open(detail::get_operator_code(in, get_operator), offset);
    } else if (next == ')' && !nodes.none()) {
      if (!nodes.has_operands()) in.unexpected("an operand");
      in.character(")");
      nodes.close();
    } else if (next == 'e' && in.take(detail::empty_word)) {
      nodes.add(Tree<P, O>::empty());
    } else if (next == 'f' && in.take(detail::full_word)) {
      nodes.add(Tree<P, O>::full());
    } else if (exactcsg::detail::kind_of(next) == exactcsg::detail::CharacterKind::OfWord) {
      nodes.add(Tree<P, O>::primitive(exactcsg::detail::get_text(in, get_primitive)));
    } else if (!nodes.none() && in.at_end()) {
      in.not_closed(nodes.last_offset());
    } else {
      in.unexpected("a CSG tree");
    }
  } while (!nodes.none());
  return nodes.take();
}

template <ReadableTree T, class PutPrimitive, class PutOperator = BooleanCodes>
std::string to_text(const T& tree, PutPrimitive&& put_primitive, PutOperator&& put_operator = {}) {
  TextWriter out;
  put(out, tree, put_primitive, put_operator);
  return std::move(out).take();
}

template <GetsText GetPrimitive, GetsOperator GetOperator = BooleanCodes>
auto from_text(std::string_view text, GetPrimitive&& get_primitive, GetOperator&& get_operator = {},
               std::string file = {}) {
  return read_whole(text, std::move(file),
                    [&](TextReader& in) { return get(in, get_primitive, get_operator); });
}

}  // namespace exactcsg::csg
