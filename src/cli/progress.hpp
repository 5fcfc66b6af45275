// One line that tells how far a run is: rewritten in place on a terminal, a plain line now and then elsewhere.
#pragma once

#include <optional>
#include <string>

#include "base/stopwatch.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift::cli {

class ProgressLine {
 public:
  /// On a terminal the first line comes after so many seconds.
  explicit ProgressLine(double first = 0);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const Progress& progress);
  /// A short note instead of a run's progress ("12 of 120 heights").
  void show(const std::string& text);
  /// Removes the line from a terminal, before other output.
  void clear();

 private:
  bool terminal_;
  double first_;
  bool visible_ = false;
  base::Stopwatch watch_;
  double last_ = -1;  // seconds at which the line was last written
};

/// What is left of a run, in seconds: steps and outputs each take as long as those before did. Empty before there is
/// anything to judge by, since seeding and the first output say nothing of the steps.
std::optional<double> seconds_left(const Progress& progress);

/// "42 %  t = 2.64 of 6.28  step 2 640 of 6 284  0.02 ms a step  3 s left"
std::string progress_text(const Progress& progress);

}  // namespace gaussdrift::cli
