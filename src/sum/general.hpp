// General kernels of farfield on a table of points: sums of an expression of the distance
// (docs/usage.md, "Sums over a table of points").
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "farfield/general.hpp"
#include "sum/points_request.hpp"
#include "sum/verdict.hpp"

namespace gaussdrift::sum {

struct GeneralSumRequest : PointsRequest {
  std::string kernel;  // "exp(-r)/r"
  farfield::GeneralMethod method = farfield::GeneralMethod::automatic;
};

struct GeneralSums {
  std::string kernel;
  int dimension = 0;
  std::vector<std::string> columns;  // "sum"
  Eigen::MatrixXd values;            // targets x 1; a grid's first axis runs fastest
  farfield::GeneralMethod asked = farfield::GeneralMethod::automatic;
  farfield::GeneralChoice choice;
  double charge_total = 0;              // Q = sum_j |q_j|
  std::size_t compared = 0;             // targets at which the sums were compared with all pairs
  std::vector<MeasuredError> measured;  // in the measure that farfield promises
  double of_itself = 0;                 // the same error, relative to the values
  int threads = 1;
  double read_seconds = 0, prepare_seconds = 0, evaluate_seconds = 0, compare_seconds = 0, write_seconds = 0;
};

/// Is that the text of an expression, and no name of a kernel? Names have letters, digits and hyphens, and are not "r".
bool is_kernel_expression(std::string_view text);

/// Throws CommandLineError for an expression that is none, or where the request contradicts the tables. Throws InputError
/// for tables that do not belong together, a kernel that is not smooth enough, and memory or seconds beyond their limits.
/// Throws NumericalError for sums beyond the range of double.
GeneralSums sum_general(const GeneralSumRequest& request);

/// The choice and its cost, as text for people and as JSON.
std::string to_text(const GeneralSums& sums);
std::string to_json(const GeneralSums& sums);

}  // namespace gaussdrift::sum
