// The library rbf on a table of points: sums of radial kernels and of their derivatives
// (docs/usage.md, "Sums over a table of points").
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "rbf/rbf.hpp"
#include "sum/points_request.hpp"
#include "sum/verdict.hpp"

namespace gaussdrift::sum {

struct RadialSumRequest : PointsRequest {
  rbf::Function function;
  std::vector<std::vector<int>> derivatives;  // none: the plain sum
  rbf::Method method = rbf::Method::automatic;
};

struct RadialSums {
  int dimension = 0;
  std::vector<std::vector<int>> derivatives;
  std::vector<std::string> columns;  // "d_0_1", one for every derivative
  Eigen::MatrixXd values;            // targets x derivatives; a grid's first axis runs fastest
  rbf::Method asked = rbf::Method::automatic;
  rbf::Choice choice;
  double weight_total = 0;              // Q = sum_j |lambda_j|
  std::vector<double> units;            // of each column: the largest kernel value or derivative on the range, times Q
  std::vector<double> error_bounds;     // of each column, with rounding
  std::size_t compared = 0;             // targets at which the sums were compared with `direct`
  std::vector<MeasuredError> measured;  // of each column, relative to its unit; none for `direct`
  int threads = 1;
  double read_seconds = 0, prepare_seconds = 0, evaluate_seconds = 0, compare_seconds = 0, write_seconds = 0;
};

/// Throws CommandLineError where the request contradicts the tables or itself. Throws InputError for tables that do not
/// belong together, a tolerance that cannot be promised, and memory or seconds beyond their limits. Throws
/// NumericalError for values that are not finite.
RadialSums sum_radial(const RadialSumRequest& request);

/// Compares the values with all pairs at some targets. sum_radial() has done so, unless `direct` did the sum.
void measure_errors(const RadialSumRequest& request, RadialSums& sums);

/// What was chosen and what it cost, for people and as JSON.
std::string to_text(const RadialSums& sums);
std::string to_json(const RadialSums& sums);

}  // namespace gaussdrift::sum
