// The parts of a run: all that its files share. simulation.cpp carries, run_outputs.cpp shows, run_follow.cpp
// follows particles, run_state.cpp keeps and takes up.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "base/seam.hpp"
#include "base/state_bytes.hpp"
#include "base/stopwatch.hpp"
#include "gaussdrift/simulation.hpp"
#include "reference/reference.hpp"
#include "sim/carrier.hpp"
#include "sim/checks.hpp"
#include "sim/comparison.hpp"
#include "sim/follow/particle_fields.hpp"
#include "sim/follow/tracks.hpp"
#include "sim/placement.hpp"
#include "sim/releases.hpp"
#include "sim/scene.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

/// What a case counts besides: about edges of the domain and land, and about what sources release.
struct Counted {
  bool edges = false, sources = false, stopped = false, tracers = false, fields = false;
};

class Simulation::Parts {
 public:
  Parts(const Case& spec, int threads, base::Communicator* ranks);

  void prepare();
  void restore(Particles particles, const std::string& bytes);
  std::string state();
  RunSummary summary();
  RunSummary run();
  const Particles& particles() const { return particles_; }
  Particles all_particles() const { return gather_particles(particles_, ranks_); }
  std::size_t particle_count() const { return place_.particle_count(); }
  bool compares_everywhere() const { return reference_ && compared_.points >= scene_.evaluation.size(); }
  double rough_seconds() const;
  void abandon_when(std::function<bool()> wanted);

  std::vector<std::unique_ptr<Observer>> observers;
  std::function<bool(const Progress&)> go_on;

 private:
  using ObserverStates = std::vector<std::pair<std::string, std::string>>;  // name and state

  template <class Work>
  void on_first(const Work& work) const {
    ranks_.agree_on([&] {
      if (place_.is_first()) work();
    });
  }

  // simulation.cpp: from the first step to the last.
  void make_ready();
  void begin();
  bool carry();
  void release(double time);
  bool is_output(double time) const {
    return std::find(case_.output.times.begin(), case_.output.times.end(), time) != case_.output.times.end();
  }
  bool finish();
  void end();
  void sum_up();
  RunSummary as_told() const;
  std::vector<std::pair<double, FrameNumbers>> frames_as_told() const;
  /// Null where nobody has said when.
  const base::AbandonWanted* abandon_wanted() const { return abandon_wanted_ ? &abandon_wanted_ : nullptr; }

  // run_outputs.cpp: what an output shows.
  DensityOptions density_options() const;
  Cutoff blob() const;
  void place(double from);
  double mass() const;
  std::vector<double> velocity_at_particles(double time, bool wanted) const;
  void check_density_seconds() const;
  void plan_reference();
  const Particles& summed(Particles& images) const;
  const Particles& images_agreed(Particles& images) const;
  DensityGrid sum_density(DensityReport& report);
  DensityGrid sum_tiles(DensityReport& report);
  std::vector<FieldOnGrid> fields_of_piece(double time, const LatticeBox& box, std::vector<double>& values) const;
  DensityGrid sum_in_pieces(Frame& frame, DensityReport& report);
  // tracer_outputs.cpp: the same of each named density.
  std::vector<TracerNumbers> count_tracers() const;
  DensityGrid sum_unless_tracers_do(DensityReport& report);
  void sum_tracers(double time, DensityGrid& density, std::vector<TracerNumbers>& numbers, DensityReport& whole);

  // run_outputs.cpp again.
  bool show_or_abandon(double time);
  void forget_output();
  void show_frame(double time);
  bool somebody_needs_particles(const Frame& frame) const;
  Counted counted() const {
    return {case_.domain.counts_inside() || carrier_.departures().possible(), releases_.possible(),
            case_.domain.coast == AtCoast::stop, !case_.tracers.empty(), checks_fields(case_.checks)};
  }
  bool in_pieces() const { return pieces_.count() > 1; }
  /// A formula is evaluated wherever a piece is. Paths are followed from points of the thinned grid alone.
  bool compares_pieces() const {
    return in_pieces() && compared_.points >= scene_.evaluation.size() &&
           case_.reference.kind == ReferenceSpec::Kind::exact;
  }
  void compare_with_reference(const DensityGrid& density, Frame& frame, std::vector<double>& exact);
  ReferenceReport compare_thinned(const DensityGrid& density, Frame& frame, std::vector<double>& exact);
  void judge_norms(const std::vector<double>& exact, FrameNumbers& numbers) const;

