# SPDX-License-Identifier: BSD-3-Clause
# Finds Zoltan, alone or of Trilinos, which brings no package file on Debian: the target Zoltan::zoltan. Needs MPI::MPI_C.
find_path(ZOLTAN_INCLUDE zoltan.h PATH_SUFFIXES trilinos)
find_library(ZOLTAN_LIBRARY NAMES trilinos_zoltan zoltan)
if(ZOLTAN_INCLUDE AND ZOLTAN_LIBRARY AND NOT TARGET Zoltan::zoltan)
  add_library(Zoltan::zoltan UNKNOWN IMPORTED)
  set_target_properties(Zoltan::zoltan PROPERTIES IMPORTED_LOCATION ${ZOLTAN_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${ZOLTAN_INCLUDE} INTERFACE_LINK_LIBRARIES MPI::MPI_C)
endif()
