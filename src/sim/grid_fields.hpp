// The catalogue of what a run can show on its grid beside the density, `output.fields` of a case: derivatives of the
// density, the velocity, and what follows from its gradient; and fields of particles. A field is one object. To add one:
// its object in grid_fields.cpp, or in sim/follow/particle_fields.cpp.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"
#include "base/named.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// The flow at one place and time; entries beyond the dimension are 0.
struct FlowThere {
  int dimension = 2;
  Vector velocity{};
  std::array<Vector, max_dimension> gradient{};  // [k][i] = d u_k / d x_i
};

struct ParticlesThere;  // sim/follow/particle_fields.hpp

/// A field of particles.
struct FieldOfParticles {
  /// [j][component], at all particles.
  std::vector<double> (*values)(const ParticlesThere& there) = nullptr;
  /// Of a particle that has left the run, from Particles::kept. Null: not known then.
  double (*of_gone)(const double* kept, const TimeSpec& clock) = nullptr;
  bool is_remembered = false;        // it needs Particles::kept
  bool compares_neighbours = false;  // it needs particles and their neighbours together
};

struct GridFieldKind {
  GridField about;
  /// The derivatives D^alpha of the density whose sum is a component, for each component. Null: it is not of the density.
  std::vector<std::vector<std::array<int, max_dimension>>> (*of_density)(int dimension) = nullptr;
  /// The components, from the flow. Null: it is not of the flow.
  void (*of_flow)(const FlowThere& flow, double* components) = nullptr;
  bool needs_gradient = false;  // of the velocity

  /// It belongs to particles, as `about` says.
  FieldOfParticles of_particles = {};

  int components(int dimension) const {
    return about.is_matrix ? dimension * dimension : about.is_vector[dimension - 2] ? dimension : 1;
  }
};

/// In the order of docs/cases.md.
const std::vector<GridFieldKind>& grid_fields();

/// Throws std::out_of_range if no field is called so.
const GridFieldKind& find_grid_field(std::string_view name);

/// Those that a case names, without the density, which is always there.
std::vector<const GridFieldKind*> fields_beside_density(const OutputSpec& output);

}  // namespace gaussdrift

template <>
std::vector<gaussdrift::GridFieldKind>& gaussdrift::base::catalogue<gaussdrift::GridFieldKind>();
