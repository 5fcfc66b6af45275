#include "sum/general.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "base/users_words.hpp"
#include "expression/expression.hpp"
#include "gaussdrift/error.hpp"
#include "sum/first_lines.hpp"
#include "sum/request_as_points.hpp"
#include "sum/sums_json.hpp"

namespace gaussdrift::sum {

namespace {

constexpr double rounding_of_general = 1e-14;  // of the sums without signs

Expression parsed(const std::string& text) {
  try {
    return Expression(text, {"r"}, {});
  } catch (const ExpressionError& error) {
    throw CommandLineError(fmt::format("--kernel \"{}\", at character {}: {}; the kernel is an expression of r", text,
                                       error.position() + 1, error.what()));
  }
}

farfield::KernelFunction kernel_of(const Expression& expression) {
  constexpr double nanoseconds_of_unit = 40;  // Expression::cost()
  return farfield::KernelFunction::of_distance(
      [expression](const double* r, std::size_t count, double* values) {
        const double* const arguments[] = {r};
        expression.evaluate(arguments, count, values);
      },
      std::max(2.0, nanoseconds_of_unit * expression.cost()));
}

/// A sum and the same without signs, at one target. A value at distance 0 that is not finite is left out.
struct Pairwise {
  double sum = 0, size = 0;
};

template <int d>
Pairwise all_pairs(const Expression& kernel, const PointsRequest& request, const double* target) {
  constexpr std::size_t together = 256;
  const std::vector<double>& position = request.sources.positions;
  double r[together], values[together];
  const double* const arguments[] = {r};
  Pairwise sums;
  for (std::size_t begin = 0; begin < request.sources.size(); begin += together) {
    const std::size_t count = std::min(together, request.sources.size() - begin);
    for (std::size_t j = 0; j < count; ++j) {
      double square = 0;
      for (std::size_t l = 0; l < d; ++l) square += std::pow(target[l] - position[(begin + j) * d + l], 2);
      r[j] = std::sqrt(square);
    }
    kernel.evaluate(arguments, count, values);
    for (std::size_t j = 0; j < count; ++j) {
      if (r[j] == 0 && !std::isfinite(values[j])) continue;
      const double term = request.sources.weights[begin + j] * values[j];
      sums.sum += term;
      sums.size += std::abs(term);
    }
  }
  return sums;
}

/// The root mean square of the errors at some targets, relative to what farfield promises it by.
template <int d>
void measure(const GeneralSumRequest& request, const Expression& kernel, GeneralSums& result) {
  const SampleOfTargets sample = sample_targets(request);
  const std::size_t count = sample.rows.size();
  std::vector<Pairwise> exact(count);
  const double seconds = 40e-9 * kernel.cost() * static_cast<double>(count * request.sources.size());
  base::parallel_for({count, seconds}, request.threads,
                     [&](std::size_t i) { exact[i] = all_pairs<d>(kernel, request, sample.points.data() + i * d); });
  double squares = 0, values = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double error =
        std::abs(result.values(sample.rows[i], 0) - exact[i].sum) - rounding_of_general * exact[i].size;
    if (!(error <= 0)) squares += error * error;
    values += exact[i].sum * exact[i].sum;
  }
  const double root = std::sqrt(static_cast<double>(count));
  const double scale = result.choice.kernel_size * std::sqrt(static_cast<double>(request.sources.size())) *
                       weights_of(request).stableNorm();
  result.compared = count;
  result.measured = {
      {"the root mean square of the sums", relative(std::sqrt(squares) / root, scale), request.tolerance}};
  result.of_itself = relative(std::sqrt(squares), std::sqrt(values));
}

template <int d>
void sum(const GeneralSumRequest& request, const Expression& expression, GeneralSums& result) {
  const farfield::KernelFunction kernel = kernel_of(expression);
  farfield::GeneralOptions options{
      .tolerance = request.tolerance, .method = request.method, .threads = request.threads};
  // Points are held twice, as read and as the library takes them.
  options.memory_limit = memory_for_plan(request, 1 + d);
  const farfield::Points<d> sources = points_of<d>(request.sources);
  const bool self = !request.targets && request.grid.empty();
  const farfield::Points<d> targets = self                   ? sources
                                      : request.grid.empty() ? farfield::Points<d>(points_of<d>(*request.targets))
                                                             : nodes_as_points<d>(request.grid);
  if (request.method == farfield::GeneralMethod::direct) {
    const double pairs = static_cast<double>(sources.cols()) * static_cast<double>(targets.cols());
    const double seconds = 40e-9 * expression.cost() * pairs / base::resolve_threads(request.threads);
    constexpr double told_from = 5;
    if (seconds > std::min(told_from, request.most_seconds))
      tell_or_refuse(request, {seconds, to_string(request.method)}, [] { return PredictedWork{}; });
  }
  const base::Stopwatch preparing;
  const auto plan = self ? farfield::GeneralPlan<d>(kernel, sources, options)
                         : farfield::GeneralPlan<d>(kernel, sources, targets, options);
  result.prepare_seconds = preparing.seconds();
  result.choice = plan.choice();
  const base::Stopwatch evaluating;
  result.values = plan.evaluate(weights_of(request));
  result.evaluate_seconds = evaluating.seconds();
  if (result.choice.method == farfield::GeneralMethod::direct) return;
  const base::Stopwatch comparing;
  measure<d>(request, expression, result);
  result.compare_seconds = comparing.seconds();
}

}  // namespace

