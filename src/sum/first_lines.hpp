// The first lines of what the command `sum` prints: the same for every kernel.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

#include "base/printed.hpp"

namespace gaussdrift::sum {

/// Columns, targets, seconds by stage, and the method that did the sums.
template <class Sums>
std::string first_lines(const Sums& sums) {
  return fmt::format(
      "sums   {} at {} targets in {:.3g} s on {} {} (read {:.3g}, prepare {:.3g}, evaluate {:.3g}, compare {:.3g}, "
      "write {:.3g})\nmethod {}\n",
      fmt::join(sums.columns, ", "), sums.values.rows(),
      sums.read_seconds + sums.prepare_seconds + sums.evaluate_seconds + sums.compare_seconds + sums.write_seconds,
      sums.threads, sums.threads == 1 ? "thread" : "threads", sums.read_seconds, sums.prepare_seconds,
      sums.evaluate_seconds, sums.compare_seconds, sums.write_seconds, base::printed(sums.choice));
}

}  // namespace gaussdrift::sum
