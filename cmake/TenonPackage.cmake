# SPDX-License-Identifier: BSD-3-Clause
# tenon_package(ROOM FOLDER ROOM FOLDER ...)
#
# Installs rooms as a package: libraries, headers under include/tenon/FOLDER (so that includes read as they do here),
# and what find_package(Tenon COMPONENTS transfer) needs. `cmake --install build --component transfer` installs no more.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

function(tenon_package)
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Tenon)
  while(ARGN)
    list(POP_FRONT ARGN room folder)
    set_target_properties(tenon_${room} PROPERTIES EXPORT_NAME ${room})
    install(TARGETS tenon_${room} EXPORT TenonTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT transfer
      INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tenon)
    get_filename_component(parent include/${folder} DIRECTORY)
    string(REPLACE "include" "${CMAKE_INSTALL_INCLUDEDIR}/tenon" parent ${parent})
    install(DIRECTORY ${folder} DESTINATION ${parent} COMPONENT transfer FILES_MATCHING PATTERN "*.hpp"
      PATTERN "*_impl.hpp" EXCLUDE PATTERN "field_link.hpp" EXCLUDE PATTERN "time_samples.hpp" EXCLUDE)
  endwhile()
  install(EXPORT TenonTargets NAMESPACE Tenon:: DESTINATION ${package} COMPONENT transfer)
  configure_package_config_file(cmake/TenonConfig.cmake.in ${CMAKE_BINARY_DIR}/package/TenonConfig.cmake
    INSTALL_DESTINATION ${package})
  # Before 1.0 a minor version may change the interface.
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/TenonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_BINARY_DIR}/package/TenonConfig.cmake ${CMAKE_BINARY_DIR}/package/TenonConfigVersion.cmake
    cmake/TenonZoltan.cmake DESTINATION ${package} COMPONENT transfer)
  install(DIRECTORY apps/examples/transfer_library DESTINATION ${CMAKE_INSTALL_DATADIR}/tenon/examples
    COMPONENT transfer)
endfunction()
