// Data as if they had been measured at half as many points: what interpolation misses shows in the difference.
#pragma once

#include <memory>

#include "field/gridded/grid_data.hpp"

namespace gaussdrift {

/// Every second point along each axis, and the last one. Axes of two points stay.
std::shared_ptr<const GridData> every_second_point(const GridData& data);
/// Every second time, and the last one.
std::shared_ptr<const GridData> every_second_time(const GridData& data);

}  // namespace gaussdrift
