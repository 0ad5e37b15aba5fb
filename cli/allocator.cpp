// SPDX-License-Identifier: GPL-3.0-or-later
// How jemalloc, which the command is linked with, is set up. Huge pages: exact numbers are many
// small blocks all over the memory, and looking up their pages took a fifth of the time. Nothing is
// given back before the end: the command ends soon. MALLOC_CONF in the environment overrides this.

extern "C" {
extern const char* malloc_conf;
const char* malloc_conf = "thp:always,metadata_thp:always,dirty_decay_ms:-1,muzzy_decay_ms:-1";
}
