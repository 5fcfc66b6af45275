# One static library a module, and the compiler flags that all of them share.

add_library(gaussdrift_flags INTERFACE)
target_compile_options(gaussdrift_flags INTERFACE -Wall -Wextra -Wpedantic -Wno-unknown-pragmas)
# Files that are compiled together share their unnamed namespace: what is local in one hides names of another.
if(NOT GAUSSDRIFT_TOGETHER)
  target_compile_options(gaussdrift_flags INTERFACE -Wshadow)
endif()
if(GAUSSDRIFT_WARNINGS_AS_ERRORS)
  target_compile_options(gaussdrift_flags INTERFACE -Werror)
endif()
if(GAUSSDRIFT_SANITIZE)
  target_compile_options(gaussdrift_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(gaussdrift_flags INTERFACE -fsanitize=address,undefined)
endif()
if(GAUSSDRIFT_FUZZ)
  target_compile_options(gaussdrift_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(gaussdrift_flags INTERFACE -fsanitize=address,undefined)
endif()
if(GAUSSDRIFT_NATIVE)
  target_compile_options(gaussdrift_flags INTERFACE -march=native)
endif()
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_definitions(gaussdrift_flags INTERFACE _GLIBCXX_ASSERTIONS)
endif()

set(little_optimised $<$<CONFIG:Release,RelWithDebInfo>:-O1>)

# gaussdrift_module(name [WORDS] SOURCES a.cpp ... DEPENDS target ... PRIVATE_DEPENDS target ...)
# With WORDS it is optimised little: a module of words and files, which takes no time when it runs, compiles faster.
# Includes are written from src/ ("field/velocity/velocity.hpp") and from include/ ("fgtd/fgtd.hpp").
function(gaussdrift_module name)
  cmake_parse_arguments(MODULE "WORDS" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(gaussdrift_${name} STATIC ${MODULE_SOURCES})
  target_include_directories(gaussdrift_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(gaussdrift_${name} PUBLIC ${MODULE_DEPENDS} PRIVATE gaussdrift_flags ${MODULE_PRIVATE_DEPENDS})
  set_target_properties(gaussdrift_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  compile_together(gaussdrift_${name} 5)
  if(MODULE_WORDS)
    target_compile_options(gaussdrift_${name} PRIVATE ${little_optimised})
    use_precompiled_headers(gaussdrift_${name} words)
  elseif(fmt::fmt IN_LIST MODULE_PRIVATE_DEPENDS)  # fmt is among the headers
    use_precompiled_headers(gaussdrift_${name} modules)
  endif()
endfunction()

# embedded_files(source FOLDER folder PATTERN *.csv HEADER input/examples.hpp MODULE input TYPE File FUNCTION files): the files of a folder of the tree become
# part of a module. Sets `source` to the source that has them, which cmake/EmbedFiles.cmake writes.
function(embedded_files source)
  cmake_parse_arguments(EMBED "" "FOLDER;PATTERN;HEADER;MODULE;TYPE;FUNCTION" "" ${ARGN})
  file(GLOB names RELATIVE ${EMBED_FOLDER} CONFIGURE_DEPENDS ${EMBED_FOLDER}/${EMBED_PATTERN})
  list(SORT names)
  list(TRANSFORM names PREPEND ${EMBED_FOLDER}/ OUTPUT_VARIABLE paths)
  list(JOIN names "|" joined)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/${EMBED_FUNCTION}.cpp)
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -D FOLDER=${EMBED_FOLDER} "-DFILES=${joined}" -D OUT=${out} -D HEADER=${EMBED_HEADER} -D MODULE=${EMBED_MODULE}
      -D TYPE=${EMBED_TYPE} -D FUNCTION=${EMBED_FUNCTION} -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    DEPENDS ${paths} ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake VERBATIM)
  set(${source} ${out} PARENT_SCOPE)
endfunction()

# Programs look for such libraries beside themselves (in the folder of the build) and where they are installed. The longer of the two
# paths is that of the build: CMake would fill it up with empty ones, and they mean the folder that somebody is in.
include(GNUInstallDirs)
file(RELATIVE_PATH installed_modules /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR}/gaussdrift)
set(installed_modules "$ORIGIN/${installed_modules}")
set(CMAKE_BUILD_RPATH "$ORIGIN" "$ORIGIN/." ${installed_modules})

# loaded_module(name SOURCES a.cpp ... FOR target file [COMPONENT component]): a shared library libgaussdrift_<name>.so that the program loads when it
# first needs it. The file of the target knows its name as GAUSSDRIFT_<NAME>, and where it is installed as GAUSSDRIFT_MODULES.
function(loaded_module name)
  cmake_parse_arguments(MODULE "" "COMPONENT" "SOURCES;FOR" ${ARGN})
  if(NOT MODULE_COMPONENT)
    set(MODULE_COMPONENT gaussdrift)
  endif()
  list(GET MODULE_FOR 0 user)
  list(GET MODULE_FOR 1 file)
  add_library(gaussdrift_${name} MODULE ${MODULE_SOURCES})
  target_include_directories(gaussdrift_${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(gaussdrift_${name} PRIVATE gaussdrift_flags)
  set_target_properties(gaussdrift_${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR} BUILD_RPATH "")
  add_dependencies(${user} gaussdrift_${name})
  string(TOUPPER ${name} upper)
  set_property(SOURCE ${file} APPEND PROPERTY COMPILE_DEFINITIONS GAUSSDRIFT_${upper}="libgaussdrift_${name}.so"
    GAUSSDRIFT_MODULES="${CMAKE_INSTALL_LIBDIR}/gaussdrift")
  if(GAUSSDRIFT_INSTALL)
    install(TARGETS gaussdrift_${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/gaussdrift COMPONENT ${MODULE_COMPONENT})
  endif()
endfunction()
