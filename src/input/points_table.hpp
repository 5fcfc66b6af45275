// Points from a table of comma-separated values with a header line (docs/usage.md, "Sums over a table of points").
// Strict: whatever cannot be read as it stands is an InputError that names file, line and column.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::input {

/// Sources have a column `weight`, in any place; targets have coordinates only.
enum class PointsRole { sources, targets };

struct PointsTable {
  std::vector<std::string> coordinates;  // names of the columns but `weight`, in order; 1 to 4
  std::vector<double> positions;         // [size][dimension]
  std::vector<double> weights;           // [size]; empty for targets

  int dimension() const { return static_cast<int>(coordinates.size()); }
  std::size_t size() const { return coordinates.empty() ? 0 : positions.size() / coordinates.size(); }
};

/// Throws FileError if the file cannot be read, InputError for what it contains, or if it would take more than
/// `memory_limit` bytes (text and numbers together) to read it.
PointsTable read_points_table(const std::filesystem::path& file, PointsRole role, std::size_t memory_limit);

/// The same from a text; `name` stands for the file in messages.
PointsTable parse_points_table(std::string_view text, const std::string& name, PointsRole role,
                               std::size_t memory_limit);

/// A table of exactly these columns, in any order in the file: [row][column], in the order of `names`.
/// Throws as read_points_table() does.
std::vector<double> read_named_columns(const std::filesystem::path& file, const std::vector<std::string>& names,
                                       std::size_t memory_limit);

/// The same from a text; `name` stands for the file in messages.
std::vector<double> parse_named_columns(std::string_view text, const std::string& name,
                                        const std::vector<std::string>& names, std::size_t memory_limit);

}  // namespace gaussdrift::input
