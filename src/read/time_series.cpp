#include "read/time_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

void settle_duplicates(std::vector<Stamp>& stamps, Duplicates duplicates, const std::string& name) {
  std::vector<Stamp> kept;
  for (Stamp& stamp : stamps) {
    if (kept.empty() || stamp.time != kept.back().time) {
      kept.push_back(std::move(stamp));
      continue;
    }
    if (duplicates == Duplicates::error)
      throw GridFileError(fmt::format("{} has two snapshots for {}", name, stamp.written),
                          "duplicates = \"first\" or \"last\" says which one counts");
    if (duplicates == Duplicates::last) kept.back() = std::move(stamp);
  }
  stamps = std::move(kept);
}

void look_for_gaps(const std::vector<Stamp>& stamps, Gaps gaps, const std::string& name,
                   std::vector<DataWarning>& warnings) {
  if (stamps.size() < 4 || gaps == Gaps::bridge) return;
  std::vector<double> distances;
  for (std::size_t i = 1; i < stamps.size(); ++i) distances.push_back(stamps[i].time - stamps[i - 1].time);
  std::vector<double> sorted = distances;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  const auto in_rhythm =
      std::count_if(distances.begin(), distances.end(), [&](double d) { return std::abs(d - usual) < 0.01 * usual; });
  if (2 * in_rhythm <= static_cast<std::ptrdiff_t>(distances.size())) return;  // months, or by hand
  std::size_t count = 0, first = 0;
  double missing = 0;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (distances[i] > 1.5 * usual) {
      if (count++ == 0) first = i;
      missing += std::round(distances[i] / usual) - 1;
    }
  if (count == 0) return;
  const std::string message = fmt::format("{} misses {:.0f} snapshot{}: between {} and {} {}", name, missing,
                                          missing == 1 ? "" : "s", stamps[first].written, stamps[first + 1].written,
                                          count == 1 ? "is a gap" : fmt::format("is the first of {} gaps", count));
  if (gaps == Gaps::error) throw GridFileError(message, "gaps = \"bridge\" interpolates over it");
  warnings.push_back({message,
                      "values there are interpolated over it. gaps = \"bridge\" says that this is meant, gaps = "
                      "\"error\" refuses it"});
}

}  // namespace gaussdrift::read
