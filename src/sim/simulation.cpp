#include "gaussdrift/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "base/has_one.hpp"
#include "base/parallel.hpp"
#include "base/seam.hpp"
#include "base/state_bytes.hpp"
#include "base/stopwatch.hpp"
#include "effect/catalogue.hpp"
#include "field/velocity/value_seconds.hpp"
#include "gaussdrift/error.hpp"
#include "reference/norms.hpp"
#include "reference/reference.hpp"
#include "reference/sample.hpp"
#include "sim/carrier.hpp"
#include "sim/checks.hpp"
#include "sim/comparison.hpp"
#include "sim/landings.hpp"
#include "sim/outside.hpp"
#include "sim/placement.hpp"
#include "sim/scene.hpp"
#include "sim/shared_reference.hpp"
#include "sim/stable_step.hpp"
#include "sim/stepper.hpp"
#include "sim/tiled_density.hpp"
#include "sim/transform.hpp"
#include "sim/work.hpp"

namespace gaussdrift {

namespace {

/// What a particle adds to the sums of a frame.
enum Addend : std::size_t { mass, weight, outside, centroid, addends = centroid + max_dimension };

FrameNumbers measure_particles(const Particles& particles, const Domain& domain, const Placement& place, int threads) {
  const std::vector<double> sums = place.sums(particles, addends, threads, [&](std::size_t j, double* of_particle) {
    const double alpha = particles.alpha[j];
    of_particle[mass] = alpha;
    of_particle[weight] = std::abs(alpha);
    of_particle[outside] = is_outside(particles, j, domain) ? std::abs(alpha) : 0;
    for (int k = 0; k < max_dimension; ++k)
      of_particle[centroid + static_cast<std::size_t>(k)] =
          k < particles.dimension ? alpha * particles.position[k][j] : 0;
  });
  FrameNumbers numbers;
  numbers.mass = sums[mass];
  numbers.weight = sums[weight];
  numbers.outside = sums[weight] > 0 ? sums[outside] / sums[weight] : 0;
  // Where positive and negative weights cancel there is no centre of mass.
  const bool cancelled = std::abs(numbers.mass) <= 1e-12 * numbers.weight;
  for (int k = 0; k < particles.dimension; ++k)
    numbers.centroid[k] = cancelled ? std::numeric_limits<double>::quiet_NaN()
                                    : sums[centroid + static_cast<std::size_t>(k)] / numbers.mass;
  return numbers;
}

/// What keeps ranks from sharing a case, for the user; empty: nothing.
std::string why_not_shared(const Case& spec, const VelocityField& velocity) {
  for (const auto& [effect, values] : effects_of(spec.effects)) {
    const EffectTraits& traits = effect->traits;
    const int dimension = spec.domain.dimension;
    const bool by_widths = effect->spreading && effect->spreading(values) > 0;  // each blob spreads by itself
    if (traits.particles_interact || traits.adds_particles.of(values, dimension) ||
        traits.replaces_particles.of(values, dimension) || (traits.moves_weight.of(values, dimension) && !by_widths))
      return fmt::format("[effects.{}] needs all particles in one process", values.name);
  }
  return velocity.evaluates_in_blocks() ? "" : "this velocity is evaluated at all particles at once";
}

// Numbers of an output, one by one: a new one must not be forgotten here.
void pass(base::StateBytes& bytes, FrameNumbers& n) {
  static_assert(sizeof(FrameNumbers) == 152 + sizeof(std::string), "a number is not passed yet");
  bytes(n.mass, n.minimum, n.maximum, n.centroid, n.transform_error, n.transform_tolerance, n.evaluate_seconds,
        n.seconds, n.stretch, n.weight, n.outside, n.error, n.no_norms, n.compared, n.untraced);
}

void pass(base::StateBytes& bytes, Comparison& plan) {
  bytes(plan.points, plan.following.most_steps, plan.following.by_half_steps, plan.word, plan.left_out);
}

void summarise_effects(const Effects& effects, const Scene& scene, RunSummary& summary) {
  summary.effects.push_back({"transport",
                             summary.stages.of("transport"),
                             "X' = u(X, t), " + scene.velocity->describe(),
                             "every weight",
                             {"position"},
                             {},
                             ""});
  for (const auto& effect : effects) {
    EffectSummary row{effect->name(),
                      summary.stages.of("effect " + effect->name()),
                      effect->describe(),
                      effect->conserves(),
                      {},
                      effect->numbers(),
                      effect->warning()};
    const Changes changes = effect->changes();
    if (changes.position) row.changes.emplace_back("position");
    if (changes.weight) row.changes.emplace_back("weight");
    if (changes.width) row.changes.emplace_back("width");
    if (changes.particles) row.changes.emplace_back("particles");
    summary.effects.push_back(std::move(row));
  }
}

DensityOptions density_options(const EvaluateSpec& evaluate, int dimension, int threads) {
  DensityOptions options;
  options.tolerance = evaluate.tolerance;
  options.method = evaluate.method;
  options.threads = threads;
  options.tiles = usual_tiles(dimension);
  if (evaluate.tile_particles > 0) options.tiles->particles = static_cast<std::int64_t>(evaluate.tile_particles);
  return options;
}

/// A function as an observer.
class FunctionObserver : public Observer {
 public:
  FunctionObserver(std::string name, std::function<void(const Frame&)> see)
      : name_(std::move(name)), see_(std::move(see)) {}
  std::string name() const override { return name_; }
  void frame(const Frame& frame) override { see_(frame); }

