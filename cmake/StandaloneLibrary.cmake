# standalone_library(name ABOUT text SOURCES a.cpp ... DISPATCH dispatch.cpp KERNELS files ... [DEPENDS library ...]): a library that is
# installed alone as the package `name`. It depends on Eigen, the standard library and, where present, OpenMP, on other such
# libraries if they are named, and takes the objects of src/core into its own archive.
include(InstructionSets)
include(InstallLibrary)

function(standalone_library name)
  cmake_parse_arguments(LIBRARY "" "ABOUT;DISPATCH" "SOURCES;KERNELS;DEPENDS" ${ARGN})
  add_library(${name} STATIC ${LIBRARY_SOURCES} ${LIBRARY_DISPATCH} $<TARGET_OBJECTS:gaussdrift_core>)
  add_kernels(${name} DISPATCH ${LIBRARY_DISPATCH} SOURCES ${LIBRARY_KERNELS})
  target_compile_options(${name} PRIVATE -ffp-contract=off)
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>
                                     PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_link_libraries(${name} PUBLIC Eigen3::Eigen ${LIBRARY_DEPENDS}
    PRIVATE $<BUILD_INTERFACE:gaussdrift_parallel> $<BUILD_INTERFACE:gaussdrift_flags>)
  if(OpenMP_CXX_FOUND)  # gaussdrift_parallel is not installed, and who links the library needs OpenMP's run-time library
    target_link_libraries(${name} PRIVATE OpenMP::OpenMP_CXX)
  endif()
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  use_precompiled_headers(${name} libraries)
  add_library(${name}::${name} ALIAS ${name})
  if(GAUSSDRIFT_INSTALL)
    install_library(${name} ABOUT ${LIBRARY_ABOUT} DEPENDS ${LIBRARY_DEPENDS})
  endif()
endfunction()
