// Sums of farfield over all particles, as the effects charge and vortex need them: a plan for each set of positions.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/state_bytes.hpp"
#include "farfield/farfield.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

class PairVelocity {
 public:
  /// threads: 0 for all. tolerance: as the promise of farfield has it.
  PairVelocity(double tolerance, int threads) : tolerance_(tolerance), threads_(threads) {}

  /// Velocity of vortex blobs of core radius `core` and circulations `weights`: 2 x particles.
  farfield::Points<2> vortices(const PointsView& x, const std::vector<double>& weights, double core) const;
  /// Field of point charges: 3 x particles.
  farfield::Points<3> charges(const PointsView& x, const std::vector<double>& weights) const;

  /// Measured: what a plan and its evaluation hold a particle.
  static double bytes_of_particle(int dimension) { return dimension == 3 ? 300 : 200; }

  /// See Effect::pass_state().
  void pass_state(base::StateBytes& bytes) { bytes(evaluations_); }

  std::size_t evaluations() const { return evaluations_; }
  const farfield::Choice& last_choice() const { return choice_; }

 private:
  double tolerance_;
  int threads_;
  // The plan of the last evaluation. It is kept because plans share their tables as long as one of them lives.
  mutable std::unique_ptr<farfield::Plan<2>> plane_;
  mutable std::unique_ptr<farfield::Plan<3>> space_;
  mutable farfield::Choice choice_{};
  mutable std::size_t evaluations_ = 0;
};

}  // namespace gaussdrift