 private:
  std::string name_;
  std::function<void(const Frame&)> see_;
};

// What every step makes sure of, of particles that come from elsewhere.
bool all_finite(const Particles& particles) {
  const auto finite = [](const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
  };
  return std::all_of(particles.position.begin(), particles.position.end(), finite) && finite(particles.alpha) &&
         std::all_of(particles.path.begin(), particles.path.end(), finite) && finite(particles.volume);
}

}  // namespace

class Simulation::Parts {
 public:
  Parts(const Case& spec, int threads, base::Communicator* ranks)
      : case_(spec),
        threads_(base::resolve_threads(threads)),
        ranks_(ranks ? *ranks : alone_),
        place_(ranks_),
        scene_(make_scene(case_, threads_)),
        carrier_(case_, scene_, threads_, ranks_),
        landings_(landings(case_)) {
    if (ranks_.size() == 1) return;
    if (const std::string why = why_not_shared(case_, *scene_.velocity); !why.empty())
      throw InputError(
          fmt::format("{}, so that {} ranks cannot share this case; start it on one rank", why, ranks_.size()));
  }

  void prepare();
  void restore(Particles particles, const std::string& bytes);
  std::string state();
  RunSummary summary();
  RunSummary run();
  const Particles& particles() const { return particles_; }
  Particles all_particles() const { return gather_particles(particles_, ranks_); }
  std::size_t particle_count() const;
  bool compares_everywhere() const { return reference_ && compared_.points >= scene_.evaluation.size(); }
  double rough_seconds() const {
    constexpr double seconds_of_a_unit = 40e-9;  // work.hpp
    return seconds_of_a_unit * work_of(case_, scene_, particle_count()).total();
  }

  void abandon_when(std::function<bool()> wanted) {
    abandon_wanted_ = std::move(wanted);
    carrier_.abandon_when(abandon_wanted());
  }

  std::vector<std::unique_ptr<Observer>> observers;
  std::function<bool(const Progress&)> go_on;

 private:
  using ObserverStates = std::vector<std::pair<std::string, std::string>>;  // name and state

  void begin();
  void pass_state(base::StateBytes& bytes, ObserverStates& seen);
  void check_leg() const;
  void check_frames() const;
  void plan_landings();
  void take_up(const ObserverStates& seen);
  void take_up_outputs(const ObserverStates& seen);
  std::size_t steps_to_end() const;
  std::vector<double> velocity_at_particles(double time, bool wanted) const;
  void plan_reference();
  void check_density_seconds() const;
  Cutoff blob() const;
  void place(double from);
  DensityGrid sum_density(DensityReport& report);
  DensityGrid sum_tiles(DensityReport& report);
  template <class Work>
  void on_first(const Work& work) const {
    ranks_.agree_on([&] {
      if (place_.is_first()) work();
    });
  }
  /// Ranks do not agree at seams yet: where there are several, what is under way is finished.
  const base::AbandonWanted* abandon_wanted() const {
    return abandon_wanted_ && ranks_.size() == 1 ? &abandon_wanted_ : nullptr;
  }
  void make_ready();
  bool carry();
  bool show_or_abandon(double time);
  void forget_output();
  void show_frame(double time);
  bool somebody_needs_particles(double time) const;
  void tell_all(FrameNumbers& numbers) const;
  std::string told_by_first(const std::string& text) const;
  void compare_with_reference(const DensityGrid& density, Frame& frame, std::vector<double>& exact);
  void judge_norms(const std::vector<double>& exact, FrameNumbers& numbers) const;
  bool finish();
  bool is_output(double time) const {
    return std::find(case_.output.times.begin(), case_.output.times.end(), time) != case_.output.times.end();
  }
  void end();
  void sum_up();

