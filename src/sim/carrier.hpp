// Carries the particles of a scene through transport and its effects, from time to time. method.md, sections 4 and 8.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/exact_sum.hpp"
#include "base/folding.hpp"
#include "base/seam.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/stage_times.hpp"
#include "sim/adaptive_stepper.hpp"
#include "sim/borders/coast.hpp"
#include "sim/borders/departures.hpp"
#include "sim/effects.hpp"
#include "sim/follow/particle_memory.hpp"
#include "sim/stable_step.hpp"
#include "sim/stepper.hpp"
#include "sim/steps_taken.hpp"
#include "time/schedule.hpp"

namespace gaussdrift {

class Carrier {
 public:
  /// Constructs the effects that the case names. Case and scene must outlive the carrier. threads: 0 for all.
  Carrier(const Case& spec, const Scene& scene, int threads);
  /// The same where other ranks carry the rest of the particles: all of them call what follows together, and throw the
  /// same errors.
  Carrier(const Case& spec, const Scene& scene, int threads, base::Communicator& ranks, const RankAt& rank_at);
  Carrier(const Carrier&) = delete;  // effects refer to it
  Carrier& operator=(const Carrier&) = delete;

  /// Prepares the particles for the effects. Throws InputError if time.step is not stable for the flow or for an
  /// effect. The message names a step that is stable for all of them.
  void begin(Particles& particles) { begin(particles, particles); }
  /// The same from a sample of the particles of all ranks.
  void begin(Particles& particles, const Particles& sample);

  /// Particles have gone to other ranks or have come from there.
  void placed(const Particles& particles);

  /// The longest step <= `step` that begin() accepts with a method of fixed steps, for the particles that it saw last.
  /// begin() may have refused the step of the case before. Not for a case whose method chooses its steps.
  double longest_step(const time::Tableau& tableau, double step) const;

  /// Warnings about the steps of this case, as sentences for the user. Call it after begin().
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Steps may be abandoned at their seams once `wanted` says so. Null: they may not. It must outlive the carrier.
  void abandon_when(const base::AbandonWanted* wanted) { abandon_wanted_ = wanted; }

  /// Batches end where so many steps have been taken since the start, and at multiples of that. 0: wherever.
  void pause_every(std::size_t steps) { pause_every_ = steps; }

  /// The way from one landing time to the next, and how far along it the particles are.
  struct Leg {
    double from = 0, to = 0;
    std::size_t steps = 0;  // taken on it
    double now = 0;         // reached
  };

  /// Carries the particles on along the leg, and at its end brings weights and widths up to it. `steps_before` is the
  /// number of steps before the leg. `go_on` is called between batches of steps, with the leg so far; where it returns
  /// false the particles stay there, and another call goes on with the same bits. So they do where steps are abandoned:
  /// then particles and effects are as before these steps. Seconds are booked under "transport"
  /// and "effect <name>". Returns true if the end is reached.
  bool carry(Particles& particles, Leg& leg, std::size_t steps_before, StageTimes& stages,
             const std::function<bool(const Leg& leg)>& go_on);
  /// A whole leg; returns the steps taken.
  std::size_t carry(Particles& particles, double from, double to, std::size_t steps_before, StageTimes& stages);

  /// Steps of a fixed length alone: steps first .. first + count - 1 of the interval.
  void advance(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
               std::size_t steps_before, StageTimes& stages);

  /// What effects and steps have gathered beside what the particles hold: writes it, or takes it up for these particles.
  /// Throws std::out_of_range if the bytes are not those of this case. landed_on: times on which steps have landed, from
  /// the begin of the run on, which whoever reads knows too. With them the bytes do not grow with the number of landings.
  void pass_state(base::StateBytes& bytes, const Particles& particles, std::span<const double> landed_on = {});

  /// Whether what pass_state() has read are steps of this case, one after another, and none of them after `now`.
  bool has_steps_until(double now) const { return taken_.fit(case_.time.step, now); }

  /// True if steps are chosen by their error (time.tolerance) instead of by time.step.
  bool is_adaptive() const { return adaptive_.has_value(); }

  /// True if an effect has to see the particles between any two steps.
  bool acts_between_steps() const { return between_steps_; }

  /// True if an effect may put other particles in place of those that were seeded.
  bool replaces_particles() const;

  /// True if particles that start side by side stay so, but for what the flow does.
  bool keeps_neighbours() const;

  /// What may leave the run, and has.
  const Departures& departures() const { return departures_; }
  Departures& departures() { return departures_; }

