// SPDX-License-Identifier: Apache-2.0
#pragma once

// The version of the library and of the command; CMakeLists.txt reads it from here.

#include <string_view>

namespace exactcsg {

inline constexpr std::string_view version = "0.1.0";

}  // namespace exactcsg
