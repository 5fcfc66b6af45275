// The times of NetCDF files as those of a scene, and what that means for velocities.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "read/netcdf/netcdf_layout.hpp"

namespace gaussdrift::read {

class NetcdfTimes {
 public:
  /// `series`: its name, for messages.
  NetcdfTimes(const GridRequest& request, std::string series) : request_(request), series_(std::move(series)) {}

  /// The times of the next file, by its number. Throws GridFileError if they do not go with those before.
  void add(std::size_t file, const std::string& name, const NetcdfLayout& layout);
  /// All of them in the time of the scene, in order, each once. Throws GridFileError.
  std::vector<Stamp> settled(std::vector<DataWarning>& warnings);
  /// "t = 0 at 2020-01-03 00:00, in hours"; empty for one time. After settled().
  std::string describe() const;
  /// What dates the times of the scene are. After settled().
  std::optional<GridDates> dates() const;
  /// By what velocities are multiplied to be lengths per time of the scene. Warns of units that do not fit.
  double velocity_factor(const NetcdfLayout& layout, std::vector<DataWarning>& warnings) const;

 private:
  double scene_time(double number) const;
  void choose_start(const std::vector<Stamp>& stamps);

  const GridRequest& request_;
  std::string series_, units_;
  Calendar calendar_ = Calendar::standard;
  std::optional<TimeUnits> clock_;  // of the first file; all numbers are in its units
  std::vector<Stamp> stamps_;
  double start_ = 0;
  double scene_seconds_ = 0;  // of the unit of the scene; 0: not known
};

}  // namespace gaussdrift::read
