// Describes what a case will do without running it: fields are sampled, particles counted, and costs predicted from
// short trials.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "accuracy/budget.hpp"
#include "accuracy/footprint.hpp"
#include "accuracy/memory_limits.hpp"
#include "gaussdrift/case.hpp"
#include "sim/transform.hpp"
#include "sim/work.hpp"

namespace gaussdrift::accuracy {

struct Forecast {
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
  bool whole = true;                         // all particles were looked at; else `particles` is an estimate
  std::size_t looked_at = 0;                 // lattice points at which the density was asked for
  double work_of_errors = 0;                 // taken by their prediction (sim/work.hpp)
  double paths_traced = 0;            // for the seconds of the reference: evaluations of the velocity at one point
  std::vector<std::string> left_out;  // what was done with a sample, or not at all
  std::size_t lattice_points = 0, particles = 0, grid_points = 0, steps = 0, frames = 0;
  double spacing = 0, core_radius = 0;
  SeedReport seeding;                               // what has no particle
  double beyond_at_start = 0;                       // part of the mass of rho_0 that lies outside the domain
  DensityReport density;                            // of a trial evaluation at t = 0
  double density_minimum = 0, density_maximum = 0;  // rho_eps^h on the grid at t = 0
  // Predictions
  double seed_seconds = 0, step_seconds = 0, evaluate_seconds = 0;  // the latter two of one
  double reference_seconds = 0, picture_seconds = 0, file_seconds = 0, report_seconds = 0, seconds = 0;
  double animation_seconds = 0;  // densities of its frames, and the films
  double error_at_start = -1;    // largest, of rho_eps^h on the grid; negative: not known
  double particles_at_end = 0;   // with those that diffusion and remeshing add, on the mean of the run
  double particles_at_most = 0;
  double released = 0;             // particles, by sources
  std::size_t tried_in_steps = 0;  // particles whose steps were timed
  RunMemory memory;                // beside the program
  double program_bytes = 0;        // that the program itself takes
  double disk_bytes = 0;
  MemoryLimit memory_limit;
  int threads = 1;
  Budget budget;  // predicted

  double memory_bytes() const { return memory.all() + program_bytes; }
};

/// Throws what a run would throw before its first step: NumericalError for a density or velocity that is not finite at
/// the sampled places, InputError where nothing carries weight. Takes about two seconds and 100 MB at most, whatever
/// the case: what is larger is sampled or left out. `doing` is told what comes next. most_memory: --memory, in bytes.
Forecast forecast(const Case& spec, int threads, const std::function<void(const std::string&)>& doing = {},
                  double most_memory = no_limit);

/// The lines that `gaussdrift check` prints.
std::string to_text(const Case& spec, const Forecast& forecast);
/// The same as JSON.
std::string to_json(const Case& spec, const Forecast& forecast);

}  // namespace gaussdrift::accuracy
