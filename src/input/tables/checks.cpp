// [[check]]: bounds that the results have to keep.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "input/tables/tables.hpp"

namespace gaussdrift::input {

Section checks_section() {
  return {Table{.name = "check",
                .required = false,
                .meaning =
                    "a bound that the results have to keep. If they break it, the run ends with exit code 5. Several "
                    "`[[check]]` are possible",
                .kinds = {"what"}},
          {{.name = "what",
            .type = Type::choice,
            .required = true,
            .choices = {"Linf", "L1", "L2", "mass"},
            .meaning = "the number to check: a norm of the error relative to that of the exact density, or the mass "
                       "relative to that at the start"},
           {.name = "max", .type = Type::number, .meaning = "the number must not be larger"},
           {.name = "min", .type = Type::number, .meaning = "the number must not be smaller"},
           {.name = "at",
            .type = Type::number,
            .unit = "time",
            .meaning = "the output time to check. Without it every output is checked"}}};
}

using Kind = Value::Kind;

namespace {

/// The output time that a number means, exactly as the outputs have it; a complaint if there is none.
double output_time(Reader& in, const Number& at, const Case& spec) {
  const auto& times = spec.output.times;
  for (const double time : times)
    if (std::abs(time - at.number) <= same_time * spec.time.end) return time;
  if (!times.empty() && in.facts.end)
    in.diagnostics.error(
        at.written->place,
        fmt::format("check.at = {} is none of the output times", found_number(at.number, *at.written)),
        times.size() <= 10 ? fmt::format("output times: {:.6g}", fmt::join(times, ", ")) : "give one of output.times");
  return at.number;
}

}  // namespace

void read_checks(Reader& in, Case& spec) {
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
    if (check.what != CheckSpec::Quantity::mass && spec.reference.kind == ReferenceSpec::Kind::none)
      in.diagnostics.error(value.place,
                           fmt::format("{} needs an exact density, but reference.kind is \"none\"", value.text));
    if (const auto at = in.number("check", "at")) check.at = output_time(in, *at, spec);
    spec.checks.push_back(check);
  });
}

void write_checks(Writer& out, const std::vector<CheckSpec>& checks) {
  for (const CheckSpec& check : checks) {
    out.part("check", checks.size());
    out.entry("what", written_choice(find_key("check", "what"), check.what));
    if (check.max) out.entry("max", written(*check.max));
    if (check.min) out.entry("min", written(*check.min));
    if (check.at) out.entry("at", written(*check.at));
  }
}

}  // namespace gaussdrift::input
