// Data on a grid of longitudes and latitudes, for a domain on a sphere.
#pragma once

#include <memory>

#include "field/gridded/grid_data.hpp"

namespace gaussdrift {

/// The same data with longitudes around `middle`, whatever turn of the circle the file counts in. Data that go all the way
/// round go on beyond both ends of it, so that between the last and the first longitude there is no gap. Data on a
/// curvilinear grid stay as they are. Throws std::invalid_argument where the axes are no longitudes and latitudes.
std::shared_ptr<const GridData> around_sphere(const std::shared_ptr<const GridData>& data, double middle);

}  // namespace gaussdrift
