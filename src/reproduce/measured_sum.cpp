#include "reproduce/measured_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace gaussdrift::reproduce {

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
  fgtd::Options options;
  options.hermite =
      fgtd::HermiteParameters{.box_scale = box_scale(nu, problem_.sigma), .expansion_order = p, .neighbours = n};
  return measure(with_corners<d>(problem_.points), with_corners(problem_.weights), options);
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

}  // namespace gaussdrift::reproduce
