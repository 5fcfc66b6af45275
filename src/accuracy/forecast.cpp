#include "accuracy/forecast.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>
#include <vector>

#include "accuracy/footprint.hpp"
#include "accuracy/picture_seconds.hpp"
#include "accuracy/processor_clock.hpp"
#include "accuracy/trial.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "render/picture.hpp"
#include "sim/outside.hpp"
#include "sim/simulation.hpp"
#include "sim/stepper.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double enough_seconds = 0.05;  // for a timing
// Work that the parts of a check may take (sim/simulation.hpp): together two seconds of one core, or less.
constexpr double work_of_steps = 2e6, work_of_paths = 4e6, work_of_samples = 2e6, work_of_drifts = 2e7,
                 work_of_growth = 1e7;
/// The prediction of the errors may take half as much again as steps, density and pictures of the run, within bounds.
constexpr double least_work_of_errors = 3e7, most_work_of_errors = 2.5e8;
constexpr std::size_t most_particles = 400'000, most_with_method = 30'000;  // of a trial; with a method asked by name
constexpr double most_pairs = 3e8;                                          // summed one by one
constexpr std::size_t written_particles = 20'000, written_points = 40'000;  // of a file that is made on trial

/// Seconds on `threads` threads of work that takes `seconds` on one. `serial` is the share that is not divided.
double shared(double seconds, int threads, double serial) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return seconds * (serial + (1 - serial) / std::min(static_cast<double>(threads), static_cast<double>(cores)));
}
constexpr double serial_steps = 0.05, serial_sum = 0.15, serial_drifts = 0.15;

Particles sample_of(const Particles& all, std::size_t most) {
  Particles some;
  some.dimension = all.dimension;
  const std::size_t wanted = std::min(most, all.size());
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t j = i * all.size() / wanted;
    for (int k = 0; k < all.dimension; ++k) some.position[k].push_back(all.position[k][j]);
    some.alpha.push_back(all.alpha[j]);
    some.id.push_back(all.id[j]);
  }
  return some;
}

using Columns = std::array<std::vector<double>, max_dimension>;

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

