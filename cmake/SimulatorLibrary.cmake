# The simulator as a library: gaussdrift::gaussdrift, one archive with the objects of these modules. Installed, it is the package
# that find_package(gaussdrift) finds. fgtd and farfield are packages of their own, which it needs.
include(InstallLibrary)

set(library_modules base rows expression time field read particle effect reference sim write render input accuracy)
add_library(gaussdrift_library STATIC)
add_library(gaussdrift::gaussdrift ALIAS gaussdrift_library)
set_target_properties(gaussdrift_library PROPERTIES OUTPUT_NAME gaussdrift EXPORT_NAME gaussdrift LINKER_LANGUAGE CXX)
target_include_directories(gaussdrift_library PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
target_compile_features(gaussdrift_library PUBLIC cxx_std_20)

foreach(module ${library_modules})
  target_sources(gaussdrift_library PRIVATE $<TARGET_OBJECTS:gaussdrift_${module}>)
  foreach(isa ${core_instruction_sets})
    if(TARGET gaussdrift_${module}_kernels_${isa})
      target_sources(gaussdrift_library PRIVATE $<TARGET_OBJECTS:gaussdrift_${module}_kernels_${isa}>)
    endif()
  endforeach()
  # What a module needs from elsewhere, whoever links the archive needs.
  get_target_property(needed gaussdrift_${module} LINK_LIBRARIES)
  list(FILTER needed EXCLUDE REGEX "gaussdrift_|-NOTFOUND|^::@|^\\$<")
  list(APPEND library_needs ${needed})
  get_target_property(options gaussdrift_${module} INTERFACE_LINK_OPTIONS)
  if(options)
    target_link_options(gaussdrift_library INTERFACE ${options})
  endif()
endforeach()
list(REMOVE_DUPLICATES library_needs)
target_link_libraries(gaussdrift_library PRIVATE ${library_needs})
if(OpenMP_CXX_FOUND)
  target_link_libraries(gaussdrift_library PRIVATE OpenMP::OpenMP_CXX)
endif()

if(GAUSSDRIFT_INSTALL)
  set(modules fmt expat zlib muparser tomlplusplus)  # of pkg-config
  if(GAUSSDRIFT_HAS_SLEEF)
    list(APPEND modules sleef)
  endif()
  install_library(gaussdrift TARGET gaussdrift_library COMPONENT library CONFIG gaussdriftConfig.cmake.in
    ABOUT "A density that moves with a flow, by smoothed particles" DEPENDS fgtd farfield rbf REQUIRES ${modules})
endif()