  // run_moments.cpp: frames of an animation.
  void plan_moments();
  bool is_moment(double time) const;
  bool is_landing_of_case(double time) const;
  bool moment_has_fields() const;
  DensityGrid sum_moment(DensityReport& report);
  void add_tracers_of_moment(DensityGrid& density);  // tracer_outputs.cpp
  void show_moment(double time);
  bool show_moment_or_abandon(double time);

  // run_follow.cpp: tracks, and fields of the particles.
  void look_at_tracks(bool landed);
  void check_particle_fields() const;
  bool shows_where_particles_began() const;
  void hand_out_pieces(const Frame& frame, const std::vector<double>& velocity);
  std::vector<FieldOnGrid> add_particle_fields(const Frame& frame, DensityGrid& density) const;
  std::vector<FieldOnGrid> for_files_of_particles(const Particles& particles) const;
  ParticlesThere there(const Particles& particles, double time) const;

  // run_state.cpp: what the run has come to, for another process that goes on.
  void pass_outputs(base::StateBytes& bytes);
  std::vector<std::string> outputs();
  void take_outputs(const std::vector<std::string>& all);
  std::vector<double> landed_on() const;
  void pass_state(base::StateBytes& bytes, std::uint64_t format, ObserverStates& seen);
  void check_leg() const;
  void check_frames() const;
  void take_particles(Particles particles);
  void plan_landings();
  void take_up(const ObserverStates& seen);
  void take_up_outputs(const ObserverStates& seen);
  std::size_t steps_to_end() const;

  const Case case_;
  int threads_;
  base::Communicator alone_;
  base::Communicator& ranks_;
  Placement place_;
  std::optional<double> placed_at_;  // the time of the particles when they were placed
  base::AbandonWanted abandon_wanted_;
  Scene scene_;
  Carrier carrier_;
  Releases releases_;
  Tracks tracks_;
  std::vector<double> landings_;
  std::vector<double> of_case_, moments_;  // landings without frames of an animation, and these
  std::uint64_t moments_shown_ = 0;
  double last_moment_ = -1;      // elapsed
  bool showing_moment_ = false;  // what is summed now is a frame
  bool tracer_alone_ = false;    // what is summed now is a named density, without derivatives
  double part_of_spread_ = 1;    // that its blobs have
  LatticePieces pieces_;         // of the evaluation lattice
  Particles particles_;
  std::unique_ptr<Reference> reference_;  // null for none
  bool shares_reference_ = false;
  SeedReport seeding_;
  double seed_seconds_ = 0, mass_at_start_ = 0, beyond_at_start_ = 0;
  double largest_at_start_ = 0;  // of |rho_0| on the lattice
  Comparison compared_;

  // How far the run is. `leg_` leads to landings_[landed_].
  enum class Stage { made, prepared, under_way, ended } stage_ = Stage::made;
  std::size_t landed_ = 0, steps_before_ = 0, steps_total_ = 0;
  int index_ = 0;  // of the next output
  Carrier::Leg leg_;
  struct {
    std::size_t frames = 0;
    ReferenceReport reference;
    std::string carrier;  // effects count what they do
  } before_output_;
  double seconds_before_ = 0;  // of earlier calls of run()
  base::Stopwatch watch_;
  RunSummary summary_;  // its outputs by elapsed times
};

/// The numbers of an output, to be kept or told.
void pass(base::StateBytes& bytes, FrameNumbers& numbers, Counted counted);
void pass_fields(base::StateBytes& bytes, std::vector<FieldNumbers>& fields);
void pass_tracers(base::StateBytes& bytes, std::vector<TracerNumbers>& tracers);

}  // namespace gaussdrift
