#include "study/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "base/repeated_time.hpp"
#include "base/stopwatch.hpp"
#include "effect/tracer_reactions.hpp"
#include "gaussdrift/accuracy.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "particle/cutoff.hpp"
#include "study/standard_studies.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::study {

namespace {

constexpr std::size_t most_combinations = 2000;
constexpr const char* no_exact_density =
    "the case has no exact density to compare with; reference.kind = \"exact\" with a formula gives it one";

std::optional<double> number_of(const std::string& text) {
  try {
    std::size_t used = 0;
    const double value = std::stod(text, &used);
    if (used == text.size()) return value;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

double seconds_of_run(const RunSummary& summary) {
  double total = 0;
  for (const auto& [stage, seconds] : summary.stages.stages())
    if (stage == "seed" || stage == "density" || stage == "transport" || stage.rfind("effect ", 0) == 0)
      total += seconds;
  return total;
}

std::string value_or_quoted(const std::string& value) {
  // Words are strings of the case; numbers, lists and quoted texts stay.
  const bool word = !value.empty() && std::isalpha(static_cast<unsigned char>(value[0])) != 0 && value != "true" &&
                    value != "false" && value.find_first_of("*/+(") == std::string::npos;
  return word ? '"' + value + '"' : value;
}

std::string conclusion_of(const Experiment& experiment) {
  const Sample* best = nullptr;
  for (const Sample& sample : experiment.samples)
    if (sample.failure.empty() && (!best || sample.error < best->error)) best = &sample;
  if (!best) return "No combination could be run.";
  const Sample* cheap = best;
  for (const Sample& sample : experiment.samples)
    if (sample.failure.empty() && sample.error <= 1.1 * best->error && sample.seconds < cheap->seconds) cheap = &sample;
  const auto named = [&](const Sample& sample) {
    std::string text;
    for (std::size_t k = 0; k < experiment.keys.size(); ++k)
      text += fmt::format("{}{} = {}", k ? ", " : "", experiment.keys[k], sample.values[k]);
    return text;
  };
  if (cheap->seconds < 0.8 * best->seconds)
    return fmt::format("{} is as accurate as {} and {:.2g} times as fast: an error of {:.2g} in {:.2g} s.",
                       named(*cheap), named(*best), best->seconds / cheap->seconds, cheap->error, cheap->seconds);
  return fmt::format("The smallest error, {:.2g}, is that of {}, in {:.2g} s; every cheaper one is less accurate.",
                     best->error, named(*best), best->seconds);
}

}  // namespace

Variation parse_variation(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw CommandLineError(fmt::format("--vary {}: it is written key=a,b,c, as in --vary time.step=0.1,0.05", text));
  Variation variation{text.substr(0, equals), {}};
  std::string value;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = equals + 1; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ',';
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == '[' || c == '(')) ++depth;
    if (!quoted && (c == ']' || c == ')')) --depth;
    if (c != ',' || (i < text.size() && (quoted || depth > 0))) {
      value += c;
      continue;
    }
    if (value.empty()) throw CommandLineError(fmt::format("--vary {}: a value is missing", text));
    variation.values.push_back(value);
    value.clear();
  }
  return variation;
}

Sample measure_run(const Case& spec, const StudyOptions& options) {
  Sample sample;
  Case bare = spec;
  bare.output.files.clear();
  bare.output.images.clear();
  bare.output.animation.reset();
  if (!bare.output.times.empty()) bare.output.times = {bare.output.times.back()};
  bare.checks.clear();
  try {
    refuse_what_does_not_fit(bare, options.threads, options.most_memory);
    base::RepeatedTime seconds;
    std::string left_out;  // why there is no error
    // Where no two agree the machine is busy with other work: some more, to meet a quiet moment.
    const auto wanted = [&](int repeat) {
      return repeat <= options.repeats ||
             (options.repeats > 1 && !seconds.repeatable() && repeat <= 3 * options.repeats);
    };
    for (int repeat = 0; wanted(repeat); ++repeat) {
      Simulation simulation(bare, options.threads);
      const RunSummary summary = simulation.run();
      if (repeat == 0) {
        sample.particles = summary.particles;
        sample.steps = summary.steps;
        const FrameNumbers& last = summary.frames.back().second;
        if (last.error) {
          sample.error = last.error->linf;
          sample.l1 = last.error->l1;
          sample.l2 = last.error->l2;
        }
        sample.failure = last.no_norms;
        if (!last.error && !summary.warnings.empty()) left_out = summary.warnings.back();
        if (last.untraced > 0) sample.failure = "the exact density is not known at some grid points";
        bare.reference = {};  // repeats are for the time alone
      }
      const double now = seconds_of_run(summary);
      if (repeat > 0 || options.repeats == 0 || now > 1) seconds.add(now);
      if (now > 1) break;  // long runs need no warm-up
    }
    sample.seconds = seconds.fastest();
    sample.confirmed = seconds.count() < 2 || seconds.repeatable();
    if (sample.failure.empty() && !std::isfinite(sample.error))
      sample.failure = left_out.empty() ? "the case has no exact density" : left_out;
  } catch (const Error& error) {
    sample.failure = error.what();
  }
  return sample;
}

