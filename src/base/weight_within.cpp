#include "base/weight_within.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/longest_side.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

double largest_weight_within(const PointsView& points, const double* weight, double reach) {
  // Boxes of half the reach: a ball of that radius around any point of a box lies within two boxes on each side.
  const std::size_t count = points.count;
  if (count == 0) return 0;
  const int dimension = points.dimension;
  Vector low{}, high{};
  for (int k = 0; k < dimension; ++k) {
    const auto [a, b] = std::minmax_element(points.axis[k], points.axis[k] + count);
    low[k] = *a, high[k] = *b;
    if (!std::isfinite(high[k] - low[k]))
      throw NumericalError("some points lie so far apart that no number can hold their distance. Shorten time.end.");
  }
  // The box array may have a few entries a point; a very short reach gets longer boxes, which only raises the bound.
  const double allowed = 4.0 * static_cast<double>(count) + 1e6;
  const double longest = longest_side(dimension, low, high);
  double side = std::max(reach / 2, longest / allowed);
  if (!(side > 0)) side = 1;  // all on one place
  std::array<std::size_t, max_dimension> boxes{1, 1, 1};
  for (;; side *= 1.5) {
    double total = 1;
    for (int k = 0; k < dimension; ++k) total *= std::floor((high[k] - low[k]) / side) + 1;
    if (total <= allowed) break;
  }
  for (int k = 0; k < dimension; ++k) boxes[k] = static_cast<std::size_t>((high[k] - low[k]) / side) + 1;

  std::vector<double> box_weight(boxes[0] * boxes[1] * boxes[2], 0.0);
  for (std::size_t j = 0; j < count; ++j) {
    std::size_t index = 0;
    for (int k = dimension - 1; k >= 0; --k)
      index = index * boxes[k] + std::min(boxes[k] - 1, static_cast<std::size_t>((points.axis[k][j] - low[k]) / side));
    box_weight[index] += std::abs(weight[j]);
  }
  // Sums over 5 boxes, one axis after the other.
  std::size_t stride = 1;
  std::vector<double> line;
  for (int k = 0; k < dimension; ++k) {
    line.resize(boxes[k]);
    for (std::size_t start = 0; start < box_weight.size(); ++start) {
      if ((start / stride) % boxes[k] != 0) continue;
      for (std::size_t i = 0; i < boxes[k]; ++i) line[i] = box_weight[start + i * stride];
      for (std::size_t i = 0; i < boxes[k]; ++i) {
        double sum = 0;
        for (std::size_t n = i < 2 ? 0 : i - 2; n <= std::min(i + 2, boxes[k] - 1); ++n) sum += line[n];
        box_weight[start + i * stride] = sum;
      }
    }
    stride *= boxes[k];
  }
  return *std::max_element(box_weight.begin(), box_weight.end());
}

}  // namespace gaussdrift
