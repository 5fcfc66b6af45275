// Data on grids as a user meets them: winds with land, runs in long domains, files of two times, and what is said about
// files of other kinds.
#include <gtest/gtest.h>

#include <tuple>

#include "parsed_json.hpp"
#include "program.hpp"

namespace gaussdrift {
namespace {

/// A wind to the left on [-1, 1]^2 with land at x <= -0.5, marked as `mark`.
std::string wind(const std::string& mark) {
  std::string values;
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 9; ++i) values += i < 3 ? mark + " " + mark + " " : "-1 0 ";
  return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 8 0 8 0 "
         "0\" "
         "Origin=\"-1 -1 0\" Spacing=\"0.25 0.25 1\"><Piece Extent=\"0 8 0 8 0 0\"><PointData><DataArray "
         "type=\"Float64\" "
         "Name=\"wind\" NumberOfComponents=\"2\" format=\"ascii\">" +
         values + "</DataArray></PointData></Piece></ImageData></VTKFile>\n";
}

const std::string coast = case_text({.velocity = "file = \"wind.vti\"\noutside = \"clamp\"",
                                     .density = shape_of("wendland", "0.3, 0", "0.2"),
                                     .particles = "per_axis = 41",
                                     .time = "end = 2\nstep = 0.1",
                                     .reference = not_compared,
                                     .output = "frames = 2\nimages = []\nreport = \"none\""});

TEST(Wind, WithLandIsRefusedAndRunsWithTheRemediesThatAreOffered) {
  const ScratchFolder folder;
  write_file(folder / "coast.toml", coast);
  for (const char* mark : {"1e20", "nan", "-9999"}) {
    write_file(folder / "wind.vti", wind(mark));
    const Outcome refused = gaussdrift_in(folder, "run coast.toml --set velocity.missing=error");
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.err.find("wind of wind.vti has no value at (-1, -1): "), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("(27 of 81 values are missing)"), std::string::npos) << refused.err;
    for (const auto& [missing, from, to] : {std::tuple{"zero", -0.51, -0.25}, {"nearest", -1.71, -1.69}}) {
      const Outcome run =
          gaussdrift_in(folder, std::string("run coast.toml --force --set velocity.missing=") + missing);
      ASSERT_EQ(run.exit_code, 0) << run.err;
      const auto summary = parsed_json(read_file(folder / "output/coast/summary.json"));
      const double x = summary["frames"].back()["centroid"][0];  // started at 0.3, for 2 s at -1
      EXPECT_GT(x, from) << missing;                             // the coast stops it within the cell before -0.5
      EXPECT_LT(x, to) << missing;
    }
  }
}

TEST(Wind, WithLandRunsUntilAParticleReachesIt) {
  const ScratchFolder folder;
  write_file(folder / "coast.toml", coast);
  for (const char* mark : {"1e20", "nan", "-9999"}) {
    write_file(folder / "wind.vti", wind(mark));  // the coast is at x = -0.375
    EXPECT_EQ(gaussdrift_in(folder, "run coast.toml --force --set time.end=0.4").exit_code, 0);
    const Outcome ashore = gaussdrift_in(folder, "run coast.toml --force");
    EXPECT_EQ(ashore.exit_code, 4);
    for (const char* words : {"particle ", " at t = 0.", "has reached land, where wind of wind.vti has no value",
                              "domain.coast = \"stop\", \"slide\" or \"remove\""})
      EXPECT_NE(ashore.err.find(words), std::string::npos) << ashore.err;
    for (const auto& [rule, stopped] : {std::pair{"stop", true}, {"remove", false}}) {
      const Outcome run = gaussdrift_in(
          folder, std::string("run coast.toml --force --set domain.coast=") + rule + " --set output.report=html");
      ASSERT_EQ(run.exit_code, 0) << run.err;
      const auto summary = parsed_json(read_file(folder / "output/coast/summary.json"));
      const double mass = summary["frames"].front()["mass"];
      const auto last = summary["frames"].back();
      const double there = stopped ? last["stopped"]["mass"] : last["left"]["coast"]["mass"];
      EXPECT_NEAR(there, mass, 1e-12 * mass);
      if (stopped) {
        EXPECT_NEAR(double(last["centroid"][0]), -0.375, 1e-9);
      }
      const std::string head = read_file(folder / "output/coast/series.csv").substr(0, 300);
      EXPECT_NE(head.find(stopped ? ",inside,stopped," : ",inside,left_coast,"), std::string::npos) << head;
      EXPECT_NE(read_file(folder / "output/coast/report.html").find(stopped ? "stopped at the coast" : "left by coast"),
                std::string::npos);
    }
  }
}

