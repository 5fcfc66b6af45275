// Carries particles along their paths with nearly full precision. The error of a run's steps is measured against them.
#pragma once

#include <cstddef>

#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

struct ExactPathsOptions {
  double tolerance = 1e-12;  // of a step, relative to `length`; of the exponent of the weights
  double length = 1;         // of the domain
  std::size_t most_steps = 100'000;
  int threads = 0;
};

struct ExactPaths {
  std::size_t lost = 0;   // particles whose path could not be followed; their position is NaN then
  std::size_t rates = 0;  // evaluations of the velocity for one particle, summed over all
};

/// Carries positions from time `from` to `to` by the method of order 8, which chooses its steps by their error.
/// Multiplies weights by exp(-int u0 ds) if there is a rate u0.
ExactPaths carry_exactly(const VelocityField& velocity, const ScalarField* rate, Particles& particles, double from,
                         double to, const ExactPathsOptions& options);

}  // namespace gaussdrift
