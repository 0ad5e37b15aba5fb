// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Limits of time in tests are loose, but made for code without a sanitizer.

namespace exactcsg::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr double sanitizer_slowdown = 10;
#else
inline constexpr double sanitizer_slowdown = 1;
#endif

}  // namespace exactcsg::test
