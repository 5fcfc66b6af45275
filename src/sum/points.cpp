#include "sum/points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number.hpp"
#include "base/parallel.hpp"
#include "base/printable.hpp"
#include "base/printed.hpp"
#include "base/stopwatch.hpp"
#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"
#include "sum/derivatives.hpp"
#include "sum/first_lines.hpp"
#include "sum/request_as_points.hpp"
#include "sum/sums_json.hpp"

namespace gaussdrift::sum {

namespace {

constexpr int highest_order = 16;  // of fgtd
constexpr double rounding_of_points =
    3e-14;  // of every term, relative to |lambda| N_alpha (docs/fgtd.md, "The promise")

template <int d>
void sum(const SumRequest& request, fgtd::Options options, PointSums& result) {
  const std::vector<fgtd::Combination<d>> combinations = combinations_of<d>(result.derivatives);
  if (!request.grid.empty()) options.expected_grid = fgtd::TensorGrid{nodes_of(request.grid)};

  const base::Stopwatch preparing;
  const fgtd::Plan<d> plan(points_of<d>(request.sources), weights_of(request), request.sigma, options);
  result.prepare_seconds = preparing.seconds();

  const base::Stopwatch evaluating;
  if (options.expected_grid)
    result.values = plan.evaluate_combinations(*options.expected_grid, combinations);
  else
    result.values =
        plan.evaluate_combinations(points_of<d>(request.targets ? *request.targets : request.sources), combinations);
  result.evaluate_seconds = evaluating.seconds();

  result.choice = plan.choice();
  for (const auto& combination : combinations) {
    result.error_bounds.emplace_back();
    if (result.choice.bound)
      result.error_bounds.back() = (*result.choice.bound + rounding_of_points) *
                                   fgtd::derivative_scale<d>(combination.front().derivative, request.sigma) *
                                   result.weight_total;
  }
}

// Of each term, in the unit of the tolerance. Parameters by hand promise their bound, and nothing if they have none.
double promised(const SumRequest& request, const fgtd::Choice& choice) {
  if (!request.hermite) return request.tolerance + 2 * rounding_of_points;
  return choice.bound ? *choice.bound + 2 * rounding_of_points : std::numeric_limits<double>::infinity();
}

template <int d>
void measure(const SumRequest& request, PointSums& result) {
  const SampleOfTargets sample = sample_targets(request);
  const auto combinations = combinations_of<d>(result.derivatives);
  fgtd::Options options;
  options.method = fgtd::Method::direct;
  options.threads = request.threads;
  options.derivative_order = highest_order_of(result.derivatives);
  options.tolerance = 1e-6;  // all pairs, whatever it is
  const fgtd::Plan<d> plan(points_of<d>(request.sources), weights_of(request), request.sigma, options);
  const Eigen::MatrixXd exact = plan.evaluate_combinations(fgtd::Points<d>(sample.points), combinations);
  result.compared = sample.rows.size();
  result.measured.clear();
  result.units.clear();
  for (std::size_t k = 0; k < combinations.size(); ++k) {
    const double scale =
        fgtd::derivative_scale<d>(combinations[k].front().derivative, request.sigma) * result.weight_total;
    const auto column = static_cast<Eigen::Index>(k);
    Worst worst;
    for (std::size_t i = 0; i < sample.rows.size(); ++i)
      worst.take(std::abs(result.values(sample.rows[i], column) - exact(static_cast<Eigen::Index>(i), column)));
    result.units.push_back(scale);
    result.measured.push_back({result.columns[k], relative(worst.error(), scale), promised(request, result.choice)});
  }
}

// The tables have been checked, so fgtd can only refuse a number of the command line.
template <class Work>
void with_errors_of_fgtd(const Work& work) {
  const base::Words words = {{"Options::tolerance = ", "--tolerance "},
                             {"with sigma = ", "with --sigma "},
                             {"HermiteParameters::box_scale = ", "--r "},
                             {"HermiteParameters::expansion_order = ", "--p "}};
  try {
    work();
  } catch (const fgtd::MemoryLimitError& error) {
    throw InputError(
        fmt::format("the sum would take {:.3g} GB, at most {:.3g} GB are left for it; ask for fewer targets "
                    "at a time, or leave --method to auto",
                    error.needed / 1e9, static_cast<double>(error.limit) / 1e9));
  } catch (const fgtd::InvalidArgument& error) {
    throw CommandLineError(base::in_users_words(error.what(), words));
  } catch (const fgtd::Error& error) {
    throw InputError(base::in_users_words(error.what(), words));
  }
}

}  // namespace

int parse_neighbours(const std::string& text) {
  if (text == "all") return fgtd::HermiteParameters::all_boxes;
  const auto number = base::read_number<int>(text);
  if (!number || *number < 0)
    throw CommandLineError(fmt::format("--n {}: must be a whole number from 0, or all", base::printable(text)));
  return *number;
}

PointSums sum_points(const SumRequest& request) {
  check_together(request);
  check_derivatives(request.derivatives, request.sources, highest_order, "");
  PointSums result;
  result.dimension = request.sources.dimension();
  result.sigma = request.sigma;
  result.derivatives = request.derivatives;
  if (result.derivatives.empty()) result.derivatives.emplace_back(result.dimension, 0);
  result.asked = request.method;
  result.threads = base::resolve_threads(request.threads);
  for (const double weight : request.sources.weights) result.weight_total += std::abs(weight);

  fgtd::Options options;
  options.tolerance = request.tolerance;
  options.method = request.method;
  options.hermite = request.hermite;
  options.threads = request.threads;
  options.memory_limit = memory_for_plan(request, std::max<std::size_t>(1, request.derivatives.size()));
  options.expected_targets = request.targets ? request.targets->size() : request.sources.size();
  options.derivative_order = highest_order_of(result.derivatives);
  for (const auto& derivative : result.derivatives) result.columns.push_back(column_name(derivative));
  if (!request.column.empty() && request.derivatives.empty()) result.columns = {request.column};
  with_errors_of_fgtd([&] {
    in_dimension<1, 4>(result.dimension, [&](auto dimension) {
      constexpr int d = decltype(dimension)::value;
      const auto work = [&](double most_seconds) {
        options.most_seconds = most_seconds;
        sum<d>(request, options, result);
      };
      within_seconds<fgtd::TimeLimitError>(request, work, [&](double most_seconds) {
        options.method = fgtd::Method::automatic, options.hermite.reset();
        work(most_seconds);
      });
    });
  });
  check_values(result.columns, result.values, "scale the weights or sigma down");
  if (result.choice.method != fgtd::Method::direct) {
    const base::Stopwatch comparing;
    measure_errors(request, result);
    result.compare_seconds = comparing.seconds();
  }
  return result;
}

void measure_errors(const SumRequest& request, PointSums& sums) {
  with_errors_of_fgtd(
      [&] { in_dimension<1, 4>(sums.dimension, [&](auto d) { measure<decltype(d)::value>(request, sums); }); });
}

std::string to_text(const PointSums& sums) {
  std::string text = first_lines(sums);
  if (sums.normalised || !sums.bandwidth.empty()) {
    text += "shape  ";
    if (sums.covariance.empty())
      text += fmt::format("standard deviation {:.6g}", std::sqrt(0.5 / sums.sigma));
    else
      text += fmt::format("covariance {:::.6g}", sums.covariance);
    text += fmt::format("{}{}\n", sums.bandwidth.empty() ? "" : ", --bandwidth " + sums.bandwidth,
                        sums.normalised ? "; a density with the integral 1" : "");
  }
  return text + precision_line(sums);
}

std::string to_json(const PointSums& sums) {
  const fgtd::Choice& choice = sums.choice;
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  for (const fgtd::Parameter& parameter : fgtd::parameters(choice))
    std::visit([&](const auto& value) { parameters[parameter.name] = value; }, parameter.value);
  nlohmann::ordered_json errors = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < sums.columns.size(); ++k) errors[sums.columns[k]] = finite_or_null(sums.error_bounds[k]);
  nlohmann::ordered_json measured = nullptr;
  if (sums.compared > 0) {
    measured = {{"targets", sums.compared}};
    if (!sums.measured.empty()) measured["errors"] = nlohmann::ordered_json::object();
    for (const MeasuredError& one : sums.measured) measured["errors"][one.of] = finite_or_null(one.error);
    measured["kept"] = broken_promises(sums.measured, sums.compared).empty();
  }
  nlohmann::ordered_json json = {{"kernel", "gauss"},
                                 {"dimension", sums.dimension},
                                 {"sources", choice.sources},
                                 {"targets", sums.values.rows()},
                                 {"sigma", sums.sigma},
                                 {"columns", sums.columns},
                                 {"derivatives", sums.derivatives},
                                 {"tolerance", choice.tolerance},
                                 {"method_asked", fgtd::to_string(sums.asked)},
                                 {"method", fgtd::to_string(choice.method)},
                                 {"parameters", parameters},
                                 {"choice", base::printed(choice)},
                                 {"bound", finite_or_null(choice.bound)},
                                 {"error_bounds", errors},
                                 {"measured", measured},
                                 {"Q", finite_or_null(sums.weight_total)},
                                 {"predicted_seconds", finite_or_null(choice.seconds)},
                                 {"threads", sums.threads},
                                 {"seconds", seconds_by_stage(sums)}};
  if (!sums.covariance.empty()) json["sigma"] = nullptr, json["covariance"] = sums.covariance;
  if (!sums.bandwidth.empty()) json["bandwidth"] = sums.bandwidth;
  if (sums.normalised) json["normalised"] = true;
  return text_of(json);
}

}  // namespace gaussdrift::sum
