// The library fgtd on a table of points: reads nothing, writes the values of the sum as a table
// (docs/usage.md, "Sums over a table of points").
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fgtd/fgtd.hpp"
#include "sum/points_request.hpp"
#include "sum/verdict.hpp"

namespace gaussdrift::sum {

struct SumRequest : PointsRequest {
  double sigma = 0;                           // the Gaussian is exp(-sigma r^2)
  std::vector<std::vector<int>> derivatives;  // none: the plain sum
  fgtd::Method method = fgtd::Method::automatic;
  std::optional<fgtd::HermiteParameters> hermite = {};  // by hand: their bound takes the place of the tolerance
  std::string column = {};                              // what the plain sum is called; empty: "d_0_0"
};

/// "2", or "all": the n of HermiteParameters. Throws CommandLineError.
int parse_neighbours(const std::string& text);

struct PointSums {
  int dimension = 0;
  double sigma = 0;
  std::string bandwidth;                        // that was asked for in place of sigma (sum/density.hpp)
  std::vector<std::vector<double>> covariance;  // of the Gaussians where they are not round by themselves; else none
  bool normalised = false;                      // the sum is a density
  std::vector<std::vector<int>> derivatives;
  std::vector<std::string> columns;  // "d_0_1_2", one for every derivative
  Eigen::MatrixXd values;            // targets x derivatives; a grid's first axis runs fastest
  fgtd::Method asked = fgtd::Method::automatic;
  fgtd::Choice choice;
  double weight_total = 0;                          // Q = sum_j |lambda_j|
  std::vector<std::optional<double>> error_bounds;  // of each column: with rounding, for all of Q; none without a bound
  std::size_t compared = 0;                         // targets at which the sums were compared with `direct`
  std::vector<MeasuredError> measured;              // of each column, relative to its unit; none for `direct`
  std::vector<double> units;                        // N_alpha Q
  int threads = 1;
  double read_seconds = 0, prepare_seconds = 0, evaluate_seconds = 0, compare_seconds = 0, write_seconds = 0;
};

/// Throws CommandLineError where the request contradicts the tables or itself. Throws InputError for tables that do not
/// belong together, a tolerance that cannot be promised, and memory or seconds beyond their limits. Throws
/// NumericalError for values that are not finite.
PointSums sum_points(const SumRequest& request);

/// Compares the values with all pairs at some targets. sum_points() has done so, unless `direct` did the sum.
void measure_errors(const SumRequest& request, PointSums& sums);

/// What was chosen and what it cost, for people and as JSON.
std::string to_text(const PointSums& sums);
std::string to_json(const PointSums& sums);

}  // namespace gaussdrift::sum
