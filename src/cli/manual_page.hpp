// The manual page gaussdrift(1), from what the program says about its command line.
#pragma once

#include <string>

#include "cli/program_words.hpp"

namespace gaussdrift::cli {

/// In roff, with the macros `man` that every man(1) has.
std::string manual_page(const ProgramWords& program);

}  // namespace gaussdrift::cli
