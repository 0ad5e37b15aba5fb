// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The command refuses a model that needs more memory than it may use, before the machine swaps or
// the kernel kills something.

#include <cstddef>

namespace exactcsg::cli {

// From now on, allocations that would take the process beyond the limit throw std::bad_alloc, also
// those that GMP makes (which would abort by itself). 0: no limit, but GMP throws all the same.
void limit_memory(std::size_t bytes);

}  // namespace exactcsg::cli
