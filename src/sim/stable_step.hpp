// The longest step with which transport is stable, estimated from the gradient of the velocity. method.md, section 4.
#pragma once

#include <complex>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "field/velocity/differences.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/particles.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

/// An eigenvalue of grad u.
struct FlowRate {
  std::complex<double> value;
  Vector place{};
  double time = 0;

  bool turns() const { return std::abs(value.imag()) > std::abs(value.real()); }
};

/// What a flow does to small differences between particles.
struct FlowRates {
  std::vector<FlowRate> rates;
  std::vector<Jump> jumps;  // met on the way; a jump is not a rate
};

struct StableStep {
  double step = 0;                     // the longest; the step asked for if that is stable
  std::optional<FlowRate> limited_by;  // nothing if that is stable
};

/// A motion that only turns or decays may grow by this part over a run. If it grows by more the step is unstable.
/// euler and heun amplify a rotation with every step, however short, so they are judged by what they do in this
/// run.
constexpr double growth_allowed = 0.1;

/// The eigenvalues of grad u (central differences over `distance`) at up to sampled_particles particles, at the start, the middle
/// and the end of the time `length`; particles stand where they start. Where grad u is not finite there are none.
FlowRates sample_flow_rates(const VelocityField& velocity, const Particles& particles, double length, double distance);

/// The longest step <= `step` with which nothing of that grows by more than growth_allowed over the time `length`.
StableStep longest_stable_step(const FlowRates& flow, const time::Tableau& tableau, double length, double step);

/// Samples the rates, then finds the longest step.
StableStep estimate_stable_step(const VelocityField& velocity, const Particles& particles, const time::Tableau& tableau,
                                double length, double step, double distance);

}  // namespace gaussdrift
