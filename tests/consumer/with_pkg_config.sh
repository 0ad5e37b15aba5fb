#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# with_pkg_config.sh COMPILER PREFIX LIBDIR SOURCE PROGRAM: builds and runs the kernel's consumer by
# pkg-config instead of CMake.
set -eu
export PKG_CONFIG_PATH="$2/$3/pkgconfig"
# shellcheck disable=SC2046
"$1" $(pkg-config --cflags exactcsg) "$4" -o "$5" $(pkg-config --libs exactcsg)
"$5"
