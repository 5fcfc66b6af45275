// The four studies that `gaussdrift study CASE` makes by itself: transform, steps, lattice, whole runs.
#include <fmt/format.h>
#include <fgtd/fgtd.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "accuracy/target.hpp"
#include "accuracy/would_run.hpp"
#include "base/longest_side.hpp"
#include "base/number.hpp"
#include "base/parallel.hpp"
#include "base/repeated_time.hpp"
#include "base/stopwatch.hpp"
#include "base/users_words.hpp"
#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/simulation.hpp"
#include "particle/cutoff.hpp"
#include "particle/subset.hpp"
#include "reference/exact_paths.hpp"
#include "sim/carrier.hpp"
#include "sim/transform.hpp"
#include "study/study.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::study {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double longest_side_of(const Case& spec) {
  return longest_side(spec.domain.dimension, spec.domain.min, spec.domain.max);
}

template <class SomeExperiment>
auto cheapest_below(SomeExperiment& experiment, double error) {
  decltype(experiment.samples.data()) best = nullptr;
  for (auto& sample : experiment.samples)
    if (sample.failure.empty() && sample.error <= error && (!best || sample.seconds < best->seconds)) best = &sample;
  return best;
}

/// The conclusion where no run has an error.
std::string no_error(const Experiment& experiment) {
  return experiment.samples.empty() ? "Nothing was run."
                                    : fmt::format("No run has a known error: {}.", experiment.samples.front().failure);
}

}  // namespace

