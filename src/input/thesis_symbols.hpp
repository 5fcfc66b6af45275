// Tables A.1 to A.4 of the thesis: its symbols, and what stands for each of them here.
#pragma once

#include <string_view>
#include <vector>

namespace gaussdrift::input {

struct ThesisSymbol {
  std::string_view symbol;
  std::string_view table;    // "A.1"
  std::string_view meaning;  // in the thesis
  std::string_view here;     // where it is found in gaussdrift
};

/// In the order of the tables. A symbol of several tables is there for each of them.
const std::vector<ThesisSymbol>& thesis_symbols();

}  // namespace gaussdrift::input
