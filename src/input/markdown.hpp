// The tables of keys and of functions, as docs/cases.md shows them.
#pragma once

#include <string>

namespace gaussdrift::input {

std::string registry_markdown();
std::string functions_markdown();

}  // namespace gaussdrift::input
