# Writes a source with the files of a folder as byte arrays: input::example_files().
# Usage: cmake -D FOLDER=<folder> -D FILES=<a.toml|b.vti> -D OUT=<file.cpp> -P EmbedFiles.cmake
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
file(WRITE "${OUT}" "// Written by cmake/EmbedFiles.cmake from the files of a folder.\n#include \"input/examples.hpp\"\n\nnamespace gaussdrift::input {\n\nnamespace {\n${arrays}}  // namespace\n\nconst std::vector<ExampleFile>& example_files() {\n  static const std::vector<ExampleFile> files = {\n${entries}  };\n  return files;\n}\n\n}  // namespace gaussdrift::input\n")
