#include "sim/landings.hpp"

#include "effect/catalogue.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

std::vector<double> landings(const Case& description) {
  std::vector<double> times = description.output.times;
  if (times.empty() || times.back() < description.time.end) times.push_back(description.time.end);
  return times;
}

std::size_t total_steps(const Case& description) {
  std::size_t steps = 0;
  if (time::is_adaptive(time::find_tableau(description.time.method))) return 0;
  double from = 0;
  for (const double to : landings(description)) {
    steps += time::Interval(from, to, description.time.step).steps();
    from = to;
  }
  return steps;
}

}  // namespace gaussdrift
