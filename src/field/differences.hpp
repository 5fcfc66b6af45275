// Gradients of a velocity field at given points, from its values.
#pragma once

#include <array>
#include <vector>

#include "field/velocity.hpp"

namespace gaussdrift {

/// One array per axis, all of the same length.
using Columns = std::array<std::vector<double>, max_dimension>;

/// gradient[k][i][j] = d u_k / d x_i at the point j of x, by central differences over `distance`. Values that are not
/// finite are passed on.
std::array<Columns, max_dimension> gradient_by_differences(const VelocityField& field, double t, Columns x,
                                                           int dimension, double distance);

/// At most `most` of the points, evenly spread over their order.
Columns sample_of(const PointsView& points, std::size_t most);

}  // namespace gaussdrift
