// A toy kind of output files and a toy style of pictures, each added to its catalogue and nowhere else: everything that
// speaks of files and pictures knows them, and a run makes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "accuracy/forecast.hpp"
#include "base/catalogue.hpp"
#include "case_text.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/explain.hpp"
#include "input/markdown.hpp"
#include "input/registry.hpp"
#include "pictures.hpp"
#include "render/canvas.hpp"
#include "render/styles.hpp"
#include "scratch_folder.hpp"
#include "write/output_files.hpp"

namespace gaussdrift {
namespace {

const std::string small_case = case_text({.reference = not_compared, .output = R"(frames = 2
vtk = ["density", "toy"]
images = []
report = "none")"});

constexpr double toy_bytes = 1e9;

write::FileKind toy_file() {
  return {.about = {.name = "toy", .meaning = "how many particles move", .needs_velocity = true},
          .ending = ".txt",
          .text = [](const std::filesystem::path&,
                     const Frame& frame) { return std::to_string(frame.velocity->size() / 2) + " particles move\n"; },
          .bytes = [](const write::Extent&) { return toy_bytes; },
          .memory = [](const write::Extent&) { return 5e9; },
          .view = [](int) { return std::string("Show(toy, view)\n"); }};
}

constexpr render::Colour toy_colour{12, 200, 34};

render::Painting toy_painting(const DensityGrid&, const render::ColourRange&, const render::PictureOptions&) {
  return [](render::Canvas& canvas) {
    canvas.area({0, 0, double(canvas.width()), double(canvas.height())}, toy_colour);
  };
}

render::Style toy_style() {
  return {.about = {.name = "toy_picture", .meaning = "one colour", .most_dimension = 2},
          .cost = {.seconds = 50, .bytes = 7e8},
          .painting = toy_painting};
}

bool explains(const std::string& word, const std::string& kind) {
  const auto found = input::explain(word);
  return std::any_of(found.begin(), found.end(), [&](const auto& one) { return one.kind == kind; });
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// What the program says that is called with these words.
std::string said(std::vector<std::string> words) {
  words.insert(words.begin(), "gaussdrift");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  testing::internal::CaptureStdout();
  EXPECT_EQ(cli::main_verbs(static_cast<int>(arguments.size()), arguments.data()), 0);
  return testing::internal::GetCapturedStdout();
}

TEST(OutputFile, OfACatalogueIsKnownToAll) {
  EXPECT_FALSE(explains("toy", "file"));
  EXPECT_THROW(gaussdrift::parse_case(small_case, "small.toml"), Error) << "before it is added";
  const base::Added<write::FileKind> added(toy_file());
  EXPECT_TRUE(explains("toy", "file"));
  EXPECT_TRUE(has(input::schema_json(), "\"toy\""));
  EXPECT_TRUE(has(input::registry_markdown(), "| `toy` | how many particles move |"));
  const Case spec = gaussdrift::parse_case(small_case, "small.toml").spec;
  EXPECT_TRUE(has(case_text(spec), "vtk = [\"density\", \"toy\"]"));
  Case without = spec;
  without.output.files.pop_back();
  const accuracy::Forecast with = accuracy::forecast(spec, 1), bare = accuracy::forecast(without, 1);
  EXPECT_EQ(with.disk_bytes - bare.disk_bytes, 2 * toy_bytes);
  EXPECT_GT(with.memory_bytes(), 5e9);
  EXPECT_LT(bare.memory_bytes(), 5e9);
  EXPECT_GT(with.file_seconds, bare.file_seconds);
}

TEST(OutputFile, OfACatalogueIsWrittenByARunAndRemovedByTheNext) {
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  const std::vector<std::string> run{"run", folder / "small.toml", "--out", folder / "out", "--force"};
  {
    write::FileKind toy = toy_file();
    toy.memory = [](const write::Extent&) { return 0.0; };
    const base::Added<write::FileKind> added(toy);
    said(run);
    EXPECT_TRUE(has(read_file(folder / "out/toy/toy_0001.txt"), " particles move\n"));
    EXPECT_TRUE(has(read_file(folder / "out/toy.pvd"), "toy/toy_0000.txt"));
    EXPECT_TRUE(has(read_file(folder / "out/view.py"), "toy = open_series(\"toy\")"));
    std::vector<std::string> again = run;
    again.insert(again.end(), {"--set", "output.vtk=[\"density\"]"});
    said(again);
    EXPECT_FALSE(std::filesystem::exists(folder / "out/toy")) << "the files of the run before";
    EXPECT_FALSE(std::filesystem::exists(folder / "out/toy.pvd"));
  }
}

TEST(PictureStyle, OfACatalogueIsKnownToAll) {
  const std::vector<std::string> overrides{"output.images=[\"toy_picture\"]", "output.vtk=[\"density\"]"};
  EXPECT_FALSE(explains("toy_picture", "picture"));
  EXPECT_THROW(gaussdrift::parse_case(small_case, "small.toml", overrides), Error) << "before it is added";
  const base::Added<render::Style> added(toy_style());
  EXPECT_TRUE(explains("toy_picture", "picture"));
  EXPECT_TRUE(has(input::schema_json(), "\"toy_picture\""));
  EXPECT_TRUE(has(input::registry_markdown(), "| `toy_picture` | 2 | one colour |"));
  EXPECT_TRUE(has(std::string(input::find_key("output", "images").meaning), "`streamlines` and `toy_picture`; in 3D"));
  const Case spec = gaussdrift::parse_case(small_case, "small.toml", overrides).spec;
  EXPECT_TRUE(has(case_text(spec), "images = [\"toy_picture\"]"));
  Case without = spec;
  without.output.images.clear();
  const accuracy::Forecast with = accuracy::forecast(spec, 1), bare = accuracy::forecast(without, 1);
  EXPECT_EQ(with.disk_bytes - bare.disk_bytes, 2 * 7e8);
  EXPECT_EQ(bare.picture_seconds, 0);
  EXPECT_GT(with.picture_seconds, 10) << "two of 50 s, on a machine not five times as fast";
}

TEST(PictureStyle, OfACatalogueIsDrawnByARunAndLater) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const base::Added<render::Style> added(toy_style());
  const ScratchFolder folder;
  write_file(folder / "small.toml", small_case);
  said({"run", folder / "small.toml", "--out", folder / "out", "--set", "output.images=[\"toy_picture\"]", "--set",
        "output.vtk=[\"density\"]"});
  EXPECT_TRUE(std::filesystem::exists(folder / "out/images/toy_picture_0001.png"));
  const std::string text = said({"render", folder / "out", "--style", "toy_picture", "--out", folder / "p"});
  EXPECT_TRUE(has(text, "toy_picture_0000.png")) << text;
}

TEST(PictureStyle, HasOneForEachDimensionWhereACaseDoesNotSay) {
  for (const int dimension : {2, 3}) {
    const auto count = std::count_if(render::styles().begin(), render::styles().end(), [&](const render::Style& style) {
      return style.about.by_default && style.about.shows(dimension);
    });
    EXPECT_EQ(count, 1) << dimension << "D";
    EXPECT_TRUE(render::default_style(dimension, true).about.shows_error);
    EXPECT_FALSE(render::panel_style(dimension).about.shows_error);
    EXPECT_TRUE(render::panel_style(dimension, true).about.shows_error);
  }
}

}  // namespace
}  // namespace gaussdrift
