# SPDX-License-Identifier: BSD-3-Clause
# Compiler flags of the whole project.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
endif()

# The kernels need AVX2 and FMA to be fast; a host without them gets the baseline. With AVX-512 they keep vectors of four
# numbers, which do not slow the clock down, and use its 32 registers: fewer spills, the same bits.
if(EXISTS /proc/cpuinfo)
  file(STRINGS /proc/cpuinfo _avx2 REGEX "avx2.*fma|fma.*avx2" LIMIT_COUNT 1)
  file(STRINGS /proc/cpuinfo _avx512 REGEX "avx512f.*avx512dq.*avx512cd.*avx512bw.*avx512vl" LIMIT_COUNT 1)
endif()
if(_avx512)
  set(_march x86-64-v4)
elseif(_avx2)
  set(_march x86-64-v3)
endif()
set(TENON_MARCH "${_march}" CACHE STRING "Value of -march; empty for the compiler's default")
if(TENON_MARCH)
  add_compile_options(-march=${TENON_MARCH})
  if(TENON_MARCH MATCHES "x86-64-v4")
    add_compile_options(-mprefer-vector-width=256)
    add_compile_options(-Wno-maybe-uninitialized)  # the compiler's own AVX-512 headers (gcc bug 105593)
  endif()
endif()

# No contraction by default: the same expression must round the same way in every copy of it
# (vector body, remainder, another rank). Kernels that run in padded batches only may switch it on.
add_compile_options(-Wall -Wextra -Wshadow -Wno-unused-parameter -ffp-contract=off $<$<CONFIG:Release>:-O3>)
add_compile_definitions(OMPI_SKIP_MPICXX)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

# The compiler's own linker, not lld: lld 14 enters the empty cold part that g++ splits off some functions into the
# table of the unwinder in place of its neighbour, and a throw there ends the program (llvm issue 218124).