Experiment study_transform(const Case& spec, int threads, double seconds) {
  Experiment experiment{
      .name = "transform",
      .title = "Tolerance and method of the Gauss transform",
      .question = "What does a digit of the density cost?",
      .keys = {"evaluate.method", "evaluate.tolerance"},
      .error_is = "largest error of the sum, relative to max |rho|, on a sample against the direct sum",
      .seconds_are = "of one evaluation of the last output",
      .samples = {},
      .conclusion = {},
      .notes = {}};
  Case bare = spec;
  bare.output.files.clear();
  bare.output.images.clear();
  bare.checks.clear();
  bare.reference = {};
  if (!bare.output.times.empty()) bare.output.times = {bare.output.times.back()};
  Simulation simulation(bare, threads);
  simulation.run();
  const Scene scene = make_scene(bare, threads);
  const Particles& particles = simulation.particles();
  const Cutoff blob =
      particles.spread > 0 ? spread_cutoff(scene.cutoff, particles.dimension, particles.spread) : scene.cutoff;
  const base::Stopwatch watch;
  double cheapest_auto = nan, dearest_auto = nan, direct = nan;
  for (const fgtd::Method method : fgtd::methods()) {
    // 10^9 pairs a second and core.
    bool too_dear = method == fgtd::Method::direct &&
                    static_cast<double>(particles.size()) * static_cast<double>(scene.evaluation.size()) > 3e9;
    const base::EnoughTimes enough{.long_enough = 0.3, .most = 12};
    std::vector<base::RepeatedTime> times;  // of those that have some
    std::vector<double> tolerances;
    std::vector<std::size_t> place;  // of their samples
    const auto predicted_seconds = [&](double tolerance) {
      const DensityOptions options{.tolerance = tolerance, .method = fgtd::to_string(method), .threads = threads};
      return predict_density(particles, blob, scene.evaluation, options).seconds / base::resolve_threads(threads);
    };
    const auto measure_again = [&](std::size_t i) {
      DensityReport report;
      evaluate_density(particles, blob, scene.evaluation,
                       {.tolerance = tolerances[i], .method = fgtd::to_string(method), .threads = threads}, &report);
      times[i].add(report.evaluate_seconds);
    };
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      Sample sample{.values = {fgtd::to_string(method), fmt::format("{:.0e}", tolerance)}};
      if (too_dear || (watch.seconds() > seconds && method != fgtd::Method::automatic)) {
        sample.failure = "left out: too dear";
      } else {
        try {
          if (method != fgtd::Method::automatic && predicted_seconds(tolerance) > seconds) {
            too_dear = true;
            continue;
          }
          DensityReport report;
          evaluate_density(
              particles, blob, scene.evaluation,
              {.tolerance = tolerance, .method = fgtd::to_string(method), .threads = threads, .measure = true},
              &report);
          sample.error = std::max(report.measured_error, 1e-16);
          times.emplace_back();
          tolerances.push_back(tolerance);
          place.push_back(experiment.samples.size());
          if (report.evaluate_seconds >= enough.long_enough) times.back().add(report.evaluate_seconds);
          for (int repeat = 0; repeat < 3 && report.evaluate_seconds < enough.long_enough; ++repeat)
            measure_again(times.size() - 1);                                        // the one before has warmed up
          too_dear = times.back().fastest() > 1 || method == fgtd::Method::direct;  // which takes the same for all
        } catch (const Error& error) {
          sample.failure = error.what();
        } catch (const fgtd::Error& error) {
          sample.failure = base::in_users_words(error.what(), {{"Options::tolerance = ", "a tolerance of "}});
        }
      }
      if (sample.failure != "left out: too dear" || !too_dear) experiment.samples.push_back(std::move(sample));
    }
    std::vector<std::size_t> doubtful = base::to_measure_again(times, enough);
    for (int round = 0; round < 9 && !doubtful.empty() && watch.seconds() < seconds; ++round) {
      for (const std::size_t i : doubtful) measure_again(i);
      doubtful = base::to_measure_again(times, enough);
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
      experiment.samples[place[i]].seconds = times[i].fastest();
      experiment.samples[place[i]].confirmed = std::find(doubtful.begin(), doubtful.end(), i) == doubtful.end();
    }
    if (times.empty()) continue;
    if (method == fgtd::Method::automatic)
      cheapest_auto = times.front().fastest(), dearest_auto = times.back().fastest();
    if (method == fgtd::Method::direct) direct = times.front().fastest();
  }
  finish(experiment, spec);
  experiment.conclusion = fmt::format(
      "{}: {:.2g} ms at 1e-2, {:.2g} ms at 1e-12",
      dearest_auto < 1.3 * cheapest_auto
          ? std::string("Digits of the sum are almost free")
          : fmt::format("Ten digits more of the sum cost {:.2g} times the time", dearest_auto / cheapest_auto),
      1e3 * cheapest_auto, 1e3 * dearest_auto);
  experiment.conclusion += std::isfinite(direct) ? fmt::format("; pair by pair it is {:.2g} ms.", 1e3 * direct) : ".";
  return experiment;
}

namespace {

/// What the steps of a study move, and where it should end up.
struct Paths {
  Particles start, exact;
  double scale = 1;  // particles of the case for each of these
  double known = 0;  // to which `exact` is right, in core radii
  std::string note;  // how that is known; empty: to rounding
};

double largest_distance(const Particles& a, const Particles& b) {
  double largest = 0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    double square = 0;
    for (int k = 0; k < a.dimension; ++k) square += std::pow(a.position[k][j] - b.position[k][j], 2);
    if (!std::isnan(square)) largest = std::max(largest, square);
  }
  return std::sqrt(largest);
}

/// Some of the particles, and their paths to full precision.
Paths paths_in_the_flow(const Case& spec, const Scene& scene, const Particles& all, int threads) {
  Paths paths;
  const std::size_t stride = std::max<std::size_t>(1, all.size() / 2000);
  std::vector<std::size_t> chosen;
  for (std::size_t j = 0; j < all.size(); j += stride) chosen.push_back(j);
  paths.start = subset(all, chosen);
  paths.scale = static_cast<double>(all.size()) / static_cast<double>(paths.start.size());
  paths.exact = paths.start;
  carry_exactly(
      *scene.velocity, nullptr, paths.exact, 0, spec.output.times.back(),
      {.tolerance = scene.velocity->is_smooth() ? 1e-14 : 1e-10, .length = longest_side_of(spec), .threads = threads});
  return paths;
}

