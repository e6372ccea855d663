# SPDX-License-Identifier: BSD-3-Clause
# tenon_room(NAME DIRECTORY SOURCES ... ROOMS ... [LIBRARIES ...] [PRIVATE_LIBRARIES ...])
#
# Declares the library tenon_NAME of one folder. Headers are included by their path from the root
# ("framework/comm/communicator.hpp"), but a room's folder is visible only to targets that link it:
# each room exports a directory of its own that holds nothing but a link to its folder. An include
# against the direction of the architecture therefore does not compile.
function(tenon_room name directory)
  cmake_parse_arguments(ROOM "" "" "SOURCES;ROOMS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  set(view ${CMAKE_BINARY_DIR}/rooms/${name})
  get_filename_component(parent ${view}/${directory} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${directory} ${view}/${directory} SYMBOLIC)
  if(ROOM_SOURCES)
    add_library(tenon_${name} STATIC ${ROOM_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(tenon_${name} PRIVATE ${ROOM_PRIVATE_LIBRARIES})
  else()
    add_library(tenon_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(tenon_${name} ${scope} $<BUILD_INTERFACE:${view}>)
  target_compile_features(tenon_${name} ${scope} cxx_std_20)
  list(TRANSFORM ROOM_ROOMS PREPEND tenon_)
  target_link_libraries(tenon_${name} ${scope} ${ROOM_ROOMS} ${ROOM_LIBRARIES})
  add_library(Tenon::${name} ALIAS tenon_${name})
endfunction()
