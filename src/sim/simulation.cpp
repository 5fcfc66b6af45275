#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.hpp"
#include "base/has_one.hpp"
#include "base/parallel.hpp"
#include "effect/catalogue.hpp"
#include "reference/sample.hpp"
#include "sim/outside.hpp"
#include "sim/stepper.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

namespace {

FrameNumbers measure_frame(const Particles& particles, const DensityGrid& density) {
  FrameNumbers numbers;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    numbers.mass += particles.alpha[j];
    numbers.weight += std::abs(particles.alpha[j]);
    for (int k = 0; k < particles.dimension; ++k) numbers.centroid[k] += particles.alpha[j] * particles.position[k][j];
  }
  // Where positive and negative weights cancel there is no centre of mass.
  const bool cancelled = std::abs(numbers.mass) <= 1e-12 * numbers.weight;
  for (int k = 0; k < particles.dimension; ++k)
    numbers.centroid[k] = cancelled ? std::numeric_limits<double>::quiet_NaN() : numbers.centroid[k] / numbers.mass;
  const auto [low, high] = std::minmax_element(density.rho.begin(), density.rho.end());
  numbers.minimum = *low;
  numbers.maximum = *high;
  return numbers;
}

double seconds_of(const base::StageTimes& stages, const std::string& wanted) {
  for (const auto& [name, seconds] : stages.stages())
    if (name == wanted) return seconds;
  return 0;
}

