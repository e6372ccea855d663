# SPDX-License-Identifier: BSD-3-Clause
# Installs the transfer library, builds the installed example outside the source tree, and runs it on 1 and 3 ranks.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nended with ${code}:\n${out}\n${err}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${FOLDER})
set(prefix ${FOLDER}/prefix)
run(${CMAKE_COMMAND} --install ${TENON_BUILD} --prefix ${prefix} --component transfer)
run(${CMAKE_COMMAND} -S ${prefix}/share/tenon/examples/transfer_library -B ${FOLDER}/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release
  "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
run(${CMAKE_COMMAND} --build ${FOLDER}/build)

run(${MPIEXEC} --oversubscribe -n 1 ${FOLDER}/build/transfer_example)
set(alone "${output}")
run(${MPIEXEC} --oversubscribe -n 3 ${FOLDER}/build/transfer_example)
if(NOT output STREQUAL alone)
  message(FATAL_ERROR "one rank says\n${alone}three ranks say\n${output}")
endif()
# Exact integral of 300 + 50 x^2 - 20 z over the unit cube: 306 2/3; linear interpolation on 20 and 31 cells is above it
# by 50/6 h^2.
if(NOT output MATCHES "^32768 points, 0 outside; integral 306\\.6875[0-9]* -> 306\\.69[0-9]* K m\\^3; estimated error (0\\.[0-9]+) K\n$")
  message(FATAL_ERROR "unexpected: ${output}")
endif()

run(ldd ${FOLDER}/build/transfer_example)
string(REGEX MATCHALL "lib(vtk|hdf5|netcdf|yaml|muparser)[^ ]*" unwanted "${output}")
if(unwanted)
  message(FATAL_ERROR "the example links ${unwanted}")
endif()
file(GLOB_RECURSE headers RELATIVE ${prefix}/include/tenon ${prefix}/include/tenon/*)
list(FILTER headers EXCLUDE REGEX "^(framework/(base|comm|decomposition|search|mesh|fields)|transfer)/[a-z0-9_]+\\.hpp$")
if(headers)
  message(FATAL_ERROR "unexpected files among the headers: ${headers}")
endif()
