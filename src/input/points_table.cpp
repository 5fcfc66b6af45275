#include "input/points_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include "base/printable.hpp"
#include "base/size_text.hpp"
#include "base/text_file.hpp"
#include "gaussdrift/error.hpp"
#include "input/column_names.hpp"
#include "input/table_columns.hpp"
#include "input/table_text.hpp"
#include "read/grid_file_error.hpp"
#include "read/npy.hpp"
#include "read/point_file.hpp"

namespace gaussdrift::input {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kind = "a table of points (CSV)";

/// The readers of data below tell problem and remedy apart.
template <class Work>
auto with_errors_of_data(const Work& work) {
  try {
    return work();
  } catch (const read::GridFileError& error) {
    throw InputError(error.remedy().empty() ? std::string(error.what())
                                            : fmt::format("{}; {}", error.what(), error.remedy()));
  }
}

RefuseColumn refusal_of(const std::string& name) {
  return [&name](std::optional<std::size_t>, const std::string& what) {
    throw InputError(fmt::format("{}: {}", name, what));
  };
}

void check_memory(const std::string& name, std::size_t points, double bytes, std::size_t memory_limit) {
  if (bytes > static_cast<double>(memory_limit))
    throw InputError(fmt::format("{} has {} points and would take {} to read; at most {} may be used", name, points,
                                 base::size_text(bytes), base::size_text(static_cast<double>(memory_limit))));
}

void check_numbers(const std::string& name, const TextTable& table, const std::vector<std::string>& columns,
                   const ChosenColumns& chosen) {
  const auto refuse = [&](double value, std::size_t row, std::size_t column) {
    throw InputError(
        fmt::format("{}: {} of point {} (counted from 1) is {}; numbers must be finite, so leave the point "
                    "out",
                    name, base::in_quotes(columns[column]), row + 1, value));
  };
  const std::size_t width = chosen.coordinates.size();
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (!std::isfinite(table.rows[i])) refuse(table.rows[i], i / width, chosen.coordinates[i % width]);
  for (std::size_t i = 0; i < table.weights.size(); ++i)
    if (!std::isfinite(table.weights[i])) refuse(table.weights[i], i, *chosen.weight);
}

/// What is the same of every file that is no text.
TextTable begun(const TableColumns& columns, const ChosenColumns& chosen, std::size_t points, const std::string& name) {
  if (points == 0) throw InputError(fmt::format("{} has no points", name));
  TextTable table;
  for (const std::size_t column : chosen.coordinates) table.names.push_back(columns.names[column]);
  table.lines.add(0, 1);
  return table;
}

TextTable table_of_npy(std::string_view bytes, const std::string& name, const WantedColumns& wanted,
                       std::size_t memory_limit) {
  const read::NpyArray array = with_errors_of_data([&] { return read::parse_npy(bytes, name); });
  constexpr std::size_t most_columns = 10000;
  if (array.columns > most_columns)
    throw InputError(
        fmt::format("{} has {} columns, at most {} are possible; a point is a row", name, array.columns, most_columns));
  TableColumns columns{.names = {}, .named = false};
  for (std::size_t k = 0; k < array.columns; ++k) columns.names.push_back(fmt::format("{}", k + 1));
  const ChosenColumns chosen = choose_columns(columns, wanted, refusal_of(name));
  TextTable table = begun(columns, chosen, array.rows, name);
  const std::size_t width = chosen.coordinates.size();
  check_memory(name, array.rows,
               static_cast<double>(bytes.size()) +
                   8.0 * static_cast<double>(array.rows) * static_cast<double>(width + (chosen.weight ? 1 : 0)),
               memory_limit);
  table.rows.resize(array.rows * width);
  for (std::size_t k = 0; k < width; ++k) array.copy_column(chosen.coordinates[k], table.rows.data() + k, width);
  if (chosen.weight) {
    table.weights.resize(array.rows);
    array.copy_column(*chosen.weight, table.weights.data(), 1);
  }
  check_numbers(name, table, columns.names, chosen);
  return table;
}

TextTable table_of_point_file(const fs::path& file, const WantedColumns& wanted, std::size_t memory_limit) {
  const std::string name = file.string();
  return with_errors_of_data([&] {
    read::PointFile points(file);
    TableColumns columns{.names = points.columns(), .named = true, .places = 3};
    constexpr std::size_t most_at_once = 9;  // components of an array
    const double a_column = 8.0 * static_cast<double>(points.size());
    check_memory(name, points.size(), most_at_once * a_column, memory_limit);
    if (wanted.table != WantedColumns::Table::exactly && wanted.coordinates.empty() && points.is_flat())
      columns.places = 2;
    const ChosenColumns chosen = choose_columns(columns, wanted, refusal_of(name));
    TextTable table = begun(columns, chosen, points.size(), name);
    check_memory(name, points.size(), static_cast<double>(chosen.coordinates.size() + 1 + most_at_once) * a_column,
                 memory_limit);
    table.rows = points.read(chosen.coordinates);
    if (chosen.weight) table.weights = points.read({*chosen.weight});
    check_numbers(name, table, columns.names, chosen);
    return table;
  });
}

TextTable table_of_bytes(std::string_view bytes, const std::string& name, const WantedColumns& wanted,
                         std::size_t memory_limit) {
  if (bytes.substr(0, read::npy_mark.size()) == read::npy_mark) return table_of_npy(bytes, name, wanted, memory_limit);
  return parse_text_table(bytes, name, wanted, memory_limit);
}

/// How the file begins; nothing where that cannot be known without taking it from a pipe.
std::string beginning_of(const fs::path& file, std::size_t most) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return {};
  std::ifstream in(file, std::ios::binary);
  std::string bytes(most, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(most));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  return bytes;
}

