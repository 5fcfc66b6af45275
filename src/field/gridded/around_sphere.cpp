#include "field/gridded/around_sphere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

namespace gaussdrift {

namespace {

constexpr double whole = 360;

/// A longitude, and the column of the data that belongs to it.
using Column = std::pair<double, std::size_t>;

/// The columns of data that go all the way round, from middle - 180 to middle + 180 and two more on either side: as many
/// as cubics look at.
std::vector<Column> all_round(const std::vector<double>& axis, std::size_t different, double middle) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < different; ++i)
    columns.emplace_back(axis[i] - whole * std::floor((axis[i] - middle + whole / 2) / whole), i);
  std::sort(columns.begin(), columns.end());
  constexpr std::size_t more = 2;
  std::vector<Column> with_ends;
  for (std::size_t i = different - std::min(more, different); i < different; ++i)
    with_ends.emplace_back(columns[i].first - whole, columns[i].second);
  with_ends.insert(with_ends.end(), columns.begin(), columns.end());
  for (std::size_t i = 0; i < std::min(more, different); ++i)
    with_ends.emplace_back(columns[i].first + whole, columns[i].second);
  return with_ends;
}

std::vector<double> with_columns(const std::vector<double>& values, std::size_t row, std::size_t components,
                                 const std::vector<Column>& columns) {
  const std::size_t rows = values.size() / (row * components);
  std::vector<double> some;
  some.reserve(rows * columns.size() * components);
  for (std::size_t j = 0; j < rows; ++j)
    for (const auto& [longitude, column] : columns) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>((j * row + column) * components);
      some.insert(some.end(), first, first + static_cast<std::ptrdiff_t>(components));
    }
  return some;
}

void check_latitudes(const GridData& data) {
  constexpr double rounding = 1e-6;
  const double south = data.axis[1].front(), north = data.axis[1].back();
  if (south < -90 - rounding || north > 90 + rounding)
    throw std::invalid_argument(fmt::format(
        "{} reaches from {:g} to {:g} along y, and latitudes lie between -90 and 90", data.name, south, north));
}

}  // namespace

std::shared_ptr<const GridData> around_sphere(const std::shared_ptr<const GridData>& data, double middle) {
  if (data->curved) return data;
  check_latitudes(*data);
  const std::vector<double>& axis = data->axis[0];
  const std::size_t count = axis.size();
  const double length = axis.back() - axis.front(), spacing = length / static_cast<double>(count - 1);
  const bool ends_meet = std::abs(length - whole) < 1e-3 * spacing;
  if (length > whole + 1e-3 * spacing)
    throw std::invalid_argument(
        fmt::format("{} reaches over {:g} degrees of longitude, and there are 360", data->name, length));
  const bool round = ends_meet || std::abs(length + spacing - whole) < 0.1 * spacing;
  const double turns = std::round((middle - (axis.front() + axis.back()) / 2) / whole);
  if (!round && turns == 0) return data;
  auto moved = std::make_shared<GridData>(*data);
  if (!round) {
    for (double& longitude : moved->axis[0]) longitude += whole * turns;
    return moved;
  }
  const std::vector<Column> columns = all_round(axis, ends_meet ? count - 1 : count, middle);
  moved->axis[0].clear();
  for (const auto& [longitude, column] : columns) moved->axis[0].push_back(longitude);
  const auto change = [count, components = data->components, columns](const std::vector<double>& values) {
    return with_columns(values, count, components, columns);
  };
  for (std::vector<double>& values : moved->values) values = change(values);
  if (data->levels) moved->levels = data->levels->changed(change);
  return moved;
}

}  // namespace gaussdrift
