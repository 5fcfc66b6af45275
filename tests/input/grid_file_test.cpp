// Velocities and densities from ParaView files: what is read, and the promised message for everything wrong with a
// file.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "field/gridded/gridded.hpp"
#include "gaussdrift/simulation.hpp"
#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

TEST_F(GridFile, OfADensityCoversTheDomainOrSaysWhatStandsBeyond) {
  write_vti("rho.vti", 3, 3, 1, "rho", 1, "1 1 1 1 1 1 1 1 1 ");
  const auto refusal_with = [&](const std::string& outside, const std::string& override) -> std::string {
    const std::string shape = "shape = \"wendland\"\ncenter = [0.5, 0]\nradius = \"R\"\nheight = 1.5";
    const std::string file = "file = \"rho.vti\"\noutside = \"" + outside + "\"";
    try {
      parse_case(with(cone, shape, file), folder_ / "cone.toml", {override, "output.times=[0]"});
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal_with("error", "domain.max=[1,1]"), "");
  EXPECT_EQ(refusal_with("zero", "domain.max=[1,1.0000001]"), "");
  const std::string text = refusal_with("error", "domain.max=[1,1.0000001]");
  EXPECT_NE(text.find("rho of rho.vti reaches from -1 to 1 along y, the domain from -1 to 1.0000001"),
            std::string::npos)
      << text;
}

constexpr auto turning = [](double x, double y) { return std::pair(-y, x); };

TEST_F(GridFile, IsReadAndSurvivesTheWayToAFileAndBack) {
  write_vti("wind.vti", 5, 5, 1, "u", 2, sampled(5, turning));
  const Case scene = parse_case(case_with("file = \"wind.vti\"\noutside = \"clamp\""), folder_ / "cone.toml").spec;
  const auto& spec = std::get<FileVelocitySpec>(scene.velocity.at(0));
  EXPECT_EQ(spec.outside, "clamp");
  EXPECT_EQ(spec.interpolation, "linear");
  ASSERT_TRUE(spec.data);
  EXPECT_EQ(spec.data->points(), 25u);
  EXPECT_EQ(spec.data->values[0][0], 1);
  EXPECT_EQ(spec.data->values[0][1], -1);
  const Case again = parse_case(case_text(scene), "/elsewhere/run.toml").spec;  // the path is absolute
  EXPECT_EQ(std::get<FileVelocitySpec>(again.velocity.at(0)).data->values, spec.data->values);
}

TEST_F(GridFile, MayBeRectilinear) {
  // u = (x y, x - y) at uneven points: bilinear interpolation gives it back everywhere.
  const std::vector<double> xs{-1, -0.7, 0.1, 1}, ys{-1, 0.25, 1};
  std::ostringstream u, x_text, y_text;
  u.precision(17);
  for (const double y : ys)
    for (const double x : xs) u << x * y << " " << x - y << " 0 ";
  for (const double x : xs) x_text << x << " ";
  for (const double y : ys) y_text << y << " ";
  const auto axis = [](const char* name, const std::string& values) {
    return std::string("<DataArray type=\"Float64\" Name=\"") + name + "\" format=\"ascii\">" + values + "</DataArray>";
  };
  std::ofstream(folder_ / "wind.vtr")
      << "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><RectilinearGrid "
         "WholeExtent=\"0 3 0 2 0 0\"><Piece Extent=\"0 3 0 2 0 0\"><PointData><DataArray type=\"Float64\" "
         "Name=\"u\" NumberOfComponents=\"3\" format=\"ascii\">"
      << u.str() << "</DataArray></PointData><Coordinates>" << axis("x", x_text.str()) << axis("y", y_text.str())
      << axis("z", "0") << "</Coordinates></Piece></RectilinearGrid></VTKFile>\n";
  const Case scene = parse_case(case_with("file = \"wind.vtr\""), folder_ / "cone.toml").spec;
  const auto& data = std::get<FileVelocitySpec>(scene.velocity.at(0)).data;
  EXPECT_EQ(data->axis[0], xs);
  EXPECT_EQ(data->axis[1], ys);
  const GriddedVelocity field(GridInterpolator(data, Interpolation::linear, Outside::error));
  for (const auto& [x, y] : {std::pair{-0.9, 0.9}, {0.0, 0.0}, {0.3, -0.2}, {1.0, 1.0}}) {
    double sums[] = {0, 0}, divergence = 0;
    const PointsView at{2, 1, {&x, &y, nullptr}};
    field.add(0, at, {2, 1, {&sums[0], &sums[1], nullptr}});
    EXPECT_NEAR(sums[0], x * y, 1e-15);  // roundings of numbers up to 2
    EXPECT_NEAR(sums[1], x - y, 1e-15);
    field.add_divergence(0, at, &divergence);
    EXPECT_NEAR(divergence, y - 1, 7e-16);
  }
}

TEST_F(GridFile, IsNamedWhereAParticleLeavesIt) {
  write_vti("wind.vti", 3, 3, 1, "u", 2, sampled(3, [](double, double) { return std::pair(1., 0.); }));
  const Case scene = parse_case(case_with("file = \"wind.vti\""), folder_ / "cone.toml",
                                {"time.end=1", "output.times=[0, 1]", "reference.kind=none"})
                         .spec;
  try {
    Simulation(scene).run();
    FAIL() << "the cone has left the grid";
  } catch (const NumericalError& error) {
    const std::string text = error.what();
    for (const char* part : {"for particle", "at t = 0.", "is outside of u of wind.vti, which reaches from -1 to 1",
                             "outside = \"clamp\" or \"zero\""})
      EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  }
}

TEST_F(GridFile, IsReadFromASeriesAndInSpace) {
  write_vti("a.vti", 3, 3, 1, "u", 2, sampled(3, [](double, double) { return std::pair(0., 1.); }));
  write_vti("b.vti", 3, 3, 1, "u", 2, sampled(3, [](double, double) { return std::pair(4., 1.); }));
  write_series("wind.pvd", "<DataSet timestep=\"0\" file=\"a.vti\"/><DataSet timestep=\"2\" file=\"b.vti\"/>");
  const auto data = read::read_grid(folder_ / "wind.pvd", vector_of("u"));
  EXPECT_EQ(data->times, (std::vector<double>{0, 2}));
  const GridInterpolator grid(data, Interpolation::linear, Outside::error);
  const double x = 0.3, y = 0.1;
  double u = 0, v = 0;
  double* sums[] = {&u, &v};
  grid.add(0.5, {2, 1, {&x, &y, nullptr}}, 2, sums);
  EXPECT_NEAR(u, 1, 1e-15);
  EXPECT_NEAR(v, 1, 1e-15);
  write_vti("solid.vti", 2, 2, 2, "rho", 1, "0 1 2 3 4 5 6 7");
  EXPECT_EQ(read::read_grid(folder_ / "solid.vti", {.dimension = 3})->values[0][5], 5);
}

TEST_F(GridFile, ThatCannotBeUsedIsRefusedWithItsPlaceInTheCase) {
  write_vti("wind.vti", 3, 3, 1, "u", 2, sampled(3, turning));
  write_vti("hole.vti", 3, 3, 1, "u", 2, "0 0 0 0 0 0 0 0 0 nan 0 0 0 0 0 0 0 0");
  write_vti("thick.vti", 2, 2, 2, "u", 2, "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0");
  write_vti("rho.vti", 2, 2, 1, "rho", 1, "0 0 0 0");
  std::ofstream(folder_ / "damaged.vti")
      << "<VTKFile type=\"ImageData\" version=\"1.0\"><ImageData WholeExtent=\"0 1 0";
  for (const char* name : {"text.txt", "wind.nc", "wind.h5", "wind.png"}) std::ofstream(folder_ / name) << "u v\n";
  write_series("empty.pvd", "");
  write_series("lost.pvd", "<DataSet timestep=\"0\" file=\"nowhere.vti\"/>");
  write_series("back.pvd",
               "<DataSet timestep=\"0.5\" file=\"wind.vti\"/><DataSet timestep=\"1\" file=\"wind.vti\"/><DataSet "
               "timestep=\"0\" file=\"wind.vti\"/>");
  write_series("short.pvd", "<DataSet timestep=\"0\" file=\"wind.vti\"/><DataSet timestep=\"0.5\" file=\"wind.vti\"/>");
  write_series("mixed.pvd", "<DataSet timestep=\"0\" file=\"wind.vti\"/><DataSet timestep=\"1\" file=\"other.vti\"/>");
  write_vti("other.vti", 4, 4, 1, "u", 2, sampled(4, turning));
  const struct {
    const char *velocity, *message;
  } refusals[] = {
      {"file = \"nowhere.vti\"", "error: there is no file "},
      {"file = \"nowhere.vti\"", "   = paths are relative to the folder of the case file"},
      {"file = 3", "velocity.file must be the name of a file in a string, found the number 3"},
      {"file = \"wind.vti\"\narray = \"v\"", "wind.vti has no array \"v\"; it has \"u\""},
      {"file = \"wind.vti\"\noutside = \"clam\"",
       "unknown value \"clam\" for velocity.outside; did you mean \"clamp\"?"},
      {"file = \"wind.vti\"\ninterpolation = \"cubc\"", "did you mean \"cubic\"?"},
      {"file = \"hole.vti\"\nmissing = \"error\"",
       "u of hole.vti has no value at (0, 0): nan is there (1 of 9 values are missing)"},
      {"file = \"thick.vti\"", "the grid of thick.vti has 2 x 2 x 2 points, but the domain has 2 dimensions"},
      {"file = \"rho.vti\"", "the array \"rho\" of rho.vti has 1 component, needed: 2 or 3"},
      {"file = \"damaged.vti\"", "damaged.vti is "},
      {"file = \"wind.nc\"", "wind.nc is "},
      {"file = \"wind.h5\"", "ParaView opens the file: apply its filter Resample To Image and save the data as .vti"},
      {"file = \"wind.png\"", "ParaView opens the picture as image data: save it as .vti"},
      {"file = \"text.txt\"", "text.txt has the ending \".txt\""},
      {"file = \"empty.pvd\"", "the series empty.pvd is empty"},
      {"file = \"lost.pvd\"", "nowhere.vti, which line 1 of lost.pvd names for t = 0"},
      {"file = \"back.pvd\"", "the times of back.pvd do not ascend: 0 after 1"},
      {"file = \"short.pvd\"", "u of short.pvd covers the times 0 to 0.5, but the run goes from 0 to 1"},
      {"file = \"mixed.pvd\"", "the grid of other.vti differs from that of wind.vti"},
  };
  for (const auto& refusal : refusals) {
    const std::string found = message(refusal.velocity);
    EXPECT_NE(found.find(refusal.message), std::string::npos) << refusal.velocity << "\n" << found;
    EXPECT_NE(found.find("cone.toml:1"), std::string::npos) << found;
  }
  EXPECT_EQ(message("file = \"wind.vti\""), "");
}

}  // namespace
}  // namespace gaussdrift::input
