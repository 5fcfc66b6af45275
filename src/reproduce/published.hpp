// The tables of tests/reference, as printed in the literature. They are part of the program. All published numbers that
// it shows come from them.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::reproduce {

struct PublishedFile {
  std::string_view name;   // "schroeder-table-4.1.csv"
  std::string_view bytes;  // as it stands in tests/reference/
};

/// In alphabetical order. Generated from tests/reference/ by cmake/EmbedFiles.cmake.
const std::vector<PublishedFile>& published_files();

/// Stands for a printed dash: a break-even that is never reached, a factor below one.
constexpr double never = std::numeric_limits<double>::infinity();

/// Rows of one table, by the name in their first column.
class PublishedTable {
 public:
  /// "schroeder-table-4.1" or "boerm-coulomb". Throws Error(ExitCode::internal) if there is none or it is no table.
  explicit PublishedTable(const std::string& name);

  std::size_t rows() const { return cells_.size(); }
  const std::vector<std::string>& columns() const { return columns_; }
  const std::string& row_name(std::size_t row) const { return cells_[row][0]; }
  const std::string& text(std::size_t row, const std::string& column) const;
  /// None where nothing is printed, `never` for a dash.
  std::optional<double> number(std::size_t row, const std::string& column) const;
  /// One unit of the last printed digit: 1e-6 of 0.955033, 1e-13 of 1.44e-11.
  double last_digit(std::size_t row, const std::string& column) const;

 private:
  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace gaussdrift::reproduce
