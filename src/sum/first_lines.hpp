// The first lines of what the command `sum` prints: the same for every kernel.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <optional>
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

/// The sum of the weights without signs, what each column is right to, and what was measured of it.
template <class Sums>
std::string precision_line(const Sums& sums) {
  std::string text = fmt::format("Q      {:.9g}", sums.weight_total);
  for (std::size_t k = 0; k < sums.columns.size(); ++k)
    if (const std::optional<double> bound = sums.error_bounds[k])
      text += fmt::format("{} {} right to {:.1e}", k ? "," : ";", sums.columns[k], *bound);
  for (std::size_t k = 0; k < sums.measured.size(); ++k)
    text += fmt::format("{} {} {:.1e}", k ? "," : fmt::format("; measured at {} targets:", sums.compared),
                        sums.measured[k].of, sums.measured[k].error * sums.units[k]);
  return text + "\n";
}

}  // namespace gaussdrift::sum
