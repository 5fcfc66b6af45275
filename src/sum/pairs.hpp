// The library farfield on a table of points: potential and field of Coulomb charges or of the logarithm
// (docs/usage.md, "Sums over a table of points").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "farfield/farfield.hpp"
#include "sum/points_request.hpp"
#include "sum/verdict.hpp"

namespace gaussdrift::sum {

struct PairSumRequest : PointsRequest {
  farfield::Kernel kernel = farfield::Kernel::coulomb;  // or log
  farfield::Method method = farfield::Method::automatic;
};

struct PairSums {
  int dimension = 0;
  std::vector<std::string> columns;  // "potential", then "fx", "fy", "fz" (coulomb) or "gx", "gy" (log)
  Eigen::MatrixXd values;            // targets x columns; a grid's first axis runs fastest
  farfield::Method asked = farfield::Method::automatic;
  farfield::Choice choice;
  double charge_total = 0;              // Q = sum_j |q_j|
  std::size_t compared = 0;             // targets at which the sums were compared with `direct`
  std::vector<MeasuredError> measured;  // of potential and field, relative to the sums that farfield promises them by
  double potential_of_itself = 0;       // there, root of the sum of squares, relative to that of the values: more where
  double field_of_itself = 0;           // charges cancel
  int threads = 1;
  double read_seconds = 0, prepare_seconds = 0, evaluate_seconds = 0, compare_seconds = 0, write_seconds = 0;
};

/// Compares the values with all pairs at some targets. sum_pairs() has done so, unless `direct` did the sum.
void measure_errors(const PairSumRequest& request, PairSums& sums);

/// Throws CommandLineError where the request contradicts the tables or itself. Throws InputError for tables that do not
/// belong together, a tolerance that cannot be promised, and memory or seconds beyond their limits. Throws
/// NumericalError for sums beyond the range of double.
PairSums sum_pairs(const PairSumRequest& request);

/// The choice and its cost, as text for people and as JSON.
std::string to_text(const PairSums& sums);
std::string to_json(const PairSums& sums);

}  // namespace gaussdrift::sum
