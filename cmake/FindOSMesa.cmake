# OSMesa, Mesa's off-screen OpenGL: OSMesa_FOUND, OSMesa_LIBRARY, OSMesa_INCLUDE_DIR (Debian: libosmesa6-dev).
find_library(OSMesa_LIBRARY OSMesa)
find_path(OSMesa_INCLUDE_DIR GL/osmesa.h)
mark_as_advanced(OSMesa_LIBRARY OSMesa_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OSMesa REQUIRED_VARS OSMesa_LIBRARY OSMesa_INCLUDE_DIR)
