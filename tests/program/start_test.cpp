// What the program loads: what draws, MPI and NetCDF are there only where they are needed.
#include <gtest/gtest.h>

#include <string>

#include "program/program.hpp"

namespace gaussdrift {
namespace {

/// The libraries that the loader brought in while the program did that.
std::string loaded_by(const ScratchFolder& folder, const std::string& arguments) {
  const Outcome outcome = gaussdrift_in(folder, arguments, "LD_DEBUG=files LD_DEBUG_OUTPUT=files");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::string all;
  for (const auto& entry : fs::directory_iterator(folder.path()))
    if (entry.path().filename().string().starts_with("files.")) all += read_file(entry.path());
  EXPECT_NE(all.find("libstdc++"), std::string::npos) << "the loader tells nothing";
  return all;
}

const std::string picture_of_two = " --set output.images='[\"heatmap\"]' --set output.times='[0]'";

TEST(Start, BringsInNothingThatARunDoesNotNeed) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  const std::string loaded = loaded_by(folder, "run a.toml --set output.report=none");
  for (const char* library : {"libvtk", "libOSMesa", "libLLVM", "libmpi", "libnetcdf", "libhdf5"})
    EXPECT_EQ(loaded.find(library), std::string::npos) << library;
}

TEST(Start, OfAPictureBringsInWhatDraws) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  const std::string loaded = loaded_by(folder, "run a.toml --set output.report=none" + picture_of_two);
  for (const char* library : {"libgaussdrift_drawing.so", "libOSMesa"})
    EXPECT_NE(loaded.find(library), std::string::npos) << library;
}

TEST(Start, WithoutTheLibraryThatDrawsSaysSoAndRuns) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  fs::copy_file(PROGRAM, folder / "alone");
  const Outcome run = outcome_of(folder, "./alone run a.toml --out run --set output.report=none" + picture_of_two);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("warning: no pictures are drawn: pictures cannot be drawn: libgaussdrift_drawing.so: "),
            std::string::npos)
      << run.err;
  EXPECT_TRUE(fs::exists(folder / "run/density/density_0000.vti"));
  const Outcome picture = outcome_of(folder, "./alone render run");
  EXPECT_EQ(picture.exit_code, 2) << picture.err;
  EXPECT_NE(picture.err.find("which is installed with the program in lib"), std::string::npos) << picture.err;
}

}  // namespace
}  // namespace gaussdrift
