// Data on a grid from NetCDF files: one, or several that share their grid, in the order of time.
#pragma once

#include <filesystem>
#include <memory>

#include "read/grid_file.hpp"

namespace gaussdrift::read {

/// As read_grid() does. Series that are longer than what is held are read on the way, time by time.
std::shared_ptr<const GridData> read_netcdf_grid(const std::filesystem::path& file, const GridRequest& request);

}  // namespace gaussdrift::read
