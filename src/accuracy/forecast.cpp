#include "accuracy/forecast.hpp"

#include <fmt/format.h>
#include <fgtd/fgtd.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "accuracy/footprint.hpp"
#include "accuracy/grouped.hpp"
#include "accuracy/picture_seconds.hpp"
#include "accuracy/processor_clock.hpp"
#include "accuracy/trial.hpp"
#include "accuracy/trial_times.hpp"
#include "base/duration_text.hpp"
#include "base/parallel.hpp"
#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/simulation.hpp"
#include "render/film_cost.hpp"
#include "render/picture.hpp"
#include "sim/borders/edges.hpp"
#include "sim/borders/outside.hpp"
#include "sim/carrier.hpp"
#include "sim/comparison.hpp"
#include "sim/grid_pieces.hpp"
#include "sim/landings.hpp"
#include "sim/moments.hpp"
#include "sim/releases.hpp"
#include "sim/tiled_density.hpp"
#include "sim/work.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double work_of_samples = 2e6;  // that looking at the velocity may take (sim/work.hpp)
/// The prediction of the errors may take half as much again as steps, density and pictures of the run, within bounds.
constexpr double least_work_of_errors = 3e7, most_work_of_errors = 2.5e8;
constexpr std::size_t most_particles = 400'000, most_with_method = 30'000;  // of a trial; with a method asked by name
constexpr double most_pairs = 3e8;                                          // summed one by one
constexpr double most_seconds_of_sum = 2;                                   // by a method asked by name

Columns velocity_at(const VelocityField& field, double t, const Particles& particles) {
  Columns u;
  VectorsView view{particles.dimension, particles.size(), {}};
  for (int k = 0; k < particles.dimension; ++k) {
    u[k].assign(particles.size(), 0.0);
    view.axis[k] = u[k].data();
  }
  field.add(t, particles.view(), view);
  return u;
}

void sample_field(const Scene& scene, const Particles& particles, double end, Forecast& result) {
  // Up to this many particles, evenly spread over the list, stand for all: velocity and divergence, three times.
  const double affordable = work_of_samples / (6 * scene.velocity->cost());
  const Particles sample = sample_of(particles, static_cast<std::size_t>(std::clamp(affordable, 20.0, 2000.0)));
  for (const double t : {0.0, 0.5 * end, end}) {
    const Columns u = velocity_at(scene.velocity->in_lengths(), t, sample);
    for (std::size_t j = 0; j < sample.size(); ++j) {
      double square = 0;
      for (int k = 0; k < sample.dimension; ++k) square += u[k][j] * u[k][j];
      if (!std::isfinite(square)) {
        if (t > 0) continue;  // particles will have moved by then; the run itself watches them
        std::string place;
        Vector x{};
        for (int k = 0; k < sample.dimension; ++k) {
          x[k] = sample.position[k][j];
          place += fmt::format("{}{:.6g}", k ? ", " : "", x[k]);
        }
        const std::string reason = scene.velocity->why_not_finite(t, x);
        throw NumericalError(fmt::format("the velocity is not finite at t = {:.6g}, ({}); {}",
                                         scene.velocity->shown_time(t), place,
                                         reason.empty() ? "guard the expression or move the density" : reason));
      }
      result.largest_speed = std::max(result.largest_speed, std::sqrt(square));
    }
    std::vector<double> divergence(sample.size(), 0.0);
    scene.velocity->add_divergence(t, sample.view(), divergence.data());
    for (const double value : divergence)
      result.largest_divergence = std::max(result.largest_divergence, std::abs(value));
  }
  result.solenoidal = scene.velocity->is_solenoidal();
  result.divergence_noise = 1e3 * std::numeric_limits<double>::epsilon() * result.largest_speed / scene.core_radius;
}

/// The largest difference between the density of the blobs and the initial one, on the grid.
double error_at_start(const Scene& scene, const DensityGrid& density) {
  const Lattice& grid = density.lattice;
  Columns x;
  PointsView nodes{grid.dimension, density.rho.size(), {}};
  for (int k = 0; k < grid.dimension; ++k) x[k].resize(nodes.count);
  for (std::size_t i = 0; i < nodes.count; ++i)
    for (std::size_t k = 0, rest = i; k < static_cast<std::size_t>(grid.dimension); rest /= grid.points[k++])
      x[k][i] = grid.coordinate(static_cast<int>(k), rest % grid.points[k]);
  for (int k = 0; k < grid.dimension; ++k) nodes.axis[k] = x[k].data();
  std::vector<double> exact(density.rho.size(), 0.0);
  scene.density->add(nodes, exact.data());
  double largest = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) largest = std::max(largest, std::abs(exact[i] - density.rho[i]));
  return largest;
}

