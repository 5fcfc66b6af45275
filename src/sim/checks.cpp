#include "sim/checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace gaussdrift {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double quantity_of(CheckSpec::Quantity what, double mass_at_start, const FrameNumbers& numbers) {
  if (what == CheckSpec::Quantity::mass) return mass_at_start != 0 ? numbers.mass / mass_at_start : nan;
  if (!numbers.error || numbers.untraced > 0) return nan;
  switch (what) {
    case CheckSpec::Quantity::linf:
      return numbers.error->linf;
    case CheckSpec::Quantity::l1:
      return numbers.error->l1;
    case CheckSpec::Quantity::l2:
      return numbers.error->l2;
    case CheckSpec::Quantity::mass:
      break;
  }
  return nan;
}

// How far a value lies beyond the limits: positive if it does. One that is no number is beyond all.
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
  }
  return "";
}

std::vector<CheckResult> judge(const std::vector<CheckSpec>& checks, double mass_at_start,
                               const std::vector<std::pair<double, FrameNumbers>>& frames) {
  std::vector<CheckResult> results;
  for (const CheckSpec& check : checks) {
    CheckResult result;
    result.check = check;
    double worst = -std::numeric_limits<double>::infinity();
    bool seen = false;
    for (const auto& [time, numbers] : frames) {
      if (check.at && *check.at != time) continue;
      const double value = quantity_of(check.what, mass_at_start, numbers), beyond = excess(check, value);
      if (seen && beyond <= worst) continue;
      seen = true;
      worst = beyond, result.value = value, result.time = time;
    }
    if (!seen) result.value = nan;
    result.passed = seen && worst <= 0;
    // Enough digits that a value and the limit it missed do not look the same.
    result.text = fmt::format("{} = {:.15g} at t = {:.6g}, {} {}", to_string(check.what), result.value, result.time,
                              result.passed ? "is" : "must be", limits_text(check));
    if (std::isnan(result.value)) result.text += "; it is not known there";
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace gaussdrift
