// The steps that particles have taken since all of them stood on nodes of the lattice. New particles take them too.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/state_bytes.hpp"
#include "time/schedule.hpp"

namespace gaussdrift {

class StepsTaken {
 public:
  /// `steps` of an interval, from `first` on.
  struct Part {
    time::Interval interval;
    std::size_t first = 0, steps = 0;
    bool operator==(const Part&) const = default;
  };

  /// One step more, the i-th of its interval.
  void add(const time::Interval& interval, std::size_t i);
  void clear() { parts_.clear(); }
  const std::vector<Part>& parts() const { return parts_; }

  /// Writes all parts, or reads them.
  void pass(base::StateBytes& bytes) { bytes(parts_); }
  /// The same in few bytes where most parts lead from one of these times to the next, by steps of that length. Throws
  /// std::out_of_range if the bytes say what cannot be.
  void pass(base::StateBytes& bytes, std::span<const double> times, double step);

  /// Whether these are steps of that length, one after another, and none of them after `now`.
  bool fit(double step, double now) const;

 private:
  std::vector<Part> parts_;
};

}  // namespace gaussdrift
