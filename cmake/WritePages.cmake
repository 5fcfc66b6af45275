# Lets the program write its manual page, completions and schema into a folder.
# Usage: cmake "-DPROGRAM=<emulator;>program" -D FOLDER=<folder> -D GZIP=<gzip, or empty> -P WritePages.cmake
cmake_policy(VERSION 3.25)
list(REMOVE_ITEM PROGRAM "")
file(MAKE_DIRECTORY ${FOLDER})

function(write file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${FOLDER}/${file} RESULT_VARIABLE code ERROR_VARIABLE said)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${PROGRAM} ${ARGN}: exit code ${code}\n${said}")
  endif()
endfunction()

write(gaussdrift.1 manual)
foreach(shell bash zsh fish)
  write(gaussdrift.${shell} manual --completions ${shell})
endforeach()
write(case.schema.json explain --schema)
if(GZIP)  # the same bytes each time, without name and time
  execute_process(COMMAND ${GZIP} -9 -n -f -k gaussdrift.1 WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
endif()
