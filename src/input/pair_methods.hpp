// The methods of the library farfield, in its own words: `gaussdrift sum` takes them, and effects choose among them.
#pragma once

#include <string>
#include <vector>

namespace gaussdrift::input {

struct PairMethod {
  std::string name, meaning;
};

/// "auto" is not among them: it is a word of many keys.
std::vector<PairMethod> pair_methods();

}  // namespace gaussdrift::input
