# install_library(name) installs a library as a package that find_package(name) finds: header, static library, exported target
# name::name. `cmake --install <build> --component <name>` installs it alone.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

function(install_library library)
  set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/${library})
  install(TARGETS ${library} EXPORT ${library}Targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${library})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/${library} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${library})
  install(EXPORT ${library}Targets NAMESPACE ${library}:: DESTINATION ${package_folder} COMPONENT ${library})

  set(uses_openmp ${OpenMP_CXX_FOUND})
  configure_package_config_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/libraryConfig.cmake.in
    ${PROJECT_BINARY_DIR}/${library}Config.cmake INSTALL_DESTINATION ${package_folder})
  # Before 1.0 a new minor version may change the interface.
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/${library}ConfigVersion.cmake VERSION ${PROJECT_VERSION}
    COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/${library}Config.cmake ${PROJECT_BINARY_DIR}/${library}ConfigVersion.cmake
    DESTINATION ${package_folder} COMPONENT ${library})
endfunction()
