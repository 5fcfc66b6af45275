# Kernels: inner loops that are compiled once for every instruction set. A dispatch source picks among them when the
# program runs (src/core/dispatch.hpp), so that one binary runs everywhere and is fast where it can be.

set(core_x86 OFF)
set(core_instruction_sets baseline)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(core_x86 ON)
  list(APPEND core_instruction_sets avx2 avx512)
endif()

# dispatch_sources(a.cpp ...) tells those sources of the current folder which instruction sets are compiled.
function(dispatch_sources)
  if(core_x86)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_DEFINITIONS CORE_X86)
  endif()
endfunction()

# The kernels of one instruction set, as an object library: kernels_of_one_set(target set doubles-in-a-vector SOURCES a.cpp
# ... OPTIONS ...). They see their namespace as CORE_ISA and the length of a vector as CORE_LANES.
function(kernels_of_one_set target isa lanes)
  cmake_parse_arguments(KERNELS "" "" "SOURCES;OPTIONS" ${ARGN})
  if(NOT GAUSSDRIFT_SANITIZE)  # at -O3 a checked kernel takes the compiler minutes
    set(optimisation -O3)
  endif()
  set(kernels ${target}_kernels_${isa})
  add_library(${kernels} OBJECT ${KERNELS_SOURCES})
  target_compile_definitions(${kernels} PRIVATE CORE_ISA=${isa} CORE_LANES=${lanes})
  # Vectors pass only between inline functions: -Wno-psabi.
  target_compile_options(${kernels} PRIVATE ${optimisation} -ffp-contract=fast -Wno-psabi ${KERNELS_OPTIONS})
  target_include_directories(${kernels} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(${kernels} PRIVATE cxx_std_20)
  target_link_libraries(${kernels} PRIVATE gaussdrift_flags)
  set_target_properties(${kernels} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${kernels}>)
endfunction()

# add_kernels(target DISPATCH dispatch.cpp SOURCES files ... OPTIONS ...) compiles the sources for every instruction set, with
# these options, and puts them into the target, to which dispatch.cpp belongs.
function(add_kernels target)
  cmake_parse_arguments(ADD "" "DISPATCH" "SOURCES;OPTIONS" ${ARGN})
  kernels_of_one_set(${target} baseline 2 SOURCES ${ADD_SOURCES} OPTIONS ${ADD_OPTIONS})
  if(core_x86)
    kernels_of_one_set(${target} avx2 4 SOURCES ${ADD_SOURCES} OPTIONS -mavx2 -mfma ${ADD_OPTIONS})
    kernels_of_one_set(${target} avx512 8 SOURCES ${ADD_SOURCES}
      OPTIONS -mavx2 -mfma -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512 ${ADD_OPTIONS})
  endif()
  dispatch_sources(${ADD_DISPATCH})
endfunction()
