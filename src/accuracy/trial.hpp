// A case made small enough to be tried out. Few particles are all taken. Many are replaced by those of a coarser
// lattice, in the part of the domain that has density, with wider blobs and larger weights. Costs are scaled up.
#pragma once

#include <array>
#include <cstddef>

#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/simulation.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

/// Some points of a lattice: `count` of them on each axis from `first` on, every `stride`-th of which is taken.
struct LatticePart {
  std::array<std::size_t, max_dimension> first{}, count{1, 1, 1};
  std::size_t stride = 1;

  std::size_t size() const;
  Lattice of(const Lattice& whole) const;
};

struct Trial {
  Case spec;                  // of the trial: D has grown with the square of the spacing, so that the same is stable
  Scene scene;                // its lattice and blobs; the grid is that of the case
  Particles particles;        // on the trial's lattice
  SeedReport seeding{};       // what has no particle on it
  LatticePart part{};         // of the lattice of the case
  Lattice lattice{};          // of the case
  Lattice grid{};             // for the density of a trial: that of the case, or every so many points of it
  bool whole = true;          // these are the particles of the case, all of them
  double carried = 0;         // particles of the case: counted, or estimated from the trial
  EffectsSpec effects{};      // of the case; those of `spec` are as on the coarser lattice
  std::size_t looked_at = 0;  // points at which the density was asked for

  /// Particles, or steps of all of them, of the case for one of the trial.
  double each() const { return carried / static_cast<double>(particles.size()); }
};

/// A trial with at most about so many particles. Work: some million values of the density at most, whatever the case.
/// Throws what seed_scene() throws.
Trial make_trial(const Case& spec, std::size_t most_particles, int threads);

/// The same trial with at most about so many particles, if it has more.
void thin_out(Trial& trial, std::size_t most_particles, int threads);

}  // namespace gaussdrift::accuracy
