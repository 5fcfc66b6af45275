// How long steps may be: the paths of particles by every method and several steps, compared with exact ones.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "accuracy/would_run.hpp"
#include "base/longest_side.hpp"
#include "base/number.hpp"
#include "base/repeated_time.hpp"
#include "base/stopwatch.hpp"
#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/simulation.hpp"
#include "particle/subset.hpp"
#include "reference/exact_paths.hpp"
#include "sim/carrier.hpp"
#include "sim/scene.hpp"
#include "study/standard_studies.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::study {

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
  carry_exactly(*scene.velocity, nullptr, paths.exact, 0, spec.output.times.back(),
                {.tolerance = scene.velocity->is_smooth() ? 1e-14 : 1e-10,
                 .length = longest_side(spec.domain.dimension, spec.domain.min, spec.domain.max),
                 .threads = threads});
  return paths;
}

/// Particles that move each other: all of them, and steps of the usual method that are halved until they change nothing
/// more that matters, or too much time is gone.
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
    if (last > 0) paths.known = largest_distance(moved, paths.exact) * scene.seeding.unit() / 15 / scene.core_radius;
    paths.exact = std::move(moved);
    last = one.seconds();
    if (paths.known < enough) break;
  }
  paths.note = fmt::format("compared with {} at time.step = {:.3g}, whose own error is about {:.1g}", spec.time.method,
                           spec.time.step, paths.known);
  return paths;
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
  spec.output.animation.reset();
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

/// Only positions are studied. Effects that do not move particles are left out, but the steps that they forbid stay
/// forbidden.
struct Moving {
  Case spec;
  bool tried = false;  // weights that go from particle to particle may ask for shorter steps later on
};

Moving moving_part(const Case& spec) {
  Moving moving{spec};
  moving.spec.tracers.clear();  // they change weights alone
  const bool each_other = particles_interact(spec.effects);
  for (const auto& [effect, written] : effects_of(spec.effects)) {
    const bool moves = effect->traits.particles_interact || effect->spreading;
    if (each_other && moves) continue;
    moving.spec.effects.remove(written.name);
    moving.tried = moving.tried || effect->traits.moves_weight.of(written, spec.domain.dimension);
  }
  return moving;
}

class StepsStudy {
 public:
  StepsStudy(const Case& spec, int threads, double seconds, Experiment& experiment)
      : experiment_(experiment),
        spec_(spec),
        threads_(threads),
        seconds_(seconds),
        time_(spec.output.times.back()),
        each_other_(particles_interact(spec.effects)),
        moving_(moving_part(spec)),
        scene_(make_scene(moving_.spec, threads)),
        all_(seed_scene(scene_, threads)),
        whole_(make_scene(spec, threads)),
        asked_(with_steps(spec, time::tableaux().front(), spec.time.end, 0)),
        rules_(asked_, whole_, threads) {
    try {
      Particles seen = all_;
      rules_.begin(seen);
    } catch (const InputError&) {  // of this step alone
    }
    paths_ = each_other_ ? paths_of_each_other(moving_.spec, scene_, all_, threads, 0.4 * seconds)
                         : paths_in_the_flow(moving_.spec, scene_, all_, threads);
  }

  /// Ever shorter steps of one method, until they are exact or dear.
  void try_method(const time::Tableau& tableau) {
    const bool adaptive = time::is_adaptive(tableau);
    if (adaptive && !accuracy::why_not_read(with_steps(spec_, tableau, 0, 1e-4)).empty()) return;
    for (int k = 0; k < 12; ++k) {
      const double step = adaptive ? 0 : base::rounded_down(time_ / (8 << k), 4), tolerance = std::pow(10, -2 - k);
      if (adaptive && (tolerance < 1e-13 || (each_other_ && tolerance < 1e-5))) return;  // sums are right to 1e-6
      const double longest = std::min(step, spec_.time.end);
      if (!adaptive && rules_.longest_step(tableau, longest) < longest * (1 - 1e-9)) continue;  // would be refused
      const double steps = adaptive ? 20 : time_ / step;
      if (watch_.seconds() + 2 * steps * tableau.stages * each_rate_ > seconds_) {
        left_out_ = true;
        return;
      }
      const Sample sample = take(tableau, step, tolerance);
      experiment_.samples.push_back(sample);
      if (sample.failure.empty() &&
          (sample.error < std::max(1e-11, 3 * paths_.known) || sample.seconds / paths_.scale > 0.4))
        return;
    }
  }

