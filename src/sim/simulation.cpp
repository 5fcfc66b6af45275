#include "gaussdrift/simulation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/parallel.hpp"
#include "effect/catalogue.hpp"
#include "field/velocity/sampled_gradients.hpp"
#include "gaussdrift/error.hpp"
#include "sim/borders/outside.hpp"
#include "sim/checks.hpp"
#include "sim/landings.hpp"
#include "sim/piece_comparison.hpp"
#include "sim/run_parts.hpp"
#include "sim/sharing.hpp"
#include "sim/stable_step.hpp"
#include "sim/work.hpp"

namespace gaussdrift {

namespace {

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
    if (changes.neighbours) row.changes.emplace_back("neighbours");
    if (changes.particles) row.changes.emplace_back("particles");
    summary.effects.push_back(std::move(row));
  }
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

}  // namespace

Simulation::Parts::Parts(const Case& spec, int threads, base::Communicator* ranks)
    : case_(spec),
      threads_(base::resolve_threads(threads)),
      ranks_(ranks ? *ranks : alone_),
      place_(ranks_),
      scene_(make_scene(case_, threads_)),
      carrier_(case_, scene_, threads_, ranks_, [this](const Vector& place) { return place_.owner_of(place); }),
      releases_(case_, scene_, threads_),
      tracks_(case_, scene_, threads_, ranks_),
      landings_(landings(case_)),
      pieces_(scene_.evaluation, case_.evaluate.piece_points) {
  plan_moments();
  if (tracks_.wanted()) {
    carrier_.pause_every(tracks_.steps());
    carrier_.departures().watch([this](std::int64_t id) { return tracks_.follows(id); });
  }
  if (in_pieces() && !case_.tracers.empty())
    throw InputError(
        "named densities are summed on the whole grid, and evaluate.piece_points divides it into pieces; raise "
        "evaluate.piece_points, or take a coarser grid");
  if (ranks_.size() == 1) return;
  if (const std::string why = why_not_shared(*scene_.velocity); !why.empty())
    throw InputError(
        fmt::format("{}, so that {} ranks cannot share this case; start it on one rank", why, ranks_.size()));
}

double Simulation::Parts::rough_seconds() const {
  constexpr double seconds_of_a_unit = 40e-9;  // work.hpp
  return seconds_of_a_unit * work_of(case_, scene_, particle_count()).total();
}

void Simulation::Parts::abandon_when(std::function<bool()> wanted) {
  abandon_wanted_ = std::move(wanted);
  carrier_.abandon_when(abandon_wanted());
}

