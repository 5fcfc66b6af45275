// Faults in a new run.
#include <cerrno>

#include "faults/suffering.hpp"

namespace gaussdrift {
namespace {

/// Else nine of ten allocations are made for it, after the run.
const std::string without_budget = "\n[accuracy]\nbudget = \"none\"\n";

class BytesWritten : public Faults {};

/// With a checkpoint at each of them. They would grow with the square if a checkpoint had all outputs.
TEST_F(BytesWritten, GrowWithTheOutputs) {
  write_file(folder / "small.toml", apart);
  const auto bytes_of = [&](int outputs) {
    std::string times;
    for (int i = 0; i < outputs; ++i) times += (i ? "," : "") + std::to_string(0.3 * i / (outputs - 1));
    const auto bytes =
        static_cast<double>(begin_with("run small.toml --set output.vtk=[] --set output.times=[" + times + "]").bytes);
    fs::remove_all(folder / "whole");
    return bytes;
  };
  EXPECT_LT(bytes_of(160) / bytes_of(80), 2.2);
}

TEST_F(Faults, ACallThatFindsTheDiskFull) {
  const long calls = begin(apart).calls;
  for (const long at : spread(0, calls, faults_of_a_test(40))) suffer(at_call(at, ENOSPC), of_files);
  tell("calls found the disk full", calls);
}

TEST_F(Faults, ADiskThatStaysFull) {
  const long calls = begin(apart).calls;
  for (const long at : spread(0, calls, faults_of_a_test(30)))
    suffer("FAULTS_LASTING=1 " + at_call(at, ENOSPC), of_files);
  tell("calls found the disk full, and so did all later ones", calls);
}

/// What needs no room goes on: so the folder can say how the run ended.
TEST_F(Faults, ADiskThatStaysFullForWhatNeedsRoom) {
  tells_its_end = true;
  const long calls = begin(apart).calls;
  constexpr long begun = 25;  // status.json has its first name by then: each of these calls, and some of the others
  for (const long at : spread(0, begun, begun)) suffer("FAULTS_LASTING=room " + at_call(at, ENOSPC), of_files);
  for (const long at : spread(begun, calls, faults_of_a_test(10)))
    suffer("FAULTS_LASTING=room " + at_call(at, ENOSPC), of_files);
  tell("calls found the disk full, and so did all later ones that need room", calls);
}

TEST_F(Faults, ACallThatFailsWithAnErrorOfTheDisk) {
  const long calls = begin(apart).calls;
  for (const long at : spread(0, calls, faults_of_a_test(30))) suffer(at_call(at, EIO), of_files);
  tell("calls failed with an error of the disk", calls);
}

TEST_F(Faults, AKill) {
  const long calls = begin(drawn).calls;
  for (const long at : spread(0, calls, faults_of_a_test(10))) suffer(killed_at(at), of_kills);
  tell("calls killed a run with pictures and a page", calls);
}

/// In the middle of a checkpoint, among others: it is the last one then, and the disk is not waited for.
TEST_F(Faults, ASignal) {
  const long calls = begin(drawn).calls;
  for (const long at : spread(0, calls, faults_of_a_test(10))) suffer(signalled_at(at), of_signals);
  tell("calls in which SIGTERM came, in a run with pictures and a page", calls);
}

/// There is no time to draw them within two seconds. Page and terminal say what to do.
TEST_F(Faults, ASignalOnALargeGridLeavesAPageWithoutPictures) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  write_file(folder / "small.toml", drawn);
  const std::string large = "run small.toml --out part --set evaluate.per_axis=510 --set 'output.images=[\"heatmap\"]'";
  const Outcome stopped = call(large + " --set 'reference.kind=\"none\"'", signalled_at(200));
  EXPECT_EQ(stopped.exit_code, 128 + 15) << stopped.err;
  EXPECT_NE(stopped.out.find("without pictures for now: gaussdrift report part draws them"), std::string::npos)
      << stopped.out;
  const std::string page = read_file(folder / "part/report.html");
  EXPECT_NE(page.find("pictures: there was no time to draw them when the run was stopped; gaussdrift report part draws "
                      "them"),
            std::string::npos);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(gaussdrift_in(folder, "report part").exit_code, 0);
  EXPECT_NE(read_file(folder / "part/report.html").find("<img"), std::string::npos);
}

/// One at every call from this one on: the second ends the program at once, in the middle of its last checkpoint mostly.
TEST_F(Faults, ASecondSignal) {
  const long calls = begin(drawn).calls;
  for (const long at : spread(0, calls - 1, faults_of_a_test(10))) {
    suffer("FAULTS_LASTING=1 " + signalled_at(at), of_second_signals);
    EXPECT_EQ(last_.err.find("resume with"), std::string::npos) << "it went on to its last word";
  }
  tell("calls from which on SIGTERM came, in a run with pictures and a page", calls);
}

/// Before main, while the command line is read, and while the tables of keys are made.
TEST_F(Faults, EachOfTheFirstAllocations) {
  from_its_loading = true;
  begin(apart);
  constexpr long first = 500;
  for (long at = 1; at <= first; ++at) suffer("FAULTS_NEW_ALL=1 FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell("first allocations of the program failed", first);
}

TEST_F(Faults, ALaterAllocation) {
  constexpr long first = 500;
  const long allocations = begin(apart + without_budget, "FAULTS_NEW_ALL=1").allocations;
  for (const long at : spread(first, allocations, faults_of_a_test(200)))
    suffer("FAULTS_NEW_ALL=1 FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell("later allocations failed", allocations - first);
}

/// The case is read here, by tables that the program makes of everything that a case may say.
TEST_F(Faults, AnAllocationBeforeItWrites) {
  const long all = begin(apart, "FAULTS_NEW_ALL=1").allocations;
  fs::remove_all(folder / "whole");
  const long before = all - begin(apart).allocations;
  EXPECT_GT(before, 1000);
  for (const long at : spread(0, before, faults_of_a_test(60)))
    suffer("FAULTS_NEW_ALL=1 FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell("allocations failed before the program wrote", before);
}

/// Of VTK, LLVM, muParser, the C++ library and Eigen, too. Nine of ten are made for pictures.
TEST_F(Faults, AnAllocationOfALibrary) {
  const long allocations = begin(drawn + without_budget, "FAULTS_NEW_OF=libraries").allocations;
  for (const long at : spread(0, allocations, faults_of_a_test(5)))
    suffer("FAULTS_NEW_OF=libraries FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell("allocations of any library failed, once it wrote, in a run with pictures and a page", allocations);
}

/// Libraries in C do not look whether malloc() gave them something, so the drawing crashes.
TEST_F(Faults, MemoryThatStaysShort) {
  const std::string lasting = "FAULTS_NEW_OF=libraries FAULTS_NEW_LASTING=1";
  const long allocations = begin(drawn + without_budget, lasting).allocations;
  for (const long at : spread(0, allocations, faults_of_a_test(4)))
    suffer(lasting + " FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell("allocations of any library failed, and so did all later ones", allocations);
}

/// Some of them while threads share work. Which one comes at which number is left to chance; what is promised is not.
TEST_F(Faults, AnAllocationWithTwoThreads) {
  threads = 2;
  const long allocations = begin(small(150, "", "none") + without_budget).allocations;
  for (const long at : spread(0, allocations, faults_of_a_test(10)))
    suffer("FAULTS_NEW_AT=" + std::to_string(at), of_memory);
  tell("allocations failed in a run on two threads, once it wrote", allocations);
}

}  // namespace
}  // namespace gaussdrift
