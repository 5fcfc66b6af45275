#include "sim/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/nan.hpp"

namespace gaussdrift {

namespace {

using base::nan;

double mass_that_left(const CheckSpec& check, const FrameNumbers& numbers) {
  double mass = 0;
  for (const Departed& departed : numbers.left)
    if (check.by.empty() || check.by == departed.reason) mass += departed.mass;
  return mass;
}

/// The mass of a tracer relative to that of all at the start, what was released of it, or a norm of its own error.
double quantity_of_tracer(const CheckSpec& check, double mass_at_start, const FrameNumbers& numbers) {
  for (const TracerNumbers& tracer : numbers.tracers) {
    if (tracer.name != check.tracer) continue;
    if (check.what == CheckSpec::Quantity::released) return tracer.released.value_or(nan);
    if (!check.is_error()) return mass_at_start == 0 ? nan : tracer.mass / mass_at_start;
    if (!tracer.error) return nan;
    return check.what == CheckSpec::Quantity::linf ? tracer.error->linf
           : check.what == CheckSpec::Quantity::l1 ? tracer.error->l1
                                                   : tracer.error->l2;
  }
  return nan;
}

double quantity_of_field(const CheckSpec& check, const FrameNumbers& numbers) {
  for (const FieldNumbers& field : numbers.fields)
    if (field.name == check.field) return check.what == CheckSpec::Quantity::largest ? field.largest : field.mean;
  return nan;
}

double quantity_of(const CheckSpec& check, double mass_at_start, const FrameNumbers& numbers) {
  if (check.is_of_field()) return quantity_of_field(check, numbers);
  if (!check.tracer.empty()) return quantity_of_tracer(check, mass_at_start, numbers);
  if (check.what == CheckSpec::Quantity::released) return numbers.released.value_or(nan);
  if (!check.is_error()) {
    if (mass_at_start == 0) return nan;
    if (check.what == CheckSpec::Quantity::stopped)
      return numbers.stopped ? numbers.stopped->mass / mass_at_start : nan;
    if (check.what == CheckSpec::Quantity::inside) return numbers.inside ? *numbers.inside / mass_at_start : nan;
    return (check.what == CheckSpec::Quantity::left ? mass_that_left(check, numbers) : numbers.mass) / mass_at_start;
  }
  if (!numbers.error || numbers.untraced > 0) return nan;
  switch (check.what) {
    case CheckSpec::Quantity::linf:
      return numbers.error->linf;
    case CheckSpec::Quantity::l1:
      return numbers.error->l1;
    case CheckSpec::Quantity::l2:
      return numbers.error->l2;
    case CheckSpec::Quantity::mass:
    case CheckSpec::Quantity::inside:
    case CheckSpec::Quantity::left:
    case CheckSpec::Quantity::released:
    case CheckSpec::Quantity::stopped:
    case CheckSpec::Quantity::largest:
    case CheckSpec::Quantity::mean:
      break;
  }
  return nan;
}

std::string why_not_known(const CheckSpec& check, const FrameNumbers& numbers) {
  if (check.is_of_field()) return fmt::format("no particle has a value of {}", check.field);
  if (!check.is_error()) return "the mass at the start is 0";
  if (!numbers.no_norms.empty()) return numbers.no_norms;
  if (numbers.untraced > 0) return fmt::format("the exact density is not known at {} grid points", numbers.untraced);
  return numbers.error ? "it is not a number" : "the run was compared with nothing";
}

// How far a value lies beyond the limits; positive if it does. NaN lies beyond all limits.
double excess(const CheckSpec& check, double value) {
  if (std::isnan(value)) return std::numeric_limits<double>::infinity();
  double beyond = -std::numeric_limits<double>::infinity();
  if (check.max) beyond = std::fmax(beyond, value - *check.max);
  if (check.min) beyond = std::fmax(beyond, *check.min - value);
  return beyond;
}

std::string limits_text(const CheckSpec& check) {
  if (check.min && check.max) return fmt::format("between {} and {}", *check.min, *check.max);
  return check.max ? fmt::format("at most {}", *check.max) : fmt::format("at least {}", check.min.value_or(0));
}

}  // namespace

std::string to_string(CheckSpec::Quantity quantity) {
  switch (quantity) {
    case CheckSpec::Quantity::linf:
      return "Linf";
    case CheckSpec::Quantity::l1:
      return "L1";
    case CheckSpec::Quantity::l2:
      return "L2";
    case CheckSpec::Quantity::mass:
      return "mass";
    case CheckSpec::Quantity::inside:
      return "inside";
    case CheckSpec::Quantity::left:
      return "left";
    case CheckSpec::Quantity::released:
      return "released";
    case CheckSpec::Quantity::stopped:
      return "stopped";
    case CheckSpec::Quantity::largest:
      return "largest";
    case CheckSpec::Quantity::mean:
      return "mean";
  }
  return "";
}

std::string words_for(const CheckSpec& check) {
  return to_string(check.what) + (check.field.empty() ? "" : " " + check.field) +
         (check.by.empty() ? "" : " by " + check.by) + (check.tracer.empty() ? "" : " of " + check.tracer);
}

bool checks_fields(const std::vector<CheckSpec>& checks) {
  return std::any_of(checks.begin(), checks.end(), [](const CheckSpec& check) { return check.is_of_field(); });
}

std::vector<FieldNumbers> count_fields(const std::vector<CheckSpec>& checks, const std::vector<FieldOnGrid>& fields) {
  std::vector<FieldNumbers> counted;
  for (const FieldOnGrid& field : fields) {
    if (std::none_of(checks.begin(), checks.end(), [&](const CheckSpec& check) { return check.field == field.name; }))
      continue;
    FieldNumbers& one = counted.emplace_back(FieldNumbers{.name = field.name, .largest = nan});
    for (const double value : field.values) {
      if (!std::isfinite(value)) continue;
      one.largest = one.values == 0 ? value : std::max(one.largest, value);
      one.mean += value;
      ++one.values;
    }
    one.mean = one.values == 0 ? nan : one.mean / static_cast<double>(one.values);
  }
  return counted;
}

const std::pair<double, FrameNumbers>* worst_output(const std::vector<std::pair<double, FrameNumbers>>& frames) {
  const std::pair<double, FrameNumbers>* worst = nullptr;
  for (const auto& frame : frames) {
    const auto& error = frame.second.error;
    if (error && std::isfinite(error->l1) && (!worst || error->l1 > worst->second.error->l1)) worst = &frame;
  }
  return worst;
}

std::vector<CheckResult> judge(const std::vector<CheckSpec>& checks, double mass_at_start,
                               const std::vector<std::pair<double, FrameNumbers>>& frames, const TimeSpec& clock) {
  std::vector<CheckResult> results;
  for (const CheckSpec& check : checks) {
    CheckResult result;
    result.check = check;
    double worst = -std::numeric_limits<double>::infinity();
    bool seen = false;
    std::string why = "no output is at this time";
    for (const auto& [time, numbers] : frames) {
      if (check.at && *check.at != time) continue;
      if (check.is_of_field() && std::isnan(quantity_of_field(check, numbers))) {
        why = why_not_known(check, numbers);
        continue;
      }
      const double value = quantity_of(check, mass_at_start, numbers), beyond = excess(check, value);
      if (seen && beyond <= worst) continue;
      seen = true;
      worst = beyond, result.value = value, result.time = clock.at(time);
      why = why_not_known(check, numbers);
    }
    if (!seen) result.value = nan;
    result.passed = seen && worst <= 0;
    if (std::isnan(result.value)) {
      result.text = fmt::format("{} at t = {:.6g} must be {} but is not known: {}", words_for(check), result.time,
                                limits_text(check), why);
      results.push_back(std::move(result));
      continue;
    }
    // Enough digits that a value and the limit it missed do not look the same.
    result.text = fmt::format("{} = {:.15g} at t = {:.6g}, {} {}", words_for(check), result.value, result.time,
                              result.passed ? "is" : "must be", limits_text(check));
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace gaussdrift
