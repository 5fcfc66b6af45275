// Sizes in bytes for people.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace gaussdrift::base {

/// "800 bytes", "12 kB", "3.07 GB".
inline std::string size_text(double bytes) {
  if (bytes > 0 && bytes < 1e3) return fmt::format("{:.0f} bytes", bytes);
  if (bytes < 999.5e3) return fmt::format("{:.0f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.3g} MB", bytes / 1e6);
  return fmt::format("{:.3g} GB", bytes / 1e9);
}

/// Bytes of "2 GiB", "500 MB", "1.5GB" or "2e9"; none if it is no size. Upper and lower case do not matter.
inline std::optional<double> read_size(std::string_view text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || !std::isfinite(value) || value <= 0) return std::nullopt;
  std::string unit;
  for (const char c : std::string_view(end, static_cast<std::size_t>(text.data() + text.size() - end)))
    if (c != ' ' || !unit.empty()) unit += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  constexpr std::pair<std::string_view, double> units[] = {{"", 1},
                                                           {"b", 1},
                                                           {"kb", 1e3},
                                                           {"mb", 1e6},
                                                           {"gb", 1e9},
                                                           {"tb", 1e12},
                                                           {"kib", 1024},
                                                           {"k", 1024},
                                                           {"mib", 1048576},
                                                           {"m", 1048576},
                                                           {"gib", 1073741824},
                                                           {"g", 1073741824},
                                                           {"tib", 1099511627776},
                                                           {"t", 1099511627776}};
  for (const auto& [name, bytes] : units)
    if (unit == name) return value * bytes;
  return std::nullopt;
}

/// For messages: how read_size() wants it.
constexpr const char* size_form = "a size such as \"2 GiB\", \"500 MB\" or a number of bytes";

}  // namespace gaussdrift::base