/// Particles that move each other: all of them, and steps of the usual method that are halved until they change nothing more that
/// matters, or too much time is gone.
Paths paths_of_each_other(Case spec, const Scene& scene, const Particles& all, int threads, double seconds) {
  const double time = spec.output.times.back(), enough = 1e-6;
  Paths paths{all, all, 1, std::numeric_limits<double>::infinity(), ""};
  spec.time.method = time::tableaux().front().name;
  const base::Stopwatch watch;
  double last = 0;
  for (int k = 0; k < 12 && watch.seconds() + 2 * last < seconds; ++k) {
    const base::Stopwatch one;
    spec.time.step = time / (16 << k);
    Particles moved = all;
    Carrier carrier(spec, scene, threads);
    try {
      carrier.begin(moved);
    } catch (const InputError&) {  // not stable: half of it may be
      continue;
    }
    StageTimes ignored;
    carrier.carry(moved, 0, time, 0, ignored);
    // Halving takes away 15/16 of the error.
    if (last > 0) paths.known = largest_distance(moved, paths.exact) / 15 / scene.core_radius;
    paths.exact = std::move(moved);
    last = one.seconds();
    if (paths.known < enough) break;
  }
  paths.note = fmt::format("compared with {} at time.step = {:.3g}, whose own error is about {:.1g}", spec.time.method,
                           spec.time.step, paths.known);
  return paths;
}

/// The settings of a sample, as in --set.
std::string settings_of(const Sample& sample, const std::vector<std::string>& keys) {
  std::string text;
  for (std::size_t k = 0; k < keys.size() && k < sample.values.size(); ++k) {
    std::string key = keys[k], value = sample.values[k];
    if (value.rfind("tolerance ", 0) == 0) key = "time.tolerance", value = value.substr(10);
    const bool word = key == "time.method" || key == "particles.cutoff";
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, word ? '"' + value + '"' : value);
  }
  return text;
}

/// The case with other steps.
Case with_steps(Case spec, const time::Tableau& tableau, double step, double tolerance) {
  spec.time.method = tableau.name;
  spec.time.step = step;
  if (time::is_adaptive(tableau)) spec.time.tolerance = tolerance;
  return spec;
}

