// SPDX-License-Identifier: GPL-3.0-or-later
// Boost.Spirit X3 reads the tokens, values and the header of one node; the nesting of nodes is an
// explicit stack, so that its depth costs no call stack
// (docs/decisions/0010-spirit-x3-reads-csg.md).
#include <algorithm>
#include <boost/spirit/home/x3.hpp>
#include <functional>
#include <limits>
#include <utility>

#include "exactcsg/io/openscad/syntax.hpp"

namespace exactcsg::io::openscad {

SourcePosition SyntaxTree::position(std::uint32_t offset) const {
  const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
  const auto line = static_cast<std::size_t>(after - line_starts.begin());
  return {file, line, offset - line_starts[line - 1] + 1};
}

namespace {

namespace x3 = boost::spirit::x3;

using Range = boost::iterator_range<const char*>;

std::string_view view(const Range& range) {
  return {range.begin(), static_cast<std::size_t>(range.size())};
}

// What the grammar's actions write to.
struct Sink {
  SyntaxTree& tree;
  const char* begin;
  std::vector<std::uint32_t> open_vectors{};
  bool too_deep = false;

  std::uint32_t offset(const char* at) const { return static_cast<std::uint32_t>(at - begin); }

  void add(Value::Kind kind, const Range& range, bool boolean = false) {
    Value value;
    value.kind = kind;
    value.boolean = boolean;
    value.offset = offset(range.begin());
    value.end = static_cast<std::uint32_t>(tree.values.size() + 1);
    value.text = view(range);
    tree.values.push_back(value);
  }
  bool open(const Range& range) {
    if (open_vectors.size() >= vector_depth_limit) {
      too_deep = true;
      return false;
    }
    open_vectors.push_back(static_cast<std::uint32_t>(tree.values.size()));
    add(Value::Kind::Vector, range);
    return true;
  }
  void close() {
    tree.values[open_vectors.back()].end = static_cast<std::uint32_t>(tree.values.size());
    open_vectors.pop_back();
  }
  void begin_argument(const char* at) {
    Argument argument;
    argument.offset = offset(at);
    argument.value = static_cast<std::uint32_t>(tree.values.size());
    tree.arguments.push_back(argument);
  }
};

struct sink_tag;

template <class Context>
Sink& sink(const Context& context) {
  return x3::get<sink_tag>(context).get();
}

template <class Parser>
auto named(const char* name, const Parser& parser) {
  return x3::rule<Parser, x3::unused_type>{name} = parser;
}

const auto comment = ("//" >> *(x3::char_ - x3::eol)) | ("/*" >> *(x3::char_ - "*/") >> "*/");
// Only ASCII: a byte above 127 is never white space.
const auto skipper = x3::char_(" \t\n\r\f\v") | comment;

const auto letter = x3::char_("a-zA-Z_$");
const auto letter_or_digit = x3::char_("a-zA-Z0-9_$");
const auto digit = x3::char_("0-9");
const auto identifier = x3::lexeme[letter >> *letter_or_digit];
const auto end_of_word = !letter_or_digit;

const auto on_node_name = [](auto& context) {
  Sink& s = sink(context);
  s.tree.nodes.back().name = view(x3::_attr(context));
  s.tree.nodes.back().offset = s.offset(x3::_attr(context).begin());
};
const auto on_modifier = [](auto& context) {
  Modifiers& modifiers = sink(context).tree.nodes.back().modifiers;
  switch (x3::_attr(context)) {
    case '%':
      modifiers.background = true;
      break;
    case '#':
      modifiers.highlight = true;
      break;
    case '!':
      modifiers.root = true;
      break;
    default:
      modifiers.disabled = true;
  }
};
const auto on_argument_start = [](auto& context) {
  sink(context).begin_argument(x3::_attr(context).begin());
};
const auto on_argument_name = [](auto& context) {
  sink(context).tree.arguments.back().name = view(x3::_attr(context));
};
const auto on_number = [](auto& context) {
  sink(context).add(Value::Kind::Number, x3::_attr(context));
};
const auto on_text = [](auto& context) {
  sink(context).add(Value::Kind::Text, x3::_attr(context));
};
const auto on_true = [](auto& context) {
  sink(context).add(Value::Kind::Boolean, x3::_attr(context), true);
};
const auto on_false = [](auto& context) {
  sink(context).add(Value::Kind::Boolean, x3::_attr(context), false);
};
const auto on_undefined = [](auto& context) {
  sink(context).add(Value::Kind::Undefined, x3::_attr(context));
};
const auto on_open = [](auto& context) {
  x3::_pass(context) = sink(context).open(x3::_attr(context));
};
const auto on_close = [](auto& context) { sink(context).close(); };

const auto exponent_digits = named("the digits of an exponent", +digit);
const auto number =
    x3::lexeme[-x3::char_("+-") >> ((+digit >> -('.' >> *digit)) | ('.' >> +digit)) >>
               -((x3::char_("eE") >> -x3::char_("+-")) > exponent_digits) >> end_of_word];
const auto not_a_number = x3::lexeme[-x3::char_("+-") >> (x3::lit("inf") | "nan") >> end_of_word];

template <std::size_t N>
auto word(const char (&text)[N]) {
  return x3::raw[x3::lexeme[x3::lit(text) >> end_of_word]];
}

constexpr const char* string_end_name = "'\"' at the end of the string";
const auto characters = *(('\\' >> x3::char_) | (x3::char_ - x3::char_("\"\\")));
const auto string_end = named(string_end_name, x3::lit('"'));
const auto text_value = x3::lexeme['"' > x3::raw[characters][on_text] > string_end];

// Actions run only where nothing is taken back any more: after the opening bracket everything is
// expected, not tried.
x3::rule<class value_tag, x3::unused_type> const value = "a value";
const auto vector_end = named("',' or ']'", x3::lit(']')[on_close]);
const auto elements = (!x3::lit(']')) > value > *((',' >> !x3::lit(']')) > value) > -x3::lit(',');
const auto vector_value = x3::raw[x3::lit('[')][on_open] > -(elements) > vector_end;
const auto value_def = x3::raw[number][on_number] | text_value | vector_value |
                       word("true")[on_true] | word("false")[on_false] |
                       word("undef")[on_undefined] | x3::raw[not_a_number][on_undefined];
BOOST_SPIRIT_DEFINE(value)

const auto argument_name = (x3::raw[identifier] >> x3::lit('='))[on_argument_name];
const auto argument =
    (!x3::lit(')') >> x3::raw[x3::eps][on_argument_start] >> -argument_name) > value;
const auto arguments = argument > *(x3::lit(',') >> argument) > -x3::lit(',');
const auto opening = named("'(' after the node's name", x3::lit('('));
const auto closing = named("',' or ')'", x3::lit(')'));
const auto modifier = x3::char_("%#!*")[on_modifier];
const auto node_name = x3::raw[identifier][on_node_name];
const auto header = named("a node", *modifier >> node_name) > opening > -(arguments) > closing;

class Parser {
 public:
  Parser(std::string_view text, std::string file, std::size_t nesting_limit)
      : begin_(text.data()),
        end_(text.data() + text.size()),
        at_(begin_),
        nesting_limit_(nesting_limit) {
    tree_.file = std::move(file);
    tree_.line_starts.push_back(0);
    for (const char* c = begin_; c != end_; ++c) {
      if (*c == '\n') tree_.line_starts.push_back(sink_.offset(c) + 1);
    }
  }

