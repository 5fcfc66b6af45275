// What the interpolation of a velocity adds to the error: half of the data tell it for all of them.
#include "accuracy/interpolation.hpp"

#include <cmath>
#include <numbers>

#include "accuracy/carrying.hpp"
#include "field/gridded/every_second.hpp"
#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

class InterpolationError : public GridFile {
 protected:
  static constexpr double end = 1;

  /// A vortex that grows with 2 t - t^2, so that lines miss some of it between points and between times; on n x n points at `times` times; its formula.
  void write_vortex(int n, int times) const {
    std::string entries;
    for (int s = 0; s < times; ++s) {
      const double t = end * s / std::max(1, times - 1);
      const std::string name = fmt::format("vortex_{}.vti", s);
      write_vti(name, n, n, 1, "u", 2, sampled(n, [&](double x, double y) {
                  const double growth = 1 + 2 * t - t * t;
                  return std::pair(-growth * std::sin(2 * y), growth * std::sin(2 * x));
                }));
      entries += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>", t, name);
    }
    write_series("vortex.pvd", entries);
  }

  Case read(const std::string& velocity) const {
    return parse_case(
               case_with(velocity), folder_ / "cone.toml",
               {"time.end=1", "time.step=0.01", "output.times=[1]", "particles.per_axis=40", "evaluate.per_axis=20"})
        .spec;
  }

  struct Compared {
    double told, is;
  };
  /// What is told for this interpolation, and what the formula itself shows.
  Compared compare(const std::string& order) const {
    const Case data =
        read(fmt::format("file = \"vortex.pvd\"\ninterpolation = \"{0}\"\ntime_interpolation = \"{0}\"", order));
    const Case formula = read("u = [\"-(1+2*t-t^2)*sin(2*y)\", \"(1+2*t-t^2)*sin(2*x)\"]");
    const Scene by_data = make_scene(data, 1), by_formula = make_scene(formula, 1);
    const Particles start = seed_scene(by_data, 1);
    std::vector<accuracy::Probe> probes;
    for (std::size_t i = 0; i < by_data.evaluation.size(); ++i)
      probes.push_back({i, accuracy::grid_point(by_data.evaluation, i), 0});
    const auto sums = [&](const Case& spec, const Scene& scene) {
      Particles moved = start;
      accuracy::carry_by_steps(spec, scene, moved, 1, 1);
      return accuracy::sums_at(probes, moved, by_data.cutoff, spec.domain, 1);
    };
    return {accuracy::interpolation_error(data, by_data, start, probes, 1, 1),
            accuracy::largest_difference(sums(data, by_data), sums(formula, by_formula))};
  }
};

TEST_F(InterpolationError, is_told_closely_for_lines_and_not_too_small_for_cubics) {
  for (const auto& [n, times] : {std::pair{33, 17}, {17, 33}}) {
    write_vortex(n, times);
    for (const char* order : {"linear", "cubic"}) {
      const Compared errors = compare(order);
      // Errors of cubics change their sign within a cell, so on a path some cancel. The order of the interpolation
      // itself does not know of that.
      const double most = order == std::string("linear") ? 1.5 : 4;
      EXPECT_GT(errors.is, 1e-6) << order;
      EXPECT_GT(errors.told, errors.is / 1.2) << order << ", " << n;
      EXPECT_LT(errors.told, errors.is * most) << order << ", " << n;
    }
  }
}

TEST_F(InterpolationError, comes_from_every_second_point_and_the_last) {
  GridData data;
  data.axis[0] = {0, 1, 2, 3};
  data.axis[1] = {0, 1, 2};
  data.times = {0, 1, 2, 3};
  for (int t = 0; t < 4; ++t) {
    data.values.emplace_back();
    for (int p = 0; p < 12; ++p) data.values.back().push_back(100 * t + p);
  }
  const auto points = every_second_point(data), times = every_second_time(data);
  EXPECT_EQ(points->axis[0], (std::vector<double>{0, 2, 3}));
  EXPECT_EQ(points->axis[1], (std::vector<double>{0, 2}));
  EXPECT_EQ(points->values[1], (std::vector<double>{100, 102, 103, 108, 110, 111}));
  EXPECT_EQ(times->times, (std::vector<double>{0, 2, 3}));
  EXPECT_EQ(times->values[1], data.values[2]);
}

}  // namespace
}  // namespace gaussdrift::input
