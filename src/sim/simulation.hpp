// A run: seeds the particles of a case, carries them from output time to output time, and shows each frame to
// observers.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/stopwatch.hpp"
#include "gaussdrift/case.hpp"
#include "sim/carrier.hpp"
#include "sim/comparison.hpp"
#include "sim/frame.hpp"
#include "sim/landings.hpp"
#include "sim/scene.hpp"
#include "sim/summary.hpp"
#include "sim/work.hpp"

namespace gaussdrift {

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
  void check_density_seconds() const;
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
