#include "study/sum_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"

namespace gaussdrift::study {

namespace {

constexpr std::size_t most_compared = 200;  // targets

template <int d>
farfield::Points<d> points_of(const input::PointsTable& table) {
  return Eigen::Map<const farfield::Points<d>>(table.positions.data(), d, static_cast<Eigen::Index>(table.size()));
}

template <int d>
farfield::Points<d> points_of(const std::vector<GridAxis>& grid) {
  const auto nodes = nodes_of(grid);
  std::size_t count = 1;
  for (const auto& axis : nodes) count *= axis.size();
  farfield::Points<d> points(d, static_cast<Eigen::Index>(count));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    std::size_t rest = static_cast<std::size_t>(i);
    for (int l = 0; l < d; ++l) {
      const auto& axis = nodes[static_cast<std::size_t>(l)];
      points(l, i) = axis[rest % axis.size()];
      rest /= axis.size();
    }
  }
  return points;
}

double relative(double error, double size) { return error == 0 ? 0 : error / size; }

/// Against all pairs, at some of the targets.
template <int d>
void compare(const PairSumRequest& request, const farfield::Points<d>& sources, const farfield::Points<d>& targets,
             const Eigen::VectorXd& charges, farfield::Options options, PairSums& result) {
  const auto count = static_cast<std::size_t>(targets.cols());
  result.compared = std::min(most_compared, count);
  farfield::Points<d> some(d, static_cast<Eigen::Index>(result.compared));
  std::vector<Eigen::Index> row(result.compared);
  for (std::size_t i = 0; i < result.compared; ++i) {
    row[i] = static_cast<Eigen::Index>(i * count / result.compared);
    some.col(static_cast<Eigen::Index>(i)) = targets.col(row[i]);
  }
  options.method = farfield::Method::direct;
  const farfield::Values<d> exact = farfield::Plan<d>(request.kernel, sources, some, options).evaluate(charges);
  double error[2] = {}, size[2] = {};
  for (std::size_t i = 0; i < result.compared; ++i)
    for (Eigen::Index k = 0; k <= d; ++k) {
      const auto at = static_cast<Eigen::Index>(i);
      const double right = k == 0 ? exact.potential[at] : exact.field(k - 1, at);
      error[k > 0] += std::pow(result.values(row[i], k) - right, 2);
      size[k > 0] += right * right;
    }
  result.potential_error = relative(std::sqrt(error[0]), std::sqrt(size[0]));
  result.field_error = relative(std::sqrt(error[1]), std::sqrt(size[1]));
}

template <int d>
void sum(const PairSumRequest& request, farfield::Options options, PairSums& result) {
  const farfield::Points<d> sources = points_of<d>(request.sources);
  const bool self = !request.targets && request.grid.empty();
  const farfield::Points<d> targets = self                   ? sources
                                      : request.grid.empty() ? points_of<d>(*request.targets)
                                                             : points_of<d>(request.grid);
  const Eigen::VectorXd charges = Eigen::Map<const Eigen::VectorXd>(
      request.sources.weights.data(), static_cast<Eigen::Index>(request.sources.weights.size()));

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

  if (result.choice.method == farfield::Method::direct) return;
  const base::Stopwatch comparing;
  compare<d>(request, sources, targets, charges, options, result);
  result.compare_seconds = comparing.seconds();
}

// The tables are finite and belong together, so what farfield refuses is a number of the command line.
template <class Work>
void with_errors_of_farfield(const Work& work) {
  try {
    work();
  } catch (const farfield::InvalidArgument& error) {
    throw CommandLineError(error.what());
  } catch (const farfield::RangeError& error) {
    throw NumericalError(error.what());
  } catch (const farfield::Error& error) {
    throw InputError(error.what());
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
    switch (result.dimension) {
      case 1:
        return sum<1>(request, options, result);
      case 2:
        return sum<2>(request, options, result);
      default:
        return sum<3>(request, options, result);
    }
  });
  return result;
}

std::string to_text(const PairSums& sums) {
  std::ostringstream choice;
  choice << sums.choice;
  std::string text = fmt::format(
      "sums   {} at {} targets in {:.3g} s on {} {} (read {:.3g}, prepare {:.3g}, evaluate {:.3g}, compare {:.3g}, "
      "write {:.3g})\n",
      fmt::join(sums.columns, ", "), sums.values.rows(),
      sums.read_seconds + sums.prepare_seconds + sums.evaluate_seconds + sums.compare_seconds + sums.write_seconds,
      sums.threads, sums.threads == 1 ? "thread" : "threads", sums.read_seconds, sums.prepare_seconds,
      sums.evaluate_seconds, sums.compare_seconds, sums.write_seconds);
  text += fmt::format("method {}\n", choice.str());
  text += fmt::format("Q      {:.9g}", sums.charge_total);
  if (sums.compared > 0)
    text += fmt::format("; at {} targets against all pairs: potential right to {:.1e}, field to {:.1e} of itself",
                        sums.compared, sums.potential_error, sums.field_error);
  return text + "\n";
}

std::string to_json(const PairSums& sums) {
  const farfield::Choice& choice = sums.choice;
  std::ostringstream line;
  line << choice;
  const auto number = [](double value) -> nlohmann::ordered_json {
    if (std::isfinite(value)) return value;
    return nullptr;
  };
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  if (choice.method != farfield::Method::direct)
    parameters = {{"degree", choice.degree},
                  {"leaf_size", choice.leaf_size},
                  {"clusters", choice.clusters},
                  {"levels", choice.levels}};
  nlohmann::ordered_json measured = nullptr;
  if (sums.compared > 0)
    measured = {{"targets", sums.compared},
                {"potential_error", number(sums.potential_error)},
                {"field_error", number(sums.field_error)}};
  const nlohmann::ordered_json json = {{"kernel", farfield::to_string(choice.kernel)},
                                       {"dimension", sums.dimension},
                                       {"sources", choice.sources},
                                       {"targets", sums.values.rows()},
                                       {"columns", sums.columns},
                                       {"tolerance", choice.tolerance},
                                       {"method_asked", farfield::to_string(sums.asked)},
                                       {"method", farfield::to_string(choice.method)},
                                       {"parameters", parameters},
                                       {"choice", line.str()},
                                       {"bound", number(choice.bound)},
                                       {"measured", measured},
                                       {"Q", number(sums.charge_total)},
                                       {"predicted_seconds", number(choice.seconds)},
                                       {"threads", sums.threads},
                                       {"seconds",
                                        {{"read", sums.read_seconds},
                                         {"prepare", sums.prepare_seconds},
                                         {"evaluate", sums.evaluate_seconds},
                                         {"compare", sums.compare_seconds},
                                         {"write", sums.write_seconds}}}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::study