bool is_point_file(const fs::path& file) {
  const std::string begins = beginning_of(file, 8);
  return begins.starts_with("<?xml") || begins.starts_with("<VTKFile");
}

TextTable table_of_file(const fs::path& file, const WantedColumns& wanted, std::size_t memory_limit) {
  if (is_point_file(file)) return table_of_point_file(file, wanted, memory_limit);
  return table_of_bytes(base::read_text_file(file, kind, memory_limit), file.string(), wanted, memory_limit);
}

WantedColumns wanted_of(PointsRole role, const PointsColumns& columns) {
  using Table = WantedColumns::Table;
  return {.table = role == PointsRole::sources ? Table::sources : Table::targets,
          .coordinates = columns.coordinates,
          .weight = columns.weight,
          .weight_may_lack = columns.weight_may_lack};
}

/// One sentence about each column that may be no coordinate.
std::vector<std::string> doubts_of(const TextTable& table, const std::string& name) {
  std::vector<std::string> doubts;
  for (const std::string& doubt : doubtful_coordinates(table.names, table.rows)) {
    std::vector<std::string> axes;
    std::copy_if(table.names.begin(), table.names.end(), std::back_inserter(axes), names_an_axis);
    doubts.push_back(fmt::format("{}: {}; {}--columns {} says that it is one", name, doubt,
                                 axes.empty() ? "" : fmt::format("--columns {} leaves it out, ", listed(axes, ",")),
                                 listed(table.names, ",")));
  }
  return doubts;
}

PointsTable points_of(TextTable&& table, const std::string& name, const WantedColumns& wanted) {
  PointsTable points;
  if (wanted.coordinates.empty()) points.doubts = doubts_of(table, name);
  points.coordinates = std::move(table.names);
  points.positions = std::move(table.rows);
  points.weights = std::move(table.weights);
  if (wanted.table == WantedColumns::Table::sources && points.weights.empty())
    points.weights.assign(points.size(), 1.0);
  return points;
}

WantedColumns exactly(const std::vector<std::string>& names) {
  return {.table = WantedColumns::Table::exactly, .coordinates = names};
}

}  // namespace

PointsTable parse_points_table(std::string_view bytes, const std::string& name, PointsRole role,
                               std::size_t memory_limit, const PointsColumns& columns) {
  const WantedColumns wanted = wanted_of(role, columns);
  return points_of(table_of_bytes(bytes, name, wanted, memory_limit), name, wanted);
}

PointsTable read_points_table(const fs::path& file, PointsRole role, std::size_t memory_limit,
                              const PointsColumns& columns) {
  if (file == standard_input)
    return parse_points_table(base::read_standard_input(kind, memory_limit), std::string(standard_input_name), role,
                              memory_limit, columns);
  const WantedColumns wanted = wanted_of(role, columns);
  return points_of(table_of_file(file, wanted, memory_limit), file.string(), wanted);
}

NamedColumns parse_named_columns(std::string_view bytes, const std::string& name, const std::vector<std::string>& names,
                                 std::size_t memory_limit) {
  TextTable table = table_of_bytes(bytes, name, exactly(names), memory_limit);
  return {std::move(table.rows), std::move(table.lines)};
}

NamedColumns read_named_columns(const fs::path& file, const std::vector<std::string>& names, std::size_t memory_limit) {
  TextTable table = table_of_file(file, exactly(names), memory_limit);
  return {std::move(table.rows), std::move(table.lines)};
}

bool has_third_coordinate(const fs::path& file, std::size_t memory_limit) {
  constexpr std::size_t looked_at = 65536;
  const std::string begins = beginning_of(file, looked_at);
  try {
    if (is_point_file(file)) {
      read::PointFile points(file);
      return 24.0 * static_cast<double>(points.size()) < static_cast<double>(memory_limit) && !points.is_flat();
    }
    if (begins.starts_with(read::npy_mark))
      return read::parse_npy(base::read_text_file(file, kind, memory_limit), file.string()).columns == 4;
  } catch (const read::GridFileError&) {
    return false;
  }
  const std::vector<std::string> names = names_in(begins);
  return std::find(names.begin(), names.end(), "z") != names.end();
}

}  // namespace gaussdrift::input
