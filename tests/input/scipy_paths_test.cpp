// Particles in a velocity on a grid go where an independent program takes them: SciPy, tests/reference/scipy-paths.py.
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "field/gridded/gridded.hpp"
#include "grid_files.hpp"
#include "sim/stepper.hpp"

#ifdef HAS_NETCDF
#include "netcdf_files.hpp"
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

  const std::vector<double> times_{0.0, 0.5, 1.0, 1.75, 2.0, 3.0};
  std::vector<double> x_, y_;
};

TEST_F(ScipyPaths, are_those_of_a_series_of_paraview) {
  write_pvd();
  EXPECT_LT(worst("wind.pvd"), 1e-8);
}

#ifdef HAS_NETCDF
TEST_F(ScipyPaths, are_those_of_netcdf_held_and_read_on_the_way) {
  write_netcdf();
  EXPECT_LT(worst("wind.nc"), 1e-8);
  EXPECT_LT(worst("wind.nc", 1), 1e-8);
}
#endif

}  // namespace
}  // namespace gaussdrift::input
