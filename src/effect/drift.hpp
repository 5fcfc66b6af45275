// A velocity that all particles give each other. The stepper adds it to the flow at every stage, for all particles at
// once.
#pragma once

#include "gaussdrift/particles.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

class Drift {
 public:
  virtual ~Drift() = default;
  /// u[k][j] += the velocity of particle j if all stand at x at time t; weights and charges are those of `particles`.
  /// Called from one thread at a time, with all particles. Ranks that share the particles call it together, each with its
  /// own, and agree on errors. Throws NumericalError where a velocity exceeds all numbers.
  virtual void add(double t, const Particles& particles, const PointsView& x, const VectorsView& u) const = 0;
};

}  // namespace gaussdrift
