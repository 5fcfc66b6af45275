// Pictures of a run share their colour range, also where the run is that of several processes.
#include "render/picture_series.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pictures.hpp"
#include "render/styles.hpp"
#include "scratch_folder.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::render {
namespace {

namespace fs = std::filesystem;

/// A hill whose height and whose error triple from output to output: every range is left.
class Growing {
 public:
  explicit Growing(const Lattice& lattice) : density_{lattice, {}}, exact_(lattice.size()) { particles_.dimension = 2; }

  void show(Observer& observer, int index) {
    const Lattice& lattice = density_.lattice;
    const double height = std::pow(3, index);
    density_.rho.clear();
    for (std::size_t i = 0; i < lattice.size(); ++i) {
      const double along = lattice.coordinate(0, i % lattice.points[0]);
      density_.rho.push_back(height / (1 + 10 * along * along));
      exact_[i] = density_.rho[i] - 0.01 * height * std::sin(3 * along);
    }
    Frame frame{.index = index,
                .time = time_of(index),
                .particles = &particles_,
                .density = &density_,
                .exact = &exact_,
                .numbers = {}};
    frame.numbers.maximum = height;
    observer.frame(frame);
  }

  static double time_of(int index) { return index / 7.; }
  static std::vector<std::pair<double, FrameNumbers>> known(int frames) {
    std::vector<std::pair<double, FrameNumbers>> all;
    for (int i = 0; i < frames; ++i) all.emplace_back(time_of(i), FrameNumbers{});
    return all;
  }

 private:
  Particles particles_;
  DensityGrid density_;
  std::vector<double> exact_;
};

std::vector<PictureStyle> called(const std::vector<const char*>& names) {
  std::vector<PictureStyle> all;
  for (const char* name : names) all.push_back(find_style(name).about);
  return all;
}

std::map<std::string, std::string> pictures_in(const ScratchFolder& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::directory_iterator(folder / "images"))
    all[entry.path().filename().string()] = read_file(entry.path());
  return all;
}

/// By one process.
std::map<std::string, std::string> pictures_of_all(const Lattice& lattice, const std::vector<PictureStyle>& styles) {
  const ScratchFolder folder;
  Growing scene(lattice);
  const auto pictures = picture_series(folder.path(), styles, "hill");
  scene.show(*pictures, 0), scene.show(*pictures, 1);
  pictures->finish();
  return pictures_in(folder);
}

/// By a process for each of two outputs, which keep nothing in memory.
std::map<std::string, std::string> pictures_of_two(const Lattice& lattice, const std::vector<PictureStyle>& styles,
                                                   bool with_files, std::vector<std::string>& said,
                                                   const std::function<void(const fs::path&)>& between = {}) {
  const ScratchFolder folder;
  Growing scene(lattice);
  const auto files = write::file_series(write::density_output(), folder.path());
  const SeriesOptions options{.warn = [&](const std::string& line) { said.push_back(line); },
                              .most_bytes = 0,
                              .run_writes_densities = with_files};
  const auto show = [&](Observer& pictures, int index) {
    if (with_files) scene.show(*files, index);
    scene.show(pictures, index);
  };
  std::string state;
  {
    const auto first = picture_series(folder.path(), styles, "hill", options);
    show(*first, 0);
    state = first->state();
  }
  EXPECT_NE(fs::exists(folder / "state/pictures"), with_files);
  if (between) between(folder.path());
  const auto second = picture_series(folder.path(), styles, "hill", options);
  second->restore(Growing::known(1), state);
  EXPECT_EQ(second->state(), state);
  show(*second, 1);
  second->finish();
  if (!between) {
    EXPECT_FALSE(fs::exists(folder / "state"));
  }
  return pictures_in(folder);
}

void expect_same_bits(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, bytes] : a) EXPECT_TRUE(b.contains(name) && b.at(name) == bytes) << name << " differs";
}

using PictureSeries = Drawn;