  const Case case_;
  int threads_;
  base::Communicator alone_;
  base::Communicator& ranks_;
  Placement place_;
  base::AbandonWanted abandon_wanted_;
  Scene scene_;
  Carrier carrier_;
  std::vector<double> landings_;
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
  RunSummary summary_;
};

void Simulation::Parts::prepare() {
  if (stage_ != Stage::made) return;
  try {
    const base::Abandonable while_it_lasts(abandon_wanted());
    make_ready();
  } catch (const base::Abandoned&) {
    throw Abandoned();
  }
}

void Simulation::Parts::make_ready() {
  const base::Stopwatch seeding;
  particles_ = seed_scene(scene_, threads_, &seeding_, ranks_);
  seed_seconds_ = seeding.seconds();
  place(0);
  mass_at_start_ = measure_particles(particles_, case_.domain, place_, threads_).mass;
  Heaviest heavy = heaviest(particles_, scene_.seeding);
  heavy = {place_.max(heavy.anywhere), place_.max(heavy.at_edge)};
  largest_at_start_ = heavy.anywhere / std::pow(scene_.seeding.spacing, scene_.seeding.dimension);
  beyond_at_start_ = part_beyond(scene_.density->mass(), heavy, mass_at_start_);
  const Particles sample = place_.sample(particles_, sampled_particles);
  ranks_.agree_on([&] { carrier_.begin(particles_, sample); });
  ranks_.agree_on([&] { velocity_at_particles(0, false); });
  check_density_seconds();
  plan_reference();
  stage_ = Stage::prepared;
}

// Paths are shared; a formula is quick on rank 0.
void Simulation::Parts::plan_reference() {
  on_first([&] { compared_ = plan_comparison(case_, scene_, particle_count(), threads_); });
  base::StateBytes said;
  pass(said, compared_);
  const std::string told = told_by_first(said.written());
  base::StateBytes heard(told);
  pass(heard, compared_);
  shares_reference_ = ranks_.size() > 1 && case_.reference.kind == ReferenceSpec::Kind::characteristics;
  if (compared_.points == 0 || !(place_.is_first() || shares_reference_)) return;
  Following following = compared_.following;
  if (shares_reference_)
    following.rank = static_cast<std::size_t>(ranks_.rank()), following.ranks = static_cast<std::size_t>(ranks_.size());
  reference_ = make_reference(case_, scene_, threads_, following);
  if (shares_reference_) reference_ = shared_reference(std::move(reference_), scene_.evaluation, ranks_);
}

std::size_t Simulation::Parts::particle_count() const { return place_.particle_count(); }

Cutoff Simulation::Parts::blob() const {
  return particles_.spread > 0 ? spread_cutoff(scene_.cutoff, particles_.dimension, particles_.spread) : scene_.cutoff;
}

// Particles to the ranks that carry them from `from` to the next landing, and sum the density at `from`.
void Simulation::Parts::place(double from) {
  const DensityOptions options = density_options(case_.evaluate, case_.domain.dimension, threads_);
  Tiles tiles = tiles_of(particles_, blob(), scene_.evaluation, options,
                         [&](std::vector<std::int64_t>& counts) { ranks_.sum(counts); });
  const auto next = std::upper_bound(landings_.begin(), landings_.end(), from);
  const double to = next == landings_.end() ? from : *next;
  const double steps =
      carrier_.is_adaptive() ? 20 : static_cast<double>(time::Interval(from, to, case_.time.step).steps());
  const double carrying = steps * time::find_tableau(case_.time.method).stages * value_seconds(*scene_.velocity);
  // Of a particle and a grid point in a Gauss transform, roughly; bench_tiles shows how evenly ranks are loaded.
  const double of_particle = scene_.evaluation.dimension == 2 ? 0.13e-6 : 0.35e-6, of_point = 12e-9;
  place_.renew(particles_, std::move(tiles), [&](const Tile& tile) {
    const auto particles = static_cast<double>(tile.particles), points = static_cast<double>(tile.size());
    return particles * (carrying + of_particle) + (tile.particles > 0 ? of_point : 0.1 * of_point) * points;
  });
}

// [j][dimension], or nothing if only looked at. Throws NumericalError where the field is not finite.
std::vector<double> Simulation::Parts::velocity_at_particles(double time, bool wanted) const {
  const auto dimension = static_cast<std::size_t>(particles_.dimension);
  const std::size_t count = particles_.size();
  std::vector<double> columns(count * dimension, 0.0), velocity;
  VectorsView u{particles_.dimension, count, {}};
  for (std::size_t k = 0; k < dimension; ++k) u.axis[k] = columns.data() + k * count;
  add_flow_and_drifts(*scene_.velocity, carrier_.drifts(), time, particles_, particles_.view(), u, threads_);
  check_velocity(*scene_.velocity, particles_, u, time, steps_before_);
  if (!wanted) return velocity;
  velocity.resize(count * dimension);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t k = 0; k < dimension; ++k) velocity[j * dimension + k] = u.axis[k][j];
  return velocity;
}

