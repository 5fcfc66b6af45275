// An output that is abandoned in the middle, in its density, its exact density, a file or a picture: every file is whole
// or absent, and a run that goes on from there ends with the same files.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "case_text.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "pictures.hpp"
#include "program/same_run.hpp"
#include "render/picture_series.hpp"
#include "scratch_folder.hpp"
#include "write/output_files.hpp"
#include "write/series_table.hpp"

namespace gaussdrift {
namespace {

namespace fs = std::filesystem;

const CaseTables turning{.density = shape_of("gaussian", "0, 0", "0.3"),
                         .particles = "per_axis = 15",
                         .time = "end = 1\nstep = 0.25",
                         .evaluate = "per_axis = 20",
                         .output = "times = [0, 1]\nreport = \"none\"\nimages = [\"heatmap\"]"};

/// Writes all files of a run into the folder, on one thread: its seams are always the same.
std::unique_ptr<Simulation> simulation_in(const fs::path& folder, bool pictures, std::function<bool()> wanted) {
  const Case spec = parse_case(case_text(turning), "turning.toml").spec;
  auto simulation = std::make_unique<Simulation>(spec, 1);
  simulation->observe(write::series_table(folder, 2, true));
  for (const write::FileKind& kind : write::output_files()) simulation->observe(write::file_series(kind, folder));
  if (pictures) simulation->observe(render::picture_series(folder, spec.output.images, "turning"));
  simulation->abandon_when(std::move(wanted));
  return simulation;
}

/// Files that do not grow.
std::map<std::string, std::string> files_of_outputs(const fs::path& folder) {
  std::map<std::string, std::string> files;
  if (fs::exists(folder)) files = bits_of(folder);
  std::erase_if(files, [](const auto& file) { return file.first == "series.csv" || file.first.ends_with(".pvd"); });
  return files;
}

/// Cuts a run at a seam, checks what it left, and goes on. Returns the outputs that were there.
std::size_t cut_and_go_on(const fs::path& whole, const fs::path& part, bool pictures, int at) {
  int asked = 0;
  auto first = simulation_in(part, pictures, [&] { return ++asked >= at; }), second = simulation_in(part, pictures, {});
  const RunSummary cut = first->run();
  EXPECT_FALSE(cut.complete);
  EXPECT_THROW(first->run(), std::logic_error) << "an output was abandoned";
  const auto files = files_of_outputs(whole);
  for (const auto& [name, bytes] : files_of_outputs(part)) {
    EXPECT_TRUE(files.contains(name) && files.at(name) == bytes) << name << " is not whole, at seam " << at;
  }
  second->restore(first->particles(), first->state());
  EXPECT_TRUE(second->run().complete);
  expect_same(whole, part);
  return cut.frames.size();
}

TEST(AbandonedOutput, LeavesWholeFilesAndIsShownAgain) {
  const ScratchFolder folder;
  int seams = 0;
  auto whole = simulation_in(folder / "whole", false, [&] { return ++seams < 0; });
  whole->prepare();
  const int before = seams;
  EXPECT_TRUE(whole->run().complete);
  // From the one before the first density to the one before the first file, and all of the last output.
  std::set<std::size_t> outputs;
  for (const int at : {before + 1, before + 2, before + 3, seams - 4, seams - 3, seams - 2, seams - 1, seams})
    outputs.insert(cut_and_go_on(folder / "whole", folder / std::to_string(at), false, at));
  EXPECT_EQ(outputs, (std::set<std::size_t>{0, 1}));
}

class AbandonedPicture : public Drawn {};

TEST_F(AbandonedPicture, IsDrawnAgain) {
  const ScratchFolder folder;
  int seams = 0;
  auto whole = simulation_in(folder / "whole", true, [&] { return ++seams < 0; });
  EXPECT_TRUE(whole->run().complete);
  // Behind the seam of the last picture are those before finish() of four observers.
  EXPECT_EQ(cut_and_go_on(folder / "whole", folder / "part", true, seams - 4), 1u);
  EXPECT_FALSE(fs::exists(folder / "whole" / "images" / "heatmap_0002.png"));
}

}  // namespace
}  // namespace gaussdrift
