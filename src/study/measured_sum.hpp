// One sum of [Sch06, ch. 4] measured three ways: direct, hermite with the thesis's parameters, and automatic.
#pragma once

#include <cstddef>
#include <optional>

#include "fgtd/fgtd.hpp"

namespace gaussdrift::study {

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

}  // namespace gaussdrift::study
