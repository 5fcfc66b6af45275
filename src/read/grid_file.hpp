// Data on grids from ParaView files: .vti (image data), .vtr (rectilinear grid), .pvd (a series of them).
// grid_file.cpp is the one place that reads with VTK.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "field/grid_data.hpp"

namespace gaussdrift::read {

/// A file that cannot be used: what is wrong, and what to do about it.
class GridFileError : public std::runtime_error {
 public:
  explicit GridFileError(const std::string& message, std::string remedy = {})
      : std::runtime_error(message), remedy_(std::move(remedy)) {}
  const std::string& remedy() const { return remedy_; }

 private:
  std::string remedy_;
};

/// Reads point data `array` (empty: the only array) in `dimension` dimensions; a grid one layer thick along z is 2D.
/// least_components, most_components: what the array may have. At most 2 GiB of numbers are read.
/// Throws GridFileError: no such file or array, not VTK's XML, wrong number of components or dimensions, values that
/// are not finite, grids of a series that differ.
std::shared_ptr<const GridData> read_grid(const std::filesystem::path& file, const std::string& array, int dimension,
                                          std::size_t least_components, std::size_t most_components);

/// One file of a series, the times ascending.
struct SeriesEntry {
  std::filesystem::path file;
  double time = 0;
};
/// The files that a .pvd lists, relative to its folder. Throws GridFileError.
std::vector<SeriesEntry> read_series(const std::filesystem::path& file);

/// An array with one component of one .vti or .vtr, as it is: values may be NaN.
struct GridSnapshot {
  int dimension = 2;                                    // 2 where the grid is one layer thick along z, else 3
  std::array<std::vector<double>, max_dimension> axis;  // coordinates, ascending
  std::vector<double> values;                           // first axis fastest
  std::optional<double> time;                           // the file's TimeValue
};
/// Throws GridFileError as read_grid() does.
GridSnapshot read_snapshot(const std::filesystem::path& file, const std::string& array);

/// Of the library that runs: "9.1.0".
std::string vtk_version();

}  // namespace gaussdrift::read
