# SPDX-License-Identifier: GPL-3.0-or-later
# The libraries that the project stands on, found once for all folders. The same packages by their
# Debian names: cmake/debian-packages.txt. What an installed exactcsg needs: exactcsgConfig.cmake.in.
find_package(PkgConfig REQUIRED)
# pc_: plain GMP and MPFR would clash with the variables of CGAL's own search.
pkg_check_modules(pc_gmpxx REQUIRED IMPORTED_TARGET gmpxx)
pkg_check_modules(pc_mpfr REQUIRED IMPORTED_TARGET mpfr)
find_package(TBB REQUIRED)
pkg_check_modules(pc_nettle REQUIRED IMPORTED_TARGET nettle)
find_package(Boost REQUIRED)
find_package(Threads REQUIRED)

if(EXACTCSG_KERNEL_ONLY)
  return()
endif()

set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL REQUIRED)
pkg_check_modules(pc_polyclipping REQUIRED IMPORTED_TARGET polyclipping)
pkg_check_modules(pc_text REQUIRED IMPORTED_TARGET fontconfig freetype2 harfbuzz)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(pugixml REQUIRED)
find_package(CLI11 REQUIRED)
# The HTML report's template engine is one header without a package file.
find_path(KAINJOW_MUSTACHE_INCLUDE_DIR kainjow/mustache.hpp REQUIRED)
