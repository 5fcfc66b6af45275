// The times of steps: full steps of tau, the last of which is shortened to end exactly at the landing time.
#pragma once

#include <cstddef>

namespace gaussdrift::time {

/// The steps from one landing time to the next.
class Interval {
 public:
  Interval() = default;  // no step
  /// begin <= end, step > 0. A remainder below 1e-9 steps is rounding and joins the step before.
  Interval(double begin, double end, double step);

  std::size_t steps() const { return steps_; }
  /// Time at which step i begins, i <= steps(); start(steps()) is exactly `end`. Not accumulated, so it does not drift.
  double start(std::size_t i) const { return i >= steps_ ? end_ : begin_ + static_cast<double>(i) * step_; }
  double length(std::size_t i) const { return i + 1 < steps_ ? step_ : end_ - start(i); }
  bool operator==(const Interval&) const = default;

 private:
  double begin_ = 0, end_ = 0, step_ = 1;
  std::size_t steps_ = 0;
};

}  // namespace gaussdrift::time
