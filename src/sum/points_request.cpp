#include "sum/points_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>

#include "base/number.hpp"
#include "base/size_text.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::sum {

namespace {

double node(const GridAxis& axis, std::size_t i) {
  if (i == 0) return axis.lower;
  if (i + 1 == axis.count) return axis.upper;
  return axis.lower + (axis.upper - axis.lower) * static_cast<double>(i) / static_cast<double>(axis.count - 1);
}

// In doubles, because a product of counts may exceed an integer.
double targets_of(const PointsRequest& request) {
  if (request.targets) return static_cast<double>(request.targets->size());
  if (request.grid.empty()) return static_cast<double>(request.sources.size());
  double product = 1;
  for (const GridAxis& axis : request.grid) product *= static_cast<double>(axis.count);
  return product;
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<GridAxis> parse_grid(const std::string& text) {
  std::vector<GridAxis> grid;
  for (const std::string_view part : split(text, ',')) {
    const auto refuse = [&](const char* why) {
      throw CommandLineError(fmt::format(
          "--grid: \"{}\" {}; write lowest:highest:count for every axis, as in --grid=-1:1:200,0:1:100", part, why));
    };
    const auto numbers = split(part, ':');
    GridAxis axis;
    const auto number = [&](std::size_t k) { return base::read_number<double>(numbers[k]); };
    if (numbers.size() != 3 || !number(0) || !number(1)) refuse("is not an axis");
    axis.lower = *number(0), axis.upper = *number(1);
    const auto count = base::read_number<std::size_t>(numbers[2]);
    if (!count || *count < 1) refuse("has no positive count");
    axis.count = *count;
    if (!std::isfinite(axis.lower) || !std::isfinite(axis.upper) || !std::isfinite(axis.upper - axis.lower))
      refuse("is not finite");
    if (axis.count == 1 && axis.lower != axis.upper) refuse("has one node between two ends");
    if (axis.count > 1 && !(axis.lower < axis.upper)) refuse("does not ascend");
    grid.push_back(axis);
  }
  if (grid.size() > 4) throw CommandLineError(fmt::format("--grid has {} axes, at most 4 are possible", grid.size()));
  return grid;
}

input::CoordinateNames parse_columns(const std::string& text, const std::string& weight) {
  constexpr std::size_t most = 4;
  input::CoordinateNames names;
  if (text.empty()) return names;
  for (std::string_view name : split(text, ',')) {
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    const auto refuse = [&](const std::string& why) {
      throw CommandLineError(fmt::format("--columns {}: {}", text, why));
    };
    if (name.empty()) refuse("a name is missing; write --columns x,y");
    if (weight.empty() && name == "weight") refuse("\"weight\" is no coordinate; it is read anyway");
    if (name == weight) refuse(fmt::format("\"{}\" is the weight, by --weight", name));
    if (std::find(names.begin(), names.end(), name) != names.end()) refuse(fmt::format("\"{}\" is there twice", name));
    names.emplace_back(name);
  }
  if (names.size() > most)
    throw CommandLineError(
        fmt::format("--columns {} names {} coordinates, at most {} are possible", text, names.size(), most));
  return names;
}

std::vector<std::vector<double>> nodes_of(const std::vector<GridAxis>& grid) {
  std::vector<std::vector<double>> result;
  for (const GridAxis& axis : grid) {
    std::vector<double>& nodes = result.emplace_back(axis.count);
    for (std::size_t i = 0; i < axis.count; ++i) nodes[i] = node(axis, i);
    if (std::adjacent_find(nodes.begin(), nodes.end(), [](double a, double b) { return !(a < b); }) != nodes.end())
      throw CommandLineError(fmt::format("--grid: {} nodes from {} to {} cannot be told apart in double precision",
                                         axis.count, axis.lower, axis.upper));
  }
  return result;
}

void check_together(const PointsRequest& request) {
  const input::PointsTable& sources = request.sources;
  if (!request.grid.empty())
    if (request.grid.size() != sources.coordinates.size())
      throw CommandLineError(fmt::format("--grid has {} {}, but the sources have {} ({})", request.grid.size(),
                                         request.grid.size() == 1 ? "axis" : "axes", sources.coordinates.size(),
                                         fmt::join(sources.coordinates, ", ")));
  if (!request.targets) return;
  // Columns belong together by their place; the same names in another order are a mistake.
  const auto &from = sources.coordinates, &to = request.targets->coordinates;
  if (from.size() != to.size())
    throw InputError(fmt::format("targets have {} coordinates ({}), sources have {} ({}); both need the same",
                                 to.size(), fmt::join(to, ", "), from.size(), fmt::join(from, ", ")));
  if (from != to && std::is_permutation(from.begin(), from.end(), to.begin()))
    throw InputError(fmt::format(
        "the coordinates of the targets come in the order {}, those of the sources in the order {}; use one order",
        fmt::join(to, ", "), fmt::join(from, ", ")));
}

std::size_t memory_for_plan(const PointsRequest& request, std::size_t values) {
  const auto numbers = [](const input::PointsTable& table) { return table.positions.size() + table.weights.size(); };
  const double targets = targets_of(request);
  const double columns = static_cast<double>(values);
  double doubles = static_cast<double>(numbers(request.sources)) + targets * columns;
  if (request.targets) doubles += static_cast<double>(numbers(*request.targets));
  for (const GridAxis& axis : request.grid) doubles += static_cast<double>(axis.count);
  const double bytes = sizeof(double) * doubles, limit = static_cast<double>(request.memory_limit);
  if (bytes < limit) return request.memory_limit - static_cast<std::size_t>(bytes);
  throw InputError(
      fmt::format("{:.4g} targets with {} {} would take {} with the points; at most {} may be used; ask for fewer "
                  "targets at a time",
                  targets, columns, columns == 1 ? "value" : "values", base::size_text(bytes), base::size_text(limit)));
}

SampleOfTargets sample_targets(const PointsRequest& request) {
  constexpr double most_pairs = 2e7;
  const double sources = std::max(1.0, static_cast<double>(request.sources.size()));
  const auto targets = static_cast<std::size_t>(targets_of(request));
  const std::size_t count = std::min(targets, static_cast<std::size_t>(std::clamp(most_pairs / sources, 10.0, 200.0)));
  const auto dimension = static_cast<Eigen::Index>(request.sources.coordinates.size());
  SampleOfTargets sample{{}, Eigen::MatrixXd(dimension, static_cast<Eigen::Index>(count))};
  const input::PointsTable& table = request.targets ? *request.targets : request.sources;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t row = i * targets / count;
    sample.rows.push_back(static_cast<Eigen::Index>(row));
    for (Eigen::Index l = 0; l < dimension; ++l) {
      const auto axis = static_cast<std::size_t>(l);
      double& coordinate = sample.points(l, static_cast<Eigen::Index>(i));
      if (request.grid.empty()) {
        coordinate = table.positions[row * static_cast<std::size_t>(dimension) + axis];
      } else {
        coordinate = node(request.grid[axis], row % request.grid[axis].count);
        row /= request.grid[axis].count;
      }
    }
  }
  return sample;
}

void write_table(const std::vector<std::string>& names, const Eigen::MatrixXd& values, std::FILE* out) {
  constexpr int digits = 17;                  // enough to read the same double again
  constexpr std::size_t longest_number = 32;  // "-1.2345678901234567e-308," and room
  constexpr std::size_t block = std::size_t{1} << 16;
  const auto columns = static_cast<std::size_t>(values.cols());
  const auto flush = [out](std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), out) != text.size())
      throw std::system_error(errno, std::generic_category());
    text.clear();
  };
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  text.reserve(block + longest_number * columns);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      std::array<char, longest_number> buffer;
      const auto end =
          std::to_chars(buffer.data(), buffer.data() + buffer.size(), values(i, k), std::chars_format::general, digits)
              .ptr;
      text.append(buffer.data(), end);
      text += k + 1 < values.cols() ? ',' : '\n';
    }
    if (text.size() >= block) flush(text);
  }
  flush(text);
  if (std::fflush(out) != 0) throw std::system_error(errno, std::generic_category());
}

}  // namespace gaussdrift::sum
