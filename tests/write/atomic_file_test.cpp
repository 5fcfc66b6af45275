#include "write/atomic_file.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

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
  write_atomically(folder / "file.txt", [&](const std::filesystem::path& part) {
    EXPECT_EQ(part.parent_path(), folder.path());  // a rename across file systems would not be atomic
    EXPECT_NE(part, folder / "file.txt");
    std::ofstream(part) << "half";
    EXPECT_EQ(read_file(folder / "file.txt"), "old");
  });
  EXPECT_EQ(read_file(folder / "file.txt"), "half");
}

TEST(AtomicFile, KeepsTheOldFileWhenWritingFails) {
  const ScratchFolder folder;
  write_text(folder / "file.txt", "old");
  const auto broken = [](const std::filesystem::path& part) {
    std::ofstream(part) << "half a te";
    throw std::logic_error("out of ideas");
  };
  EXPECT_THROW(write_atomically(folder / "file.txt", broken), std::logic_error);
  EXPECT_EQ(read_file(folder / "file.txt"), "old");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(AtomicFile, TurnsSystemErrorsIntoFileErrors) {
  const ScratchFolder folder;
  const auto broken = [](const std::filesystem::path&) { throw std::system_error(EIO, std::generic_category()); };
  const auto text = message_of<FileError>([&] { write_atomically(folder / "file.txt", broken); });
  EXPECT_NE(text.find("file.txt"), std::string::npos) << text;
  EXPECT_NE(text.find("Input/output error (5)"), std::string::npos) << text;
}

TEST(AtomicFile, FailsWhenNothingWasWritten) {
  const ScratchFolder folder;
  EXPECT_THROW(write_atomically(folder / "file.txt", [](const auto&) {}), FileError);
  EXPECT_EQ(folder.count(), 0u);
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