/// Why the case with its outputs left out does not run to its end; empty: it does.
std::string why_it_does_not_finish(Case spec, int threads) {
  spec.output.files.clear();
  spec.output.images.clear();
  spec.output.times = {spec.output.times.back()};
  spec.checks.clear();
  spec.reference = {};
  try {
    Simulation(spec, threads).run();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

Experiment study_steps(const Case& spec, int threads, double seconds) {
  Experiment experiment{.name = "steps",
                        .title = "Step and integrator",
                        .question = "How long may steps be?",
                        .keys = {"time.method", "time.step"},
                        .error_is = "largest error of a position at the last output, in core radii",
                        .seconds_are = "of transport, for all particles",
                        .samples = {},
                        .conclusion = {},
                        .notes = {}};
  const base::Stopwatch watch;
  // Only positions are studied. Effects that do not move particles are left out, but the steps that they forbid stay
  // forbidden.
  Case moving = spec;
  const bool each_other = particles_interact(spec.effects);
  const int dimension = spec.domain.dimension;
  bool tried = false;  // weights that go from particle to particle may ask for shorter steps later on
  for (const auto& [effect, written] : effects_of(spec.effects)) {
    const bool moves = effect->traits.particles_interact || effect->spreading;
    if (each_other && moves) continue;
    moving.effects.remove(written.name);
    tried = tried || effect->traits.moves_weight.of(written, dimension);
  }
  const Scene scene = make_scene(moving, threads);
  const double time = spec.output.times.back();
  const Particles all = seed_scene(scene, threads);
  if (time <= 0) {
    experiment.conclusion = "There are no steps before the last output.";
    return experiment;
  }
  // The steps that `run` accepts, by the run's own rules for the whole case.
  const Scene whole = make_scene(spec, threads);
  const Case asked = with_steps(spec, time::tableaux().front(), spec.time.end, 0);
  Carrier rules(asked, whole, threads);
  try {
    Particles seen = all;
    rules.begin(seen);
  } catch (const InputError&) {  // of this step alone
  }
  const Paths paths = each_other ? paths_of_each_other(moving, scene, all, threads, 0.4 * seconds)
                                 : paths_in_the_flow(moving, scene, all, threads);
  if (each_other) experiment.seconds_are = "of transport and of what moves particles, for all of them";
  std::map<std::string, double> orders;
  double each_rate = 0;  // seconds of one evaluation for all particles
  bool left_out = false;
  for (const time::Tableau& tableau : time::tableaux()) {
    const bool adaptive = time::is_adaptive(tableau);
    if (adaptive && !accuracy::why_not_read(with_steps(spec, tableau, 0, 1e-4)).empty()) continue;
    for (int k = 0; k < 12; ++k) {
      const double step = adaptive ? 0 : base::rounded_down(time / (8 << k), 4), tolerance = std::pow(10, -2 - k);
      if (adaptive && (tolerance < 1e-13 || (each_other && tolerance < 1e-5))) break;  // sums are right to 1e-6
      const double longest = std::min(step, spec.time.end);
      if (!adaptive && rules.longest_step(tableau, longest) < longest * (1 - 1e-9)) continue;  // would be refused
      const double steps = adaptive ? 20 : time / step;
      if (watch.seconds() + 2 * steps * tableau.stages * each_rate > seconds) {
        left_out = true;
        break;
      }
      Case varied = with_steps(moving, tableau, step, tolerance);
      varied.output.times = {time};
      Sample sample{
          .values = {tableau.name, adaptive ? fmt::format("tolerance {:.0e}", tolerance) : fmt::format("{:g}", step)}};
      try {
        Particles moved = paths.start;
        Carrier carrier(varied, scene, threads);
        if (each_other) carrier.begin(moved);
        StageTimes ignored;
        const base::Stopwatch work;
        sample.steps = carrier.carry(moved, 0, time, 0, ignored);
        base::RepeatedTime times;
        const double first = work.seconds();
        if (each_other)
          each_rate = first / static_cast<double>(std::max<std::size_t>(1, sample.steps)) / tableau.stages;
        if (first < 0.03) {  // that one warmed up
          for (int repeat = 0; repeat < 3 || (repeat < 9 && !times.repeatable()); ++repeat) {
            Particles again = paths.start;
            if (each_other) carrier.begin(again);
            const base::Stopwatch once;
            carrier.carry(again, 0, time, 0, ignored);
            times.add(once.seconds());
          }
        } else {
          times.add(first);
        }
        sample.seconds = times.fastest() * paths.scale;
        sample.confirmed = times.count() < 2 || times.repeatable();
        sample.particles = all.size();
        sample.error =
            std::max({largest_distance(moved, paths.exact) / scene.core_radius, each_other ? paths.known : 0.0, 1e-16});
      } catch (const Error& error) {
        sample.failure = error.what();
      }
      experiment.samples.push_back(sample);
      if (sample.failure.empty() &&
          (sample.error < std::max(1e-11, 3 * paths.known) || sample.seconds / paths.scale > 0.4))
        break;
    }
  }
  const double shows = std::max(1e-9, 20 * paths.known);  // below, rounding or the comparison does
  for (std::size_t i = 1; i < experiment.samples.size(); ++i) {
    Sample &before = experiment.samples[i - 1], &now = experiment.samples[i];
    if (before.values[0] != now.values[0] || !before.failure.empty() || !now.failure.empty() ||
        time::is_adaptive(time::find_tableau(now.values[0])) || now.error < shows)
      continue;
    now.order = std::log(before.error / now.error) /
                std::log(*base::read_number<double>(before.values[1]) / *base::read_number<double>(now.values[1]));
    orders[now.values[0]] = now.order;
  }
  for (const auto& [name, order] : orders)
    experiment.notes.push_back(
        fmt::format("{}: observed order {:.2f}, expected {}", name, order, time::find_tableau(name).time_order));
  if (!paths.note.empty()) experiment.notes.push_back(paths.note);
  if (left_out) experiment.notes.push_back("shorter steps were left out to stay within --seconds");

  Sample* enough = nullptr;
  while ((enough = cheapest_below(experiment, 1e-3))) {
    const bool adaptive = time::is_adaptive(time::find_tableau(enough->values[0]));
    const Case recommended =
        with_steps(spec, time::find_tableau(enough->values[0]),
                   adaptive ? spec.time.step : *base::read_number<double>(enough->values[1]),
                   adaptive ? *base::read_number<double>(enough->values[1].substr(10)) : spec.time.tolerance);
    std::string reason = accuracy::why_refused(recommended, threads);
    if (reason.empty() && tried) reason = why_it_does_not_finish(recommended, threads);
    if (reason.empty()) break;
    enough->failure = reason;
  }
  finish(experiment, spec);
  if (enough)
    experiment.conclusion = fmt::format(
        "{} is the cheapest that carries every particle to within a thousandth of its blob: {} steps, {:.2g} s.",
        settings_of(*enough, experiment.keys), enough->steps, enough->seconds);
  else
    experiment.conclusion = "No method of these carries every particle to within a thousandth of its blob.";
  return experiment;
}

Experiment study_lattice(const Case& spec, const StudyOptions& options, double seconds) {
  Experiment experiment{.name = "lattice",
                        .title = "Lattice, overlap and cutoff",
                        .question = "Finer, wider, or of higher order?",
                        .keys = {"particles.cutoff", "particles.overlap", "particles.per_axis"},
                        .error_is = "Linf at the last output, of the whole run",
                        .seconds_are = "of seeding, transport, effects and density, without the reference",
                        .samples = {},
                        .conclusion = {},
                        .notes = {}};
  const base::Stopwatch watch;
  const double c = spec.particles.overlap;
  double dearest = 0;
  std::size_t left_out = 0;
  std::vector<std::string> possible;  // cutoffs that the case may have
  for (const NamedCutoff& named : cutoffs()) {
    if (!named.parameters.empty()) continue;
    const std::string cutoff(named.name);
    Case varied = spec;
    varied.particles.cutoff = cutoff;
    varied.particles.cutoff_arguments.clear();
    if (const std::string reason = accuracy::why_not_read(varied); reason.empty())
      possible.push_back(cutoff);
    else
      experiment.notes.push_back(fmt::format("{} is not for this case: {}", cutoff, reason));
  }
  // Coarse lattices of all cutoffs come before finer ones of any, so that only the finest are left out for time.
  for (const double factor : {0.25, 0.35, 0.5, 0.7, 1.0})
    for (const double overlap : {c, 1.5 * c}) {
      for (const std::string& cutoff : possible) {
        Case varied = spec;
        varied.particles.cutoff = cutoff;
        varied.particles.cutoff_arguments.clear();
        varied.particles.overlap = *base::read_number<double>(fmt::format("{:g}", overlap));  // as it is told
        varied.particles.per_axis = std::max(8, static_cast<int>(std::lround(factor * spec.particles.per_axis)));
        if (watch.seconds() + 3 * dearest > seconds) {
          ++left_out;
          continue;
        }
        const base::Stopwatch one;
        Sample sample = measure_run(varied, options);
        dearest = std::max(dearest, one.seconds());
        sample.values = {cutoff, fmt::format("{:g}", overlap), std::to_string(varied.particles.per_axis)};
        experiment.samples.push_back(std::move(sample));
      }
    }
  std::stable_sort(experiment.samples.begin(), experiment.samples.end(), [](const Sample& a, const Sample& b) {
    return a.values[0] != b.values[0] ? a.values[0] < b.values[0] : std::stod(a.values[1]) < std::stod(b.values[1]);
  });
  finish(experiment, spec);
  if (left_out > 0)
    experiment.notes.push_back(fmt::format("{} combinations were left out to stay within --seconds", left_out));
  const Sample *best = nullptr, *now = nullptr;
  for (const Sample& sample : experiment.samples) {
    if (!sample.failure.empty()) continue;
    if (!best || sample.error < best->error) best = &sample;
    if (sample.values[0] == spec.particles.cutoff && sample.values[1] == fmt::format("{:g}", c) &&
        sample.values[2] == std::to_string(spec.particles.per_axis))
      now = &sample;
  }
  if (best) {
    const Sample* same = now ? cheapest_below(experiment, 1.05 * now->error) : nullptr;
    experiment.conclusion =
        fmt::format("The smallest error here, {:.2g}, is that of {}", best->error, settings_of(*best, experiment.keys));
    if (now && same && same != now)
      experiment.conclusion +=
          fmt::format("; the case's own {:.2g} can be had with {} in {:.2g} instead of {:.2g} s", now->error,
                      settings_of(*same, experiment.keys), same->seconds, now->seconds);
    experiment.conclusion += ".";
    experiment.notes.push_back("for a smooth density the error falls with the cutoff's order in per_axis: 2, 4, 6, 8");
  } else {
    experiment.conclusion = no_error(experiment);
  }
  return experiment;
}

Experiment study_whole(const Case& spec, const StudyOptions& options, double seconds) {
  Experiment experiment{
      .name = "whole",
      .title = "Whole runs, settings chosen for a target",
      .question = "What does one more digit cost?",
      .keys = {"accuracy.target"},
      .error_is = "Linf at the last output",
      .seconds_are = "of seeding, transport and density, without the reference and the choice of settings",
      .samples = {},
      .conclusion = {},
      .notes = {}};
  const base::Stopwatch watch;
  Sample as_it_is = measure_run(spec, options);
  as_it_is.values = {"as it is"};
  experiment.samples.push_back(as_it_is);
  if (const std::string reason = accuracy::budget_not_covered(spec); !reason.empty()) {
    experiment.notes.push_back("no settings are chosen: " + reason);
  } else {
    for (const double target : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5}) {
      Sample sample{.values = {fmt::format("{:g}", target)}};
      if (watch.seconds() > seconds) {
        experiment.notes.push_back(fmt::format("targets from {:g} on were left out to stay within --seconds", target));
        break;
      }
      try {
        const accuracy::AccuracyChoice choice = accuracy::choose_for_accuracy(spec, target, options.threads);
        sample = measure_run(choice.spec, options);
        sample.values = {fmt::format("{:g}", target)};
        experiment.notes.push_back(fmt::format("{:g}: {}", target, to_text(choice).substr(7)));
        experiment.notes.back().pop_back();
      } catch (const Error& error) {
        sample.failure = error.what();
      }
      experiment.samples.push_back(sample);
      if (!sample.failure.empty()) break;
    }
  }
  finish(experiment, spec);
  const Sample *first = nullptr, *last = nullptr;
  for (const Sample& sample : experiment.samples)
    if (sample.failure.empty() && &sample != &experiment.samples.front()) {
      if (!first) first = &sample;
      last = &sample;
    }
  if (first && last && first != last && last->error < first->error)
    experiment.conclusion =
        fmt::format("From {:.1g} to {:.1g} a digit costs {:.2g} times the time each", first->error, last->error,
                    std::pow(last->seconds / first->seconds, 1 / std::log10(first->error / last->error)));
  if (as_it_is.failure.empty()) {
    const Sample* same = cheapest_below(experiment, as_it_is.error);
    experiment.conclusion +=
        fmt::format("{} case as it is has {:.2g} in {:.2g} s", experiment.conclusion.empty() ? "The" : "; the",
                    as_it_is.error, as_it_is.seconds);
    if (same && same != &experiment.samples.front())
      experiment.conclusion += fmt::format(", and {:.2g} can be had in {:.2g} s", same->error, same->seconds);
  }
  experiment.conclusion = experiment.conclusion.empty() ? no_error(experiment) : experiment.conclusion + ".";
  return experiment;
}

}  // namespace gaussdrift::study
