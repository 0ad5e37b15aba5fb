// SPDX-License-Identifier: Apache-2.0
#pragma once

// CSG trees as text, "(+ (- full a) b)", written and read by a single call. [Exact]
//
//   to_text(tree, put_primitive [, put_operator]) -> string
//   from_text(text, get_primitive [, get_operator [, file]]) -> Tree<P, O>
//   put(writer, tree, put_primitive [, put_operator])      inside a larger text: see gdt/text.hpp
//   get(reader, get_primitive [, get_operator]) -> Tree<P, O>
// and for attributed trees, "@a (+ @b p @c q)", the same with put_attribute and get_attribute after
// the functions for operators; get then yields an AttributedTree<P, O, A>.
//
// put_primitive(const P&) -> text, or put_primitive(TextWriter&, const P&);
// get_primitive(TextReader&)
// -> P. put_operator(O) -> char, get_operator(char) -> optional<O>; without them the operators are
// the Boolean ones, as BooleanCodes writes them. put_attribute and get_attribute are as those for
// primitives.
//
// LAW csg.text.1  from_text(to_text(tree)) == tree if get_primitive(put_primitive(p)) == p and
//                 get_operator(put_operator(o)) == o, and so for attributes. (What was shared is
//                 written again each time.)
// LAW csg.text.2  the grammar is that of docs/format.md; blanks and comments change nothing.
// THROWS put: Error(BadArgument) if the text of a primitive or operator could be taken for
// something else. get: Error(UnexpectedText | TruncatedInput | ...) with line and column, and what
// the user's functions throw, which gets them too if it is an Error. No recursion. COST: O(length
// of the text).
//
// Source: Davy and Dew, section 3.5 (CSGget, CSGput); the grammar is ours.

#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/csg/attributed.hpp"
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

template <class F, class O>
concept PutsOperator = std::is_invocable_r_v<char, F&, const O&>;

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
    Tree<P, O> tree = Tree<P, O>::compose_from(std::move(open_.back().operation),
                                               std::span<Tree<P, O>>(first, done_.end()));
    done_.erase(first, done_.end());
    done_.push_back(std::move(tree));
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

// begin_operator(const O&) and primitive(const P&) write a node up to its operands.
template <class T, class BeginOperator, class WritePrimitive>
void put_nodes(TextWriter& out, const T& tree, BeginOperator&& begin_operator,
               WritePrimitive&& write_primitive) {
  walk(
      tree.root(),
      [&](auto node) {
        begin_operator(node.operation());
        return true;
      },
      [&](auto node) {
        if (node.kind() == NodeKind::Primitive) return write_primitive(node.primitive());
        out.separate();
        out.write(node.kind() == NodeKind::Full ? full_word : empty_word);
      },
      [&](auto) { out.write(')'); });
}

template <class A, class PutAttribute>
void put_attribute_text(TextWriter& out, const A& attribute, PutAttribute& put_attribute) {
  out.separate();
  out.write('@');
  exactcsg::detail::put_text(out, put_attribute, attribute, "#");
}

// How nodes are read that have no attributes.
struct NoAttributes {
  template <class T>
  T with(TextReader&, T value) {
    return value;
  }
  bool take(TextReader&, char) { return false; }
  bool waits() const noexcept { return false; }
};
// The attribute that was read last waits for its node.
template <class GetAttribute>
class Attributes {
 public:
  explicit Attributes(GetAttribute& get) : get_(get) {}
  template <class T>
  Attributed<T, TextValue<GetAttribute>> with(TextReader& in, T value) {
    if (!waits()) {
      in.fail(ErrorId::UnexpectedText, "no attribute", "'@' and an attribute before it");
    }
    Attributed<T, TextValue<GetAttribute>> node{std::move(value), std::move(waiting_.back())};
    waiting_.pop_back();
    return node;
  }
  bool take(TextReader& in, char next) {
    if (next != '@' || waits()) return false;
    in.character("@");
    waiting_.push_back(exactcsg::detail::get_text(in, get_));
    return true;
  }
  bool waits() const noexcept { return !waiting_.empty(); }

 private:
  GetAttribute& get_;
  std::vector<TextValue<GetAttribute>> waiting_;  // none or one
};

