// Completions of the command line for shells, from what the program says about it. Scripts are complete in themselves: a key
// that is pressed starts no program.
#pragma once

#include <string>
#include <vector>

#include "cli/program_words.hpp"

namespace gaussdrift::cli {

/// "bash", "zsh", "fish".
std::vector<std::string> shells();

/// The script for one of the shells.
std::string completions(const ProgramWords& program, const std::string& shell);

}  // namespace gaussdrift::cli