// To the next landing time; false if the run is to stop before.
bool Simulation::Parts::carry() {
  bool wanted = true;
  const bool arrived = carrier_.carry(particles_, leg_, steps_before_, summary_.stages, [&](const Carrier::Leg& leg) {
    if (!go_on) return true;
    double stepping = summary_.stages.of("transport");
    for (const auto& effect : carrier_.effects()) stepping += summary_.stages.of("effect " + effect->name());
    wanted = go_on({steps_before_ + leg.steps, steps_total_, leg.now, case_.time.end,
                    seconds_before_ + watch_.seconds(), stepping});
    return wanted;
  });
  return arrived && wanted;
}

// The density at the start stands for all: a run that has begun is not stopped.
void Simulation::Parts::check_density_seconds() const {
  const EvaluateSpec& evaluate = case_.evaluate;
  if (!limits_seconds(evaluate)) return;
  const auto predicted = [&](const std::string& method) {
    DensityOptions options = density_options(evaluate, case_.domain.dimension, threads_);
    options.method = method;
    return predict_density(particles_, scene_.cutoff, scene_.evaluation, options);
  };
  ranks_.agree_on([&] {
    check_seconds(evaluate, predicted(evaluate.method), base::resolve_threads(threads_),
                  [&] { return predicted("auto"); });
  });
}

// On rank 0 the whole of it.
DensityGrid Simulation::Parts::sum_density(DensityReport& report) {
  if (!place_.one_tile()) return sum_tiles(report);
  DensityGrid density;
  on_first([&] {
    density = evaluate_at_once(particles_, blob(), scene_.evaluation,
                               density_options(case_.evaluate, case_.domain.dimension, threads_), &report);
  });
  return density;
}

DensityGrid Simulation::Parts::sum_tiles(DensityReport& report) {
  const Particles felt = felt_from_elsewhere(particles_, place_.tiles(), place_.owner(), ranks_);
  const std::vector<TileDensity> own =
      evaluate_tiles({particles_, felt}, place_.tiles(), place_.owned(), blob(), scene_.evaluation,
                     density_options(case_.evaluate, case_.domain.dimension, threads_), ranks_, report);
  DensityGrid density{scene_.evaluation, {}};
  const auto& tiles = place_.tiles().list();
  if (place_.is_first()) density.rho.resize(scene_.evaluation.size());
  std::vector<double> values;  // of the others, tile after tile
  for (const auto& [tile, rho] : own)
    if (place_.is_first())
      gaussdrift::place(rho, tiles[tile], scene_.evaluation, density.rho);
    else
      values.insert(values.end(), rho.begin(), rho.end());
  const std::vector<base::Bytes> arrived = ranks_.gather(base::to_bytes(values));
  if (!place_.is_first()) return density;
  std::vector<std::size_t> read(arrived.size(), 0);
  std::vector<double> rho;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    const auto from = static_cast<std::size_t>(place_.owner()[tile]);
    if (from == 0) continue;
    const std::size_t bytes = tiles[tile].size() * sizeof(double);
    rho = base::from_bytes<double>(std::span(arrived[from]).subspan(read[from], bytes));
    read[from] += bytes;
    gaussdrift::place(rho, tiles[tile], scene_.evaluation, density.rho);
  }
  return density;
}

