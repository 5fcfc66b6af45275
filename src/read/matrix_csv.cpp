#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "read/file_bytes.hpp"
#include "read/grid_file_error.hpp"
#include "read/matrix.hpp"

namespace gaussdrift::read {

namespace {

/// A number as tables have it, perhaps in quotation marks or with the exponent of Fortran.
std::optional<double> number_of(std::string_view text) {
  if (text.size() > 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  const std::string fortran = base::with_e(text);
  return base::read_number<double>(fortran.empty() ? text : std::string_view(fortran));
}

}  // namespace

Matrix read_csv_matrix(const std::filesystem::path& file) {
  FileBytes bytes(file);
  std::string text(static_cast<std::size_t>(bytes.size()), '\0');
  text.resize(bytes.read(0, text.data(), text.size()));
  Matrix matrix;
  std::vector<double> downwards;
  std::size_t line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++line_number;
    std::size_t columns = 0;
    for (std::size_t at = 0; at < line.size() && line[at] != '#';) {
      const auto separates = [](char c) { return c == ',' || c == ';' || std::isspace(static_cast<unsigned char>(c)); };
      if (std::isspace(static_cast<unsigned char>(line[at]))) {
        ++at;
        continue;
      }
      std::size_t stop = at;
      while (stop < line.size() && !separates(line[stop]) && line[stop] != '#') ++stop;
      const auto number = number_of(line.substr(at, stop - at));
      if (!number)
        throw GridFileError(fmt::format("{}:{}:{}: {} is not a number", bytes.name(), line_number, at + 1,
                                        base::in_quotes(line.substr(at, stop - at), 60)),
                            "a table of a density has numbers alone, row by row, the uppermost row first");
      downwards.push_back(*number);
      ++columns;
      while (stop < line.size() && std::isspace(static_cast<unsigned char>(line[stop]))) ++stop;
      at = stop < line.size() && (line[stop] == ',' || line[stop] == ';') ? stop + 1 : stop;
    }
    if (columns == 0) continue;
    if (matrix.rows > 0 && columns != matrix.columns)
      throw GridFileError(fmt::format("{}:{}: {} numbers stand here, and {} in the rows before", bytes.name(),
                                      line_number, columns, matrix.columns));
    matrix.columns = columns;
    ++matrix.rows;
  }
  if (matrix.rows == 0) throw GridFileError(fmt::format("{} has no numbers", bytes.name()));
  matrix.values.resize(downwards.size());
  for (std::size_t row = 0; row < matrix.rows; ++row)
    std::copy_n(downwards.data() + row * matrix.columns, matrix.columns,
                matrix.values.data() + (matrix.rows - 1 - row) * matrix.columns);
  return matrix;
}

}  // namespace gaussdrift::read
