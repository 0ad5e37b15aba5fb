// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mcnp/cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "exactcsg/io/region_expression.hpp"

namespace exactcsg::io::mcnp {

namespace {

constexpr std::size_t most_elements = 10'000'000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return c >= 'a' && c <= 'z'; }

// ---- geometry
// ------------------------------------------------------------------------------------

class GeometryLanguage {
 public:
  using Tree = Geometry;
  static constexpr std::string_view blanks = " ";
  static constexpr char complement = '#';
  static constexpr char alternative = ':';
  static constexpr std::string_view operand_names = "a surface, # or a parenthesis";
  static constexpr std::string_view end_name = "the end of the geometry";

  explicit GeometryLanguage(const Card& card) : card_(card) {}

  [[noreturn]] void fail(std::string found, std::string expected, std::size_t at) const {
    card_.fail(ErrorId::UnexpectedText, std::move(found), std::move(expected), at);
  }

  static Geometry complement_of(Geometry geometry) { return csg::complement(std::move(geometry)); }

  Geometry operand(std::string_view text, std::size_t& at, bool follows_complement) const {
    Operand result;
    result.at = at;
    result.is_cell = follows_complement;
    const bool has_sign = text[at] == '-' || text[at] == '+';
    result.is_positive = text[at] != '-';
    if (has_sign) ++at;
    const std::optional<openmc::Id> number = digits(text, at);
    const bool ends_well = at == text.size() ||
                           std::string_view(" ()#:").find(text[at]) != std::string_view::npos ||
                           (text[at] == '.' && !result.is_cell);
    if (!number || !ends_well || (result.is_cell && has_sign)) {
      fail(fmt::format("'{}'", text.substr(result.at, at - result.at + 1)),
           result.is_cell ? "the number of a cell behind #, or a parenthesis"
                          : "the number of a surface, ':', '#' or a parenthesis",
           result.at);
    }
    result.number = *number;
    if (at < text.size() && text[at] == '.') {
      const std::size_t point = at++;
      const auto facet = digits(text, at);
      if (!facet || *facet == 0 || *facet > 8) {
        fail(fmt::format("'{}'", text.substr(point, at - point)), "the number of a facet", point);
      }
      result.facet = static_cast<unsigned>(*facet);
    }
    return Geometry::primitive(result);
  }

 private:
  // As a number; nullopt if there are none.
  std::optional<openmc::Id> digits(std::string_view text, std::size_t& at) const {
    constexpr std::size_t most_digits = 9;
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    if (at == begin) return std::nullopt;
    if (at - begin > most_digits) {
      card_.fail(ErrorId::NumberOutOfRange, fmt::format("'{:.40}'", text.substr(begin, at - begin)),
                 "at most nine digits", begin);
    }
    return std::stoi(std::string(text.substr(begin, at - begin)));
  }

  const Card& card_;
};

// From offset `from` of the card to `to`.
Geometry geometry_of(const Card& card, std::size_t from, std::size_t to) {
  const GeometryLanguage language(card);
  return RegionExpression(language, card.text().substr(0, to), from).parse();
}

// ---- parameters
// ----------------------------------------------------------------------------------

// Those that say nothing about geometry, without what follows a colon.
constexpr std::array<std::string_view, 18> passed_over{
    "imp", "vol",  "pwt",  "ext", "fcl",   "wwn", "dxc",  "nonu", "pd",
    "tmp", "elpt", "cosy", "unc", "bflcl", "rho", "area", "wwe",  "spabi"};

struct Parameter {
  std::string name;  // without star and particles
  bool has_star = false;
  std::size_t at = 0;
  std::vector<Word> values;
};

bool is_keyword(const Word& word) {
  const std::string_view text = word.text;
  if (text == "r" || text == "i" || text == "m" || text == "j" || text == "log" || text == "ilog") {
    return false;
  }
  return is_letter(text[0]) || (text[0] == '*' && text.size() > 1 && is_letter(text[1]));
}

std::vector<Parameter> parameters_of(const Card& card, std::size_t from) {
  std::vector<Parameter> parameters;
  for (Word& word : words_of(card, from, card.text().size())) {
    if (is_keyword(word)) {
      Parameter parameter;
      parameter.has_star = word.text[0] == '*';
      const std::string name = word.text.substr(parameter.has_star ? 1 : 0);
      parameter.name = name.substr(0, name.find(':'));
      parameter.at = word.at;
      parameters.push_back(std::move(parameter));
    } else if (parameters.empty()) {
      card.fail(ErrorId::UnexpectedText, fmt::format("'{:.40}'", word.text), "a parameter",
                word.at);
    } else {
      parameters.back().values.push_back(std::move(word));
    }
  }
  return parameters;
}

openmc::Id material_of(const Card& card, std::int32_t number, std::size_t at) {
  if (number >= 0) return number;
  card.fail(ErrorId::BadArgument, fmt::format("the material {}", number), "one of at least 0", at);
}

class ParameterReader {
 public:
  ParameterReader(const Card& card, const Transformations& transformations,
                  std::vector<Warning>& warnings)
      : card_(card), transformations_(transformations), warnings_(warnings) {}

