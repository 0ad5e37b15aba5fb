# SPDX-License-Identifier: GPL-3.0-or-later
# install, find_package(exactcsg) and pkg-config.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Installs one of our libraries with its headers as a component of the package.
function(exactcsg_install_library component)
  install(TARGETS exactcsg_${component} EXPORT exactcsg_${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT exactcsg_${component} NAMESPACE exactcsg::
    FILE exactcsg_${component}.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/exactcsg)
endfunction()

function(exactcsg_install_package)
  set(cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/exactcsg)
  configure_package_config_file(cmake/exactcsgConfig.cmake.in exactcsgConfig.cmake
    INSTALL_DESTINATION ${cmake_dir})
  write_basic_package_version_file(exactcsgConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  # Relative, so that the tree may be installed or moved anywhere.
  file(RELATIVE_PATH exactcsg_prefix_from_pkgconfig
    /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
  configure_file(cmake/exactcsg.pc.in exactcsg.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/exactcsgConfig.cmake
    ${PROJECT_BINARY_DIR}/exactcsgConfigVersion.cmake DESTINATION ${cmake_dir})
  install(FILES ${PROJECT_BINARY_DIR}/exactcsg.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  install(FILES LICENSE LICENSES/Apache-2.0.txt LICENSES/GPL-3.0-or-later.txt
    DESTINATION ${CMAKE_INSTALL_DOCDIR})
endfunction()
