/// @file
/// How far a run is, and what it did.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"
#include "gaussdrift/norms.hpp"
#include "gaussdrift/particles.hpp"
#include "gaussdrift/stage_times.hpp"

namespace gaussdrift {

/// How far a run is.
struct Progress {
  std::size_t steps_done = 0;     ///< since the start
  std::size_t steps_total = 0;    ///< to the end; 0: not known beforehand
  double time = 0;                ///< that the clock of the case shows
  double end = 0;                 ///< that it shows when the run ends
  double elapsed = 0;             ///< since the start, in the time of the case
  double length = 0;              ///< of the run in the time of the case: `TimeSpec::end`
  double seconds = 0;             ///< since the run began
  double step_seconds = 0;        ///< of these, in steps
  std::size_t outputs_done = 0;   ///< since the start
  std::size_t outputs_total = 0;  ///< to the end
};

/// What transport or one effect did.
struct EffectSummary {
  std::string name;                  ///< "transport", or as in [effects.name]
  double seconds = 0;                ///< wall time
  std::string equation;              ///< with the numbers of the case, one line
  std::string conserves;             ///< what stays the same under it, for people
  std::vector<std::string> changes;  ///< some of position, weight, width, particles
  Numbers numbers;                   ///< of its own
  std::string warning;               ///< what is not exact about it in this scene; empty: nothing
};

/// A check of the case and how it came out.
struct CheckResult {
  CheckSpec check;      ///< as in the case
  double value = 0;     ///< farthest beyond a limit, or nearest to it if none is passed; NaN where it cannot be judged
  double time = 0;      ///< of that output
  bool passed = false;  ///< the limits hold
  std::string text;     ///< "Linf = 0.0261 at t = 6.28319, at most 0.03"
};

/// What a run did.
struct RunSummary {
  std::size_t lattice_points = 0;   ///< of the seeding lattice
  std::size_t particles = 0;        ///< at the start
  std::size_t grid_points = 0;      ///< on which the density is summed
  std::size_t steps = 0;            ///< taken
  SeedReport seeding;               ///< what has no particle
  double beyond_at_start = 0;       ///< part of the mass of rho_0 that lies outside the domain, where its mass is known
  std::size_t steps_rejected = 0;   ///< tried and taken back by a method that chooses its steps
  double spacing = 0;               ///< h of the seeding lattice
  double core_radius = 0;           ///< eps = c h
  int threads = 1;                  ///< that were used
  std::string transform_choice;     ///< the method of the last frame, with its parameters
  double transform_tolerance = 0;   ///< requested by the case, relative to max |rho|
  double transform_achievable = 0;  ///< worst frame; above the tolerance only where that cannot be promised
  /// The same of the derivatives that `output.fields` names, relative to the largest value of each; 0: it names none
  double derivatives_achievable = 0;
  double derivatives_error = 0;        ///< the largest measured of them
  std::vector<EffectSummary> effects;  ///< that ran: transport and what the scene called for, nothing else
  std::vector<std::pair<double, FrameNumbers>> frames;  ///< time and numbers of each output
  ReferenceReport reference;                            ///< points of all outputs whose exact density is not known
  std::string reference_word;                           ///< what is not exact about the exact density; empty: nothing
  std::vector<CheckResult> checks;                      ///< over the frames, in the order of the case
  std::vector<std::string> warnings;                    ///< what is not exact about the steps of this case
  StageTimes stages;                                    ///< seconds by stage
  double seconds = 0;                                   ///< wall time of all
  bool complete = false;  ///< false: a progress callback stopped the run, and run() would go on
  double time = 0;        ///< that the clock of the case shows where the run is
  double elapsed = 0;     ///< since the start, in the time of the case
};

}  // namespace gaussdrift
