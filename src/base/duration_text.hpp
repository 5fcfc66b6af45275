// Long and short times for people.
#pragma once

#include <fmt/format.h>

#include <string>

namespace gaussdrift::base {

/// "45 s", "12 minutes", "3.5 hours", "12 days".
inline std::string duration_text(double seconds) {
  if (seconds < 120) return fmt::format("{:.2g} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} minutes", seconds / 60);
  if (seconds < 172800) return fmt::format("{:.2g} hours", seconds / 3600);
  return fmt::format("{:.3g} days", seconds / 86400);
}

}  // namespace gaussdrift::base
