// The derivatives that a sum over a table of points is asked for, and its columns: one for each.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "fgtd/fgtd.hpp"
#include "input/points_table.hpp"

namespace gaussdrift::sum {

/// "0,1,2". Throws CommandLineError.
std::vector<int> parse_derivative(const std::string& text);

/// |alpha|. In doubles, because a sum of large orders may exceed an int.
double order_of(const std::vector<int>& derivative);

/// The largest of them. Orders beyond a million count as a million.
int highest_order_of(const std::vector<std::vector<int>>& derivatives);

/// Throws CommandLineError for a derivative that has no number for a coordinate or one too many, is there twice, or is of
/// an order above `highest`. `why` ends that message.
void check_derivatives(const std::vector<std::vector<int>>& derivatives, const input::PointsTable& sources, int highest,
                       const std::string& why);

/// "d_0_1_2".
std::string column_name(const std::vector<int>& derivative);

/// Throws NumericalError for a value that is not finite; `remedy` ends the message.
void check_values(const std::vector<std::string>& columns, const Eigen::MatrixXd& values, const char* remedy);

/// Each derivative as a combination of the libraries.
template <int d>
std::vector<fgtd::Combination<d>> combinations_of(const std::vector<std::vector<int>>& derivatives) {
  std::vector<fgtd::Combination<d>> combinations;
  for (const auto& derivative : derivatives) {
    fgtd::Term<d> term;
    std::copy(derivative.begin(), derivative.end(), term.derivative.begin());
    combinations.push_back({term});
  }
  return combinations;
}

}  // namespace gaussdrift::sum
