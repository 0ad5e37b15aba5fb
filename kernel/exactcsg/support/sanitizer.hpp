// SPDX-License-Identifier: Apache-2.0
#pragma once

// Whether a sanitizer watches the memory. Its shadow takes terabytes of address space, so that
// limits on that cannot be set, and its checks take time.

namespace exactcsg {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool has_shadow_memory = true;
#else
inline constexpr bool has_shadow_memory = false;
#endif

}  // namespace exactcsg
