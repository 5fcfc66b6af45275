/// @file
/// A run: seeds the particles of a case, carries them from output time to output time, and shows each frame to
/// observers.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "gaussdrift/case.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/frame.hpp"
#include "gaussdrift/particles.hpp"
#include "gaussdrift/summary.hpp"

namespace gaussdrift {

namespace base {
class Communicator;
}

/// What Simulation::abandon_when() has asked for came true before the run could begin.
class Abandoned : public Error {
 public:
  /// No step was taken.
  Abandoned() : Error(ExitCode::stopped, "the run was abandoned before its first step") {}
};

/// One run of one case. It prints nothing and writes no file; observers see what comes out.
class Simulation {
 public:
  /// Makes the fields and effects that the case names. The settings of the case count as they are: `accuracy.target`
  /// is not looked at (see choose_settings()). threads: 0 for all; results do not depend on it. Throws InputError.
  explicit Simulation(const Case& spec, int threads = 0);
  /// The share of a rank, where N processes carry out one run together: all call the same functions in the same order,
  /// and throw the same errors. Observers are added on rank 0, where frames, states and summaries are complete; those
  /// that look at pieces are added on the others, too.
  /// `threads` counts for a rank. Throws InputError for a case that cannot be shared.
  Simulation(const Case& spec, int threads, base::Communicator& ranks);
  Simulation(Simulation&&) noexcept;             ///< what is left may only be destroyed
  Simulation& operator=(Simulation&&) noexcept;  ///< what is left may only be destroyed
  ~Simulation();

  /// Adds one that sees every frame, after those that were added before.
  void observe(std::unique_ptr<Observer> observer);
  /// The same with a function; `name` is the stage that its seconds are booked under.
  void observe(const std::string& name, std::function<void(const Frame&)> see);

  /// `go_on` is called between batches of steps, several times a second at most, on the thread of run(). Where it
  /// returns false the run stops after that step.
  void on_progress(std::function<bool(const Progress&)> go_on);

  /// Ends a run without waiting for a long step or output. `wanted` is asked inside of them, by several threads and
  /// thousands of times a second. Once it returns true, run() abandons what is under way within moments (docs/library.md)
  /// and returns: steps under way are not taken, an output under way is not among the frames. Observers may have seen that
  /// output, and will see it again. Where an output was abandoned the run goes on in another Simulation, by restore();
  /// run() then throws std::logic_error. prepare() and restore() throw Abandoned.
  void abandon_when(std::function<bool()> wanted);

  /// Seeds the particles and looks at the velocity there, so that what cannot begin is refused early: InputError where
  /// there is no density, a step is unstable or a named method too slow; NumericalError where a field is not finite;
  /// std::bad_alloc. run() does it if it was not done.
  void prepare();

  /// Runs to time.end, or until on_progress() says no; called again it goes on from there, with the same bits as a run
  /// that never stopped. Throws NumericalError naming step, time, particle and place where a value is not finite, what
  /// prepare() throws, and what observers throw; frames already shown stay as they are. std::logic_error if the run is
  /// complete or an error ended it.
  RunSummary run();

  /// All that a run needs to go on, beside the particles: how far it is, and what effects and observers have gathered.
  /// Bytes for restore(). Wherever a progress function is called, and between calls of run(), the particles and these
  /// bytes belong together.
  std::string state() const;

  /// Goes on where another run of this case was, with the same bits: its particles() and its state(). To be called
  /// instead of prepare(), after the observers are added; these make again what they have written (Observer::restore).
  /// Later outputs and time.end may differ from those of that run, and so may the number of threads. Throws what
  /// prepare() throws, and InputError if the particles or the bytes are not those of this case, or if time.end lies
  /// before them. On several ranks each brings some of the particles, and rank 0 the bytes.
  void restore(Particles particles, const std::string& state);

  /// What the run has done so far; callable wherever a progress function is called. Its seconds are those until now.
  RunSummary summary() const;

  /// Whether every point of every output is compared with the exact density. Known after prepare().
  bool compares_everywhere() const;
  /// What the whole run takes on one thread, by its work on a usual machine: right within a factor of three or so. Known
  /// after prepare().
  double rough_seconds() const;

  /// As they are now, without copies; empty before prepare(). Weights and widths are those of the last output. Where
  /// several ranks share the run these are the own ones.
  const Particles& particles() const;
  /// Those of all ranks, by id, on rank 0; elsewhere none. Copies; all ranks call it together.
  Particles all_particles() const;
  /// The number of particles of all ranks.
  std::size_t particle_count() const;

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace gaussdrift
