// Faults in a run that goes on with an earlier one, or replaces it.
#include <cerrno>

#include "faults/suffering.hpp"

namespace gaussdrift {
namespace {

/// A run that was killed after two thirds of what it writes.
class FaultsInResume : public Faults {
 protected:
  Counts begin_resumed() {
    const long calls = begin(apart).calls;
    EXPECT_TRUE(of_kills.contains(call("run small.toml --out part", killed_at(2 * calls / 3)).exit_code));
    fs::rename(folder / "part", folder / "stopped");
    return begin_in("stopped", "resume part");
  }
};

TEST_F(FaultsInResume, ACall) {
  const long calls = begin_resumed().calls;
  for (const long at : spread(0, calls, faults_of_a_test(10))) suffer(at_call(at, ENOSPC), of_files);
  tell("calls of resume found the disk full", calls);
  for (const long at : spread(0, calls, faults_of_a_test(10))) suffer(at_call(at, EIO), of_files);
  tell("calls of resume failed with an error of the disk", calls);
}

TEST_F(FaultsInResume, AKill) {
  const long calls = begin_resumed().calls;
  for (const long at : spread(0, calls, faults_of_a_test(3))) suffer(killed_at(at), of_kills);
  tell("calls killed a resume", calls);
}

TEST_F(FaultsInResume, AnAllocation) {
  const long allocations = begin_resumed().allocations;
  for (const long at : spread(0, allocations, faults_of_a_test(10)))
    suffer("FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell("allocations of resume failed, once it wrote", allocations);
}

/// Over a whole run of other settings.
class FaultsInForce : public Faults {
 protected:
  Counts begin_replacing() {
    begin(apart);
    write_file(folder / "old.toml", small(25, "", "none"));
    EXPECT_EQ(call("run old.toml --out part").exit_code, 0);
    fs::rename(folder / "part", folder / "old");
    return begin_in("old", "run small.toml --out part --force");
  }
};

TEST_F(FaultsInForce, ACall) {
  const long calls = begin_replacing().calls;
  for (const long at : spread(0, calls, faults_of_a_test(10))) suffer(at_call(at, ENOSPC), of_files);
  tell("calls of run --force found the disk full", calls);
  for (const long at : spread(0, calls, faults_of_a_test(10))) suffer(at_call(at, EIO), of_files);
  tell("calls of run --force failed with an error of the disk", calls);
}

TEST_F(FaultsInForce, AKill) {
  const long calls = begin_replacing().calls;
  for (const long at : spread(0, calls, faults_of_a_test(3))) suffer(killed_at(at), of_kills);
  tell("calls killed a run --force", calls);
}

TEST_F(FaultsInForce, AnAllocation) {
  const long allocations = begin_replacing().allocations;
  for (const long at : spread(0, allocations, faults_of_a_test(10)))
    suffer("FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell("allocations of run --force failed, once it wrote", allocations);
}

}  // namespace
}  // namespace gaussdrift