bool is_kernel_expression(std::string_view text) {
  return text == "r" || !std::all_of(text.begin(), text.end(),
                                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

GeneralSums sum_general(const GeneralSumRequest& request) {
  const Expression expression = parsed(request.kernel);
  check_together(request);
  GeneralSums result;
  result.kernel = request.kernel;
  result.dimension = request.sources.dimension();
  result.asked = request.method;
  result.threads = base::resolve_threads(request.threads);
  result.columns = {"sum"};
  if (result.dimension != 2 && result.dimension != 3)
    throw CommandLineError(
        fmt::format("--kernel \"{}\": an expression is for points in 2 or 3 dimensions, the sources "
                    "have {} ({})",
                    request.kernel, result.dimension, fmt::join(request.sources.coordinates, ", ")));
  for (const double charge : request.sources.weights) result.charge_total += std::abs(charge);
  const base::Words words = {{"GeneralOptions::tolerance = ", "--tolerance "},
                             {"leave the method to direct", "use --method direct"}};
  try {
    in_dimension<2, 3>(result.dimension, [&](auto d) { sum<decltype(d)::value>(request, expression, result); });
  } catch (const farfield::MemoryLimitError& error) {
    throw InputError(fmt::format("the sum would take {:.3g} GB, at most {:.3g} GB are left for it; give fewer points",
                                 error.needed / 1e9, static_cast<double>(error.limit) / 1e9));
  } catch (const farfield::RangeError& error) {
    throw NumericalError(
        fmt::format("the sum at target {} (counted from 1) is no finite number; the kernel \"{}\" is infinite or not "
                    "defined at some distance, or the weights are too large",
                    error.target + 1, request.kernel));
  } catch (const farfield::InvalidArgument& error) {
    throw CommandLineError(base::in_users_words(error.what(), words));
  } catch (const farfield::Error& error) {
    throw InputError(base::in_users_words(error.what(), words));
  }
  return result;
}

std::string to_text(const GeneralSums& sums) {
  std::string text = first_lines(sums);
  text += fmt::format("Q      {:.9g}", sums.charge_total);
  if (sums.compared > 0)
    text += fmt::format("; measured at {} targets: {:.1e} ({:.1e} of the values)", sums.compared,
                        sums.measured[0].error, sums.of_itself);
  return text + "\n";
}

std::string to_json(const GeneralSums& sums) {
  const farfield::GeneralChoice& choice = sums.choice;
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  if (choice.method != farfield::GeneralMethod::direct) {
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const farfield::GeneralLevel& level : choice.levels)
      levels.push_back({{"level", level.level},
                        {"order", level.order},
                        {"functions", level.functions},
                        {"rank", level.rank},
                        {"couplings", level.couplings},
                        {"matrices", level.matrices}});
    parameters = {{"clusters", choice.clusters},
                  {"pairs", choice.pairs},
                  {"levels", levels},
                  {"basis_bytes", choice.basis_bytes},
                  {"coupling_bytes", choice.coupling_bytes},
                  {"list_bytes", choice.list_bytes},
                  {"kernel_size", choice.kernel_size}};
  }
  nlohmann::ordered_json measured = nullptr;
  if (sums.compared > 0)
    measured = {{"targets", sums.compared},
                {"sum_error", finite_or_null(sums.measured[0].error)},
                {"of_itself", finite_or_null(sums.of_itself)},
                {"kept", broken_promises(sums.measured, sums.compared).empty()}};
  nlohmann::ordered_json json = head_of(sums, sums.kernel, choice.sources, parameters);
  json.update({{"measured", measured},
               {"Q", finite_or_null(sums.charge_total)},
               {"threads", sums.threads},
               {"seconds", seconds_by_stage(sums)}});
  return text_of(json);
}

}  // namespace gaussdrift::sum
