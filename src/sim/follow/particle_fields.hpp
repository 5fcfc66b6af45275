// Fields of output.fields that belong to particles: age, residence time, first exit, and how the flow has drawn their
// neighbours apart. Files of particles have them where the particles are. Density files have those that are numbers at
// the points where the particles began. Kinds are in grid_fields.cpp with those of the grid.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/density_grid.hpp"
#include "gaussdrift/particles.hpp"
#include "sim/follow/particle_memory.hpp"
#include "sim/grid_fields.hpp"

namespace gaussdrift {

/// Some particles, and what their fields follow from.
struct ParticlesThere {
  const Particles& particles;  // ids ascend
  const Domain& domain;
  const Lattice& lattice;                        // on which they began
  double time = 0;                               // elapsed
  const TimeSpec& clock;                         // of the case
  std::function<double(std::int64_t id)> began;  // the time at which a particle began
  int threads = 1;
};

/// The kinds, in the order of docs/cases.md.
std::vector<GridFieldKind> particle_field_kinds();

/// Those that a case names.
std::vector<const GridFieldKind*> particle_fields_of(const OutputSpec& output);
/// Does one of them need what particles remember, or particles and their neighbours together?
bool remembers(const OutputSpec& output);
bool compares_neighbours(const OutputSpec& output);
/// The names of those that density files have, too.
std::vector<std::string> particle_fields_on_grid(const OutputSpec& output);
/// Numbers that they take a particle in a file, where vectors and matrices have three components an axis.
int particle_field_numbers(const OutputSpec& output);

/// What the case names, at the particles: [j][component].
std::vector<FieldOnGrid> particle_fields(const OutputSpec& output, const ParticlesThere& there);

/// Of those the ones that density files have, on all points of a lattice: the value of the particle that began nearest,
/// NaN where none did, or where it has left the run and nothing is known of it. gone: particles that have.
std::vector<FieldOnGrid> where_particles_began(const OutputSpec& output, const std::vector<FieldOnGrid>& fields,
                                               const std::vector<Gone>& gone, const ParticlesThere& there,
                                               const Lattice& evaluation);

}  // namespace gaussdrift
