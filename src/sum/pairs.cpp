#include "sum/pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"
#include "sum/first_lines.hpp"
#include "sum/request_as_points.hpp"
#include "sum/sums_json.hpp"

namespace gaussdrift::sum {

namespace {

constexpr double rounding_of_pairs = 1e-14;  // of the same sums that the tolerance is relative to

/// The sums without signs that farfield's promise is relative to, at one target.
struct Unsigned {
  double potential = 0, field = 0;
};

template <int d>
Unsigned unsigned_sums(const PairSumRequest& request, const double* target) {
  const std::vector<double>& position = request.sources.positions;
  Unsigned sums;
  for (std::size_t j = 0; j < request.sources.size(); ++j) {
    double square = 0;
    for (std::size_t l = 0; l < d; ++l) square += std::pow(target[l] - position[j * d + l], 2);
    if (square == 0) continue;
    const double r = std::sqrt(square), charge = std::abs(request.sources.weights[j]);
    sums.potential += d == 3 ? charge / r : charge * (1 + std::abs(std::log(r)));
    sums.field += d == 3 ? charge / square : charge / r;
  }
  return sums;
}

/// Against all pairs, at some of the targets.
template <int d>
void measure(const PairSumRequest& request, PairSums& result) {
  const SampleOfTargets sample = sample_targets(request);
  const std::size_t count = sample.rows.size();
  farfield::Options options;
  options.method = farfield::Method::direct;
  options.threads = request.threads;
  const Eigen::VectorXd charges = weights_of(request);
  const farfield::Values<d> exact =
      farfield::Plan<d>(request.kernel, points_of<d>(request.sources), farfield::Points<d>(sample.points), options)
          .evaluate(charges);
  std::vector<Unsigned> scale(count);
  base::parallel_for({count, 10e-9 * static_cast<double>(count * request.sources.size())}, request.threads,
                     [&](std::size_t i) { scale[i] = unsigned_sums<d>(request, sample.points.data() + i * d); });
  Worst worst[2];
  double error[2] = {}, size[2] = {};
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    double square[2] = {};
    for (Eigen::Index k = 0; k <= d; ++k) {
      const double right = k == 0 ? exact.potential[at] : exact.field(k - 1, at);
      square[k > 0] += std::pow(result.values(sample.rows[i], k) - right, 2);
      size[k > 0] += right * right;
    }
    for (const int k : {0, 1}) {
      error[k] += square[k];
      worst[k].take(relative(std::sqrt(square[k]), k == 0 ? scale[i].potential : scale[i].field));
    }
  }
  result.compared = count;
  const double allowed = request.tolerance + rounding_of_pairs;
  result.measured = {{"the potential", worst[0].error(), allowed}, {"the field", worst[1].error(), allowed}};
  result.potential_of_itself = relative(std::sqrt(error[0]), std::sqrt(size[0]));
  result.field_of_itself = relative(std::sqrt(error[1]), std::sqrt(size[1]));
}

template <int d>
void sum(const PairSumRequest& request, farfield::Options options, PairSums& result) {
  const farfield::Points<d> sources = points_of<d>(request.sources);
  const bool self = !request.targets && request.grid.empty();
  const farfield::Points<d> targets = self                   ? sources
                                      : request.grid.empty() ? farfield::Points<d>(points_of<d>(*request.targets))
                                                             : nodes_as_points<d>(request.grid);
  const Eigen::VectorXd charges = weights_of(request);

  const base::Stopwatch preparing;
  const auto plan = self ? farfield::Plan<d>(request.kernel, sources, options)
                         : farfield::Plan<d>(request.kernel, sources, targets, options);
  result.prepare_seconds = preparing.seconds();
  result.choice = plan.choice();

  const base::Stopwatch evaluating;
  {
    const farfield::Values<d> values = plan.evaluate(charges);
    result.values.resize(targets.cols(), 1 + d);
    result.values.col(0) = values.potential;
    result.values.rightCols(d) = values.field.transpose();
  }
  result.evaluate_seconds = evaluating.seconds();
}

// The tables have been checked, so farfield can only refuse a number of the command line.
template <class Work>
void with_errors_of_farfield(const Work& work) {
  const base::Words words = {{"Options::tolerance = ", "--tolerance "}, {"leave the method to", "leave --method to"}};
  try {
    work();
  } catch (const farfield::MemoryLimitError& error) {
    throw InputError(fmt::format("the sum would take {:.3g} GB, at most {:.3g} GB are left for it; give fewer points",
                                 error.needed / 1e9, static_cast<double>(error.limit) / 1e9));
  } catch (const farfield::RangeError& error) {
    throw NumericalError(
        fmt::format("the {} at target {} (counted from 1) exceeds the range of double precision; scale "
                    "the charges down, or join points that are nearly equal",
                    error.quantity, error.target + 1));
  } catch (const farfield::InvalidArgument& error) {
    throw CommandLineError(base::in_users_words(error.what(), words));
  } catch (const farfield::Error& error) {
    throw InputError(base::in_users_words(error.what(), words));
  }
}

}  // namespace