  void read(const Parameter& parameter, CellCard& cell) {
    parameter_ = &parameter;
    const std::string& name = parameter.name;
    if (is_about_geometry(name) && !seen_.insert(name).second) {
      fail(ErrorId::UnexpectedText, fmt::format("a second '{}'", name), "each parameter once",
           parameter.at);
    }
    if (parameter.has_star && name != "trcl" && name != "fill") {
      fail(ErrorId::UnknownNode, fmt::format("'*{:.40}'", name), "*trcl or *fill", parameter.at);
    }
    if (name == "u") {
      // Of -n only: its cells are not cut by what they fill. That is no other geometry.
      cell.universe = std::abs(only_integer());
    } else if (name == "lat") {
      cell.lattice = only_integer();
      if (cell.lattice != 1 && cell.lattice != 2) {
        fail(ErrorId::BadArgument, fmt::format("lat = {}", cell.lattice), "1 or 2",
             parameter.values.front().at);
      }
    } else if (name == "trcl") {
      cell.placement = read_placement();
    } else if (name == "fill") {
      cell.fill = read_fill();
    } else if (name == "mat") {
      cell.material = material_of(card_, only_integer(), values().front().at);
    } else if (!is_passed_over(name)) {
      warnings_.push_back(
          {fmt::format("'{:.40}' is not read", name), card_.position(parameter.at)});
    }
  }

 private:
  static bool is_about_geometry(std::string_view name) {
    return name == "u" || name == "lat" || name == "trcl" || name == "fill" || name == "mat";
  }
  // "wwn1", "tmp2": the number does not matter.
  static bool is_passed_over(std::string_view name) {
    name = name.substr(0, name.find_last_not_of("0123456789") + 1);
    return std::find(passed_over.begin(), passed_over.end(), name) != passed_over.end();
  }

  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected,
                         std::size_t at) const {
    card_.fail(id, std::move(found), std::move(expected), at);
  }

  const std::vector<Word>& values() const { return parameter_->values; }

  void expect_values() const {
    if (values().empty()) {
      fail(ErrorId::MissingValue, fmt::format("'{}' without a value", parameter_->name), "a value",
           parameter_->at);
    }
  }

  std::int32_t only_integer() const {
    expect_values();
    if (values().size() > 1) {
      fail(ErrorId::WrongCount, fmt::format("{} values of '{}'", values().size(), parameter_->name),
           "one", values()[1].at);
    }
    return integer_of(card_, values().front());
  }

  // What is in parentheses from values[at] on; `at` is then behind them.
  Transformation in_parentheses(std::size_t& at) const {
    const std::size_t open = at++;
    const std::size_t begin = at;
    EntryList list(card_, 100);
    for (; at < values().size() && values()[at].text != ")"; ++at) list.add(values()[at]);
    if (at == values().size()) {
      fail(ErrorId::UnexpectedText, "a parenthesis that is not closed", "')'", values()[open].at);
    }
    const std::vector<Entry> entries = list.finish();
    if (entries.empty()) {
      fail(ErrorId::MissingValue, "an empty transformation", "a number of a TR card, or a list",
           values()[open].at);
    }
    ++at;
    if (entries.size() == 1) return transformations_(card_, values()[begin]);
    return transformation_of(card_, entries, parameter_->has_star);
  }

  Transformation read_placement() const {
    expect_values();
    std::size_t at = 0;
    Transformation result =
        values().front().text == "(" ? in_parentheses(at) : transformations_(card_, values()[at++]);
    if (at < values().size()) {
      fail(ErrorId::UnexpectedText, fmt::format("'{:.40}'", values()[at].text),
           "one number of a TR card, or a list in parentheses", values()[at].at);
    }
    return result;
  }

  Fill read_fill() const {
    expect_values();
    Fill fill;
    fill.card = &card_;
    fill.at = parameter_->at;
    std::size_t at = 0;
    const bool has_ranges = values().front().text.find(':') != std::string::npos ||
                            (values().size() > 1 && values()[1].text.starts_with(':'));
    if (has_ranges) fill.ranges = read_ranges(at);
    read_elements(fill, at);
    return fill;
  }

