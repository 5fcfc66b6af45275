#include "accuracy/target.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "accuracy/causes.hpp"
#include "accuracy/would_run.hpp"
#include "base/number.hpp"
#include "gaussdrift/error.hpp"
#include "sim/borders/edges.hpp"
#include "sim/stable_step.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double most_particles = 4e6;  // on the lattice; each costs a path for every prediction
// Parts of the target, because a prediction is right to a factor of two or so. The second is used if the first cannot
// be met. The rest is for steps and sums.
constexpr std::array aims{0.45, 0.8};
constexpr double for_steps = 0.2, for_sums = 0.02;  // parts of the target
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
  const NamedCutoff* cutoff = nullptr;
  int per_axis = 0;
  double overlap = 2;
  double error = 0;  // of both
  double quadrature = 0;
  std::size_t particles = 0;

  /// A cutoff of higher order has more terms in the transform, all in one pass.
  double dearer() const { return 1 + 0.1 * cutoff->order; }
  double cost() const { return static_cast<double>(particles) * dearer(); }
};

/// What a search may take, has taken and says while it does.
struct Search {
  Allowance allowance;
  std::function<void(const std::string&)> doing;
  std::vector<Settings> tried{};
  bool stopped = false;  // a lattice would have taken too much
  double fit = 0;        // of samples: an error that no lattice changes, as predicted last
  int threads = 0;

  const Settings* known(const NamedCutoff& cutoff, int per_axis, double overlap) const {
    for (const Settings& one : tried)
      if (one.cutoff == &cutoff && one.per_axis == per_axis && one.overlap == overlap) return &one;
    return nullptr;
  }
  /// Infinite if nothing has been tried.
  double smallest_error() const {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Settings& one : tried) smallest = std::min(smallest, one.error);
    return smallest;
  }
  /// The cheapest that has been tried with an error of at most `wanted`.
  std::optional<Settings> cheapest(double wanted) const {
    std::optional<Settings> found;
    for (const Settings& one : tried)
      if (one.error <= wanted && (!found || one.cost() < found->cost())) found = one;
    return found;
  }
};

/// Nothing if the prediction would take too much work: more than is left, or more than a sixth of the whole search,
/// because chosen settings are predicted some six times more.
std::optional<Settings> try_lattice(Case spec, int per_axis, double overlap, Search& search) {
  const NamedCutoff& cutoff = find_cutoff(spec.particles.cutoff);
  if (const Settings* known = search.known(cutoff, per_axis, overlap)) return *known;
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
  search.fit = budget.fit;
  search.tried.push_back(
      {&cutoff, per_axis, overlap, std::max(budget.total, budget.smoothing), budget.quadrature, budget.particles});
  return search.tried.back();
}

/// The nearest number with which the lattice divides all axes that are periodic or closed. Throws where there is none.
int with_whole_cells(const Domain& domain, int per_axis) {
  if (const std::vector<int> good = per_axis_with_whole_cells(domain, per_axis, 1); !good.empty()) return good.front();
  throw InputError(
      "no settings can be chosen for this accuracy: no lattice divides the lengths of all axes that are periodic or "
      "closed. Make the lengths of the domain small multiples of one length");
}

