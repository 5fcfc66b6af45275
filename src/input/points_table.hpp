// Points from a table: text with a line of names, a NumPy array, or the points of a ParaView file (docs/usage.md, "Sums
// over a table of points"). Strict: whatever cannot be read as it stands is an InputError that names file, line and column.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gaussdrift::input {

/// Sources have a weight, in any column; targets have coordinates only.
enum class PointsRole { sources, targets };

struct PointsTable {
  std::vector<std::string> coordinates;  // names of their columns, in order; 1 to 4. Where there are no names, numbers
  std::vector<double> positions;         // [size][dimension]
  std::vector<double> weights;           // [size]; empty for targets
  std::vector<std::string> doubts;       // sentences about columns that may be no coordinates, each with a remedy

  int dimension() const { return static_cast<int>(coordinates.size()); }
  std::size_t size() const { return coordinates.empty() ? 0 : positions.size() / coordinates.size(); }
};

/// Which columns are coordinates, in this order, by their names or their numbers from 1; columns that are neither these
/// nor the weight are not looked at. None: all but the weight are, and names that are none, as id or time, are refused.
using CoordinateNames = std::vector<std::string>;

struct PointsColumns {
  CoordinateNames coordinates = {};
  std::string weight = {};       // name or number of its column; empty: "weight"
  bool weight_may_lack = false;  // without a column "weight" all weights are 1
};

/// The name of standard input among those of files, and what messages call it.
constexpr std::string_view standard_input = "-", standard_input_name = "standard input";

/// Throws FileError if the file cannot be read, InputError for what it contains, or if it would take more than
/// `memory_limit` bytes (text and numbers together) to read it.
PointsTable read_points_table(const std::filesystem::path& file, PointsRole role, std::size_t memory_limit,
                              const PointsColumns& columns = {});

/// The same from the bytes of a text or of a NumPy array; `name` stands for the file in messages.
PointsTable parse_points_table(std::string_view bytes, const std::string& name, PointsRole role,
                               std::size_t memory_limit, const PointsColumns& columns = {});

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
  RowLines lines;            // of a file that is no text, the number of the row
};

/// A table of exactly these columns, in any order in the file. A NumPy array has them in this order. A ParaView file has
/// x, y and z as places of its points, the others as arrays, and may have more. Throws as read_points_table() does.
NamedColumns read_named_columns(const std::filesystem::path& file, const std::vector<std::string>& names,
                                std::size_t memory_limit);

/// The same from bytes, as parse_points_table() takes them.
NamedColumns parse_named_columns(std::string_view bytes, const std::string& name, const std::vector<std::string>& names,
                                 std::size_t memory_limit);

/// Does a table of points that are all in a plane or in space have a third coordinate: a column "z" of a text, four columns
/// of a NumPy array, a ParaView file with a z that is not 0? False for whatever cannot be read.
bool has_third_coordinate(const std::filesystem::path& file, std::size_t memory_limit);

}  // namespace gaussdrift::input
