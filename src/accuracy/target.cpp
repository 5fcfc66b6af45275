#include "accuracy/target.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "accuracy/would_run.hpp"
#include "base/number.hpp"
#include "gaussdrift/error.hpp"
#include "sim/stable_step.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double most_particles = 4e6;  // on the lattice; each costs a path for every prediction
// Parts of the target, because a prediction is right to a factor of two or so. The second is used if the first cannot
// be met.
constexpr std::array aims{0.45, 0.8};
constexpr int fewest_per_axis = 12;

int most_per_axis(const Case& spec) {
  // Lattice points along the longest axis, for the shape of this domain.
  double longest = 0, volume = 1;
  for (int k = 0; k < spec.domain.dimension; ++k) {
    const double side = spec.domain.max[k] - spec.domain.min[k];
    longest = std::max(longest, side);
    volume *= side;
  }
  const double d = spec.domain.dimension;
  return static_cast<int>(std::pow(most_particles * std::pow(longest, d) / volume, 1 / d));
}

/// Smoothing and quadrature alone: steps and transform are chosen afterwards.
struct Settings {
  int per_axis = 0;
  double overlap = 2;
  double error = 0;  // of both
  double quadrature = 0;
  std::size_t particles = 0;
};

/// What a search may take, has taken and says while it does.
struct Search {
  Allowance allowance;
  std::function<void(const std::string&)> doing;
  std::size_t lattices = 0;
  bool stopped = false;  // a lattice would have taken too much
  int threads = 0;
};

/// Nothing if the prediction would take too much work: more than is left, or more than a sixth of the whole search,
/// because chosen settings are predicted some six times more.
std::optional<Settings> try_lattice(Case spec, int per_axis, double overlap, Search& search) {
  spec.particles.per_axis = per_axis;
  spec.particles.overlap = overlap;
  if (search.doing)
    search.doing(
        fmt::format("trying cutoff = \"{}\", overlap = {:g}, per_axis = {}", spec.particles.cutoff, overlap, per_axis));
  const Scene scene = make_scene(spec, search.threads);
  Allowance one{std::min(search.allowance.left(), search.allowance.work / 6)};
  const Budget budget = predict_budget(spec, scene, one, search.threads, Causes::lattice);
  search.allowance.spent += one.spent;
  if (budget.too_dear) {
    search.stopped = true;
    return std::nullopt;
  }
  if (!budget.known()) throw InputError("no settings can be chosen for this accuracy: " + budget.not_covered);
  ++search.lattices;
  return Settings{per_axis, overlap, std::max(budget.total, budget.smoothing), budget.quadrature, budget.particles};
}

/// The coarsest lattice of this cutoff and overlap that meets `wanted`, with no more particles than `most_carried`;
/// nothing if none does, or if the search ends. `best`: the smallest error seen. `gaps`: more overlap would help, a
/// finer lattice would not.
std::optional<Settings> find_lattice(const Case& spec, double wanted, double overlap, double most_carried,
                                     Search& search, double& best, bool& gaps) {
  const int order = find_cutoff(spec.particles.cutoff).order;
  int most = most_per_axis(spec);
  gaps = false;
  int per_axis = std::clamp(spec.particles.per_axis, fewest_per_axis, most);
  std::optional<Settings> good;
  int too_coarse = 0;
  for (int round = 0; round < 7; ++round) {
    const std::optional<Settings> tried = try_lattice(spec, per_axis, overlap, search);
    if (!tried) {  // too dear: is a coarser one good enough?
      most = per_axis - 1;
      per_axis = good ? (too_coarse + good->per_axis) / 2 : per_axis / 2;
      if (per_axis <= std::max(too_coarse, fewest_per_axis) || (good && per_axis > 0.93 * good->per_axis)) break;
      continue;
    }
    const Settings& trial = *tried;
    best = std::min(best, trial.error);
    // Particles are drawn apart, so their sum has ripples, however fine the lattice.
    gaps = trial.quadrature > 0.3 * trial.error;
    if (trial.error > wanted && (gaps || static_cast<double>(trial.particles) > most_carried)) return std::nullopt;
    if (trial.error <= wanted) {
      if (!good || trial.per_axis < good->per_axis) good = trial;
    } else {
      too_coarse = std::max(too_coarse, per_axis);
    }
    // The error falls with the order of the cutoff, until something rougher shows; half of the order is safe upwards.
    const double ratio = trial.error / (0.75 * wanted);
    const double exponent = ratio > 1 ? 1.0 / std::max(1.0, 0.75 * order) : 1.0 / order;
    int next = static_cast<int>(std::lround(per_axis * std::clamp(std::pow(ratio, exponent), 0.25, 4.0)));
    next = std::clamp(next, fewest_per_axis, most);
    if (good && next >= good->per_axis) break;
    if (next <= too_coarse) next = good ? (too_coarse + good->per_axis) / 2 : std::min(most, 2 * per_axis);
    if (next == per_axis || next <= too_coarse) break;
    if (good && next > 0.93 * good->per_axis) break;
    per_axis = next;
  }
  return good;
}

double step_for(const Case& spec, const Scene& scene, double wanted, int threads) {
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  Case trial = spec;
  const Particles particles = seed_scene(scene, threads);
  const auto stable = [&](double step) {
    return estimate_stable_step(*scene.velocity, particles, tableau, spec.time.end, step, difference_length(scene))
        .step;
  };
  trial.time.step = stable(std::min(spec.time.end / 16, 10 * spec.time.step));
  for (int round = 0; round < 4; ++round) {
    const Budget budget = predict_budget(trial, scene, Effort::whatever, threads);
    const double ratio = budget.time_stepping / wanted;
    if (ratio <= 1 && (ratio > 0.05 || round > 0)) break;
    const double next = trial.time.step * std::clamp(std::pow(ratio * 1.3, -1.0 / tableau.time_order), 0.05, 4.0);
    if (ratio <= 1 && next <= 1.2 * trial.time.step) break;
    const double bounded = stable(std::min(next, spec.time.end / 8));
    if (std::abs(bounded / trial.time.step - 1) < 0.05) break;
    trial.time.step = bounded;
  }
  return trial.time.step;
}

