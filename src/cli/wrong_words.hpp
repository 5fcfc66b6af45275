// Why a command line cannot be read, in the words of the person who typed it.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace gaussdrift::cli {

/// The answer to an unknown verb: the one that was probably meant.
std::string unknown_verb(const CLI::App& app, const std::string& word);

/// The answer to options that the verb does not have and to needless words; else the parser's message.
std::string explained(const CLI::App& app, const CLI::ParseError& error);

}  // namespace gaussdrift::cli
