// Ranks of a machine share its cores.
#include "cli/rank_threads.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "ranks_of_threads.hpp"

namespace gaussdrift::cli {
namespace {

using Cores = std::vector<int>;

/// By rank, for the cores that each may use; the first ranks are on the first host.
std::vector<int> threads(const std::vector<Cores>& cores, int hosts = 1) {
  std::vector<int> found(cores.size());
  const auto share = [&](base::Communicator& ranks) {
    const auto own = static_cast<std::size_t>(ranks.rank());
    found[own] = threads_of_rank(ranks, cores[own]);
  };
  on_ranks(static_cast<int>(cores.size()), share, hosts);
  return found;
}

TEST(ThreadsOfRank, AreAllCoresForOne) { EXPECT_EQ(threads({{0, 1, 2, 7}}), (std::vector<int>{4})); }

TEST(ThreadsOfRank, AreEqualPartsOfTheSameCores) {
  EXPECT_EQ(threads({{0, 1, 2, 3}, {0, 1, 2, 3}}), (std::vector<int>{2, 2}));
  EXPECT_EQ(threads({{0, 1}, {0, 1}, {0, 1}}), (std::vector<int>{1, 1, 1}));  // more ranks than cores
}

TEST(ThreadsOfRank, AreItsOwnCoresWhereItIsBoundToThem) {
  EXPECT_EQ(threads({{0, 1}, {2, 3}, {4}}), (std::vector<int>{2, 2, 1}));
  EXPECT_EQ(threads({{0, 1, 2, 3}, {2, 3}, {4, 5}}), (std::vector<int>{2, 1, 2}));
}

TEST(ThreadsOfRank, AreNotSharedWithAnotherHost) {
  EXPECT_EQ(threads({{0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1}}, 2), (std::vector<int>{2, 2, 2, 1}));
}

TEST(ThreadsOfRank, AreOneWhereTheSystemDoesNotTell) { EXPECT_EQ(threads({{}, {}}), (std::vector<int>{1, 1})); }

}  // namespace
}  // namespace gaussdrift::cli
