// How far a fit to samples is off, near given points. Each sample that is left out and predicted from the others tells the
// error around it. Those at the border, which others see from one side, have by far the largest, and do not matter where
// no particle comes.
#pragma once

#include <vector>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

class FitErrors {
 public:
  FitErrors() = default;
  /// positions  [point][dimension];  errors  [point], NaN where nothing is known
  FitErrors(int dimension, const std::vector<double>& positions, const std::vector<double>& errors);

  bool known() const { return !errors_.empty(); }
  /// The root mean square over some points, at most some hundred of them, of the errors of the samples that are nearest to
  /// each. 0 if nothing is known.
  double near(const PointsView& points) const;

 private:
  int dimension_ = 2;
  std::vector<double> positions_;  // [point][dimension]
  std::vector<double> errors_;
};

}  // namespace gaussdrift