/// Which pictures are drawn again at the end: those of a quantity that leaves the range of colours which its first
/// output was given.
Redrawn redrawn(const Case& spec, const Forecast& result) {
  if (spec.output.times.size() < 2) return {};
  const auto [low, high] = render::rounded_range(std::min(0.0, result.density_minimum), result.density_maximum);
  const double margin = 0.01 * (high - low);
  // Where the end is not predicted, the error is taken to grow.
  if (!result.budget.known())
    return {.density = flat_patches_ripple(spec.effects) && result.density_maximum > high - margin, .error = true};
  const double error = render::symmetric_range(-result.error_at_start, result.error_at_start).second;
  return {.density = result.budget.lowest < low - margin || result.budget.highest > high + margin,
          .error = result.error_at_start < 0 || result.budget.total * result.density_maximum > 1.02 * error};
}

/// The density at the start, and the seconds that an output of the case takes.
void try_density(const Case& spec, const Trial& trial, int threads, Forecast& result) {
  DensityOptions options;
  options.tolerance = spec.evaluate.tolerance;
  options.method = spec.evaluate.method;
  options.hermite = spec.evaluate.hermite;
  options.threads = 1;  // the density is the same for any
  const auto n = static_cast<double>(trial.particles.size());
  Lattice grid = trial.grid;
  const std::string all_pairs = to_string(fgtd::Method::direct);
  const bool pairs = spec.evaluate.method == all_pairs;
  for (std::size_t k = 0; pairs && n * static_cast<double>(grid.size()) > most_pairs; k = (k + 1) % max_dimension)
    grid.points[k] = (grid.points[k] + 1) / 2;  // of the same spacing: pairs cost the same wherever they are
  const auto all = static_cast<double>(result.particles), points = static_cast<double>(result.grid_points),
             m = static_cast<double>(grid.size());
  // A method that cannot serve gives way to all pairs; `auto` has others.
  const auto times_by = [&](const std::string& asked, const std::string& done_by) {
    return asked != "auto" && done_by == all_pairs ? all * points / (n * m) : (all + points) / (n + m);
  };
  double times = times_by(spec.evaluate.method, spec.evaluate.method);
  double predicted = 0;  // seconds of a sum that is too slow to be tried
  if (limits_seconds(spec.evaluate)) {
    const auto work = [&](const std::string& method) {
      options.method = method;
      DensityWork whole = predict_density(trial.particles, trial.scene.cutoff, grid, options);
      whole.seconds *= times_by(method, whole.method);
      return whole;
    };
    const DensityWork named = work(spec.evaluate.method);
    check_seconds(spec.evaluate, named, threads, [&] { return work("auto"); });
    times = times_by(spec.evaluate.method, named.method);
    if (named.seconds / times > most_seconds_of_sum) {
      predicted = named.seconds / times;
      options.method = "auto";
      result.left_out.push_back(
          fmt::format("the density at the start is summed by auto, because {} would take {} for this check alone; what "
                      "it takes in a run is predicted",
                      spec.evaluate.method, base::duration_text(predicted)));
    }
  }
  const ProcessorClock watch;
  Particles with_images;
  const Particles& sources =
      summed_particles(spec.domain, trial.particles, reach_of_blob(trial.scene.cutoff, options), with_images);
  const DensityGrid density = evaluate_density(sources, trial.scene.cutoff, grid, options, &result.density);
  const double both = result.density.evaluate_seconds + result.density.measure_seconds,
               of_sum = both > 0 ? result.density.evaluate_seconds / both : 1;
  const double took = watch.seconds();
  // The first sum is timed: sums of a run find as little in the caches, because their memory is new each time.
  const double seconds = predicted > 0 ? predicted : took * of_sum;
  const auto [lowest, highest] = std::minmax_element(density.rho.begin(), density.rho.end());
  result.density_minimum = *lowest, result.density_maximum = *highest;
  const auto& images = spec.output.images;
  if (trial.whole &&
      std::any_of(images.begin(), images.end(), [](const PictureStyle& style) { return style.shows_error; }))
    result.error_at_start = error_at_start(trial.scene, density);
  const auto measured = [](double particles) { return std::max(2e7, 4 * particles); };  // pairs
  result.evaluate_seconds = shared(seconds * times, threads, serial_sum) +
                            shared(took * (1 - of_sum) * measured(all) / measured(n), threads, serial_steps);
}

