# The target `docs` writes <build>/docs/html: the reference of include/ and the pages of docs/, by Doxygen.
# A public name without documentation fails it.
find_program(DOXYGEN doxygen)
find_package(Python3 QUIET COMPONENTS Interpreter)
if(DOXYGEN AND Python3_FOUND)
  set(DOCS_FOLDER ${PROJECT_BINARY_DIR}/docs)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/Doxyfile.in ${DOCS_FOLDER}/Doxyfile @ONLY)
  add_custom_target(docs VERBATIM
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/setup/doxygen_pages.py ${PROJECT_SOURCE_DIR} ${DOCS_FOLDER}/pages ${DOCS_FOLDER}/html
    COMMAND ${CMAKE_COMMAND} -D DOXYGEN=${DOXYGEN} -D FOLDER=${DOCS_FOLDER} -P ${CMAKE_CURRENT_LIST_DIR}/RunDoxygen.cmake
    COMMENT "Writing ${DOCS_FOLDER}/html/index.html")
else()
  add_custom_target(docs VERBATIM
    COMMAND ${CMAKE_COMMAND} -E echo "The docs need Doxygen and Python: apt-get install doxygen python3, then configure again: cmake --preset release"
    COMMAND ${CMAKE_COMMAND} -E false
    COMMENT "No docs")
endif()
