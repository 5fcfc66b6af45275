// A scene whose density, or velocity, is known at random points only: the error of the run is the error of the fit, and
// the budget tells it as a cause of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "accuracy/budget.hpp"
#include "accuracy/target.hpp"
#include "case_text.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::accuracy {
namespace {

struct Found {
  Budget predicted, measured;
  double linf = 0;
};

Found run(const Case& spec) {
  Found found;
  LastFrame::Kept last;
  Simulation simulation(spec);
  simulation.observe(std::make_unique<LastFrame>(last, spec.output.times.back()));
  found.linf = simulation.run().frames.back().second.error->linf;
  found.measured = measure_budget(spec, make_scene(spec), last, Effort::whatever, 0);
  found.predicted = predict_budget(spec, make_scene(spec), Effort::whatever, 0);
  return found;
}

class SampledScene : public ::testing::Test {
 protected:
  template <class Function>
  void write(const std::string& name, const std::string& header, int count, double reach, const Function& function) {
    std::mt19937 random(1);
    std::ofstream out(folder_ / name);
    out.precision(17);
    out << header << "\n";
    const auto coordinate = [&] { return reach * (2 * static_cast<double>(random()) / 4294967296.0 - 1); };
    for (int i = 0; i < count; ++i) {
      const double x = coordinate(), y = coordinate();
      out << x << "," << y;
      for (const double value : function(x, y)) out << "," << value;
      out << "\n";
    }
  }
  Case scene(const CaseTables& tables) const { return parse_case(case_text(tables), folder_ / "scene.toml").spec; }