  // "-1:1 0:2 0:0", blanks anywhere; `at` is then behind them.
  std::array<std::array<std::int64_t, 2>, 3> read_ranges(std::size_t& at) const {
    std::array<std::array<std::int64_t, 2>, 3> ranges{};
    std::vector<Word> parts;
    const auto next_part = [&]() -> Word {
      while (parts.empty()) {
        if (at == values().size()) {
          fail(ErrorId::MissingValue, "fill with less than three ranges", "i1:i2 j1:j2 k1:k2",
               parameter_->at);
        }
        const Word& word = values()[at++];
        std::size_t begin = 0;
        for (std::size_t i = 0; i <= word.text.size(); ++i) {
          if (i < word.text.size() && word.text[i] != ':') continue;
          if (i > begin) parts.push_back({word.text.substr(begin, i - begin), word.at + begin});
          if (i < word.text.size()) parts.push_back({":", word.at + i});
          begin = i + 1;
        }
      }
      Word part = parts.front();
      parts.erase(parts.begin());
      return part;
    };
    for (auto& range : ranges) {
      const Word first = next_part();
      range[0] = integer_of(card_, first);
      const Word colon = next_part();
      if (colon.text != ":") {
        fail(ErrorId::UnexpectedText, fmt::format("'{:.40}'", colon.text), "':'", colon.at);
      }
      range[1] = integer_of(card_, next_part());
      if (range[1] < range[0]) {
        fail(ErrorId::BadArgument, fmt::format("the range {}:{}", range[0], range[1]),
             "the lower bound first", first.at);
      }
    }
    if (!parts.empty()) {
      fail(ErrorId::UnexpectedText, fmt::format("'{:.40}'", parts.front().text), "a universe",
           parts.front().at);
    }
    return ranges;
  }

  openmc::Id universe_of(const Entry& entry) const {
    constexpr int greatest = 99'999'999;
    if (!entry.value || entry.value->get_den() != 1 || *entry.value < 0 ||
        *entry.value > greatest) {
      fail(ErrorId::BadArgument, fmt::format("the universe '{:.40}'", entry.word.text),
           "a whole number of at least 0", entry.word.at);
    }
    return static_cast<openmc::Id>(entry.value->get_num().get_si());
  }

  std::size_t wanted_elements(const Fill& fill) const {
    std::size_t wanted = 1;
    if (!fill.ranges) return wanted;
    for (const auto& range : *fill.ranges) {
      const auto size = static_cast<std::size_t>(range[1] - range[0] + 1);
      if (size > most_elements / wanted) {
        fail(ErrorId::TooLarge, "an array of more universes",
             fmt::format("at most {}", most_elements), fill.at);
      }
      wanted *= size;
    }
    return wanted;
  }

  void read_elements(Fill& fill, std::size_t at) const {
    const std::size_t wanted = wanted_elements(fill);
    EntryList list(card_, most_elements);
    const auto flush = [&] {
      for (const Entry& entry : list.finish()) {
        fill.elements.push_back({universe_of(entry), std::nullopt, entry.word.at});
      }
    };
    while (at < values().size()) {
      const Word& word = values()[at];
      if (word.text != "(") {
        if (word.text.ends_with('r') && list.size() == 0 && !fill.elements.empty()) {
          fail(ErrorId::UnsupportedNode, "a repetition behind a transformation",
               "the universe and its transformation again", word.at);
        }
        list.add(word);
        ++at;
        continue;
      }
      flush();
      if (fill.elements.empty()) {
        fail(ErrorId::UnexpectedText, "'('", "a universe before its transformation", word.at);
      }
      fill.elements.back().transformation = in_parentheses(at);
    }
    flush();
    if (fill.elements.size() != wanted) {
      fail(ErrorId::WrongCount, fmt::format("{} universes", fill.elements.size()),
           fmt::format("{}", wanted),
           fill.elements.size() > wanted ? fill.elements[wanted].at : fill.at);
    }
  }

  const Card& card_;
  const Transformations& transformations_;
  std::vector<Warning>& warnings_;
  const Parameter* parameter_ = nullptr;
  std::set<std::string> seen_;
};

// ---- cards
// ---------------------------------------------------------------------------------------

class CellReader {
 public:
  CellReader(const std::vector<Card>& cards, const Transformations& transformations,
             std::vector<Warning>& warnings)
      : cards_(cards), transformations_(transformations), warnings_(warnings) {}

  std::vector<CellCard> read() {
    for (const Card& card : cards_) add_number(card);
    for (std::size_t i = 0; i < cards_.size(); ++i) done_.push_back(read_cell(i));
    return std::move(done_);
  }

 private:
  struct Head {
    openmc::Id number = 0;
    std::size_t end = 0;  // behind the number
  };

