// Reaction, d_t rho + div(rho u) + u0 rho = 0: along the path of a particle alpha' = -u0(X, t) alpha, so that
// alpha(t) = alpha(0) exp(-integral of u0). The integral is a quadrature over the stages of the path and the
// exponential is taken of the sum: a weight keeps its sign and cannot overshoot, however large u0. docs/method.md,
// section 8.1.
#pragma once

#include "effect/effect.hpp"
#include "field/scalar.hpp"

namespace gaussdrift {

class Reaction : public Effect, private PathIntegral {
 public:
  /// The rate u0 must outlive the effect.
  explicit Reaction(const ScalarField& rate) : rate_(rate) {}

  std::string name() const override { return "reaction"; }
  std::string describe() const override { return "reaction alpha' = -(" + rate_.describe() + ") alpha"; }
  Changes changes() const override { return {.weight = true}; }
  std::string conserves() const override { return "the sign of every weight"; }

  const PathIntegral* path_integral() const override { return this; }
  /// Throws NumericalError where a weight is too large for a number.
  void settle(Particles& particles, const double* integral, double time) override;

 private:
  void add_rate(double t, const PointsView& x, double* rate) const override { rate_.add(t, x, rate); }
  std::string quantity() const override { return "the rate of [effects.reaction]"; }

  const ScalarField& rate_;
};

}  // namespace gaussdrift
