// The words of the command line, read: a verb and the values of its options. command_line.cpp defines the options of verbs
// (options.hpp) too, and it alone includes the parser behind both, CLI11: its header costs the compiler five seconds.
#pragma once

#include <string>
#include <vector>

#include "cli/program_words.hpp"
#include "cli/verb.hpp"

namespace gaussdrift::cli {

/// What the command line asks for: a verb, or an answer that is there already.
struct CommandLine {
  const Verb* verb;  // null: an answer
  std::string answer;
};

/// Throws CommandLineError where it is wrong.
CommandLine parse(int argc, char** argv, const std::vector<Verb>& verbs);

/// What the program says about its command line.
ProgramWords words_of(const std::vector<Verb>& verbs);

}  // namespace gaussdrift::cli