  SyntaxTree parse() && {
    skip_byte_order_mark();
    for (;;) {
      skip();
      if (at_ == end_) break;
      if (*at_ == ';') {
        ++at_;
      } else if (*at_ == '}') {
        close_node();
      } else {
        parse_header();
        open_or_end_node();
      }
    }
    if (!open_nodes_.empty()) {
      fail(end_, "'}' that closes " + describe_node(open_nodes_.back()));
    }
    if (tree_.nodes.empty()) {
      throw Error(ErrorId::EmptyFile,
                  {"a text without any node", "at least one node", tree_.position(0)});
    }
    return std::move(tree_);
  }

 private:
  void skip_byte_order_mark() {
    if (std::string_view(begin_, end_).starts_with("\xef\xbb\xbf")) at_ += 3;
  }

  void skip() { x3::phrase_parse(at_, end_, x3::eps, skipper); }

  void parse_header() {
    if (tree_.nodes.size() >= std::numeric_limits<std::uint32_t>::max() - 1) {
      throw Error(ErrorId::TooLarge,
                  {"more than 2^32 nodes", "", tree_.position(sink_.offset(at_))});
    }
    const auto first_argument = static_cast<std::uint32_t>(tree_.arguments.size());
    tree_.nodes.emplace_back();
    tree_.nodes.back().offset = sink_.offset(at_);
    tree_.nodes.back().first_argument = first_argument;
    const char* const start = at_;
    try {
      const auto grammar = x3::with<sink_tag>(std::ref(sink_))[header];
      if (!x3::phrase_parse(at_, end_, grammar, skipper)) fail(start, "a node");
    } catch (const x3::expectation_failure<const char*>& failure) {
      if (sink_.too_deep) {
        throw Error(ErrorId::TooDeep,
                    {"a vector inside " + std::to_string(vector_depth_limit) + " others", "",
                     tree_.position(sink_.offset(skipped(failure.where())))});
      }
      if (failure.which() == string_end_name) fail_in_string();
      fail(failure.where(), failure.which());
    }
    Node& node = tree_.nodes.back();
    node.argument_count = static_cast<std::uint32_t>(tree_.arguments.size()) - first_argument;
    node.end = static_cast<std::uint32_t>(tree_.nodes.size());
  }

