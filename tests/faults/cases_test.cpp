// Kills in the cases of cases/, small.
#include "faults/suffering.hpp"

namespace gaussdrift {
namespace {

std::vector<std::string> all_cases() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(SOURCE_DIR "/cases"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class KilledCase : public Faults, public testing::WithParamInterface<std::string> {};

TEST_P(KilledCase, GoesOnWithTheSameBits) {
  const long calls = begin_with("run '" SOURCE_DIR "/cases/" + GetParam() +
                                ".toml' --set particles.per_axis=31 --set evaluate.per_axis=15 --set "
                                "output.images=[] --set 'output.report=\"none\"' --set output.checkpoint=1e-9")
                         .calls;
  for (const long at : spread(0, calls, std::max(1L, faults_of_a_test(1) / 20))) suffer(killed_at(at), of_kills);
  tell("calls killed " + GetParam(), calls);
}

/// tools/torture takes all.
INSTANTIATE_TEST_SUITE_P(Cases, KilledCase,
                         testing::ValuesIn(many_are_asked() ? all_cases()
                                                            : std::vector<std::string>{"decay", "gridded_wind",
                                                                                       "kirchhoff", "taylor_green"}),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace gaussdrift
