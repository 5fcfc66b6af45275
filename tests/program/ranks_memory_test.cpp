// The memory of several ranks: those of a host count together.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "accuracy/memory_limits.hpp"
#include "accuracy/rank_forecast.hpp"
#include "accuracy/ranks_memory.hpp"
#include "case_text.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "ranks_of_threads.hpp"

namespace gaussdrift {
namespace {

/// Three million particles in 16 tiles and more. No rank gathers them.
Case large_case() {
  return parse_case(case_text({.density = shape_of("wendland", "0, 0", "0.9"),
                               .particles = "per_axis = 2200",
                               .evaluate = "per_axis = 400",
                               .output = "times = [0]\nimages = []\nvtk = []\nreport = \"none\"\ncheckpoint = 0"}),
                    "scene.toml", {"accuracy.budget=\"none\"", "evaluate.tile_particles=100000"})
      .spec;
}

/// What a rank said; empty: it fits.
std::vector<std::string> refusals(const Case& spec, double asked, int ranks, int hosts) {
  std::vector<std::string> said;
  for (const std::exception_ptr& end : ends_on_ranks(
           ranks,
           [&](base::Communicator& communicator) {
             accuracy::refuse_what_does_not_fit(spec, 1, communicator.rank() == 0 ? asked : accuracy::no_limit,
                                                communicator);
           },
           hosts)) {
    said.emplace_back();
    if (!end) continue;
    try {
      std::rethrow_exception(end);
    } catch (const InputError& error) {
      said.back() = error.what();
    }
  }
  return said;
}

TEST(RanksMemory, OfOneHostCountsTogether) {
  const Case spec = large_case();
  const std::vector<accuracy::RunMemory> memory = accuracy::forecast_ranks(spec, 3.1e6, 0, 4).memory;
  ASSERT_EQ(memory.size(), 4u);
  double all = 0, most = 0;
  for (const auto& of_rank : memory) all += of_rank.all(), most = std::max(most, of_rank.all());
  EXPECT_LT(most, 0.4 * all);
  const double held = accuracy::memory_of_this_process();  // by each of the ranks, which are threads here
  // Room for two of four ranks on a host, and not for four.
  const double room = 2 * held + 0.75 * all;
  EXPECT_EQ(refusals(spec, room, 4, 2), std::vector<std::string>(4));
  const std::vector<std::string> said = refusals(spec, room, 4, 1);
  EXPECT_EQ(said[0].find("4 ranks of the run would take about "), 0u) << said[0];
  for (const char* words : {" of memory on ", " together, and --memory allows ", " for particles, ",
                            " for the programs; ", "start the ranks on more hosts, or lower particles.per_axis"})
    EXPECT_NE(said[0].find(words), std::string::npos) << words << "\n" << said[0];
  EXPECT_EQ(said[3], said[0]);
}

/// With checkpoints, a page and a budget, as by default.
TEST(RanksMemory, OfRank0DoesNotGrowWithAllParticles) {
  Case spec = large_case();
  spec.output.report = true, spec.output.checkpoint.reset(), spec.accuracy.budget = AccuracySpec{}.budget;
  const auto of_rank_0 = [&](int ranks) { return accuracy::forecast_ranks(spec, 3.1e6, 0, ranks).memory[0].particles; };
  spec.output.piece_particles = 1e5;
  EXPECT_LT(of_rank_0(4), 0.4 * of_rank_0(1));
  spec.output.piece_particles = 1e7;
  EXPECT_GT(of_rank_0(4), 0.9 * of_rank_0(1)) << "so many are brought together";
}

TEST(RanksMemory, OfOneRankIsAsEver) {
  const Case spec = large_case();
  const std::vector<std::string> said = refusals(spec, accuracy::memory_of_this_process() + 1e7, 1, 1);
  EXPECT_EQ(said[0].find("the run would take about "), 0u) << said[0];
}

// The check must not cost small runs a trial: the most that they could take is little.
TEST(RanksMemory, OfASmallCaseFits) {
  const Case spec = parse_case(case_text(CaseTables{}), "scene.toml", {}).spec;
  EXPECT_EQ(refusals(spec, accuracy::no_limit, 8, 2), std::vector<std::string>(8));
}

}  // namespace
}  // namespace gaussdrift
