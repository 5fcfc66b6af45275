// Keys that cases of other programs have, and what is possible here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::input {

struct ForeignKey {
  std::string_view word;
  std::string_view key;  // "time.step": the key that is meant; empty: there is none
  std::string answer;    // what is possible
};

const std::vector<ForeignKey>& foreign_keys();

/// Null for words that are not known from elsewhere. Upper and lower case, - and _ do not matter.
const ForeignKey* find_foreign_key(std::string_view word);

}  // namespace gaussdrift::input
