// What is beyond the ends of the lattice of the particles: nodes that are other names of nodes within, where the domain
// has edges. docs/method.md, section 12.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "effect/node_sums.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

class LatticeEnds {
 public:
  /// No edges: the lattice goes on without end.
  LatticeEnds() = default;
  /// `seeding` is the lattice of these edges, seeding_lattice(). Beyond an open end nothing is put: what would come there
  /// comes to mirror images of these nodes within, so that only the flow takes anything out.
  LatticeEnds(const Domain& domain, const Lattice& seeding);

  /// True if any end does something.
  bool any() const { return axes_[0].any() || axes_[1].any() || axes_[2].any(); }

  /// The node that is meant along an axis. The same where no end does anything.
  std::int64_t fold(int axis, std::int64_t index) const;

  /// The node after this one, which on a periodic axis is the first after the last.
  std::int64_t next(int axis, std::int64_t index, int by = 1) const;

  /// The distance between two places along an axis, by the nearest image of a periodic one.
  double distance(int axis, double a, double b) const;

  /// Twice the distance of a particle from the closed end beside its node: that of its mirror image. 0: no such end.
  double distance_to_image(int axis, std::int64_t index, double x) const;

  /// Calls use(weights) for parts of what a particle gives, so that all of them lie on the lattice and add up to the whole.
  template <class Use>
  void for_each_part(const NodeWeights& weights, int dimension, const Use& use) const;

 private:
  struct Axis {
    std::int64_t points = 0;
    bool periodic = false;
    bool mirror_low = false, mirror_high = false;
    std::int64_t low_sum = 0, high_sum = 0;  // i and low_sum - i are images of each other
    bool closed_low = false, closed_high = false;
    double low = 0, high = 0;  // of the domain

    bool any() const { return periodic || mirror_low || mirror_high; }
  };

  std::vector<AxisWeights> parts(int axis, const AxisWeights& weights) const;

  std::array<Axis, max_dimension> axes_{};
};

template <class Use>
void LatticeEnds::for_each_part(const NodeWeights& weights, int dimension, const Use& use) const {
  const auto within = [&](int k) {
    const Axis& axis = axes_[static_cast<std::size_t>(k)];
    const AxisWeights& along = weights[static_cast<std::size_t>(k)];
    return !axis.any() ||
           (along.first >= 0 && along.first + static_cast<std::int64_t>(along.weights.size()) <= axis.points);
  };
  bool all_within = true;
  for (int k = 0; k < dimension; ++k) all_within = all_within && within(k);
  if (all_within) return use(weights);
  std::array<std::vector<AxisWeights>, max_dimension> along;
  for (int k = 0; k < max_dimension; ++k) {
    const auto a = static_cast<std::size_t>(k);
    along[a] = k < dimension && !within(k) ? parts(k, weights[a]) : std::vector<AxisWeights>{weights[a]};
  }
  NodeWeights part;
  for (const AxisWeights& z : along[2]) {
    part[2] = z;
    for (const AxisWeights& y : along[1]) {
      part[1] = y;
      for (const AxisWeights& x : along[0]) {
        part[0] = x;
        use(part);
      }
    }
  }
}

}  // namespace gaussdrift
