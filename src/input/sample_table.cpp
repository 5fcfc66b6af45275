#include "input/sample_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <compare>
#include <numeric>

#include "gaussdrift/error.hpp"
#include "input/points_table.hpp"

namespace gaussdrift::input {

namespace {

void check_distinct(const NamedColumns& table, std::size_t columns, std::size_t dimension, const std::string& name) {
  const std::vector<double>& rows = table.rows;
  std::vector<std::size_t> order(rows.size() / columns);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto row = [&](std::size_t k) { return rows.begin() + static_cast<std::ptrdiff_t>(k * columns); };
  const auto length = static_cast<std::ptrdiff_t>(dimension);
  const auto compare = [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare_three_way(row(a), row(a) + length, row(b), row(b) + length);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto places = compare(a, b);
    return places != 0 ? places < 0 : a < b;
  });
  std::size_t first = rows.size(), second = first;  // the pair that the file tells first
  for (std::size_t i = 1; i < order.size(); ++i)
    if (compare(order[i - 1], order[i]) == 0 && order[i] < second) first = order[i - 1], second = order[i];
  if (second == rows.size()) return;
  const std::vector<double> place(row(first), row(first) + length);
  const bool same = std::equal(row(first), row(first) + static_cast<std::ptrdiff_t>(columns), row(second));
  throw InputError(fmt::format(
      "{}:{}:1: the sample at ({:g}) stands in line {} already{}; no field can be fitted to both: remove one", name,
      table.lines.line_of(second), fmt::join(place, ", "), table.lines.line_of(first),
      same ? "" : ", with different values"));
}

}  // namespace

SampleTable read_sample_table(const std::filesystem::path& file, const std::vector<std::string>& names, int dimension,
                              Coinciding coinciding) {
  constexpr std::size_t memory_limit = std::size_t{2} << 30;
  const NamedColumns read = read_named_columns(file, names, memory_limit);
  const std::vector<double>& rows = read.rows;
  const std::size_t columns = names.size(), d = static_cast<std::size_t>(dimension);
  if (coinciding == Coinciding::refused) check_distinct(read, columns, d, file.string());
  SampleTable table;
  for (std::size_t at = 0; at < rows.size(); at += columns) {
    const auto row = rows.begin() + static_cast<std::ptrdiff_t>(at);
    table.positions.insert(table.positions.end(), row, row + dimension);
    table.values.insert(table.values.end(), row + dimension, row + static_cast<std::ptrdiff_t>(columns));
  }
  return table;
}

}  // namespace gaussdrift::input
