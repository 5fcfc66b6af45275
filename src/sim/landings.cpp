#include "sim/landings.hpp"

#include "effect/catalogue.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

std::vector<double> landings(const Case& spec) {
  std::vector<double> times = spec.output.times;
  if (times.empty() || times.back() < spec.time.end) times.push_back(spec.time.end);
  return times;
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
