// The published heights of the rotating cone, all 120 of them, against the tables as printed.
#include "reproduce/cone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace gaussdrift::reproduce {
namespace {

// A table as printed: row name -> column name -> number.
std::map<std::string, std::map<std::string, double>> read_table(const std::string& file) {
  std::ifstream in(std::string(REFERENCE_DIR) + "/" + file);
  std::map<std::string, std::map<std::string, double>> table;
  std::vector<std::string> header;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (header.empty())
      header = cells;
    else
      for (std::size_t k = 1; k < cells.size(); ++k) table[cells[0]][header[k]] = std::stod(cells[k]);
  }
  return table;
}

TEST(ReproduceCone, AgreesWithAllPublishedHeights) {
  const auto table_51 = read_table("schroeder-table-5.1.csv"), table_52 = read_table("schroeder-table-5.2.csv");
  const std::map<std::string, std::string> column{{"0", "t0"}, {"2 pi", "t2pi"}, {"20 pi", "t20pi"}};
  const ConeReproduction result = reproduce_cone(0);
  ASSERT_EQ(result.heights.size(), 120u);
  for (const ConeHeight& entry : result.heights) {
    const std::string c = std::to_string(entry.overlap);
    const double published = entry.table == 51 ? table_51.at(c).at("ng" + std::to_string(entry.per_axis))
                                               : table_52.at(c).at(column.at(entry.time));
    EXPECT_NEAR(entry.computed, published, cone_agreement)
        << "Table " << entry.table << ", n_g = " << entry.per_axis << ", c = " << c << ", t = " << entry.time;
    EXPECT_EQ(entry.published, published);  // what the program prints beside it is what was printed
  }
}

}  // namespace
}  // namespace gaussdrift::reproduce