  /// Observed orders, how exact paths are known, and what was left out.
  void add_notes() {
    if (each_other_) experiment_.seconds_are = "of transport and of what moves particles, for all of them";
    const double shows = std::max(1e-9, 20 * paths_.known);  // below, rounding or the comparison does
    std::map<std::string, double> orders;
    for (std::size_t i = 1; i < experiment_.samples.size(); ++i) {
      Sample &before = experiment_.samples[i - 1], &now = experiment_.samples[i];
      if (before.values[0] != now.values[0] || !before.failure.empty() || !now.failure.empty() ||
          time::is_adaptive(time::find_tableau(now.values[0])) || now.error < shows)
        continue;
      now.order = std::log(before.error / now.error) /
                  std::log(*base::read_number<double>(before.values[1]) / *base::read_number<double>(now.values[1]));
      orders[now.values[0]] = now.order;
    }
    for (const auto& [name, order] : orders)
      experiment_.notes.push_back(
          fmt::format("{}: observed order {:.2f}, expected {}", name, order, time::find_tableau(name).time_order));
    if (!paths_.note.empty()) experiment_.notes.push_back(paths_.note);
    if (left_out_) experiment_.notes.push_back("shorter steps were left out to stay within --seconds");
  }

  /// The cheapest sample that is good enough and that `run` accepts; those that it refuses say why from then on. Null
  /// if there is none.
  Sample* recommend() {
    while (Sample* enough = cheapest_below(experiment_, 1e-3)) {
      const time::Tableau& tableau = time::find_tableau(enough->values[0]);
      const bool adaptive = time::is_adaptive(tableau);
      const Case recommended =
          with_steps(spec_, tableau, adaptive ? spec_.time.step : *base::read_number<double>(enough->values[1]),
                     adaptive ? *base::read_number<double>(enough->values[1].substr(10)) : spec_.time.tolerance);
      std::string reason = accuracy::why_refused(recommended, threads_);
      if (reason.empty() && moving_.tried) reason = why_it_does_not_finish(recommended, threads_);
      if (reason.empty()) return enough;
      enough->failure = reason;
    }
    return nullptr;
  }

 private:
  Sample take(const time::Tableau& tableau, double step, double tolerance) {
    const bool adaptive = time::is_adaptive(tableau);
    Case varied = with_steps(moving_.spec, tableau, step, tolerance);
    varied.output.times = {time_};
    Sample sample{
        .values = {tableau.name, adaptive ? fmt::format("tolerance {:.0e}", tolerance) : fmt::format("{:g}", step)}};
    try {
      Particles moved = paths_.start;
      Carrier carrier(varied, scene_, threads_);
      if (each_other_) carrier.begin(moved);
      StageTimes ignored;
      const base::Stopwatch work;
      sample.steps = carrier.carry(moved, 0, time_, 0, ignored);
      const double first = work.seconds();
      if (each_other_)
        each_rate_ = first / static_cast<double>(std::max<std::size_t>(1, sample.steps)) / tableau.stages;
      const base::RepeatedTime times = repeated(carrier, first);
      sample.seconds = times.fastest() * paths_.scale;
      sample.confirmed = times.count() < 2 || times.repeatable();
      sample.particles = all_.size();
      sample.error = std::max({largest_distance(moved, paths_.exact) * scene_.seeding.unit() / scene_.core_radius,
                               each_other_ ? paths_.known : 0.0, 1e-16});
    } catch (const Error& error) {
      sample.failure = error.what();
    }
    return sample;
  }

  /// The time of the same steps once more, several times if they are short: then the first has warmed up.
  base::RepeatedTime repeated(Carrier& carrier, double first) const {
    base::RepeatedTime times;
    if (first >= 0.03) {
      times.add(first);
      return times;
    }
    StageTimes ignored;
    for (int repeat = 0; repeat < 3 || (repeat < 9 && !times.repeatable()); ++repeat) {
      Particles again = paths_.start;
      if (each_other_) carrier.begin(again);
      const base::Stopwatch once;
      carrier.carry(again, 0, time_, 0, ignored);
      times.add(once.seconds());
    }
    return times;
  }

  const base::Stopwatch watch_;
  Experiment& experiment_;
  const Case& spec_;
  const int threads_;
  const double seconds_, time_;
  const bool each_other_;
  const Moving moving_;
  const Scene scene_;  // of what moves
  const Particles all_;
  const Scene whole_;  // of the case
  const Case asked_;
  Carrier rules_;  // which steps `run` accepts, by the run's own rules for the whole case
  Paths paths_;
  double each_rate_ = 0;  // seconds of one evaluation for all particles
  bool left_out_ = false;
};

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
  if (spec.output.times.back() <= 0) {
    experiment.conclusion = "There are no steps before the last output.";
    return experiment;
  }
  StepsStudy study(spec, threads, seconds, experiment);
  for (const time::Tableau& tableau : time::tableaux()) study.try_method(tableau);
  study.add_notes();
  Sample* enough = study.recommend();
  if (enough) enough->role = Sample::Role::recommended;
  finish(experiment, spec);
  experiment.conclusion =
      enough ? fmt::format(
                   "{} is the cheapest that carries every particle to within a thousandth of its blob: {} steps, "
                   "{:.2g} s.",
                   settings_of(*enough, experiment.keys), enough->steps, enough->seconds)
             : "No method of these carries every particle to within a thousandth of its blob.";
  return experiment;
}

}  // namespace gaussdrift::study
