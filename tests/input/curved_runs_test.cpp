// Curvilinear grids in whole runs: series of .vts, binary files, values that are missing, threads and ranks.
#include <cmath>
#include <cstring>
#include <numbers>

#include "field/gridded/gridded.hpp"
#include "gaussdrift/simulation.hpp"
#include "grid_files.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"

namespace gaussdrift::input {
namespace {

/// Radii from 0.2 to 2 and all angles but a slit on the left: polar coordinates, 19 x 41 points.
Vector ring(int a, int b) {
  const double r = 0.2 + 0.1 * a, angle = (-0.95 + 1.9 * b / 40) * std::numbers::pi;
  return {r * std::cos(angle), r * std::sin(angle), 0};
}
constexpr int radii = 19, angles = 41;

/// A velocity at a place.
using Flow = Vector (*)(const Vector& x);
Vector rotation(const Vector& x) { return {-x[1], x[0], 0}; }
Vector outwards(const Vector& x) { return {x[0], x[1], 0}; }

/// How the numbers stand in the file.
enum class Form { text, binary, appended };

class CurvedRun : public GridFile {
 protected:
  void write_ring(const std::string& name, Flow flow, Form form = Form::text,
                  const std::string& missing_at_5 = "") const {
    std::vector<double> places, values;
    for (int b = 0; b < angles; ++b)
      for (int a = 0; a < radii; ++a) {
        const Vector x = ring(a, b), u = flow(x);
        places.insert(places.end(), x.begin(), x.end());
        values.insert(values.end(), u.begin(), u.end());
      }
    std::string appended;
    const auto written = [&](const std::string& array_name, const std::vector<double>& numbers) {
      const std::string head =
          fmt::format("<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"3\" format=\"", array_name);
      if (form == Form::text) {
        std::string text;
        for (std::size_t i = 0; i < numbers.size(); ++i)
          text += array_name == "u" && i / 3 == 5 && !missing_at_5.empty() ? missing_at_5 + " "
                                                                           : fmt::format("{} ", numbers[i]);
        return head + "ascii\">" + text + "</DataArray>";
      }
      const std::uint64_t bytes = 8 * numbers.size();
      std::string raw(8 + bytes, '\0');
      std::memcpy(raw.data(), &bytes, 8);
      std::memcpy(raw.data() + 8, numbers.data(), bytes);
      if (form == Form::binary) return head + "binary\">" + in_base64(raw) + "</DataArray>";
      appended += raw;
      return head + fmt::format("appended\" offset=\"{}\"/>", appended.size() - raw.size());
    };
    const std::string inside = data(written("u", values)) + "<Points>" + written("places", places) + "</Points>";
    std::ofstream(folder_ / name, std::ios::binary) << fmt::format(
        "<VTKFile type=\"StructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
        "<StructuredGrid WholeExtent=\"{0}\"><Piece Extent=\"{0}\">{1}</Piece></StructuredGrid>{2}</VTKFile>\n",
        fmt::format("0 {} 0 {} 0 0", radii - 1, angles - 1), inside,
        form == Form::appended ? "<AppendedData encoding=\"raw\">\n_" + appended + "</AppendedData>" : "");
  }

