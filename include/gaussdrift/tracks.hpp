/// @file
/// What a run tells of the particles that it follows, `[output.tracks]` of a case.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace gaussdrift {

/// Some places on tracks, in the order in which the run came to them: those of one track are in the order of time.
struct TrackSamples {
  int dimension = 2;  ///< 2 or 3
  /// Name and components of what is told there, as `output.tracks.fields` names it.
  std::vector<std::pair<std::string, int>> fields;
  std::vector<std::string> reasons;  ///< for which tracks may end

  std::vector<std::int64_t> id;  ///< of the particle; -1, -2, ... for the points of a table, in its order
  std::vector<double> time;      ///< of the scene
  std::vector<double> place;     ///< [i][dimension]
  std::vector<double> values;    ///< [i][all components of the fields]; NaN where something is not known
  std::vector<int> end;          ///< 0: the track goes on; k: it ends here, for reasons[k - 1]

  /// Number of places.
  std::size_t size() const { return id.size(); }
  /// Numbers that the fields have at a place.
  std::size_t components() const {
    std::size_t all = 0;
    for (const auto& [name, of_field] : fields) all += static_cast<std::size_t>(of_field);
    return all;
  }
};

}  // namespace gaussdrift
