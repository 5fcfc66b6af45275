// Animations of a run: their frames, what they cost a run beside them, and what happens where one cannot be made.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "case_text.hpp"
#include "pictures.hpp"
#include "program/program.hpp"
#include "program/same_run.hpp"
#include "render/film_reader.hpp"

namespace gaussdrift {
namespace {

/// A blob that turns by a quarter: 200 steps, two outputs, a fifth of a second.
const std::string turning = case_text({.density = shape_of("wendland", "0.5, 0", "0.3"),
                                       .particles = "per_axis = 40",
                                       .time = "end = \"pi/2\"\nstep = \"pi/400\"",
                                       .evaluate = "per_axis = 40",
                                       .output = "frames = 2\nimages = [\"heatmap\"]\nreport = \"none\"\n"
                                                 "animation_frames = 9\nanimation_size = [161, 120]"});

class Animation : public testing::Test {
 protected:
  void SetUp() override {
    if (!draws_pictures) GTEST_SKIP() << without_pictures;
    std::ofstream(folder / "turning.toml") << turning;
  }
  Outcome run(const std::string& kind, const std::string& more = "", const std::string& before = "") {
    return gaussdrift_in(folder, "run turning.toml --set output.animation=" + kind + " " + more, before);
  }
  /// A program of that name in the folder bin, which is all of PATH but the shell's own.
  void install(const std::string& text) {
    fs::create_directories(folder / "bin");
    std::ofstream(folder / "bin/ffmpeg") << "#!/bin/sh\n" << text << "\n";
    fs::permissions(folder / "bin/ffmpeg", fs::perms::owner_all);
  }
  const std::string with_it = "PATH=bin:/bin:/usr/bin", without_it = "PATH=/nowhere";
  const ScratchFolder folder;
};

/// The middle of what is brighter than half of the range, in the map's coordinates from -1 to 1, upwards positive.
std::pair<double, double> place_of_blob(const ReadFilm& film, std::size_t frame) {
  const auto at = [&](int row, int column) {
    return film.frames[frame][static_cast<std::size_t>(row * film.width + column)];
  };
  const auto is_dark = [&](int row, int column) {  // the lowest colour
    const auto [red, green, blue] = at(row, column);
    return red < 75 && green < 10 && blue > 70;
  };
  // The first row with that colour is the top of the map; the bar beside it has it below alone.
  int top = 0, left = 0;
  while (!is_dark(top, left))
    if (++left == film.width) left = 0, ++top;
  int right = left, bottom = top;
  while (is_dark(top, right + 1)) ++right;
  while (is_dark(bottom + 1, left)) ++bottom;
  double x = 0, y = 0, count = 0;
  for (int row = top; row <= bottom; ++row)
    for (int column = left; column <= right; ++column) {
      const auto [red, green, blue] = at(row, column);
      if (green > 140 && green > red + 30) x += column, y += row, ++count;
    }
  return {2 * (x / count - left) / (right - left) - 1, 1 - 2 * (y / count - top) / (bottom - top)};
}

TEST_F(Animation, ShowsTheRunBetweenItsOutputs) {
  const Outcome with = run("true", "--out with"), without = run("false", "--out without");
  ASSERT_EQ(with.exit_code, 0) << with.err;
  EXPECT_NE(with.out.find("film   images/heatmap.gif"), std::string::npos) << with.out;
  // Keys of an animation that is not made are a mistake; false says that it is meant so.
  EXPECT_EQ(without.exit_code, 0) << without.err;
  const ReadFilm film = read_gif(read_file(folder / "with/images/heatmap.gif"));
  EXPECT_EQ(film.width, 162) << "even";
  EXPECT_EQ(film.height, 120);
  ASSERT_EQ(film.frames.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const double angle = std::numbers::pi / 2 * static_cast<double>(i) / 8;
    const auto [x, y] = place_of_blob(film, i);
    EXPECT_NEAR(x, 0.5 * std::cos(angle), 0.05) << i;  // two pixels of a map of some 90
    EXPECT_NEAR(y, 0.5 * std::sin(angle), 0.05) << i;
  }
  // Frames leave no files, and lie on steps: all numbers are those of a run without, but for rounding.
  EXPECT_FALSE(fs::exists(folder / "with/state"));
  EXPECT_FALSE(fs::exists(folder / "with/density/density_0002.vti"));
  const auto last_row = [&](const char* name) {
    std::istringstream rows(read_file(folder / name / "series.csv"));
    std::string row, last;
    while (std::getline(rows, row)) last = row;
    std::vector<double> numbers;
    std::istringstream cells(last);
    for (std::string cell; std::getline(cells, cell, ',') && numbers.size() < 7;)
      numbers.push_back(std::atof(cell.c_str()));
    return numbers;
  };
  const auto a = last_row("with"), b = last_row("without");
  ASSERT_EQ(a.size(), 7u);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-11) << "column " << i;  // 200 steps of rounding
}

TEST_F(Animation, IsTheSameForAnyNumberOfThreadsAndAfterAStop) {
  for (const char* kind : {"gif", "apng"}) {
    const std::string word = std::string("'\"") + kind + "\"'", name = kind;
    ASSERT_EQ(run(word, "--set output.checkpoint=0.01 --threads 1 --out " + name + "1").exit_code, 0);
    ASSERT_EQ(run(word, "--set output.checkpoint=0.01 --threads 2 --out " + name + "2").exit_code, 0);
    expect_same(folder / (name + "1"), folder / (name + "2"));
    if (name == "apng") continue;  // their frames are the same
    Outcome stopped = run(word, "--set output.checkpoint=0.01 --stop-after 0.02 --out " + name + "3");
    for (int stops = 0; stopped.exit_code == 7 && stops < 20; ++stops)
      stopped = gaussdrift_in(folder, "resume " + name + "3 --stop-after 0.05");
    if (stopped.exit_code == 7) stopped = gaussdrift_in(folder, "resume " + name + "3");
    ASSERT_EQ(stopped.exit_code, 0) << stopped.err;
    expect_same(folder / (name + "1"), folder / (name + "3"));
  }
}

TEST_F(Animation, ByAProgramThatIsNotThereIsRefusedBeforeTheRun) {
  const Outcome checked = gaussdrift_in(folder, "check turning.toml --set 'output.animation=\"mp4\"'", without_it);
  EXPECT_EQ(checked.exit_code, 3);
  EXPECT_NE(checked.err.find("ffmpeg is not installed"), std::string::npos) << checked.err;
  EXPECT_NE(checked.err.find("\"gif\" needs no other program"), std::string::npos) << checked.err;
  EXPECT_EQ(run("'\"webm\"'", "--out no", without_it).exit_code, 3);
  EXPECT_FALSE(fs::exists(folder / "no"));
}

TEST_F(Animation, ByAProgramThatFailsCostsNothingElse) {
  install("echo no such coder >&2; exit 3");
  const Outcome failed = run("'\"mp4\"'", "--out part", with_it);
  EXPECT_EQ(failed.exit_code, 6);
  EXPECT_NE(failed.err.find("ffmpeg ended with exit code 3: no such coder"), std::string::npos) << failed.err;
  EXPECT_NE(failed.err.find("gaussdrift render part --animation"), std::string::npos) << failed.err;
  for (const char* file : {"summary.json", "log.txt", "density/density_0001.vti", "images/heatmap_0001.png"})
    EXPECT_TRUE(fs::exists(folder / "part" / file)) << file;
  EXPECT_FALSE(fs::exists(folder / "part/images/heatmap.mp4"));
  // The frames are there for another kind.
  const Outcome later = gaussdrift_in(folder, "render part --style heatmap --animation gif --size 160x120");
  EXPECT_EQ(later.exit_code, 0) << later.err;
  EXPECT_EQ(read_gif(read_file(folder / "part/images/heatmap.gif")).frames.size(), 9u);
}

TEST_F(Animation, ByAProgramGetsItsPixels) {
  install("echo \"$@\" > words; cat > /dev/fd/3");
  const Outcome made = run("'\"mp4\"'", "--out whole", with_it);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(fs::file_size(folder / "whole/images/heatmap.mp4"), 9u * 162 * 120 * 3);
  const std::string words = read_file(folder / "words");
  EXPECT_NE(words.find("-s 162x120 -framerate 9000/10000"), std::string::npos) << words;
  EXPECT_NE(words.find("-pix_fmt yuv420p"), std::string::npos) << words;
}

TEST_F(Animation, OfOutputsIsMadeLater) {
  ASSERT_EQ(run("false", "--set output.frames=4 --out part").exit_code, 0);
  const Outcome made = gaussdrift_in(folder, "render part --style heatmap --animation --seconds 2 --size 160x120");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const ReadFilm film = read_gif(read_file(folder / "part/images/heatmap.gif"));
  ASSERT_EQ(film.frames.size(), 4u);
  EXPECT_EQ(film.seconds, std::vector<double>(4, 0.5));
}

TEST_F(Animation, IsRefusedWhereItHasNoSense) {
  const auto refused = [&](const std::string& more, const std::string& why) {
    const Outcome outcome = run("true", more + " --out no");
    EXPECT_EQ(outcome.exit_code, 3) << more;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << more << ": " << outcome.err;
  };
  refused("--set time.end=0 --set time.step=1 --set output.frames=1", "leaves nothing to move");
  refused("--set evaluate.piece_points=1000", "an animation shows the whole grid");
  refused("--set output.animation_frames=1", "animation_frames");
  refused("--set output.animation_size=[10,10]", "animation_size");
  EXPECT_EQ(gaussdrift_in(folder, "check turning.toml").exit_code, 3) << "keys of an animation, and none is made";
  EXPECT_EQ(gaussdrift_in(folder, "render turning.toml --animation").exit_code, 2);
  EXPECT_EQ(run("'\"avi\"'").exit_code, 3);
}

}  // namespace
}  // namespace gaussdrift
