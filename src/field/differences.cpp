#include "field/differences.hpp"

#include <algorithm>

namespace gaussdrift {

namespace {

Columns velocity_at(const VelocityField& field, double t, const Columns& x, int dimension) {
  const std::size_t count = x[0].size();
  Columns u;
  PointsView points{dimension, count, {}};
  VectorsView view{dimension, count, {}};
  for (int k = 0; k < dimension; ++k) {
    u[k].assign(count, 0.0);
    points.axis[k] = x[k].data();
    view.axis[k] = u[k].data();
  }
  field.add(t, points, view);
  return u;
}

}  // namespace

std::array<Columns, max_dimension> gradient_by_differences(const VelocityField& field, double t, Columns x,
                                                           int dimension, double distance) {
  std::array<Columns, max_dimension> gradient;
  for (int i = 0; i < dimension; ++i) {
    const std::vector<double> kept = x[i];
    for (double& value : x[i]) value += distance;
    const Columns right = velocity_at(field, t, x, dimension);
    for (std::size_t j = 0; j < kept.size(); ++j) x[i][j] = kept[j] - distance;
    const Columns left = velocity_at(field, t, x, dimension);
    x[i] = kept;
    for (int k = 0; k < dimension; ++k) {
      gradient[k][i].resize(kept.size());
      for (std::size_t j = 0; j < kept.size(); ++j) gradient[k][i][j] = (right[k][j] - left[k][j]) / (2 * distance);
    }
  }
  return gradient;
}

Columns sample_of(const PointsView& points, std::size_t most) {
  const std::size_t count = std::min(most, points.count);
  Columns x;
  for (std::size_t i = 0; i < count; ++i)
    for (int k = 0; k < points.dimension; ++k) x[k].push_back(points.axis[k][i * points.count / count]);
  return x;
}

}  // namespace gaussdrift
