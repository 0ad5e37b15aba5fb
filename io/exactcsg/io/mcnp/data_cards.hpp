// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Of the data cards those that say something about geometry: TRn and *TRn. [Exact]
//
// The others are passed over, those that MCNP does not have with a warning. Cards that give cell
// parameters which belong to geometry (U, FILL, LAT, TRCL), READ and the vertical format are
// refused.

#include <unordered_map>
#include <vector>

#include "exactcsg/io/mcnp/transformation.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::mcnp {

class TransformationTable {
 public:
  // THROWS Error(UnsupportedNode | DuplicateId | BadArgument | MissingValue), and what
  // transformation_of throws
  TransformationTable(const std::vector<Card>& data, std::vector<Warning>& warnings);

  // By the number that the word is. THROWS Error(UndefinedId | UnexpectedText) at it
  const Transformation& find(const Card& card, const Word& word) const;

 private:
  void add(const Card& card, const std::vector<Word>& words, bool is_in_degrees,
           std::string_view number);

  std::unordered_map<openmc::Id, Transformation> transformations_;
};

}  // namespace exactcsg::io::mcnp