TEST_F(PictureSeries, OfTwoProcessesAreThoseOfOne) {
  const Lattice flat = make_lattice(2, {-1. / 3, -0.3, 0}, {1, 0.7, 0}, 24);
  std::vector<std::string> said;
  const auto styles = called({"heatmap", "error"});
  expect_same_bits(pictures_of_all(flat, styles), pictures_of_two(flat, styles, true, said));
  EXPECT_TRUE(said.empty());
}

TEST_F(PictureSeries, OfTwoProcessesAreThinnedAlikeInSpace) {
  const Lattice solid = make_lattice(3, {-1. / 3, -0.05, 0}, {1, 0.05, 0.1}, 140);
  std::vector<std::string> said;
  const auto styles = called({"slices"});
  expect_same_bits(pictures_of_all(solid, styles), pictures_of_two(solid, styles, true, said));
  EXPECT_TRUE(said.empty());
}

TEST_F(PictureSeries, OfARunWithoutDensityFilesAreTheSameToo) {
  std::vector<std::string> said;
  const Lattice flat = make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 21);
  const Lattice solid = make_lattice(3, {-1. / 3, -0.05, 0}, {1, 0.05, 0.1}, 140);
  for (const auto& [lattice, style] : {std::pair{flat, "error"}, {flat, "heatmap"}, {solid, "slices"}}) {
    const auto styles = called({style});
    expect_same_bits(pictures_of_all(lattice, styles), pictures_of_two(lattice, styles, false, said));
  }
  EXPECT_TRUE(said.empty());
}

TEST_F(PictureSeries, NamesTheDensityAsTheCaseDoes) {
  const auto pictures_with = [](const std::string& label) {
    const ScratchFolder folder;
    Growing scene(make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 21));
    const auto pictures = picture_series(folder.path(), called({"heatmap"}), "hill", {.label = label});
    scene.show(*pictures, 0);
    pictures->finish();
    return pictures_in(folder);
  };
  EXPECT_EQ(pictures_with(""), pictures_with("density"));
  EXPECT_NE(pictures_with("vorticity"), pictures_with("density"));
}

/// What a run keeps for its pictures stays as long as a checkpoint does.
TEST_F(PictureSeries, KeepsItsDensitiesBesideACheckpoint) {
  const ScratchFolder folder;
  Growing scene(make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 21));
  fs::create_directories(folder / "state/0");
  std::ofstream(folder / "state/0/manifest.json") << "{}";
  const auto pictures = picture_series(folder.path(), called({"heatmap"}), "hill");
  scene.show(*pictures, 0);
  pictures->finish();
  EXPECT_TRUE(fs::exists(folder / "state/pictures/density_0000.raw"));
}

TEST_F(PictureSeries, WhereItsDensitiesAreGoneOrDamagedEarlierOnesStayAndAWarningSaysSo) {
  const Lattice flat = make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 21);
  const auto styles = called({"heatmap"});
  const auto whole = pictures_of_all(flat, styles);
  const fs::path name = "state/pictures/density_0000.raw";
  const std::vector<std::function<void(const fs::path&)>> harms{
      [&](const fs::path& folder) { fs::remove(folder / name); },
      [&](const fs::path& folder) { fs::resize_file(folder / name, 100); },
      [&](const fs::path& folder) {
        std::string bytes = read_file(folder / name);
        bytes[50] ^= 1;
        std::ofstream(folder / name, std::ios::binary) << bytes;
      },
      [&](const fs::path& folder) {
        fs::rename(folder / name, folder / "elsewhere");
        fs::create_symlink(folder / "elsewhere", folder / name);
      }};
  for (const auto& harm : harms) {
    std::vector<std::string> said;
    const auto two = pictures_of_two(flat, styles, false, said, harm);
    EXPECT_NE(two.at("heatmap_0000.png"), whole.at("heatmap_0000.png"));
    EXPECT_EQ(two.at("heatmap_0001.png"), whole.at("heatmap_0001.png"));
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("1 earlier output keep a narrower range of colours"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("has no file of t = 0 (output.vtk)"), std::string::npos) << said[0];
  }
}

}  // namespace
}  // namespace gaussdrift::render
