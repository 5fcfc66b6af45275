// Finer, wider, or of higher order: whole runs with other lattices, overlaps and cutoffs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "accuracy/would_run.hpp"
#include "base/number.hpp"
#include "base/stopwatch.hpp"
#include "particle/cutoff.hpp"
#include "render/ticks.hpp"
#include "study/standard_studies.hpp"

namespace gaussdrift::study {

namespace {

/// The number of points nearest to `per_axis` that the case takes: edges that are periodic or closed want a whole number
/// of spacings. `per_axis` itself where none near it is taken.
int fitting_lattice(Case varied, int per_axis) {
  for (int away = 0; away < per_axis / 4; ++away)
    for (const int other : {per_axis + away, per_axis - away}) {
      varied.particles.per_axis = other;
      if (other >= 8 && accuracy::why_not_read(varied).empty()) return other;
    }
  return per_axis;
}

Case with_cutoff(Case spec, const std::string& cutoff) {
  spec.particles.cutoff = cutoff;
  spec.particles.cutoff_arguments.clear();
  return spec;
}

/// Cutoffs that the case may have; a note says why not another.
std::vector<std::string> possible_cutoffs(const Case& spec, Experiment& experiment) {
  std::vector<std::string> possible;
  for (const NamedCutoff& named : cutoffs()) {
    if (!named.parameters.empty()) continue;
    const std::string cutoff(named.name);
    if (const std::string reason = accuracy::why_not_read(with_cutoff(spec, cutoff)); reason.empty())
      possible.push_back(cutoff);
    else
      experiment.notes.push_back(fmt::format("{} is not for this case: {}", cutoff, reason));
  }
  return possible;
}

/// Runs all combinations that there is time for; returns how many were left out. Coarse lattices of all cutoffs come
/// before finer ones of any, so that only the finest are left out.
std::size_t run_lattices(const Case& spec, const StudyOptions& options, double seconds, Experiment& experiment) {
  const base::Stopwatch watch;
  const std::vector<std::string> possible = possible_cutoffs(spec, experiment);
  const double c = spec.particles.overlap;
  double dearest = 0;
  std::size_t left_out = 0;
  for (const double factor : {0.25, 0.35, 0.5, 0.7, 1.0})
    for (const double overlap : {c, 1.5 * c})
      for (const std::string& cutoff : possible) {
        if (watch.seconds() + 3 * dearest > seconds) {
          ++left_out;
          continue;
        }
        Case varied = with_cutoff(spec, cutoff);
        varied.particles.overlap = *base::read_number<double>(fmt::format("{:g}", overlap));  // as it is written
        varied.particles.per_axis =
            fitting_lattice(varied, std::max(8, static_cast<int>(std::lround(factor * spec.particles.per_axis))));
        const base::Stopwatch one;
        Sample sample = measure_run(varied, options);
        dearest = std::max(dearest, one.seconds());
        sample.values = {cutoff, fmt::format("{:g}", overlap), std::to_string(varied.particles.per_axis)};
        experiment.samples.push_back(std::move(sample));
      }
  std::stable_sort(experiment.samples.begin(), experiment.samples.end(), [](const Sample& a, const Sample& b) {
    return a.values[0] != b.values[0] ? a.values[0] < b.values[0] : std::stod(a.values[1]) < std::stod(b.values[1]);
  });
  return left_out;
}

/// "2, 4, 6, 8".
std::string orders_text() {
  std::set<int> orders;
  for (const NamedCutoff& cutoff : cutoffs()) orders.insert(cutoff.order);
  return fmt::format("{}", fmt::join(orders, ", "));
}

/// Marks the case's own settings and cheaper ones. The smallest error, and whether the case's own can be had for less.
std::string conclusion_of(const Case& spec, Experiment& experiment) {
  Sample *best = nullptr, *now = nullptr;
  for (Sample& sample : experiment.samples) {
    if (!sample.failure.empty()) continue;
    if (!best || sample.error < best->error) best = &sample;
    if (sample.values[0] == spec.particles.cutoff && sample.values[1] == fmt::format("{:g}", spec.particles.overlap) &&
        sample.values[2] == std::to_string(spec.particles.per_axis))
      now = &sample;
  }
  if (!best) return no_error(experiment);
  std::string text = fmt::format("The smallest error here, {}, is that of {}", render::told_number(best->error, 2),
                                 settings_of(*best, experiment.keys));
  Sample* same = now ? cheapest_below(experiment, 1.05 * now->error) : nullptr;
  if (now) now->role = Sample::Role::current;
  if (same && same != now) {
    same->role = Sample::Role::recommended;
    text += fmt::format("; the case's own {} can be had with {} in {} instead of {} s",
                        render::told_number(now->error, 2), settings_of(*same, experiment.keys),
                        render::told_number(same->seconds, 2), render::told_number(now->seconds, 2));
  }
  return text + ".";
}

}  // namespace

Experiment study_lattice(const Case& spec, const StudyOptions& options, double seconds) {
  Experiment experiment{.name = "lattice",
                        .title = "Lattice, overlap and cutoff",
                        .question = "Finer, wider, or of higher order?",
                        .keys = {"particles.cutoff", "particles.overlap", "particles.per_axis"},
                        .error_is = "Linf at the last output, relative to the largest density",
                        .seconds_are = "of seeding, transport, effects and density, without the reference",
                        .samples = {},
                        .conclusion = {},
                        .notes = {}};
  const std::size_t left_out = run_lattices(spec, options, seconds, experiment);
  finish(experiment, spec);
  if (left_out > 0)
    experiment.notes.push_back(fmt::format("{} combinations were left out to stay within --seconds", left_out));
  experiment.conclusion = conclusion_of(spec, experiment);
  if (std::any_of(experiment.samples.begin(), experiment.samples.end(),
                  [](const Sample& sample) { return sample.failure.empty(); }))
    experiment.notes.push_back(
        fmt::format("for a smooth density the error falls with the cutoff's order in per_axis: {}", orders_text()));
  return experiment;
}

}  // namespace gaussdrift::study
