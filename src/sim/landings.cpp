#include "sim/landings.hpp"

#include <algorithm>
#include <cstddef>

#include "effect/catalogue.hpp"
#include "sim/moments.hpp"
#include "sim/releases.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

namespace {

std::vector<double> outputs_and_end(const Case& spec) {
  std::vector<double> times = spec.output.times;
  if (times.empty() || times.back() < spec.time.end) times.push_back(spec.time.end);
  return times;
}

}  // namespace

double rounding_of_times(const Case& spec) { return 1e-12 * spec.time.end; }

std::vector<double> landings_without_moments(const Case& spec) {
  const std::vector<double> kept = outputs_and_end(spec);
  if (spec.sources.empty()) return kept;
  const double rounding = rounding_of_times(spec);
  std::vector<double> all = kept;
  double last = -1;
  for (const double time : release_times(spec)) {
    if (time <= rounding || time >= spec.time.end || time <= last + rounding) continue;
    const auto next = std::lower_bound(kept.begin(), kept.end(), time - rounding);
    if (next != kept.end() && *next <= time + rounding) continue;
    all.push_back(time);
    last = time;
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<double> landings(const Case& spec) {
  std::vector<double> all = landings_without_moments(spec);
  const auto count = static_cast<std::ptrdiff_t>(all.size());
  for (const double time : moments(spec, all))
    if (time > 0 && !std::binary_search(all.begin(), all.begin() + count, time)) all.push_back(time);
  std::inplace_merge(all.begin(), all.begin() + count, all.end());
  return all;
}

std::size_t total_steps(const Case& spec) {
  std::size_t steps = 0;
  if (time::is_adaptive(time::find_tableau(spec.time.method))) return 0;
  double from = 0;
  for (const double to : landings(spec)) {
    steps += time::Interval(from, to, spec.time.step).steps();
    from = to;
  }
  return steps;
}

}  // namespace gaussdrift
