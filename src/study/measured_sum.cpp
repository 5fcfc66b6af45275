#include "study/measured_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/stopwatch.hpp"

namespace gaussdrift::study {

namespace {

// Work is repeated until this much time has passed, ten times at most, and the fastest run counts: what other programs
// take from the machine is left out. The thesis averages ten runs.
constexpr double repeated_seconds = 0.02;
constexpr int most_repetitions = 10;

// `direct` is right to this, relative to N_alpha times the weight (docs/fgtd.md).
constexpr double rounding = 3e-14;

template <class Work>
double fastest_seconds(const Work& work) {
  const base::Stopwatch total;
  double fastest = std::numeric_limits<double>::infinity();
  for (int run = 0; run == 0 || (run < most_repetitions && total.seconds() < repeated_seconds); ++run) {
    const base::Stopwatch watch;
    work();
    fastest = std::min(fastest, watch.seconds());
  }
  return fastest;
}

template <int d>
fgtd::Points<d> sample(const fgtd::Points<d>& points, std::size_t wanted) {
  const auto all = static_cast<std::size_t>(points.cols());
  const std::size_t count = std::min(wanted, all);
  if (count == all) return points;
  fgtd::Points<d> some(d, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i)
    some.col(static_cast<Eigen::Index>(i)) = points.col(static_cast<Eigen::Index>((2 * i + 1) * all / (2 * count)));
  return some;
}

}  // namespace

template <int d>
MeasuredSum<d>::MeasuredSum(Problem<d> problem, std::size_t compared, std::size_t timed, int threads)
    : problem_(std::move(problem)),
      threads_(threads),
      compared_(sample<d>(problem_.points, compared)),
      timed_(sample<d>(problem_.points, timed)) {
  const int order = std::accumulate(problem_.alpha.begin(), problem_.alpha.end(), 0);
  const fgtd::Plan<d> plan(problem_.points, problem_.weights, problem_.sigma,
                           {.derivative_order = order, .method = fgtd::Method::direct, .threads = threads});
  direct_seconds_ = fastest_seconds([&] { exact_ = plan.evaluate(compared_, problem_.alpha); }) /
                    static_cast<double>(compared_.cols());
}

template <int d>
Measurement MeasuredSum<d>::measure(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights,
                                    fgtd::Options options) const {
  options.derivative_order = std::accumulate(problem_.alpha.begin(), problem_.alpha.end(), 0);
  options.threads = threads_;
  options.expected_targets = static_cast<std::size_t>(problem_.points.cols());
  const fgtd::Plan<d> plan(sources, weights, problem_.sigma, options);
  Measurement result;
  result.choice = plan.choice();
  const Eigen::ArrayXXd error = (plan.evaluate(compared_, problem_.alpha) - exact_).array().abs();
  // A NaN is no small error, but maxCoeff() may step over it.
  const bool broken = !error.allFinite();
  result.absolute = broken ? std::numeric_limits<double>::infinity() : error.maxCoeff();
  result.relative = broken ? std::numeric_limits<double>::infinity() : (error / exact_.array().abs()).maxCoeff();
  if (timed_.cols() > 0) {
    result.prepare = fastest_seconds([&] { fgtd::Plan<d>(sources, weights, problem_.sigma, options); });
    result.evaluate =
        fastest_seconds([&] { plan.evaluate(timed_, problem_.alpha); }) / static_cast<double>(timed_.cols());
  }
  return result;
}

template <int d>
Measurement MeasuredSum<d>::hermite(int nu, int p, int n) const {
  // Boxes start at the lowest source. Sources of weight 0 in two corners of the unit cube make it the bounding box, as
  // in the thesis. The side is rounded up, so that it fits into the cube nu times.
  const Eigen::Index count = problem_.points.cols();
  fgtd::Points<d> sources(d, count + 2);
  sources << problem_.points, Eigen::Matrix<double, d, 1>::Zero(), Eigen::Matrix<double, d, 1>::Ones();
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(count + 2, 1);
  weights.topRows(count) = problem_.weights;
  const double r = (1 + 4 * std::numeric_limits<double>::epsilon()) / (nu * std::sqrt(2 / problem_.sigma));
  fgtd::Options options;
  options.hermite = fgtd::HermiteParameters{.box_scale = r, .expansion_order = p, .neighbours = n};
  return measure(sources, weights, options);
}

template <int d>
double MeasuredSum<d>::automatic_tolerance(double error) const {
  const double scale = fgtd::derivative_scale<d>(problem_.alpha, problem_.sigma) * total_weight();
  return std::clamp(error / scale, fgtd::smallest_tolerance, 0.1);
}

template <int d>
Measurement MeasuredSum<d>::automatic(double error) const {
  fgtd::Options options;
  options.tolerance = automatic_tolerance(error);
  Measurement result = measure(problem_.points, problem_.weights, options);
  result.allowed =
      (options.tolerance + rounding) * fgtd::derivative_scale<d>(problem_.alpha, problem_.sigma) * total_weight();
  return result;
}

template class MeasuredSum<2>;
template class MeasuredSum<3>;
template class MeasuredSum<4>;

}  // namespace gaussdrift::study