template <class P, class O, class Reader, class GetPrimitive, class GetOperator>
Tree<P, O> get_nodes(TextReader& in, GetPrimitive& get_primitive, GetOperator& get_operator,
                     Reader attributes) {
  using T = Tree<P, O>;
  OpenNodes<P, O> nodes;
  do {
    const char next = in.peek();
    if (attributes.take(in, next)) continue;
    if (next == '(') {
      const std::size_t offset = in.offset();
      in.character("(");
      nodes.open(attributes.with(in, get_operator_code(in, get_operator)), offset);
    } else if (next == ')' && !nodes.none() && nodes.has_operands() && !attributes.waits()) {
      in.character(")");
      nodes.close();
    } else if (next == 'e' && !attributes.waits() && in.take(empty_word)) {
      nodes.add(T::empty());
    } else if (next == 'f' && !attributes.waits() && in.take(full_word)) {
      nodes.add(T::full());
    } else if (exactcsg::detail::kind_of(next) == exactcsg::detail::CharacterKind::OfWord) {
      if (in.take(empty_word) || in.take(full_word)) in.unexpected_token("a primitive or operator");
      nodes.add(T::primitive(attributes.with(in, exactcsg::detail::get_text(in, get_primitive))));
    } else if (!nodes.none() && in.at_end()) {
      in.not_closed(nodes.last_offset());
    } else {
      in.unexpected(next == ')' && !nodes.none() ? "an operand" : "a CSG tree");
    }
  } while (!nodes.none() || attributes.waits());
  return nodes.take();
}

}  // namespace detail

template <ReadableTree T, class PutPrimitive, class PutOperator = BooleanCodes>
requires PutsText<PutPrimitive, typename T::Primitive> &&
    PutsOperator<PutOperator, typename T::Operator>
void put(TextWriter& out, const T& tree, PutPrimitive&& put_primitive,
         PutOperator&& put_operator = {}) {
  detail::put_nodes(
      out, tree, [&](const auto& op) { detail::put_operator_code(out, op, put_operator); },
      [&](const auto& primitive) { detail::put_primitive_text(out, primitive, put_primitive); });
}

template <class P, class O, class A, class PutPrimitive, class PutOperator, class PutAttribute>
requires PutsText<PutPrimitive, P> && PutsOperator<PutOperator, O> && PutsText<PutAttribute, A>
void put(TextWriter& out, const Tree<Attributed<P, A>, Attributed<O, A>>& tree,
         PutPrimitive&& put_primitive, PutOperator&& put_operator, PutAttribute&& put_attribute) {
  detail::put_nodes(
      out, tree,
      [&](const Attributed<O, A>& op) {
        detail::put_attribute_text(out, op.attribute, put_attribute);
        detail::put_operator_code(out, op.value, put_operator);
      },
      [&](const Attributed<P, A>& primitive) {
        detail::put_attribute_text(out, primitive.attribute, put_attribute);
        detail::put_primitive_text(out, primitive.value, put_primitive);
      });
}

template <GetsText GetPrimitive, GetsOperator GetOperator = BooleanCodes,
          class P = TextValue<GetPrimitive>,
          class O = typename std::invoke_result_t<GetOperator&, char>::value_type>
Tree<P, O> get(TextReader& in, GetPrimitive&& get_primitive, GetOperator&& get_operator = {}) {
  return detail::get_nodes<P, O>(in, get_primitive, get_operator, detail::NoAttributes{});
}

template <GetsText GetPrimitive, GetsOperator GetOperator, GetsText GetAttribute,
          class A = TextValue<GetAttribute>, class P = TextValue<GetPrimitive>,
          class O = typename std::invoke_result_t<GetOperator&, char>::value_type>
AttributedTree<P, O, A> get(TextReader& in, GetPrimitive&& get_primitive,
                            GetOperator&& get_operator, GetAttribute&& get_attribute) {
  return detail::get_nodes<Attributed<P, A>, Attributed<O, A>>(
      in, get_primitive, get_operator,
      detail::Attributes<std::remove_reference_t<GetAttribute>>(get_attribute));
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

template <class P, class O, class A, class PutPrimitive, class PutOperator, class PutAttribute>
std::string to_text(const Tree<Attributed<P, A>, Attributed<O, A>>& tree,
                    PutPrimitive&& put_primitive, PutOperator&& put_operator,
                    PutAttribute&& put_attribute) {
  TextWriter out;
  put(out, tree, put_primitive, put_operator, put_attribute);
  return std::move(out).take();
}

template <GetsText GetPrimitive, GetsOperator GetOperator, GetsText GetAttribute>
auto from_text(std::string_view text, GetPrimitive&& get_primitive, GetOperator&& get_operator,
               GetAttribute&& get_attribute, std::string file = {}) {
  return read_whole(text, std::move(file), [&](TextReader& in) {
    return get(in, get_primitive, get_operator, get_attribute);
  });
}

}  // namespace exactcsg::csg
