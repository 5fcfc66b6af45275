# Where Python packages are installed, and how. Debian's Python looks into dist-packages: /usr/lib/python3 has what packages of Debian
# install, /usr/local/lib/python3.11 what others do. Elsewhere it is site-packages.
set(python_version ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})
set(GAUSSDRIFT_PYTHON_MINOR ${Python_VERSION_MINOR} PARENT_SCOPE)  # for DebianPackages.cmake
if(NOT EXISTS /etc/debian_version OR NOT Python_EXECUTABLE MATCHES "^/usr/bin/")
  set(folder lib/python${python_version}/site-packages)
elseif(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(folder lib/python3/dist-packages)
else()
  set(folder lib/python${python_version}/dist-packages)
endif()
set(GAUSSDRIFT_PYTHON_FOLDER ${folder} CACHE STRING "Where the Python packages are installed, as seen from the prefix")

# install_python_package(name file ...): its core, and these files.
function(install_python_package name)
  set(destination ${GAUSSDRIFT_PYTHON_FOLDER}/${name})
  install(TARGETS python_${name} LIBRARY DESTINATION ${destination} COMPONENT python)
  install(FILES ${ARGN} DESTINATION ${destination} COMPONENT python)
endfunction()

# For importlib.metadata and pip, which list what is installed.
if(GAUSSDRIFT_INSTALL)
  set(metadata ${PROJECT_BINARY_DIR}/gaussdrift.egg-info)
  file(CONFIGURE OUTPUT ${metadata} CONTENT "Metadata-Version: 2.1
Name: gaussdrift
Version: @PROJECT_VERSION@
Summary: @PROJECT_DESCRIPTION@
Author: The gaussdrift developers
License: BSD-3-Clause
Requires-Dist: numpy
" @ONLY)
  install(FILES ${metadata} DESTINATION ${GAUSSDRIFT_PYTHON_FOLDER} RENAME gaussdrift-${PROJECT_VERSION}.egg-info COMPONENT python)
endif()