  ScratchFolder folder_;
};

const std::string turned_gaussian = "kind = \"exact\"\nrho = \"exp(-((x - 0.2*cos(t))^2 + (y - 0.2*sin(t))^2)/0.04)\"";
// Blobs of order 8, whose own errors are some 1e-6. The Gaussian is 1e-7 where the domain ends.
const std::string fine = "per_axis = 101\ncutoff = \"gauss8\"";

TEST_F(SampledScene, OfAGaussianAtRandomPointsReachesTheErrorOfTheFit) {
  write("cloud.csv", "x,y,rho", 2000, 1,
        [](double x, double y) { return std::vector<double>{std::exp(-((x - 0.2) * (x - 0.2) + y * y) / 0.04)}; });
  // The width is the one that is chosen: given, the test takes a third of the time.
  const Case spec = scene({.density = "samples = \"cloud.csv\"\nwidth = 0.36",
                           .particles = fine,
                           .time = "end = 0.5\nstep = 0.05",
                           .evaluate = "per_axis = 61",
                           .reference = turned_gaussian});
  const Found found = run(spec);
  EXPECT_LT(found.linf, 1e-3);
  for (const Budget& budget : {found.measured, found.predicted}) {
    ASSERT_TRUE(budget.known()) << budget.not_covered;
    EXPECT_EQ(budget.dominates, "fit of samples");
    EXPECT_LT(std::max({budget.smoothing, budget.quadrature, budget.time_stepping}), 0.2 * budget.fit);
    EXPECT_NE(to_text(budget).find("fit of samples"), std::string::npos);
  }
  // Measured: the difference of the fit from the formula, where it is largest. Predicted: from left-out samples.
  EXPECT_NEAR(found.measured.fit / found.linf, 1, 0.1);
  EXPECT_GT(found.predicted.fit, 0.5 * found.linf);
  EXPECT_LT(found.predicted.fit, 10 * found.linf);
}

TEST_F(SampledScene, WithAFormulaAloneHasNoSuchCause) {
  const Found found = run(scene({.reference = "kind = \"characteristics\""}));
  EXPECT_EQ(found.measured.fit, 0);
  EXPECT_EQ(found.predicted.fit, 0);
  EXPECT_EQ(to_text(found.predicted).find("fit of samples"), std::string::npos);
}

TEST_F(SampledScene, OfAWindAtRandomPointsTellsWhatTheFitOfTheWindDoes) {
  write("wind.csv", "x,y,u,v", 150, 1.2, [](double x, double y) { return std::vector<double>{-y, x}; });
  const Found found = run(scene({.velocity = "samples = \"wind.csv\"\nwidth = 0.7",
                                 .density = "expression = \"exp(-((x - 0.2)^2 + y^2)/0.04)\"",
                                 .particles = fine,
                                 .time = "end = 0.5\nstep = 0.1",
                                 .evaluate = "per_axis = 31",
                                 .reference = turned_gaussian}));
  ASSERT_TRUE(found.measured.known()) << found.measured.not_covered;
  EXPECT_EQ(found.measured.dominates, "fit of samples");
  EXPECT_NEAR(found.measured.fit / found.linf, 1, 0.1);
  // Predicted from the samples around the density: those at the border have errors that are hundreds of times larger.
  ASSERT_TRUE(found.predicted.known()) << found.predicted.not_covered;
  EXPECT_GT(found.predicted.fit, 0.5 * found.linf);
  EXPECT_LT(found.predicted.fit, 10 * found.linf);
}

TEST_F(SampledScene, OfDivergenceFreeGaussiansTellsTheSameCause) {
  write("wind.csv", "x,y,u,v", 400, 1.2, [](double x, double y) {
    const double e = std::exp(-x * x - y * y);
    return std::vector<double>{-y * e, x * e};
  });
  // A circle of radius r turns by t exp(-r^2).
  const std::string cosine = "cos(t*exp(-x^2-y^2))", sine = "sin(t*exp(-x^2-y^2))";
  const std::string from_x = "(x*" + cosine + " + y*" + sine + " - 0.2)",
                    from_y = "(y*" + cosine + " - x*" + sine + ")";
  const Found found =
      run(scene({.velocity = "gaussians = \"wind.csv\"",
                 .density = "expression = \"exp(-((x - 0.2)^2 + y^2)/0.04)\"",
                 .particles = fine,
                 .time = "end = 0.5\nstep = 0.1",
                 .evaluate = "per_axis = 31",
                 .reference = "kind = \"exact\"\nrho = \"exp(-(" + from_x + "^2 + " + from_y + "^2)/0.04)\""}));
  ASSERT_TRUE(found.measured.known()) << found.measured.not_covered;
  EXPECT_EQ(found.measured.dominates, "fit of samples");
  EXPECT_NEAR(found.measured.fit / found.linf, 1, 0.1);
  ASSERT_TRUE(found.predicted.known()) << found.predicted.not_covered;
  EXPECT_GT(found.predicted.fit, 0.5 * found.linf);
  EXPECT_LT(found.predicted.fit, 10 * found.linf);
  EXPECT_NE(to_text(found.predicted).find("fit of samples"), std::string::npos);
}

TEST_F(SampledScene, IsRefusedATargetThatItsFitMisses) {
  write("cloud.csv", "x,y,rho", 700, 1,
        [](double x, double y) { return std::vector<double>{std::exp(-((x - 0.2) * (x - 0.2) + y * y) / 0.09)}; });
  const Case spec = scene({.density = "samples = \"cloud.csv\"\nwidth = 0.5",
                           .particles = "per_axis = 41\ncutoff = \"gauss6\"",
                           .time = "end = 0.1\nstep = 0.05",
                           .evaluate = "per_axis = 31",
                           .reference = "kind = \"characteristics\""});
  const double fit = predict_budget(spec, make_scene(spec), Effort::whatever, 0).fit;
  ASSERT_GT(fit, 0);
  const std::string refusal = message_of<InputError>([&] { choose_for_accuracy(spec, fit, 0); });
  EXPECT_NE(refusal.find("the fit of the samples alone is predicted to be off by"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("more samples"), std::string::npos) << refusal;
  const double target = std::max(3 * fit, 2e-3);
  const AccuracyChoice choice = choose_for_accuracy(spec, target, 0);
  EXPECT_GT(choice.predicted.fit, 0);
  EXPECT_LE(choice.predicted.total, target);
}

}  // namespace
}  // namespace gaussdrift::accuracy
