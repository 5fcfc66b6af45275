// A density in space as the pictures use it: cut by planes, projected onto them, or thinned.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "gaussdrift/frame.hpp"
#include "render/height_field.hpp"

namespace gaussdrift::render {

/// Throws Error(ExitCode::internal) unless the density has three dimensions and a value at every point.
void check_solid(const DensityGrid& density);

/// Lattice point of the value largest in size, and of a plateau its middle. The middle of the lattice where all are 0 or
/// not finite.
std::array<std::size_t, 3> largest_point(const DensityGrid& density);

/// Values where the index along the third axis is `index`; `across` and `up` are two different axes.
Plane slice(const DensityGrid& density, int across, int up, std::size_t index);

/// At each point of the plane: the value largest in size on the line along the third axis. NaN only if all are NaN.
Plane projection(const DensityGrid& density, int across, int up);

/// The lattice of thinned().
Lattice thinned_lattice(const Lattice& full, std::size_t most);

/// Every second, third, ... point of each axis and the last one nearest to its end, so that no axis has more than
/// `most`.
DensityGrid thinned(const DensityGrid& density, std::size_t most);

}  // namespace gaussdrift::render
