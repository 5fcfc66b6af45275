// Every case of cases/, small: taken up by another run in its middle, it ends with the bits of one that never stopped.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift {
namespace {

std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SOURCE_DIR "/cases"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  return names;
}

Case small(const std::string& name) {
  return read_case(SOURCE_DIR "/cases/" + name + ".toml", {"particles.per_axis=31", "evaluate.per_axis=15"}).spec;
}

class Resumed : public testing::TestWithParam<std::string> {};

TEST_P(Resumed, HasTheSameBits) {
  const Case spec = small(GetParam());
  Simulation whole(spec, 1), other(spec, 2);
  Particles particles;
  std::string state;
  whole.on_progress([&](const Progress& progress) {
    if (state.empty() && progress.time >= 0.4 * progress.end) particles = whole.particles(), state = whole.state();
    return true;
  });
  const RunSummary once = whole.run();
  ASSERT_FALSE(state.empty());
  other.restore(particles, state);
  const RunSummary again = other.run();
  EXPECT_EQ(once.steps, again.steps);
  EXPECT_EQ(whole.particles().position, other.particles().position);
  EXPECT_EQ(whole.particles().alpha, other.particles().alpha);
  ASSERT_EQ(once.frames.size(), again.frames.size());
  for (std::size_t i = 0; i < once.frames.size(); ++i) {
    const auto& [time, numbers] = once.frames[i];
    EXPECT_EQ(time, again.frames[i].first);
    EXPECT_EQ(numbers.maximum, again.frames[i].second.maximum);
    EXPECT_EQ(numbers.stretch, again.frames[i].second.stretch);
    ASSERT_EQ(numbers.error.has_value(), again.frames[i].second.error.has_value());
    if (numbers.error) {
      EXPECT_EQ(numbers.error->l1, again.frames[i].second.error->l1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Resumed, testing::ValuesIn(cases()), [](const auto& one) { return one.param; });

}  // namespace
}  // namespace gaussdrift