std::optional<double> expected_order(const std::string& key, const Case& spec) {
  if (key == "time.step") return time::find_tableau(spec.time.method).time_order;
  if (key == "particles.overlap") return find_cutoff(spec.particles.cutoff).order;
  if (key == "particles.per_axis") return find_cutoff(spec.particles.cutoff).order;
  return std::nullopt;
}

void finish(Experiment& experiment, const Case& spec) {
  auto& samples = experiment.samples;
  if (const auto doubtful =
          std::count_if(samples.begin(), samples.end(), [](const Sample& each) { return !each.confirmed; }))
    experiment.notes.push_back(
        fmt::format("Doubtful times: {}. Measurements differ by more than a fifth, or more digits took less time. The "
                    "machine was busy "
                    "with other work. What follows from these times is doubtful, too",
                    doubtful));
  for (Sample& sample : samples) {
    sample.on_front = sample.failure.empty();
    for (const Sample& other : samples)
      if (other.failure.empty() && other.seconds <= sample.seconds && other.error <= sample.error &&
          (other.seconds < sample.seconds || other.error < sample.error))
        sample.on_front = false;
  }
  if (experiment.keys.empty() || !expected_order(experiment.keys.back(), spec)) return;
  const std::size_t last = experiment.keys.size() - 1;
  const bool finer_if_larger = experiment.keys.back() == "particles.per_axis";
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Sample &before = samples[i - 1], &now = samples[i];
    if (!before.failure.empty() || !now.failure.empty() ||
        !std::equal(now.values.begin(), now.values.begin() + static_cast<std::ptrdiff_t>(last), before.values.begin()))
      continue;
    const auto a = number_of(before.values[last]), b = number_of(now.values[last]);
    if (a && b && *a > 0 && *b > 0 && *a != *b && before.error > 0 && now.error > 0)
      samples[i].order = std::log(now.error / before.error) / std::log(*b / *a) * (finer_if_larger ? -1 : 1);
  }
}

namespace {

/// All standard studies that go with the case.
void make_standard_studies(const Case& spec, const StudyOptions& options, Study& study) {
  const bool exact = spec.reference.kind != ReferenceSpec::Kind::none;
  for (const StandardStudy& standard : standard_studies()) {
    if (standard.compares_density && !exact) continue;
    if (options.progress) options.progress(standard.meaning);
    study.experiments.push_back(standard.make(spec, options, standard.share * options.seconds));
    if (options.table_grew) options.table_grew(study.experiments.back());
  }
  if (!exact)
    study.experiments.back().notes.push_back(std::string("lattices and whole runs are not studied: ") +
                                             no_exact_density);
}

/// Fills in the keys and returns the number of combinations of their values. Throws CommandLineError for keys that
/// cannot be varied and for too many combinations.
std::size_t combinations_of(const StudyOptions& options, std::vector<std::string>& keys) {
  std::size_t combinations = 1;
  for (const Variation& variation : options.vary) {
    for (const char* fixed : {"case", "output", "reference", "check", "accuracy", "gaussdrift"})
      if (variation.key.substr(0, variation.key.find('.')) == fixed)
        throw CommandLineError(fmt::format("--vary {}: what is in [{}] does not change a run's error or its seconds",
                                           variation.key, fixed));
    if (std::find(keys.begin(), keys.end(), variation.key) != keys.end())
      throw CommandLineError(fmt::format("--vary {}: it is given twice; all values go into one, --vary {}=a,b,c",
                                         variation.key, variation.key));
    keys.push_back(variation.key);
    combinations *= variation.values.size();
    if (combinations > most_combinations)
      throw CommandLineError(fmt::format("the study has more than {} combinations; vary less", most_combinations));
  }
  return combinations;
}

/// The values of combination i, one a key; those of the last key change first.
std::vector<std::string> combination(const std::vector<Variation>& vary, std::size_t i) {
  std::vector<std::string> values(vary.size());
  for (std::size_t rest = i, k = vary.size(); k-- > 0; rest /= vary[k].values.size())
    values[k] = vary[k].values[rest % vary[k].values.size()];
  return values;
}

/// "4", or "4 with gauss4" where other keys vary, too.
std::string order_text(double order, const std::vector<std::string>& values) {
  if (values.size() < 2) return fmt::format("{:g}", order);
  return fmt::format("{:g} with {}", order, fmt::join(values.begin(), values.end() - 1, ", "));
}

/// A note where every run has a large error.
void note_large_errors(Experiment& experiment) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Sample& sample : experiment.samples)
    if (sample.failure.empty()) smallest = std::min(smallest, sample.error);
  if (std::isfinite(smallest) && smallest > 0.3)
    experiment.notes.push_back(
        "Linf is large in every run, as at a jump of the density, where it stays at any resolution: compare L1 and L2");
}

