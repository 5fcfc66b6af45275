// The error budget where the domain has edges: a scene that is moved by half a period, or cut in two by a mirror, errs as
// before, for the same reasons.
#include <gtest/gtest.h>

#include <cmath>

#include "accuracy/budget.hpp"
#include "accuracy/target.hpp"
#include "case_text.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "message_of.hpp"

namespace gaussdrift::accuracy {
namespace {

Case scene(const std::string& domain, const std::string& density, const std::vector<std::string>& u, int across) {
  const CaseTables tables{.domain = domain,
                          .velocity = "u = [\"" + u[0] + "\", \"" + u[1] + "\"]",
                          .density = "expression = \"" + density + "\"",
                          .particles = "per_axis = 61\noverlap = 1.2",
                          .time = "end = 0.6\nstep = 0.15",
                          .evaluate = "per_axis = " + std::to_string(across),
                          .reference = "kind = \"characteristics\""};
  return parse_case(case_text(tables), "scene.toml").spec;
}

Budget measured_budget(const Case& spec) {
  LastFrame::Kept last;
  Simulation simulation(spec, 1);
  simulation.observe(std::make_unique<LastFrame>(last, spec.output.times.back()));
  simulation.run();
  return measure_budget(spec, make_scene(spec), last, Effort::whatever, 1);
}

/// The largest errors of both are at the same places, but probes are chosen one by one: on a seam a place is met twice.
void expect_alike(const Budget& a, const Budget& b) {
  ASSERT_TRUE(a.known() && b.known()) << a.not_covered << b.not_covered;
  EXPECT_EQ(a.dominates, b.dominates);
  EXPECT_NEAR(a.total, b.total, 1e-6 * b.total);
  EXPECT_NEAR(a.smoothing, b.smoothing, 1e-3 * b.smoothing);
  EXPECT_NEAR(a.quadrature, b.quadrature, 0.3 * b.quadrature);
  EXPECT_NEAR(a.time_stepping, b.time_stepping, 0.3 * b.time_stepping);
  EXPECT_GT(b.smoothing, 1e-3);
  EXPECT_GT(b.quadrature, 1e-4);
  EXPECT_GT(b.time_stepping, 1e-7);
}

TEST(BudgetWithEdges, IsThatOfTheSceneMovedAcrossTheSeam) {
  const std::string periodic = square + "\nedges = [\"periodic\", \"periodic\"]";
  const auto blob = [](const std::string& x, const std::string& y) {
    return "exp(3*(cos(pi*(" + x + "))+cos(pi*(" + y + "))-2))";
  };
  const Case middle = scene(periodic, blob("x-0.13", "y+0.21"), {"sin(pi*y)+0.3", "0.5*cos(pi*x)"}, 41),
             corner = scene(periodic, blob("x-1.13", "y-0.79"), {"-sin(pi*y)+0.3", "-0.5*cos(pi*x)"}, 41);
  expect_alike(measured_budget(corner), measured_budget(middle));
  const auto predicted = [](const Case& spec) { return predict_budget(spec, make_scene(spec), Effort::whatever, 1); };
  expect_alike(predicted(corner), predicted(middle));
  // What is predicted of the whole is what a run finds.
  EXPECT_NEAR(predicted(corner).total, measured_budget(corner).total, 0.02 * measured_budget(corner).total);
}

TEST(BudgetWithEdges, IsThatOfTheSceneAndItsMirrorImage) {
  // A stagnation flow on the wall x = 0, which is a line of symmetry of the whole.
  const std::string blob = "exp(-6*(x^2+(y-0.1)^2))";
  const std::vector<std::string> u{"sin(pi*x)*cos(pi*y)", "-cos(pi*x)*sin(pi*y)"};
  const Case whole = scene(square + "\nedges = [\"closed\", \"closed\"]", blob, u, 61),
             half = scene("min = [0, -1]\nmax = [1, 1]\nedges = [\"closed\", \"closed\"]", blob, u, 61);
  expect_alike(measured_budget(half), measured_budget(whole));
}

TEST(BudgetWithEdges, LetsSettingsBeChosen) {
  const Case spec = scene("min = [-1, 0]\nmax = [1, 0.5]\nedges = [\"periodic\", \"closed\"]",
                          "exp(3*(cos(pi*x)-1))*(1+cos(2*pi*y))", {"sin(2*pi*y)^2", "0"}, 41);
  const double target = 1e-2;
  const AccuracyChoice choice = choose_for_accuracy(spec, target, 1);
  EXPECT_LE(choice.predicted.total, target);
  EXPECT_LE(Simulation(choice.spec, 1).run().frames.back().second.error->linf, target);
}

TEST(BudgetWithEdges, IsNotKnownWhereSomethingLeaves) {
  const Case spec = scene(square + "\nedges = [\"open\", \"periodic\"]", "1", {"1", "0"}, 21);
  EXPECT_NE(budget_not_covered(spec).find("open edges"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { static_cast<void>(choose_for_accuracy(spec, 1e-2, 1)); }).find("open edges"),
            std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::accuracy