void predict_errors(const Case& spec, const Trial& trial, int threads, Forecast& result) {
  if (trial.part.stride > 1) {
    result.budget.not_covered = budget_not_covered(spec);
    if (!result.budget.known()) return;
    result.budget.not_covered = fmt::format(
        "a prediction follows all particles, which are too many here; accuracy.budget = \"measured\" lets "
        "the run tell its errors apart");
    result.budget.too_dear = true;
    return;
  }
  Allowance allowance{std::clamp(1.5 * work_of(spec, trial.scene, trial.particles.size()).total(), least_work_of_errors,
                                 most_work_of_errors)};
  result.budget = predict_budget(spec, trial.scene, allowance, threads);
  result.work_of_errors = allowance.spent;
}

/// Steps, the seconds of one, and what effects make of the particles.
void try_steps(const Case& spec, Trial& trial, int threads, Forecast& result) {
  thin_out(trial, particles_for_steps(trial.spec, trial.scene, trial.particles.size()), threads);
  const double seeded = static_cast<double>(trial.particles.size()), each = trial.carried / seeded;
  Particles particles = trial.particles;
  result.tried_in_steps = particles.size();
  Carrier carrier(trial.spec, trial.scene, threads);
  carrier.begin(particles);
  result.step_warnings = trial.scene.misfits;
  result.step_warnings.insert(result.step_warnings.end(), carrier.warnings().begin(), carrier.warnings().end());
  for (const auto& effect : carrier.effects())
    if (const std::string warning = effect->warning(); !warning.empty()) result.effect_warnings.push_back(warning);
  const Carrier as_written(spec, trial.scene, threads);
  for (const auto& effect : as_written.effects()) result.effects.push_back(effect->describe());
  result.particles_at_end =
      with_halo(trial.carried, static_cast<double>(particles.size()) - seeded, each, spec.domain.dimension);
  result.particles_at_most = result.particles_at_end;
  // On the mean of the run about half of what sources release is there.
  result.released = particles_released(spec, threads);
  const double besides = spec.density.empty() ? 0 : result.released / 2;  // else the trial stands for them
  result.particles_at_end += besides;
  result.particles_at_most += besides + result.released / 2;
  const double times = result.particles_at_end / static_cast<double>(particles.size());
  const bool drifts = particles_interact(spec.effects);
  double seconds = 0;
  result.steps = total_steps(spec);
  if (carrier.is_adaptive()) {
    const ChosenSteps chosen = try_chosen_steps(trial.spec, trial.scene, trial.particles);
    result.steps = static_cast<std::size_t>(chosen.steps);
    if (!spec.sources.empty()) result.steps = std::max(result.steps, landings(spec).size());
    seconds = chosen.seconds * times;
  } else {
    const bool replaced = carrier.replaces_particles() && spec.time.end > 0;
    seconds = drifts      ? time_drifts(trial.spec, trial.scene, trial.particles) * times
              : !replaced ? time_steps(trial.spec, trial.scene, trial.particles) * times
                          : 0;
    if (replaced) {
      const Growth growth = grow(spec, trial);
      seconds = seconds * growth.mean + growth.seconds * (drifts ? growth.between_steps : 1) * result.particles_at_end;
      result.particles_at_most *= growth.most;
      result.particles_at_end *= growth.mean;
    }
  }
  result.step_seconds = shared(seconds, threads, drifts ? serial_drifts : serial_steps);
}

/// After the last output: the error budget, the table of tolerances and the page.
double time_report(const Case& spec, const Forecast& result, double run) {
  double seconds = 0;
  if (spec.reference.kind != ReferenceSpec::Kind::none && spec.accuracy.budget != AccuracySpec::Budget::none &&
      budget_not_covered(spec).empty())
    seconds += std::max(0.1, 0.1 * run);
  if (!spec.output.report) return seconds;
  const double most = std::max(0.5, 0.1 * run), tolerances = 6, once = result.evaluate_seconds;
  if (once <= most / tolerances) seconds += std::min(most, 3 * tolerances * once);
  return seconds + (spec.output.images.empty() ? 0.02 : 0.25);
}

