# SPDX-License-Identifier: GPL-3.0-or-later
# Options, warnings and the flags that exact arithmetic depends on.
option(EXACTCSG_BUILD_TESTS "build the tests" ${PROJECT_IS_TOP_LEVEL})
option(EXACTCSG_BUILD_BENCHMARKS "build the benchmarks" OFF)
option(EXACTCSG_BUILD_FUZZERS "build the libFuzzer targets (clang)" OFF)
option(EXACTCSG_KERNEL_ONLY "build the kernel alone: no readers, oracles or command" OFF)
option(EXACTCSG_WARNINGS_AS_ERRORS "treat warnings in our code as errors" ${PROJECT_IS_TOP_LEVEL})
set(EXACTCSG_SANITIZE "" CACHE STRING "address, undefined or thread: build with that sanitizer")

# Compiling again what was compiled before costs nothing where ccache is installed.
find_program(EXACTCSG_CCACHE ccache)
if(EXACTCSG_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${EXACTCSG_CCACHE})
endif()

# Flags for every target of ours. The filters' error bounds assume that no operation is contracted
# or reordered (docs/exactness.md).
# -Wrestrict of GCC 12 warns of innocent std::string concatenations (GCC bug 105329).
add_library(exactcsg_options INTERFACE)
target_compile_options(exactcsg_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<BOOL:${EXACTCSG_WARNINGS_AS_ERRORS}>:-Werror> -ffp-contract=off -frounding-math)
if(EXACTCSG_SANITIZE)
  # For all targets, also those of the tests' libraries: a mix of instrumented and plain code of ours
  # gives false reports. The presets do not treat warnings as errors: with a sanitizer GCC 12 takes
  # innocent values of the standard library for uninitialized.
  add_compile_options(-fsanitize=${EXACTCSG_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${EXACTCSG_SANITIZE})
endif()
if(EXACTCSG_BUILD_FUZZERS)
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all)
  add_link_options(-fsanitize=address,undefined)
endif()
