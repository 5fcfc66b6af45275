// Particles in a velocity on a grid go where an independent program takes them: SciPy, tests/reference/scipy-paths.py.
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "case_text.hpp"
#include "field/gridded/gridded.hpp"
#include "gaussdrift/simulation.hpp"
#include "grid_files.hpp"
#include "sim/stepper.hpp"
#include "write/track_files.hpp"

#ifdef HAS_NETCDF
#include "netcdf_files.hpp"
#include "read/netcdf/netcdf_file.hpp"
#endif

namespace gaussdrift::input {
namespace {

class ScipyPaths : public GridFile {
 protected:
  ScipyPaths() {
    for (int i = 0; i < 13; ++i) x_.push_back(2.0 * (i / 12. + 0.02 * (i % 3)) / 1.04);
    for (int j = 0; j < 9; ++j) y_.push_back(j / 8.);
  }

  /// As in the script.
  std::vector<double> sampled_at(double t, int component) const {
    std::vector<double> values;
    for (const double y : y_)
      for (const double x : x_) {
        const double phase = std::numbers::pi * (x + 0.1 * std::sin(2 * t));
        values.push_back(component == 0 ? -std::sin(phase) * std::cos(std::numbers::pi * y)
                                        : std::cos(phase) * std::sin(std::numbers::pi * y));
      }
    return values;
  }

  static std::string text(const std::vector<double>& numbers) {
    std::string all;
    for (const double number : numbers) all += fmt::format("{}{:.17g}", all.empty() ? "" : " ", number);
    return all;
  }

  void write_pvd() const {
    std::string entries;
    for (std::size_t s = 0; s < times_.size(); ++s) {
      const std::string name = fmt::format("wind_{}.vtr", s);
      write_vtr(name, text(x_), text(y_),
                data(array("u", 1, text(sampled_at(times_[s], 0))) + array("v", 1, text(sampled_at(times_[s], 1)))));
      entries += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>", times_[s], name);
    }
    write_series("wind.pvd", entries);
  }

#ifdef HAS_NETCDF
  void write_netcdf() const {
    NetcdfWriter file(folder_ / "wind.nc");
    file.dimension("time", 0);
    file.dimension("y", y_.size());
    file.dimension("x", x_.size());
    for (const char* name : {"time", "y", "x"}) file.variable(name, NC_DOUBLE, {name});
    for (const char* name : {"u", "v"}) file.variable(name, NC_DOUBLE, {"time", "y", "x"});
    file.values("x", x_);
    file.values("y", y_);
    file.values("time", times_, times_.size());
    for (const int component : {0, 1}) {
      std::vector<double> all;
      for (const double t : times_) {
        const std::vector<double> some = sampled_at(t, component);
        all.insert(all.end(), some.begin(), some.end());
      }
      file.values(component == 0 ? "u" : "v", all, times_.size());
    }
  }
#endif

  /// The largest distance of a particle from where SciPy brings it.
  double worst(const std::string& name, double most_held = read::most_bytes_held) const {
    const auto data = read::read_grid(folder_ / name, {.arrays = {"u", "v"},
                                                       .least_components = 2,
                                                       .most_components = 2,
                                                       .times_at_once = 4,
                                                       .most_held = most_held});
    double worst = 0;
    for (const Interpolation order : {Interpolation::linear, Interpolation::cubic}) {
      const GriddedVelocity velocity(GridInterpolator(data, order, Outside::error, order));
      Particles particles;
      particles.dimension = 2;
      std::vector<std::array<double, 2>> ends;
      std::ifstream table(std::string(REFERENCE_DIR) + "/scipy-paths.csv");
      for (std::string line; std::getline(table, line);) {
        const std::string kind(interpolation_names[static_cast<std::size_t>(order)]);
        if (line.rfind(kind + ",", 0) != 0) continue;
        std::array<double, 4> numbers{};
        std::size_t at = kind.size();
        for (double& number : numbers) {
          number = std::stod(line.substr(at + 1));
          at = line.find(',', at + 1);
        }
        for (std::size_t k = 0; k < 2; ++k) particles.position[k].push_back(numbers[k]);
        particles.alpha.push_back(1);
        particles.id.push_back(static_cast<std::int64_t>(ends.size()));
        ends.push_back({numbers[2], numbers[3]});
      }
      EXPECT_EQ(ends.size(), 5u);
      // A kink costs the jump of the slope times the square of a step.
      const double step = order == Interpolation::linear ? 1e-4 : 1e-3;
      const time::Interval interval(0, 3, step);
      Stepper(velocity, time::find_tableau("rk4"), 1).advance(particles, interval, 0, interval.steps(), 0);
      for (std::size_t j = 0; j < ends.size(); ++j)
        worst =
            std::max(worst, std::hypot(particles.position[0][j] - ends[j][0], particles.position[1][j] - ends[j][1]));
    }
    return worst;
  }

