// The methods of the libraries farfield and rbf, in their own words: `gaussdrift sum` takes them, and effects choose among
// those of farfield.
#pragma once

#include <string>
#include <vector>

namespace gaussdrift::input {

struct PairMethod {
  std::string name, meaning, sums;
};

/// "auto" is not among them: it is a word of many keys. A name that several lists have means the same in both and comes once.
std::vector<PairMethod> pair_methods();

}  // namespace gaussdrift::input