  Case spec_of(const std::string& file, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> overrides{"time.end=0.6",   "output.times=[0, 0.6]",       "output.images=[]",
                                       "output.vtk=[]",  "particles.per_axis=301",      "evaluate.per_axis=61",
                                       "time.step=0.02", "evaluate.tile_particles=200", "density.center=[0.9, 0.1]"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return parse_case(case_with("file = \"" + file + "\""), folder_ / "ring.toml", overrides).spec;
  }
  static Particles end_of(const Case& spec, int threads = 1) {
    Simulation simulation(spec, threads);
    simulation.run();
    return simulation.particles();
  }
};

TEST_F(CurvedRun, CarriesParticlesWhereTheFlowGoes) {
  // A linear flow is linear in every cell, so that the data miss nothing and only the steps do.
  write_ring("wind.vts", rotation);
  const Case spec = spec_of("wind.vts");
  Simulation simulation(spec, 2);
  simulation.prepare();
  const Particles start = simulation.particles();
  const RunSummary summary = simulation.run();
  const Particles& end = simulation.particles();
  ASSERT_GT(end.size(), 1000u);
  for (std::size_t j = 0; j < end.size(); ++j) {
    const double x = start.position[0][j], y = start.position[1][j];
    EXPECT_NEAR(end.position[0][j], x * std::cos(0.6) - y * std::sin(0.6), 1e-9);  // rk4: 0.6 * 0.02^4 / 120
    EXPECT_NEAR(end.position[1][j], x * std::sin(0.6) + y * std::cos(0.6), 1e-9);
  }
  expect_same(end, end_of(spec, 1));
  expect_same(end, end_of(spec, 3));
  on_ranks(2, [&](base::Communicator& ranks) {
    Simulation shared(spec, 1, ranks);
    const RunSummary of_ranks = shared.run();
    EXPECT_EQ(of_ranks.frames.back().second.maximum, summary.frames.back().second.maximum);
    EXPECT_EQ(of_ranks.frames.back().second.centroid, summary.frames.back().second.centroid);
  });
}

TEST_F(CurvedRun, ReadsBinaryFilesAsItReadsText) {
  write_ring("text.vts", rotation);
  write_ring("binary.vts", rotation, Form::binary);
  write_ring("appended.vts", rotation, Form::appended);
  const auto text = read::read_grid(folder_ / "text.vts", vector_of());
  for (const char* name : {"binary.vts", "appended.vts"}) {
    const auto other = read::read_grid(folder_ / name, vector_of());
    EXPECT_EQ(other->values, text->values) << name;
    EXPECT_TRUE(other->curved->same_places(*text->curved));
  }
}

TEST_F(CurvedRun, InterpolatesBetweenTheTimesOfASeries) {
  write_ring("first.vts", rotation);
  write_ring("last.vts", outwards, Form::binary);
  write_series("wind.pvd", "<DataSet timestep=\"0\" file=\"first.vts\"/><DataSet timestep=\"2\" file=\"last.vts\"/>");
  const auto data = read::read_grid(folder_ / "wind.pvd", vector_of());
  EXPECT_EQ(data->times, (std::vector<double>{0, 2}));
  const GriddedVelocity wind(GridInterpolator(data, Interpolation::linear, Outside::error));
  const double x = 0.6, y = 0.7, t = 0.5;
  double u = 0, v = 0;
  PointsView at{2, 1, {}};
  at.axis[0] = &x, at.axis[1] = &y;
  VectorsView to{2, 1, {}};
  to.axis[0] = &u, to.axis[1] = &v;
  wind.add(t, at, to);
  EXPECT_NEAR(u, 0.75 * -y + 0.25 * x, 1e-14);
  EXPECT_NEAR(v, 0.75 * x + 0.25 * y, 1e-14);
  EXPECT_GT(end_of(spec_of("wind.pvd")).size(), 1000u);
  // Points that move are refused.
  std::string moved;
  std::getline(std::ifstream(folder_ / "first.vts"), moved, '\0');
  moved.replace(moved.find(fmt::format("{} ", ring(0, 0)[0]), moved.find("<Points>")), 5, "-0.21");
  std::ofstream(folder_ / "moved.vts") << moved;
  write_series("wind.pvd", "<DataSet timestep=\"0\" file=\"first.vts\"/><DataSet timestep=\"2\" file=\"moved.vts\"/>");
  EXPECT_NE(refusal("wind.pvd", vector_of()).find("the grid of moved.vts differs from that of first.vts"),
            std::string::npos);
}

TEST_F(CurvedRun, PutsValuesWhereNoneAre) {
  write_ring("holes.vts", rotation, Form::text, "nan");
  EXPECT_NE(refusal("holes.vts", vector_of()).find("has no value at (-0.691382, -0.109504): nan"), std::string::npos)
      << refusal("holes.vts", vector_of());
  const auto zero = read::read_grid(folder_ / "holes.vts", vector_of("", read::Missing::zero));
  EXPECT_EQ(zero->values[0][15], 0);
  EXPECT_EQ(zero->values[0][16], 0);
  // The mean of the neighbours along the lines of the grid: point 5 has 4, 6, and 24, in the next row.
  const auto nearest = read::read_grid(folder_ / "holes.vts", vector_of("", read::Missing::nearest));
  double mean = 0;
  for (const auto& [a, b] : {std::pair{4, 0}, {6, 0}, {5, 1}}) mean += rotation(ring(a, b))[0] / 3;
  EXPECT_NEAR(nearest->values[0][15], mean, 1e-15);
  EXPECT_EQ(end_of(spec_of("holes.vts", {"velocity.missing=nearest"})).size(),
            end_of(spec_of("holes.vts", {"velocity.missing=zero"})).size());
}

TEST_F(CurvedRun, TellsThatItsPlacesCostMore) {
  write_ring("wind.vts", rotation);
  const auto curved = read::read_grid(folder_ / "wind.vts", vector_of());
  auto plain = std::make_shared<GridData>(*curved);
  plain->curved = nullptr;
  const auto velocity_of = [](std::shared_ptr<const GridData> data) {
    return GriddedVelocity(GridInterpolator(std::move(data), Interpolation::linear, Outside::error)).cost();
  };
  EXPECT_GT(velocity_of(curved), 3 * velocity_of(plain));
}

}  // namespace
}  // namespace gaussdrift::input
