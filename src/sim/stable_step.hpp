// The longest step with which transport is stable, estimated from the gradient of the velocity. method.md, section 4.
#pragma once

#include <string>

#include "field/velocity.hpp"
#include "particle/particles.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

struct StableStep {
  double step = 0;     // the longest; the step asked for if that is stable
  std::string reason;  // place, time and rate that limit it; empty if nothing does
};

/// A motion that only turns or decays may grow by this much over a run; more is called unstable. Methods that are
/// stable beyond their limit of no motion at all (euler and heun on a rotation) are thus judged by what they do in this
/// run.
constexpr double growth_allowed = 0.1;

/// Looks at the eigenvalues of grad u (central differences over `distance`) at up to 500 particles, at the start, the
/// middle and the end of the time `length`; particles stand where they start. Where grad u is not finite nothing is
/// concluded.
StableStep estimate_stable_step(const VelocityField& velocity, const Particles& particles, const time::Tableau& tableau,
                                double length, double step, double distance);

}  // namespace gaussdrift