TEST(Wind, ThatIsDamagedIsToldInTheProgramsOwnWordsAlone) {
  const ScratchFolder folder;
  write_file(folder / "coast.toml", coast);
  std::string damaged = wind("-1");
  damaged.resize(damaged.size() / 2);
  write_file(folder / "wind.vti", damaged);
  const Outcome run = gaussdrift_in(folder, "check coast.toml");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.err.rfind("error: wind.vti is ", 0), 0u) << run.err;  // nothing stands before
  for (const char* word : {"ERR|", "vtkXML", ".cxx"}) EXPECT_EQ(run.err.find(word), std::string::npos) << run.err;
}

TEST(Wind, ThatAParticleLeavesIsNamedWithTheAxisByEveryMethod) {
  const ScratchFolder folder;
  write_file(folder / "coast.toml", coast);
  write_file(folder / "wind.vti", wind("-1"));
  const std::string reason = " is outside of wind of wind.vti, which reaches from -1 to 1: say what stands there";
  for (const char* method : {"rk4", "dopri5"}) {
    const Outcome run = gaussdrift_in(
        folder, std::string("run coast.toml --force --set velocity.outside=error --set time.method=") + method);
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_NE(run.err.find("x = -1.0"), std::string::npos) << method << ": " << run.err;
    EXPECT_NE(run.err.find(reason), std::string::npos) << method << ": " << run.err;
  }
  const Outcome check = gaussdrift_in(
      folder, "check coast.toml --set velocity.outside=error --set domain.min=[-2,-1] --set density.center=[-1.2,0]");
  EXPECT_EQ(check.exit_code, 4);
  EXPECT_NE(check.err.find(reason), std::string::npos) << check.err;
}

TEST(Wind, OfAnotherKindIsAnsweredWithWhatIsPossible) {
  const ScratchFolder folder;
  for (const char* kind : {"h5", "png", "vtu"}) {
    write_file(folder / (std::string("wind.") + kind), "data");
    std::string text = coast;
    text.replace(text.find("wind.vti"), 8, std::string("wind.") + kind);
    write_file(folder / "coast.toml", text);
    const Outcome run = gaussdrift_in(folder, "check coast.toml");
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.err.find("ParaView opens the "), std::string::npos) << run.err;
  }
  EXPECT_NE(gaussdrift_in(folder, "run wind.h5").err.find("wind.h5 is not a case but data; ParaView opens"),
            std::string::npos);
  write_file(folder / "wind.nc", "data");
  EXPECT_NE(gaussdrift_in(folder, "run wind.nc").err.find("wind.nc is data on a grid, not a case"), std::string::npos);
  EXPECT_NE(gaussdrift_in(folder, "compare wind.png wind.png").err.find("ParaView opens the picture"),
            std::string::npos);
  write_file(folder / "a.toml", small_case);
  for (const char* out : {"run a.toml --out a.nc", "run a.toml --out a.png", "study a.toml --out a.pdf",
                          "render a --out a.png", "sum --sources a.csv --sigma 1 --out a.nc"}) {
    const Outcome run = gaussdrift_in(folder, out);
    EXPECT_EQ(run.exit_code, 2) << out;
    EXPECT_NE(run.err.find("such as a"), std::string::npos) << run.err;
  }
}

