// What a digit of the density costs: the Gauss transform of the last output by every method and to several tolerances.
#include <fmt/format.h>
#include <fgtd/fgtd.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/nan.hpp"
#include "base/parallel.hpp"
#include "base/repeated_time.hpp"
#include "base/stopwatch.hpp"
#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/simulation.hpp"
#include "particle/cutoff.hpp"
#include "render/ticks.hpp"
#include "sim/borders/edges.hpp"
#include "sim/scene.hpp"
#include "sim/tiled_density.hpp"
#include "sim/transform.hpp"
#include "study/standard_studies.hpp"

namespace gaussdrift::study {

namespace {

using base::nan;
constexpr const char* left_out = "left out: too dear";

/// The case as far as its last output needs it.
Case bare_case(const Case& spec) {
  Case bare = spec;
  bare.output.files.clear();
  bare.output.images.clear();
  bare.output.animation.reset();
  bare.checks.clear();
  bare.reference = {};
  if (!bare.output.times.empty()) bare.output.times = {bare.output.times.back()};
  return bare;
}

Particles particles_at_end(const Case& bare, int threads) {
  Simulation simulation(bare, threads);
  simulation.run();
  return simulation.particles();
}

class TransformStudy {
 public:
  TransformStudy(const Case& bare, int threads, double seconds, Experiment& experiment)
      : experiment_(experiment),
        threads_(threads),
        seconds_(seconds),
        particles_(particles_at_end(bare, threads)),
        scene_(make_scene(bare, threads)),
        blob_(blob_of(scene_, particles_)) {
    Particles images;
    const Particles& sources = summed_particles(bare.domain, particles_, reach_of_blob(blob_, {}), images);
    if (&sources == &images) particles_ = std::move(images);
  }

  /// Seconds of the coarsest and of the finest tolerance that could be timed; NaN if none could.
  struct Seconds {
    double cheapest = nan, dearest = nan;
  };

  Seconds try_method(fgtd::Method method) {
    // 10^9 pairs a second and core.
    bool too_dear = method == fgtd::Method::direct &&
                    static_cast<double>(particles_.size()) * static_cast<double>(scene_.evaluation.size()) > 3e9;
    std::vector<Timed> timed;
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      Sample sample{.values = {fgtd::to_string(method), fmt::format("{:.0e}", tolerance)}};
      if (too_dear || (watch_.seconds() > seconds_ && method != fgtd::Method::automatic)) {
        sample.failure = left_out;
      } else {
        if (!measure(method, tolerance, sample, timed)) {
          too_dear = true;
          continue;
        }
        // The direct sum takes the same for all tolerances.
        if (sample.failure.empty()) too_dear = timed.back().time.fastest() > 1 || method == fgtd::Method::direct;
      }
      if (sample.failure != left_out || !too_dear) experiment_.samples.push_back(std::move(sample));
    }
    confirm(method, timed);
    if (timed.empty()) return {};
    return {timed.front().time.fastest(), timed.back().time.fastest()};
  }

 private:
  struct Timed {
    double tolerance;
    std::size_t place;  // of its sample
    base::RepeatedTime time{};
  };

  /// False if it is predicted to take too long.
  bool measure(fgtd::Method method, double tolerance, Sample& sample, std::vector<Timed>& timed) const {
    try {
      const DensityOptions options = options_of(method, tolerance);
      if (method != fgtd::Method::automatic &&
          predict_density(particles_, blob_, scene_.evaluation, options).seconds / base::resolve_threads(threads_) >
              seconds_)
        return false;
      DensityOptions measured = options;
      measured.measure = true;
      DensityReport report;
      evaluate_density(particles_, blob_, scene_.evaluation, measured, &report);
      sample.error = std::max(report.measured_error, 1e-16);
      timed.push_back({tolerance, experiment_.samples.size()});
      if (report.evaluate_seconds >= enough_.long_enough) timed.back().time.add(report.evaluate_seconds);
      for (int repeat = 0; repeat < 3 && report.evaluate_seconds < enough_.long_enough; ++repeat)
        measure_again(method, timed.back());  // the one before has warmed up
    } catch (const Error& error) {
      sample.failure = error.what();
    } catch (const fgtd::Error& error) {
      sample.failure = base::in_users_words(error.what(), {{"Options::tolerance = ", "a tolerance of "}});
    }
    return true;
  }

  /// Measures doubtful times some times more.
  void confirm(fgtd::Method method, std::vector<Timed>& timed) const {
    const auto doubtful_now = [&] {
      std::vector<base::RepeatedTime> times;
      for (const Timed& one : timed) times.push_back(one.time);
      return base::to_measure_again(times, enough_);
    };
    std::vector<std::size_t> doubtful = doubtful_now();
    for (int round = 0; round < 9 && !doubtful.empty() && watch_.seconds() < seconds_; ++round) {
      for (const std::size_t i : doubtful) measure_again(method, timed[i]);
      doubtful = doubtful_now();
    }
    for (std::size_t i = 0; i < timed.size(); ++i) {
      Sample& sample = experiment_.samples[timed[i].place];
      sample.seconds = timed[i].time.fastest();
      sample.confirmed = std::find(doubtful.begin(), doubtful.end(), i) == doubtful.end();
    }
  }

  void measure_again(fgtd::Method method, Timed& timed) const {
    DensityReport report;
    evaluate_density(particles_, blob_, scene_.evaluation, options_of(method, timed.tolerance), &report);
    timed.time.add(report.evaluate_seconds);
  }

  DensityOptions options_of(fgtd::Method method, double tolerance) const {
    return {.tolerance = tolerance, .method = fgtd::to_string(method), .threads = threads_};
  }

  Experiment& experiment_;
  const int threads_;
  const double seconds_;
  Particles particles_;  // that are summed: with their images beyond edges
  const Scene scene_;
  const Cutoff blob_;
  const base::EnoughTimes enough_{.long_enough = 0.3, .most = 12};
  const base::Stopwatch watch_;  // without the run that comes before
};

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
  TransformStudy study(bare_case(spec), threads, seconds, experiment);
  double cheapest = nan, dearest = nan, direct = nan;
  for (const fgtd::Method method : fgtd::methods()) {
    const auto took = study.try_method(method);
    if (method == fgtd::Method::automatic && std::isfinite(took.cheapest))
      cheapest = took.cheapest, dearest = took.dearest;
    if (method == fgtd::Method::direct) direct = took.cheapest;
  }
  finish(experiment, spec);
  experiment.conclusion =
      fmt::format("{}: {} ms at 10⁻², {} ms at 10⁻¹²",
                  dearest < 1.3 * cheapest
                      ? std::string("Digits of the sum are almost free")
                      : fmt::format("Ten digits more of the sum cost {:.2g} times the time", dearest / cheapest),
                  render::told_number(1e3 * cheapest, 2), render::told_number(1e3 * dearest, 2));
  experiment.conclusion +=
      std::isfinite(direct) ? fmt::format("; pair by pair it is {} ms.", render::told_number(1e3 * direct, 2)) : ".";
  return experiment;
}

}  // namespace gaussdrift::study
