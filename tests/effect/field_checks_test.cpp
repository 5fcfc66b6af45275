// [[check]] of fields of the particles: their largest values and means.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"

namespace gaussdrift {
namespace {

std::string check(const std::string& what, const std::string& more) {
  return "[[check]]\nwhat = \"" + what + "\"\n" + more + "\n";
}
Case spec_of(const std::string& checks, const std::vector<std::string>& more = {}) {
  return scene_of(
      with({"velocity.u=[\"x\", \"-y\"]", "output.fields=[\"rho\", \"ftle\", \"age\", \"flow_map_gradient\"]",
            "output.vtk=[\"particles\"]", "output.times=[0, 0.25, 0.5]", "time.step=0.01"},
           more),
      resting_gaussian + checks);
}

TEST(FieldChecks, KnowTheExponentOfAStrain) {
  // The flow map is linear, so differences are exact: ln(exp(t))/t = 1 for every particle. At t = 0 there is none.
  const std::string checks = check("largest", "field = \"ftle\"\nmin = 0.999999999\nmax = 1.000000001") +
                             check("mean", "field = \"ftle\"\nat = 0.5\nmin = 0.999999999\nmax = 1.000000001") +
                             check("mean", "field = \"age\"\nat = 0.25\nmin = 0.25\nmax = 0.25") +
                             check("mean", "field = \"age\"\nmax = 0.4") +
                             check("largest", "field = \"ftle\"\nat = 0\nmax = 2");
  const Case spec = spec_of(checks);
  const RunSummary alone = Simulation(spec, 1).run();
  ASSERT_EQ(alone.checks.size(), 5u);
  for (const std::size_t passes : {0u, 1u, 2u}) EXPECT_TRUE(alone.checks[passes].passed) << alone.checks[passes].text;
  EXPECT_FALSE(alone.checks[3].passed);
  EXPECT_EQ(alone.checks[3].value, 0.5);
  EXPECT_NE(alone.checks[3].text.find("mean age = 0.5 at t = 0.5, must be at most 0.4"), std::string::npos)
      << alone.checks[3].text;
  EXPECT_FALSE(alone.checks[4].passed);
  EXPECT_NE(alone.checks[4].text.find("no particle has a value of ftle"), std::string::npos) << alone.checks[4].text;
  const auto& fields = alone.frames.back().second.fields;
  ASSERT_EQ(fields.size(), 2u) << "those that checks name";
  EXPECT_EQ(fields[0].values, alone.particles);
  const Case again = gaussdrift::parse_case(case_text(spec), "again.toml").spec;
  ASSERT_EQ(again.checks.size(), 5u);
  EXPECT_EQ(again.checks[1].field, "ftle");
  EXPECT_EQ(again.checks[1].what, CheckSpec::Quantity::mean);
  // On ranks that have some of the particles each, with the same bits.
  const Case tiles = spec_of(checks, {"evaluate.tile_particles=200", "particles.per_axis=81", "output.vtk=[]"});
  const RunSummary one = Simulation(tiles, 1).run();
  on_ranks(2, [&](base::Communicator& ranks) {
    const RunSummary shared = Simulation(tiles, 1, ranks).run();
    for (std::size_t i = 0; i < one.checks.size(); ++i) EXPECT_EQ(shared.checks[i].text, one.checks[i].text);
  });
}

TEST(FieldChecks, CostNothingWhereNobodyAsks) {
  EXPECT_TRUE(Simulation(spec_of(""), 1).run().frames.back().second.fields.empty());
}

TEST(FieldChecks, RefuseWhatIsNoField) {
  const auto refused = [](const std::string& checks, const std::string& words) {
    const std::string message = message_of<Error>([&] { spec_of(checks); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  refused(check("largest", "max = 1"), "what = \"largest\" needs a \"field\"");
  refused(check("mean", "field = \"exit_time\"\nmax = 1"),
          "\"exit_time\" is no field of the particles that this run tells");
  refused(check("mean", "field = \"flow_map_gradient\"\nmax = 1"), "one number: ftle, age");
  refused(check("mass", "field = \"ftle\"\nmax = 1"), "\"field\" does not go with what = \"mass\"");
}

}  // namespace
}  // namespace gaussdrift
