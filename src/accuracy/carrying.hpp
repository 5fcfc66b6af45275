// Carries particles to the last output, exactly or by steps of the case, and tells beforehand what work that takes.
#pragma once

#include "gaussdrift/case.hpp"
#include "reference/exact_paths.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

/// How particles are carried to the last output when causes are told apart.
struct Carrying {
  bool exactly = true;        // else by steps of the case, `factor` times as long
  ExactPathsOptions paths{};  // exactly
  double factor = 1;
};

/// By steps of the case, `factor` times as long.
void carry_by_steps(const Case& spec, const Scene& scene, Particles& particles, double factor, int threads);

/// False if a path could not be followed.
bool carry(const Case& spec, const Scene& scene, const Carrying& how, Particles& particles);

/// The error of the steps is what halving them changes, times this. Past a kink a method has order 2 at most.
double of_halved_steps(const Case& spec, const Scene& scene);

/// Evaluations of the velocity of one particle in all steps.
double rates_of_steps(const Case& spec, const Scene& scene);

/// The work of carrying one particle, along its exact path found with a few particles. An eighth of `allowed` may be
/// spent on that; infinite if it is not enough.
double work_of_a_path(const Case& spec, const Scene& scene, const Particles& particles, const Carrying& how,
                      double allowed);

}  // namespace gaussdrift::accuracy
