// [[check]]: bounds that the results have to keep.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "input/tables/tables.hpp"
#include "sim/borders/departures.hpp"

namespace gaussdrift::input {

Section checks_section() {
  return {
      Table{.name = "check",
            .required = false,
            .meaning =
                "a bound that the results have to keep. If they break it, the run ends with exit code 5. Several "
                "`[[check]]` are possible",
            .kinds = {"what"}},
      {{.name = "what",
        .type = Type::choice,
        .required = true,
        .choices = {"Linf", "L1", "L2", "mass", "inside", "left", "released", "stopped", "largest", "mean"},
        .meaning =
            "the number to check: a norm of the error relative to that of the exact density, or a mass "
            "relative to that at the start. `mass` is that of all particles, `inside` of those inside the "
            "domain, `left` of those that have left the run, `stopped` of those that lie at a coast. `inside` and "
            "`left` need `domain.edges` or `domain.coast`, `stopped` needs coast = \"stop\". `released` is the "
            "mass that `[[source]]` has "
            "released, relative to nothing. `largest` and `mean` are of the values that the particles have of a "
            "`field`"},
       {.name = "by",
        .type = Type::text,
        .meaning = "with what = \"left\": the reason for which particles have left, a face of the domain as in "
                   "`x_max`, or `coast`. Without it all of them count"},
       {.name = "tracer",
        .meaning = "the named density that is meant; without it the sum of all. Its mass is relative to that of all "
                   "at the start. Norms need its `exact` density"},
       {.name = "field",
        .meaning = "with what = \"largest\" or \"mean\": a field of the particles that is one number, as `ftle` or "
                   "`age`; `output.fields` names it too. Particles and outputs without a value do not count"},
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
  std::vector<double> times = spec.output.times;
  const double elapsed = spec.time.elapsed(at.number);
  const double most = std::max(std::abs(spec.time.start), std::abs(spec.time.at(spec.time.end)));
  for (const double time : times)
    if (std::abs(time - elapsed) <= same_time * std::max(spec.time.end, most)) return time;
  for (double& time : times) time = spec.time.at(time);
  if (!times.empty() && in.facts.end)
    in.diagnostics.error(
        at.written->place,
        fmt::format("check.at = {} is none of the output times", found_number(at.number, *at.written)),
        times.size() <= 10 ? fmt::format("output times: {:.6g}", fmt::join(times, ", ")) : "give one of output.times");
  return elapsed;
}

/// Masses that only some cases count.
void read_departure(Reader& in, const Value& what, const Case& spec, CheckSpec& check) {
  using Quantity = CheckSpec::Quantity;
  const Entry* by = in.find("check", "by");
  const std::vector<std::string> reasons = reasons_to_leave(spec);
  if (check.what == Quantity::inside && !spec.domain.counts_inside() && in.facts.domain_valid)
    in.diagnostics.error(what.place,
                         "what is inside the domain is counted only where domain.edges or domain.coast is given",
                         "without edges, check \"mass\"; outside in series.csv is the part that is not inside");
  if (check.what == Quantity::left && reasons.empty() && in.facts.domain_valid)
    in.diagnostics.error(
        what.place, "no particle can leave this run",
        "domain.edges opens ends of the domain: edges = [\"open\", \"open\"]; coast = \"remove\" takes "
        "what reaches land");
  if (check.what == Quantity::stopped && spec.domain.coast != AtCoast::stop && in.facts.domain_valid)
    in.diagnostics.error(what.place, "no particle of this run stops",
                         "coast = \"stop\" in [domain] stops what reaches land");
  if (check.what == Quantity::released && spec.sources.empty())
    in.diagnostics.error(what.place, "no [[source]] releases anything in this case",
                         "[[source]] with a shape or points");
  if (!by) return;
  check.by = in.text("check", "by");
  if (check.what != Quantity::left)
    in.diagnostics.error(by->place, fmt::format("\"by\" goes with what = \"left\", not with \"{}\"", what.text));
  else if (!reasons.empty() && std::find(reasons.begin(), reasons.end(), check.by) == reasons.end())
    in.diagnostics.error(by->value.place, fmt::format("no particle of this run leaves by \"{}\"", check.by),
                         fmt::format("reasons to leave: {}", fmt::join(reasons, ", ")));
}

/// Of which named density.
void read_tracer(Reader& in, const Value& what, const Case& spec, CheckSpec& check) {
  const Entry* entry = in.find("check", "tracer");
  if (!entry) return;
  check.tracer = in.text("check", "tracer");
  const auto tracer = std::find_if(spec.tracers.begin(), spec.tracers.end(),
                                   [&](const TracerSpec& one) { return one.name == check.tracer; });
  if (tracer == spec.tracers.end())
    return in.diagnostics.error(entry->value.place, fmt::format("no density is called \"{}\"", check.tracer));
  if (check.is_error() && tracer->exact.empty())
    in.diagnostics.error(what.place, fmt::format("{} of {} needs its exact density", what.text, check.tracer),
                         "[[density]] exact = \"...\" gives it");
  if (!check.is_error() && check.what != CheckSpec::Quantity::mass && check.what != CheckSpec::Quantity::released)
    in.diagnostics.error(entry->place, fmt::format("\"tracer\" does not go with what = \"{}\"", what.text),
                         "mass, released and norms are known of named densities");
}

/// The field of the particles whose values are meant.
void read_field(Reader& in, const Value& what, const Case& spec, CheckSpec& check) {
  const Entry* entry = in.find("check", "field");
  std::vector<std::string> possible;
  for (const GridField& field : spec.output.fields)
    if (field.is_of_particles && !field.is_matrix) possible.emplace_back(field.name);
  if (!check.is_of_field()) {
    if (entry)
      in.diagnostics.error(entry->place, fmt::format("\"field\" does not go with what = \"{}\"", what.text),
                           "it goes with \"largest\" and \"mean\"");
    return;
  }
  if (!entry)
    return in.diagnostics.error(what.place, fmt::format("what = \"{}\" needs a \"field\"", what.text),
                                meaning_note(find_key("check", "field")));
  check.field = in.text("check", "field");
  if (std::find(possible.begin(), possible.end(), check.field) == possible.end())
    in.diagnostics.error(
        entry->value.place, fmt::format("\"{}\" is no field of the particles that this run tells", check.field),
        possible.empty()
            ? "output.fields = [\"rho\", \"ftle\"] tells one"
            : fmt::format("those that output.fields names and that are one number: {}", fmt::join(possible, ", ")));
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
    read_departure(in, value, spec, check);
    read_tracer(in, value, spec, check);
    read_field(in, value, spec, check);
    if (check.is_error() && check.tracer.empty() && spec.reference.kind == ReferenceSpec::Kind::none)
      in.diagnostics.error(value.place,
                           fmt::format("{} needs an exact density, but reference.kind is \"none\"", value.text));
    if (const auto at = in.number("check", "at")) check.at = output_time(in, *at, spec);
    spec.checks.push_back(check);
  });
}

void write_checks(Writer& out, const std::vector<CheckSpec>& checks, const TimeSpec& time) {
  for (const CheckSpec& check : checks) {
    out.part("check", checks.size());
    out.entry("what", written_choice(find_key("check", "what"), check.what));
    if (!check.by.empty()) out.entry("by", written(check.by));
    if (!check.field.empty()) out.entry("field", written(check.field));
    if (!check.tracer.empty()) out.entry("tracer", written(check.tracer));
    if (check.max) out.entry("max", written(*check.max));
    if (check.min) out.entry("min", written(*check.min));
    if (check.at) out.entry("at", written(time.at(*check.at)));
  }
}

}  // namespace gaussdrift::input
