#include "sim/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "effect/catalogue.hpp"
#include "particle/seeding.hpp"
#include "reference/characteristics.hpp"
#include "reference/formula.hpp"
#include "reference/sample.hpp"
#include "sim/make_fields.hpp"
#include "sim/outside.hpp"
#include "sim/stepper.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

std::vector<double> landings(const Case& description) {
  std::vector<double> times = description.output.times;
  if (times.empty() || times.back() < description.time.end) times.push_back(description.time.end);
  return times;
}

namespace {

/// Has one of the things this property?
template <class Thing>
bool has_one(const std::vector<Thing>& things, bool Thing::*property) {
  return std::any_of(things.begin(), things.end(), [&](const Thing& thing) { return thing.*property; });
}

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

void make_effect_fields(const Case& description, Scene& scene) {
  const int dimension = description.domain.dimension;
  std::vector<std::unique_ptr<ScalarField>> decays;
  for (const auto& [effect, spec] : effects_of(description.effects)) {
    const auto field_of = [&, &spec = spec](std::string_view key) -> std::unique_ptr<ScalarField> {
      if (key.empty() || !spec.has(key)) return nullptr;
      return std::make_unique<WrittenScalar>(spec.text(key), dimension, description.params);
    };
    if (auto decay = field_of(effect->decay_rate)) decays.push_back(std::move(decay));
    scene.effect_fields.push_back({spec.name, field_of(effect->decay_rate), field_of(effect->carried),
                                   fmt::format("effects.{}.{}", spec.name, effect->carried)});
  }
  if (decays.size() == 1) scene.decay_rate = std::move(decays.front());
  if (decays.size() > 1) scene.decay_rate = std::make_unique<SumOfScalars>(std::move(decays));
}

}  // namespace

Scene make_scene(const Case& description, int threads) {
  Scene scene;
  const Domain& domain = description.domain;
  scene.velocity = make_velocity(description, threads);
  scene.density = make_density(description);
  make_effect_fields(description, scene);
  scene.threshold = description.particles.threshold;
  scene.seeding = make_lattice(domain.dimension, domain.min, domain.max, description.particles.per_axis);
  const EvaluateSpec& evaluate = description.evaluate;
  scene.evaluation = evaluate.spacing > 0
                         ? make_lattice_with_spacing(domain.dimension, domain.min, domain.max, evaluate.spacing)
                         : make_lattice(domain.dimension, domain.min, domain.max, evaluate.per_axis);
  scene.core_radius = description.particles.overlap * scene.seeding.spacing;
  scene.cutoff = make_cutoff(description.particles.cutoff, domain.dimension, scene.core_radius,
                             description.particles.cutoff_arguments);
  return scene;
}

