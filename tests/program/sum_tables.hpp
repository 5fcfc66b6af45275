// Tables for `gaussdrift sum`, and what it writes.
#pragma once

#include <charconv>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace gaussdrift {

using Rows = std::vector<std::vector<double>>;

struct Table {
  std::string header;
  Rows rows;
};

inline Table table_of(const std::string& text) {
  Table table;
  std::istringstream lines(text);
  std::getline(lines, table.header);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    table.rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) table.rows.back().push_back(std::stod(cell));
  }
  return table;
}

/// Points that fill the unit cube without a pattern; the last column is the weight, of both signs.
inline Rows points(int count, int columns) {
  Rows rows(count, std::vector<double>(columns));
  std::uint64_t state = 12345;
  for (auto& row : rows)
    for (double& entry : row) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      entry = static_cast<double>(state >> 11) * 0x1p-53;
    }
  return rows;
}

inline std::string csv(const std::string& header, const Rows& rows) {
  std::string text = header + "\n";
  for (const auto& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) {
      char buffer[32];
      text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, row[k]).ptr);
      text += k + 1 < row.size() ? "," : "\n";
    }
  return text;
}

inline const std::vector<std::string> headers{"", "x,weight", "x,y,weight", "x,y,z,weight", "x,y,z,w,weight"};
inline const std::vector<std::string> target_headers{"", "x", "x,y", "x,y,z", "x,y,z,w"};

}  // namespace gaussdrift
