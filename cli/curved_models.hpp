// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What interference and contains answer where a model is an OpenMC geometry.

#include <string>

#include "cli/two_models.hpp"

namespace exactcsg::cli {

// "geometry.xml", or "geometry.xml#7" for its cell 7.
bool names_geometry(const std::string& name);

// Yes if it is proved, or undecided within models.tolerance.
Answer curved_interference(Context& context, const TwoModels& models);
Answer curved_contains(Context& context, const TwoModels& models);

}  // namespace exactcsg::cli
