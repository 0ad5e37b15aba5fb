// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The text of a .csg file as a tree of nodes, flat in three arrays: nothing in it is nested, so a
// tree of any depth is built, walked and destroyed without recursion.
//
// Grammar (after white space and // and /* */ comments are skipped):
//   file     := statement*
//   statement:= ("%" | "#" | "!" | "*")* name "(" [ argument ("," argument)* [","] ] ")"
//               ( ";" | "{" statement* "}" ) | ";"
//   argument := [ name "=" ] value
//   value    := number | string | "true" | "false" | "undef" | ["-"] "inf" | ["-"] "nan"
//             | "[" [ value ("," value)* [","] ] "]"
//
// LAW syntax.1  positions: every node and argument remembers the byte at which it starts.
// LAW syntax.2  parse(text) throws Error or returns; it never reads outside `text`, and its stack
//               does not grow with the depth of the nodes. Vectors nest at most
//               `vector_depth_limit`.
// COST: O(length of the text).

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "exactcsg/support/error.hpp"

namespace exactcsg::io::openscad {

constexpr std::size_t vector_depth_limit = 64;

struct Value {
  // Undefined is `undef`, and inf and nan too: OpenSCAD writes them but reads them back as names
  // that it does not know, hence as undef.
  enum class Kind : std::uint8_t { Undefined, Boolean, Number, Text, Vector };
  Kind kind = Kind::Undefined;
  bool boolean = false;
  std::uint32_t offset = 0;  // in the text
  // One past the last value inside a vector; for others, one past this value. The elements of the
  // vector at i are i + 1, values[i + 1].end, ... up to values[i].end.
  std::uint32_t end = 0;
  std::string_view text;  // the number, or what stands between the quotes, escapes not resolved
};

struct Argument {
  std::string_view name;  // empty if it was given by position
  std::uint32_t offset = 0;
  std::uint32_t value = 0;  // index of its value
};

struct Modifiers {
  bool background = false;  // %
  bool highlight = false;   // #
  bool root = false;        // !
  bool disabled = false;    // *
};

struct Node {
  std::string_view name;
  Modifiers modifiers;
  std::uint32_t offset = 0;  // of the name
  std::uint32_t first_argument = 0;
  std::uint32_t argument_count = 0;
  // One past the last node of its subtree: children are i + 1, nodes[i + 1].end, ...
  std::uint32_t end = 0;
};

struct SyntaxTree {
  std::string file;
  std::vector<Node> nodes;
  std::vector<Argument> arguments;
  std::vector<Value> values;
  std::vector<std::uint32_t> line_starts;

  SourcePosition position(std::uint32_t offset) const;
};

// The tree's views point into `text`, which must outlive it.
// THROWS Error(EmptyFile | NotText | UnexpectedText | TruncatedInput | TooDeep | TooLarge), with a
// position where there is one.
SyntaxTree parse(std::string_view text, std::string file, std::size_t nesting_limit);

}  // namespace exactcsg::io::openscad
