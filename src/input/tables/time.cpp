// [time]: how long, and in which steps.
#include <fmt/format.h>

#include "input/tables/tables.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::input {

constexpr double most_steps = 2147483648.0;

void read_time(Reader& in, TimeSpec& time) {
  const auto end = in.number("time", "end");
  time.method = in.choice("time", "method");
  const bool adaptive = time::is_adaptive(time::find_tableau(time.method));
  if (!adaptive) in.require(find_key("time", "step"));
  if (const Entry* tolerance = in.find("time", "tolerance"); tolerance && !adaptive)
    in.diagnostics.error(
        tolerance->place,
        fmt::format("\"tolerance\" goes with method = {}, not with \"{}\"", time::adaptive_names(), time.method),
        "a method with fixed steps takes them as time.step says");
  const auto step = in.number("time", "step");
  if (const auto tolerance = in.number("time", "tolerance")) time.tolerance = tolerance->number;
  if (end) time.end = end->number, in.facts.end = end->number;
  if (step) time.step = step->number;
  if (end && step && time.end / time.step > most_steps)
    in.diagnostics.error(step->written->place,
                         fmt::format("time.end / time.step is {:.3g} steps; at most {} are possible",
                                     time.end / time.step, static_cast<long long>(most_steps)),
                         "raise time.step");
}

}  // namespace gaussdrift::input
