// What Figures 3.3 to 3.5 of [Sch06] print beside their boxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "reproduce/figures.hpp"
#include "reproduce/neighbour_boxes.hpp"

namespace gaussdrift::reproduce {
namespace {

TEST(NeighbourBoxes, AreAsManyAsTheFigureShows) {
  const BoxIndices along{7, 5}, of{3, 1};  // 35 boxes, B so near an edge that five of 25 fall away for n = 2
  EXPECT_EQ(neighbour_boxes(0, of, along).size(), 1u);
  EXPECT_EQ(neighbour_boxes(1, of, along).size(), 9u);
  EXPECT_EQ(neighbour_boxes(2, of, along).size(), 20u);
  EXPECT_EQ(neighbour_boxes(3, of, along).size(), 35u);
}

TEST(NeighbourBoxes, ComeInTheOrderOfTheFigure) {
  const BoxIndices along{7, 4}, of{1, 2};
  const std::vector<std::size_t> found = neighbour_boxes(2, of, along);
  ASSERT_EQ(found.size(), 16u);  // printed: n_c = 16, the rows 0..3, 4..7, 8 B_i 10 11, 12..15
  EXPECT_EQ(found[9], box_number(of, along));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(found[static_cast<std::size_t>(4 * row + column)], box_number({column, row}, along));
}

TEST(NeighbourBoxes, AreThoseOfAPlainSearchInSpace) {
  const BoxIndices along{4, 5, 3}, of{3, 2, 0};
  std::set<std::size_t> expected;
  for (int k = 0; k < along[2]; ++k)
    for (int j = 0; j < along[1]; ++j)
      for (int i = 0; i < along[0]; ++i)
        if (std::max({std::abs(i - of[0]), std::abs(j - of[1]), std::abs(k - of[2])}) <= 1)
          expected.insert(box_number({i, j, k}, along));
  const std::vector<std::size_t> found = neighbour_boxes(1, of, along);
  EXPECT_EQ(std::set<std::size_t>(found.begin(), found.end()), expected);
  EXPECT_EQ(found.size(), expected.size());
}

TEST(Figures, AreAllThatTheThesisHas) {
  const std::vector<std::string> expected{"2.1", "3.1", "3.2", "3.3", "3.4", "3.5", "3.6", "3.7",
                                          "4.1", "4.2", "5.1", "5.2", "5.3", "5.4", "5.5"};
  EXPECT_EQ(figure_numbers(), expected);
}

}  // namespace
}  // namespace gaussdrift::reproduce
