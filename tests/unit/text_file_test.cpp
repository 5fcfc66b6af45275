// Files that somebody names: what is no text, or too much of it, is answered before memory is taken for it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "base/text_file.hpp"
#include "gaussdrift/error.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::base {
namespace {

namespace fs = std::filesystem;

class TextFile : public testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& text) const {
    write_file(folder_ / name, text);
    return folder_ / name;
  }
  /// The refusal, with the folder left out.
  std::string refusal(const fs::path& path, std::size_t most = 1000) const {
    try {
      read_text_file(path, "a table", most);
    } catch (const Error& error) {
      const std::string text = error.what(), prefix = folder_.path().string() + "/";
      return text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text;
    }
    return "";
  }
  ScratchFolder folder_;
};

TEST_F(TextFile, IsReadWholeUpToTheLimitAndRefusedBeyond) {
  const std::string text(1'000'000, 'x');
  EXPECT_EQ(read_text_file(file("a", text), "a table", text.size()), text);
  EXPECT_EQ(refusal(file("a", text), text.size() - 1), "a has 1.0 MB or more; a table has at most 1.0 MB");
  EXPECT_EQ(read_text_file(file("empty", ""), "a table", 1), "");
}

TEST_F(TextFile, ASparseTerabyteIsRefusedByItsSize) {
  const fs::path huge = file("huge", "x");
  ASSERT_EQ(::truncate(huge.c_str(), off_t{1} << 40), 0);
  EXPECT_EQ(refusal(huge, 4'000'000), "huge has 1099512 MB or more; a table has at most 4.0 MB");
}

TEST_F(TextFile, WhatIsNoFileOfTextSaysWhatItIs) {
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero is a device, not a table");
  fs::create_directory(folder_ / "d");
  EXPECT_EQ(refusal(folder_ / "d"), "d is a folder, not a table");
  fs::create_symlink("/dev/zero", folder_ / "link");
  EXPECT_EQ(refusal(folder_ / "link"), "link is a device, not a table");
  EXPECT_EQ(refusal(folder_ / "none"), "cannot read " + (folder_ / "none").string() + ": No such file or directory");
}

TEST_F(TextFile, APipeIsReadAndOneToWhichNobodyWritesIsNotWaitedFor) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(
      refusal(pipe),
      "pipe is a pipe, and nothing came through it; a table is expected: write to the pipe before, or name a file");
  const int both = ::open(pipe.c_str(), O_RDWR);  // does not wait for the other end
  ASSERT_GE(both, 0);
  ASSERT_EQ(::write(both, "x,y\n1,2\n", 8), 8);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);  // keeps what was written
  ::close(both);
  EXPECT_EQ(read_text_file(pipe, "a table", 100), "x,y\n1,2\n");
  ::close(reader);
}

TEST_F(TextFile, APipeWithoutEndIsRefusedAtTheLimit) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int both = ::open(pipe.c_str(), O_RDWR);
  ASSERT_GE(both, 0);
  const std::string much(2000, 'y');
  ASSERT_EQ(::write(both, much.data(), much.size()), static_cast<ssize_t>(much.size()));
  EXPECT_EQ(refusal(pipe, 1000), "pipe has 2000 bytes or more; a table has at most 1000 bytes");
  ::close(both);
}

}  // namespace
}  // namespace gaussdrift::base
