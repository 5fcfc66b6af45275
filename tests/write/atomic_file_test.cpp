#include "write/atomic_file.hpp"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <system_error>

#include "base/seam.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"
#include "write/disk.hpp"

namespace gaussdrift::write {
namespace {

TEST(AtomicFile, HoldsTheTextAndNothingElseIsLeft) {
  const ScratchFolder folder;
  const std::string text("line\nNUL \0 and \xFF", 16);
  write_text(folder / "file.txt", text);
  EXPECT_EQ(read_file(folder / "file.txt"), text);
  EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, ReplacesAnOlderOne) {
  const ScratchFolder folder;
  write_text(folder / "file.txt", "a longer old text");
  write_text(folder / "file.txt", "new");
  EXPECT_EQ(read_file(folder / "file.txt"), "new");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, MakesItsFolders) {
  const ScratchFolder folder;
  write_text(folder / "a/b/file.txt", "x");
  EXPECT_EQ(read_file(folder / "a/b/file.txt"), "x");
}

TEST(AtomicFile, WritesBesideItsNameInTheSameFolder) {
  const ScratchFolder folder;
  write_text(folder / "file.txt", "old");
  write_atomically(folder / "file.txt", [&](std::FILE* part) {
    std::fputs("half", part);
    EXPECT_EQ(std::fflush(part), 0);
    EXPECT_EQ(read_file(folder / "file.txt"), "old");
    EXPECT_EQ(folder.count(), 2u);  // a rename across file systems would not be atomic
  });
  EXPECT_EQ(read_file(folder / "file.txt"), "half");
}

TEST(AtomicFile, KeepsTheOldFileWhenWritingFails) {
  const ScratchFolder folder;
  write_text(folder / "file.txt", "old");
  const auto broken = [](std::FILE* part) {
    std::fputs("half a te", part);
    throw std::logic_error("out of ideas");
  };
  EXPECT_THROW(write_atomically(folder / "file.txt", broken), std::logic_error);
  EXPECT_EQ(read_file(folder / "file.txt"), "old");
  EXPECT_EQ(folder.count(), 1u);
}

/// Two pieces are written, and two waited for before the last.
TEST(AtomicFile, MayBeAbandonedWhileTheDiskIsWaitedFor) {
  const ScratchFolder folder;
  write_text(folder / "large", "old");
  const std::string text(std::size_t{1} << 24 | 1000, 'x');
  int seams = 0;
  const base::AbandonWanted at_the_fourth = [&] { return ++seams == 4; };
  {
    const base::Abandonable while_it_lasts(&at_the_fourth);
    EXPECT_THROW(write_text(folder / "large", text), base::Abandoned);
  }
  EXPECT_EQ(read_file(folder / "large"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator()),
            1);
}

TEST(AtomicFile, TurnsSystemErrorsIntoFileErrors) {
  const ScratchFolder folder;
  const auto broken = [](std::FILE*) { throw std::system_error(EIO, std::generic_category()); };
  const auto text = message_of<FileError>([&] { write_atomically(folder / "file.txt", broken); });
  EXPECT_NE(text.find("file.txt"), std::string::npos) << text;
  EXPECT_NE(text.find("Input/output error (5)"), std::string::npos) << text;
}

/// A link that somebody has put there must not lead the program to write elsewhere.
TEST(AtomicFile, FollowsNoLinks) {
  const ScratchFolder folder;
  write_text(folder / "precious", "mine");
  const std::string id = std::to_string(getpid());
  for (int i = 0; i < 200; ++i)  // the names that a part may get next
    std::filesystem::create_symlink(folder / "precious",
                                    folder / (".gaussdrift-" + id + "-" + std::to_string(i) + ".part"));
  std::filesystem::create_symlink(folder / "precious", folder / "v.csv.part");
  std::filesystem::create_symlink(folder / "precious", folder / "v.csv");
  write_text(folder / "v.csv", "values");
  EXPECT_EQ(read_file(folder / "precious"), "mine");
  EXPECT_EQ(read_file(folder / "v.csv"), "values");
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "v.csv"));
}

