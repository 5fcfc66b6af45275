# Packages for Debian, by CPack: the preset `deb` configures, builds and packs (docs/install.md).
option(GAUSSDRIFT_DEB "Make the target `package`: .deb packages for this Debian" OFF)
if(NOT GAUSSDRIFT_DEB)
  return()
endif()
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  message(FATAL_ERROR "GAUSSDRIFT_DEB=ON needs CMAKE_INSTALL_PREFIX=/usr, where packages of Debian are installed; the preset `deb` has both")
endif()
find_program(DPKG_SHLIBDEPS dpkg-shlibdeps)
find_program(FILE_PROGRAM file)
find_program(GZIP_PROGRAM gzip)
if(NOT DPKG_SHLIBDEPS OR NOT FILE_PROGRAM OR NOT GZIP_PROGRAM)
  message(FATAL_ERROR "GAUSSDRIFT_DEB=ON needs dpkg-shlibdeps, file and gzip: apt-get install dpkg-dev file gzip")
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_NAME gaussdrift)
set(CPACK_PACKAGE_VENDOR "The gaussdrift developers")
set(CPACK_PACKAGE_CONTACT "the gaussdrift developers <gaussdrift@example.org>")  # the format demands an address
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(debian_folder ${PROJECT_BINARY_DIR}/debian)
set(CPACK_COMPONENTS_ALL "")

# The time of the last commit, so that a tree makes the same packages each time.
set(date $ENV{SOURCE_DATE_EPOCH})
if(NOT date)
  execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%ct OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT date)
  set(date 0)
endif()
execute_process(COMMAND date -u -R -d @${date} OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
string(REGEX REPLACE "(^|\n)([^\n])" "\\1 \\2" license "${license}")
file(CONFIGURE OUTPUT ${debian_folder}/copyright CONTENT "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: gaussdrift

Files: *
Copyright: 2026, the gaussdrift authors
License: BSD-3-Clause

License: BSD-3-Clause
@license@" @ONLY)
file(CONFIGURE OUTPUT ${debian_folder}/changelog CONTENT "gaussdrift (@PROJECT_VERSION@) unstable; urgency=medium

  * What is new stands in CHANGELOG.md of the package gaussdrift.

 -- @CPACK_PACKAGE_CONTACT@  @date@
" @ONLY)
execute_process(COMMAND ${GZIP_PROGRAM} -9 -n -f -k ${debian_folder}/changelog COMMAND_ERROR_IS_FATAL ANY)

# debian_package(component name SECTION section ABOUT "line" TEXT "more" [DEPENDS "a, b"] [RECOMMENDS ...] [SUGGESTS ...] [CONTROL file ...])
macro(debian_package component name)
  cmake_parse_arguments(DEB "" "SECTION;ABOUT;TEXT;DEPENDS;RECOMMENDS;SUGGESTS" "CONTROL" ${ARGN})
  string(TOUPPER ${component} upper)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${DEB_SECTION})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${DEB_ABOUT}\n${DEB_TEXT}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${DEB_DEPENDS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS "${DEB_RECOMMENDS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SUGGESTS "${DEB_SUGGESTS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA "${DEB_CONTROL}")
  install(FILES ${debian_folder}/copyright ${debian_folder}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endmacro()

set(same "(= ${PROJECT_VERSION})")
if(TARGET gaussdrift)
  debian_package(gaussdrift gaussdrift SECTION science
    ABOUT "smoothed-particle advection of a density in a prescribed flow"
    TEXT "A scene is a small text file. Particles move with the flow and carry the
density, in two or three dimensions. A run draws pictures, writes files for
ParaView, and says how accurate it is."
    RECOMMENDS "libnetcdf19, fonts-dejavu-core" SUGGESTS "ffmpeg, paraview, python3-gaussdrift")
  if(GAUSSDRIFT_HAS_MPI)
    debian_package(mpi gaussdrift-mpi SECTION science DEPENDS "gaussdrift ${same}" RECOMMENDS "openmpi-bin"
      ABOUT "smoothed-particle advection on several machines"
      TEXT "With this part the program gaussdrift runs on several ranks of MPI.")
  endif()
endif()
debian_package(fgtd libfgtd-dev SECTION libdevel DEPENDS "libeigen3-dev"
  ABOUT "fast Gauss transform with derivatives (C++ library)"
  TEXT "Sums of many Gaussians, and their derivatives, at many points: N Gaussians
at M points take a time like N + M. The error is below a tolerance that the
caller chooses.")
debian_package(farfield libfarfield-dev SECTION libdevel DEPENDS "libeigen3-dev"
  ABOUT "fast sums of charges, logarithms and vortex blobs (C++ library)"
  TEXT "Sums of functions that fall off slowly, such as fields of charges, at many
points in a time that is nearly linear. The error is below a tolerance that
the caller chooses.")
debian_package(rbf librbf-dev SECTION libdevel DEPENDS "libeigen3-dev, libfgtd-dev ${same}"
  ABOUT "fast sums of radial basis functions (C++ library)"
  TEXT "Sums of radial basis functions at many points, interpolation of scattered
data with them, and integrals of what results.")
if(TARGET gaussdrift_library)
  set(needed "libfgtd-dev ${same}, libfarfield-dev ${same}, librbf-dev ${same}, libfmt-dev, nlohmann-json3-dev, libtomlplusplus-dev, libexpat1-dev, zlib1g-dev, libmuparser-dev, pkg-config")
  if(GAUSSDRIFT_HAS_SLEEF)
    string(APPEND needed ", libsleef-dev")
  endif()
  debian_package(library libgaussdrift-dev SECTION libdevel DEPENDS "${needed}"
    ABOUT "smoothed-particle advection inside of a program (C++ library)"
    TEXT "The simulator of the package gaussdrift as a library: read a case, run it,
look at its outputs.")
endif()
if(TARGET python_fgtd)
  # What Python compiles at its first import would be left behind when the package is removed.
  foreach(script postinst=py3compile prerm=py3clean)
    string(REPLACE "=" ";" script ${script})
    list(GET script 0 name)
    list(GET script 1 command)
    file(WRITE ${debian_folder}/${name}
      "#!/bin/sh\nset -e\nif command -v ${command} >/dev/null 2>&1; then\n  ${command} -p python3-gaussdrift\nfi\n")
    file(CHMOD ${debian_folder}/${name} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  endforeach()
  math(EXPR next_minor "${GAUSSDRIFT_PYTHON_MINOR} + 1")
  debian_package(python python3-gaussdrift SECTION python SUGGESTS "gaussdrift, python3-matplotlib"
    DEPENDS "python3 (>= 3.${GAUSSDRIFT_PYTHON_MINOR}), python3 (<< 3.${next_minor}), python3-numpy" RECOMMENDS "libnetcdf19"
    CONTROL ${debian_folder}/postinst ${debian_folder}/prerm
    ABOUT "smoothed-particle advection and fast Gauss transforms in Python"
    TEXT "The modules gaussdrift, fgtd, farfield and rbf, with NumPy arrays in and
out.")
endif()
include(CPack)