// Particles and velocities of all ranks, by id.
std::pair<Particles, std::vector<double>> gathered(const Particles& particles, const std::vector<double>& velocity,
                                                   base::Communicator& ranks) {
  const auto dimension = static_cast<std::size_t>(particles.dimension);
  Particles carrying = particles;  // velocities travel as further integrals
  const std::size_t integrals = carrying.path.size();
  for (std::size_t k = 0; k < dimension; ++k) {
    std::vector<double>& column = carrying.path.emplace_back(particles.size());
    for (std::size_t j = 0; j < column.size() && !velocity.empty(); ++j) column[j] = velocity[j * dimension + k];
  }
  Particles all = gather_particles(carrying, ranks);
  std::vector<double> of_all(all.size() * dimension);
  for (std::size_t j = 0; j < all.size(); ++j)
    for (std::size_t k = 0; k < dimension; ++k) of_all[j * dimension + k] = all.path[integrals + k][j];
  all.path.resize(integrals);
  return {std::move(all), std::move(of_all)};
}

// False if it was abandoned. A run that goes on from state() shows it again.
bool Simulation::Parts::show_or_abandon(double time) {
  if (abandon_wanted()) {
    base::StateBytes carrier;
    carrier_.pass_state(carrier, particles_);
    before_output_ = {summary_.frames.size(), summary_.reference, carrier.written()};
  }
  try {
    const base::Abandonable while_it_lasts(abandon_wanted());
    show_frame(time);
    return true;
  } catch (const base::Abandoned&) {
    forget_output();
    return false;
  }
}

void Simulation::Parts::forget_output() {
  summary_.frames.resize(before_output_.frames);
  index_ = static_cast<int>(before_output_.frames);
  summary_.reference = before_output_.reference;
  base::StateBytes carrier(before_output_.carrier);
  carrier_.pass_state(carrier, particles_);
}

void Simulation::Parts::show_frame(double time) {
  DensityReport report;
  place(time);
  const DensityGrid density = sum_density(report);
  summary_.stages.add("density", report.evaluate_seconds);
  summary_.stages.add("measure transform error", report.measure_seconds);
  summary_.transform_choice = report.choice;
  summary_.transform_achievable = std::max(summary_.transform_achievable, report.achievable);

  const bool velocity_wanted = base::has_one(case_.output.files, &OutputFile::needs_velocity);
  std::vector<double> velocity;
  ranks_.agree_on([&] { velocity = velocity_at_particles(time, velocity_wanted); });

  Frame frame;
  frame.index = index_++;
  frame.time = time;
  frame.numbers = measure_particles(particles_, case_.domain, place_, threads_);
  if (!carrier_.replaces_particles()) frame.numbers.stretch = largest_stretch(particles_, scene_.seeding, ranks_);
  const bool elsewhere = ranks_.size() > 1 && !place_.one_tile() && somebody_needs_particles(time);
  std::pair<Particles, std::vector<double>> all;
  if (elsewhere) all = gathered(particles_, velocity, ranks_);
  frame.particles = elsewhere ? &all.first : &particles_;
  frame.velocity = !velocity_wanted ? nullptr : elsewhere ? &all.second : &velocity;
  frame.density = &density;
  std::vector<double> exact;
  const auto compare = [&] {
    if (reference_) summary_.stages.run("reference", [&] { compare_with_reference(density, frame, exact); });
  };
  if (shares_reference_)
    compare();
  else
    on_first(compare);
  on_first([&] {
    const auto [low, high] = std::minmax_element(density.rho.begin(), density.rho.end());
    frame.numbers.minimum = *low;
    frame.numbers.maximum = *high;
    frame.numbers.transform_error = report.measured_error;
    frame.numbers.transform_tolerance = report.requested_tolerance;
    frame.numbers.evaluate_seconds = report.evaluate_seconds;
    frame.numbers.seconds = seconds_before_ + watch_.seconds();
  });
  tell_all(frame.numbers);
  summary_.frames.emplace_back(time, frame.numbers);
  on_first([&] {
    for (const auto& observer : observers) {
      base::seam();
      summary_.stages.run(observer->name(), [&] { observer->frame(frame); });
    }
  });
}

bool Simulation::Parts::somebody_needs_particles(double time) const {
  std::int64_t needed = std::any_of(observers.begin(), observers.end(),
                                    [&](const auto& observer) { return observer->needs_particles(time); });
  ranks_.max(std::span(&needed, 1));
  return needed != 0;
}

// All ranks know what is known of the outputs, and judge the run alike.
void Simulation::Parts::tell_all(FrameNumbers& numbers) const {
  base::StateBytes said;
  pass(said, numbers);
  const std::string told = told_by_first(said.written());
  base::StateBytes heard(told);
  pass(heard, numbers);
}