void Simulation::Parts::prepare() {
  if (stage_ != Stage::made) return;
  try {
    const base::AbandonableTogether while_it_lasts(ranks_, abandon_wanted());
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
  mass_at_start_ = mass();
  Heaviest heavy = heaviest(particles_, scene_.seeding);
  heavy = {place_.max(heavy.anywhere), place_.max(heavy.at_edge)};
  largest_at_start_ = heavy.anywhere / scene_.seeding.largest_cell();
  beyond_at_start_ = part_beyond(scene_.density->mass(), heavy, mass_at_start_);
  Particles sample = place_.sample(particles_, sampled_particles);
  releases_.add_places(sample, sampled_particles);
  carrier_.begin(particles_, sample);
  if (tracks_.wanted()) tracks_.check_ids(particles_, releases_.ids_end());
  check_particle_fields();
  velocity_at_particles(0, false);
  check_density_seconds();
  plan_reference();
  stage_ = Stage::prepared;
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
  release(0);
  stage_ = Stage::under_way;
}

// What sources release at `time`, where all particles are.
void Simulation::Parts::release(double time) {
  if (!releases_.possible()) return;
  bool some = false;
  ranks_.agree_on([&] {
    some = releases_.release(particles_, time,
                             [&](const Vector& place) { return place_.owner_of(place) == ranks_.rank(); });
  });
  if (!some) return;
  placed_at_.reset();
  carrier_.placed(particles_);
}

// To the next landing time; false if the run is to stop before.
bool Simulation::Parts::carry() {
  bool wanted = true;
  const bool arrived = carrier_.carry(particles_, leg_, steps_before_, summary_.stages, [&](const Carrier::Leg& leg) {
    if (tracks_.wanted()) tracks_.leave(carrier_.departures().left_lately(), carrier_.departures().reasons());
    if (tracks_.steps() > 0 && leg.now < leg.to && (steps_before_ + leg.steps) % tracks_.steps() == 0)
      look_at_tracks(false);
    if (!go_on) return true;
    double stepping = summary_.stages.of("transport");
    for (const auto& effect : carrier_.effects()) stepping += summary_.stages.of("effect " + effect->name());
    wanted = go_on({.steps_done = steps_before_ + leg.steps,
                    .steps_total = steps_total_,
                    .time = case_.time.at(leg.now),
                    .end = case_.time.at(case_.time.end),
                    .elapsed = leg.now,
                    .length = case_.time.end,
                    .seconds = seconds_before_ + watch_.seconds(),
                    .step_seconds = stepping,
                    .outputs_done = summary_.frames.size(),
                    .outputs_total = case_.output.times.size()});
    return wanted;
  });
  if (tracks_.wanted()) tracks_.bring_together();
  return arrived && wanted;
}

RunSummary Simulation::Parts::run() {
  if (stage_ == Stage::ended) throw std::logic_error("Simulation::run(): this run has ended");
  prepare();
  const bool begins = stage_ == Stage::prepared;
  watch_ = base::Stopwatch();
  if (begins) begin();
  stage_ = Stage::ended;  // if something is thrown
  if (begins) look_at_tracks(true);
  bool wanted = true, shown = true;
  while (wanted && landed_ < landings_.size()) {
    wanted = carry();
    if (leg_.now < leg_.to) break;
    release(leg_.to);
    if (is_landing_of_case(leg_.to)) look_at_tracks(true);
    if (is_moment(leg_.to)) shown = show_moment_or_abandon(leg_.to);
    if (shown && is_output(leg_.to)) shown = show_or_abandon(leg_.to);
    if (!shown) break;
    if (++landed_ == landings_.size()) break;
    steps_before_ += leg_.steps;
    leg_ = {leg_.to, landings_[landed_], 0, leg_.to};
  }
  const bool arrived = landed_ == landings_.size();
  summary_.complete = arrived && finish();
  if (shown && !arrived) stage_ = Stage::under_way;
  end();
  return as_told();
}

// False if it was abandoned. A run that goes on from state() then shows the last output again, if it is of this time.
bool Simulation::Parts::finish() {
  try {
    const base::AbandonableTogether while_it_lasts(ranks_, abandon_wanted());
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
  summary_.elapsed = leg_.now;
  summary_.checks = judge(case_.checks, case_.density.empty() ? 1 : mass_at_start_, summary_.frames, case_.time);
  summary_.steps = steps_before_ + leg_.steps;
  summary_.steps_rejected = carrier_.steps_rejected();
  summary_.warnings = scene_.misfits;
  summary_.warnings.insert(summary_.warnings.end(), carrier_.warnings().begin(), carrier_.warnings().end());
  summary_.warnings.insert(summary_.warnings.end(), releases_.warnings().begin(), releases_.warnings().end());
  if (!compared_.left_out.empty()) summary_.warnings.push_back(compared_.left_out);
  if (in_pieces() && !case_.output.times.empty())
    summary_.warnings.push_back(words_for_pieces(pieces_, scene_.evaluation, compared_, compares_pieces()));
  summary_.reference_word = compared_.word;
  summary_.effects.clear();
  summarise_effects(carrier_.effects(), scene_, summary_);
  summary_.seconds = seconds_before_ + watch_.seconds();
}

RunSummary Simulation::Parts::summary() {
  sum_up();
  return as_told();
}

// With the times that the clock of the case shows.
RunSummary Simulation::Parts::as_told() const {
  RunSummary told = summary_;
  told.time = case_.time.at(told.elapsed);
  told.frames = frames_as_told();
  return told;
}

std::vector<std::pair<double, FrameNumbers>> Simulation::Parts::frames_as_told() const {
  std::vector<std::pair<double, FrameNumbers>> frames = summary_.frames;
  for (auto& [time, numbers] : frames) time = case_.time.at(time);
  return frames;
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