/// Those without parameters of their own. The lowest order comes last: it needs by far the finest lattices.
std::vector<const NamedCutoff*> cutoffs_to_try() {
  std::vector<const NamedCutoff*> list;
  for (const NamedCutoff& cutoff : cutoffs())
    if (cutoff.parameters.empty()) list.push_back(&cutoff);
  std::stable_partition(list.begin(), list.end(), [](const NamedCutoff* cutoff) { return cutoff->order > 2; });
  return list;
}

}  // namespace

AccuracyChoice choose_for_accuracy(const Case& spec, double target, int threads,
                                   const std::function<void(const std::string&)>& doing, double most_work) {
  if (const std::string reason = budget_not_covered(spec); !reason.empty())
    throw InputError("no settings can be chosen for this accuracy: " + reason);
  AccuracyChoice choice;
  choice.target = target;
  Search search{.allowance = {most_work}, .doing = doing, .threads = threads};
  double best = std::numeric_limits<double>::infinity(), cheapest = best;
  std::optional<Case> chosen;
  for (const double aim : aims) {
    if (chosen || (std::isfinite(best) && best > target)) break;
    for (const NamedCutoff* cutoff : cutoffs_to_try()) {
      Case varied = spec;
      varied.particles.cutoff = cutoff->name;
      varied.particles.cutoff_arguments.clear();
      varied.evaluate.tolerance = 1e-8;
      // More overlap where the flow draws particles apart.
      for (const double overlap : {2.0, 3.0, 4.5, 7.0}) {
        const double dearer = 1 + 0.1 * cutoff->order;  // more terms in the transform, all in one pass
        bool gaps = false;
        const std::optional<Settings> trial =
            find_lattice(varied, aim * target, overlap, cheapest / dearer, search, best, gaps);
        if (!trial && gaps) continue;
        if (!trial) break;
        const double cost = static_cast<double>(trial->particles) * dearer;
        if (cost < cheapest) {
          cheapest = cost;
          chosen = varied;
          chosen->particles.per_axis = trial->per_axis;
          chosen->particles.overlap = overlap;
        }
        if (!gaps) break;  // more overlap would only widen the blobs
      }
    }
  }
  choice.lattices = search.lattices;
  choice.work = search.allowance.spent;
  if (!chosen && search.stopped)
    throw InputError(fmt::format(
        "no settings for an error of {:g} were found: the search is bounded, and {} lattices were tried{}. Finer ones "
        "were left out because their errors take too long to predict. Choose particles.per_axis and time.step "
        "yourself; "
        "`run` measures the error",
        target, search.lattices,
        std::isfinite(best) ? fmt::format(", with errors of {:.1e} at least", best) : std::string()));
  if (search.stopped)
    choice.left_out = fmt::format(
        "the search is bounded: {} lattices were tried, finer ones were left out because their errors take "
        "too long to predict; there may be cheaper settings",
        search.lattices);
  if (!chosen)
    throw InputError(fmt::format(
        "an error of {:g} cannot be met with at most {:.0e} lattice points: the smallest predicted is {:.1e}; ask for "
        "a larger error, or make the density smoother",
        target, most_particles, best));
  Case& settled = *chosen;
  settled.evaluate.tolerance = std::clamp(base::rounded_down(0.02 * target, 2), 1e-13, 1e-3);
  {
    const Scene scene = make_scene(settled, threads);
    if (time::is_adaptive(time::find_tableau(settled.time.method)))
      settled.time.tolerance = std::min(settled.time.tolerance, 1e-2 * target);
    else
      settled.time.step = base::rounded_down(step_for(settled, scene, 0.2 * target, threads), 2);
    choice.predicted = predict_budget(settled, scene, Effort::whatever, threads);
  }
  if (choice.predicted.total > target)
    throw InputError(fmt::format("an error of {:g} cannot be met: {} alone is predicted to make {:.1e}", target,
                                 choice.predicted.dominates, choice.predicted.total));
  settled.accuracy.target.reset();
  if (const std::string reason = why_refused(settled, threads); !reason.empty())
    throw InputError(fmt::format("no settings can be chosen for an error of {:g}: {}", target, reason));
  choice.settings = {fmt::format("particles.per_axis = {}", settled.particles.per_axis),
                     fmt::format("particles.overlap = {:g}", settled.particles.overlap),
                     fmt::format("particles.cutoff = \"{}\"", settled.particles.cutoff),
                     time::is_adaptive(time::find_tableau(settled.time.method))
                         ? fmt::format("time.tolerance = {:g}", settled.time.tolerance)
                         : fmt::format("time.step = {:g}", settled.time.step),
                     fmt::format("evaluate.tolerance = {:g}", settled.evaluate.tolerance)};
  choice.spec = std::move(settled);
  return choice;
}

std::string to_text(const AccuracyChoice& choice) {
  return fmt::format("chosen {}; predicted error {:.2g} for a target of {:g}\n{}", fmt::join(choice.settings, ", "),
                     choice.predicted.total, choice.target,
                     choice.left_out.empty() ? "" : fmt::format("       {}\n", choice.left_out));
}

}  // namespace gaussdrift::accuracy
