# The check of the module order finds what it should: each of these includes, put into a copy of the tree, must fail it.
# Usage: cmake -D ROOT=<source folder> -D SCRATCH=<folder> -P module_order_test.cmake
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})
file(COPY ${ROOT}/src ${ROOT}/include DESTINATION ${SCRATCH})

function(check expected what)
  execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${SCRATCH} -P ${ROOT}/tools/check_layers.cmake
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(expected STREQUAL "passes" AND NOT result EQUAL 0)
    message(FATAL_ERROR "the tree as it is fails the check:\n${text}")
  elseif(expected STREQUAL "fails" AND result EQUAL 0)
    message(FATAL_ERROR "not noticed: ${what}")
  endif()
endfunction()

check(passes "the tree")
foreach(pair
    "src/base/lattice.cpp|cli/verbs.hpp" "src/sim/simulation.cpp|cli/verbs.hpp" "src/fgtd/plan.cpp|gaussdrift/frame.hpp"
    "src/particle/seeding.cpp|field/velocity/velocity.hpp" "src/write/summary.cpp|gaussdrift/read_case.hpp"
    "src/fgtd/plan.cpp|gaussdrift/error.hpp" "include/fgtd/fgtd.hpp|gaussdrift/case.hpp" "src/time/schedule.cpp|../sim/scene.hpp" "src/sim/simulation.cpp|mpi/ranks.hpp" "src/cli/launcher.cpp|mpi.h" "src/mpi/ranks.cpp|sim/scene.hpp")
  string(REPLACE "|" ";" pair "${pair}")
  list(GET pair 0 file)
  list(GET pair 1 header)
  file(READ ${SCRATCH}/${file} before)
  file(APPEND ${SCRATCH}/${file} "\n#include \"${header}\"\n")
  check(fails "${file} includes ${header}")
  file(WRITE ${SCRATCH}/${file} "${before}")
endforeach()

# A header that a module keeps to itself, whatever its folder, and one of a list that nobody includes.
file(WRITE ${SCRATCH}/src/time/own.hpp "#pragma once\n")
file(WRITE ${SCRATCH}/src/time/folder/own.hpp "#pragma once\n")
foreach(header time/own.hpp time/folder/own.hpp)
  file(WRITE ${SCRATCH}/src/time/user.cpp "#include \"${header}\"\n")
  check(passes "${header} in its own module")
  file(WRITE ${SCRATCH}/src/sim/user.cpp "#include \"${header}\"\n")
  check(fails "${header} in another")
  file(REMOVE ${SCRATCH}/src/sim/user.cpp ${SCRATCH}/src/time/user.cpp)
endforeach()
file(REMOVE_RECURSE ${SCRATCH}/src/cli ${SCRATCH}/src/study)
check(fails "headers that only cli and study included")
file(COPY ${ROOT}/src DESTINATION ${SCRATCH})
check(passes "the tree again")

