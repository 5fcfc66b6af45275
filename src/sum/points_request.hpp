// The request of a sum over a table of points: sources, and targets, which are a table, a grid or the sources
// themselves (docs/usage.md, "Sums over a table of points"). Also writes the values as a table.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/points_table.hpp"

namespace gaussdrift::sum {

/// `count` nodes at equal distances, both ends among them.
struct GridAxis {
  double lower = 0, upper = 0;
  std::size_t count = 0;
};

struct PointsRequest {
  input::PointsTable sources;
  std::optional<input::PointsTable> targets;  // neither targets nor grid: the sources are the targets
  std::vector<GridAxis> grid;                 // one for every coordinate
  double tolerance = 1e-6;
  int threads = 0;                                                // 0: all
  std::size_t memory_limit = std::size_t{8} << 30;                // bytes of points, values and plan together
  double most_seconds = std::numeric_limits<double>::infinity();  // of the clock, that may be predicted
  std::function<void(const std::string&)> tell = {};              // what takes long, before it begins
  std::function<void(double)> predicted = {};                     // its seconds of the clock, then
};

/// "-1:1:200,-1:1:200". Throws CommandLineError.
std::vector<GridAxis> parse_grid(const std::string& text);

/// "x,y" or "1,2": names or numbers of columns, beside that of the weight ("": the name "weight"). Throws
/// CommandLineError.
input::CoordinateNames parse_columns(const std::string& text, const std::string& weight);

/// The nodes of every axis. Throws CommandLineError for nodes that a double cannot tell apart.
std::vector<std::vector<double>> nodes_of(const std::vector<GridAxis>& grid);

/// Throws CommandLineError for a grid, InputError for targets that do not belong to the sources.
void check_together(const PointsRequest& request);

/// Bytes that are left for the plan when the points, the nodes and `columns` values a target have their memory.
/// Throws InputError if nothing is.
std::size_t memory_for_plan(const PointsRequest& request, std::size_t columns);

/// Some of the targets, evenly taken from all.
struct SampleOfTargets {
  std::vector<Eigen::Index> rows;
  Eigen::MatrixXd points;  // [dimension x rows]
};
/// How many targets are compared with all pairs in a fraction of a second: 10 to 200.
SampleOfTargets sample_targets(const PointsRequest& request);

/// A header line, then a line for every row of `values` with 17 significant digits. Throws std::system_error.
void write_table(const std::vector<std::string>& columns, const Eigen::MatrixXd& values, std::FILE* out);

std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace gaussdrift::sum
