// Gradients of a velocity field at given points, from its values. Places where it jumps have none and are listed.
#pragma once

#include <array>
#include <vector>

#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// One array per axis, all of the same length.
using Columns = std::array<std::vector<double>, max_dimension>;

/// A place where a field changes by `height` at once.
struct Jump {
  Vector place{};
  double time = 0;
  double height = 0;  // Euclidean norm of the change of u
};

/// gradient[k][i][j] = d u_k / d x_i at the point j of x, by differences over `distance` to either side. A jump is not
/// a slope. Where a third of the change within +-distance happens on a sixteenth of that length, the slope is taken
/// beside it, and `jumps`, if given, gets the place. Values that are not finite are passed on.
std::array<Columns, max_dimension> gradient_by_differences(const VelocityField& field, double t, Columns x,
                                                           int dimension, double distance,
                                                           std::vector<Jump>* jumps = nullptr);

/// At most `most` of the points, evenly spread over their order.
Columns sample_of(const PointsView& points, std::size_t most);

}  // namespace gaussdrift
