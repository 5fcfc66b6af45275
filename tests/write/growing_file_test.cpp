// series.csv and .pvd while a run goes on, after a failure, and in a process that goes on with an earlier run.
#include "write/growing_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"
#include "write/atomic_file.hpp"
#include "write/disk.hpp"
#include "write/output_files.hpp"
#include "write/series_table.hpp"

namespace gaussdrift::write {
namespace {

std::string piece(int i) { return fmt::format("row {} {}\n", i, std::string(static_cast<std::size_t>(i % 7), 'x')); }

TEST(GrowingFile, HoldsAllPiecesAndItsEndAfterEveryCall) {
  const ScratchFolder folder;
  std::string expected = "head\n";
  {
    GrowingFile file(folder / "file", "end\n");
    file.begin(expected);
    for (int i = 0; i < 40; ++i) {
      file.append(piece(i));
      expected += piece(i);
      ASSERT_EQ(read_file(folder / "file"), expected + "end\n") << i;
    }
  }
  EXPECT_EQ(folder.count(), 1u);
}

/// Bytes that this process has handed to the system, as it counts them.
std::size_t bytes_written() {
  std::ifstream io("/proc/self/io");
  for (std::string name, value; io >> name >> value;)
    if (name == "wchar:") return std::stoul(value);
  return 0;
}

TEST(GrowingFile, WritesEveryPieceTwiceAndNotTheWholeEachTime) {
  if (bytes_written() == 0) GTEST_SKIP() << "this system does not count what is written";
  const ScratchFolder folder;
  GrowingFile file(folder / "file", "end\n");
  const std::size_t before = bytes_written();
  std::size_t size = 0;
  for (int i = 0; i < 60; ++i) {
    file.append(piece(i));
    size += piece(i).size() + 4;
  }
  EXPECT_LE(bytes_written() - before, 2 * size + 1000);
}

/// A reader that opened the file keeps what it saw until the next piece but one: nothing changes under its hands.
TEST(GrowingFile, IsNotWrittenToWhileItIsSeen) {
  const ScratchFolder folder;
  GrowingFile file(folder / "file", "end\n");
  for (int i = 0; i < 3; ++i) file.append(piece(i));
  std::ifstream reader(folder / "file", std::ios::binary);
  const std::string seen = read_file(folder / "file");
  file.append(piece(3));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), seen);
}

TEST(GrowingFile, IsAsBeforeWhereAPieceFailsAndGrowsOn) {
  const ScratchFolder folder;
  for (const int pieces : {0, 1, 2, 3, 4}) {
    GrowingFile file(folder / "file", "end\n");
    std::string expected;
    file.begin("");
    for (int i = 0; i < pieces; ++i) {
      file.append(piece(i));
      expected += piece(i);
    }
    {
      const FileSizeLimit limit(expected.size() + 10);
      EXPECT_THROW(file.append(std::string(5000, 'y')), FileError);
    }
    EXPECT_EQ(read_file(folder / "file"), expected + "end\n");
    for (int i = 5; i < 9; ++i) {
      file.append(piece(i));
      expected += piece(i);
      EXPECT_EQ(read_file(folder / "file"), expected + "end\n") << pieces;
    }
  }
  EXPECT_EQ(folder.count(), 1u);
}

/// Its user has replaced the file: the next piece makes it again, and the other is not written to.
TEST(GrowingFile, MakesItselfAgainWhereSomebodyTookItsName) {
  const ScratchFolder folder;
  GrowingFile file(folder / "file");
  std::string expected;
  for (int i = 0; i < 8; ++i) {
    if (i % 3 == 1) write_text(folder / "file", "foreign");
    if (i == 5) std::filesystem::remove(folder / "file");
    file.append(piece(i));
    expected += piece(i);
    EXPECT_EQ(read_file(folder / "file"), expected) << i;
  }
}

FrameNumbers numbers_of(int index) {
  FrameNumbers n;
  n.mass = 1. / (index + 1), n.minimum = -index, n.maximum = index, n.centroid = {0.1 * index, 0.2, 0.3};
  n.error = ErrorNorms{0.1, 0.2, 0.3 * index};
  n.seconds = 0.25 * index, n.evaluate_seconds = 0.5;
  return n;
}

/// What both leave: file names and texts.
std::string all_of(const ScratchFolder& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    if (entry.is_regular_file())
      files.push_back(std::filesystem::relative(entry.path(), folder.path()).string() + "\n" + read_file(entry.path()));
  std::sort(files.begin(), files.end());
  std::string all;
  for (const std::string& file : files) all += file + "\n";
  return all;
}

TEST(Observers, LeaveTheSameFilesInAProcessThatGoesOn) {
  Particles particles;
  particles.dimension = 2;
  const DensityGrid density{make_lattice(2, {0, 0, 0}, {1, 1, 0}, 3), std::vector<double>(9, 0.5)};
  const auto frame_of = [&](int index) {
    return Frame{.index = index,
                 .time = index / 3.,
                 .particles = &particles,
                 .density = &density,
                 .exact = nullptr,
                 .numbers = numbers_of(index)};
  };
  const auto observers = [](const ScratchFolder& folder) {
    std::vector<std::unique_ptr<Observer>> all;
    all.push_back(series_table(folder.path(), 2, true));
    all.push_back(file_series(find_output_file("density"), folder.path()));
    return all;
  };
  constexpr int frames = 6;
  const ScratchFolder whole;
  for (auto all = observers(whole); const auto& observer : all)
    for (int i = 0; i < frames; ++i) observer->frame(frame_of(i));
  for (int seen = 0; seen <= frames; ++seen) {
    const ScratchFolder folder;
    std::vector<std::string> states;
    // The first process dies an output later than what is known of it.
    for (auto all = observers(folder); const auto& observer : all) {
      for (int i = 0; i < seen; ++i) observer->frame(frame_of(i));
      states.push_back(observer->state());
      if (seen < frames) observer->frame(frame_of(seen));
    }
    std::vector<std::pair<double, FrameNumbers>> known;
    for (int i = 0; i < seen; ++i) known.emplace_back(frame_of(i).time, numbers_of(i));
    auto all = observers(folder);
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k]->restore(known, states[k]);
      for (int i = seen; i < frames; ++i) all[k]->frame(frame_of(i));
    }
    all.clear();
    EXPECT_EQ(all_of(folder), all_of(whole)) << seen;
  }
}

}  // namespace
}  // namespace gaussdrift::write
