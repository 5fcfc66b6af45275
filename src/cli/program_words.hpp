// What the program says about its command line: the verbs, and what was said about their options when they were declared.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "cli/options.hpp"

namespace gaussdrift::cli {

struct VerbWords {
  std::string name;
  std::string meaning;              // one line
  std::deque<OptionWords> options;  // and words without dashes; --help is the last
};

struct ExitMeaning {
  std::string_view code, meaning;
};

struct ProgramWords {
  std::string purpose;
  std::string version;
  std::vector<ExitMeaning> exits;
  std::vector<VerbWords> verbs;
};

}  // namespace gaussdrift::cli