/// The coarsest lattice of this cutoff and overlap that meets `wanted`, with no more particles than `most_carried`;
/// nothing if none does, or if the search ends. `gaps`: more overlap would help, a finer lattice would not.
std::optional<Settings> find_lattice(const Case& spec, double wanted, double overlap, double most_carried,
                                     Search& search, bool& gaps) {
  const int order = find_cutoff(spec.particles.cutoff).order;
  int most = most_per_axis(spec);
  gaps = false;
  int per_axis = std::clamp(spec.particles.per_axis, fewest_per_axis, most);
  std::optional<Settings> good;
  int too_coarse = 0;
  for (int round = 0; round < 7; ++round) {
    per_axis = with_whole_cells(spec.domain, per_axis);
    const std::optional<Settings> tried = try_lattice(spec, per_axis, overlap, search);
    if (!tried) {  // too dear: is a coarser one good enough?
      most = per_axis - 1;
      per_axis = good ? (too_coarse + good->per_axis) / 2 : per_axis / 2;
      if (per_axis <= std::max(too_coarse, fewest_per_axis) || (good && per_axis > 0.93 * good->per_axis)) break;
      continue;
    }
    const Settings& trial = *tried;
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

/// Replaces `chosen` by a cheaper lattice that meets `wanted`, if there is one.
void find_cheaper(const Case& spec, double wanted, Search& search, std::optional<Settings>& chosen) {
  for (const NamedCutoff* cutoff : cutoffs_to_try()) {
    Case varied = spec;
    varied.particles.cutoff = cutoff->name;
    varied.particles.cutoff_arguments.clear();
    varied.evaluate.tolerance = 1e-8;
    // More overlap where the flow draws particles apart.
    for (const double overlap : {2.0, 3.0, 4.5, 7.0}) {
      const double cheapest = chosen ? chosen->cost() : std::numeric_limits<double>::infinity();
      bool gaps = false;
      const std::optional<Settings> trial =
          find_lattice(varied, wanted, overlap, cheapest / Settings{.cutoff = cutoff}.dearer(), search, gaps);
      if (trial && trial->cost() < cheapest) chosen = trial;
      if (!gaps) break;  // more overlap would only widen the blobs
    }
  }
}

/// What a fit to samples leaves of the target to the settings. Throws where that is nothing.
double left_by_fit(const Case& spec, double target, Search& search) {
  if (!is_fitted(make_scene(spec, search.threads))) return target;
  if (!find_cutoff(spec.particles.cutoff).parameters.empty() ||
      !try_lattice(
          spec,
          with_whole_cells(spec.domain, std::clamp(spec.particles.per_axis, fewest_per_axis, most_per_axis(spec))),
          spec.particles.overlap, search))
    return target;
  constexpr double least = 0.1;  // of the target: less is no room for settings
  if (search.fit > (1 - least) * target)
    throw InputError(fmt::format(
        "an error of {:g} cannot be met: the fit of the samples alone is predicted to be off by {:.1e}, whatever the "
        "settings are. Give more samples where the density is or comes, or another kernel or width; or accept an error "
        "of {:.1e}",
        target, search.fit, base::rounded_up(1.5 * search.fit, 2)));
  return target - search.fit;
}

/// Throws what says why a search has found nothing.
[[noreturn]] void refuse(double target, const Search& search) {
  const double best = search.smallest_error();
  const std::string too_near = best <= target ? ", which leaves too little of the target to steps and sums" : "";
  if (search.stopped)
    throw InputError(fmt::format(
        "no settings for an error of {:g} were found: the search is bounded, and {} lattices were tried{}. Finer ones "
        "were left out because their errors take too long to predict. Accept a larger error, or choose "
        "particles.per_axis and time.step yourself; `run` measures the error",
        target, search.tried.size(),
        std::isfinite(best) ? fmt::format("; the smallest error among them was {:.1e}{}", best, too_near) : ""));
  throw InputError(fmt::format(
      "an error of {:g} cannot be met with at most {:.0e} lattice points: the smallest predicted is {:.1e}{}; ask for "
      "a larger error, or make the density smoother",
      target, most_particles, best, too_near));
}

/// Chooses steps and the tolerance of the sums for this lattice, and predicts the whole. Steps have a part of the
/// target, or what the lattice leaves of it.
Case with_steps_and_sums(const Case& spec, const Settings& lattice, double target, int threads, Budget& predicted) {
  Case settled = spec;
  settled.particles.cutoff = lattice.cutoff->name;
  settled.particles.cutoff_arguments.clear();
  settled.particles.per_axis = lattice.per_axis;
  settled.particles.overlap = lattice.overlap;
  settled.evaluate.tolerance = std::clamp(base::rounded_down(for_sums * target, 2), 1e-13, 1e-3);
  const Scene scene = make_scene(settled, threads);
  const double left = target - lattice.error - settled.evaluate.tolerance;
  if (time::is_adaptive(time::find_tableau(settled.time.method)))
    settled.time.tolerance = std::min(settled.time.tolerance, 1e-2 * target);
  else
    settled.time.step =
        base::rounded_down(step_for(settled, scene, std::min(for_steps * target, 0.9 * left), threads), 2);
  predicted = predict_budget(settled, scene, Effort::whatever, threads);
  settled.accuracy.target.reset();
  return settled;
}

/// As they are written in a case.
std::vector<std::string> settings_of(const Case& spec) {
  return {fmt::format("particles.per_axis = {}", spec.particles.per_axis),
          fmt::format("particles.overlap = {:g}", spec.particles.overlap),
          fmt::format("particles.cutoff = \"{}\"", spec.particles.cutoff),
          time::is_adaptive(time::find_tableau(spec.time.method))
              ? fmt::format("time.tolerance = {:g}", spec.time.tolerance)
              : fmt::format("time.step = {:g}", spec.time.step),
          fmt::format("evaluate.tolerance = {:g}", spec.evaluate.tolerance)};
}

}  // namespace

AccuracyChoice choose_for_accuracy(const Case& spec, double target, int threads,
                                   const std::function<void(const std::string&)>& doing, double most_work) {
  if (const std::string reason = budget_not_covered(spec); !reason.empty())
    throw InputError("no settings can be chosen for this accuracy: " + reason);
  if (spec.evaluate.hermite)
    throw InputError(
        "no settings can be chosen for this accuracy: evaluate.r, p and n fix the error of the sums; leave them out");
  Search search{.allowance = {most_work}, .doing = doing, .threads = threads};
  std::optional<Settings> lattice;
  const double left = left_by_fit(spec, target, search);
  for (const double aim : aims) {
    if (lattice || (!search.tried.empty() && search.smallest_error() > left && search.fit == 0)) break;
    // One that was tried for a smaller error may do. There may be a cheaper one, as far as there is work left.
    lattice = search.cheapest(aim * left);
    find_cheaper(spec, aim * left, search, lattice);
  }
  if (!lattice) refuse(target, search);
  AccuracyChoice choice;
  choice.target = target;
  choice.lattices = search.tried.size();
  choice.work = search.allowance.spent;
  if (search.stopped)
    choice.left_out = fmt::format(
        "the search is bounded: {} lattices were tried, finer ones were left out because their errors take "
        "too long to predict; there may be cheaper settings",
        search.tried.size());
  choice.spec = with_steps_and_sums(spec, *lattice, left, threads, choice.predicted);
  if (choice.predicted.total > target)
    throw InputError(fmt::format("an error of {:g} cannot be met: the smallest predicted is {:.1e}, most of it by {}",
                                 target, choice.predicted.total, choice.predicted.dominates));
  if (const std::string reason = why_refused(choice.spec, threads); !reason.empty())
    throw InputError(fmt::format("no settings can be chosen for an error of {:g}: {}", target, reason));
  choice.settings = settings_of(choice.spec);
  return choice;
}

std::string to_text(const AccuracyChoice& choice) {
  return fmt::format("chosen {}; predicted error {:.2g} for a target of {:g}\n{}", fmt::join(choice.settings, ", "),
                     choice.predicted.total, choice.target,
                     choice.left_out.empty() ? "" : fmt::format("       {}\n", choice.left_out));
}

}  // namespace gaussdrift::accuracy
