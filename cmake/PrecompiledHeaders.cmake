# Headers that most files include are parsed once and not once a file (docs/decisions/0029-precompiled-headers.md). They belong
# to the standard library and to others, so a change of ours never makes them anew.
option(GAUSSDRIFT_PRECOMPILED_HEADERS "Parse the headers that most files include once (GCC alone)" ON)

# precompiled_headers(name HEADERS <a> ... LIBRARIES target ... OPTIONS ...) makes them, for targets that are compiled with
# these options; targets with others need a set of their own.
function(precompiled_headers name)
  # clang reads every file as it stands, so the preset `clang` finds a file that lacks an include.
  if(NOT GAUSSDRIFT_PRECOMPILED_HEADERS OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  cmake_parse_arguments(SET "POSITION_INDEPENDENT" "" "HEADERS;LIBRARIES;OPTIONS" ${ARGN})
  set(source ${PROJECT_BINARY_DIR}/precompiled_headers.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(gaussdrift_headers_${name} OBJECT ${source})
  target_link_libraries(gaussdrift_headers_${name} PRIVATE gaussdrift_flags ${SET_LIBRARIES})
  target_compile_options(gaussdrift_headers_${name} PRIVATE ${SET_OPTIONS})
  target_compile_features(gaussdrift_headers_${name} PRIVATE cxx_std_20)
  set_target_properties(gaussdrift_headers_${name} PROPERTIES POSITION_INDEPENDENT_CODE ${SET_POSITION_INDEPENDENT})
  target_precompile_headers(gaussdrift_headers_${name} PRIVATE ${SET_HEADERS})
endfunction()

# use_precompiled_headers(target name): every file of the target is compiled as if it included them first.
function(use_precompiled_headers target name)
  if(TARGET gaussdrift_headers_${name})
    target_precompile_headers(${target} REUSE_FROM gaussdrift_headers_${name})
  endif()
endfunction()

# compile_together(target files): so many files of the target are compiled as one, so that what they include is parsed once
# (docs/decisions/0058-files-compiled-together.md). Names in their unnamed namespaces must differ. Files with options of their own
# are compiled alone. clang reads every file by itself, so the preset `clang` finds a file that lacks an include.
function(compile_together target files)
  if(GAUSSDRIFT_TOGETHER AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  endif()
endfunction()

set(usual_headers <algorithm> <array> <chrono> <cmath> <filesystem> <functional> <map> <memory> <optional> <string> <string_view>
  <variant> <vector>)
