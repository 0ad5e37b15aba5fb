// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "exactcsg/io/region_expression.hpp"

namespace exactcsg::io::openmc {

namespace {

class RegionLanguage {
 public:
  using Tree = Region;
  static constexpr std::string_view blanks = " \t\r\n";
  static constexpr char complement = '~';
  static constexpr char alternative = '|';
  static constexpr std::string_view operand_names = "a surface or a parenthesis";
  static constexpr std::string_view end_name = "the end";

  RegionLanguage(const Field& field, const std::function<std::optional<Index>(Id)>& surface_of)
      : field_(field), surface_of_(surface_of) {}

  [[noreturn]] void fail(std::string found, std::string expected, std::size_t at) const {
    field_.fail(ErrorId::UnexpectedText, std::move(found), std::move(expected), at);
  }

  static Region complement_of(Region region) {
    if (!region.is_primitive()) return csg::complement(std::move(region));
    SurfaceSide side = region.primitive();
    side.is_positive = !side.is_positive;
    return Region::primitive(side);
  }

  Region operand(std::string_view text, std::size_t& at, bool /*follows_complement*/) const {
    const std::size_t begin = at;
    const bool is_negative = text[at] == '-';
    if (is_negative || text[at] == '+') ++at;
    const std::size_t digits = at;
    at = std::min(text.find_first_not_of("0123456789", digits), text.size());
    if (at == digits) {
      fail(fmt::format("'{}'", text.substr(begin, digits - begin + 1)),
           "the number of a surface, an operator or a parenthesis", begin);
    }
    constexpr std::size_t most_digits = 9;
    const std::string number(text.substr(digits, at - digits));
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

 private:
  const Field& field_;
  const std::function<std::optional<Index>(Id)>& surface_of_;
};

}  // namespace

Region parse_region(const Field& text, const std::function<std::optional<Index>(Id)>& surface_of) {
  if (text.stripped().empty()) return Region::full();
  const RegionLanguage language(text, surface_of);
  return RegionExpression(language, text.text()).parse();
}

}  // namespace exactcsg::io::openmc
