# SPDX-License-Identifier: BSD-3-Clause
# Every outside library, found once. docs/dependencies.md says what each is for.
find_package(MPI REQUIRED COMPONENTS C)

find_package(fmt REQUIRED)
include(TenonZoltan)
if(NOT TARGET Zoltan::zoltan)
  message(FATAL_ERROR "Tenon needs Zoltan (Debian: libtrilinos-zoltan-dev); set ZOLTAN_INCLUDE and ZOLTAN_LIBRARY")
endif()
if(TENON_ONLY)
  return()
endif()

set(HDF5_PREFER_PARALLEL ON)
find_package(HDF5 REQUIRED COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "Tenon needs the parallel HDF5 (Debian: libhdf5-openmpi-dev), found a serial one")
endif()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(yaml-cpp REQUIRED)
find_package(muparser REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)

find_path(UDUNITS_INCLUDE udunits2.h REQUIRED)
find_library(UDUNITS_LIBRARY udunits2 REQUIRED)
add_library(Udunits::udunits UNKNOWN IMPORTED)
set_target_properties(Udunits::udunits PROPERTIES IMPORTED_LOCATION ${UDUNITS_LIBRARY}
  INTERFACE_INCLUDE_DIRECTORIES ${UDUNITS_INCLUDE})

find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel CommonExecutionModel IOXML IOParallelXML IOExodus
  IOImage FiltersCore FiltersGeometry FiltersParallel RenderingCore RenderingOpenGL2 RenderingAnnotation RenderingFreeType
  RenderingContext2D RenderingContextOpenGL2 ChartsCore ViewsContext2D InteractionStyle)

# netCDF (under VTK's Exodus) is built on the serial HDF5 and names it for linking. Our own HDF5 calls would then bind to the
# serial library and fail at run time; the netCDF library finds its HDF5 by itself.
if(TARGET netCDF::netcdf)
  set_property(TARGET netCDF::netcdf PROPERTY INTERFACE_LINK_LIBRARIES "")
endif()
