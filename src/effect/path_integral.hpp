// A quantity that accumulates along the path of a particle, I_j' = f(X_j(t), t): exponents of weights and of volumes.
// The stepper integrates it with the stages of the path, so it has the path's order and costs one evaluation of f a
// stage.
#pragma once

#include <string>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

class PathIntegral {
 public:
  virtual ~PathIntegral() = default;
  /// rate[i] += f(x_i, t). Called for blocks of particles, from several threads.
  virtual void add_rate(double t, const PointsView& x, double* rate) const = 0;
  /// "the rate of [effects.reaction]": names f in messages.
  virtual std::string quantity() const = 0;
};

}  // namespace gaussdrift
