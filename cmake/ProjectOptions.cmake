# SPDX-License-Identifier: GPL-3.0-or-later
# Options, warnings and the flags that exact arithmetic depends on.
option(EXACTCSG_BUILD_TESTS "build the tests" ${PROJECT_IS_TOP_LEVEL})
option(EXACTCSG_BUILD_BENCHMARKS "build the benchmarks" ${PROJECT_IS_TOP_LEVEL})
option(EXACTCSG_WARNINGS_AS_ERRORS "treat warnings in our code as errors" ${PROJECT_IS_TOP_LEVEL})
set(EXACTCSG_SANITIZE "" CACHE STRING "address, undefined or thread: build with that sanitizer")

# Flags for every target of ours. The filters' error bounds assume that no operation is contracted
# or reordered (docs/exactness.md).
add_library(exactcsg_options INTERFACE)
target_compile_options(exactcsg_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion
  $<$<BOOL:${EXACTCSG_WARNINGS_AS_ERRORS}>:-Werror> -ffp-contract=off -frounding-math)
if(EXACTCSG_SANITIZE)
  target_compile_options(exactcsg_options INTERFACE -fsanitize=${EXACTCSG_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(exactcsg_options INTERFACE -fsanitize=${EXACTCSG_SANITIZE})
endif()