PairSums sum_pairs(const PairSumRequest& request) {
  check_together(request);
  PairSums result;
  result.dimension = request.sources.dimension();
  result.asked = request.method;
  result.threads = base::resolve_threads(request.threads);
  const bool coulomb = request.kernel == farfield::Kernel::coulomb;
  const int lowest = coulomb ? 2 : 1, highest = coulomb ? 3 : 2;
  if (result.dimension < lowest || result.dimension > highest)
    throw CommandLineError(fmt::format("--kernel {} is for points in {} or {} dimensions, the sources have {} ({})",
                                       farfield::to_string(request.kernel), lowest, highest, result.dimension,
                                       fmt::join(request.sources.coordinates, ", ")));
  for (const double charge : request.sources.weights) result.charge_total += std::abs(charge);
  result.columns.emplace_back("potential");
  for (int l = 0; l < result.dimension; ++l) result.columns.push_back(std::string(coulomb ? "f" : "g") + "xyz"[l]);

  farfield::Options options;
  options.tolerance = request.tolerance;
  options.method = request.method;
  options.threads = request.threads;
  // Points are held twice, as read and as the library takes them.
  options.memory_limit = memory_for_plan(request, result.columns.size() + static_cast<std::size_t>(result.dimension));
  with_errors_of_farfield([&] {
    in_dimension<1, 3>(result.dimension, [&](auto dimension) {
      constexpr int d = decltype(dimension)::value;
      const auto work = [&](double most_seconds) {
        options.most_seconds = most_seconds;
        sum<d>(request, options, result);
      };
      within_seconds<farfield::TimeLimitError>(request, work, [&](double most_seconds) {
        options.method = farfield::Method::automatic;
        work(most_seconds);
      });
    });
  });
  if (result.choice.method != farfield::Method::direct) {
    const base::Stopwatch comparing;
    measure_errors(request, result);
    result.compare_seconds = comparing.seconds();
  }
  return result;
}

void measure_errors(const PairSumRequest& request, PairSums& sums) {
  with_errors_of_farfield(
      [&] { in_dimension<1, 3>(sums.dimension, [&](auto d) { measure<decltype(d)::value>(request, sums); }); });
}

std::string to_text(const PairSums& sums) {
  std::string text = first_lines(sums);
  text += fmt::format("Q      {:.9g}", sums.charge_total);
  if (sums.compared > 0)
    text += fmt::format("; measured at {} targets: potential {:.1e}, field {:.1e} ({:.1e} and {:.1e} of themselves)",
                        sums.compared, sums.measured[0].error, sums.measured[1].error, sums.potential_of_itself,
                        sums.field_of_itself);
  return text + "\n";
}

std::string to_json(const PairSums& sums) {
  const farfield::Choice& choice = sums.choice;
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  if (choice.method != farfield::Method::direct)
    parameters = {{"degree", choice.degree},
                  {"leaf_size", choice.leaf_size},
                  {"clusters", choice.clusters},
                  {"levels", choice.levels}};
  nlohmann::ordered_json measured = nullptr;
  if (sums.compared > 0)
    measured = {{"targets", sums.compared},
                {"potential_error", finite_or_null(sums.measured[0].error)},
                {"field_error", finite_or_null(sums.measured[1].error)},
                {"potential_of_itself", finite_or_null(sums.potential_of_itself)},
                {"field_of_itself", finite_or_null(sums.field_of_itself)},
                {"kept", broken_promises(sums.measured, sums.compared).empty()}};
  nlohmann::ordered_json json = head_of(sums, farfield::to_string(choice.kernel), choice.sources, parameters);
  json.update({{"bound", finite_or_null(choice.bound)},
               {"measured", measured},
               {"Q", finite_or_null(sums.charge_total)},
               {"predicted_seconds", finite_or_null(choice.seconds)},
               {"threads", sums.threads},
               {"seconds", seconds_by_stage(sums)}});
  return text_of(json);
}

}  // namespace gaussdrift::sum
