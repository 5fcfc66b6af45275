// Why a command line cannot be read, in the words of the person who typed it.
#pragma once

#include <string>
#include <vector>

#include "cli/program_words.hpp"

namespace gaussdrift::cli {

/// The answer to an unknown verb: the one that was probably meant.
std::string unknown_verb(const std::vector<VerbWords>& verbs, const std::string& word);

/// What the parser did not understand.
struct Unread {
  std::string message;                  // of the parser
  std::string verb = {};                // that it has found; empty: none
  std::vector<std::string> extra = {};  // words that it could not place
  bool too_many = false;                // they are all that is wrong
};

/// The answer to options that the verb does not have and to needless words; else the parser's message.
std::string explained(const std::vector<VerbWords>& verbs, const Unread& words);

}  // namespace gaussdrift::cli
