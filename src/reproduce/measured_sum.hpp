// One sum of [Sch06, ch. 4] measured three ways: direct, hermite with the thesis's parameters, and automatic.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "base/repeated_time.hpp"
#include "base/stopwatch.hpp"
#include "fgtd/fgtd.hpp"

namespace gaussdrift::reproduce {

/// Work is repeated until 0.02 s have passed and two runs agree, at most ten times and for at most 0.2 s. The fastest run
/// counts, because other programs slow down the rest. The thesis averages ten runs.
template <class Work>
double fastest_seconds(const Work& work) {
  constexpr double least_seconds = 0.02, most_seconds = 0.2;
  constexpr std::size_t most_runs = 10;
  const base::Stopwatch total;
  base::RepeatedTime time;
  do {
    const base::Stopwatch watch;
    work();
    time.add(watch.seconds());
  } while (time.count() < most_runs && total.seconds() < (time.repeatable() ? least_seconds : most_seconds));
  return time.fastest();
}

/// `wanted` of the points, evenly spaced, or all of them.
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

/// The rounding of `direct` that every promise allows for, relative to N_alpha times the weight (docs/fgtd.md).
constexpr double rounding = 3e-14;

/// r of boxes that fill the unit cube nu times on every axis; the side is rounded up, so that it fits into the cube.
inline double box_scale(int nu, double sigma) {
  return (1 + 4 * std::numeric_limits<double>::epsilon()) / (nu * std::sqrt(2 / sigma));
}

/// Boxes start at the lowest source. Two more sources, in corners of the unit cube, make it the bounding box, as in the
/// thesis; their weights are 0.
template <int d>
fgtd::Points<d> with_corners(const fgtd::Points<d>& points) {
  fgtd::Points<d> more(d, points.cols() + 2);
  more << points, Eigen::Matrix<double, d, 1>::Zero(), Eigen::Matrix<double, d, 1>::Ones();
  return more;
}
inline Eigen::MatrixXd with_corners(const Eigen::MatrixXd& weights) {
  Eigen::MatrixXd more = Eigen::MatrixXd::Zero(weights.rows() + 2, weights.cols());
  more.topRows(weights.rows()) = weights;
  return more;
}

template <int d>
struct Problem {
  fgtd::Points<d> points;   // in the unit cube; sources, and all that may be targets
  Eigen::MatrixXd weights;  // one column
  double sigma = 1;
  fgtd::Derivative<d> alpha{};
};

struct Measurement {
  double absolute = 0, relative = 0;  // max |b - f|, max |(b - f) / b| over the compared targets
  double prepare = 0, evaluate = 0;   // seconds, fastest of some runs; of one target, averaged over the timed ones
  double allowed = 0;                 // automatic: absolute error that it promises
  fgtd::Choice choice;
};

/// Targets are evenly spaced samples of the points: `compared` for the errors, `timed` for the seconds (0: no times).
template <int d>
class MeasuredSum {
 public:
  MeasuredSum(Problem<d> problem, std::size_t compared, std::size_t timed, int threads);

  /// Seconds of a target by `direct`.
  double direct_seconds() const { return direct_seconds_; }
  double total_weight() const { return problem_.weights.cwiseAbs().sum(); }  // Q
  double largest() const { return exact_.cwiseAbs().maxCoeff(); }            // |sum| at the compared targets

  /// Boxes of side 1/nu that fill the unit cube, as in the thesis; p terms; n neighbours or all_boxes.
  Measurement hermite(int nu, int p, int n) const;
  /// Automatic with a tolerance that promises `error` wherever the weights are; see automatic_tolerance().
  Measurement automatic(double error) const;
  /// error / (N_alpha Q), but neither below what can be promised nor above 0.1.
  double automatic_tolerance(double error) const;

 private:
  Measurement measure(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, fgtd::Options options) const;

  Problem<d> problem_;
  int threads_;
  fgtd::Points<d> compared_, timed_;
  Eigen::MatrixXd exact_;  // at compared_
  double direct_seconds_ = 0;
};

extern template class MeasuredSum<2>;
extern template class MeasuredSum<3>;
extern template class MeasuredSum<4>;

}  // namespace gaussdrift::reproduce
