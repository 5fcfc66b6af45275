// A run: seeds the particles of a case, carries them from output time to output time, and shows each frame to
// observers.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/lattice.hpp"
#include "base/stopwatch.hpp"
#include "field/density/density.hpp"
#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"
#include "particle/cutoff.hpp"
#include "particle/seeding.hpp"
#include "reference/reference.hpp"
#include "sim/carrier.hpp"
#include "sim/checks.hpp"
#include "sim/density.hpp"
#include "sim/frame.hpp"

namespace gaussdrift {

/// The fields that keys of an effect give, see NamedEffect.
struct EffectFields {
  std::string effect;
  std::unique_ptr<ScalarField> decay;
  std::unique_ptr<ScalarField> carried;
  std::string carried_key;  // "effects.charge.density"
};

/// The parts of a case that are made from its text and numbers, shared by `run` and `check`.
struct Scene {
  std::unique_ptr<VelocityField> velocity;
  std::unique_ptr<InitialDensity> density;
  std::unique_ptr<ScalarField> decay_rate;  // of all weights along their paths, u0; null if none decays
  std::vector<EffectFields> effect_fields;
  Lattice seeding;         // where particles start
  Lattice evaluation;      // where rho is summed
  double core_radius = 0;  // eps = c h
  double threshold = 0;    // particles.threshold
  Cutoff cutoff;
};

/// The length over which gradients of the velocity are taken as differences: a thousandth of the smallest length that
/// the density resolves.
inline double difference_length(const Scene& scene) { return 1e-3 * scene.core_radius; }

/// threads: see make_velocity().
Scene make_scene(const Case& description, int threads = 0);

/// How paths are followed back where their work is bounded.
struct Following {
  std::size_t most_steps = 0;  // of a path; 0: far more than any usual one takes
  bool by_half_steps = false;  // by the method of the case with steps half as long, for paths through kinks
};

/// The exact density that the case asks for, on the evaluation lattice; null for none. The scene must outlive it.
std::unique_ptr<Reference> make_reference(const Case& description, const Scene& scene, int threads,
                                          const Following& following = {});

/// False if the velocity or the rate of a reaction has kinks. Methods of high order take short steps at each.
bool has_smooth_paths(const Scene& scene);

/// The work of a run. The unit is one evaluation of a velocity with a sine or two, some 40 ns of one core. It is
/// counted, not timed, so that decisions do not depend on the machine.
struct Work {
  double transport = 0, density = 0, pictures = 0;
  double total() const { return transport + density + pictures; }
};
Work work_of(const Case& description, const Scene& scene, std::size_t particles);

/// The work of one evaluation of the velocity at all particles, with what they do to each other.
double work_of_rate(const Case& description, const Scene& scene, std::size_t particles);

/// The work of one evaluation on an exact path, the integrator included.
double work_of_exact_rate(const Scene& scene);

/// Paths that can be followed within some work, and how.
struct Affordable {
  std::size_t points = 0;  // 0: not even few
  Following following{};
  double work = 0;     // of one path from the last output to the start
  std::string word{};  // what is not exact about them; empty: nothing
};

/// How many exact paths can be followed from grid points to the start with the work `allowed`, for `outputs` outputs
/// (in units of the last one): at least 16, or none. Paths with kinks that are too expensive are followed by steps half
/// as long as those of the case. The answer comes from following some paths, which takes at most a quarter of the work.
Affordable affordable_paths(const Case& description, const Scene& scene, double allowed, double outputs, int threads);

/// The part of an output that is compared with the reference.
struct Comparison {
  std::size_t points = 0;  // of the grid; 0: none, for the reason `left_out`
  Following following{};
  std::string word{};  // what is not exact about the exact density; empty: nothing
  std::string left_out{};
};

/// reference.points if the case has it. All if a picture shows the error, or if the reference is a formula. Otherwise
/// as many as 15 % of the work of the run allow (or a tenth of a second): all if density files are written, else at
/// most 4096, and at most 256 where paths have kinks. None if fewer than 16 are allowed, unless a check or a target
/// needs them.
Comparison plan_comparison(const Case& description, const Scene& scene, std::size_t particles, int threads);

/// The same on any lattice, and none where there is nothing.
Particles seed_lattice(const Scene& scene, const Lattice& lattice, int threads, SeedReport* report = nullptr);

/// Particles of the scene at t = 0: every lattice point with density or charge that exceeds the threshold. The report
/// tells of both, in that order. Throws NumericalError where one is not finite, InputError if rho_0 is 0 everywhere.
Particles seed_scene(const Scene& scene, int threads, SeedReport* report = nullptr);

/// The largest density that the blobs of all points left out can have together, anywhere and at any time, if weights
/// stay.
double density_left_out(const Scene& scene, const SeedReport& report);

/// The times on which steps land exactly: outputs, and time.end.
std::vector<double> landings(const Case& description);

/// Steps from t = 0 to time.end with landings on all output times; 0 if they are chosen by their error.
std::size_t total_steps(const Case& description);

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

class Simulation {
 public:
  /// threads: 0 for all.
  explicit Simulation(const Case& description, int threads = 0);

  void observe(std::unique_ptr<Observer> observer) { observers_.push_back(std::move(observer)); }
  /// Called between batches of steps, several times a second at most.
  void on_progress(std::function<void(const Progress&)> report) { progress_ = std::move(report); }

  /// Seeds the particles and looks at the velocity there, so that what cannot begin is refused before anything is
  /// written. run() does it if it was not done.
  void prepare();

  /// Runs to time.end. Errors of fields and observers pass through; frames already shown stay as they are.
  RunSummary run();

  const Particles& particles() const { return particles_; }
  /// What was constructed for this case beside transport.
  const Effects& effects() const { return carrier_.effects(); }

 private:
  std::vector<double> velocity_at_particles(double time) const;
  void carry(double from, double to, RunSummary& summary);
  void show_frame(int index, double time, RunSummary& summary);
  void judge_norms(const std::vector<double>& exact, FrameNumbers& numbers) const;

  const Case case_;
  int threads_;
  Scene scene_;
  Carrier carrier_;
  Particles particles_;
  std::unique_ptr<Reference> reference_;  // null for none
  SeedReport seeding_;
  double seed_seconds_ = 0, mass_at_start_ = 0, beyond_at_start_ = 0;
  double largest_at_start_ = 0;  // of |rho_0| on the lattice
  Comparison compared_;
  std::vector<std::unique_ptr<Observer>> observers_;
  std::function<void(const Progress&)> progress_;
  base::Stopwatch watch_;
  std::size_t steps_done_ = 0, steps_total_ = 0;
};

}  // namespace gaussdrift
