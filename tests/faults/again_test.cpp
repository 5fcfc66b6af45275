// Faults in a run that goes on with an earlier one, or replaces it.
#include <cerrno>

#include "faults/suffering.hpp"

namespace gaussdrift {
namespace {

/// What is called over an earlier run, and how that one came to be.
struct Again {
  const char* name;
  const char* words;  // for the counts
};

class FaultsAgain : public Faults, public testing::WithParamInterface<Again> {
 protected:
  Counts begin_again() { return std::string(GetParam().name) == "InResume" ? begin_resumed() : begin_replacing(); }
  std::string words(const std::string& before, const std::string& after) const {
    return before + GetParam().words + after;
  }

 private:
  /// Over a run that was killed after two thirds of what it writes.
  Counts begin_resumed() {
    const long calls = begin(apart).calls;
    EXPECT_TRUE(of_kills.contains(call("run small.toml --out part", killed_at(2 * calls / 3)).exit_code));
    fs::rename(folder / "part", folder / "stopped");
    return begin_in("stopped", "resume part");
  }
  /// Over a whole run of other settings.
  Counts begin_replacing() {
    begin(apart);
    write_file(folder / "old.toml", small(25, "", "none"));
    EXPECT_EQ(call("run old.toml --out part").exit_code, 0);
    fs::rename(folder / "part", folder / "old");
    return begin_in("old", "run small.toml --out part --force");
  }
};

INSTANTIATE_TEST_SUITE_P(, FaultsAgain, testing::Values(Again{"InResume", "resume"}, Again{"InForce", "run --force"}),
                         [](const auto& again) { return again.param.name; });

TEST_P(FaultsAgain, ACall) {
  const long calls = begin_again().calls;
  for (const long at : spread(0, calls, faults_of_a_test(10))) suffer(at_call(at, ENOSPC), of_files);
  tell(words("calls of ", " found the disk full"), calls);
  for (const long at : spread(0, calls, faults_of_a_test(10))) suffer(at_call(at, EIO), of_files);
  tell(words("calls of ", " failed with an error of the disk"), calls);
}

TEST_P(FaultsAgain, AKill) {
  const long calls = begin_again().calls;
  for (const long at : spread(0, calls, faults_of_a_test(3))) suffer(killed_at(at), of_kills);
  tell(words("calls killed a ", ""), calls);
}

TEST_P(FaultsAgain, ASignal) {
  const long calls = begin_again().calls;
  for (const long at : spread(0, calls, faults_of_a_test(3))) suffer(signalled_at(at), of_signals);
  tell(words("calls of a ", " in which SIGTERM came"), calls);
}

TEST_P(FaultsAgain, AnAllocation) {
  const long allocations = begin_again().allocations;
  for (const long at : spread(0, allocations, faults_of_a_test(10)))
    suffer("FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell(words("allocations of ", " failed, once it wrote"), allocations);
}

}  // namespace
}  // namespace gaussdrift
