// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The arguments of a node as typed values: by name or by position, missing and undefined ones as
// their defaults, unknown ones with a warning, wrong ones as errors with a position.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/io/openscad/syntax.hpp"
#include "exactcsg/number/exact.hpp"

namespace exactcsg::io::openscad {

// Collects what a reader has to say; after `limit` warnings only one more says so.
class Warnings {
 public:
  void add(std::string text, SourcePosition position);
  std::vector<Warning> take() && { return std::move(list_); }

 private:
  static constexpr std::size_t limit = 1000;
  std::vector<Warning> list_;
};

class Arguments {
 public:
  // `names`: those that the node knows; the first `positional` of them may stand without a name.
  // The names must outlive this object.
  Arguments(const SyntaxTree& tree, std::uint32_t node, std::span<const std::string_view> names,
            std::size_t positional, Warnings& warnings);

  // The value given, unless it is missing or undefined.
  const Value* find(std::string_view name) const;
  // True if a value was given, even an undefined one.
  bool is_given(std::string_view name) const;

  // THROWS Error(BadArgument | NumberOutOfRange) at the argument, all of them.
  std::optional<Rational> number(std::string_view name) const;
  std::optional<bool> boolean(std::string_view name) const;
  // A vector of exactly `size` numbers; with `scalar_repeats`, one number stands for `size` equal
  // ones.
  std::optional<std::vector<Rational>> vector(std::string_view name, std::size_t size,
                                              bool scalar_repeats) const;

  Rational number_of(const Value& value, std::string_view what) const;
  // Indices of the elements of a vector. THROWS Error(BadArgument) if it is none.
  std::vector<std::uint32_t> elements(const Value& value, std::string_view what) const;
  const Value& value(std::uint32_t index) const { return tree_->values[index]; }

  [[noreturn]] void fail(const Value& value, std::string_view expected) const;
  SourcePosition position(const Value& value) const { return tree_->position(value.offset); }
  SourcePosition node_position() const;
  Warnings& warnings() const { return *warnings_; }

 private:
  const SyntaxTree* tree_;
  std::uint32_t node_;
  std::span<const std::string_view> names_;
  std::array<std::uint32_t, 16> given_;  // by index of the name: index of the value
  Warnings* warnings_;
};

}  // namespace exactcsg::io::openscad
