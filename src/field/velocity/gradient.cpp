#include "field/velocity/gradient.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gaussdrift {

namespace {

using Columns = std::array<std::vector<double>, max_dimension>;

double halton(std::size_t index, std::size_t base) {
  double value = 0, digit = 1;
  for (; index > 0; index /= base) {
    digit /= static_cast<double>(base);
    value += digit * static_cast<double>(index % base);
  }
  return value;
}

Columns velocity_at(const VelocityField& field, int dimension, double t, const Columns& x) {
  const std::size_t count = x[0].size();
  Columns u;
  PointsView points{dimension, count, {}};
  VectorsView values{dimension, count, {}};
  for (int k = 0; k < dimension; ++k) {
    u[k].assign(count, 0.0);
    points.axis[k] = x[k].data();
    values.axis[k] = u[k].data();
  }
  field.add(t, points, values);
  return u;
}

}  // namespace

GradientSample sample_gradient(const VelocityField& field, int dimension, const Vector& min, const Vector& max,
                               double begin, double end, std::size_t points, int times) {
  constexpr std::array<std::size_t, max_dimension> bases{2, 3, 5};
  GradientSample result;
  Columns x;
  for (int k = 0; k < dimension; ++k)
    for (std::size_t i = 0; i < points; ++i) x[k].push_back(min[k] + (max[k] - min[k]) * halton(i + 1, bases[k]));
  if (field.is_steady() || begin == end) times = 1;
  for (int n = 0; n < times; ++n) {
    const double t = times == 1 ? begin : begin + (end - begin) * n / (times - 1);
    const Columns u = velocity_at(field, dimension, t, x);
    std::vector<double> square(points, 0.0);
    for (int axis = 0; axis < dimension; ++axis) {
      const double reach = 1e-6 * (max[axis] - min[axis]);
      Columns above = x, below = x;
      for (std::size_t i = 0; i < points; ++i) above[axis][i] += reach, below[axis][i] -= reach;
      const Columns up = velocity_at(field, dimension, t, above), down = velocity_at(field, dimension, t, below);
      for (int k = 0; k < dimension; ++k)
        for (std::size_t i = 0; i < points; ++i) {
          const double slope = (up[k][i] - down[k][i]) / (above[axis][i] - below[axis][i]);
          square[i] += slope * slope;
        }
    }
    for (std::size_t i = 0; i < points; ++i) {
      double speed = 0;
      for (int k = 0; k < dimension; ++k) speed = std::hypot(speed, u[k][i]);
      const double gradient = std::sqrt(square[i]);
      if (!std::isfinite(speed) || !std::isfinite(gradient)) {
        result.finite = false;
        continue;
      }
      result.speed = std::max(result.speed, speed);
      if (gradient <= result.largest) continue;
      result.largest = gradient;
      result.time = t;
      for (int k = 0; k < dimension; ++k) result.place[k] = x[k][i];
    }
  }
  return result;
}

}  // namespace gaussdrift
