// What the variables of a NetCDF file mean, by the CF conventions: which are the arrays, along which axes they lie, what
// times they have, which numbers mark missing data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "read/calendar.hpp"
#include "read/grid_file.hpp"
#include "read/netcdf/netcdf_file.hpp"

namespace gaussdrift::read {

/// The axis of a grid, turned so that it ascends.
struct NetcdfAxis {
  std::string name, units;
  std::vector<double> points;
  bool descends = false;  // in the file
  double rounding = 0;    // by how much points may be wrong
  std::size_t along = 0;  // which dimension of the arrays
};

/// A variable that says where there is land.
struct NetcdfMask {
  std::string name;
  std::vector<std::optional<std::size_t>>
      along;                // of each of its dimensions: that of the arrays; nothing: it has length 1
  bool marks_land = false;  // by numbers other than 0

  bool operator==(const NetcdfMask&) const = default;
};

struct NetcdfLayout {
  std::vector<std::string> arrays, units;  // one a component
  std::vector<double> signs;               // -1: a component counts downwards
  std::vector<NetcdfAxis> axes;            // x, y, perhaps z
  std::vector<std::size_t> lengths;        // of the dimensions of the arrays
  std::vector<std::size_t> start;          // the layer that is read, along other dimensions
  std::optional<std::size_t> time;         // which dimension of the arrays
  std::vector<double> times;               // as they stand in the file; at least one
  Calendar calendar = Calendar::standard;
  std::string time_units;          // as they stand in the file
  std::optional<TimeUnits> clock;  // the same, understood
  std::optional<NetcdfMask> mask;

  std::size_t points() const;
};

/// Throws GridFileError: no such arrays, arrays on different grids, axes that are not known or have no order, more
/// dimensions than are asked for.
NetcdfLayout netcdf_layout(const NetcdfFile& file, const GridRequest& request);

/// The numbers of a time.
struct NetcdfValues {
  std::vector<double> values;        // [point][component], unpacked; NaN at hidden points
  std::vector<std::uint8_t> hidden;  // points that the file marks; empty: none
};
/// The mask that is asked for, whose dimensions are among those of the arrays. Throws GridFileError: there is none, or it
/// does not lie along x and y.
NetcdfMask netcdf_mask(const NetcdfFile& file, const NetcdfLayout& layout, const GridRequest& request);
/// 1 for each point that is land. Throws GridFileError.
std::vector<std::uint8_t> read_netcdf_mask(const NetcdfFile& file, const NetcdfLayout& layout, std::size_t time);

/// `keep`: all numbers are meant, and none is hidden. Throws GridFileError.
NetcdfValues read_netcdf_values(const NetcdfFile& file, const NetcdfLayout& layout, std::size_t time, bool keep);

}  // namespace gaussdrift::read