std::string Simulation::Parts::told_by_first(const std::string& text) const {
  base::Bytes bytes = base::to_bytes(std::span<const char>(text));
  ranks_.broadcast(bytes);
  const auto letters = base::from_bytes<char>(bytes);
  return {letters.begin(), letters.end()};
}

// On the whole grid, or on a sample of it. The density is on rank 0, and so is what comes out.
void Simulation::Parts::compare_with_reference(const DensityGrid& density, Frame& frame, std::vector<double>& exact) {
  ReferenceReport traced;
  if (compared_.points >= scene_.evaluation.size()) {
    traced = reference_->evaluate(frame.time, exact);
    if (!place_.is_first()) return;
    frame.exact = &exact;
    frame.numbers.error = compare(density.rho, exact);
    frame.numbers.compared = density.rho.size();
  } else {
    GridSample sample;
    if (place_.is_first()) sample = sample_of_grid(scene_.evaluation, density.rho, compared_.points);
    traced = reference_->evaluate_at(frame.time, sample.points, exact);
    if (!place_.is_first()) return;
    frame.numbers.error = compare(density.rho, sample, exact);
    frame.numbers.compared = sample.points.size();
  }
  frame.numbers.untraced = traced.untraced;
  judge_norms(exact, frame.numbers);
  if (summary_.reference.untraced == 0)
    summary_.reference = traced;
  else
    summary_.reference.untraced += traced.untraced;
}

// Norms are relative to the exact density. They mean nothing where that is nearly 0.
void Simulation::Parts::judge_norms(const std::vector<double>& exact, FrameNumbers& numbers) const {
  double largest = -1;
  for (const double value : exact) largest = std::max(largest, std::abs(value));  // not of NaN
  if (largest < 0) {
    numbers.no_norms = "the exact density is not known anywhere";
  } else if (largest == 0 || (is_all(numbers.outside) && is_nothing(largest, largest_at_start_))) {
    numbers.no_norms = why_nothing_is_left(numbers.outside, numbers.weight);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    numbers.error = ErrorNorms{nan, nan, nan};
  }
}

// What is known before the first step.
void Simulation::Parts::begin() {
  steps_total_ = total_steps(case_);
  seconds_before_ = seed_seconds_;  // before the watch of run()
  summary_.threads = threads_;
  summary_.transform_tolerance = case_.evaluate.tolerance;
  summary_.stages.add("seed", seed_seconds_);
  summary_.lattice_points = scene_.seeding.size();
  summary_.particles = particle_count();
  summary_.seeding = seeding_;
  summary_.beyond_at_start = beyond_at_start_;
  summary_.grid_points = scene_.evaluation.size();
  summary_.spacing = scene_.seeding.spacing;
  summary_.core_radius = scene_.core_radius;
  leg_ = {0, landings_.front(), 0, 0};
  stage_ = Stage::under_way;
}

// A state may be a stranger's: numbers that count steps, and those that index, are looked at before they are used.
void Simulation::Parts::check_leg() const {
  constexpr double most_steps = 1e15;  // so that they can be counted
  const bool countable = carrier_.is_adaptive() || (leg_.to - leg_.from) / case_.time.step < most_steps;
  if (!(leg_.from >= 0 && leg_.from <= leg_.now && leg_.now <= leg_.to && std::isfinite(leg_.to) && countable))
    throw std::out_of_range("its times are wrong");
}

void Simulation::Parts::check_frames() const {
  double last = 0;
  for (const auto& [time, numbers] : summary_.frames) {
    if (!(time >= last && time <= leg_.now)) throw std::out_of_range("the times of its outputs are wrong");
    last = time;
  }
  if (index_ < 0 || static_cast<std::size_t>(index_) != summary_.frames.size())
    throw std::out_of_range("its outputs are not as many as it counts");
}

// What the run has come to, beside the particles.
void Simulation::Parts::pass_state(base::StateBytes& bytes, ObserverStates& seen) {
  bytes(leg_, steps_before_, index_);
  if (bytes.reading()) check_leg();
  carrier_.pass_state(bytes, particles_);
  bytes(summary_.transform_choice, summary_.transform_achievable);
  std::uint64_t frames = summary_.frames.size();
  bytes(frames);
  if (bytes.reading()) summary_.frames.clear();
  for (std::uint64_t i = 0; i < frames; ++i) {
    if (bytes.reading()) summary_.frames.emplace_back();
    bytes(summary_.frames[i].first);
    pass(bytes, summary_.frames[i].second);
  }
  ReferenceReport& traced = summary_.reference;
  if (bytes.reading()) check_frames();
  bytes(traced.untraced, traced.first_untraced, traced.trouble, traced.rates, traced.exhausted);
  auto stages = summary_.stages.stages();
  double seconds = seconds_before_ + watch_.seconds();
  bytes(stages, seconds, seen);
  bytes.end();
  if (!bytes.reading()) return;
  summary_.stages = {};
  for (const auto& [stage, spent] : stages) summary_.stages.add(stage, spent);
  seconds_before_ = seconds;
}

