// Data on grids from files of ParaView, .vti (image data), .vtr (rectilinear grid),
// .vts (curvilinear grid), .pvd (a series of them), and of NetCDF.
// stored_grid.hpp and netcdf/ read the files; here their contents become numbers on ascending axes.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "field/gridded/grid_data.hpp"
#include "read/grid_file_error.hpp"
#include "read/land_mask.hpp"
#include "read/missing_data.hpp"
#include "read/time_series.hpp"

namespace gaussdrift::read {

/// Where a picture or a table of numbers lies.
struct Frame {
  std::array<double, max_dimension> min{}, max{};
};

/// How the times of data become those of a scene.
struct SceneClock {
  std::string start{};                   // a date at which the scene begins
  std::optional<double> start_number{};  // or a time of the data
  std::string unit{};                    // of the time of the scene, "h"; velocities follow it
  std::optional<double> unit_number{};   // or how much of the data's time it is; velocities stay as they are
};

/// More than that is not held: of longer series the times that are needed are read on the way.
constexpr double most_bytes_held = 268435456;

/// What is wanted of a file.
struct GridRequest {
  std::vector<std::string> arrays{};  // one array, or one for each component; none: the only array of the file
  int dimension = 2;
  std::size_t least_components = 1, most_components = 1;
  Missing missing = Missing::error;       // what stands where the file has no value
  std::optional<double> missing_value{};  // marks missing data, besides the marks that are recognised
  std::string mask{};                     // an array that says where there is land; empty: none
  MaskIs mask_is = MaskIs::as_the_file_says;
  bool decays = false;           // the data span many powers of ten by nature, as densities do
  std::optional<Frame> frame{};  // of .png and .csv, which are read only where there is one
  std::optional<SceneClock> clock{};
  std::optional<double> level{};  // of a further dimension: the layer that is read
  bool on_sphere = false;         // coordinates are degrees, and velocities are lengths per time all the same
  Gaps gaps = Gaps::warn;
  Duplicates duplicates = Duplicates::error;
  std::size_t times_at_once = 2;  // that a value depends on
  double most_held = most_bytes_held;
};

/// Reads .vti, .vtr, .vts, .pvd, or NetCDF (.nc), of which the name may be a pattern: wind_*.nc.
/// A grid one layer thick along z is 2D. Axes that descend are turned round. Data of cells stand at the middles of the
/// cells, and in the outer half of the outermost cells their value holds. At most 2 GiB of numbers are read.
/// Throws GridFileError: no such file or array, not VTK's XML, wrong number of components or dimensions, numbers that
/// are not numbers, pieces that leave gaps, missing data that are not asked for, grids of a series that differ.
std::shared_ptr<const GridData> read_grid(const std::filesystem::path& file, const GridRequest& request);

/// One file of a series, the times ascending.
struct SeriesEntry {
  std::filesystem::path file;
  double time = 0;
  std::size_t line = 0;  // of the series that names it
};
/// The files that a .pvd lists, relative to its folder. Throws GridFileError: two for one time, if there must be one.
std::vector<SeriesEntry> read_series(const std::filesystem::path& file, bool each_time_once = true);

/// By its ending.
bool is_netcdf(const std::filesystem::path& file);
/// The files that a name with * and ? stands for, in the order of the alphabet; the file itself if it has none or exists.
std::vector<std::filesystem::path> files_of_pattern(const std::filesystem::path& file);

/// An array of one .vti or .vtr, as it is: values may be NaN.
struct GridSnapshot {
  int dimension = 2;                                    // 2 where the grid is one layer thick along z, else 3
  std::array<std::vector<double>, max_dimension> axis;  // coordinates, ascending; one on an axis is possible
  std::size_t components = 1;                           // of the array, 1 to 3
  std::vector<double> values;                           // one number a point, first axis fastest
  std::optional<double> time;                           // the file's TimeValue
  double sphere = 0;                                    // radius, where the axes are longitudes and latitudes
};
/// Its values, or a component of them; of a vector without that its length. Throws GridFileError as read_grid() does.
GridSnapshot read_snapshot(const std::filesystem::path& file, const std::string& array,
                           std::optional<std::size_t> component = {});

/// What can be done with a file that has this ending ("nc", ".png"); empty where nothing is known.
std::string way_to_read(const std::filesystem::path& file);

}  // namespace gaussdrift::read
