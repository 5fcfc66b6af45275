#include "effect/lattice_ends.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace gaussdrift {

LatticeEnds::LatticeEnds(const Domain& domain, const Lattice& seeding) {
  for (int k = 0; k < domain.dimension; ++k) {
    const auto a = static_cast<std::size_t>(k);
    const auto [lower, upper] = domain.edges[a];
    Axis& axis = axes_[a];
    axis.points = static_cast<std::int64_t>(seeding.points[a]);
    axis.low = domain.min[a], axis.high = domain.max[a];
    axis.periodic = lower == Edge::periodic;
    axis.closed_low = lower == Edge::closed, axis.closed_high = upper == Edge::closed;
    axis.mirror_low = axis.closed_low || lower == Edge::open;
    axis.mirror_high = axis.closed_high || upper == Edge::open;
    // A closed end lies in the middle between two nodes. An open one is moved to the last node before it, or to the middle
    // behind that node, whichever is nearer.
    const auto twice = [&](double place) { return std::llround(2 * (place - seeding.origin[a]) / seeding.spacing); };
    axis.low_sum = std::clamp(twice(axis.low), -1LL, 0LL);
    axis.high_sum = std::clamp(twice(axis.high), 2LL * axis.points - 2, 2LL * axis.points - 1);
  }
}

std::int64_t LatticeEnds::fold(int k, std::int64_t index) const {
  const Axis& axis = axes_[static_cast<std::size_t>(k)];
  if (axis.periodic) return ((index % axis.points) + axis.points) % axis.points;
  if (axis.points == 1 && axis.mirror_low && axis.mirror_high) return 0;
  for (;;) {
    if (axis.mirror_low && index < 0)
      index = axis.low_sum - index;
    else if (axis.mirror_high && index >= axis.points)
      index = axis.high_sum - index;
    else
      return index;
  }
}

std::int64_t LatticeEnds::next(int k, std::int64_t index, int by) const {
  return axes_[static_cast<std::size_t>(k)].periodic ? fold(k, index + by) : index + by;
}

double LatticeEnds::distance(int k, double a, double b) const {
  const Axis& axis = axes_[static_cast<std::size_t>(k)];
  return axis.periodic ? std::remainder(a - b, axis.high - axis.low) : a - b;
}

double LatticeEnds::distance_to_image(int k, std::int64_t index, double x) const {
  const Axis& axis = axes_[static_cast<std::size_t>(k)];
  if (axis.closed_low && index == 0) return 2 * (x - axis.low);
  if (axis.closed_high && index == axis.points - 1) return 2 * (axis.high - x);
  return 0;
}

// Runs of nodes that follow each other.
std::vector<AxisWeights> LatticeEnds::parts(int k, const AxisWeights& weights) const {
  std::map<std::int64_t, double> folded;
  for (std::size_t i = 0; i < weights.weights.size(); ++i)
    folded[fold(k, weights.first + static_cast<std::int64_t>(i))] += weights.weights[i];
  std::vector<AxisWeights> runs;
  for (const auto& [index, weight] : folded) {
    if (runs.empty() || index != runs.back().first + static_cast<std::int64_t>(runs.back().weights.size()))
      runs.push_back({index, {}});
    runs.back().weights.push_back(weight);
  }
  return runs;
}

}  // namespace gaussdrift
