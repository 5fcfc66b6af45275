// The times of a series: in order, each once, and whether one is missing.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "field/gridded/grid_data.hpp"

namespace gaussdrift::read {

/// What happens where a snapshot is missing. In time one goes on over the gap.
enum class Gaps { warn, error, bridge };
constexpr std::array<std::string_view, 3> gaps_names{"warn", "error", "bridge"};

/// Which of two snapshots for one time counts.
enum class Duplicates { error, first, last };
constexpr std::array<std::string_view, 3> duplicates_names{"error", "first", "last"};

/// A snapshot: its time, and where it stands.
struct Stamp {
  double time = 0;
  std::string written;  // the time for people
  std::size_t file = 0, index = 0;
};

/// One of two equal times goes. Throws GridFileError if it may not. The times ascend.
void settle_duplicates(std::vector<Stamp>& stamps, Duplicates duplicates, const std::string& name);
/// A gap: of a series with a rhythm, a distance of more than one and a half. Throws GridFileError, or gives a warning.
void look_for_gaps(const std::vector<Stamp>& stamps, Gaps gaps, const std::string& name,
                   std::vector<DataWarning>& warnings);

}  // namespace gaussdrift::read
