#include "reproduce/interpolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "base/stopwatch.hpp"
#include "rbf/integral.hpp"
#include "rbf/interpolant.hpp"
#include "reproduce/point_sets.hpp"

namespace gaussdrift::reproduce {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double most_times_dense = 1.5;

/// Franke's test function [Fra82]: three bumps and a slope.
double franke(double x, double y) {
  const double u = 9 * x, v = 9 * y;
  return 0.75 * std::exp(-((u - 2) * (u - 2) + (v - 2) * (v - 2)) / 4) +
         0.75 * std::exp(-(u + 1) * (u + 1) / 49 - (v + 1) / 10) +
         0.5 * std::exp(-((u - 7) * (u - 7) + (v - 3) * (v - 3)) / 4) -
         0.2 * std::exp(-(u - 4) * (u - 4) - (v - 7) * (v - 7));
}

VectorXd franke_at(const rbf::Points<2>& points) {
  VectorXd values(points.cols());
  for (Index i = 0; i < points.cols(); ++i) values[i] = franke(points(0, i), points(1, i));
  return values;
}

/// Over the unit square.
double integral_of_franke() {
  // integral_0^1 exp(-p (9x - m)^2) dx
  const auto bump = [](double p, double m) {
    const double root = std::sqrt(p);
    return std::sqrt(std::numbers::pi) / (18 * root) * (std::erf(root * (9 - m)) + std::erf(root * m));
  };
  const double slope = 10.0 / 9 * (std::exp(-0.1) - std::exp(-1.0));
  return 0.75 * bump(0.25, 2) * bump(0.25, 2) + 0.75 * bump(1.0 / 49, -1) * slope +
         0.5 * bump(0.25, 7) * bump(0.25, 3) - 0.2 * bump(1, 4) * bump(1, 7);
}

/// Kernels whose errors fall as a power of the spacing, and one whose shape is chosen.
struct Studied {
  rbf::Function function;
  /// In the plane, of the error in the mean, for functions of the kernel's own space H^m: spacing^m [Wen05, chapter 11].
  double stated = 0;
};
constexpr double fixed_shape = 0.2;
const std::vector<Studied>& studied() {
  static const std::vector<Studied> all{{{rbf::Kernel::thin_plate, 0}, 2},
                                        {{rbf::Kernel::matern32, fixed_shape}, 2.5},
                                        {{rbf::Kernel::matern52, fixed_shape}, 3.5},
                                        {{rbf::Kernel::multiquadric, 0}, 0}};
  return all;
}

struct Targets {
  explicit Targets(int count)
      : points(random_points<2>(static_cast<std::size_t>(count), 2)), exact(franke_at(points)) {}
  double error_of(const VectorXd& values) const {
    return (values - exact).norm() / std::sqrt(static_cast<double>(exact.size()));
  }
  rbf::Points<2> points;
  VectorXd exact;
};

/// The spacing goes as the root of the number of points.
double rate_between(const InterpolationFit& few, const InterpolationFit& many) {
  return 2 * std::log(few.error / many.error) / std::log(static_cast<double>(many.points) / few.points);
}

InterpolationFit fit_of(const rbf::Function& function, int count, const Targets& targets, int threads) {
  const rbf::Points<2> points = random_points<2>(static_cast<std::size_t>(count), 1);
  std::optional<rbf::Interpolant<2>> made;
  try {
    made.emplace(function, points, franke_at(points), rbf::FitOptions{.threads = threads});
  } catch (const rbf::IllConditioned&) {
    return {.kernel = to_string(function.kernel), .shape = function.shape, .points = count, .refused = true};
  }
  const rbf::Interpolant<2>& fit = *made;
  const rbf::FitReport& report = fit.report();
  const rbf::Integral integral = rbf::integral<2>(fit, Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1));
  return {.kernel = to_string(function.kernel),
          .shape = report.function.shape,
          .shape_was_chosen = report.shape_was_chosen,
          .points = count,
          .solver = to_string(report.solver),
          .iterations = report.iterations,
          .error = targets.error_of(fit.evaluate(targets.points).col(0)),
          .left_out = report.left_out[0],
          .integral_error = std::abs(integral.values[0] - integral_of_franke()),
          .seconds = report.seconds};
}

InterpolationSolvers solvers_of(const rbf::Function& function, int count, const Targets& targets, int threads) {
  const rbf::Points<2> points = random_points<2>(static_cast<std::size_t>(count), 1);
  const VectorXd values = franke_at(points);
  const rbf::Interpolant<2> dense(function, points, values, {.solver = rbf::Solver::dense, .threads = threads});
  // The same shape, should it have been chosen.
  const rbf::Interpolant<2> krylov(dense.report().function, points, values,
                                   {.solver = rbf::Solver::krylov, .threads = threads});
  const VectorXd first = dense.evaluate(targets.points).col(0), second = krylov.evaluate(targets.points).col(0);
  return {.kernel = to_string(function.kernel),
          .points = count,
          .dense_error = targets.error_of(first),
          .krylov_error = targets.error_of(second),
          .apart = (first - second).cwiseAbs().maxCoeff() / values.cwiseAbs().maxCoeff(),
          .dense_seconds = dense.report().seconds,
          .krylov_seconds = krylov.report().seconds};
}

}  // namespace

bool InterpolationReproduction::agrees() const {
  return std::all_of(rates.begin(), rates.end(), [](const InterpolationRate& rate) { return rate.holds(); }) &&
         std::all_of(solvers.begin(), solvers.end(), [](const InterpolationSolvers& both) {
           return both.krylov_error <= most_times_dense * both.dense_error;
         });
}

