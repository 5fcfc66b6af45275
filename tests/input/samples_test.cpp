// Densities and velocities from tables of scattered samples: what is read and fitted, where it holds, and the promised
// message for everything wrong with it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <variant>

#include "cases.hpp"
#include "field/samples/sampled_density.hpp"
#include "field/samples/sampled_velocity.hpp"
#include "input/data_files.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::input {
namespace {

using Function = std::function<std::vector<double>(double, double)>;

const std::string wind = "u = [\"-y\", \"x\"]",
                  blob = "shape = \"wendland\"\ncenter = [0.5, 0]\nradius = \"R\"\nheight = 1.5";

class Samples : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  /// Values at random points of [-1, 1]^2.
  void write_random(const std::string& name, const std::string& header, int count, const Function& function) {
    std::mt19937 random(1);
    std::ofstream out(folder_ / name);
    out.precision(17);
    out << header << "\n";
    const auto coordinate = [&] { return -1 + 2 * static_cast<double>(random()) / 4294967296.0; };
    for (int i = 0; i < count; ++i) {
      const double x = coordinate(), y = coordinate();
      out << x << "," << y;
      for (const double value : function(x, y)) out << "," << value;
      out << "\n";
    }
  }
  Case read(const std::string& tables, const std::string& replaced) const {
    return parse_case(with(cone, replaced, tables), folder_ / "cone.toml").spec;
  }
  std::string message(const std::string& tables, const std::string& replaced = blob) const {
    try {
      read(tables, replaced);
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  }

  ScratchFolder folder_;
};

std::vector<double> gaussian(double x, double y) { return {2 * std::exp(-((x - 0.2) * (x - 0.2) + y * y) / 0.16)}; }
std::vector<double> vortex(double x, double y) {
  const double e = std::exp(-x * x - y * y);
  return {-y * e, x * e};
}

SamplesDensitySpec density_of(const Case& spec) { return std::get<SamplesDensitySpec>(spec.density.at(0)); }
SamplesVelocitySpec velocity_of(const Case& spec) { return std::get<SamplesVelocitySpec>(spec.velocity.at(0)); }

double value(const InitialDensity& density, double x, double y) {
  double found = 0;
  density.add({2, 1, {&x, &y, nullptr}}, &found);
  return found;
}
Vector value(const VelocityField& field, double x, double y) {
  Vector u{};
  field.add(0, {2, 1, {&x, &y, nullptr}}, {2, 1, {&u[0], &u[1], nullptr}});
  return u;
}

std::unique_ptr<InitialDensity> made(const SamplesDensitySpec& spec, Outside outside = Outside::zero) {
  return make_sampled_density(spec.fit, outside, {-1, -1}, {1, 1});
}

TEST_F(Samples, OfADensityAreTaken) {
  write_random("cloud.csv", "x,y,rho", 300, gaussian);
  const Case spec = read("samples = \"cloud.csv\"", blob);
  const SamplesDensitySpec samples = density_of(spec);
  EXPECT_EQ(samples.kernel, "matern52");
  EXPECT_EQ(samples.outside, "zero");
  EXPECT_GT(samples.width, 0.1);  // several spacings: the function is smooth
  const auto density = made(samples);
  double worst = 0;
  for (double x = -0.8; x < 0.9; x += 0.16)
    for (double y = -0.8; y < 0.9; y += 0.16)
      worst = std::max(worst, std::abs(value(*density, x, y) - gaussian(x, y)[0]));
  EXPECT_LT(worst, density->fit_error());
  EXPECT_LT(density->fit_error(), 0.05);  // of 2
  // The mass of the Gaussian; 0.2 % of it lies beyond the square.
  ASSERT_TRUE(density->mass());
  EXPECT_NEAR(*density->mass(), 2 * 3.14159265358979 * 0.16, 4e-3);
  EXPECT_NE(density->describe().find("mass 1.00"), std::string::npos) << density->describe();
  EXPECT_NE(density->describe().find("(chosen) to 300 samples"), std::string::npos) << density->describe();
  // The file is one that the run depends on: its bytes count for what is resumed.
  EXPECT_EQ(data_files(spec), std::vector{std::filesystem::path(folder_ / "cloud.csv")});
}

TEST_F(Samples, HaveTheSameBitsWhateverIsAskedForTogether) {
  write_random("cloud.csv", "x,y,rho", 60, gaussian);
  for (const std::string kernel : {"matern52", "thin-plate", "multiquadric", "gaussian"}) {
    const auto density = made(density_of(read("samples = \"cloud.csv\"\nkernel = \"" + kernel + "\"", blob)));
    std::array<std::vector<double>, 2> x;
    for (int i = 0; i < 101; ++i) x[0].push_back(-1 + i / 50.0), x[1].push_back(std::sin(i));
    std::vector<double> all(101, 0.0);
    const PointsView view{2, 101, {x[0].data(), x[1].data(), nullptr}};
    density->add(view, all.data());
    for (const std::size_t length : {std::size_t{1}, std::size_t{3}, std::size_t{8}, std::size_t{50}})
      for (std::size_t first = 0; first + length <= 101; first += 17) {
        std::vector<double> some(length, 0.0);
        density->add(view.block(first, length), some.data());
        for (std::size_t i = 0; i < length; ++i) EXPECT_EQ(some[i], all[first + i]) << kernel << " " << length;
      }
  }
}

TEST_F(Samples, HaveTheMostLikelyWidthIfAsked) {
  const Function narrow = [](double x, double y) {
    return std::vector<double>{std::exp(-((x - 0.2) * (x - 0.2) + y * y) / 0.02)};
  };
  const Function edged = [](double x, double y) { return std::vector<double>{std::abs(x - 0.1) + std::abs(y)}; };
  int differ = 0;
  for (const Function& function : {narrow, edged}) {
    write_random("cloud.csv", "x,y,rho", 150, function);
    const auto left_out = density_of(read("samples = \"cloud.csv\"", blob)),
               likely = density_of(read("samples = \"cloud.csv\"\nwidth_by = \"likelihood\"", blob));
    EXPECT_GE(likely.fit->report.log_likelihood[0], left_out.fit->report.log_likelihood[0]);
    EXPECT_LE(left_out.fit->typical_error, likely.fit->typical_error);
    differ += likely.width != left_out.width ? 1 : 0;
  }
  EXPECT_GE(differ, 1);  // else the key has no effect
}

TEST_F(Samples, AreWrittenIntoTheResolvedCase) {
  write_random("cloud.csv", "x,y,rho", 60, gaussian);
  write_random("wind.csv", "x,y,u,v", 60, vortex);
  const Case first = read("samples = \"cloud.csv\"\nregularisation = 1e-9\noutside = \"clamp\"", blob);
  const SamplesDensitySpec a = density_of(first), b = density_of(parse_case(case_text(first), "else/run.toml").spec);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(b.regularisation, 1e-9);
  EXPECT_EQ(b.outside, "clamp");
  EXPECT_EQ(value(*made(a), 0.1, 0.2), value(*made(b), 0.1, 0.2));
  for (const bool divergence_free : {false, true}) {
    const Case second =
        read(std::string("samples = \"wind.csv\"\ndivergence_free = ") + (divergence_free ? "true" : "false"), wind);
    const SamplesVelocitySpec u = velocity_of(second),
                              v = velocity_of(parse_case(case_text(second), "else/run.toml").spec);
    EXPECT_EQ(v.divergence_free, divergence_free);
    EXPECT_EQ(u.width, v.width);
    EXPECT_EQ(value(*make_sampled_velocity(u.fit, Outside::error, 1), 0.1, 0.2),
              value(*make_sampled_velocity(v.fit, Outside::error, 1), 0.1, 0.2));
  }
}

TEST_F(Samples, OfAVelocityHaveItsValuesAndTheirOwnDerivatives) {
  write_random("wind.csv", "x,y,u,v", 100, vortex);
  for (const bool divergence_free : {false, true}) {
    const Case spec =
        read(std::string("samples = \"wind.csv\"\ndivergence_free = ") + (divergence_free ? "true" : "false"), wind);
    const auto field = make_sampled_velocity(velocity_of(spec).fit, Outside::error, 1);
    EXPECT_EQ(field->is_solenoidal(), divergence_free);
    EXPECT_TRUE(field->is_steady() && field->is_smooth() && field->evaluates_in_blocks());
    const double x = 0.31, y = -0.42, h = 1e-4;
    const double error = field->fit_error({2, 1, {&x, &y, nullptr}});
    EXPECT_LT(error, 1e-2) << field->describe();
    EXPECT_GT(error, 0);
    EXPECT_NEAR(value(*field, x, y)[0], vortex(x, y)[0], 5 * error);
    EXPECT_NEAR(value(*field, x, y)[1], vortex(x, y)[1], 5 * error);
    std::array<std::array<double, 2>, 2> slopes{};
    field->add_gradient(0, {2, 1, {&x, &y, nullptr}},
                        {2, 1, {{{&slopes[0][0], &slopes[0][1], nullptr}, {&slopes[1][0], &slopes[1][1], nullptr}}}});
    for (std::size_t k = 0; k < 2; ++k) {  // differences: the step squared
      EXPECT_NEAR(slopes[k][0], (value(*field, x + h, y)[k] - value(*field, x - h, y)[k]) / (2 * h), 1e-5) << k;
      EXPECT_NEAR(slopes[k][1], (value(*field, x, y + h)[k] - value(*field, x, y - h)[k]) / (2 * h), 1e-5) << k;
    }
    double divergence = 0;
    field->add_divergence(0, {2, 1, {&x, &y, nullptr}}, &divergence);
    EXPECT_NEAR(divergence, slopes[0][0] + slopes[1][1], 1e-12);
  }
}

TEST_F(Samples, OfAVelocityAtManyPointsAreSummedFast) {
  write_random("wind.csv", "x,y,u,v", 600, vortex);
  const Case spec = read("samples = \"wind.csv\"\nwidth = 0.4", wind);
  const auto fast = make_sampled_velocity(velocity_of(spec).fit, Outside::error, 1000000),
             pairs = make_sampled_velocity(velocity_of(spec).fit, Outside::error, 1);
  EXPECT_FALSE(fast->evaluates_in_blocks());  // so several ranks refuse it
  std::array<std::vector<double>, 4> found;
  std::array<std::vector<double>, 2> x;
  for (int i = 0; i < 1000; ++i) x[0].push_back(std::cos(i) * 0.9), x[1].push_back(std::sin(2 * i) * 0.9);
  for (auto& values : found) values.assign(1000, 0.0);
  const PointsView view{2, 1000, {x[0].data(), x[1].data(), nullptr}};
  fast->add(0, view, {2, 1000, {found[0].data(), found[1].data(), nullptr}});
  pairs->add(0, view, {2, 1000, {found[2].data(), found[3].data(), nullptr}});
  for (std::size_t i = 0; i < 1000; ++i)
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(found[k][i], found[k + 2][i], 1e-8) << i;
}

TEST_F(Samples, EndWhereTheCaseSays) {
  write_random("cloud.csv", "x,y,rho", 100, [](double x, double) { return std::vector<double>{2 + x}; });
  const SamplesDensitySpec samples = density_of(read("samples = \"cloud.csv\"", blob));
  const double right = samples.fit->high[0];
  EXPECT_GT(right, 1);  // the last sample and a spacing
  EXPECT_LT(right, 1.3);
  EXPECT_EQ(value(*made(samples, Outside::zero), right + 1e-9, 0), 0);
  EXPECT_GT(value(*made(samples, Outside::zero), right - 1e-9, 0), 2.5);
  EXPECT_EQ(value(*made(samples, Outside::clamp), 5, 0), value(*made(samples, Outside::clamp), right, 0));
  EXPECT_TRUE(std::isnan(value(*made(samples, Outside::error), 5, 0)));
  EXPECT_FALSE(made(samples, Outside::clamp)->mass());

  write_random("wind.csv", "x,y,u,v", 100, vortex);
  const SamplesVelocitySpec flow = velocity_of(read("samples = \"wind.csv\"", wind));
  EXPECT_EQ(flow.outside, "error");
  const auto ends = make_sampled_velocity(flow.fit, Outside::error, 1);
  EXPECT_TRUE(std::isnan(value(*ends, 5, 0)[1]));
  EXPECT_NE(ends->why_not_finite(0, {5, 0, 0}).find("x = 5 is outside of the samples"), std::string::npos);
  EXPECT_NE(ends->why_not_finite(0, {5, 0, 0}).find("outside = \"clamp\""), std::string::npos);
  const auto clamped = make_sampled_velocity(flow.fit, Outside::clamp, 1);
  const double x = 5, y = 0.1;
  std::array<std::array<double, 2>, 2> slopes{};
  clamped->add_gradient(0, {2, 1, {&x, &y, nullptr}},
                        {2, 1, {{{&slopes[0][0], &slopes[0][1], nullptr}, {&slopes[1][0], &slopes[1][1], nullptr}}}});
  EXPECT_EQ(slopes[1][0], 0);  // nothing changes along x there
  EXPECT_NE(slopes[1][1], 0);
}

TEST_F(Samples, ThatBreakOffInsideTheDomainAreTold) {
  write_random("cloud.csv", "x,y,rho", 100, [](double x, double) { return std::vector<double>{2 + x}; });
  std::string scene = with(cone, blob, "samples = \"cloud.csv\"");
  const auto warnings = [&] {
    std::string all;
    for (const std::string& text : parse_case(scene, folder_ / "cone.toml").warnings) all += text;
    return all;
  };
  EXPECT_EQ(warnings().find("breaks off"), std::string::npos) << warnings();
  scene = with(scene, "min = [-1, -1]", "min = [-2, -1]");
  EXPECT_NE(warnings().find("the density breaks off where the samples end"), std::string::npos) << warnings();
  scene = with(scene, "samples = \"cloud.csv\"", "samples = \"cloud.csv\"\noutside = \"error\"");
  EXPECT_THROW(warnings(), CaseError);
}

TEST_F(Samples, AreRefusedWithPlaceAndRemedy) {
  const auto says = [&](const std::string& tables, const std::string& wanted, const std::string& replaced = blob) {
    const std::string found = message(tables, replaced);
    EXPECT_NE(found.find(wanted), std::string::npos) << tables << "\n" << found;
  };
  write_random("cloud.csv", "x,y,rho", 30, gaussian);
  const std::string cloud = "samples = \"cloud.csv\"\n";
  says("samples = \"nowhere.csv\"", "nowhere.csv");
  says("samples = 3", "must be the name of a file in a string");
  says(cloud + "kernel = \"matern\"", "unknown value \"matern\" for density.kernel");
  says(cloud + "kernel = \"thin-plate\"\nwidth = 0.3", "kernel = \"thin-plate\" takes no width");
  says(cloud + "kernel = \"thin-plate\"\nwidth_by = \"likelihood\"", "kernel = \"thin-plate\" has no width to choose");
  says(cloud + "width = 0.3\nwidth_by = \"likelihood\"", "the width is given, so it is not chosen");
  says(cloud + "width_by = \"guess\"", "unknown value \"guess\" for density.width_by");
  says(cloud + "width = 0", "greater than 0");
  says(cloud + "interpolation = \"cubic\"", "\"interpolation\" goes with \"file\", not with \"samples\"");
  says(cloud + "kernel = \"gaussian\"\nwidth = 50", "Lower width");
  says(cloud + "kernel = \"gaussian\"\nwidth = 50", "leave width out to have it chosen");
  says(cloud + "kernel = \"gaussian\"\nwidth = 50", "cloud.csv: the samples cannot be fitted");
  write("few.csv", "x,y,rho\n0,0,1\n0,1,2\n1,0,1\n");
  says("samples = \"few.csv\"", "few.csv: 3 samples are too few to fit a function in 2 dimensions; give 4 at least");
  write("twice.csv", "x,y,rho\n0,0,1\n0,1,2\n1,0,1\n1,1,0\n0,1,3\n");
  says("samples = \"twice.csv\"", "twice.csv:6:1: the sample at (0, 1) stands in line 3 already");
  EXPECT_EQ(message("samples = \"twice.csv\"\nregularisation = 1e-3"), "");  // between the two
  write("nan.csv", "x,y,rho\n0,0,1\n0,1,nan\n1,0,1\n1,1,0\n");
  says("samples = \"nan.csv\"", "nan.csv:3:5");
  write("huge.csv", "x,y,rho\n0,0,1\n0,1,1e200\n1,0,1\n1,1,0\n");
  says("samples = \"huge.csv\"", "too large for a fit in doubles; take other units");
  write("far.csv", "x,y,rho\n0,0,1\n0,1e200,1\n1e200,0,1\n1,1,0\n");
  says("samples = \"far.csv\"", "the coordinate 1e+200 is too large");
  write("line.csv", "x,y,rho\n0,0,1\n1,1,2\n2,2,1\n3,3,0\n4,4,0\n");
  says("samples = \"line.csv\"\nkernel = \"thin-plate\"", "all points lie on a line");
  write("named.csv", "x,y,density\n0,0,1\n");
  says("samples = \"named.csv\"",
       "named.csv:1:5: column \"density\" is not one of those that are wanted; the columns must be x,y,rho");

  write_random("wind.csv", "x,y,u,v", 30, vortex);
  const std::string flow = "samples = \"wind.csv\"\n";
  says(flow + "divergence_free = 1", "must be true or false", wind);
  says(flow + "divergence_free = true\nkernel = \"thin-plate\"", "has no second derivatives at distance 0", wind);
  write_random("many.csv", "x,y,u,v", 2001, vortex);
  says("samples = \"many.csv\"\ndivergence_free = true", "at most 2000 in 2 dimensions", wind);
}

TEST_F(Samples, InSpaceAreTakenToo) {
  std::mt19937 random(2);
  std::ofstream cloud(folder_ / "cloud.csv"), flow(folder_ / "wind.csv");
  cloud << "rho,z,y,x\n";
  flow << "x,y,z,u,v,w\n";
  const auto coordinate = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (int i = 0; i < 80; ++i) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    cloud << 1 + x * y + z << "," << z << "," << y << "," << x << "\n";
    flow << x << "," << y << "," << z << "," << y << "," << z << "," << x << "\n";
  }
  cloud.close(), flow.close();
  const std::string scene =
      with(least, "u = [\"y\", \"z*t\", \"x\"]", "samples = \"wind.csv\"\ndivergence_free = true");
  const Case spec = parse_case(scene, folder_ / "least.toml").spec;
  const auto field = make_sampled_velocity(velocity_of(spec).fit, Outside::error, 1);
  const Vector x{0.4, 0.5, 0.6};
  Vector u{};
  field->add(0, {3, 1, {&x[0], &x[1], &x[2]}}, {3, 1, {&u[0], &u[1], &u[2]}});
  EXPECT_NEAR(u[0], 0.5, 0.05);
  EXPECT_NEAR(u[1], 0.6, 0.05);
  EXPECT_NEAR(u[2], 0.4, 0.05);
  const Case with_cloud =
      parse_case(with(least, "expression = \"exp(-x^2-y^2-z^2)\"", "samples = \"cloud.csv\""), folder_ / "least.toml")
          .spec;
  double rho = 0;
  make_sampled_density(density_of(with_cloud).fit, Outside::zero, {}, {1, 1, 1})
      ->add({3, 1, {&x[0], &x[1], &x[2]}}, &rho);
  EXPECT_NEAR(rho, 1 + 0.2 + 0.6, 0.05);
}

}  // namespace
}  // namespace gaussdrift::input