TEST(Evaluation, OfALongDomainHasASpacing) {
  const ScratchFolder folder;
  std::string text = coast;
  text.replace(text.find("max = [1, 1]"), 12, "max = [99, 1]");
  text.replace(text.find("file = \"wind.vti\"\noutside = \"clamp\""), 35, "u = [\"1\", \"0\"]");
  text.replace(text.find("per_axis = 41"), 13, "per_axis = 1001");
  write_file(folder / "long.toml", text);
  const Outcome narrow = gaussdrift_in(folder, "check long.toml");
  EXPECT_EQ(narrow.exit_code, 0);
  EXPECT_NE(narrow.err.find("the evaluation lattice has 21 x 1 points, only 1 along y"), std::string::npos)
      << narrow.err;
  EXPECT_NE(narrow.err.find("spacing = 0.1 instead of per_axis has 1001 x 21 points"), std::string::npos) << narrow.err;
  const Outcome spaced = gaussdrift_in(folder, "run long.toml --set evaluate.spacing=0.1");
  EXPECT_EQ(spaced.exit_code, 0) << spaced.err;
  EXPECT_NE(read_file(folder / "output/long/density/density_0000.vti").find("WholeExtent=\"0 1000 0 20 0 0\""),
            std::string::npos);
  EXPECT_NE(read_file(folder / "output/long/run.toml").find("spacing = 0.1"), std::string::npos);
  EXPECT_EQ(gaussdrift_in(folder, "run output/long/run.toml --out again").exit_code, 0);
  for (const auto& [value, message] : {std::pair{"0", "evaluate.spacing must be greater than 0"},
                                       {"101", "is longer than the domain, 100"},
                                       {"1e-6", "the evaluation lattice would have 2e+14 points"}}) {
    const Outcome run = gaussdrift_in(folder, std::string("check long.toml --set evaluate.spacing=") + value);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  }
  text.replace(text.find("per_axis = 21"), 13, "per_axis = 21\nspacing = 0.1");
  write_file(folder / "both.toml", text);
  EXPECT_NE(gaussdrift_in(folder, "check both.toml").err.find("[evaluate] has both \"per_axis\" and \"spacing\""),
            std::string::npos);
}

TEST(Compare, OfFilesOfTwoTimesWarns) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  ASSERT_EQ(gaussdrift_in(folder, "run a.toml --set output.images=[] --set output.report=none").exit_code, 0);
  const Outcome files =
      gaussdrift_in(folder, "compare output/a/density/density_0000.vti output/a/density/density_0001.vti --json");
  EXPECT_EQ(files.exit_code, 0) << files.err;
  EXPECT_NE(files.err.find("warning: the times differ: output/a/density/density_0000.vti is at t = 0"),
            std::string::npos)
      << files.err;
  const auto report = parsed_json(files.out);
  EXPECT_EQ(report["outputs"][0]["t"], 0);
  EXPECT_GT(report["outputs"][0]["t_second"], 0);
  EXPECT_GT(report["outputs"][0]["Linf"], 0.1);
  EXPECT_EQ(gaussdrift_in(folder, "compare output/a/density/density_0000.vti output/a/density/density_0000.vti").err,
            "");
}

TEST(Results, OfGridsWithOneNodeOnAnAxisAreRead) {
  for (const char* domain : {"min = [-1, -1, 0]\nmax = [1, 1, 0.01]", "min = [0, -1, -1]\nmax = [0.01, 1, 1]",
                             "min = [-1, 0, -1]\nmax = [1, 0.01, 1]"}) {
    const ScratchFolder folder;
    write_file(folder / "thin.toml", case_text({.domain = domain,
                                                .velocity = velocity_of({"0.1", "0.1", "0.1"}),
                                                .density = "expression = \"exp(-9*(x^2 + y^2 + z^2))\"",
                                                .time = "end = 0.1\nstep = 0.1",
                                                .reference = not_compared,
                                                .output = "frames = 2\nimages = []"}));
    const bool reports = std::string(domain).find("[0, ") != std::string::npos;  // a page has pictures too
    const Outcome run = gaussdrift_in(folder, "run thin.toml --set output.report=none");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    for (const char* verb : {reports ? "report output/thin" : "render output/thin --times 0 --out pictures",
                             "compare output/thin output/thin",
                             "compare output/thin/density/density_0000.vti output/thin/density/density_0001.vti"}) {
      if (!draws_pictures && std::string(verb).starts_with("render")) continue;
      const Outcome look = gaussdrift_in(folder, verb);
      EXPECT_EQ(look.exit_code, 0) << domain << "\n" << verb << "\n" << look.out << look.err;
    }
  }
}

}  // namespace
}  // namespace gaussdrift
