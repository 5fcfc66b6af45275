// Effects by name, `[effects.name]` of a case file: each describes itself in a file of its own. docs/effects.md.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/catalogue.hpp"
#include "base/communicator.hpp"
#include "base/folding.hpp"
#include "base/named.hpp"
#include "effect/effect.hpp"
#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"
#include "particle/cutoff.hpp"

namespace gaussdrift {

/// Something that an effect does or needs, in the words of messages. Without words it does not.
struct Trait {
  std::string_view words = {};
  std::string_view unless = {};  // "the charge has a density of its own": where it does not; empty: it always does
  std::string_view remedy = {};  // what to change in a case, for people
  bool (*holds)(const EffectSpec& effect, int dimension) = nullptr;  // null: always

  bool of(const EffectSpec& effect, int dimension) const {
    return !words.empty() && (!holds || holds(effect, dimension));
  }
};

/// What others have to know of an effect. Which effects go together follows from these (input/effect_rules.cpp), and
/// so does which effects a reference, a budget and a study can deal with.
struct EffectTraits {
  /// Particles move each other: all are carried together, and no path is known beforehand.
  bool particles_interact = false;
  /// Their weights say how: "these are the charges that move the particles".
  Trait moved_by_weights = {};
  /// Their motion does not see how wide the blobs are: "charges are points, so their field would not spread ...".
  Trait blind_to_widths = {};
  /// Particles carry something besides their weight, which only those of the start have: "charge of their own".
  Trait carries_more = {};
  /// Weights grow or decay along the paths: "the reaction changes the weights".
  Trait grows_weights = {};
  /// Particles appear during the run: "particle-exchange adds particles during the run".
  Trait adds_particles = {};
  /// Others stand in place of the particles: "remeshing makes new particles".
  Trait replaces_particles = {};
  /// Weight goes from particle to particle: "diffusion moves weight between particles".
  Trait moves_weight = {};
  /// It needs steps that are known beforehand. The words follow its table in a message: "method = ...", or "at all".
  Trait needs_fixed_steps = {};
  /// Blobs become wider during the run: "core spreading widens the blobs".
  Trait widens_blobs = {};
  /// They do so more along some axes than along others: "blobs become ellipses".
  Trait makes_ellipses = {};
  /// Particles move at random: "the random walk parts neighbours".
  Trait scatters = {};
  /// It knows lengths in the plane and in space, and no longitudes: "remeshing puts particles on a flat lattice".
  Trait needs_lengths = {};
  /// The density spreads.
  bool diffuses = false;
  /// What carries the density changes, the density does not.
  bool keeps_density = false;
  /// Its lattice ends where the domain has edges, and goes on in images.
  bool knows_edges = false;
  /// It cannot be undone: a run that goes backwards in time does not know what was there before.
  Trait irreversible = {};
  /// Flat patches of density are usual with it, and ripple when particles leave their lattice.
  bool flat_patches_ripple = false;
  /// Blobs overlap again where the flow has drawn them apart.
  bool restores_overlap = false;
};

/// What an effect takes a particle.
struct EffectMemory {
  double integrals = 0;  // numbers that are integrated along its path
  double columns = 0;    // other numbers that it has
  double kept = 0;       // further bytes, all the time
  double step = 0;       // further bytes during a step
};

/// What a scene gives to an effect that is made for it. All of it must outlive the effect.
struct EffectScene {
  const Case& spec;
  const VelocityField& velocity;
  const Lattice& seeding;
  double core_radius;          // of the blobs at the start
  double distance;             // over which differences of the velocity are taken
  double spreading;            // the square of every width grows at this rate
  const ScalarField* decay;    // the field of the key NamedEffect::decay_rate; null without
  const ScalarField* carried;  // and of NamedEffect::carried
  const ScalarField* field;    // and of NamedEffect::field, or the values of its file
  /// Carries particles from their lattice nodes to the places that they would have reached by now.
  std::function<void(Particles& particles)> follow;
  Folding folding;            // of places beyond periodic and closed edges
  base::Communicator& ranks;  // that share the particles
  RankAt rank_at;
  int threads;

