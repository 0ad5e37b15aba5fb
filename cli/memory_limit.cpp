// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/memory_limit.hpp"

#include <gmp.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <new>

#include "exactcsg/support/sanitizer.hpp"

namespace exactcsg::cli {

namespace {

// GMP calls these from C; Debian builds it with unwind tables, so an exception passes through. What
// the interrupted function held is lost, which does not matter to a command that is about to end.
void* allocate(std::size_t size) {
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* reallocate(void* memory, std::size_t, std::size_t size) {
  if (void* const moved = std::realloc(memory, size)) return moved;
  throw std::bad_alloc();
}
void release(void* memory, std::size_t) { std::free(memory); }

// Only the soft limit: oracles are processes of their own and may raise it again.
void set_soft_limit(decltype(RLIMIT_DATA) what, std::size_t bytes) {
  rlimit limit{};
  if (getrlimit(what, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, bytes);
  (void)setrlimit(what, &limit);
}

}  // namespace

void limit_memory(std::size_t bytes) {
  mp_set_memory_functions(allocate, reallocate, release);
  if (bytes == 0 || has_shadow_memory) return;
  // Data: what is really used. Address space: a second net where the system does not count data;
  // malloc reserves address space for every thread, hence the slack.
  set_soft_limit(RLIMIT_DATA, bytes);
  set_soft_limit(RLIMIT_AS, bytes + (std::size_t{8} << 30U));
}

}  // namespace exactcsg::cli
