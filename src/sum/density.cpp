#include "sum/density.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "base/users_words.hpp"
#include "fgtd/density.hpp"
#include "gaussdrift/error.hpp"
#include "sum/request_as_points.hpp"

namespace gaussdrift::sum {

namespace {

constexpr const char* forms =
    "write scott, silverman, a standard deviation as 0.2, or a covariance row by row as 1,0.5,0.5,1";

template <int d>
fgtd::Bandwidth<d> bandwidth_of(const std::string& text) {
  for (const fgtd::BandwidthRule rule : fgtd::bandwidth_rules())
    if (to_string(rule) == text) return rule;
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ',')) {
    const auto number = base::read_number<double>(part);
    if (!number || !std::isfinite(*number))
      throw CommandLineError(
          fmt::format("--bandwidth {}: {} is no number; {}", base::printable(text), base::in_quotes(part), forms));
    numbers.push_back(*number);
  }
  if (numbers.size() == 1) return numbers[0];
  if (numbers.size() != d * d)
    throw CommandLineError(fmt::format("--bandwidth {} has {} numbers; for {} {} it has 1, or {} for a covariance",
                                       base::printable(text), numbers.size(), d, d == 1 ? "coordinate" : "coordinates",
                                       d * d));
  return fgtd::Covariance<d>(Eigen::Map<const fgtd::Covariance<d>>(numbers.data()).transpose());
}

std::vector<std::vector<double>> rows_of(const Eigen::MatrixXd& matrix) {
  std::vector<std::vector<double>> rows;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.emplace_back();
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) rows.back().push_back(matrix(i, k));
  }
  return rows;
}

/// In the words of who has a table.
void check_weights(const SumRequest& request) {
  const std::vector<double>& weights = request.sources.weights;
  for (std::size_t j = 0; j < weights.size(); ++j)
    if (weights[j] < 0)
      throw InputError(fmt::format("weights of a density must not be negative; that of point {} (counted from 1) is {}",
                                   j + 1, weights[j]));
}

template <int d>
void whiten(const fgtd::Whitening<d>& whitening, input::PointsTable& table) {
  const fgtd::Points<d> white = whitening.of(points_of<d>(table));
  table.positions.assign(white.data(), white.data() + white.size());
}

/// A grid stays one where no axes mix; else its nodes become targets.
template <int d>
void whiten_grid(const fgtd::Whitening<d>& whitening, SumRequest& request) {
  if (whitening.keeps_axes()) {
    for (int k = 0; k < d; ++k) {
      GridAxis& axis = request.grid[static_cast<std::size_t>(k)];
      axis.lower /= whitening.root()(k, k);
      axis.upper /= whitening.root()(k, k);
    }
    return;
  }
  memory_for_plan(request, 2 * d + 1);  // nodes, then targets, and a value for each
  input::PointsTable nodes;
  nodes.coordinates = request.sources.coordinates;
  const fgtd::Points<d> points = whitening.of(nodes_as_points<d>(request.grid));
  nodes.positions.assign(points.data(), points.data() + points.size());
  request.targets = std::move(nodes);
  request.grid.clear();
}

/// The request for round Gaussians, and what belongs to the sums. Returns the largest value of the Gaussian with integral 1.
template <int d>
double make_round(SumRequest& request, const std::string& bandwidth, PointSums& told) {
  const fgtd::Bandwidth<d> given = bandwidth.empty() ? fgtd::Bandwidth<d>(1.0) : bandwidth_of<d>(bandwidth);
  if (const auto* deviation = std::get_if<double>(&given)) {
    if (!bandwidth.empty()) {
      if (!(*deviation > 0)) throw CommandLineError(fmt::format("--bandwidth {}: must be positive", *deviation));
      request.sigma = 1 / (2 * *deviation * *deviation);
    }
    return std::pow(request.sigma / std::numbers::pi, 0.5 * d);
  }
  if (!request.derivatives.empty())
    throw CommandLineError(
        fmt::format("--derivative goes with --sigma, and with a --bandwidth that is one number, not "
                    "with {}",
                    base::printable(bandwidth)));
  if (std::holds_alternative<fgtd::BandwidthRule>(given)) check_weights(request);
  const fgtd::Covariance<d> covariance =
      fgtd::bandwidth_matrix<d>(points_of<d>(request.sources), weights_of(request), given);
  const fgtd::Whitening<d> whitening(covariance);
  told.covariance = rows_of(covariance);
  if (!request.grid.empty()) nodes_of(request.grid);  // refused in the units of the user
  whiten(whitening, request.sources);
  if (request.targets) whiten(whitening, *request.targets);
  if (!request.grid.empty()) whiten_grid(whitening, request);
  request.sigma = fgtd::Whitening<d>::sigma;
  return whitening.peak();
}

}  // namespace

PointSums sum_shaped(SumRequest request, const GaussianShape& shape) {
  check_together(request);
  if (shape.normalised) check_weights(request);
  PointSums told;
  const base::Words words = {{"Give a number as bandwidth", "Give a number as --bandwidth"},
                             {"Give a number or a matrix", "Give a number or a matrix as --bandwidth"}};
  try {
    in_dimension<1, 4>(request.sources.dimension(), [&](auto dimension) {
      const double peak = make_round<decltype(dimension)::value>(request, shape.bandwidth, told);
      if (!shape.normalised) return;
      const Eigen::VectorXd shares = fgtd::normalised_weights(weights_of(request));
      for (std::size_t j = 0; j < request.sources.size(); ++j)
        request.sources.weights[j] = peak * shares(static_cast<Eigen::Index>(j));
    });
  } catch (const fgtd::InvalidArgument& error) {
    throw InputError(base::in_users_words(error.what(), words));
  }
  if (shape.normalised && request.derivatives.empty()) request.column = "density";
  PointSums sums = sum_points(request);
  sums.covariance = std::move(told.covariance);
  sums.bandwidth = shape.bandwidth;
  sums.normalised = shape.normalised;
  return sums;
}

}  // namespace gaussdrift::sum