// Observers as they were after the outputs so far.
void Simulation::Parts::take_up_outputs(const ObserverStates& seen) {
  for (const auto& observer : observers) {
    const auto same =
        std::find_if(seen.begin(), seen.end(), [&](const auto& other) { return other.first == observer->name(); });
    observer->restore(summary_.frames, same == seen.end() ? std::string() : same->second);
  }
}

std::string Simulation::Parts::state() {
  ObserverStates seen;
  for (const auto& observer : observers) seen.emplace_back(observer->name(), observer->state());
  base::StateBytes bytes;
  pass_state(bytes, seen);
  return bytes.written();
}

// From where the particles are. The end of the leg under way is kept, because its steps lead there; only an earlier
// output may shorten it.
void Simulation::Parts::plan_landings() {
  std::vector<double> later;
  for (const double landing : landings(case_))
    if (landing > leg_.now) later.push_back(landing);
  const bool arrived = leg_.now >= leg_.to;
  if (leg_.now > case_.time.end || (!arrived && later.empty()))
    throw InputError(fmt::format("time.end = {:g} lies before t = {:g}, where the run is", case_.time.end, leg_.now));
  if (!arrived && later.front() < leg_.to) {
    if (carrier_.acts_between_steps())
      throw InputError(fmt::format(
          "the next output has to stay at t = {:g}, because an effect of this case has begun what ends there. "
          "Outputs after it may change.",
          leg_.to));
    leg_.to = later.front();
  }
  // An output at the end of the leg is shown by run(), perhaps again.
  while (arrived && !summary_.frames.empty() && summary_.frames.back().first >= leg_.to) {
    summary_.frames.pop_back();
    --index_;
  }
  landings_.assign(1, leg_.to);
  for (const double landing : later)
    if (landing > leg_.to) landings_.push_back(landing);
  landed_ = 0;
}

std::size_t Simulation::Parts::steps_to_end() const {
  if (carrier_.is_adaptive()) return 0;
  std::size_t steps = steps_before_;
  double from = leg_.from;
  for (std::size_t i = landed_; i < landings_.size(); ++i) {
    steps += time::Interval(from, landings_[i], case_.time.step).steps();
    from = landings_[i];
  }
  return steps;
}

void Simulation::Parts::restore(Particles particles, const std::string& bytes) {
  if (stage_ != Stage::made && stage_ != Stage::prepared)
    throw std::logic_error("Simulation::restore(): this run has begun");
  prepare();
  begin();
  const auto misfit = [](const std::string& what) { return InputError("the state is not one of this case: " + what); };
  ranks_.agree_on([&] {
    if (!place_.is_first()) return;
    if (particles.size() == 0) throw misfit("it has no particles");
    if (particles.dimension != particles_.dimension || particles.path.size() != particles_.path.size() ||
        (particles_.size() > 0 && particles.volume.empty() != particles_.volume.empty()))
      throw misfit("it has other particles");
    if (!all_finite(particles)) throw misfit("a number of its particles is not finite");
  });
  if (place_.is_first()) {
    particles_ = std::move(particles);
  } else {
    const std::size_t integrals = particles_.path.size();
    particles_ = {};
    particles_.dimension = scene_.seeding.dimension;
    particles_.path.resize(integrals);
  }
  particles_.spread = place_.max(particles_.spread);
  const std::string of_all = told_by_first(bytes);
  ObserverStates seen;
  ranks_.agree_on([&] {
    try {
      base::StateBytes state(of_all);
      pass_state(state, seen);
      plan_landings();
      if (!carrier_.has_steps_until(leg_.now)) throw misfit("it has other steps");
    } catch (const std::out_of_range& error) {
      throw misfit(error.what());
    }
  });
  place(leg_.now);
  try {
    const base::Abandonable while_it_lasts(abandon_wanted());
    take_up(seen);
  } catch (const base::Abandoned&) {
    throw Abandoned();
  }
  steps_total_ = steps_to_end();
}

