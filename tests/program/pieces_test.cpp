// Runs whose density is written in pieces: the files, and what other commands make of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "parsed_json.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

const std::string scene = case_text({.velocity = "field = \"rotation\"",
                                     .density = shape_of("wendland", "0.5, 0", "0.25"),
                                     .particles = "per_axis = 60",
                                     .time = "end = 1\nstep = 0.1",
                                     .evaluate = "per_axis = 90",
                                     .reference = "kind = \"exact\"\nrho = \"exp(-x^2-y^2)\"",
                                     .output = "times = [0, 0.5, 1]\nimages = []\nreport = \"none\""});

const std::string in_pieces = " --set evaluate.piece_points=3000";

TEST(DensityInPieces, IsWrittenAndCompared) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out whole").exit_code, 0);
  const Outcome run = gaussdrift_in(folder, "run a.toml --out pieces" + in_pieces);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("the density is written in 4 pieces"), std::string::npos) << run.err;
  for (const char* file :
       {"density.pvd", "density/density_0000.pvti", "density/density_0002/0000.vti", "density/density_0002/0003.vti"})
    EXPECT_TRUE(fs::exists(folder / "pieces" / file)) << file;
  EXPECT_FALSE(fs::exists(folder / "pieces/density/density_0000.vti"));
  EXPECT_FALSE(fs::exists(folder / "pieces/density/density_0002/0004.vti"));
  EXPECT_NE(read_file(folder / "pieces/density.pvd").find("file=\"density/density_0002.pvti\""), std::string::npos);

  const Outcome same = gaussdrift_in(folder, "compare pieces whole --tolerance 1e-7");
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
  EXPECT_EQ(gaussdrift_in(folder, "compare whole pieces --tolerance 1e-7").exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder,
                          "compare pieces/density/density_0000.pvti pieces/density/density_0002.pvti "
                          "--tolerance 1e-3")
                .exit_code,
            5);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out other --set evaluate.piece_points=1500").exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder, "compare other pieces --tolerance 1e-7").exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder, "report pieces").exit_code, 0);

  // The numbers are those of the whole grid.
  const auto numbers = [&](const char* name) {
    return parsed_json(read_file(folder / name / "summary.json"))["frames"];
  };
  const auto whole = numbers("whole"), pieces = numbers("pieces");
  ASSERT_EQ(whole.size(), pieces.size());
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char* key : {"maximum", "minimum", "L1", "L2", "Linf"})
      EXPECT_NEAR(pieces[i][key].get<double>(), whole[i][key].get<double>(), 1e-7) << key;

  // Another run in its place takes all of it away.
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out pieces --force").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "pieces/density/density_0000.pvti"));
  EXPECT_FALSE(fs::exists(folder / "pieces/density/density_0000"));
  EXPECT_FALSE(fs::exists(folder / "pieces/earlier"));
  EXPECT_EQ(gaussdrift_in(folder, "compare pieces whole --tolerance 0").exit_code, 0);
}

TEST(DensityInPieces, IsGoneOnWithInTheSameFiles) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  const std::string small_steps = in_pieces + " --set time.step=0.0005";
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out whole" + small_steps).exit_code, 0);
  Outcome run = gaussdrift_in(folder, "run a.toml --out parts --stop-after 0.02" + small_steps);
  ASSERT_EQ(run.exit_code, 7) << run.err;
  ASSERT_EQ(gaussdrift_in(folder, "resume parts").exit_code, 0);
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "whole/density")) {
    if (!entry.is_regular_file()) continue;
    const fs::path other = folder / "parts/density" / fs::relative(entry.path(), folder / "whole/density");
    EXPECT_EQ(read_file(entry.path()), read_file(other)) << other;
    ++files;
  }
  EXPECT_EQ(files, 3u * (1 + 4));
  EXPECT_EQ(read_file(folder / "whole/density.pvd"), read_file(folder / "parts/density.pvd"));
}