/// Runs all combinations of values.
Experiment vary_keys(const Case& spec, const StudyOptions& options) {
  Experiment experiment{.name = "study",
                        .title = spec.title.empty() ? spec.name : spec.title,
                        .question = "What does accuracy cost here?",
                        .keys = {},
                        .error_is = "Linf at the last output, relative to the largest density",
                        .seconds_are = "of seeding, transport, effects and density, without the reference",
                        .samples = {},
                        .conclusion = {},
                        .notes = {}};
  const std::size_t combinations = combinations_of(options, experiment.keys);
  if (spec.reference.kind == ReferenceSpec::Kind::none) throw InputError(std::string("study: ") + no_exact_density);
  std::optional<Case> varied;  // the last one that could be read
  std::vector<std::string> orders;
  for (std::size_t i = 0; i < combinations; ++i) {
    const std::vector<std::string> values = combination(options.vary, i);
    std::vector<std::string> overrides = options.overrides;
    for (std::size_t k = 0; k < values.size(); ++k)
      overrides.push_back(experiment.keys[k] + "=" + value_or_quoted(values[k]));
    if (options.progress) options.progress(fmt::format("{} of {}: {}", i + 1, combinations, fmt::join(values, ", ")));
    // A key that the case does not have shows at once; a wrong value among others is a row that says so.
    Sample sample;
    try {
      varied = read_case(options.file, overrides, options.threads).spec;
      sample = measure_run(*varied, options);
    } catch (const InputError& error) {
      if (!varied) throw;
      sample.failure = error.what();
    }
    sample.values = values;
    experiment.samples.push_back(sample);
    if (const auto order = sample.failure.empty() ? expected_order(experiment.keys.back(), *varied) : std::nullopt) {
      const std::string text = order_text(*order, values);
      if (std::find(orders.begin(), orders.end(), text) == orders.end()) orders.push_back(text);
    }
    if (options.table_grew) options.table_grew(experiment);
  }
  finish(experiment, *varied);
  if (!orders.empty())
    experiment.notes.push_back(
        fmt::format("orders expected where {} decides: {}", experiment.keys.back(), fmt::join(orders, "; ")));
  note_large_errors(experiment);
  experiment.conclusion = conclusion_of(experiment);
  return experiment;
}

void refuse_what_standard_studies_do_not_know(const Case& spec) {
  constexpr const char* remedy = "vary keys instead, as in --vary particles.per_axis=100,200";
  if (!spec.sources.empty())
    throw InputError(fmt::format(
        "study: the standard studies look at the particles of the start, and [[source]] adds others later; {}",
        remedy));
  if (tracers_react(spec))
    throw InputError(fmt::format(
        "study: the standard studies know one density, and here named ones change into each other; {}", remedy));
}

}  // namespace

Study run_study(const StudyOptions& options) {
  const base::Stopwatch watch;
  const Case spec = read_case(options.file, options.overrides, options.threads).spec;
  Study study{spec.name, spec.title, {}, base::resolve_threads(options.threads), 0};
  if (options.vary.empty()) refuse_what_standard_studies_do_not_know(spec);
  if (options.vary.empty()) refuse_what_does_not_fit(spec, options.threads, options.most_memory);
  if (options.begins) options.begins();
  if (options.vary.empty())
    make_standard_studies(spec, options, study);
  else
    study.experiments.push_back(vary_keys(spec, options));
  study.seconds = watch.seconds();
  return study;
}

}  // namespace gaussdrift::study
