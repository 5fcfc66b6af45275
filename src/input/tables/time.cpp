// [time]: how long, and in which steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "field/gridded/grid_data.hpp"
#include "input/tables/tables.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::input {

Section time_section() {
  return {
      Table{.name = "time", .required = true, .meaning = "how long the run lasts, and in which steps"},
      {{.name = "start",
        .type = Type::number,
        .fallback = "0",
        .unit = "time",
        .meaning = "time at which the run begins, a number or, with data that have dates, a date such as "
                   "\"2020-01-03 12:00\". The density is that of this time"},
       {.name = "end",
        .type = Type::number,
        .required = true,
        .unit = "time",
        .symbol = "T",
        .meaning = "time at which the run ends. If it is before `start`, the run goes backwards in time: particles go "
                   "back to where they came from"},
       {.name = "step",
        .type = Type::number,
        .range = {0, infinity, true},
        .unit = "time",
        .symbol = "tau",
        .meaning = "time step; the last one before an output is shortened to end there. A `method` that chooses its "
                   "own steps needs no `step`; if there is one, no step is longer"},
       {.name = "method",
        .type = Type::choice,
        .fallback = time::tableaux().front().name,
        .choices = base::names_of(time::tableaux()),
        .meaning = with_choices("Runge-Kutta method", time::tableaux())},
       {.name = "tolerance",
        .type = Type::number,
        .fallback = "1e-08",
        .range = {1e-13, 1, false, true},
        .meaning = "for a `method` that chooses its own steps: the error of position that one step may make, relative "
                   "to the longest side of the domain"}}};
}

constexpr double most_steps = 2147483648.0;

void read_time(Reader& in, TimeSpec& time) {
  const auto start = in.number("time", "start"), end = in.number("time", "end");
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
  if (start && end) {
    time.start = start->number;
    time.backwards = end->number < start->number;
    time.end = time.elapsed(end->number);
    in.facts.end = time.end;
  }
  if (step) time.step = step->number;
  const double apart = std::max(std::abs(time.start), std::abs(time.at(time.end))) * 4e-16;  // of neighbouring numbers
  if (start && end && step && time.end > 0 && time.step <= apart)
    in.diagnostics.error(
        step->written->place,
        fmt::format("time.step = {} is too short beside times of {}: the clock would not move", time.step, time.start),
        "let the clock begin nearer to 0");
  if (start && end && step && time.end / time.step > most_steps)
    in.diagnostics.error(step->written->place,
                         fmt::format("{} / time.step is {:.3g} steps; at most {} are possible",
                                     time.start == 0 ? "time.end" : "|time.end - time.start|", time.end / time.step,
                                     static_cast<long long>(most_steps)),
                         "raise time.step");
  for (const auto& [place, data] : in.facts.grid_files)
    if (!time.date && data->dates) time.date = data->dates->written;
}

void write_time(Writer& out, const TimeSpec& time) {
  out.table("time");
  if (time.start != 0) out.entry("start", written(time.start));
  out.entry("end", written(time.at(time.end)));
  if (time.step > 0) out.entry("step", written(time.step));
  out.entry("method", written(time.method));
  if (time::is_adaptive(time::find_tableau(time.method))) out.entry("tolerance", written(time.tolerance));
}

}  // namespace gaussdrift::input
