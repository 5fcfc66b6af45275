# Writes a source with the files of a folder as byte arrays: a function of the module that returns them, as
# input::example_files(). Its header declares it, and a struct of a name and bytes.
# Usage: cmake -D FOLDER=<folder> -D FILES=<a.toml|b.vti> -D OUT=<file.cpp> -D HEADER=<input/examples.hpp>
#   -D MODULE=<input> -D TYPE=<ExampleFile> -D FUNCTION=<example_files> -P EmbedFiles.cmake
cmake_policy(VERSION 3.25)
string(REPLACE "|" ";" FILES "${FILES}")
set(arrays "")
set(entries "")
set(number 0)
foreach(file ${FILES})
  file(READ "${FOLDER}/${file}" hex HEX)
  file(SIZE "${FOLDER}/${file}" size)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" text "${hex}")
  # Pieces of a string literal are joined by the compiler; short lines keep its memory small.
  string(REGEX REPLACE "((\\\\x[0-9a-f][0-9a-f])(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?(\\\\x[0-9a-f][0-9a-f])?)" "    \"\\1\"\n" text "${text}")
  string(APPEND arrays "constexpr char file_${number}[] =\n${text};\n")
  string(APPEND entries "      {\"${file}\", {file_${number}, ${size}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE "${OUT}" "// Written by cmake/EmbedFiles.cmake from the files of a folder.
#include \"${HEADER}\"

namespace gaussdrift::${MODULE} {

namespace {
${arrays}}  // namespace

const std::vector<${TYPE}>& ${FUNCTION}() {
  static const std::vector<${TYPE}> files = {
${entries}  };
  return files;
}

}  // namespace gaussdrift::${MODULE}
")