  void add_number(const Card& card) {
    Head head;
    const std::string_view text = card.text();
    const std::vector<Word> first = words_of(card, 0, std::min<std::size_t>(text.size(), 40));
    if (first.empty()) card.fail(ErrorId::MissingValue, "an empty card", "a cell");
    if (is_letter(first[0].text[0])) {
      card.fail(first[0].text == "read" ? ErrorId::UnsupportedNode : ErrorId::UnexpectedText,
                fmt::format("'{:.40}'", first[0].text), "a cell's number", first[0].at);
    }
    head.number = integer_of(card, first[0]);
    constexpr openmc::Id greatest = 99'999'999;
    if (head.number <= 0 || head.number > greatest) {
      card.fail(ErrorId::BadArgument, fmt::format("the cell's number {}", head.number),
                "one from 1 to 99999999", first[0].at);
    }
    if (!indices_.emplace(head.number, heads_.size()).second) {
      card.fail(ErrorId::DuplicateId, fmt::format("a second cell {}", head.number),
                "another number", first[0].at);
    }
    head.end = first[0].at + first[0].text.size();
    heads_.push_back(std::move(head));
  }

  // The parameters begin at the first letter, or star before one.
  static std::size_t begin_of_parameters(std::string_view text, std::size_t from) {
    for (std::size_t at = from; at < text.size(); ++at) {
      if (is_letter(text[at]) || text[at] == '*') {
        const bool is_exponent = at > from && (text[at] == 'e' || text[at] == 'd') &&
                                 (is_digit(text[at - 1]) || text[at - 1] == '.');
        if (!is_exponent) return at;
      }
    }
    return text.size();
  }

  // "like n but", from the end of the cell's number: n and what follows.
  bool read_like(const Card& card, CellCard& cell, std::size_t& parameters) {
    const std::vector<Word> words =
        words_of(card, parameters, std::min(card.text().size(), parameters + 80));
    if (words.empty() || words[0].text != "like") return false;
    if (words.size() < 3 || words[2].text != "but") {
      card.fail(ErrorId::UnexpectedText, "'like'", "like n but ...", words[0].at);
    }
    const openmc::Id other = integer_of(card, words[1]);
    const auto found = indices_.find(other);
    if (found == indices_.end()) {
      card.fail(ErrorId::UndefinedId, fmt::format("cell {}", other), "the number of a cell",
                words[1].at);
    }
    if (found->second >= done_.size()) {
      card.fail(ErrorId::UnsupportedNode, fmt::format("like {}, which comes later", other),
                "a cell that comes earlier", words[1].at);
    }
    const openmc::Id number = cell.number;
    cell = done_[found->second];
    cell.number = number;
    cell.card = &card;
    parameters = words[2].at + words[2].text.size();
    return true;
  }

  CellCard read_cell(std::size_t index) {
    const Card& card = cards_[index];
    CellCard cell;
    cell.card = cell.geometry_card = &card;
    cell.number = heads_[index].number;
    std::size_t parameters = heads_[index].end;
    if (!read_like(card, cell, parameters)) read_contents(card, cell, parameters);
    ParameterReader reader(card, transformations_, warnings_);
    for (const Parameter& parameter : parameters_of(card, parameters)) reader.read(parameter, cell);
    if (cell.lattice == 0 && cell.fill && cell.fill->ranges) {
      card.fail(ErrorId::BadArgument, "an array of universes in a cell without lat",
                "lat = 1 or 2, or one universe", cell.fill->card == &card ? cell.fill->at : 0);
    }
    return cell;
  }

  // Material, density and geometry; `at` is then where the parameters begin.
  void read_contents(const Card& card, CellCard& cell, std::size_t& at) {
    const std::string_view text = card.text();
    const std::size_t end = begin_of_parameters(text, at);
    const std::vector<Word> words = words_of(card, at, end);
    if (words.empty()) {
      card.fail(ErrorId::MissingValue, "a cell without a material",
                "0, or a material and a density", at);
    }
    cell.material = material_of(card, integer_of(card, words[0]), words[0].at);
    const std::size_t contents = cell.material == 0 ? 1 : 2;
    if (words.size() < contents) {
      card.fail(ErrorId::MissingValue, "a material without a density", "a number", words[0].at);
    }
    if (contents == 2) static_cast<void>(number_of(card, words[1]));
    const Word& last = words[contents - 1];
    cell.geometry = geometry_of(card, last.at + last.text.size(), end);
    at = end;
  }

  const std::vector<Card>& cards_;
  const Transformations& transformations_;
  std::vector<Warning>& warnings_;
  std::vector<Head> heads_;
  std::unordered_map<openmc::Id, std::size_t> indices_;
  std::vector<CellCard> done_;
};

}  // namespace

std::vector<CellCard> read_cell_cards(const std::vector<Card>& cards,
                                      const Transformations& transformations,
                                      std::vector<Warning>& warnings) {
  return CellReader(cards, transformations, warnings).read();
}

}  // namespace exactcsg::io::mcnp
