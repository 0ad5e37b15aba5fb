// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/arguments.hpp"

#include <algorithm>
#include <utility>

namespace exactcsg::io::openscad {

namespace {

constexpr std::uint32_t not_given = ~std::uint32_t{0};

std::string describe(const Value& value) {
  using enum Value::Kind;
  switch (value.kind) {
    case Undefined:
      return "undef";
    case Boolean:
      return value.boolean ? "true" : "false";
    case Number:
      return std::string(value.text.substr(0, 40));
    case Text:
      return "a string";
    case Vector:
      return "a vector";
  }
  return "a value";
}

Rational magnitude_limit() {
  Integer limit;
  mpz_ui_pow_ui(limit.get_mpz_t(), 10, 100);
  return limit;
}

}  // namespace

void Warnings::add(std::string text, SourcePosition position) {
  if (list_.size() > limit) return;
  if (list_.size() == limit) text = "more warnings are not shown";
  list_.push_back({std::move(text), std::move(position)});
}

Arguments::Arguments(const SyntaxTree& tree, std::uint32_t node,
                     std::span<const std::string_view> names, std::size_t positional,
                     Warnings& warnings)
    : tree_(&tree), node_(node), names_(names), warnings_(&warnings) {
  given_.fill(not_given);
  const Node& n = tree.nodes[node];
  std::size_t next_positional = 0;
  for (std::uint32_t i = 0; i < n.argument_count; ++i) {
    const Argument& argument = tree.arguments[n.first_argument + i];
    std::size_t index = names.size();
    if (argument.name.empty()) {
      if (next_positional < positional) index = next_positional++;
    } else {
      index = static_cast<std::size_t>(std::find(names.begin(), names.end(), argument.name) -
                                       names.begin());
    }
    if (index == names.size()) {
      warnings.add(
          "'" + std::string(n.name) + "' has no argument " +
              (argument.name.empty() ? "at this place" : "'" + std::string(argument.name) + "'") +
              ": ignored",
          tree.position(argument.offset));
      continue;
    }
    if (given_[index] != not_given) {
      warnings.add("argument '" + std::string(names[index]) + "' is given twice: the last counts",
                   tree.position(argument.offset));
    }
    given_[index] = argument.value;
  }
}

bool Arguments::is_given(std::string_view name) const {
  const auto index = std::find(names_.begin(), names_.end(), name) - names_.begin();
  return given_[static_cast<std::size_t>(index)] != not_given;
}

const Value* Arguments::find(std::string_view name) const {
  const auto index =
      static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  if (given_[index] == not_given) return nullptr;
  const Value& value = tree_->values[given_[index]];
  return value.kind == Value::Kind::Undefined ? nullptr : &value;
}

std::optional<Rational> Arguments::number(std::string_view name) const {
  const Value* const value = find(name);
  if (value == nullptr) return std::nullopt;
  return number_of(*value, "a number");
}

std::optional<bool> Arguments::boolean(std::string_view name) const {
  const Value* const value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->kind != Value::Kind::Boolean) fail(*value, "true or false");
  return value->boolean;
}

std::optional<std::vector<Rational>> Arguments::vector(std::string_view name, std::size_t size,
                                                       bool scalar_repeats) const {
  const Value* const found = find(name);
  if (found == nullptr) return std::nullopt;
  const std::string expected = "a vector of " + std::to_string(size) + " numbers";
  if (scalar_repeats && found->kind == Value::Kind::Number) {
    return std::vector<Rational>(size, number_of(*found, "a number"));
  }
  const std::vector<std::uint32_t> indices = elements(*found, expected);
  if (indices.size() != size) fail(*found, expected);
  std::vector<Rational> numbers;
  numbers.reserve(size);
  for (const std::uint32_t index : indices) numbers.push_back(number_of(value(index), expected));
  return numbers;
}

Rational Arguments::number_of(const Value& value, std::string_view what) const {
  if (value.kind != Value::Kind::Number) fail(value, what);
  static const Rational limit = magnitude_limit();
  std::optional<Rational> number;
  try {
    number = parse_rational(value.text);
  } catch (const Error& error) {
    throw error.at(position(value));
  }
  if (!number) fail(value, what);
  if (abs(*number) > limit) {
    throw Error(ErrorId::NumberOutOfRange,
                {describe(value), "a number between -1e100 and 1e100", position(value)});
  }
  return *std::move(number);
}

std::vector<std::uint32_t> Arguments::elements(const Value& value, std::string_view what) const {
  if (value.kind != Value::Kind::Vector) fail(value, what);
  std::vector<std::uint32_t> indices;
  const auto first = static_cast<std::uint32_t>(&value - tree_->values.data()) + 1;
  for (std::uint32_t i = first; i < value.end; i = tree_->values[i].end) indices.push_back(i);
  return indices;
}

void Arguments::fail(const Value& value, std::string_view expected) const {
  throw Error(ErrorId::BadArgument, {describe(value), std::string(expected), position(value)});
}

SourcePosition Arguments::node_position() const {
  return tree_->position(tree_->nodes[node_].offset);
}

}  // namespace exactcsg::io::openscad
