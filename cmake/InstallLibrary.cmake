# install_library(name ABOUT text [TARGET target] [COMPONENT component] [CONFIG file] [DEPENDS library ...] [REQUIRES module ...]) installs a
# library as a package that find_package(name) finds, and with it those of DEPENDS: headers, static library, exported target name::name;
# and as the module `name` of pkg-config, which needs those of DEPENDS and REQUIRES.
# `cmake --install <build> --component <component>` installs it alone. Target and component have the name of the library unless they are given.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

function(install_library library)
  cmake_parse_arguments(INSTALL "" "ABOUT;TARGET;COMPONENT;CONFIG" "DEPENDS;REQUIRES" ${ARGN})
  foreach(default TARGET=${library} COMPONENT=${library} CONFIG=libraryConfig.cmake.in)
    string(REPLACE "=" ";" default ${default})
    list(GET default 0 key)
    if(NOT INSTALL_${key})
      list(GET default 1 INSTALL_${key})
    endif()
  endforeach()
  set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/${library})
  install(TARGETS ${INSTALL_TARGET} EXPORT ${library}Targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${INSTALL_COMPONENT})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/${library} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${INSTALL_COMPONENT})
  install(EXPORT ${library}Targets NAMESPACE ${library}:: DESTINATION ${package_folder} COMPONENT ${INSTALL_COMPONENT})

  set(uses_openmp ${OpenMP_CXX_FOUND})
  set(find_dependencies "")
  foreach(needed ${INSTALL_DEPENDS})
    string(APPEND find_dependencies "find_dependency(${needed} ${PROJECT_VERSION})\n")
  endforeach()
  configure_package_config_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/${INSTALL_CONFIG}
    ${PROJECT_BINARY_DIR}/${library}Config.cmake INSTALL_DESTINATION ${package_folder})
  # Before 1.0 a new minor version may change the interface.
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/${library}ConfigVersion.cmake VERSION ${PROJECT_VERSION}
    COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/${library}Config.cmake ${PROJECT_BINARY_DIR}/${library}ConfigVersion.cmake
    DESTINATION ${package_folder} COMPONENT ${INSTALL_COMPONENT})

  # Paths are as seen from the file, so the prefix may be moved.
  set(module_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  file(RELATIVE_PATH prefix_from_module /${module_folder} /)
  string(REGEX REPLACE "/$" "" prefix_from_module "${prefix_from_module}")
  string(JOIN " " requires eigen3 ${INSTALL_DEPENDS} ${INSTALL_REQUIRES})
  set(about ${INSTALL_ABOUT})
  set(threads_flag "")
  if(OpenMP_CXX_FOUND)
    set(threads_flag " ${OpenMP_CXX_FLAGS}")
  endif()
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/library.pc.in ${PROJECT_BINARY_DIR}/${library}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${library}.pc DESTINATION ${module_folder} COMPONENT ${INSTALL_COMPONENT})
endfunction()
