#include "base/parallel.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace gaussdrift::base {
namespace {

TEST(ParallelFor, CallsEveryPieceOnce) {
  for (const int threads : {1, 2, 5}) {
    std::vector<std::atomic<int>> calls(1000);
    parallel_for(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count.load(), 1);
  }
}

TEST(ParallelFor, PassesOnTheExceptionOfAPiece) {
  for (const int threads : {1, 2})
    EXPECT_THROW(parallel_for(100, threads,
                              [](std::size_t i) {
                                if (i == 37) throw std::runtime_error("piece 37");
                              }),
                 std::runtime_error);
}

TEST(ParallelFor, DoesNothingForNoPieces) {
  parallel_for(0, 2, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace gaussdrift::base
