// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Regions as OpenMC writes them: "-1 (2 | ~(3 -4))". [Exact]
//
// From the strongest: parentheses, ~ (complement), a blank or nothing (intersection), | (union).
// LAW region.1  the tree is that of the documentation's meaning; complements of single surfaces are
//               their other sides, and parentheses leave no trace.
// LAW region.2  no text is too deep: nothing here recurses.
// No text but blanks is the whole of space.

#include <functional>

#include "exactcsg/io/openmc/located_xml.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::openmc {

// surface_of(id) -> its index, nullopt if there is none.
// THROWS Error(UnexpectedText | UndefinedId | NumberOutOfRange) at the place in the text.
Region parse_region(const Field& text, const std::function<std::optional<Index>(Id)>& surface_of);

}  // namespace exactcsg::io::openmc