TEST(AtomicFile, OfTwoWritersAtOnceOneIsLastAndWhole) {
  const ScratchFolder folder;
  write_atomically(folder / "file.txt", [&](std::FILE* part) {
    std::fputs("first", part);
    write_text(folder / "file.txt", "second");  // begins later and ends before
    EXPECT_EQ(read_file(folder / "file.txt"), "second");
  });
  EXPECT_EQ(read_file(folder / "file.txt"), "first");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, IsRemovedWhereItsProcessWasKilledAndNotBefore) {
  const ScratchFolder folder;
  for (const char* name : {".gaussdrift-12-a.part", "user.part", ".hidden"}) write_text(folder / name, "mine");
  std::array<int, 2> ready{};
  ASSERT_EQ(pipe(ready.data()), 0);
  const pid_t writer = fork();
  if (writer == 0) {
    write_atomically(folder / "file.txt", [&](std::FILE*) {
      if (::write(ready[1], "x", 1) == 1) pause();
    });
    _exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  remove_what_killed_processes_left(folder.path());
  EXPECT_EQ(folder.count(), 4u) << "the file of a process that lives";
  kill(writer, SIGKILL);
  waitpid(writer, nullptr, 0);
  EXPECT_EQ(folder.count(), 4u);
  remove_what_killed_processes_left(folder.path());
  EXPECT_EQ(folder.count(), 3u);
  close(ready[0]), close(ready[1]);
}

TEST(AtomicFile, NamesAFileThatIsInTheWayOfAFolder) {
  const ScratchFolder folder;
  write_text(folder / "density", "a file");
  const auto text = message_of<FileError>([&] { write_text(folder / "density/density_0000.vti", "x"); });
  EXPECT_NE(text.find("cannot write " + (folder / "density/density_0000.vti").string()), std::string::npos) << text;
  EXPECT_NE(text.find("move it away"), std::string::npos) << text;
}

TEST(AtomicFile, SaysThatAFolderMayNotBeWritten) {
  const ScratchFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const bool root = geteuid() == 0;  // may write everywhere, so becomes somebody else
  if (root && seteuid(65534) != 0) GTEST_SKIP() << "root cannot become another user here";
  const auto text = message_of<FileError>([&] { write_text(folder / "file.txt", "x"); });
  ASSERT_TRUE(!root || seteuid(0) == 0);
  EXPECT_NE(text.find("Permission denied (13); allow writing there"), std::string::npos) << text;
}

TEST(AtomicFile, KeepsTheOldFileWhenTheLimitOfFileSizesIsMet) {
  const ScratchFolder folder;
  write_text(folder / "file.txt", "old");
  std::string text;
  {
    const FileSizeLimit limit(1000);
    text = message_of<FileError>([&] { write_text(folder / "file.txt", std::string(5000, 'x')); });
  }
  EXPECT_NE(text.find("File too large (27); free some space"), std::string::npos) << text;
  EXPECT_EQ(read_file(folder / "file.txt"), "old");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, NamesFileReasonAndRemedyOnAFullDisk) {
  const ScratchFolder folder;
  const SmallDisk disk(folder.path());
  if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small file system";
  write_text(folder / "file.txt", "old");
  const auto text = message_of<FileError>([&] { write_text(folder / "file.txt", std::string(1 << 20, 'x')); });
  EXPECT_EQ(text,
            "cannot write " + (folder / "file.txt").string() +
                ": No space left on device (28); free some space, or choose another folder with --out; everything "
                "written before is intact");
  EXPECT_EQ(read_file(folder / "file.txt"), "old");
  EXPECT_EQ(folder.count(), 1u);
}

}  // namespace
}  // namespace gaussdrift::write
