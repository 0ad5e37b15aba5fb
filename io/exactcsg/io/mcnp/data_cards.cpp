// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mcnp/data_cards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace exactcsg::io::mcnp {

namespace {

// Names without numbers and particles.
constexpr std::string_view known_cards =
    " m mt mx mpn mgopt mode imp vol area pwt ext vect fcl wwn wwe wwp wwg wwge wwt esplt tsplt ext"
    " sdef si sp sb ds sc ssw ssr kcode ksrc hsrc kopts ksen burn source srcdx f fc e t c fq fm de "
    "df"
    " em tm cm cf sf fs sd fu tf dd dxt dxc ft fmesh spdtl phys tmp thtme cut elpt nps ctme notrn"
    " nonu totnu awtab xs void prdmp print lost dbcn files idum rdum histp rand talnp mplot ptrac"
    " pert kpert mesh tmesh endmd rmesh cmesh smesh cora corb corc ergsh mshmf fsrc uran pikmt drxs"
    " tropt unc cosy cosyp bfld bflcl act cgm lca lcb lcc lea leb fmult dm dawwg embed embee embeb"
    " embem embtb embtm embde embdf embed stop zaid spabi fic fip fir tally pd otfdb sens seed ";

bool is_known(std::string_view name) {
  return !name.empty() && known_cards.find(fmt::format(" {} ", name)) != std::string_view::npos;
}

bool is_refused(std::string_view name) {
  return name == "u" || name == "fill" || name == "lat" || name == "trcl" || name == "read";
}

}  // namespace

TransformationTable::TransformationTable(const std::vector<Card>& data,
                                         std::vector<Warning>& warnings) {
  for (const Card& card : data) {
    const std::vector<Word> words = words_of(card, 0, card.text().size());
    if (words.empty()) continue;
    const std::string_view word = words.front().text;
    if (word.starts_with('#')) {
      card.fail(ErrorId::UnsupportedNode, "the vertical format (#)", "cards side by side");
    }
    const bool has_star = word.starts_with('*');
    const std::size_t begin = has_star || word.starts_with('+') ? 1 : 0;
    const std::size_t letters =
        std::min(word.find_first_not_of("abcdefghijklmnopqrstuvwxyz", begin), word.size());
    const std::string_view name = word.substr(begin, letters - begin);
    if (name == "tr") {
      add(card, words, has_star, word.substr(letters));
    } else if (is_refused(name)) {
      card.fail(ErrorId::UnsupportedNode, fmt::format("'{}' as a data card", name),
                name == "read" ? "the text of the other file" : "the parameter on the cell cards");
    } else if (!is_known(name)) {
      warnings.push_back({fmt::format("'{:.40}' is not read", word), card.position()});
    }
  }
}

void TransformationTable::add(const Card& card, const std::vector<Word>& words, bool is_in_degrees,
                              std::string_view number) {
  const openmc::Id id =
      number.empty()
          ? 0
          : integer_of(card, {std::string(number),
                              words.front().at + words.front().text.size() - number.size()});
  if (id <= 0)
    card.fail(ErrorId::BadArgument, "a transformation without a number", "tr1, tr2, ...");
  const std::vector<Entry> entries = entries_of(card, words, 1);
  if (entries.empty()) {
    card.fail(ErrorId::MissingValue, "an empty transformation", "a displacement, a matrix");
  }
  if (!transformations_.emplace(id, transformation_of(card, entries, is_in_degrees)).second) {
    card.fail(ErrorId::DuplicateId, fmt::format("a second transformation {}", id),
              "another number");
  }
}

const Transformation& TransformationTable::find(const Card& card, const Word& word) const {
  const openmc::Id id = integer_of(card, word);
  const auto found = transformations_.find(id);
  if (found == transformations_.end()) {
    card.fail(ErrorId::UndefinedId, fmt::format("transformation {}", id), "the number of a TR card",
              word.at);
  }
  return found->second;
}

}  // namespace exactcsg::io::mcnp