  /// The same in the tables of tracks of a run. Points have no weight; the density is elsewhere.
  double worst_in_tracks(const std::string& name) const {
    double worst = 0;
    for (const std::string order : {"linear", "cubic"}) {
      std::ofstream points(folder_ / "points.csv");
      points << "x,y\n";
      std::vector<std::array<double, 2>> ends;
      std::ifstream table(std::string(REFERENCE_DIR) + "/scipy-paths.csv");
      for (std::string line; std::getline(table, line);) {
        if (line.rfind(order + ",", 0) != 0) continue;
        std::istringstream cells(line.substr(order.size() + 1));
        std::array<std::string, 4> cell;
        for (std::string& one : cell) std::getline(cells, one, ',');
        points << cell[0] << "," << cell[1] << "\n";
        ends.push_back({std::stod(cell[2]), std::stod(cell[3])});
      }
      points.close();
      const std::string text =
          case_text({.domain = "min = [0, 0]\nmax = [2, 1]",
                     .velocity = fmt::format("file = \"{}\"\narrays = [\"u\", \"v\"]\ninterpolation = \"{}\"\n"
                                             "time_interpolation = \"{}\"\noutside = \"clamp\"",
                                             (folder_ / name).string(), order, order),
                     .density = shape_of("wendland", "1, 0.5", "0.2"),
                     .particles = "per_axis = 11",
                     .time = std::string("end = 3\nstep = ") + (order == "linear" ? "1e-4" : "1e-3"),
                     .evaluate = "per_axis = 11",
                     .reference = not_compared,
                     .output = "times = [3]\nvtk = []\nimages = []\nreport = \"none\"\n[output.tracks]\nsteps = 7000\n"
                               "points = \"points.csv\"\nfiles = [\"netcdf\"]"});
      const Case spec = parse_case(text, folder_ / "scene.toml").spec;
      Simulation simulation(spec, 1);
      simulation.observe(write::track_writer(folder_.path(), spec));
      simulation.run();
      worst = std::max(worst, farthest(folder_ / "tracks.csv", ends));
#ifdef HAS_NETCDF  // the library reads what is written without it
      const read::NetcdfFile file(folder_ / "tracks.nc");
      const std::vector<double> x = file.read_all(*file.find("x")), id = file.read_all(*file.find("trajectory"));
      EXPECT_EQ(id, (std::vector<double>{-5, -4, -3, -2, -1}));
      EXPECT_LT(std::abs(x.back() - ends.front()[0]), 1e-8);
#endif
    }
    return worst;
  }

  /// Of the last row of each track from where it should be.
  static double farthest(const std::filesystem::path& tracks, const std::vector<std::array<double, 2>>& ends) {
    double worst = 0;
    std::size_t arrived = 0;
    std::ifstream rows(tracks);
    for (std::string row; std::getline(rows, row);) {
      std::istringstream cells(row);
      std::array<std::string, 4> cell;
      for (std::string& one : cell) std::getline(cells, one, ',');
      if (cell[1] != "3") continue;
      const auto& end = ends.at(static_cast<std::size_t>(-std::stoi(cell[0])) - 1);
      worst = std::max(worst, std::hypot(std::stod(cell[2]) - end[0], std::stod(cell[3]) - end[1]));
      ++arrived;
    }
    EXPECT_EQ(arrived, 5u);
    return worst;
  }

  const std::vector<double> times_{0.0, 0.5, 1.0, 1.75, 2.0, 3.0};
  std::vector<double> x_, y_;
};

TEST_F(ScipyPaths, are_those_of_a_series_of_paraview) {
  write_pvd();
  EXPECT_LT(worst("wind.pvd"), 1e-8);
  EXPECT_LT(worst_in_tracks("wind.pvd"), 1e-8);
}

#ifdef HAS_NETCDF
TEST_F(ScipyPaths, are_those_of_netcdf_held_and_read_on_the_way) {
  write_netcdf();
  EXPECT_LT(worst("wind.nc"), 1e-8);
  EXPECT_LT(worst("wind.nc", 1), 1e-8);
  EXPECT_LT(worst_in_tracks("wind.nc"), 1e-8);
}
#endif

}  // namespace
}  // namespace gaussdrift::input
