// Long and short times for people.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace gaussdrift::base {

/// "45 s", "12 minutes", "3.5 hours", "12 days".
inline std::string duration_text(double seconds) {
  if (seconds < 120) return fmt::format("{:.2g} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} minutes", seconds / 60);
  if (seconds < 172800) return fmt::format("{:.2g} hours", seconds / 3600);
  return fmt::format("{:.3g} days", seconds / 86400);
}

/// Seconds of "10 min", "2 h", "1.5 days", "90 s" or "90"; none if it is no length of time.
inline std::optional<double> read_duration(std::string_view text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || !std::isfinite(value) || value < 0) return std::nullopt;
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  for (const std::string_view seconds : {"", "s", "sec", "second", "seconds"})
    if (unit == seconds) return value;
  for (const std::string_view minutes : {"min", "minute", "minutes"})
    if (unit == minutes) return 60 * value;
  for (const std::string_view hours : {"h", "hour", "hours"})
    if (unit == hours) return 3600 * value;
  for (const std::string_view days : {"d", "day", "days"})
    if (unit == days) return 86400 * value;
  return std::nullopt;
}

/// For messages: how read_duration() wants it.
constexpr const char* duration_form = "seconds, or a text such as \"90 s\", \"10 min\", \"2 h\" or \"1 day\"";

}  // namespace gaussdrift::base
