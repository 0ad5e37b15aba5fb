// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Limits of time in tests are loose, but made for code without a sanitizer.

#include "exactcsg/support/sanitizer.hpp"

namespace exactcsg::test {

inline constexpr double sanitizer_slowdown = has_shadow_memory ? 10 : 1;

}  // namespace exactcsg::test
