#include "accuracy/trial_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>
#include <vector>

#include "accuracy/processor_clock.hpp"
#include "base/stopwatch.hpp"
#include "effect/catalogue.hpp"
#include "particle/subset.hpp"
#include "sim/carrier.hpp"
#include "sim/comparison.hpp"
#include "sim/stepper.hpp"
#include "sim/work.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double enough_seconds = 0.05;  // for a timing
// Work that the parts of a check may take (sim/work.hpp): together two seconds of one core, or less.
constexpr double work_of_steps = 2e6, work_of_paths = 4e6, work_of_drifts = 2e7, work_of_growth = 1e7;
constexpr std::size_t written_particles = 20'000, written_points = 40'000;  // of a file that is made on trial

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

/// `count` points of the evaluation lattice, spread evenly over its list.
std::vector<std::size_t> some_points(const Scene& scene, std::size_t count) {
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(static_cast<std::size_t>((static_cast<double>(i) + 0.5) / static_cast<double>(count) *
                                              static_cast<double>(scene.evaluation.size())));
  return points;
}

/// Seconds of an exact density that the case gives as a formula.
double time_formula(const Case& spec, const Scene& scene, std::size_t all) {
  const std::vector<std::size_t> points = some_points(scene, std::min<std::size_t>(all, 2048));
  std::vector<double> rho;
  const auto reference = make_reference(spec, scene, 1);
  const ProcessorClock watch;
  reference->evaluate_at(spec.output.times.back(), points, rho);
  return watch.seconds() * static_cast<double>(spec.output.times.size()) * static_cast<double>(all) /
         static_cast<double>(points.size());
}

}  // namespace

double shared(double seconds, int threads, double serial) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return seconds * (serial + (1 - serial) / std::min(static_cast<double>(threads), static_cast<double>(cores)));
}

Particles sample_of(const Particles& all, std::size_t most) {
  const std::size_t wanted = std::min(most, all.size());
  std::vector<std::size_t> chosen(wanted);
  for (std::size_t i = 0; i < wanted; ++i) chosen[i] = i * all.size() / wanted;
  return subset(all, chosen);
}

std::size_t particles_for_steps(const Case& spec, const Scene& scene, std::size_t particles) {
  if (particles_interact(spec.effects)) {
    // As many as one sum over all pairs affords. Fewer are summed pair by pair, which does not tell what many take.
    std::size_t most = particles;
    while (most > 1000 && work_of_rate(spec, scene, most) > work_of_drifts) most -= most / 8;
    return most;
  }
  const double stages = time::find_tableau(spec.time.method).stages;
  const double rates = stages * scene.velocity->cost();  // of one particle, in a step
  const double decay = scene.decay_rate ? stages * scene.decay_rate->cost() : 0;
  double each = rates + decay;
  for (const auto& [effect, written] : effects_of(spec.effects))
    if (effect->work) each += effect->work(written, spec);
  return static_cast<std::size_t>(std::clamp(work_of_steps / each, 20.0, 1e9));
}

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
    StageTimes ignored;
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
  const double sum = spreading(spec.effects) > 0 ? (start + 4 * at(end / 2) + at(end)) / 6 : start;
  return sum * time::find_tableau(spec.time.method).stages;
}

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
  StageTimes stages_taken;
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
    for (const auto& effect : carrier.effects())
      if (effect->acts_between_steps() && name == "effect " + effect->name()) between += stage;
  }
  Growth growth{.between_steps = all > 0 ? between / all : 0,
                .mean = on_lattice_of_case(sum / count / begun),
                .most = on_lattice_of_case(most / begun)};
  growth.seconds = seconds / sum * growth.mean;
  return growth;
}

ChosenSteps try_chosen_steps(const Case& spec, const Scene& scene, const Particles& particles) {
  Carrier trial(spec, scene, 1);
  Particles moved = particles;
  trial.begin(moved);
  StageTimes ignored;
  const ProcessorClock watch;
  const double end = spec.time.end;
  double seconds = 0;
  const double step_work =
      static_cast<double>(moved.size()) * time::find_tableau(spec.time.method).stages * work_of_exact_rate(scene);
  Carrier::Leg leg{0, end, 0, 0};
  trial.carry(moved, leg, 0, ignored, [&](const Carrier::Leg& so_far) {
    seconds = watch.seconds();
    return !(static_cast<double>(so_far.steps) * step_work > work_of_paths && seconds > enough_seconds / 2);
  });
  if (!(leg.now > 0)) return {};
  const auto steps = static_cast<double>(leg.steps);
  return {std::ceil(steps * end / leg.now), seconds / steps};
}

double time_reference(const Case& spec, const Scene& scene, const Comparison& compared, int threads, double& traced) {
  const std::size_t all = compared.points;
  if (spec.reference.kind == ReferenceSpec::Kind::none || all == 0) return 0;
  if (spec.reference.kind == ReferenceSpec::Kind::exact) return time_formula(spec, scene, all);
  const auto& times = spec.output.times;
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
  std::vector<double> rho;
  for (bool again = false; part > 1e-7;) {
    const double most_steps = std::max(2.0, work_of_paths / (rate * static_cast<double>(count)));
    const auto reference = make_reference(
        spec, scene, 1, {.most_steps = by_steps ? 0 : static_cast<std::size_t>(most_steps), .by_half_steps = by_steps});
    const std::vector<std::size_t> points = some_points(scene, count);
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

double time_files(const Case& spec, const Trial& trial, const Extent& extent) {
  constexpr double disk = 2.5e-9, small_file = 4e-3;  // seconds a byte, and to be sure that a file is there
  const auto frames = static_cast<double>(spec.output.times.size());
  double seconds = small_file * (10 + frames);  // tables and notes
  if (spec.output.files.empty()) return seconds;
  DensityGrid grid{trial.grid, {}};
  grid.lattice.points = {std::min(written_points, trial.grid.size()), 1, 1};
  grid.rho.assign(grid.lattice.size(), 1.0 / 3);
  const Particles some = sample_of(trial.particles, written_particles);
  const std::vector<double> velocity(some.size() * static_cast<std::size_t>(some.dimension), 1.0 / 3);
  Frame small;
  small.particles = &some;
  small.velocity = &velocity;
  small.density = &grid;
  for (const OutputFile& file : spec.output.files) {
    const write::FileKind& kind = write::find_output_file(file.name);
    double fastest = std::numeric_limits<double>::infinity();
    std::size_t bytes = 1;
    for (int i = 0; i < 2; ++i) {
      const ProcessorClock watch;
      bytes = std::max<std::size_t>(1, kind.text(file.name, small).size());
      fastest = std::min(fastest, watch.seconds());
    }
    seconds += frames * (kind.bytes(extent) * (fastest / static_cast<double>(bytes) + disk) + 2 * small_file);
  }
  return seconds;
}

}  // namespace gaussdrift::accuracy
