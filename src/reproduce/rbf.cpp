#include "reproduce/rbf.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/stopwatch.hpp"
#include "rbf/rbf.hpp"
#include "reproduce/measured_sum.hpp"
#include "reproduce/point_sets.hpp"

namespace gaussdrift::reproduce {

namespace {

using Eigen::Index;

/// [RB05] sums these.
bool is_in_paper(rbf::Kernel kernel) {
  return kernel == rbf::Kernel::multiquadric || kernel == rbf::Kernel::inverse_multiquadric ||
         kernel == rbf::Kernel::thin_plate;
}

/// Those of the paper first.
std::vector<rbf::Kernel> kernels() {
  std::vector<rbf::Kernel> all = rbf::kernels();
  std::stable_partition(all.begin(), all.end(), is_in_paper);
  return all;
}

/// Of both signs.
Eigen::MatrixXd weights_of(int count) {
  Eigen::MatrixXd weights(count, 1);
  for (Index j = 0; j < count; ++j) weights(j, 0) = 2 * halton(static_cast<std::size_t>(j), 7) - 1;
  return weights;
}

/// Centres and targets at random in the unit cube.
template <int d>
struct Clouds {
  explicit Clouds(int count)
      : centres(random_points<d>(static_cast<std::size_t>(count), 1)),
        targets(random_points<d>(static_cast<std::size_t>(count), 2)),
        some(sample<d>(targets, 500)),
        weights(weights_of(count)),
        range(rbf::range_of<d>(centres, targets)) {}
  rbf::Points<d> centres, targets, some;  // errors are measured at some
  Eigen::MatrixXd weights;
  double range;
};

struct Seconds {
  double fast = 0, direct = 0;
};

/// Plan and evaluation; all pairs at some targets only.
template <int d>
Seconds seconds_of(const rbf::Function& function, const Clouds<d>& clouds, const rbf::Options& options) {
  rbf::Options all_pairs = options;
  all_pairs.method = rbf::Method::direct;
  const double part = static_cast<double>(clouds.some.cols()) / static_cast<double>(clouds.targets.cols());
  Seconds seconds;
  seconds.fast = fastest_seconds(
      [&] { rbf::Plan<d>(function, clouds.centres, clouds.weights, options).evaluate(clouds.targets); });
  seconds.direct = fastest_seconds([&] {
                     rbf::Plan<d>(function, clouds.centres, clouds.weights, all_pairs).evaluate(clouds.some);
                   }) /
                   part;
  return seconds;
}

/// Value and gradient.
template <int d>
std::vector<rbf::Combination<d>> value_and_gradient() {
  std::vector<rbf::Combination<d>> wanted{{{{}, 1.0}}};
  for (std::size_t l = 0; l < d; ++l) {
    rbf::Derivative<d> along{};
    along[l] = 1;
    wanted.push_back({{along, 1.0}});
  }
  return wanted;
}

template <int d>
RbfSum sum_of(const rbf::Function& function, const Clouds<d>& clouds, const RbfOptions& options) {
  const rbf::Options plain{.tolerance = options.tolerance,
                           .method = rbf::Method::gaussians,
                           .threads = options.threads,
                           .range = clouds.range};
  rbf::Options with_gradient = plain, all_pairs = plain;
  with_gradient.derivative_order = all_pairs.derivative_order = 1;
  all_pairs.method = rbf::Method::direct;
  const auto wanted = value_and_gradient<d>();
  const Eigen::MatrixXd exact =
      rbf::Plan<d>(function, clouds.centres, clouds.weights, all_pairs).evaluate_combinations(clouds.some, wanted);
  const rbf::Plan<d> plan(function, clouds.centres, clouds.weights, plain);
  const Eigen::MatrixXd gradients = rbf::Plan<d>(function, clouds.centres, clouds.weights, with_gradient)
                                        .evaluate_combinations(clouds.some, wanted)
                                        .rightCols(d);
  const rbf::Choice& choice = plan.choice();
  const double total = clouds.weights.cwiseAbs().sum();
  const Seconds seconds = seconds_of<d>(function, clouds, plain);
  return {.kernel = to_string(function.kernel),
          .in_paper = is_in_paper(function.kernel),
          .dimension = d,
          .shape = function.shape,
          .gaussians = choice.terms.size(),
          .near = choice.near,
          .kernel_error = choice.kernel_error,
          .bound = choice.bound,
          .error = (plan.evaluate(clouds.some).col(0) - exact.col(0)).cwiseAbs().maxCoeff() / (choice.largest * total),
          .gradient_error = (gradients - exact.rightCols(d)).cwiseAbs().maxCoeff() /
                            (rbf::largest_derivative(function, clouds.range, 1) * total),
          .seconds = seconds.fast,
          .direct_seconds = seconds.direct};
}

/// Few points, so that no pairs are near: all of the kernel is Gaussians.
RbfTerms terms_of(rbf::Kernel kernel, const std::vector<double>& accuracies) {
  const rbf::Function function{kernel, rbf::takes_shape(kernel) ? 0.3 : 0};
  rbf::Points<2> corners(2, 2);
  corners << 0, 1, 0, 1;
  RbfTerms row{.kernel = to_string(kernel)};
  for (const double accuracy : accuracies)
    row.gaussians.push_back(rbf::Plan<2>(function, corners, Eigen::MatrixXd::Ones(2, 1),
                                         {.tolerance = accuracy, .method = rbf::Method::gaussians, .threads = 1})
                                .choice()
                                .terms.size());
  return row;
}

}  // namespace

bool RbfReproduction::kept() const {
  // Rounding of both sums is allowed for (docs/rbf.md, "The promise").
  const double allowed = options.tolerance + 2e-13;
  return std::all_of(sums.begin(), sums.end(), [&](const RbfSum& sum) {
    return sum.bound <= options.tolerance && sum.error <= allowed && sum.gradient_error <= allowed;
  });
}

RbfReproduction reproduce_rbf(const RbfOptions& options, const std::function<void(const std::string&)>& progress) {
  const base::Stopwatch stopwatch;
  const auto tell = [&](const std::string& what) {
    if (progress) progress(what);
  };
  RbfReproduction result{.options = options, .accuracies = {1e-2, 1e-4, 1e-6, 1e-8}};
  const Clouds<2> plane(options.points);
  const Clouds<3> space(options.points);
  for (const rbf::Kernel kernel : kernels()) {
    tell(to_string(kernel));
    result.terms.push_back(terms_of(kernel, result.accuracies));
    const bool shaped = rbf::takes_shape(kernel);
    for (const double shape : shaped ? std::vector{0.3, 0.1} : std::vector{0.0}) {
      result.sums.push_back(sum_of<2>({kernel, shape}, plane, options));
      result.sums.push_back(sum_of<3>({kernel, shape}, space, options));
    }
  }
  tell("growth");
  for (const int factor : {1, 2, 4, 8}) {
    const Clouds<2> clouds(options.points * factor);
    const Seconds seconds = seconds_of<2>({rbf::Kernel::multiquadric, 0.3}, clouds,
                                          {.tolerance = options.tolerance,
                                           .method = rbf::Method::gaussians,
                                           .threads = options.threads,
                                           .range = clouds.range});
    result.growth.push_back({options.points * factor, seconds.fast, seconds.direct});
  }
  result.seconds = stopwatch.seconds();
  return result;
}

std::string to_text(const RbfReproduction& result) {
  std::string text =
      "Gaussians that stand for a kernel of shape 0.3 in the unit square, by tolerance. * is in Roussos and Baxter "
      "2005\n"
      "kernel                ";
  const auto name_of = [](const std::string& kernel, bool in_paper) { return kernel + (in_paper ? " *" : ""); };
  for (const double accuracy : result.accuracies) text += fmt::format("  {:6.0e}", accuracy);
  text += "\n";
  for (const RbfTerms& row : result.terms) {
    text += fmt::format("{:22}", name_of(row.kernel, is_in_paper(*rbf::kernel_named(row.kernel))));
    for (const std::size_t count : row.gaussians) text += fmt::format("  {:6}", count);
    text += "\n";
  }
  text += fmt::format(
      "\nSums over {0} centres at {0} targets, at random in the unit square and cube, weights of both signs, {1} {2}.\n"
      "Errors at 500 targets, relative to the largest kernel value (slope) times the weights: {3:g} is promised.\n"
      "kernel                 d  shape  Gaussians    near  of kernel    bound    error  gradient    seconds  all pairs "
      " "
      "ratio\n",
      result.options.points, result.options.threads, result.options.threads == 1 ? "thread" : "threads",
      result.options.tolerance);
  for (const RbfSum& row : result.sums)
    text += fmt::format(
        "{:22} {:1}  {:>5}  {:9}  {:>6}   {:8.1e}  {:7.1e}  {:7.1e}   {:7.1e}  {:9.3g}  {:9.3g}  {:5.0f}\n",
        name_of(row.kernel, row.in_paper), row.dimension, row.shape > 0 ? fmt::format("{:g}", row.shape) : "-",
        row.gaussians, row.near > 0 ? fmt::format("{:.4f}", row.near) : "-", row.kernel_error, row.bound, row.error,
        row.gradient_error, row.seconds, row.direct_seconds, row.ratio());
  text +=
      "\nThe multiquadric of shape 0.3 in the plane: time grows as the number of points\n"
      "  points    seconds  us a point  all pairs   ratio\n";
  for (const RbfGrowth& row : result.growth)
    text += fmt::format("{:8}  {:9.3g}  {:10.3f}  {:9.3g}  {:6.0f}\n", row.points, row.seconds,
                        1e6 * row.seconds / row.points, row.direct_seconds, row.direct_seconds / row.seconds);
  return text + fmt::format("\n{}. {:.1f} s\n",
                            result.kept() ? "Every sum keeps its promise" : "A SUM BREAKS ITS PROMISE", result.seconds);
}

std::string to_json(const RbfReproduction& result) {
  nlohmann::ordered_json json = {{"points", result.options.points},
                                 {"tolerance", result.options.tolerance},
                                 {"threads", result.options.threads},
                                 {"accuracies", result.accuracies}};
  for (const char* list : {"terms", "sums", "growth"}) json[list] = nlohmann::ordered_json::array();
  for (const RbfTerms& row : result.terms)
    json["terms"].push_back({{"kernel", row.kernel}, {"gaussians", row.gaussians}});
  for (const RbfSum& row : result.sums)
    json["sums"].push_back({{"kernel", row.kernel},
                            {"in_paper", row.in_paper},
                            {"dimension", row.dimension},
                            {"shape", row.shape > 0 ? nlohmann::ordered_json(row.shape) : nullptr},
                            {"gaussians", row.gaussians},
                            {"near", row.near},
                            {"kernel_error", row.kernel_error},
                            {"bound", row.bound},
                            {"error", row.error},
                            {"gradient_error", row.gradient_error},
                            {"seconds", row.seconds},
                            {"direct_seconds", row.direct_seconds},
                            {"ratio", row.ratio()}});
  for (const RbfGrowth& row : result.growth)
    json["growth"].push_back(
        {{"points", row.points}, {"seconds", row.seconds}, {"direct_seconds", row.direct_seconds}});
  json["kept"] = result.kept();
  json["seconds"] = result.seconds;
  return json.dump(2) + "\n";
}

}  // namespace gaussdrift::reproduce
