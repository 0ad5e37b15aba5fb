// SPDX-License-Identifier: Apache-2.0
#pragma once

// Decomposition trees as text, "[a [b c] d]", written and read by a single call. [Exact]
//
//   to_text(tree, put_terminal [, put_label]) -> string
//   from_text(text, get_terminal [, get_label [, file]]) -> Tree<T, N>
//   put(writer, tree, put_terminal [, put_label])      inside a larger text
//   get(reader, get_terminal [, get_label]) -> Tree<T, N>
//
// put_terminal(const T&) -> text, or put_terminal(TextWriter&, const T&); get_terminal(TextReader&)
// -> T; for labels the same. Where T holds CSG trees, these call csg::put and csg::get. Labels come
// first, "[label a b]"; a multi-resolution tree is written with put_terminal alone, and read with
// SameForLabels{} in place of get_label.
//
// LAW gdt.text.1  from_text(to_text(tree)) == tree if get_terminal and get_label give back what
//                 put_terminal and put_label wrote.
// LAW gdt.text.2  the grammar is that of docs/format.md; blanks and comments change nothing.
// THROWS put: Error(BadArgument) if the text of a terminal could be taken for something else. get:
// Error(UnexpectedText | TruncatedInput | ...) with line and column, and what the user's functions
// throw, which gets them too if it is an Error. No recursion. Degrees are not written: nodes of any
// degree are read as they are.
// COST: O(length of the text).
//
// Source: Davy and Dew, section 3.5 (GDTget, GDTput); the grammar is ours.

#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/gdt/tree.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/tree_text.hpp"

namespace exactcsg::gdt {

// There are no labels.
struct NoLabelText {
  std::string_view operator()(NoLabel) const noexcept { return {}; }
  NoLabel operator()(TextReader&) const noexcept { return {}; }
};
// The labels are read and written as the terminals are.
struct SameForLabels {};

namespace detail {

template <class LabelText, class TerminalText>
auto& label_text(LabelText& for_labels, TerminalText& for_terminals) {
  if constexpr (std::same_as<std::remove_cv_t<LabelText>, SameForLabels>) {
    return for_terminals;
  } else {
    return for_labels;
  }
}

template <class T, class N>
using DefaultLabelText = std::conditional_t<std::is_empty_v<N>, NoLabelText, SameForLabels>;

}  // namespace detail

template <class T, class N, class PutTerminal, class PutLabel = detail::DefaultLabelText<T, N>>
requires PutsText<PutTerminal, T>
void put(TextWriter& out, const Tree<T, N>& tree, PutTerminal&& put_terminal,
         PutLabel&& put_label = {}) {
  using Node = typename Tree<T, N>::Node;
  struct Open {
    Node node;
    std::size_t next;
  };
  std::vector<Open> open;
  const auto begin = [&](const Node& node) {
    if (node.is_terminal()) {
      exactcsg::detail::put_text(out, put_terminal, node.terminal(), "[])#");
      return;
    }
    out.separate();
    out.write('[');
    if constexpr (!std::is_empty_v<N>) {
      exactcsg::detail::put_text(out, detail::label_text(put_label, put_terminal), node.label(),
                                 "#");
    }
    open.push_back({node, 0});
  };
  begin(tree.root());
  while (!open.empty()) {
    Open& last = open.back();
    if (last.next < last.node.degree()) {
      begin(last.node.child(last.next++));
    } else {
      out.write(']');
      open.pop_back();
    }
  }
}

template <GetsText GetTerminal, class GetLabel = NoLabelText>
auto get(TextReader& in, GetTerminal&& get_terminal, GetLabel&& get_label = {}) {
  using T = TextValue<GetTerminal>;
  auto& label_of = detail::label_text(get_label, get_terminal);
  using N = TextValue<decltype(label_of)>;
  typename Tree<T, N>::Builder nodes;
  std::vector<std::size_t> brackets;  // where they were opened
  do {
    const char next = in.peek();
    if (next == '[') {
      brackets.push_back(in.offset());
      in.character("[");
      nodes.open(exactcsg::detail::get_text(in, label_of));
    } else if (next == ']' && !brackets.empty()) {
      in.character("]");
      nodes.close();
      brackets.pop_back();
    } else if (next == ']' || next == ')') {
      in.unexpected("a decomposition tree");
    } else if (!in.at_end()) {
      nodes.terminal(exactcsg::detail::get_text(in, get_terminal));
    } else if (brackets.empty()) {
      in.unexpected("a decomposition tree");
    } else {
      in.not_closed(brackets.back());
    }
  } while (!brackets.empty());
  return std::move(nodes).take();
}

template <class T, class N, class PutTerminal, class PutLabel = detail::DefaultLabelText<T, N>>
std::string to_text(const Tree<T, N>& tree, PutTerminal&& put_terminal, PutLabel&& put_label = {}) {
  TextWriter out;
  put(out, tree, put_terminal, put_label);
  return std::move(out).take();
}

template <GetsText GetTerminal, class GetLabel = NoLabelText>
auto from_text(std::string_view text, GetTerminal&& get_terminal, GetLabel&& get_label = {},
               std::string file = {}) {
  return read_whole(text, std::move(file),
                    [&](TextReader& in) { return get(in, get_terminal, get_label); });
}

}  // namespace exactcsg::gdt
