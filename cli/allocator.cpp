// SPDX-License-Identifier: GPL-3.0-or-later
// How jemalloc, which the command is linked with, is set up. Memory that stays unused is given back
// within five seconds: pages given back sooner are soon asked for again, and the first touch of a
// page is dear. Huge pages are not asked for: where the system does not give them unasked, clearing
// what is not used of them costs more than they save. MALLOC_CONF in the environment overrides it.
#include "cli/allocator.hpp"

#include <sys/prctl.h>

extern "C" {
extern const char* malloc_conf;
const char* malloc_conf = "thp:default,dirty_decay_ms:5000,muzzy_decay_ms:0";
}

namespace exactcsg::cli {

namespace {

void without_huge_pages() { prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0); }

// Run before the libraries are set up, which allocate memory then.
[[gnu::section(".preinit_array"), gnu::used]] void (*const at_start)() = without_huge_pages;

}  // namespace

void use_huge_pages() { prctl(PR_SET_THP_DISABLE, 0, 0, 0, 0); }

}  // namespace exactcsg::cli
