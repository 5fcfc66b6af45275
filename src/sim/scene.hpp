// The parts of a case that are made from its text and numbers, and its particles at the start.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "field/density/density.hpp"
#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"
#include "particle/cutoff.hpp"
#include "particle/seeding.hpp"
#include "sim/borders/coast.hpp"

namespace gaussdrift {

/// The fields that keys of an effect give, see NamedEffect.
struct EffectFields {
  std::string effect;
  std::unique_ptr<ScalarField> decay;
  std::unique_ptr<ScalarField> carried;
  std::unique_ptr<ScalarField> field;
  std::string carried_key;  // "effects.charge.density"
};

/// The parts of a case that are made from its text and numbers, shared by `run` and `check`.
struct Scene {
  std::unique_ptr<VelocityField> velocity;
  std::unique_ptr<InitialDensity> density;
  std::vector<std::unique_ptr<InitialDensity>> tracers;  // of the named densities, whose sum is `density`
  std::unique_ptr<ScalarField> decay_rate;               // of all weights along their paths, u0; null if none decays
  std::vector<EffectFields> effect_fields;
  Lattice seeding;            // where particles start
  Lattice evaluation;         // where rho is summed
  double core_radius = 0;     // eps = c h
  double threshold = 0;       // particles.threshold
  bool starts_empty = false;  // there are sources and no density at the start
  Cutoff cutoff;
  std::optional<Tensor> spreading_shape;     // of blobs that become ellipses; empty: they stay round
  std::vector<double> spreading_of_tracers;  // which part of the spread each has; empty: all of it
  std::unique_ptr<Coast> coast;              // null: the data have no land
  std::vector<std::string> misfits;          // what is wrong with the velocity at the edges of the domain, for people
};

/// The length over which gradients of the velocity are taken as differences: a thousandth of the smallest length that
/// the density resolves.
/// In units of the coordinates.
inline double difference_length(const Scene& scene) { return 1e-3 * scene.core_radius / scene.seeding.unit(); }

/// The blob of a scene with this seeding lattice at the start: sets core radius and cutoff.
void set_blob(const ParticleSpec& particles, Scene& scene);

/// A cutoff with this name and default arguments in its place.
Cutoff other_cutoff(const Scene& scene, std::string_view name);

/// What these particles carry: the cutoff at the start, as wide as it has become; of a tracer by a part of the spread.
Cutoff blob_of(const Scene& scene, const Particles& particles, double part = 1);

/// The grid on which a case sums its density.
Lattice evaluation_lattice(const Case& spec);

/// threads: see make_velocity().
Scene make_scene(const Case& spec, int threads = 0);

/// False if the velocity or the rate of a reaction has kinks. Methods of high order take short steps at each.
bool has_smooth_paths(const Scene& scene);

/// The same on any lattice, and none where there is nothing.
Particles seed_lattice(const Scene& scene, const Lattice& lattice, int threads, SeedReport* report = nullptr);
Particles seed_lattice(const Scene& scene, const Lattice& lattice, int threads, SeedReport* report,
                       base::Communicator& ranks);

/// Particles of the scene at t = 0: every lattice point with density or charge that exceeds the threshold. The report
/// tells of both, in that order. Throws NumericalError where one is not finite, InputError if rho_0 is 0 everywhere.
Particles seed_scene(const Scene& scene, int threads, SeedReport* report = nullptr);

/// The share of a rank, see seed(). All ranks throw the same.
Particles seed_scene(const Scene& scene, int threads, SeedReport* report, base::Communicator& ranks);

/// The largest density that the blobs of all points left out can have together, anywhere and at any time, if weights
/// stay.
double density_left_out(const Scene& scene, const SeedReport& report);

}  // namespace gaussdrift
