// What the next accuracy would cost: the settings of --accuracy for an error well below that of a run, and their seconds.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift::accuracy {

struct NextTarget {
  double target = 0;                  // a power of ten, at most a third of the error of the run
  std::vector<std::string> settings;  // as AccuracyChoice has them
  double seconds_more = 0;            // than the run took; below 0: less
};

/// `error`: of the run, relative to the largest density. `seconds`: what its steps and sums took with so many particles.
/// Nothing where the error is above a tenth, or where no settings are found with a tenth of the work of the run or a
/// second of it.
std::optional<NextTarget> next_target(const Case& spec, double error, std::size_t particles, double seconds,
                                      int threads);

}  // namespace gaussdrift::accuracy