  /// What particles remember of their paths.
  ParticleMemory& memory() { return memory_; }
  const ParticleMemory& memory() const { return memory_; }

  /// With sources: what weights have lost along the paths so far, on all ranks. Nothing where they keep them.
  std::optional<double> decayed() const;

  /// What a tracer has gained along the paths so far, on all ranks. Nothing where none reacts.
  std::optional<double> reacted(std::size_t tracer) const;

  std::size_t steps_rejected() const { return adaptive_ ? adaptive_->rejected() : 0; }

  const Effects& effects() const { return effects_; }

  /// Velocities that particles give each other, in elapsed time.
  const std::vector<const Drift*>& drifts() const { return drifts_; }

 private:
  void refuse_unstable_step() const;
  void warn_of_jumps(const Particles& particles);

  // A hook of an effect, on all ranks: they agree on how it went.
  template <class Hook>
  void call(const Effect& effect, const Hook& hook) const;

  // Takes `steps` whole, or leaves particles and effects as they were and returns false.
  bool attempt(Particles& particles, const std::function<void()>& steps);

  // To the end of the leg by steps that are chosen, and by steps of a fixed length; false if `go_on` said no before.
  bool adapt(Particles& particles, Leg& leg, std::size_t steps_before, StageTimes& stages,
             const std::function<bool(const Leg& leg)>& go_on);
  bool step(Particles& particles, Leg& leg, std::size_t steps_before, StageTimes& stages,
            const std::function<bool(const Leg& leg)>& go_on);

  bool carry_on(Particles& particles, Leg& leg, std::size_t steps_before, StageTimes& stages,
                const std::function<bool(const Leg& leg)>& go_on);
  bool all_go_on(const std::function<bool(const Leg& leg)>& go_on, const Leg& leg) const;

  // Brings weights and widths up to `time`, at which the positions are.
  void land(Particles& particles, double time, StageTimes& stages);

  void take_steps(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
                  std::size_t steps_before, StageTimes& stages) const;
  void take_own_steps(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
                      std::size_t steps_before, StageTimes& stages) const;
  void exchange(Particles& particles, double time, double length, StageTimes& stages) const;
  void scatter(Particles& particles, const Scattering& part, StageTimes& stages) const;
  void rearrange(Particles& particles, double time, StageTimes& stages);
  void follow(Particles& particles) const;
  void settle(Particles& particles, double time, StageTimes& stages);
  struct Changed {
    base::ExactSum own, together;  // of this rank since the ranks brought it together, and of all ranks until then
  };
  void bring_together(Changed& changed);
  // Steps end one by one, with a look at what has come to an edge or to land.
  bool looks_at_steps() const { return departures_.possible() || coast_ || memory_.wanted(); }
  bool needs_beginnings() const { return coast_ || memory_.wanted(); }
  // At the end of a step: what has come to land meets the coast, and what leaves is taken out.
  void arrive(Particles& particles, double from, double time, StageTimes& stages);
  void bring_up(Particles& particles, double time, StageTimes& stages) const;

  base::Communicator alone_;
  base::Communicator& ranks_;
  Effects effects_;
  std::vector<Effect*> integrating_;              // those with a path integral, in the order of Particles::path
  std::vector<std::unique_ptr<Drift>> reversed_;  // where the clock goes backwards: those of the effects, turned round
  std::vector<const Drift*> drifts_;
  bool between_steps_ = false;  // some effect acts between any two steps
  Folding folding_;             // where places beyond the domain lie in it
  Departures departures_;
  ParticleMemory memory_;
  bool counts_decay_ = false;
  Changed decayed_;
  std::vector<Changed> reacted_;                          // of each tracer; empty: none reacts
  const Coast* coast_ = nullptr;                          // null: nobody looks at it
  std::array<std::vector<double>, max_dimension> began_;  // positions at the start of a step, where they are needed
  const time::Tableau& tableau_;
  const Case& case_;
  const Scene& scene_;
  Stepper stepper_;
  std::optional<AdaptiveStepper> adaptive_;
  StepsTaken taken_;  // kept only if an effect acts between steps
  FlowRates flow_;    // at the start
  std::vector<std::string> warnings_;
  const base::AbandonWanted* abandon_wanted_ = nullptr;
  Particles before_;  // steps that may be abandoned: what of them is not set at their very end
  std::size_t pause_every_ = 0;
  int threads_;
};

}  // namespace gaussdrift
