# What is installed beside the program: its manual page, completions and the schema of cases, which the program writes itself when it
# has been linked; cases, pages and licence.
if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
  message(STATUS "No manual page, completions and schema: the program does not run here (CMAKE_CROSSCOMPILING_EMULATOR is empty)")
else()
  set(pages ${PROJECT_BINARY_DIR}/pages)
  find_program(GZIP_PROGRAM gzip)
  set(manual gaussdrift.1)
  if(GZIP_PROGRAM)
    set(manual gaussdrift.1.gz)
  endif()
  add_custom_command(TARGET gaussdrift POST_BUILD VERBATIM
    COMMAND ${CMAKE_COMMAND} "-DPROGRAM=${CMAKE_CROSSCOMPILING_EMULATOR};$<TARGET_FILE:gaussdrift>" -D FOLDER=${pages} "-DGZIP=$<$<BOOL:${GZIP_PROGRAM}>:${GZIP_PROGRAM}>"
      -P ${CMAKE_CURRENT_LIST_DIR}/WritePages.cmake
    COMMENT "Writing ${pages}")
  set(zsh_folder zsh/site-functions)
  if(EXISTS /etc/debian_version AND CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set(zsh_folder zsh/vendor-completions)
  endif()
  foreach(place
      ${manual}=${CMAKE_INSTALL_MANDIR}/man1/${manual}
      gaussdrift.bash=${CMAKE_INSTALL_DATADIR}/bash-completion/completions/gaussdrift
      gaussdrift.zsh=${CMAKE_INSTALL_DATADIR}/${zsh_folder}/_gaussdrift
      gaussdrift.fish=${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d/gaussdrift.fish
      case.schema.json=${CMAKE_INSTALL_DATADIR}/gaussdrift/case.schema.json)
    string(REPLACE "=" ";" place ${place})
    list(GET place 0 file)
    list(GET place 1 path)
    get_filename_component(folder ${path} DIRECTORY)
    get_filename_component(name ${path} NAME)
    install(FILES ${pages}/${file} DESTINATION ${folder} RENAME ${name} COMPONENT gaussdrift)
  endforeach()
endif()

# As in the tree, so that the links of the pages lead somewhere.
set(doc_folder ${CMAKE_INSTALL_DATADIR}/doc/gaussdrift)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CITATION.cff ${PROJECT_SOURCE_DIR}/LICENSE
  ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md DESTINATION ${doc_folder} COMPONENT gaussdrift)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/cases ${PROJECT_SOURCE_DIR}/examples DESTINATION ${doc_folder} COMPONENT gaussdrift)
