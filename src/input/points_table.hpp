// Points from a table of comma-separated values with a line of names (docs/usage.md, "Sums over a table of points").
// Strict: whatever cannot be read as it stands is an InputError that names file, line and column.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gaussdrift::input {

/// Sources have a column `weight`, in any place; targets have coordinates only.
enum class PointsRole { sources, targets };

struct PointsTable {
  std::vector<std::string> coordinates;  // names of their columns, in order; 1 to 4
  std::vector<double> positions;         // [size][dimension]
  std::vector<double> weights;           // [size]; empty for targets
  std::vector<std::string> doubts;       // sentences about columns that may be no coordinates, each with a remedy

  int dimension() const { return static_cast<int>(coordinates.size()); }
  std::size_t size() const { return coordinates.empty() ? 0 : positions.size() / coordinates.size(); }
};

/// Which columns are coordinates, in this order; columns that are neither these nor `weight` are not looked at. None:
/// all but `weight` are, and names that are none, as id or time, are refused.
using CoordinateNames = std::vector<std::string>;

/// Throws FileError if the file cannot be read, InputError for what it contains, or if it would take more than
/// `memory_limit` bytes (text and numbers together) to read it.
PointsTable read_points_table(const std::filesystem::path& file, PointsRole role, std::size_t memory_limit,
                              const CoordinateNames& coordinates = {});

/// The same from a text; `name` stands for the file in messages.
PointsTable parse_points_table(std::string_view text, const std::string& name, PointsRole role,
                               std::size_t memory_limit, const CoordinateNames& coordinates = {});

/// The line, from 1, where each row of a table, from 0, stands in its file.
class RowLines {
 public:
  void add(std::size_t row, std::size_t line) {  // rows in ascending order
    if (runs_.empty() || line - row != runs_.back().second - runs_.back().first) runs_.emplace_back(row, line);
  }
  std::size_t line_of(std::size_t row) const {
    std::size_t k = runs_.size() - 1;
    while (runs_[k].first > row) --k;
    return runs_[k].second + (row - runs_[k].first);
  }

 private:
  std::vector<std::pair<std::size_t, std::size_t>> runs_;  // row and line at which lines begin to follow each other
};

struct NamedColumns {
  std::vector<double> rows;  // [row][column], columns in the order of the names
  RowLines lines;
};

/// A table of exactly these columns, in any order in the file. Throws as read_points_table() does.
NamedColumns read_named_columns(const std::filesystem::path& file, const std::vector<std::string>& names,
                                std::size_t memory_limit);

/// The same from a text; `name` stands for the file in messages.
NamedColumns parse_named_columns(std::string_view text, const std::string& name, const std::vector<std::string>& names,
                                 std::size_t memory_limit);

}  // namespace gaussdrift::input
