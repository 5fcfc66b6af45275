# Installs the library fgtd as a package that find_package(fgtd) finds: header, static library, exported target fgtd::fgtd.
# `cmake --install <build> --component fgtd` installs it alone.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fgtd)
install(TARGETS fgtd EXPORT fgtdTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT fgtd)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/fgtd DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT fgtd)
install(EXPORT fgtdTargets NAMESPACE fgtd:: DESTINATION ${package_folder} COMPONENT fgtd)

set(FGTD_USES_OPENMP ${OpenMP_CXX_FOUND})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/fgtdConfig.cmake.in ${PROJECT_BINARY_DIR}/fgtdConfig.cmake
  INSTALL_DESTINATION ${package_folder})
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/fgtdConfigVersion.cmake VERSION ${PROJECT_VERSION}
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/fgtdConfig.cmake ${PROJECT_BINARY_DIR}/fgtdConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT fgtd)
