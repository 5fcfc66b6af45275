// tracks.csv as it stands on the disk, row after row: other files of tracks are made from it when the run has ended, so
// that no run holds its tracks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gaussdrift/tracks.hpp"
#include "write/vtk_array.hpp"

namespace gaussdrift::write {

/// What the columns of a table of tracks are: id, t, places, values of fields, end.
struct TrackColumns {
  int dimension = 2;
  std::vector<std::pair<std::string, int>> fields;  // and their components
  std::vector<std::string> reasons;

  std::string heading() const;
  /// Of a number: t is 1, places follow, then fields.
  std::size_t first_of_fields() const { return 2 + static_cast<std::size_t>(dimension); }
};

/// The rows of some places, as they stand in the table.
std::string track_rows_text(const TrackSamples& samples);

/// One row.
class TrackRow {
 public:
  std::int64_t id = 0;
  std::size_t track = 0;  // its number, in the order of ids
  std::size_t place = 0;  // on the track, from 0

  /// Of a column; NaN where it is "nan".
  double number(std::size_t column) const;
  /// For which the track ends here; empty: it goes on.
  std::string_view end() const { return cells_.back(); }

 private:
  friend class TrackTable;
  std::vector<std::string_view> cells_;
};

/// A table that is complete.
class TrackTable {
 public:
  /// Reads it once, to know its tracks. Throws FileError: it cannot be read, or is not what a run has written.
  TrackTable(std::filesystem::path file, TrackColumns columns);

  const TrackColumns& columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  struct Track {
    std::int64_t id = 0;
    std::size_t rows = 0;
    int end = 0;  // 0: it has none; k: reasons[k - 1]
  };
  /// By id.
  const std::vector<Track>& tracks() const { return tracks_; }
  /// The rows in order. Throws FileError.
  void for_each_row(const std::function<void(const TrackRow& row)>& visit) const;

 private:
  void scan(const std::function<void(TrackRow& row)>& visit) const;

  std::filesystem::path file_;
  TrackColumns columns_;
  std::size_t rows_ = 0;
  std::vector<Track> tracks_;
};

}  // namespace gaussdrift::write