// Observers and reference as they were after the outputs so far.
void Simulation::Parts::take_up(const ObserverStates& seen) {
  const auto misfit = [](const std::string& what) { return InputError("the state is not one of this case: " + what); };
  on_first([&] {
    try {
      take_up_outputs(seen);
    } catch (const std::out_of_range& error) {  // in an observer
      throw misfit(error.what());
    }
  });
  std::vector<double> times;
  for (const auto& [time, numbers] : summary_.frames) times.push_back(time);
  if (compared_.points >= scene_.evaluation.size())
    ranks_.agree_on([&] {
      if (reference_) reference_->pass(times);
    });
}

RunSummary Simulation::Parts::run() {
  if (stage_ == Stage::ended) throw std::logic_error("Simulation::run(): this run has ended");
  prepare();
  const bool begins = stage_ == Stage::prepared;
  watch_ = base::Stopwatch();
  if (begins) begin();
  stage_ = Stage::ended;  // if something is thrown
  bool wanted = true, shown = true;
  while (wanted && landed_ < landings_.size()) {
    wanted = carry();
    if (leg_.now < leg_.to) break;
    if (is_output(leg_.to)) shown = show_or_abandon(leg_.to);
    if (!shown) break;
    if (++landed_ == landings_.size()) break;
    steps_before_ += leg_.steps;
    leg_ = {leg_.to, landings_[landed_], 0, leg_.to};
  }
  const bool arrived = landed_ == landings_.size();
  summary_.complete = arrived && finish();
  if (shown && !arrived) stage_ = Stage::under_way;
  end();
  return summary_;
}

// False if it was abandoned. A run that goes on from state() then shows the last output again, if it is of this time.
bool Simulation::Parts::finish() {
  try {
    const base::Abandonable while_it_lasts(abandon_wanted());
    on_first([&] {
      for (const auto& observer : observers) {
        base::seam();
        summary_.stages.run(observer->name(), [&] { observer->finish(); });
      }
    });
    return true;
  } catch (const base::Abandoned&) {
    if (is_output(leg_.to)) forget_output();
    return false;
  }
}

// What is known after the last step so far.
void Simulation::Parts::end() {
  sum_up();
  seconds_before_ = summary_.seconds;
  watch_ = base::Stopwatch();
}

void Simulation::Parts::sum_up() {
  summary_.time = leg_.now;
  summary_.checks = judge(case_.checks, mass_at_start_, summary_.frames);
  summary_.steps = steps_before_ + leg_.steps;
  summary_.steps_rejected = carrier_.steps_rejected();
  summary_.warnings = carrier_.warnings();
  if (!compared_.left_out.empty()) summary_.warnings.push_back(compared_.left_out);
  summary_.reference_word = compared_.word;
  summary_.effects.clear();
  summarise_effects(carrier_.effects(), scene_, summary_);
  summary_.seconds = seconds_before_ + watch_.seconds();
}

RunSummary Simulation::Parts::summary() {
  sum_up();
  return summary_;
}

Simulation::Simulation(const Case& spec, int threads) : parts_(std::make_unique<Parts>(spec, threads, nullptr)) {}
Simulation::Simulation(const Case& spec, int threads, base::Communicator& ranks)
    : parts_(std::make_unique<Parts>(spec, threads, &ranks)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

void Simulation::observe(std::unique_ptr<Observer> observer) { parts_->observers.push_back(std::move(observer)); }
void Simulation::observe(const std::string& name, std::function<void(const Frame&)> see) {
  observe(std::make_unique<FunctionObserver>(name, std::move(see)));
}
void Simulation::on_progress(std::function<bool(const Progress&)> go_on) { parts_->go_on = std::move(go_on); }
void Simulation::abandon_when(std::function<bool()> wanted) { parts_->abandon_when(std::move(wanted)); }
void Simulation::prepare() { parts_->prepare(); }
std::string Simulation::state() const { return parts_->state(); }
RunSummary Simulation::summary() const { return parts_->summary(); }
void Simulation::restore(Particles particles, const std::string& state) {
  parts_->restore(std::move(particles), state);
}
RunSummary Simulation::run() { return parts_->run(); }
bool Simulation::compares_everywhere() const { return parts_->compares_everywhere(); }
double Simulation::rough_seconds() const { return parts_->rough_seconds(); }
const Particles& Simulation::particles() const { return parts_->particles(); }
Particles Simulation::all_particles() const { return parts_->all_particles(); }
std::size_t Simulation::particle_count() const { return parts_->particle_count(); }

}  // namespace gaussdrift
