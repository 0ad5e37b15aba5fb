// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/memory_limit.hpp"

#include <sys/resource.h>

#include <algorithm>

#include "exactcsg/support/sanitizer.hpp"

namespace exactcsg::cli {

namespace {

// Only the soft limit: oracles are processes of their own and may raise it again.
void set_soft_limit(decltype(RLIMIT_DATA) what, std::size_t bytes) {
  rlimit limit{};
  if (getrlimit(what, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, bytes);
  (void)setrlimit(what, &limit);
}

}  // namespace

void limit_memory(std::size_t bytes) {
  if (bytes == 0 || has_shadow_memory) return;
  // Data: what is really used. Address space: a second net where the system does not count data;
  // malloc reserves address space for every thread, hence the slack.
  set_soft_limit(RLIMIT_DATA, bytes);
  set_soft_limit(RLIMIT_AS, bytes + (std::size_t{8} << 30U));
}

}  // namespace exactcsg::cli
