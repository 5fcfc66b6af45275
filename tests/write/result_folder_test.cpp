// Who may write into a folder of results that are no run's, and what becomes of earlier ones.
#include "write/result_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::write {
namespace {

namespace fs = std::filesystem;
using Earlier = ResultFolder::Earlier;

/// Two tables, the second only if it gets so far.
void results_in(const fs::path& folder, const std::string& mark, Earlier earlier, bool both = true) {
  ResultFolder place(folder, "study", earlier);
  write_text(place.claim("a.csv"), mark);
  place.has_result();
  if (!both) return;
  write_text(place.claim("b.csv"), mark);
  place.complete();
}

TEST(ResultFolder, KeepsEarlierResultsUntilThereIsANewOne) {
  const ScratchFolder folder;
  results_in(folder / "s", "first", Earlier::refuse);
  EXPECT_THROW(results_in(folder / "s", "second", Earlier::refuse), FileError);
  {
    ResultFolder second(folder / "s", "study", Earlier::replace);
    EXPECT_EQ(read_file(folder / "s/b.csv"), "first") << "until the first file is written";
    write_text(second.claim("a.csv"), "second");
    EXPECT_EQ(read_file(folder / "s/earlier/b.csv"), "first");
  }
  // It died there, so the first one is what the third replaces.
  {
    ResultFolder third(folder / "s", "study", Earlier::replace);
    third.claim("c.csv");
    EXPECT_EQ(read_file(folder / "s/earlier/a.csv"), "first");
    EXPECT_FALSE(fs::exists(folder / "s/a.csv"));
    write_text(folder / "s/c.csv", "third");
    third.has_result();
    EXPECT_FALSE(fs::exists(folder / "s/earlier"));
  }
  results_in(folder / "s", "fourth", Earlier::replace, false);
  EXPECT_EQ(read_file(folder / "s/a.csv"), "fourth");
  EXPECT_FALSE(fs::exists(folder / "s/c.csv")) << "results of two studies are not mixed";
}

TEST(ResultFolder, ReplacesItsOwnFilesAlone) {
  const ScratchFolder folder;
  fs::create_directory(folder / "s");
  write_text(folder / "s/a.csv", "mine");
  EXPECT_NE(message_of<FileError>([&] {
              results_in(folder / "s", "study", Earlier::replace);
            }).find("a.csv in it is no file of an earlier study"),
            std::string::npos);
  EXPECT_EQ(read_file(folder / "s/a.csv"), "mine");
  write_text(folder / "r/status.json", R"({"kind": "run", "files": ["series.csv"]})");
  EXPECT_THROW(results_in(folder / "r", "study", Earlier::replace), FileError);
}

TEST(ResultFolder, ResultsOfSeveralCallsMayJoin) {
  const ScratchFolder folder;
  results_in(folder / "s", "first", Earlier::join);
  results_in(folder / "s", "second", Earlier::join, false);
  EXPECT_EQ(read_file(folder / "s/a.csv"), "second");
  EXPECT_EQ(read_file(folder / "s/b.csv"), "first");
}

TEST(ResultFolder, TellsHowItEnded) {
  const ScratchFolder folder;
  results_in(folder / "s", "first", Earlier::refuse);
  EXPECT_NE(read_file(folder / "s/status.json").find("\"state\": \"complete\""), std::string::npos);
  results_in(folder / "s", "second", Earlier::replace, false);
  EXPECT_NE(read_file(folder / "s/status.json").find("\"state\": \"failed\""), std::string::npos);
}

TEST(ResultFolder, IsOfOneProcessAndGoesAwayIfNothingIsWritten) {
  const ScratchFolder folder;
  {
    const ResultFolder one(folder / "s", "study", Earlier::refuse);
    EXPECT_NE(message_of<FileError>([&] { ResultFolder(folder / "s", "study", Earlier::replace); }).find("is in use"),
              std::string::npos);
  }
  EXPECT_FALSE(fs::exists(folder / "s"));
}

}  // namespace
}  // namespace gaussdrift::write
