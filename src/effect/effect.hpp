// What happens to particles beside transport. An effect is constructed only if the case has its table [effects.x], and
// costs nothing otherwise. Hooks are called once for many particles, never for each. docs/effects.md is the contract,
// docs/method.md, section 8 has the equations.
//
// One run calls, in this order:
//   look_at          once, with a sample of the particles
//   begin            once the particles stand; again whenever another effect has replaced them
//   for every step   exchange (half a step), scatter (half a step), the step itself with the path integrals, scatter,
//                    settle, land, rearrange, exchange (half a step)
//   land             at output times: afterwards weights and widths are those of that time
// Without any effect that acts_between_steps(), settle and land alone are called, at output times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/state_bytes.hpp"
#include "effect/drift.hpp"
#include "effect/path_integral.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// Which parts of the particles an effect changes.
struct Changes {
  bool position = false;
  bool weight = false;
  bool width = false;       // of the blobs
  bool particles = false;   // adds or replaces particles
  bool neighbours = false;  // those that start side by side do not stay so, by chance
};

/// A part of a step in which particles move at random. Numbers are drawn for it alone.
struct Scattering {
  std::uint64_t number = 0;     // no other part of the run has it
  double time = 0, length = 0;  // of which, and how long it is
};

/// Weights are the sums of those of the tracers, where there are some.
inline void add_up_tracers(Particles& particles) {
  if (particles.tracers.empty()) return;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    double sum = 0;
    for (const auto& tracer : particles.tracers) sum += tracer[j];
    particles.alpha[j] = sum;
  }
}

/// The rank that has the tile in which this place lies.
using RankAt = std::function<int(const Vector& place)>;

class Effect {
 public:
  virtual ~Effect() = default;

  /// As in [effects.name].
  virtual std::string name() const = 0;
  /// Its equation with the numbers of the case, one line.
  virtual std::string describe() const = 0;
  virtual Changes changes() const = 0;
  /// What stays the same under it, for people: "mass and centroid", "nothing".
  virtual std::string conserves() const = 0;
  /// What is not exact about it in this scene, one sentence for people; empty: nothing. Asked after begin().
  virtual std::string warning() const { return ""; }
  /// The longest time step with which it is stable, for the particles seen by begin(); infinity if every one is.
  virtual double stable_step() const { return std::numeric_limits<double>::infinity(); }

  /// Before the first begin(): some of the particles at the start, spread over those of all ranks.
  virtual void look_at(const Particles& /*sample*/) {}
  virtual void begin(Particles& /*particles*/, double /*time*/) {}

  /// The velocity that it adds to the flow; null: none.
  virtual const Drift* drift() const { return nullptr; }
  /// The quantity to integrate along the paths; null: none.
  virtual const PathIntegral* path_integral() const { return nullptr; }
  /// Applies integral[j], gathered since the last call: the first of its rows of Particles::path, all of which the caller
  /// sets back to 0 afterwards.
  virtual void settle(Particles& /*particles*/, const double* /*integral*/, double /*time*/) {}

  /// True if it has to see the particles between any two steps.
  virtual bool acts_between_steps() const { return false; }
  /// Changes weights over a length of time, at fixed positions.
  virtual void exchange(Particles& /*particles*/, double /*time*/, double /*length*/) {}
  /// True if it moves particles at random. Then it has to act between any two steps as well.
  virtual bool scatters() const { return false; }
  /// Moves the particles by chance, on both sides of the step itself. What a particle draws follows from its id and from
  /// the number, and from nothing else.
  virtual void scatter(Particles& /*particles*/, const Scattering& /*part*/) {}
  /// May replace the particles; true if it did.
  virtual bool rearrange(Particles& /*particles*/, double /*time*/) { return false; }

  virtual void land(Particles& /*particles*/, double /*time*/) {}

  /// Where ranks share the particles, all of them call every hook together. True if hooks of this effect talk with those
  /// of the other ranks; then they agree on errors as well (base/communicator.hpp). Those of other effects work with the
  /// particles of this rank.
  virtual bool talks_to_ranks() const { return false; }
  /// Particles have gone to other ranks or have come from there.
  virtual void placed(const Particles& /*particles*/) {}

  /// What it has gathered since begin() beside what the particles hold: writes it, or takes it up in a run that goes on
  /// with these particles. begin() has been called before.
  virtual void pass_state(base::StateBytes& /*bytes*/, const Particles& /*particles*/) {}

  /// What it did, for summary.json: name and number.
  virtual Numbers numbers() const { return {}; }
};

}  // namespace gaussdrift
