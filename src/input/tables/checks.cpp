// [[check]]: bounds that the results have to keep.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "input/tables/tables.hpp"

namespace gaussdrift::input {

using Kind = Value::Kind;

namespace {

/// The output time that a number means, exactly as the outputs have it; a complaint if there is none.
double output_time(Reader& in, const Number& at, const Case& scene) {
  const auto& times = scene.output.times;
  for (const double time : times)
    if (std::abs(time - at.number) <= same_time * scene.time.end) return time;
  if (!times.empty() && in.facts.end)
    in.diagnostics.error(
        at.written->place,
        fmt::format("check.at = {} is none of the output times", found_number(at.number, *at.written)),
        times.size() <= 10 ? fmt::format("output times: {:.6g}", fmt::join(times, ", ")) : "give one of output.times");
  return at.number;
}

}  // namespace

void read_checks(Reader& in, Case& scene) {
  in.each_part("check", [&](std::string_view, const Value& value) {
    CheckSpec check;
    const auto& names = find_key("check", "what").choices;
    check.what = static_cast<CheckSpec::Quantity>(std::find(names.begin(), names.end(), value.text) - names.begin());
    if (const auto max = in.number("check", "max")) check.max = max->number;
    if (const auto min = in.number("check", "min")) check.min = min->number;
    const Entry *max = in.find("check", "max"), *min = in.find("check", "min");
    if (!max && !min)
      in.diagnostics.error(value.place, "a check needs \"max\" or \"min\", or both", "max = 0.03: at most 0.03");
    if (check.max && check.min && *check.min > *check.max)
      in.diagnostics.error(min->value.place,
                           fmt::format("no number is at least {} and at most {}", *check.min, *check.max));
    if (check.what != CheckSpec::Quantity::mass && scene.reference.kind == ReferenceSpec::Kind::none)
      in.diagnostics.error(value.place,
                           fmt::format("{} needs an exact density, but reference.kind is \"none\"", value.text));
    if (const auto at = in.number("check", "at")) check.at = output_time(in, *at, scene);
    scene.checks.push_back(check);
  });
}

}  // namespace gaussdrift::input
