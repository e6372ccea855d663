# SPDX-License-Identifier: BSD-3-Clause
# tenon_test(NAME SOURCES ... ROOMS ... [LIBRARIES ...] [RANKS 1 2 3 ...] [LABELS ...] [TIMEOUT seconds])
#
# One GoogleTest program, registered once per rank count as NAME.npN. Ranks beyond the cores are
# oversubscribed. The program's main initialises MPI and fails on every rank if one rank fails.
# Programs with the label `nightly` are left out of the default build: `ninja nightly`, then `ctest -L nightly`.
add_custom_target(nightly COMMENT "Programs of nightly tests")
function(tenon_test name)
  cmake_parse_arguments(T "" "TIMEOUT" "SOURCES;ROOMS;LIBRARIES;RANKS;LABELS" ${ARGN})
  if(NOT T_RANKS)
    set(T_RANKS 1)
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 60)
  endif()
  list(TRANSFORM T_ROOMS PREPEND tenon_)
  add_executable(${name} ${T_SOURCES})
  if("nightly" IN_LIST T_LABELS)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_dependencies(nightly ${name})
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_link_libraries(${name} PRIVATE ${T_ROOMS} tenon_test_support ${T_LIBRARIES})
  target_precompile_headers(${name} REUSE_FROM tenon_test_support)
  if(CCACHE_PROGRAM)  # which has to be told that the precompiled header is what its contents say
    set_target_properties(${name} PROPERTIES CXX_COMPILER_LAUNCHER
      "${CMAKE_COMMAND};-E;env;CCACHE_SLOPPINESS=pch_defines,time_macros;${CCACHE_PROGRAM}")
  endif()
  foreach(ranks ${T_RANKS})
    add_test(NAME ${name}.np${ranks}
      COMMAND ${MPIEXEC_EXECUTABLE} --oversubscribe -n ${ranks} $<TARGET_FILE:${name}>
      WORKING_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    set_tests_properties(${name}.np${ranks} PROPERTIES PROCESSORS ${ranks} TIMEOUT ${T_TIMEOUT} LABELS "${T_LABELS}"
      ENVIRONMENT "${TENON_TEST_ENVIRONMENT}")
  endforeach()
endfunction()
set(TENON_TEST_ENVIRONMENT "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_rmaps_base_oversubscribe=1;OMPI_MCA_hwloc_base_binding_policy=none;OMPI_MCA_pml=ob1;OMPI_MCA_btl=self,vader;OMPI_MCA_mpi_yield_when_idle=1;OMP_NUM_THREADS=1")