/// What is known from the trial alone.
void describe_trial(const Case& spec, const Trial& trial, Forecast& result) {
  const Scene& scene = trial.scene;
  result.whole = trial.whole;
  result.seeding = trial.seeding;
  result.seeding.left_out = static_cast<std::size_t>(static_cast<double>(trial.seeding.left_out) *
                                                     std::pow(trial.part.stride, trial.lattice.dimension));
  if (trial.whole) result.beyond_at_start = part_beyond(scene.density->mass(), trial.particles, scene.seeding);
  result.velocity = scene.velocity->describe();
  result.initial_density = spec.density.empty() ? "none: the run starts empty" : scene.density->describe();
  result.lattice_points = trial.lattice.size();
  result.looked_at = trial.looked_at;
  result.particles = static_cast<std::size_t>(trial.carried);
  result.grid_points = scene.evaluation.size();
  result.frames = spec.output.times.size();
  result.spacing = trial.lattice.spacing;
  result.core_radius = spec.particles.overlap * trial.lattice.spacing * trial.lattice.unit();
}

/// Seconds of pictures and report, and the sums of all that was timed.
void add_up(const Case& spec, const Extent& extent, double most_memory, Forecast& result) {
  const auto frames = static_cast<double>(result.frames);
  result.picture_seconds = seconds_of_pictures(spec, shown_grid(spec).size(), redrawn(spec, result));
  if (spec.output.animation) {
    const render::FilmCost film = render::film_cost(spec, lattice_of_moments(evaluation_lattice(spec)).size());
    result.animation_seconds = static_cast<double>(spec.output.animation->frames) * result.evaluate_seconds +
                               slowness_of_this_machine() * film.seconds / result.threads;
  }
  const double run = result.animation_seconds + result.seed_seconds +
                     static_cast<double>(result.steps) * result.step_seconds + frames * result.evaluate_seconds +
                     result.reference_seconds + result.picture_seconds + result.file_seconds;
  result.report_seconds = time_report(spec, result, run);
  result.seconds = run + result.report_seconds;
  Extent largest = extent;
  largest.particles = result.particles_at_most;
  result.memory = memory_of_run(spec, largest);
  result.memory_limit = tightest_limit(most_memory);
  result.disk_bytes = disk_of_run(spec, extent, result.seconds);
}

}  // namespace

Forecast forecast(const Case& spec, int asked_threads, const std::function<void(const std::string&)>& doing,
                  double most_memory) {
  const auto now = [&](const char* what) {
    if (doing) doing(what);
  };
  Forecast result;
  const int threads = result.threads = base::resolve_threads(asked_threads);
  result.program_bytes = memory_of_this_process();
  now("counting particles");
  const ProcessorClock counting;
  Trial trial = make_trial(spec, spec.evaluate.method == "auto" ? most_particles : most_with_method, 1);
  result.seed_seconds =
      shared(counting.seconds() * static_cast<double>(trial.lattice.size()) / static_cast<double>(trial.looked_at),
             threads, serial_sum);
  describe_trial(spec, trial, result);
  now("looking at the velocity");
  sample_field(trial.scene, trial.particles, spec.time.end, result);

  now("summing the density at the start");
  try_density(spec, trial, threads, result);
  if (!trial.whole || trial.grid.size() < result.grid_points)
    result.left_out.push_back(fmt::format("the density at the start is that of {} particles on {} grid points, {}",
                                          grouped(trial.particles.size()), grouped(trial.grid.size()),
                                          trial.part.stride > 1 ? "with wider blobs" : "as far as they were met"));

  // Errors before the lattice is thinned out for the steps.
  const Comparison plan = plan_comparison(spec, trial.scene, result.particles, threads);
  result.reference = plan.left_out.empty() ? plan.word : plan.left_out;
  now("predicting the errors");
  predict_errors(spec, trial, threads, result);

  now("trying some steps");
  try_steps(spec, trial, threads, result);
  now("tracing exact paths");
  result.reference_seconds = time_reference(spec, trial.scene, plan, threads, result.paths_traced);
  now("making files");
  const Extent extent{.lattice_points = static_cast<double>(result.lattice_points),
                      .particles = result.particles_at_end,
                      .grid_points = static_cast<double>(result.grid_points),
                      .compared_everywhere = plan.points > 0 && plan.points >= result.grid_points};
  result.file_seconds = time_files(spec, trial, extent);
  add_up(spec, extent, most_memory, result);
  return result;
}

}  // namespace gaussdrift::accuracy
