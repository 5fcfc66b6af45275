// Words of other programs are answered with keys that there are.
#include "input/foreign_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>

#include "input/registry.hpp"

namespace gaussdrift::input {
namespace {

bool is_key(const std::string& label) {
  return std::any_of(keys().begin(), keys().end(),
                     [&](const Key& key) { return std::string(key.table) + "." + std::string(key.name) == label; });
}

TEST(ForeignKeys, NameKeysAndTablesThatThereAre) {
  const std::regex key("[a-z_]+\\.[a-z_]+"), table("\\[([a-z_.]+)\\]");
  int named = 0;
  for (const ForeignKey& foreign : foreign_keys()) {
    EXPECT_EQ(find_foreign_key(foreign.word), find_foreign_key(std::string(foreign.word)));
    EXPECT_EQ(find_foreign_key(foreign.word)->word, foreign.word) << "twice in the list, or not in small letters";
    EXPECT_TRUE(foreign.key.empty() || is_key(std::string(foreign.key))) << foreign.word;
    const std::string answer(foreign.answer);
    for (std::sregex_iterator at(answer.begin(), answer.end(), key), end; at != end; ++at, ++named) {
      const std::string found = at->str();
      if (found.ends_with(".csv") || found.rfind("effects.", 0) == 0) continue;
      EXPECT_TRUE(is_key(found)) << foreign.word << ": " << found;
    }
    for (std::sregex_iterator at(answer.begin(), answer.end(), table), end; at != end; ++at, ++named)
      EXPECT_NO_THROW(find_table(at->str(1))) << foreign.word;
  }
  EXPECT_GT(named, 50);
}

TEST(ForeignKeys, AreFoundInAnyManner) {
  for (const char* word : {"time_step", "timeStep", "time-step", "TIMESTEP"}) {
    ASSERT_NE(find_foreign_key(word), nullptr) << word;
    EXPECT_EQ(find_foreign_key(word)->key, "time.step");
  }
  EXPECT_EQ(find_foreign_key("overlap"), nullptr);
}

}  // namespace
}  // namespace gaussdrift::input
