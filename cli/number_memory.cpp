// SPDX-License-Identifier: GPL-3.0-or-later
// The memory of GMP's numbers in the command: a lack of it throws std::bad_alloc, where GMP would
// abort by itself; and each thread keeps a few small blocks for the next numbers, since most live
// only shortly.
#include <gmp.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>

#include "exactcsg/support/sanitizer.hpp"

namespace exactcsg::cli {

namespace {

// GMP calls these from C; Debian builds it with unwind tables, so an exception passes through. What
// the interrupted function held is lost, which does not matter to a command that is about to end.

void* from_heap(std::size_t size) {
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

// Blocks of up to 128 bytes come in multiples of 16: a number that grows by one limb often stays.
constexpr std::size_t granule = 16;
constexpr std::size_t largest_class = has_shadow_memory ? 0 : 8;
constexpr std::size_t class_of(std::size_t size) { return (size + granule - 1) / granule; }

// Few, so that blocks which are allocated together still lie together.
constexpr std::size_t most_kept = 64;

struct KeptBlocks {
  std::size_t count = 0;
  std::array<void*, most_kept> blocks{};
};
constinit thread_local std::array<KeptBlocks, largest_class + 1> kept_blocks{};

void* allocate(std::size_t size) {
  const std::size_t size_class = class_of(size);
  if (size_class > largest_class) return from_heap(size);
  KeptBlocks& kept = kept_blocks[size_class];
  return kept.count == 0 ? from_heap(size_class * granule) : kept.blocks[--kept.count];
}

void release(void* memory, std::size_t size) {
  const std::size_t size_class = class_of(size);
  if (size_class > largest_class || kept_blocks[size_class].count == most_kept) {
    std::free(memory);
  } else {
    KeptBlocks& kept = kept_blocks[size_class];
    kept.blocks[kept.count++] = memory;
  }
}

void* reallocate(void* memory, std::size_t old_size, std::size_t size) {
  const std::size_t old_class = class_of(old_size);
  const std::size_t new_class = class_of(size);
  if (std::min(old_class, new_class) > largest_class) {
    if (void* const moved = std::realloc(memory, size)) return moved;
    throw std::bad_alloc();
  }
  if (old_class == new_class) return memory;
  void* const moved = allocate(size);
  std::memcpy(moved, memory, std::min(old_size, size));
  release(memory, old_size);
  return moved;
}

void manage() { mp_set_memory_functions(allocate, reallocate, release); }

// Before any number is made: blocks of GMP's own would be smaller than their class.
[[gnu::section(".preinit_array"), gnu::used]] void (*const at_start)() = manage;

}  // namespace

}  // namespace exactcsg::cli
