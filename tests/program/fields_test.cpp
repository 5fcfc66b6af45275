// output.fields and `gaussdrift field`, as a user meets them: files, pictures, comparisons and refusals.
#include <gtest/gtest.h>

#include "parsed_json.hpp"
#include "program.hpp"

namespace gaussdrift {
namespace {

const char* const all_fields =
    "frames = 2\nvtk = [\"density\"]\nimages = []\nreport = \"none\"\n"
    "fields = [\"gradient\", \"laplacian\", \"velocity\", \"vorticity\", \"divergence\", \"stretch\"]";

void write_case(const fs::path& file, const CaseTables& tables) { write_file(file, case_text(tables)); }

TEST(FieldsOfARun, AreInItsFilesAndAreDrawnAndCompared) {
  const ScratchFolder folder;
  write_case(folder / "one.toml", {.output = all_fields});
  write_case(folder / "two.toml", {.particles = "per_axis = 41", .output = all_fields});
  for (const char* name : {"one", "two"}) {
    const Outcome run = gaussdrift_in(folder, std::string("run ") + name + ".toml --out " + name);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find(", derivatives to "), std::string::npos) << run.out;
  }
  const std::string file = read_file(folder / "one/density/density_0001.vti");
  for (const char* array : {"gradient\" NumberOfComponents=\"3\"", "laplacian\"", "velocity\" NumberOfComponents=\"3\"",
                            "vorticity\"", "divergence\"", "stretch\""})
    EXPECT_NE(file.find(std::string("Name=\"") + array), std::string::npos) << array;
  const auto summary = parsed_json(read_file(folder / "one/summary.json"));
  EXPECT_LE(summary["evaluate"]["derivatives"]["transform_error"], 1e-8);

  EXPECT_EQ(gaussdrift_in(folder, "compare one one --field gradient --tolerance 0").exit_code, 0);
  const Outcome apart = gaussdrift_in(folder, "compare one two --field gradient --json");
  EXPECT_GT(parsed_json(apart.out)["largest"], 1e-3) << apart.out << apart.err;
  EXPECT_EQ(gaussdrift_in(folder, "compare one two --field velocity --tolerance 0").exit_code, 0);

  const Outcome wrong = gaussdrift_in(folder, "render one --field gradiant");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("did you mean gradient?"), std::string::npos) << wrong.err;
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  EXPECT_EQ(gaussdrift_in(folder, "render one --field gradient --style heatmap").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "one/images/gradient_heatmap_0001.png"));
}

// The largest value grows, so that the pictures of all outputs are drawn again with the velocity from the files.
TEST(PicturesOfTheVelocity, AreDrawnAndDrawnAgain) {
  const ScratchFolder folder;
  write_case(folder / "sink.toml", {.velocity = velocity_of({"-3*x", "-3*y"}),
                                    .density = shape_of("gaussian", "0, 0", "0.3"),
                                    .output = "frames = 2\nvtk = [\"density\"]\nreport = \"none\"\n"
                                              "fields = [\"velocity\"]\nimages = [\"arrows\", \"streamlines\"]"});
  const Outcome unnamed = gaussdrift_in(folder, "check sink.toml --set 'output.fields=[\"gradient\"]'");
  EXPECT_EQ(unnamed.exit_code, 3);
  EXPECT_NE(unnamed.err.find("shows the velocity, which output.fields does not name"), std::string::npos)
      << unnamed.err;
  const Outcome unkept = gaussdrift_in(folder, "check sink.toml --set 'output.vtk=[]'");
  EXPECT_EQ(unkept.exit_code, 3) << unkept.err;
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const Outcome run = gaussdrift_in(folder, "run sink.toml --out there");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"arrows_0000.png", "arrows_0001.png", "streamlines_0001.png"})
    EXPECT_TRUE(fs::exists(folder / "there/images" / name)) << name;
  const std::string drawn = read_file(folder / "there/images/arrows_0000.png");
  // `render` takes the range of all outputs, too.
  ASSERT_EQ(gaussdrift_in(folder, "render there --style streamlines --out again").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "again/streamlines_0001.png"));
}

TEST(FieldsOfARun, AreMissedByThoseWhoAskForThem) {
  const ScratchFolder folder;
  write_case(folder / "one.toml", {.output = "frames = 2\nvtk = [\"density\"]\nimages = []\nreport = \"none\""});
  ASSERT_EQ(gaussdrift_in(folder, "run one.toml --out one").exit_code, 0);
  const Outcome compared = gaussdrift_in(folder, "compare one one --field vorticity");
  EXPECT_EQ(compared.exit_code, 6);
  EXPECT_NE(compared.err.find("has no array \"vorticity\""), std::string::npos) << compared.err;
}

TEST(FieldVerb, WritesTheVelocityAlone) {
  const ScratchFolder folder;
  write_case(folder / "spin.toml", {.velocity = velocity_of({"-3*y + t", "3*x"})});
  const Outcome outcome = gaussdrift_in(folder, "field spin.toml --times 0,2 --out there --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto told = parsed_json(outcome.out)["fields"];
  EXPECT_EQ(told["vorticity"]["least"], 6);
  EXPECT_EQ(told["vorticity"]["most"], 6);
  EXPECT_EQ(told["divergence"]["most"], 0);
  EXPECT_EQ(told["velocity"]["unknown"], 0);
  EXPECT_TRUE(fs::exists(folder / "there/field_0001.vti"));
  const std::string series = read_file(folder / "there/field.pvd");
  EXPECT_NE(series.find("timestep=\"2\" part=\"0\" file=\"field_0001.vti\""), std::string::npos) << series;
  EXPECT_EQ(gaussdrift_in(folder, "field spin.toml --out there").exit_code, 6);
  EXPECT_EQ(gaussdrift_in(folder, "field spin.toml --out there --force --fields velocity").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "there/field_0002.vti"));
  EXPECT_EQ(gaussdrift_in(folder, "field spin.toml --out other --fields gradient").exit_code, 2);
}

TEST(FieldVerb, TellsWhereTheVelocityIsNotKnown) {
  const ScratchFolder folder;
  write_case(folder / "hole.toml", {.velocity = velocity_of({"sqrt(x)", "0"})});
  const Outcome outcome = gaussdrift_in(folder, "field hole.toml --fields velocity --times 0 --out there");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("not known at "), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace gaussdrift
