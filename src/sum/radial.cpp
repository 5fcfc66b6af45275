#include "sum/radial.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/stopwatch.hpp"
#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"
#include "sum/derivatives.hpp"
#include "sum/first_lines.hpp"
#include "sum/request_as_points.hpp"
#include "sum/sums_json.hpp"

namespace gaussdrift::sum {

namespace {

constexpr double rounding_of_radial = 1e-13;  // of the units (docs/rbf.md, "The promise")

/// Why a kernel has no higher derivatives, and what to take instead.
std::string why_no_higher(rbf::Kernel kernel) {
  if (kernel == rbf::Kernel::gaussian)
    return " for gaussian; --kernel gauss with --sigma 1/shape^2 has derivatives up to 16";
  if (rbf::highest_derivative(kernel) < 2)
    return fmt::format(" for {}, whose higher derivatives are infinite at distance 0", to_string(kernel));
  return fmt::format(" for {}", to_string(kernel));
}

/// The range that the targets need. The corners of a grid are its farthest nodes.
template <int d>
double range_of(const PointsRequest& request) {
  const auto sources = points_of<d>(request.sources);
  double range = 0;
  if (request.grid.empty()) {
    range = rbf::range_of<d>(sources, points_of<d>(request.targets ? *request.targets : request.sources));
  } else {
    rbf::Points<d> corners(d, 1 << d);
    for (int corner = 0; corner < 1 << d; ++corner)
      for (int l = 0; l < d; ++l) {
        const GridAxis& axis = request.grid[static_cast<std::size_t>(l)];
        corners(l, corner) = (corner >> l & 1) ? axis.upper : axis.lower;
      }
    range = rbf::range_of<d>(sources, corners);
  }
  if (range == 0 || (range >= 1e-75 && range <= 1e75)) return range;  // of rbf: squares are doubles
  throw InputError(
      fmt::format("the points are up to {:.3g} apart, must be 1e-75 to 1e75; take another unit of length", range));
}

template <int d>
void sum(const RadialSumRequest& request, rbf::Options options, RadialSums& result) {
  const auto combinations = combinations_of<d>(result.derivatives);
  if (!request.grid.empty()) options.expected_grid = rbf::TensorGrid{nodes_of(request.grid)};

  const base::Stopwatch preparing;
  options.range = range_of<d>(request);
  const rbf::Plan<d> plan(request.function, points_of<d>(request.sources), weights_of(request), options);
  result.prepare_seconds = preparing.seconds();

  const base::Stopwatch evaluating;
  if (options.expected_grid)
    result.values = plan.evaluate_combinations(*options.expected_grid, combinations);
  else
    result.values =
        plan.evaluate_combinations(points_of<d>(request.targets ? *request.targets : request.sources), combinations);
  result.evaluate_seconds = evaluating.seconds();

  result.choice = plan.choice();
  result.units.clear();
  result.error_bounds.clear();
  for (const auto& derivative : result.derivatives) {
    const auto order = static_cast<int>(order_of(derivative));
    result.units.push_back(rbf::largest_derivative(request.function, result.choice.range, order) * result.weight_total);
    result.error_bounds.push_back((result.choice.bound + rounding_of_radial) * result.units.back());
  }
}

template <int d>
void measure(const RadialSumRequest& request, RadialSums& result) {
  const SampleOfTargets sample = sample_targets(request);
  const rbf::Options options{.derivative_order = highest_order_of(result.derivatives),
                             .method = rbf::Method::direct,
                             .threads = request.threads,
                             .range = result.choice.range};
  const rbf::Plan<d> plan(request.function, points_of<d>(request.sources), weights_of(request), options);
  const Eigen::MatrixXd exact =
      plan.evaluate_combinations(rbf::Points<d>(sample.points), combinations_of<d>(result.derivatives));
  result.compared = sample.rows.size();
  result.measured.clear();
  for (std::size_t k = 0; k < result.columns.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    Worst worst;
    for (std::size_t i = 0; i < sample.rows.size(); ++i)
      worst.take(std::abs(result.values(sample.rows[i], column) - exact(static_cast<Eigen::Index>(i), column)));
    result.measured.push_back(
        {result.columns[k], relative(worst.error(), result.units[k]), request.tolerance + 2 * rounding_of_radial});
  }
}

// The tables have been checked, so rbf can only refuse a number of the command line.
template <class Work>
void with_errors_of_rbf(const Work& work) {
  const base::Words words = {{"Options::tolerance = ", "--tolerance "},
                             {"shape = ", "--shape "},
                             {"leave the method to auto or direct", "use --method auto or direct"},
                             {"take Method::direct", "use --method direct"}};
  try {
    work();
  } catch (const rbf::MemoryLimitError& error) {
    throw InputError(
        fmt::format("the sum would take {:.3g} GB, at most {:.3g} GB are left for it; ask for fewer targets "
                    "at a time, or use --method direct",
                    error.needed / 1e9, static_cast<double>(error.limit) / 1e9));
  } catch (const rbf::InvalidArgument& error) {
    throw CommandLineError(base::in_users_words(error.what(), words));
  } catch (const rbf::Error& error) {
    throw InputError(base::in_users_words(error.what(), words));
  }
}

}  // namespace

RadialSums sum_radial(const RadialSumRequest& request) {
  check_together(request);
  const rbf::Kernel kernel = request.function.kernel;
  RadialSums result;
  result.dimension = request.sources.dimension();
  if (result.dimension > 3)
    throw CommandLineError(fmt::format("--kernel {} is for points in 1 to 3 dimensions, the sources have {} ({})",
                                       to_string(kernel), result.dimension,
                                       fmt::join(request.sources.coordinates, ", ")));
  check_derivatives(request.derivatives, request.sources, rbf::highest_derivative(kernel), why_no_higher(kernel));
  result.derivatives = request.derivatives;
  if (result.derivatives.empty()) result.derivatives.emplace_back(result.dimension, 0);
  for (const auto& derivative : result.derivatives) result.columns.push_back(column_name(derivative));
  result.asked = request.method;
  result.threads = base::resolve_threads(request.threads);
  for (const double weight : request.sources.weights) result.weight_total += std::abs(weight);

  rbf::Options options{.tolerance = request.tolerance,
                       .derivative_order = highest_order_of(result.derivatives),
                       .method = request.method,
                       .threads = request.threads,
                       .memory_limit = memory_for_plan(request, result.columns.size()),
                       .expected_targets = request.targets ? request.targets->size() : request.sources.size()};
  with_errors_of_rbf([&] {
    in_dimension<1, 3>(result.dimension, [&](auto dimension) {
      constexpr int d = decltype(dimension)::value;
      const auto work = [&](double most_seconds) {
        options.most_seconds = most_seconds;
        sum<d>(request, options, result);
      };
      within_seconds<rbf::TimeLimitError>(request, work, [&](double most_seconds) {
        options.method = rbf::Method::automatic;
        work(most_seconds);
      });
    });
  });
  check_values(result.columns, result.values, "scale the weights down");
  if (result.choice.method != rbf::Method::direct) {
    const base::Stopwatch comparing;
    measure_errors(request, result);
    result.compare_seconds = comparing.seconds();
  }
  return result;
}

void measure_errors(const RadialSumRequest& request, RadialSums& sums) {
  with_errors_of_rbf(
      [&] { in_dimension<1, 3>(sums.dimension, [&](auto d) { measure<decltype(d)::value>(request, sums); }); });
}

std::string to_text(const RadialSums& sums) { return first_lines(sums) + precision_line(sums); }

std::string to_json(const RadialSums& sums) {
  const rbf::Choice& choice = sums.choice;
  const rbf::Function& function = choice.function;
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  if (choice.method != rbf::Method::direct) {
    nlohmann::ordered_json terms = nlohmann::ordered_json::array();
    for (const rbf::Gaussian& term : choice.terms)
      terms.push_back(
          {{"exponent", term.exponent}, {"weight", term.weight}, {"method", fgtd::to_string(term.choice.method)}});
    parameters = {{"terms", terms},
                  {"polynomial", choice.polynomial},
                  {"near", choice.near},
                  {"kernel_error", choice.kernel_error}};
  }
  nlohmann::ordered_json errors = nlohmann::ordered_json::object(), measured = nullptr;
  for (std::size_t k = 0; k < sums.columns.size(); ++k) errors[sums.columns[k]] = finite_or_null(sums.error_bounds[k]);
  if (sums.compared > 0) {
    measured = {{"targets", sums.compared}, {"errors", nlohmann::ordered_json::object()}};
    for (const MeasuredError& one : sums.measured) measured["errors"][one.of] = finite_or_null(one.error);
    measured["kept"] = broken_promises(sums.measured, sums.compared).empty();
  }
  nlohmann::ordered_json json = head_of(sums, to_string(function.kernel), choice.centres, parameters);
  json.update({{"shape", rbf::takes_shape(function.kernel) ? finite_or_null(function.shape) : nullptr},
               {"derivatives", sums.derivatives},
               {"range", choice.range},
               {"largest", choice.largest},
               {"bound", finite_or_null(choice.bound)},
               {"error_bounds", errors},
               {"measured", measured},
               {"Q", finite_or_null(sums.weight_total)},
               {"predicted_seconds", finite_or_null(choice.seconds)},
               {"threads", sums.threads},
               {"seconds", seconds_by_stage(sums)}});
  return text_of(json);
}

}  // namespace gaussdrift::sum
