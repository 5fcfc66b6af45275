# Does tools/run take a program that is built without looking for packages, and build where a source is younger?
# In a tree of its own, with a shell script for a program and a package manager that fails.
# Usage: cmake -D ROOT=<source folder> -D SCRATCH=<folder> -P tools_run_test.cmake
file(REMOVE_RECURSE ${SCRATCH})
file(COPY ${ROOT}/tools/run ${ROOT}/tools/setup DESTINATION ${SCRATCH}/tools)
foreach(name CMakeLists.txt CMakePresets.json cmake/a.cmake include/a.hpp src/a/a.cpp)
  file(WRITE ${SCRATCH}/${name} "")
endforeach()
set(program ${SCRATCH}/build/release/gaussdrift)
file(WRITE ${program} "#!/bin/sh\necho \"ran $*\"\n")
file(WRITE ${SCRATCH}/bin/dpkg-query "#!/bin/sh\nexit 1\n")
file(WRITE ${SCRATCH}/bin/id "#!/bin/sh\necho 1\n")      # not root,
file(WRITE ${SCRATCH}/bin/sudo "#!/bin/sh\nexit 1\n")    # and no way to be
file(CHMOD ${program} ${SCRATCH}/bin/dpkg-query ${SCRATCH}/bin/id ${SCRATCH}/bin/sudo
  PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
execute_process(COMMAND touch -d 2020-01-01 ${SCRATCH}/CMakeLists.txt ${SCRATCH}/CMakePresets.json ${SCRATCH}/cmake/a.cmake
  ${SCRATCH}/include/a.hpp ${SCRATCH}/src/a/a.cpp COMMAND_ERROR_IS_FATAL ANY)
set(ENV{PATH} "${SCRATCH}/bin:$ENV{PATH}")

function(expect what code said)
  execute_process(COMMAND ${SCRATCH}/tools/run ${ARGN} WORKING_DIRECTORY ${SCRATCH}
    RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE err INPUT_FILE /dev/null)
  string(FIND "${out}${err}" "${said}" at)
  if(NOT result EQUAL code OR at EQUAL -1)
    message(FATAL_ERROR "${what}: exit code ${result}, must be ${code}; said \"${out}${err}\", must have \"${said}\"")
  endif()
endfunction()

expect("a program that is built" 0 "ran run case.toml --set a=1 --force" case.toml --set a=1)
expect("a folder that is named" 0 "ran run case.toml --out there\n" case.toml --out there)
file(TOUCH ${SCRATCH}/src/a/a.cpp)
execute_process(COMMAND touch -d 2021-01-01 ${program} COMMAND_ERROR_IS_FATAL ANY)
expect("a source that is younger" 1 "Some packages are missing" case.toml)
file(REMOVE ${program})
expect("no program" 1 "Some packages are missing" case.toml)