void summarise_effects(const Effects& effects, const Scene& scene, RunSummary& summary) {
  summary.effects.push_back({"transport",
                             seconds_of(summary.stages, "transport"),
                             "X' = u(X, t), " + scene.velocity->describe(),
                             "every weight",
                             {"position"},
                             {},
                             ""});
  for (const auto& effect : effects) {
    EffectSummary row{effect->name(),
                      seconds_of(summary.stages, "effect " + effect->name()),
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

DensityOptions density_options(const EvaluateSpec& evaluate, int threads) {
  DensityOptions options;
  options.tolerance = evaluate.tolerance;
  options.method = evaluate.method;
  options.threads = threads;
  return options;
}

}  // namespace

Simulation::Simulation(const Case& description, int threads)
    : case_(description),
      threads_(base::resolve_threads(threads)),
      scene_(make_scene(case_, threads_)),
      carrier_(case_, scene_, threads_) {}

void Simulation::prepare() {
  const base::Stopwatch seeding;
  particles_ = seed_scene(scene_, threads_, &seeding_);
  seed_seconds_ = seeding.seconds();
  mass_at_start_ = std::accumulate(particles_.alpha.begin(), particles_.alpha.end(), 0.0);
  largest_at_start_ = 0;
  for (const double alpha : particles_.alpha) largest_at_start_ = std::max(largest_at_start_, std::abs(alpha));
  largest_at_start_ /= std::pow(scene_.seeding.spacing, scene_.seeding.dimension);
  beyond_at_start_ = part_beyond(scene_.density->mass(), particles_, scene_.seeding);
  carrier_.begin(particles_);
  velocity_at_particles(0);
  check_density_seconds();
  compared_ = plan_comparison(case_, scene_, particles_.size(), threads_);
  if (compared_.points > 0) reference_ = make_reference(case_, scene_, threads_, compared_.following);
}

// [j][dimension]. Throws NumericalError where the field is not finite.
std::vector<double> Simulation::velocity_at_particles(double time) const {
  const auto dimension = static_cast<std::size_t>(particles_.dimension);
  const std::size_t count = particles_.size();
  std::vector<double> columns(count * dimension, 0.0), velocity(count * dimension);
  VectorsView u{particles_.dimension, count, {}};
  for (std::size_t k = 0; k < dimension; ++k) u.axis[k] = columns.data() + k * count;
  add_flow_and_drifts(*scene_.velocity, carrier_.drifts(), time, particles_, particles_.view(), u, threads_);
  check_velocity(*scene_.velocity, particles_, u, time, steps_done_);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t k = 0; k < dimension; ++k) velocity[j * dimension + k] = u.axis[k][j];
  return velocity;
}

void Simulation::carry(double from, double to, RunSummary& summary) {
  const std::size_t before = steps_done_;
  steps_done_ += carrier_.carry(particles_, from, to, before, summary.stages, [&](double now, std::size_t steps) {
    if (!progress_) return;
    double stepping = seconds_of(summary.stages, "transport");
    for (const auto& effect : carrier_.effects()) stepping += seconds_of(summary.stages, "effect " + effect->name());
    progress_({before + steps, steps_total_, now, case_.time.end, watch_.seconds(), stepping});
  });
}

// The density at the start stands for all: a run that has begun is not stopped.
void Simulation::check_density_seconds() const {
  const EvaluateSpec& evaluate = case_.evaluate;
  if (!limits_seconds(evaluate)) return;
  const auto predicted = [&](const std::string& method) {
    DensityOptions options = density_options(evaluate, threads_);
    options.method = method;
    return predict_density(particles_, scene_.cutoff, scene_.evaluation, options);
  };
  check_seconds(evaluate, predicted(evaluate.method), base::resolve_threads(threads_),
                [&] { return predicted("auto"); });
}

void Simulation::show_frame(int index, double time, RunSummary& summary) {
  DensityReport report;
  const DensityOptions options = density_options(case_.evaluate, threads_);
  const Cutoff& start = scene_.cutoff;
  const Cutoff blob = particles_.spread > 0 ? spread_cutoff(start, particles_.dimension, particles_.spread) : start;
  const DensityGrid density = evaluate_density(particles_, blob, scene_.evaluation, options, &report);
  summary.stages.add("density", report.evaluate_seconds);
  summary.stages.add("measure transform error", report.measure_seconds);
  summary.transform_choice = report.choice;
  summary.transform_achievable = std::max(summary.transform_achievable, report.achievable);

  const std::vector<double> velocity = velocity_at_particles(time);
  const bool velocity_wanted = base::has_one(case_.output.files, &OutputFile::needs_velocity);

  Frame frame;
  frame.index = index;
  frame.time = time;
  frame.particles = &particles_;
  frame.velocity = velocity_wanted ? &velocity : nullptr;
  frame.density = &density;
  frame.numbers = measure_frame(particles_, density);
  frame.numbers.outside = part_outside(particles_, case_.domain);
  frame.numbers.transform_error = report.measured_error;
  frame.numbers.transform_tolerance = report.requested_tolerance;
  frame.numbers.evaluate_seconds = report.evaluate_seconds;
  if (!carrier_.replaces_particles()) frame.numbers.stretch = largest_stretch(particles_, scene_.seeding);
  std::vector<double> exact;
  if (reference_) {
    summary.stages.run("reference", [&] {
      ReferenceReport traced;
      if (compared_.points >= density.rho.size()) {
        traced = reference_->evaluate(time, exact);
        frame.exact = &exact;
        frame.numbers.error = compare(density.rho, exact);
        frame.numbers.compared = density.rho.size();
      } else {
        const GridSample sample = sample_of_grid(scene_.evaluation, density.rho, compared_.points);
        traced = reference_->evaluate_at(time, sample.points, exact);
        frame.numbers.error = compare(density.rho, sample, exact);
        frame.numbers.compared = sample.points.size();
      }
      frame.numbers.untraced = traced.untraced;
      judge_norms(exact, frame.numbers);
      if (summary.reference.untraced == 0)
        summary.reference = traced;
      else
        summary.reference.untraced += traced.untraced;
    });
  }
  summary.frames.emplace_back(time, frame.numbers);
  for (const auto& observer : observers_) summary.stages.run(observer->name(), [&] { observer->frame(frame); });
}

// Norms are relative to the exact density. They mean nothing where that is nearly 0.
void Simulation::judge_norms(const std::vector<double>& exact, FrameNumbers& numbers) const {
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

RunSummary Simulation::run() {
  watch_ = base::Stopwatch();
  steps_done_ = 0;
  steps_total_ = total_steps(case_);
  RunSummary summary;
  summary.threads = threads_;
  summary.transform_tolerance = case_.evaluate.tolerance;
  const double before = particles_.size() == 0 ? 0 : seed_seconds_;  // prepared before this watch ran
  if (particles_.size() == 0) prepare();
  summary.stages.add("seed", seed_seconds_);
  summary.lattice_points = scene_.seeding.size();
  summary.particles = particles_.size();
  summary.seeding = seeding_;
  summary.beyond_at_start = beyond_at_start_;
  summary.grid_points = scene_.evaluation.size();
  summary.spacing = scene_.seeding.spacing;
  summary.core_radius = scene_.core_radius;

  double now = 0;
  int index = 0;
  for (const double landing : landings(case_)) {
    carry(now, landing, summary);
    now = landing;
    const auto& outputs = case_.output.times;
    if (std::find(outputs.begin(), outputs.end(), landing) != outputs.end()) show_frame(index++, landing, summary);
  }
  for (const auto& observer : observers_) summary.stages.run(observer->name(), [&] { observer->finish(); });
  summary.checks = judge(case_.checks, mass_at_start_, summary.frames);
  summary.steps = steps_done_;
  summary.steps_rejected = carrier_.steps_rejected();
  summary.warnings = carrier_.warnings();
  if (!compared_.left_out.empty()) summary.warnings.push_back(compared_.left_out);
  summary.reference_word = compared_.word;
  summarise_effects(carrier_.effects(), scene_, summary);
  summary.seconds = before + watch_.seconds();
  return summary;
}

}  // namespace gaussdrift
