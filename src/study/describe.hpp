// What a case will do, found without running it: fields sampled, particles counted, cost predicted from short trials.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "sim/density.hpp"
#include "study/budget.hpp"

namespace gaussdrift::study {

struct Description {
  std::string velocity;                      // formula
  std::string initial_density;               // formula, smoothness, mass where it is known
  std::vector<std::string> effects;          // beside transport, their equations
  std::string reference;                     // why there is none, or what is not exact about it; empty: nothing
  std::vector<std::string> step_warnings;    // what is not exact about the steps
  std::vector<std::string> effect_warnings;  // what is not exact about them here
  double largest_speed = 0;                  // of |u| at the particles, over sampled times
  bool solenoidal = false;                   // div u = 0 by construction
  double largest_divergence = 0;             // of |div u| there
  double divergence_noise = 0;               // its rounding: terms of |u| over the shortest length resolved
  std::size_t lattice_points = 0, particles = 0, grid_points = 0, steps = 0, frames = 0;
  double spacing = 0, core_radius = 0;
  SeedReport seeding;          // what has no particle
  double beyond_at_start = 0;  // part of the mass of rho_0 that lies outside the domain
  DensityReport density;       // of a trial evaluation at t = 0
  double density_maximum = 0;  // rho_eps^h on the grid at t = 0
  // Predictions
  double step_seconds = 0, evaluate_seconds = 0, reference_seconds = 0, picture_seconds = 0, seconds = 0;
  double memory_bytes = 0, disk_bytes = 0;
  int threads = 1;
  Budget budget;  // predicted
};

/// Throws what a run would throw before its first step: NumericalError for a density or velocity that is not finite at
/// the sampled places, InputError where nothing carries weight.
Description describe(const Case& scene, int threads);

/// The lines that `gaussdrift check` prints.
std::string to_text(const Case& scene, const Description& description);
/// The same as JSON.
std::string to_json(const Case& scene, const Description& description);

}  // namespace gaussdrift::study