TEST(ParticlesInPieces, AreWrittenGoneOnWithAndTakenAway) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  const std::string small_files = " --set output.piece_particles=100 --set time.step=0.0005";
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out whole" + small_files).exit_code, 0);
  const fs::path particles = folder / "whole/particles";
  EXPECT_TRUE(fs::exists(particles / "particles_0002.pvtp"));
  EXPECT_TRUE(fs::exists(particles / "particles_0002/0001.vtp"));
  EXPECT_FALSE(fs::exists(particles / "particles_0002.vtp"));
  EXPECT_NE(read_file(folder / "whole/particles.pvd").find("file=\"particles/particles_0002.pvtp\""),
            std::string::npos);
  Outcome run = gaussdrift_in(folder, "run a.toml --out parts --stop-after 0" + small_files);
  ASSERT_EQ(run.exit_code, 7) << run.err;
  ASSERT_EQ(gaussdrift_in(folder, "resume parts").exit_code, 0);
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(particles)) {
    if (!entry.is_regular_file()) continue;
    const fs::path other = folder / "parts/particles" / fs::relative(entry.path(), particles);
    EXPECT_EQ(read_file(entry.path()), read_file(other)) << other;
    ++files;
  }
  EXPECT_EQ(files, 3u * (1 + 2));
  EXPECT_EQ(gaussdrift_in(folder, "compare parts whole --tolerance 0").exit_code, 0);
  EXPECT_EQ(gaussdrift_in(folder, "report parts").exit_code, 0);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --out parts --force").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "parts/particles/particles_0000.pvtp"));
  EXPECT_FALSE(fs::exists(folder / "parts/particles/particles_0000"));
  EXPECT_TRUE(fs::exists(folder / "parts/particles/particles_0000.vtp"));
}

TEST(DensityInPieces, IsDrawn) {
  if (!draws_pictures) GTEST_SKIP() << without_pictures;
  const ScratchFolder folder;
  write_file(folder / "a.toml", scene);
  for (const std::string& more : {std::string(" --out whole"), " --out pieces" + in_pieces}) {
    const Outcome run = gaussdrift_in(
        folder, "run a.toml --set 'output.images=[\"heatmap\", \"error\"]' --set output.report=html" + more);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  for (const char* picture : {"heatmap_0002.png", "error_0002.png"}) {
    EXPECT_TRUE(fs::exists(folder / "pieces/images" / picture)) << picture;
  }
  EXPECT_TRUE(fs::exists(folder / "pieces/report.html"));
  const Outcome drawn = gaussdrift_in(folder, "render pieces --out drawn --style heatmap");
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(fs::exists(folder / "drawn/heatmap_0002.png"));
  EXPECT_EQ(gaussdrift_in(folder, "render pieces/density/density_0001.pvti --field error --out drawn").exit_code, 0);
}

TEST(DensityInPieces, NeedsBoundedMemory) {
  const ScratchFolder folder;
  const std::string large = case_text({.domain = "min = [0, 0, 0]\nmax = [4, 4, 0.4]",
                                       .velocity = at_rest.substr(0, at_rest.size() - 1) + ", \"0\"]",
                                       .density = shape_of("wendland", "2, 2, 0.2", "0.15"),
                                       .particles = "per_axis = 201",
                                       .time = "end = 1\nstep = 1",
                                       .evaluate = "per_axis = 4000",
                                       .output = "times = [1]\nimages = []\nreport = \"none\""});
  write_file(folder / "a.toml", large);
  const Outcome check = gaussdrift_in(folder, "check a.toml --json");
  ASSERT_EQ(check.exit_code, 0) << check.err;
  const auto forecast = parsed_json(check.out)["predicted"];
  const double memory = forecast["memory_bytes"].get<double>(), disk = forecast["disk_bytes"].get<double>();
  EXPECT_GT(disk, 4000. * 4000 * 400 * 10.6) << "four letters for three bytes";
  EXPECT_LT(disk, 4000. * 4000 * 400 * 10.6 * 1.05) << "layers that are written twice are few";
  EXPECT_LT(memory, 4e9);
  EXPECT_GT(memory, 5e8);
}

// ctest -L ranks-long: half a gigabyte is written.
TEST(DensityInPieces, DISABLED_OfAGridOfFourTimesTheMemoryIsWritten) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "sanitized";
#endif
  const ScratchFolder folder;
  // 64 million points, 512 MB.
  const std::string large = case_text({.density = shape_of("wendland", "0.3, 0.1", "0.3"),
                                       .particles = "per_axis = 401",
                                       .time = "end = 0.1\nstep = 0.1",
                                       .evaluate = "per_axis = 8000\npiece_points = 1000000",
                                       .output = "times = [0.1]\nimages = []\nvtk = [\"density\"]\nreport = \"none\""});
  write_file(folder / "a.toml", large);
  // Data of the program: 128 MB.
  const Outcome run = gaussdrift_in(folder, "run a.toml --threads 1", "ulimit -c 0; ulimit -d 125000;");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const fs::path density = folder / "output/a/density";
  double bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(density))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  EXPECT_GT(bytes, 8000. * 8000 * 10.6);
  const Outcome compared =
      gaussdrift_in(folder, "compare output/a output/a --tolerance 0", "ulimit -c 0; ulimit -d 125000;");
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
}

}  // namespace
}  // namespace gaussdrift
