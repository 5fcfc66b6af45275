// Velocities and rates that jump: a jump is not a rate, so no step is too long for it; it is warned of instead.
#include <gtest/gtest.h>

#include <regex>

#include "field/gridded/grid_data.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scenes.hpp"

namespace gaussdrift {
namespace {

Case plane(const std::string& velocity, const std::vector<std::string>& overrides = {}, const std::string& more = "") {
  return written(case_text({.domain = unit_square,
                            .velocity = velocity,
                            .density = shape_of("wendland", "0.5, 0.5", "0.2"),
                            .particles = "per_axis = 201",
                            .time = "end = 0.5\nstep = 0.01",
                            .evaluate = "per_axis = 11",
                            .reference = not_compared,
                            .output = output_at("0.5")}) +
                     more,
                 overrides);
}

std::string refusal(const Case& scene) {
  return message_of<InputError>([&] { Simulation(scene).prepare(); });
}

TEST(Jump, OfAVelocityDoesNotLimitTheStep) {
  for (const char* place : {"0.62", "0.6", "0.61", "0.6225", "0.6012", "0.6137", "0.5"}) {
    const Case scene = plane("u = [\"x<" + std::string(place) + "?1:0\", \"0\"]");
    Simulation simulation(scene);
    RunSummary summary;
    ASSERT_NO_THROW(summary = simulation.run()) << place;
    ASSERT_EQ(summary.warnings.size(), 1u) << place;
    EXPECT_NE(summary.warnings[0].find("the velocity jumps by 1 at (0."), std::string::npos) << summary.warnings[0];
    // What comes to the jump stops within one step behind it.
    const Particles& end = simulation.particles();
    const double jump = std::stod(place);
    for (std::size_t j = 0; j < end.size(); ++j) EXPECT_LE(end.position[0][j], std::max(jump + 0.01, 0.7)) << place;
  }
}

TEST(Jump, OfEveryKindRuns) {
  for (const char* velocity : {"u = [\"0\", \"x+y<1 ? 1 : -1\"]", "u = [\"sign(0.5-x)\", \"sign(0.5-y)\"]",
                               "u = [\"x<0.55+0.1*t ? 1 : 0\", \"0\"]", "u = [\"t<0.3 ? 1 : -1\", \"0\"]",
                               "u = [\"floor(5*x)/5\", \"floor(5*y)/5\"]", "u = [\"x<0.6 ? -3*(x-0.5) : 2\", \"0\"]",
                               "streamfunction = \"max(x, 0.6)*0.5\""})
    for (const char* method : {"euler", "rk4"})
      EXPECT_EQ(refusal(plane(velocity, {std::string("time.method=") + method})), "") << velocity;
  const Case space = written(case_text({.domain = unit_cube,
                                        .velocity = velocity_of({"0", "0", "z<0.6 ? 1 : 0"}),
                                        .density = shape_of("wendland", "0.5, 0.5, 0.5", "0.2"),
                                        .particles = "per_axis = 51",
                                        .time = "end = 0.2\nstep = 0.01",
                                        .evaluate = "per_axis = 5",
                                        .output = output_at("0.2")}));
  EXPECT_EQ(refusal(space), "");
  EXPECT_EQ(refusal(plane("u = [\"1\", \"0\"]", {}, "[effects.reaction]\nrate = \"x<0.62 ? 0 : 1000\"\n")), "");
  // Nor is it strain that round blobs could not follow.
  Simulation spreading(plane("u = [\"0\", \"x<0.62 ? 0.1 : 0\"]", {}, "[effects.diffusion]\nD = 0.001\n"));
  EXPECT_EQ(spreading.run().effects[1].warning, "");
}

TEST(Jump, OfAGriddedWindAtTheEdgeOfItsDataRuns) {
  auto data = std::make_shared<GridData>();
  data->name = "u of wind.vti";
  data->dimension = 2;
  data->components = 2;
  data->axis[0] = {0, 0.3, 0.62};
  data->axis[1] = {0, 1};
  data->times = {0};
  data->values = {{1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0}};
  Case scene = plane("u = [\"0\", \"0\"]");
  FileVelocitySpec wind;
  wind.file = "wind.vti";
  wind.interpolation = "linear";
  wind.outside = "zero";
  wind.data = data;
  scene.velocity = {wind};
  EXPECT_EQ(refusal(scene), "");
  EXPECT_EQ(Simulation(scene).run().warnings.size(), 1u);
}

TEST(Jump, IsNotWarnedOfWhereThereIsNone) {
  for (const char* velocity :
       {"u = [\"abs(x-0.5)\", \"min(y, 0.5)\"]", "u = [\"y\", \"x\"]", "u = [\"x<2 ? 1 : 0\", \"0\"]"})
    EXPECT_TRUE(Simulation(plane(velocity)).run().warnings.empty()) << velocity;
}

TEST(Step, ThatIsRecommendedRunsAndSoDoesTheMethod) {
  for (const auto& [velocity, step, method] : {std::tuple{"u = [\"-1000*(x-0.5)\", \"0\"]", "0.01", "rk4"},
                                               {"u = [\"-1000*(x-0.5) + (x<0.62 ? 1 : 0)\", \"0\"]", "0.01", "rk4"},
                                               {"u = [\"0.5-y\", \"x-0.5\"]", "0.4", "euler"},
                                               {"u = [\"3*(0.5-y)\", \"3*(x-0.5)\"]", "0.4", "heun"},
                                               {"u = [\"7*(0.5-y)\", \"7*(x-0.5)\"]", "0.333", "euler"}}) {
    std::vector<std::string> overrides{std::string("time.step=") + step, std::string("time.method=") + method,
                                       "time.end=4", "output.times=[4]"};
    const std::string text = refusal(plane(velocity, overrides));
    std::smatch longest, other;
    ASSERT_TRUE(std::regex_search(text, longest, std::regex("Use time.step <= ([0-9.e-]*[0-9])"))) << velocity << text;
    overrides[0] = "time.step=" + longest[1].str();
    EXPECT_EQ(refusal(plane(velocity, overrides)), "");
    overrides[0] = "time.step=" + std::to_string(1.03 * std::stod(longest[1]));  // three digits, rounded down
    EXPECT_NE(refusal(plane(velocity, overrides)), "") << longest[1];
    if (!std::regex_search(text, other, std::regex("or time.method = \"([a-z0-9]+)\""))) continue;
    overrides[0] = std::string("time.step=") + step;
    overrides[1] = "time.method=" + other[1].str();
    EXPECT_EQ(refusal(plane(velocity, overrides)), "");
  }
  const std::string rotation = refusal(
      plane("u = [\"0.5-y\", \"x-0.5\"]", {"time.step=0.5", "time.method=euler", "time.end=4", "output.times=[4]"}));
  EXPECT_EQ(rotation.find("With time.step = 0.5 the method \"euler\" amplifies a pure rotation by more than 10 % over "
                          "this run: the flow turns at the rate 1 at ("),
            0u)
      << rotation;
  EXPECT_NE(rotation.find(", or time.method = \""), std::string::npos) << rotation;
}

}  // namespace
}  // namespace gaussdrift
