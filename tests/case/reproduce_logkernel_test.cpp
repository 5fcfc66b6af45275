// The tables of the logarithmic kernel, for few points.
#include "parsed_json.hpp"
#include "reproduce/logkernel.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "scratch_folder.hpp"

namespace gaussdrift::reproduce {
namespace {

TEST(ReproduceLogkernel, WritesItsTablesAndPlots) {
  const ScratchFolder folder;
  const LogKernelReproduction result = reproduce_logkernel(
      {.folder = folder.path(), .largest_storage = 7, .largest_error = 7, .largest_product = 10, .largest_dense = 10});
  ASSERT_EQ(result.storage.size(), 6u * 6u);
  EXPECT_EQ(result.storage.front().doubles, 16u);  // 4 points: all single entries
  for (const LogKernelStorage& row : result.storage) {
    EXPECT_LE(row.shared, row.doubles);
    EXPECT_LE(row.leaf, row.points * row.points);
  }
  ASSERT_EQ(result.errors.size(), 2u * 6u);
  for (std::size_t i = 0; i < result.errors.size(); ++i)
    EXPECT_TRUE(result.errors[i].degree == 0 || result.errors[i].squared < result.errors[i - 1].squared / 16);
  ASSERT_EQ(result.times.size(), 1u);
  EXPECT_LT(result.times[0].difference, 3.4e-5);  // blocks of degree 3 against the exact product by FFT
  ASSERT_EQ(result.files.size(), 9u);             // tables, and charts in three formats
  for (const auto& file : result.files) EXPECT_GT(std::filesystem::file_size(file), 50u) << file;
  std::ifstream storage(folder / "storage.csv");
  std::string line;
  std::getline(storage, line);
  EXPECT_EQ(line, "N,n,blocks,low_rank_blocks,doubles,doubles_shared_bases,doubles_leaf_16,doubles_both");
  std::getline(storage, line);
  EXPECT_EQ(line, "4,0,16,0,16,16,16,16");
  EXPECT_EQ(parsed_json(to_json(result))["errors"].size(), 12u);
}

}  // namespace
}  // namespace gaussdrift::reproduce
