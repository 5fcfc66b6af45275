// What one more digit costs: whole runs with settings that are chosen for a target.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "accuracy/forecast.hpp"
#include "accuracy/target.hpp"
#include "base/stopwatch.hpp"
#include "gaussdrift/error.hpp"
#include "render/ticks.hpp"
#include "study/standard_studies.hpp"

namespace gaussdrift::study {

namespace {

using render::told_number;

/// Its seconds are those of measure_run(): of seeding, transport and one density.
void predict(const Case& spec, const StudyOptions& options, double error, Sample& sample) {
  if (!sample.failure.empty()) return;
  try {
    const accuracy::Forecast forecast = accuracy::forecast(spec, options.threads);
    sample.predicted_seconds =
        forecast.seed_seconds + static_cast<double>(forecast.steps) * forecast.step_seconds + forecast.evaluate_seconds;
    sample.predicted_error = forecast.budget.known() ? forecast.budget.total : error;
  } catch (const Error&) {  // the run told its numbers all the same
  }
}

/// Ever smaller targets, until one cannot be met or the time is over.
void run_targets(const Case& spec, const StudyOptions& options, double seconds, const base::Stopwatch& watch,
                 Experiment& experiment) {
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
      predict(choice.spec, options, choice.predicted.total, sample);
      experiment.notes.push_back(fmt::format("{:g}: {}", target, to_text(choice).substr(7)));
      experiment.notes.back().pop_back();
    } catch (const Error& error) {
      sample.failure = error.what();
    }
    experiment.samples.push_back(sample);
    if (!sample.failure.empty()) break;
  }
}

/// Marks the case as it is, which is the first of the samples, and what can be had for less. What a digit costs, and
/// what the case as it is does.
std::string conclusion_of(Experiment& experiment) {
  Sample& as_it_is = experiment.samples.front();
  std::string text;
  const Sample *first = nullptr, *last = nullptr;
  for (const Sample& sample : experiment.samples)
    if (sample.failure.empty() && &sample != &experiment.samples.front()) {
      if (!first) first = &sample;
      last = &sample;
    }
  if (first && last && first != last && last->error < first->error)
    text = fmt::format("From {} to {} each further digit takes {:.2g} times as long", told_number(first->error, 1),
                       told_number(last->error, 1),
                       std::pow(last->seconds / first->seconds, 1 / std::log10(first->error / last->error)));
  if (as_it_is.failure.empty()) {
    Sample* same = cheapest_below(experiment, as_it_is.error);
    as_it_is.role = Sample::Role::current;
    text += fmt::format("{} case as it is has {} in {} s", text.empty() ? "The" : "; the",
                        told_number(as_it_is.error, 2), told_number(as_it_is.seconds, 2));
    if (same && same != &as_it_is) {
      same->role = Sample::Role::recommended;
      text += fmt::format(", and {} can be had in {} s", told_number(same->error, 2), told_number(same->seconds, 2));
    }
  }
  return text.empty() ? no_error(experiment) : text + ".";
}

}  // namespace

Experiment study_whole(const Case& spec, const StudyOptions& options, double seconds) {
  Experiment experiment{
      .name = "whole",
      .title = "Whole runs, settings chosen for a target",
      .question = "What does one more digit cost?",
      .keys = {"accuracy.target"},
      .error_is = "Linf at the last output, relative to the largest density",
      .seconds_are = "of seeding, transport and density, without the reference and the choice of settings",
      .samples = {},
      .conclusion = {},
      .notes = {}};
  const base::Stopwatch watch;
  experiment.samples.push_back(measure_run(spec, options));
  experiment.samples.back().values = {"as it is"};
  if (const std::string reason = accuracy::budget_not_covered(spec); !reason.empty())
    experiment.notes.push_back("no settings are chosen: " + reason);
  else {
    predict(spec, options, std::numeric_limits<double>::quiet_NaN(), experiment.samples.back());
    run_targets(spec, options, seconds, watch, experiment);
  }
  finish(experiment, spec);
  experiment.conclusion = conclusion_of(experiment);
  return experiment;
}

}  // namespace gaussdrift::study
