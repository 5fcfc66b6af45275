// Why a command line cannot be read, in the words of the person who typed it.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace gaussdrift::cli {

/// A verb that there is not: what was probably meant.
std::string unknown_verb(const CLI::App& app, const std::string& word);

/// Options that the verb has not, words that are one too many; or else what the parser says.
std::string explained(const CLI::App& app, const CLI::ParseError& error);

}  // namespace gaussdrift::cli
