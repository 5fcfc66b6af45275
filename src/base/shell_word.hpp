// A name as a command line has it.
#pragma once

#include <string>
#include <string_view>

namespace gaussdrift::base {

/// A word that a shell reads again as `text`, and that is safe to print: names with unusual characters stand in single
/// quotes, those with control characters as $'a\x1bb' (bash, zsh).
std::string shell_word(std::string_view text);

}  // namespace gaussdrift::base