  void open_or_end_node() {
    skip();
    const auto node = static_cast<std::uint32_t>(tree_.nodes.size() - 1);
    if (at_ == end_ || (*at_ != ';' && *at_ != '{')) {
      fail(at_, "';' or '{' after " + describe_node(node));
    }
    if (*at_ == '{') {
      if (open_nodes_.size() >= nesting_limit_) {
        throw Error(ErrorId::TooDeep, {"more than " + std::to_string(nesting_limit_) + " levels",
                                       "", tree_.position(tree_.nodes[node].offset)});
      }
      open_nodes_.push_back(node);
    }
    ++at_;
  }

  void close_node() {
    if (open_nodes_.empty()) fail(at_, "a node or the end of the file");
    tree_.nodes[open_nodes_.back()].end = static_cast<std::uint32_t>(tree_.nodes.size());
    open_nodes_.pop_back();
    ++at_;
  }

  std::string describe_node(std::uint32_t index) const {
    const Node& node = tree_.nodes[index];
    const SourcePosition position = tree_.position(node.offset);
    return "'" + std::string(node.name) + "' of line " + std::to_string(position.line);
  }

  const char* skipped(const char* at) const {
    x3::phrase_parse(at, end_, x3::eps, skipper);
    return at;
  }

  // What stands at `at`, shortened: up to the end of a word or a few characters.
  std::string describe_text(const char* at) const {
    if (at == end_) return "the end of the file";
    const auto is_word = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '$' || c == '.';
    };
    constexpr std::ptrdiff_t longest = 40;
    const char* last = at + 1;
    if (is_word(*at)) {
      while (last != end_ && last - at < longest && is_word(*last)) ++last;
    }
    std::string text = "'";
    for (const char* c = at; c != last; ++c) {
      const auto byte = static_cast<unsigned char>(*c);
      if (byte >= 0x20 && byte < 0x7f) {
        text += *c;
      } else {
        constexpr const char* hexadecimal = "0123456789abcdef";
        text += std::string("\\x") + hexadecimal[byte >> 4U] + hexadecimal[byte & 15U];
      }
    }
    return text + "'";
  }

  // True if what follows is cut off by the file's end rather than wrong: nothing, an unfinished
  // word or number, or an unfinished comment.
  bool is_cut_off(const char* at) const {
    const std::string_view rest(at, end_);
    if (rest.starts_with("/*")) return rest.find("*/", 2) == std::string_view::npos;
    return std::all_of(at, end_, [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '$' || c == '.' || c == '-' || c == '+' || c == '%' || c == '#' ||
             c == '!' || c == '*';
    });
  }

  [[noreturn]] void fail(const char* at, const std::string& expected) const {
    at = skipped(at);
    const ErrorId id = is_cut_off(at) ? ErrorId::TruncatedInput : ErrorId::UnexpectedText;
    throw Error(id, {describe_text(at), expected, tree_.position(sink_.offset(at))});
  }

  [[noreturn]] void fail_in_string() const {
    throw Error(ErrorId::TruncatedInput, {"a string without an end", string_end_name,
                                          tree_.position(tree_.values.back().offset - 1)});
  }

  const char* begin_;
  const char* end_;
  const char* at_;
  std::size_t nesting_limit_;
  SyntaxTree tree_;
  Sink sink_{tree_, begin_};
  std::vector<std::uint32_t> open_nodes_;
};

// The first byte that no text of this format contains; npos if there is none.
std::size_t find_binary_byte(std::string_view text) {
  const auto found = std::find_if(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r' && byte != '\f' &&
            byte != '\v') ||
           byte == 0x7f;
  });
  return found == text.end() ? std::string_view::npos
                             : static_cast<std::size_t>(found - text.begin());
}

}  // namespace

SyntaxTree parse(std::string_view text, std::string file, std::size_t nesting_limit) {
  if (text.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorId::TooLarge, {"a file of 4 GiB or more", "", SourcePosition{file}});
  }
  if (text.empty()) throw Error(ErrorId::EmptyFile, {"", "", SourcePosition{file}});
  if (text.starts_with("PK\x03\x04")) {
    throw Error(ErrorId::NotText, {"a zip archive", "text", SourcePosition{file, 1, 1}});
  }
  if (const std::size_t binary = find_binary_byte(text); binary != std::string_view::npos) {
    SyntaxTree place;
    place.file = file;
    place.line_starts.push_back(0);
    for (std::size_t i = 0; i < binary; ++i) {
      if (text[i] == '\n') place.line_starts.push_back(static_cast<std::uint32_t>(i) + 1);
    }
    throw Error(ErrorId::NotText,
                {"the byte " + std::to_string(static_cast<unsigned char>(text[binary])), "text",
                 place.position(static_cast<std::uint32_t>(binary))});
  }
  return Parser(text, std::move(file), nesting_limit).parse();
}

}  // namespace exactcsg::io::openscad