InterpolationReproduction reproduce_interpolation(const InterpolationOptions& options,
                                                  const std::function<void(const std::string&)>& progress) {
  const base::Stopwatch stopwatch;
  const auto tell = [&](const std::string& what) {
    if (progress) progress(what);
  };
  InterpolationReproduction result{.options = options};
  const Targets targets(options.targets);
  for (const Studied& one : studied()) {
    const std::string kernel = to_string(one.function.kernel);
    std::vector<InterpolationFit> fits;
    for (int count = options.fewest_points; count <= options.most_points; count *= 4) {
      tell(fmt::format("{}, {} points", kernel, count));
      InterpolationFit fit = fit_of(one.function, count, targets, options.threads);
      if (fit.refused) {
        result.fits.push_back(fit);
        break;  // more points lie closer
      }
      if (!fits.empty()) fit.rate = rate_between(fits.back(), fit);
      fits.push_back(fit);
      result.fits.push_back(fit);
    }
    if (fits.size() > 1)
      result.rates.push_back(
          {.kernel = kernel, .measured = rate_between(fits.front(), fits.back()), .stated = one.stated});
  }
  for (const Studied& one : studied()) {
    const int count = std::min(2000, options.most_points);
    tell(fmt::format("{} by both solvers", to_string(one.function.kernel)));
    result.solvers.push_back(solvers_of(one.function, count, targets, options.threads));
  }
  result.seconds = stopwatch.seconds();
  return result;
}

std::string to_text(const InterpolationReproduction& result) {
  std::string text = fmt::format(
      "Franke's function at random points of the unit square, {} {}. Errors are root mean squares at {} other points,\n"
      "where the function is 0.5; its integral is 0.4. The rate r is that of an error as spacing^r.\n"
      "kernel         points    shape  solved by       error    rate  left-out  left-out/error  of integral  seconds\n",
      result.options.threads, result.options.threads == 1 ? "thread" : "threads", result.options.targets);
  for (const InterpolationFit& row : result.fits) {
    if (row.refused) {
      text += fmt::format("{:13}  {:6}  {:>7}  refused: ill-conditioned\n", row.kernel, row.points,
                          fmt::format("{:.3g}", row.shape));
      continue;
    }
    text += fmt::format("{:13}  {:6}  {:>7}  {:12}  {:7.1e}  {:>6}   {:7.1e}  {:14.2f}  {:11.1e}  {:7.2f}\n",
                        row.kernel, row.points,
                        row.shape > 0 ? fmt::format("{:.3g}{}", row.shape, row.shape_was_chosen ? "*" : "") : "-",
                        row.iterations > 0 ? fmt::format("{} steps", row.iterations) : row.solver, row.error,
                        row.rate != 0 ? fmt::format("{:.2f}", row.rate) : "-", row.left_out, row.left_out / row.error,
                        row.integral_error, row.seconds);
  }
  text +=
      "* chosen by left-out values\n\nRates from the fewest points to the most. Theory states at least (Wendland "
      "2005)\n"
      "kernel         measured  stated\n";
  for (const InterpolationRate& row : result.rates)
    text += fmt::format("{:13}  {:8.2f}  {:>6}{}\n", row.kernel, row.measured,
                        row.stated > 0 ? fmt::format("{:.1f}", row.stated) : "-", row.holds() ? "" : "  NOT REACHED");
  text +=
      "\nThe same fit by a factorisation and by iteration\n"
      "kernel         points  error dense  error iterated  both apart  seconds dense  seconds iterated\n";
  for (const InterpolationSolvers& row : result.solvers)
    text += fmt::format("{:13}  {:6}  {:11.4e}  {:14.4e}  {:10.1e}  {:13.2f}  {:16.2f}\n", row.kernel, row.points,
                        row.dense_error, row.krylov_error, row.apart, row.dense_seconds, row.krylov_seconds);
  return text + fmt::format("\n{}. {:.1f} s\n",
                            result.agrees() ? "Errors fall as stated, and both solvers agree"
                                            : "A RATE IS NOT REACHED, OR THE SOLVERS DIFFER",
                            result.seconds);
}

std::string to_json(const InterpolationReproduction& result) {
  nlohmann::ordered_json json = {{"most_points", result.options.most_points},
                                 {"targets", result.options.targets},
                                 {"threads", result.options.threads}};
  for (const char* list : {"fits", "rates", "solvers"}) json[list] = nlohmann::ordered_json::array();
  const auto or_null = [](double value) { return value != 0 ? nlohmann::ordered_json(value) : nullptr; };
  for (const InterpolationFit& row : result.fits)
    json["fits"].push_back({{"kernel", row.kernel},
                            {"points", row.points},
                            {"shape", or_null(row.shape)},
                            {"shape_was_chosen", row.shape_was_chosen},
                            {"refused", row.refused},
                            {"solver", row.solver},
                            {"iterations", row.iterations},
                            {"error", or_null(row.error)},
                            {"rate", or_null(row.rate)},
                            {"left_out_error", or_null(row.left_out)},
                            {"integral_error", or_null(row.integral_error)},
                            {"seconds", row.seconds}});
  for (const InterpolationRate& row : result.rates)
    json["rates"].push_back(
        {{"kernel", row.kernel}, {"measured", row.measured}, {"stated", or_null(row.stated)}, {"holds", row.holds()}});
  for (const InterpolationSolvers& row : result.solvers)
    json["solvers"].push_back({{"kernel", row.kernel},
                               {"points", row.points},
                               {"dense_error", row.dense_error},
                               {"krylov_error", row.krylov_error},
                               {"apart", row.apart},
                               {"dense_seconds", row.dense_seconds},
                               {"krylov_seconds", row.krylov_seconds}});
  json["agrees"] = result.agrees();
  json["seconds"] = result.seconds;
  return json.dump(2) + "\n";
}

}  // namespace gaussdrift::reproduce