namespace {

std::size_t usual_most_steps(const Case& description) { return 10'000 + total_steps(description); }

}  // namespace

std::unique_ptr<Reference> make_reference(const Case& description, const Scene& scene, int threads,
                                          const Following& following) {
  switch (description.reference.kind) {
    case ReferenceSpec::Kind::none:
      return nullptr;
    case ReferenceSpec::Kind::exact:
      return formula(description.reference.rho, description.params, scene.evaluation);
    case ReferenceSpec::Kind::characteristics: {
      ScalarRate growth;
      const VelocityField* diverging = scene.velocity->is_solenoidal() ? nullptr : scene.velocity.get();
      const ScalarField* decay = scene.decay_rate.get();
      if (diverging || decay)
        growth = [diverging, decay](double t, const PointsView& x, double* values) {
          if (diverging) diverging->add_divergence(t, x, values);
          if (decay) decay->add(t, x, values);
        };
      const time::Tableau& tableau = time::find_tableau(description.time.method);
      const bool by_steps = following.by_half_steps && !time::is_adaptive(tableau);
      return characteristics(
          *scene.velocity, *scene.density, growth, scene.evaluation,
          {.tolerance = has_smooth_paths(scene) ? 1e-12 : 1e-9,  // short steps at every kink
           .smooth = has_smooth_paths(scene),
           .steady = scene.velocity->is_steady() && (!decay || decay->is_steady()),
           .end = description.time.end,
           .most_steps = following.most_steps > 0 ? following.most_steps : usual_most_steps(description),
           .steps_by = by_steps ? &tableau : nullptr,
           .step = by_steps ? description.time.step / 2 : 0,
           .threads = threads});
    }
  }
  return nullptr;
}

bool has_smooth_paths(const Scene& scene) {
  return scene.velocity->is_smooth() && (!scene.decay_rate || scene.decay_rate->is_smooth());
}

namespace {

/// The work of one particle's sum over all others: all pairs, or farfield with its tables if that is less. Blobs within
/// 18 widths are summed pair by pair.
double work_of_drift(const Case& description, const Scene& scene, double particles) {
  if (description.domain.dimension == 3) return std::min(0.04 * particles, 250.0);
  const double spread = spreading(description.effects) * description.time.end;
  const double width = std::sqrt(scene.core_radius * scene.core_radius + spread);
  double area = 1;
  for (int k = 0; k < 2; ++k)
    area *= description.domain.max[static_cast<std::size_t>(k)] - description.domain.min[static_cast<std::size_t>(k)];
  return std::min(0.09 * particles, 60 + 0.09 * particles * std::pow(18 * width, 2) / area);
}

}  // namespace

double work_of_rate(const Case& description, const Scene& scene, std::size_t particles) {
  const auto n = static_cast<double>(particles);
  return n * (scene.velocity->cost() +
              (particles_interact(description.effects) ? work_of_drift(description, scene, n) : 0));
}

Work work_of(const Case& description, const Scene& scene, std::size_t particles) {
  const time::Tableau& tableau = time::find_tableau(description.time.method);
  // The number of steps that a method chooses is not known here; some hundred are usual.
  const double steps = time::is_adaptive(tableau) ? 200 : static_cast<double>(total_steps(description));
  const auto n = static_cast<double>(particles), outputs = static_cast<double>(description.output.times.size());
  // Measured: 0.2 us and 1 us of one core a particle or grid point in the sum of an output; 0.1 s of two cores a
  // picture, 0.4 s for the first.
  const double sum = description.domain.dimension == 2 ? 5 : 25, picture = 5e6, first = 2e7;
  const double pictures = outputs * static_cast<double>(description.output.images.size());
  return {steps * static_cast<double>(tableau.stages) * work_of_rate(description, scene, particles),
          outputs * sum * (n + static_cast<double>(scene.evaluation.size())),
          pictures > 0 ? first + picture * pictures : 0};
}

double work_of_exact_rate(const Scene& scene) {
  const double divergence = scene.velocity->is_solenoidal() ? 0 : std::max(0.5, scene.velocity->cost() / 2);
  return scene.velocity->cost() + 0.3 + (scene.decay_rate ? scene.decay_rate->cost() : 0) + divergence;
}

Affordable affordable_paths(const Case& description, const Scene& scene, double allowed, double outputs, int threads) {
  constexpr std::size_t least = 16, stages = 12;
  const std::size_t whole = scene.evaluation.size(), usual = usual_most_steps(description);
  const double rate = work_of_exact_rate(scene), last = description.output.times.back();
  outputs = std::max(outputs, 1e-9);  // an output at the start alone: no path at all
  const auto points_for = [&](double each) {
    return each > 0 ? static_cast<std::size_t>(std::min(allowed / (each * outputs), static_cast<double>(whole)))
                    : whole;
  };
  Affordable found;
  for (const std::size_t wanted : {64, 8}) {
    const std::size_t tried = std::min(wanted, whole);
    const double bound = allowed / (8 * rate * static_cast<double>(tried * stages));
    const auto most = static_cast<std::size_t>(std::clamp(bound, 16.0, static_cast<double>(usual)));
    std::vector<std::size_t> points;
    // Points are chosen by the golden ratio, because an even stride may meet only one column of the grid.
    for (std::size_t i = 0; i < tried; ++i) {
      const double along = std::fmod((static_cast<double>(i) + 0.5) * std::numbers::phi, 1.0);
      points.push_back(std::min(whole - 1, static_cast<std::size_t>(along * static_cast<double>(whole))));
    }
    std::vector<double> ignored;
    const ReferenceReport trial =
        make_reference(description, scene, threads, {.most_steps = most})->evaluate_at(last, points, ignored);
    if (most < usual && 2 * trial.exhausted > tried) continue;
    found.work = rate * static_cast<double>(trial.rates) / static_cast<double>(tried);
    found.points = points_for(found.work);
    // No path may take many more steps than these did. A block of 256 takes the steps of its worst point; a path
    // through kinks takes its own.
    const std::size_t steps = trial.rates / (tried * stages), times = has_smooth_paths(scene) ? 16 : 4;
    found.following.most_steps = most < usual ? std::min(usual, std::max<std::size_t>(200, times * steps)) : usual;
    break;
  }
  const time::Tableau& tableau = time::find_tableau(description.time.method);
  if (!has_smooth_paths(scene) && !time::is_adaptive(tableau) && found.points < std::min<std::size_t>(64, whole)) {
    const double steps = 2 * static_cast<double>(time::Interval(0, last, description.time.step).steps());
    found.work = steps * tableau.stages * rate;
    found.points = points_for(found.work);
    found.following = {.by_half_steps = true};
    found.word = "followed back by steps half as long as those of the run";
  }
  if (found.points < std::min(least, whole)) found.points = 0;
  return found;
}

Comparison plan_comparison(const Case& description, const Scene& scene, std::size_t particles, int threads) {
  const std::size_t whole = scene.evaluation.size();
  if (description.reference.kind == ReferenceSpec::Kind::none) return {};
  if (description.reference.points)
    return {.points = std::min(whole, static_cast<std::size_t>(*description.reference.points))};
  if (description.reference.kind != ReferenceSpec::Kind::characteristics || description.output.times.empty() ||
      has_one(description.output.images, &PictureStyle::shows_error))
    return {.points = whole};
  constexpr double share = 0.15, few = 2.5e6;
  const auto& times = description.output.times;
  const bool shown = has_one(description.output.files, &OutputFile::shows_density);
  const bool steady = scene.velocity->is_steady() && (!scene.decay_rate || scene.decay_rate->is_steady());
  // Steady: the last output goes on from the feet of those before, if all points do; else each is traced to the start.
  const double outputs = times.back() > 0 ? std::accumulate(times.begin(), times.end(), 0.0) / times.back() : 0.0;
  const double allowed = std::max(few, share * work_of(description, scene, particles).total());
  const Affordable paths = affordable_paths(description, scene, allowed, outputs, threads);
  Comparison plan{.points = paths.points, .following = paths.following, .word = paths.word};
  if (paths.points == 0) {
    // A number that is asked for is measured, whatever it takes.
    const bool asked = description.accuracy.target ||
                       std::any_of(description.checks.begin(), description.checks.end(),
                                   [](const CheckSpec& check) { return check.what != CheckSpec::Quantity::mass; });
    constexpr std::size_t fewest = 64;
    if (asked) return {.points = std::min(whole, fewest)};
    plan.left_out =
        "the error is not measured: following paths back from 16 grid points would take more than 15 % of the run; "
        "reference.points = 64 measures it all the same";
    return plan;
  }
  if (!has_smooth_paths(scene)) {
    plan.points = std::min<std::size_t>(plan.points, 256);
    return plan;
  }
  if (shown && paths.work * static_cast<double>(whole) * (steady ? 1.0 : outputs) <= allowed) {
    plan.points = whole;
    return plan;
  }
  constexpr std::size_t enough = 4096;
  if (!shown) plan.points = std::min(plan.points, enough);
  return plan;
}

Particles seed_lattice(const Scene& scene, const Lattice& lattice, int threads, SeedReport* report) {
  std::vector<Carried> carried{
      {"the initial density", [&](const PointsView& x, double* values) { scene.density->add(x, values); }}};
  for (const EffectFields& fields : scene.effect_fields)
    if (fields.carried)
      carried.push_back(
          {fields.carried_key, [&](const PointsView& x, double* values) { fields.carried->add(0, x, values); }});
  return seed(lattice, carried, scene.threshold, threads, report);
}

Particles seed_scene(const Scene& scene, int threads, SeedReport* report) {
  Particles particles = seed_lattice(scene, scene.seeding, threads, report);
  if (std::all_of(particles.alpha.begin(), particles.alpha.end(), [](double alpha) { return alpha == 0; }))
    throw InputError(
        "the initial density is 0 on every point of the particle lattice, so there is nothing to carry; move or "
        "enlarge "
        "the density, or raise particles.per_axis");
  return particles;
}

double density_left_out(const Scene& scene, const SeedReport& report) {
  return report.carried.front().left_out * peak(scene.cutoff);
}

std::size_t total_steps(const Case& description) {
  std::size_t steps = 0;
  if (time::is_adaptive(time::find_tableau(description.time.method))) return 0;
  double from = 0;
  for (const double to : landings(description)) {
    steps += time::Interval(from, to, description.time.step).steps();
    from = to;
  }
  return steps;
}

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

void Simulation::show_frame(int index, double time, RunSummary& summary) {
  DensityReport report;
  DensityOptions options;
  options.tolerance = case_.evaluate.tolerance;
  options.method = case_.evaluate.method;
  options.threads = threads_;
  const Cutoff& start = scene_.cutoff;
  const Cutoff blob = particles_.spread > 0 ? spread_cutoff(start, particles_.dimension, particles_.spread) : start;
  const DensityGrid density = evaluate_density(particles_, blob, scene_.evaluation, options, &report);
  summary.stages.add("density", report.evaluate_seconds);
  summary.stages.add("measure transform error", report.measure_seconds);
  summary.transform_choice = report.choice;
  summary.transform_achievable = std::max(summary.transform_achievable, report.achievable);

  const std::vector<double> velocity = velocity_at_particles(time);
  const bool velocity_wanted = has_one(case_.output.files, &OutputFile::needs_velocity);

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
