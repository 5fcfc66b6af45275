// What a run did: for summary.json, the closing lines and progress.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/named.hpp"
#include "base/stopwatch.hpp"
#include "effect/effect.hpp"
#include "particle/seeding.hpp"
#include "reference/reference.hpp"
#include "sim/checks.hpp"
#include "sim/frame.hpp"

namespace gaussdrift {

struct Progress {
  std::size_t steps_done = 0, steps_total = 0;  // steps_total 0: not known beforehand
  double time = 0, end = 0;
  double seconds = 0;       // since the run began
  double step_seconds = 0;  // of these, in steps
};

/// What one effect did, for summary.json.
struct EffectSummary {
  std::string name;
  double seconds = 0;
  std::string equation, conserves;
  std::vector<std::string> changes;  // some of position, weight, width, particles
  Numbers numbers;
  std::string warning;  // what is not exact about it in this scene; empty: nothing
};

/// What a run did, for summary.json and the closing lines.
struct RunSummary {
  std::size_t lattice_points = 0, particles = 0, grid_points = 0, steps = 0;
  SeedReport seeding;              // what has no particle
  double beyond_at_start = 0;      // part of the mass of rho_0 that lies outside the domain, where its mass is known
  std::size_t steps_rejected = 0;  // tried and taken back by a method that chooses its steps
  double spacing = 0, core_radius = 0;
  int threads = 1;
  std::string transform_choice;        // of the last frame
  double transform_tolerance = 0;      // requested by the case, relative to max |rho|
  double transform_achievable = 0;     // worst frame; above the tolerance only where that cannot be promised
  std::vector<EffectSummary> effects;  // that ran: transport and what the scene called for, nothing else
  std::vector<std::pair<double, FrameNumbers>> frames;
  ReferenceReport reference;   // points of all outputs whose exact density is not known
  std::string reference_word;  // what is not exact about the exact density; empty: nothing
  std::vector<CheckResult> checks;
  std::vector<std::string> warnings;  // what is not exact about the steps of this case
  base::StageTimes stages;
  double seconds = 0;
};

}  // namespace gaussdrift
