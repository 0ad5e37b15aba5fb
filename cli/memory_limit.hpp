// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The command refuses a model that needs more memory than it may use, before the machine swaps or
// the kernel kills something.

#include <cstddef>

namespace exactcsg::cli {

// From now on, allocations that would take the process beyond the limit throw std::bad_alloc, also
// those that GMP makes (number_memory.cpp). 0: no limit.
void limit_memory(std::size_t bytes);

}  // namespace exactcsg::cli