void sample_field(const Scene& scene, const Particles& particles, double end, Description& result) {
  // Up to this many particles, evenly spread over the list, stand for all: velocity and divergence, three times.
  const double affordable = work_of_samples / (6 * scene.velocity->cost());
  const Particles sample = sample_of(particles, static_cast<std::size_t>(std::clamp(affordable, 20.0, 2000.0)));
  for (const double t : {0.0, 0.5 * end, end}) {
    const Columns u = velocity_at(*scene.velocity, t, sample);
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
        throw NumericalError(fmt::format("the velocity is not finite at t = {:.6g}, ({}); {}", t, place,
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

/// The number of particles that fits into the work of a few steps.
std::size_t particles_for_steps(const Case& spec, const Scene& scene, std::size_t particles) {
  if (spec.effects.drifts()) {
    // As many as one sum over all pairs affords. Fewer are summed pair by pair, which does not tell what many take.
    std::size_t most = particles;
    while (most > 1000 && work_of_rate(spec, scene, most) > work_of_drifts) most -= most / 8;
    return most;
  }
  const double stages = time::find_tableau(spec.time.method).stages;
  const double rates = stages * scene.velocity->cost();  // of one particle, in a step
  const double reaction = scene.reaction_rate ? stages * scene.reaction_rate->cost() : 0;
  double each = rates + reaction;
  const auto& diffusion = spec.effects.diffusion;
  if (diffusion && diffusion->method == DiffusionSpec::Method::particle_exchange) {
    // Nodes of the halo that are looked at around a particle at the rim, and three sums over the particles.
    const double halo = 2 * spec.particles.overlap * std::sqrt(std::log(1 / diffusion->tolerance)) + 1;
    each += 0.2 * std::pow(halo, spec.domain.dimension) + 60;
  }
  return static_cast<std::size_t>(std::clamp(work_of_steps / each, 20.0, 1e9));
}

/// Particles that move each other leave the lattice at once. Sums over particles on a lattice are cheaper, so they
/// would mislead.
void shake(Particles& particles, double spacing) {
  constexpr double golden = 0.61803398874989485;  // multiples of the golden ratio fill [0, 1) evenly
  for (int k = 0; k < particles.dimension; ++k)
    for (std::size_t j = 0; j < particles.size(); ++j)
      particles.position[k][j] +=
          spacing * 0.8 *
          (std::fmod(static_cast<double>((j + 1) * static_cast<std::size_t>(2 * k + 1)) * golden, 1.0) - 0.5);
}

/// Seconds of one step on one thread, from a few steps of a copy that is thrown away.
double time_steps(const Case& spec, const Scene& scene, const Particles& particles) {
  if (spec.time.end <= 0) return 0;
  const time::Interval interval(0, spec.time.end, spec.time.step);
  // The fastest of several batches: the first find nothing in the caches.
  double fastest = std::numeric_limits<double>::infinity();
  const ProcessorClock watch;
  for (int repeat = 0; repeat < 20; ++repeat) {
    Carrier carrier(spec, scene, 1);
    Particles copy = particles;
    carrier.begin(copy);
    base::StageTimes ignored;
    std::size_t taken = 0;
    const ProcessorClock begun;
    for (std::size_t count = 1; taken < interval.steps() && (taken == 0 || begun.seconds() < enough_seconds / 2);
         count *= 2) {
      count = std::min(count, interval.steps() - taken);
      const ProcessorClock batch;
      carrier.advance(copy, interval, taken, count, 0, ignored);
      fastest = std::min(fastest, batch.seconds() / static_cast<double>(count));
      taken += count;
    }
    if (watch.seconds() > (repeat == 0 ? 4 : 1) * enough_seconds) break;
  }
  return fastest;
}

/// Seconds a step on one thread of particles that move each other: sums over all of them, which grow dearer as their
/// blobs spread. A few sums at the start, in the middle and at the end of the run, by Simpson's rule.
double time_drifts(const Case& spec, const Scene& scene, const Particles& particles) {
  Carrier carrier(spec, scene, 1);
  Particles copy = particles;
  carrier.begin(copy);
  shake(copy, scene.seeding.spacing);
  Columns u;
  VectorsView view{copy.dimension, copy.size(), {}};
  for (int k = 0; k < copy.dimension; ++k) {
    u[k].assign(copy.size(), 0.0);
    view.axis[k] = u[k].data();
  }
  const auto at = [&](double t) {
    double fastest = std::numeric_limits<double>::infinity();
    // Twice at least: the first sum makes tables that all later ones find.
    const ProcessorClock watch;
    for (int i = 0; i < 2 || watch.seconds() < enough_seconds; ++i) {
      const ProcessorClock one;
      add_flow_and_drifts(*scene.velocity, carrier.drifts(), t, copy, copy.view(), view, 1);
      fastest = std::min(fastest, one.seconds());
    }
    return fastest;
  };
  const double end = spec.time.end, start = at(0);
  const double sum = spec.effects.diffusion ? (start + 4 * at(end / 2) + at(end)) / 6 : start;
  return sum * time::find_tableau(spec.time.method).stages;
}

/// What effects that replace particles take and do to the number of particles over the run, from fewer particles that
/// take all its steps, or as many as an amount of work allows.
struct Growth {
  double seconds = 0;         // of a step, for each particle at the start
  double between_steps = 0;   // part of it that is neither the flow's nor the drifts'
  double mean = 1, most = 1;  // numbers of particles to that at the start
};
Growth grow(const Case& spec, Trial& trial) {
  const time::Interval interval(0, spec.time.end, spec.time.step);
  const double stages = time::find_tableau(spec.time.method).stages, steps = static_cast<double>(interval.steps());
  // Exchanging and remeshing take some 0.3 us of one core for each particle and step in the cases shear_diffusion and
  // swirl_remesh.
  const double each = stages * trial.scene.velocity->cost() + 8;
  constexpr double fewest = 500;
  thin_out(trial, static_cast<std::size_t>(std::clamp(work_of_growth / (each * steps), fewest, 1e9)), 1);
  Particles copy = trial.particles;
  Carrier carrier(trial.spec, trial.scene, 1);
  carrier.begin(copy);
  const auto begun = static_cast<double>(copy.size());
  double sum = 0, most = begun, count = 0;
  base::StageTimes stages_taken;
  const ProcessorClock watch;
  // Counted with the particles that there are by then.
  for (std::size_t i = 0; i < interval.steps() && (i == 0 || sum * each < work_of_growth); ++i) {
    carrier.advance(copy, interval, i, 1, 0, stages_taken);
    const auto now = static_cast<double>(copy.size());
    sum += now;
    most = std::max(most, now);
    ++count;
  }
  // They grow by a rim of so many spacings, which on a lattice of wider spacing is a larger part.
  const auto on_lattice_of_case = [&](double times) {
    const double d = spec.domain.dimension, rim = (std::pow(times, 1 / d) - 1) / static_cast<double>(trial.part.stride);
    return std::pow(1 + rim, d);
  };
  const double seconds = watch.seconds();
  double all = 0, between = 0;
  for (const auto& [name, stage] : stages_taken.stages()) {
    all += stage;
    if (name == "effect remesh" || name == "effect diffusion") between += stage;
  }
  Growth growth{.between_steps = all > 0 ? between / all : 0,
                .mean = on_lattice_of_case(sum / count / begun),
                .most = on_lattice_of_case(most / begun)};
  growth.seconds = seconds / sum * growth.mean;
  return growth;
}

/// Seconds of the reference of all outputs, from the paths of some grid points over as much of the run as an amount of
/// work allows.
double time_reference(const Case& spec, const Scene& scene, const Comparison& compared, int threads, double& traced) {
  const std::size_t all = compared.points;
  if (spec.reference.kind == ReferenceSpec::Kind::none || all == 0) return 0;
  const auto& times = spec.output.times;
  const auto some = [&](std::size_t count) {
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < count; ++i)
      points.push_back(static_cast<std::size_t>((static_cast<double>(i) + 0.5) / static_cast<double>(count) *
                                                static_cast<double>(scene.evaluation.size())));
    return points;
  };
  std::vector<double> rho;
  if (spec.reference.kind == ReferenceSpec::Kind::exact) {
    const std::vector<std::size_t> points = some(std::min<std::size_t>(all, 2048));
    const auto reference = make_reference(spec, scene, 1);
    const ProcessorClock watch;
    reference->evaluate_at(times.back(), points, rho);
    return watch.seconds() * static_cast<double>(times.size()) * static_cast<double>(all) /
           static_cast<double>(points.size());
  }
  // In units of the last output: a flow that depends on t is traced to the start for each.
  double outputs = 1;
  if ((!scene.velocity->is_steady() || all < scene.evaluation.size()) && times.back() > 0)
    outputs = std::accumulate(times.begin(), times.end(), 0.0) / times.back();
  const bool smooth = has_smooth_paths(scene);
  const double rate = 12 * work_of_exact_rate(scene);
  std::size_t count = std::min<std::size_t>(all, smooth ? 64 : 8);
  double part = 1;  // of the run, traced
  const bool by_steps = compared.following.by_half_steps;
  if (by_steps) {
    const double rates = 2 * times.back() / spec.time.step * time::find_tableau(spec.time.method).stages;
    part = std::clamp(work_of_paths / (rates * work_of_exact_rate(scene) * static_cast<double>(count)), 2e-7, 1.0);
  }
  double each = 0;  // seconds of a point over the whole run
  for (bool again = false; part > 1e-7;) {
    const double most_steps = std::max(2.0, work_of_paths / (rate * static_cast<double>(count)));
    const auto reference = make_reference(
        spec, scene, 1, {.most_steps = by_steps ? 0 : static_cast<std::size_t>(most_steps), .by_half_steps = by_steps});
    const std::vector<std::size_t> points = some(count);
    const ProcessorClock watch;
    const ReferenceReport report = reference->evaluate_at(part * times.back(), points, rho);
    const double now = watch.seconds() / static_cast<double>(count) / part;
    const double rates = static_cast<double>(report.rates);
    traced += rates;
    if (2 * report.exhausted > count) {
      part /= 8;
      continue;
    }
    each = again ? std::min(each, now) : now;
    // More points where they are cheap, and the last of them twice: a better timing.
    const std::size_t more = std::min<std::size_t>(all, 8 * count);
    if (!again && smooth && more > count && rates * work_of_exact_rate(scene) * 8 < work_of_paths) {
      count = more;
      continue;
    }
    if (again) break;
    again = true;
  }
  return shared(each * outputs * static_cast<double>(all), threads, serial_steps);
}

/// Steps that a method will choose, and seconds a step for one particle, from a trial that stops after an amount of
/// work and is extrapolated.
struct ChosenSteps {
  double steps = 0, seconds = 0;
};
ChosenSteps try_chosen_steps(const Case& spec, const Scene& scene, const Particles& particles) {
  struct Enough {};
  Carrier trial(spec, scene, 1);
  Particles moved = particles;
  trial.begin(moved);
  base::StageTimes ignored;
  const ProcessorClock watch;
  const double end = spec.time.end;
  double now = 0, steps = 0, seconds = 0;
  const double step_work =
      static_cast<double>(moved.size()) * time::find_tableau(spec.time.method).stages * work_of_exact_rate(scene);
  try {
    trial.carry(moved, 0, end, 0, ignored, [&](double time, std::size_t taken) {
      now = time;
      steps = static_cast<double>(taken);
      seconds = watch.seconds();
      if (steps * step_work > work_of_paths && seconds > enough_seconds / 2) throw Enough{};
    });
  } catch (const Enough&) {
  }
  if (!(now > 0)) return {};
  return {std::ceil(steps * end / now), seconds / steps};
}

bool wants(const Case& scene, OutputSpec::Vtk kind) {
  return std::find(scene.output.vtk.begin(), scene.output.vtk.end(), kind) != scene.output.vtk.end();
}

/// Seconds of the files of all outputs. Making a file as text in memory is timed with a small one. Writing it to the
/// disk is taken at a usual speed.
double time_files(const Case& spec, const Trial& trial, const Extent& extent) {
  constexpr double disk = 2.5e-9, small_file = 4e-3;  // seconds a byte, and to be sure that a file is there
  const auto frames = static_cast<double>(spec.output.times.size());
  double seconds = small_file * (10 + frames);  // tables and notes
  const auto whole = [&](double bytes, std::size_t tried, double tried_seconds) {
    seconds += frames * (bytes * (tried_seconds / static_cast<double>(tried) + disk) + 2 * small_file);
  };
  const auto timed = [](const auto& make) {
    double fastest = std::numeric_limits<double>::infinity();
    std::size_t bytes = 1;
    for (int i = 0; i < 2; ++i) {
      const ProcessorClock watch;
      bytes = make().size();
      fastest = std::min(fastest, watch.seconds());
    }
    return std::pair{bytes, fastest};
  };
  if (wants(spec, OutputSpec::Vtk::density)) {
    DensityGrid grid{trial.grid, {}};
    grid.lattice.points = {std::min(written_points, trial.grid.size()), 1, 1};
    grid.rho.assign(grid.lattice.size(), 1.0 / 3);
    const auto [bytes, took] = timed([&] { return write::density_text("density.vti", grid, 0); });
    whole(bytes_of_density_file(extent), bytes, took);
  }
  if (wants(spec, OutputSpec::Vtk::particles)) {
    const Particles some = sample_of(trial.particles, written_particles);
    const std::vector<double> velocity(some.size() * static_cast<std::size_t>(some.dimension), 1.0 / 3);
    const auto [bytes, took] = timed([&] { return write::particle_text("particles.vtp", some, velocity, 0); });
    whole(bytes_of_particle_file(extent), bytes, took);
  }
  return seconds;
}

std::string grouped(std::size_t number) {
  std::string digits = std::to_string(number), text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ' ';
    text += digits[i];
  }
  return text;
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
Redrawn redrawn(const Case& spec, const Description& result) {
  if (spec.output.times.size() < 2) return {};
  const auto [low, high] = render::rounded_range(std::min(0.0, result.density_minimum), result.density_maximum);
  const double margin = 0.01 * (high - low);
  // Where the end is not predicted, the error is taken to grow, and the density of vortex blobs, of which flat patches
  // are usual, to ripple when they leave the lattice.
  if (!result.budget.known())
    return {.density = spec.effects.vortex && result.density_maximum > high - margin, .error = true};
  const double error = render::symmetric_range(-result.error_at_start, result.error_at_start).second;
  return {.density = result.budget.lowest < low - margin || result.budget.highest > high + margin,
          .error = result.error_at_start < 0 || result.budget.total * result.density_maximum > 1.02 * error};
}

/// The density at the start, and the seconds that an output of the case takes.
void try_density(const Case& spec, const Trial& trial, int threads, Description& result) {
  DensityOptions options;
  options.tolerance = spec.evaluate.tolerance;
  options.method = spec.evaluate.method;
  options.threads = 1;  // the density is the same for any
  const auto n = static_cast<double>(trial.particles.size());
  Lattice grid = trial.grid;
  const bool pairs = spec.evaluate.method == "direct";
  for (std::size_t k = 0; pairs && n * static_cast<double>(grid.size()) > most_pairs; k = (k + 1) % max_dimension)
    grid.points[k] = (grid.points[k] + 1) / 2;  // of the same spacing: pairs cost the same wherever they are
  const ProcessorClock watch;
  const DensityGrid density = evaluate_density(trial.particles, trial.scene.cutoff, grid, options, &result.density);
  const double both = result.density.evaluate_seconds + result.density.measure_seconds,
               of_sum = both > 0 ? result.density.evaluate_seconds / both : 1;
  const double took = watch.seconds();
  // The first sum is timed: sums of a run find as little in the caches, because their memory is new each time.
  const double seconds = took * of_sum;
  const auto [lowest, highest] = std::minmax_element(density.rho.begin(), density.rho.end());
  result.density_minimum = *lowest, result.density_maximum = *highest;
  const auto& images = spec.output.images;
  if (trial.whole && std::find(images.begin(), images.end(), OutputSpec::Image::error) != images.end())
    result.error_at_start = error_at_start(trial.scene, density);
  const auto all = static_cast<double>(result.particles), points = static_cast<double>(result.grid_points),
             m = static_cast<double>(grid.size());
  const auto measured = [](double particles) { return std::max(2e7, 4 * particles); };  // pairs
  const double sum = seconds * (pairs ? all * points / (n * m) : (all + points) / (n + m));
  result.evaluate_seconds = shared(sum, threads, serial_sum) +
                            shared(took * (1 - of_sum) * measured(all) / measured(n), threads, serial_steps);
}

void predict_errors(const Case& spec, const Trial& trial, int threads, Description& result) {
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
void try_steps(const Case& spec, Trial& trial, int threads, Description& result) {
  thin_out(trial, particles_for_steps(trial.spec, trial.scene, trial.particles.size()), threads);
  const double seeded = static_cast<double>(trial.particles.size()), each = trial.carried / seeded;
  Particles particles = trial.particles;
  result.tried_in_steps = particles.size();
  Carrier carrier(trial.spec, trial.scene, threads);
  carrier.begin(particles);
  result.step_warnings = carrier.warnings();
  for (const auto& effect : carrier.effects())
    if (const std::string warning = effect->warning(); !warning.empty()) result.effect_warnings.push_back(warning);
  const Carrier as_written(spec, trial.scene, threads);
  for (const auto& effect : as_written.effects()) result.effects.push_back(effect->describe());
  // A halo lies around the particles: like their surface.
  const double halo = static_cast<double>(particles.size()) - seeded;
  result.particles_at_end = trial.carried + halo * std::pow(each, 1 - 1 / static_cast<double>(spec.domain.dimension));
  result.particles_at_most = result.particles_at_end;
  const double times = result.particles_at_end / static_cast<double>(particles.size());
  const bool drifts = spec.effects.drifts();
  double seconds = 0;
  result.steps = total_steps(spec);
  if (carrier.is_adaptive()) {
    const ChosenSteps chosen = try_chosen_steps(trial.spec, trial.scene, trial.particles);
    result.steps = static_cast<std::size_t>(chosen.steps);
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
double time_report(const Case& spec, const Description& result, double run) {
  double seconds = 0;
  if (spec.reference.kind != ReferenceSpec::Kind::none && spec.accuracy.budget != AccuracySpec::Budget::none &&
      budget_not_covered(spec).empty())
    seconds += std::max(0.1, 0.1 * run);
  if (!spec.output.report) return seconds;
  const double most = std::max(0.5, 0.1 * run), tolerances = 6, once = result.evaluate_seconds;
  if (once <= most / tolerances) seconds += std::min(most, 3 * tolerances * once);
  return seconds + (spec.output.images.empty() ? 0.02 : 0.25);
}

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.3g} MB", bytes / 1e6);
  return fmt::format("{:.3g} GB", bytes / 1e9);
}

std::string effects_text(const std::vector<std::string>& effects) {
  if (effects.empty()) return "transport only";
  std::string text = "transport";
  for (const std::string& effect : effects) text += ", " + effect;
  return text;
}

}  // namespace

Description describe(const Case& spec, int asked_threads, const std::function<void(const std::string&)>& doing) {
  const auto now = [&](const char* what) {
    if (doing) doing(what);
  };
  Description result;
  const int threads = result.threads = base::resolve_threads(asked_threads);
  const double before = memory_of_this_process();
  now("counting particles");
  const ProcessorClock counting;
  Trial trial = make_trial(spec, spec.evaluate.method == "auto" ? most_particles : most_with_method, 1);
  result.seed_seconds =
      shared(counting.seconds() * static_cast<double>(trial.lattice.size()) / static_cast<double>(trial.looked_at),
             threads, serial_sum);
  const Scene& scene = trial.scene;
  result.whole = trial.whole;
  result.seeding = trial.seeding;
  result.seeding.left_out = static_cast<std::size_t>(static_cast<double>(trial.seeding.left_out) *
                                                     std::pow(trial.part.stride, trial.lattice.dimension));
  if (trial.whole) result.beyond_at_start = part_beyond(scene.density->mass(), trial.particles, scene.seeding);
  result.velocity = scene.velocity->describe();
  result.initial_density = scene.density->describe();
  result.lattice_points = trial.lattice.size();
  result.looked_at = trial.looked_at;
  result.particles = static_cast<std::size_t>(trial.carried);
  result.grid_points = scene.evaluation.size();
  result.frames = spec.output.times.size();
  result.spacing = trial.lattice.spacing;
  result.core_radius = spec.particles.overlap * trial.lattice.spacing;
  now("looking at the velocity");
  sample_field(scene, trial.particles, spec.time.end, result);

  now("summing the density at the start");
  try_density(spec, trial, threads, result);
  if (!trial.whole || trial.grid.size() < result.grid_points)
    result.left_out.push_back(fmt::format("the density at the start is that of {} particles on {} grid points, {}",
                                          grouped(trial.particles.size()), grouped(trial.grid.size()),
                                          trial.part.stride > 1 ? "with wider blobs" : "as far as they were met"));

  // Errors before the lattice is thinned out for the steps.
  const Comparison plan = plan_comparison(spec, scene, result.particles, threads);
  const std::size_t compared = plan.points;
  result.reference = plan.left_out.empty() ? plan.word : plan.left_out;
  now("predicting the errors");
  predict_errors(spec, trial, threads, result);

  now("trying some steps");
  try_steps(spec, trial, threads, result);
  now("tracing exact paths");
  result.reference_seconds = time_reference(spec, scene, plan, threads, result.paths_traced);
  now("making files");
  const Extent extent{.lattice_points = static_cast<double>(result.lattice_points),
                      .particles = result.particles_at_end,
                      .grid_points = static_cast<double>(result.grid_points),
                      .compared_everywhere = compared > 0 && compared >= result.grid_points};
  result.file_seconds = time_files(spec, trial, extent);

  const auto frames = static_cast<double>(result.frames);
  result.picture_seconds = seconds_of_pictures(spec, result.grid_points, redrawn(spec, result));
  const double run = result.seed_seconds + static_cast<double>(result.steps) * result.step_seconds +
                     frames * result.evaluate_seconds + result.reference_seconds + result.picture_seconds +
                     result.file_seconds;
  result.report_seconds = time_report(spec, result, run);
  result.seconds = run + result.report_seconds;
  Extent largest = extent;
  largest.particles = result.particles_at_most;
  result.memory_bytes = before + memory_of_run(spec, largest);
  result.memory_there = memory_of_this_machine();
  result.disk_bytes = disk_of_run(spec, extent);
  return result;
}

std::string to_text(const Case& scene, const Description& r) {
  const Domain& domain = scene.domain;
  std::string box, grid_shape;
  for (int k = 0; k < domain.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    box += fmt::format("{}[{:g},{:g}]", k ? "x" : "", domain.min[axis], domain.max[axis]);
  }
  const std::string divergence = r.solenoidal ? "div u = 0"
                                 : r.largest_divergence <= r.divergence_noise
                                     ? "div u = 0 (sampled)"
                                     : fmt::format("max|div u| = {:.3g} (sampled)", r.largest_divergence);
  std::string text = fmt::format("{}  {}D  {}   {}   max|u| = {:.3g}\n", scene.name, domain.dimension, box, divergence,
                                 r.largest_speed);
  if (!scene.title.empty())
    text += fmt::format("title      {}{}\n", scene.title, scene.cite.empty() ? "" : ", after " + scene.cite);
  text += fmt::format("velocity   {}\n", r.velocity);
  for (const std::string& warning : r.step_warnings) text += fmt::format("           {}\n", warning);
  text += fmt::format("density    {}\n", r.initial_density);
  text +=
      fmt::format("particles  {} on the lattice, h = {:.3g}, eps = {:g}h = {:.3g}, cutoff {}; {}{} carry weight{}\n",
                  grouped(r.lattice_points), r.spacing, scene.particles.overlap, r.core_radius, scene.particles.cutoff,
                  r.whole ? "" : "about ", grouped(r.particles), r.seeding.carried.size() > 1 ? " or charge" : "");
  if (r.seeding.left_out > 0)
    text += fmt::format(
        "           {} with less than {:g} of the largest weight are left out: {:.1e} of the mass{} "
        "(particles.threshold)\n",
        grouped(r.seeding.left_out), scene.particles.threshold, r.seeding.carried.front().part(),
        r.seeding.carried.size() > 1 ? fmt::format(", {:.1e} of the charge", r.seeding.carried.back().part()) : "");
  if (const std::string beyond = about_beyond(r.beyond_at_start); !beyond.empty())
    text += fmt::format("           {}\n", beyond);
  text += fmt::format("effects    {}\n", effects_text(r.effects));
  for (const std::string& warning : r.effect_warnings) text += fmt::format("           {}\n", warning);
  if (!r.reference.empty()) text += fmt::format("reference  {}\n", r.reference);
  text += fmt::format("transform  {}\n", r.density.choice);
  text += fmt::format("           asked for {:.1g} of max rho, measured {:.1e} on {} grid points at t = 0\n",
                      scene.evaluate.tolerance, r.density.measured_error, r.density.sample);
  if (r.density.achievable > scene.evaluate.tolerance)
    text +=
        fmt::format("           this tolerance cannot be promised here: the bound is {:.1e}\n", r.density.achievable);
  text += fmt::format("           max rho = {:.6g} on the {}-point grid at t = 0\n", r.density_maximum,
                      grouped(r.grid_points));
  text += fmt::format(
      "cost       {} steps x {} particles, {} frames of {} points: about {:.2g} s on {} threads (seeding {:.2g}, steps "
      "{:.2g}, density "
      "{:.2g}, reference {:.2g}, files {:.2g}, pictures {:.2g}, report {:.2g}); memory {}; disk {}\n",
      grouped(r.steps), grouped(r.particles), r.frames, grouped(r.grid_points), r.seconds, r.threads, r.seed_seconds,
      static_cast<double>(r.steps) * r.step_seconds, static_cast<double>(r.frames) * r.evaluate_seconds,
      r.reference_seconds, r.file_seconds, r.picture_seconds, r.report_seconds, bytes_text(r.memory_bytes),
      bytes_text(r.disk_bytes));
  if (r.memory_bytes >= r.memory_there)
    text += fmt::format("           this machine has {} of memory, so `run` refuses this case: lower {}\n",
                        bytes_text(r.memory_there),
                        r.particles > r.grid_points ? "particles.per_axis" : "evaluate.per_axis");
  for (const std::string& sentence : r.left_out) text += fmt::format("sampled    {}\n", sentence);
  if (r.budget.known() && r.budget.outside >= 1e-3)
    text += fmt::format("leaving    {} of the mass is outside the domain at the last output\n",
                        percent_text(r.budget.outside));
  if (!r.budget.known())
    text += fmt::format("errors     not predicted: {}\n", r.budget.not_covered);
  else
    text += fmt::format("expected error at the end, largest, relative to max rho: {:.2g}\n{}", r.budget.total,
                        to_text(r.budget));
  return text;
}

std::string to_json(const Case& scene, const Description& r) {
  std::vector<std::string> effects{"transport"};
  effects.insert(effects.end(), r.effects.begin(), r.effects.end());
  const nlohmann::ordered_json document{{"case", scene.name},
                                        {"dimension", scene.domain.dimension},
                                        {"velocity", r.velocity},
                                        {"density", r.initial_density},
                                        {"reference", to_string(scene.reference.kind)},
                                        {"reference_paths", r.reference},
                                        {"largest_speed", r.largest_speed},
                                        {"largest_divergence", r.largest_divergence},
                                        {"effects", effects},
                                        {"step_warnings", r.step_warnings},
                                        {"effect_warnings", r.effect_warnings},
                                        {"lattice_points", r.lattice_points},
                                        {"particles", r.particles},
                                        {"left_out", r.seeding.left_out},
                                        {"mass_left_out", r.seeding.carried.front().part()},
                                        {"mass_outside_at_start", r.beyond_at_start},
                                        {"mass_outside_at_end", r.budget.outside},
                                        {"particles_counted", r.whole},
                                        {"lattice_points_looked_at", r.looked_at},
                                        {"spacing", r.spacing},
                                        {"core_radius", r.core_radius},
                                        {"grid_points", r.grid_points},
                                        {"steps", r.steps},
                                        {"frames", r.frames},
                                        {"density_maximum", r.density_maximum},
                                        {"transform",
                                         {{"chosen", r.density.choice},
                                          {"measured_error", r.density.measured_error},
                                          {"achievable", r.density.achievable}}},
                                        {"sampled", r.left_out},
                                        {"budget", to_json(r.budget)},
                                        {"predicted",
                                         {{"seconds", r.seconds},
                                          {"seed_seconds", r.seed_seconds},
                                          {"step_seconds", static_cast<double>(r.steps) * r.step_seconds},
                                          {"density_seconds", static_cast<double>(r.frames) * r.evaluate_seconds},
                                          {"reference_seconds", r.reference_seconds},
                                          {"file_seconds", r.file_seconds},
                                          {"picture_seconds", r.picture_seconds},
                                          {"report_seconds", r.report_seconds},
                                          {"memory_bytes", r.memory_bytes},
                                          {"disk_bytes", r.disk_bytes},
                                          {"threads", r.threads}}}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::accuracy