  /// Volume of a particle at the start.
  double cell() const;
};

struct NamedEffect {
  /// Name, meaning, dimensions and keys. Defaults are numbers or words.
  NamedFormula about;
  EffectTraits traits = {};
  /// The key with the rate at which weights decay along their paths, if that is all that the effect does: the exact
  /// density and the error budget know it then.
  std::string_view decay_rate = {};
  /// The key with a half-life, which may stand in place of that rate: ln 2 / half-life.
  std::string_view half_life = {};
  /// The key with a density that particles carry besides rho_0; particles start where either is.
  std::string_view carried = {};
  /// What that is called: "charge".
  std::string_view carried_name = {};
  /// The key with an expression for which data on a grid may stand, `file`, and what these are: "the coefficient".
  std::string_view field = {};
  std::string_view field_name = {};
  /// Words of other programs that ask for it, and what is possible in their place.
  std::vector<std::pair<std::string_view, std::string_view>> elsewhere = {};
  /// What is wrong with it in a case whose domain, particles and times have been read.
  std::vector<Complaint> (*problems)(const EffectSpec& effect, const Case& spec) = nullptr;
  /// The rate at which the square of every width grows.
  double (*spreading)(const EffectSpec& effect) = nullptr;
  /// How that is along other directions than the fastest, see spread_cutoff(); null: all are alike.
  std::optional<Tensor> (*spreading_shape)(const EffectSpec& effect, int dimension) = nullptr;
  /// Which part of it each named density of the case has; empty: all spread alike.
  std::vector<double> (*spreading_of_tracers)(const EffectSpec& effect, const Case& spec) = nullptr;
  /// Work of a particle in a step besides stages, in evaluations of a velocity (sim/work.hpp, Work).
  double (*work)(const EffectSpec& effect, const Case& spec) = nullptr;
  EffectMemory (*memory)(const EffectSpec& effect, int dimension) = nullptr;
  /// Further bytes of a particle during a step, where images of it beyond the edges of the domain act too.
  double (*memory_of_images)(const Case& spec) = nullptr;
  /// The same effect on a lattice `times` as coarse, for a trial: in units of the spacing nothing changes.
  void (*coarsen)(EffectSpec& effect, double times) = nullptr;
  /// From values that complete_effect() has made complete.
  std::function<std::unique_ptr<Effect>(const EffectSpec& effect, const EffectScene& scene)> make;

  /// The exact density follows known paths with it.
  bool keeps_paths() const { return !decay_rate.empty() || traits.keeps_density; }
};

/// "effects.charge".
std::string table_of(const NamedEffect& effect);

/// In the order of docs/cases.md, in which they also act.
const std::vector<NamedEffect>& effects();

/// Those of a case with the complete values of their keys, in the order of the catalogue. Throws std::invalid_argument
/// if the case names an effect that does not exist.
std::vector<std::pair<const NamedEffect*, EffectSpec>> effects_of(const EffectsSpec& named);

/// True if a key has a value in the presence of the others.
bool applies(const NamedParameter& parameter, const EffectSpec& effect);

/// `given` in the order of the effect's keys, with defaults for those that apply and are not given.
EffectSpec complete_effect(const NamedEffect& effect, const EffectSpec& given);

/// Particles of this case move each other.
bool particles_interact(const EffectsSpec& named);

/// With an effect of this case flat patches of density are usual, and ripple.
bool flat_patches_ripple(const EffectsSpec& named);

/// The rate at which the square of every width grows, by all effects together.
double spreading(const EffectsSpec& named);

/// How blobs are longer along some directions; empty: all effects leave them round.
std::optional<Tensor> spreading_shape(const EffectsSpec& named, int dimension);

/// Which part of that rate the width of each named density has; empty: all blobs are alike.
std::vector<double> spreading_of_tracers(const Case& spec);

/// Why the errors of a case with these effects are not predicted: the causes that a budget knows are those of transport
/// and of weights that decay along their paths. Empty: they are.
std::string beyond_budgets(const EffectsSpec& named, int dimension);

/// "transport and reaction": what budgets, exact densities and --accuracy know.
std::string known_to_budgets();

/// What particles carry besides their mass: "charge"; empty: nothing.
std::string_view carried_besides(const EffectsSpec& named);
/// ", and of the largest charge": of all that effects may let them carry.
std::string largest_of_carried();

/// The first effect that puts lost overlap right; null if there is none.
const NamedEffect* overlap_restorer();
/// "[effects.remesh]": its table, for remedies.
std::string restorers_table();

}  // namespace gaussdrift

namespace gaussdrift::base {
template <>
std::vector<NamedEffect>& catalogue();
}
