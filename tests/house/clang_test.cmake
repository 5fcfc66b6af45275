# Does the other compiler build what is compiled in a minute or two, without a warning, and does the result run? By the
# preset `clang`, which stops at warnings: the libraries with the kernels of every instruction set, the modules that
# everything stands on, and a test of every method of fgtd on several threads. Little is optimised beside the kernels.
# Usage: cmake -D SOURCE=<source folder> -D BUILD=<folder to build in> -P clang_test.cmake
cmake_policy(VERSION 3.25)

function(call)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SOURCE} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said
    COMMAND_ECHO STDOUT)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "exit code ${code}:\n${said}")
  endif()
endfunction()

call(${CMAKE_COMMAND} --preset clang -B ${BUILD} -D CMAKE_CXX_FLAGS_RELEASE=-O1)
call(${CMAKE_COMMAND} --build ${BUILD} --target fgtd farfield rbf
  gaussdrift_base gaussdrift_expression gaussdrift_time test_parallel)
call(${BUILD}/test_parallel --gtest_brief=1)
