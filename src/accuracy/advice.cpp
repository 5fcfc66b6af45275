#include "accuracy/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "accuracy/causes.hpp"
#include "accuracy/would_run.hpp"
#include "base/number.hpp"
#include "effect/catalogue.hpp"
#include "particle/cutoff.hpp"
#include "sim/borders/edges.hpp"
#include "sim/stable_step.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::accuracy {

namespace {

/// A round number below x: 1, 2 or 5 times a power of ten.
double round_below(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double factor : {5., 2., 1.})
    if (factor * power <= x * (1 + 1e-9)) return factor * power;
  return power;
}

/// A number as it is written.
double number_of(const std::string& text) { return *base::read_number<double>(text); }

/// The longest round time.step up to `longest`, at least twice that of the case, that `run` takes; nothing if none is.
std::optional<double> longer_step(const Case& spec, const Scene& scene, double longest, int threads) {
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  // Judged as in a run: particles stand where they start.
  const double stable = estimate_stable_step(*scene.velocity, seed_scene(scene, threads), tableau, spec.time.end,
                                             longest, difference_length(scene))
                            .step;
  Case changed = spec;
  for (double step = round_below(std::min(longest, stable)); step >= 2 * spec.time.step;
       step = round_below(0.99 * step)) {
    changed.time.step = step;
    if (why_refused(changed, threads).empty()) return step;
  }
  return std::nullopt;
}

/// Would `run` take the case with this change? Lattices too large to be judged are not taken.
template <class Change>
bool runs(const Case& spec, int threads, const Change& change) {
  Case changed = spec;
  change(changed);
  const Domain& domain = changed.domain;
  const Lattice lattice = seeding_lattice(domain, changed.particles.per_axis);
  return static_cast<double>(lattice.size()) <= most_judged && why_refused(changed, threads).empty();
}

/// Longer steps where theirs is the least of the errors, shorter ones where it is the largest.
void advise_steps(const Case& spec, const Scene& scene, int threads, Budget& budget) {
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  if (time::is_adaptive(tableau) || spec.time.step <= 0) return;
  const double others = std::max({budget.smoothing, budget.quadrature, budget.transform, budget.left_out, budget.fit});
  const double step = spec.time.step, order = tableau.time_order;
  const double now = std::max(budget.time_stepping, rounding);
  if (now < 1e-2 * others) {
    const double longest = std::min(step * std::pow(1e-2 * others / now, 1 / order), spec.time.end / 8);
    if (longest < 2 * step) return;
    if (const auto longer = longer_step(spec, scene, longest, threads))
      budget.advice.push_back(fmt::format("time.step = {:g} is as accurate, with {:.0f} times fewer steps", *longer,
                                          std::floor(*longer / step + 1e-6)));
  } else if (budget.dominates == "time stepping") {
    const double shorter =
        std::max(round_below(step * std::pow(0.3 * others / now, 1 / order)), round_below(step * 1e-3));
    if (runs(spec, threads, [&](Case& changed) { changed.time.step = shorter; }))
      budget.advice.push_back(fmt::format("time.step = {:g} makes time stepping smaller than the rest", shorter));
  }
}

/// A cutoff of higher order, or finer blobs.
void advise_smoothing(const Case& spec, const Better& better, int threads, Budget& budget) {
  for (const auto& [cutoff, smoothing] : better) {
    if (smoothing > 0.5 * budget.smoothing) continue;
    const auto use_it = [&name = cutoff](Case& changed) {
      changed.particles.cutoff = name;
      changed.particles.cutoff_arguments.clear();
    };
    if (!runs(spec, threads, use_it)) continue;
    budget.advice.push_back(fmt::format("particles.cutoff = \"{}\" lowers the smoothing to {:.2g}", cutoff, smoothing));
    break;
  }
  const int finer = 2 * spec.particles.per_axis - 1;
  if (runs(spec, threads, [&](Case& changed) { changed.particles.per_axis = finer; }))
    budget.advice.push_back(fmt::format(
        "particles.per_axis = {} makes the blobs half as wide: the smoothing of a smooth density falls to 1/{}", finer,
        1 << find_cutoff(spec.particles.cutoff).order));
}

/// More overlap, or an effect that restores it.
void advise_quadrature(const Case& spec, int threads, Budget& budget) {
  const double wider = number_of(fmt::format("{:.3g}", 1.5 * spec.particles.overlap));
  std::string remedies;
  if (runs(spec, threads, [&](Case& changed) { changed.particles.overlap = wider; }))
    remedies = fmt::format("particles.overlap = {:g}", wider);
  const NamedEffect* restorer = overlap_restorer();
  if (restorer && !spec.effects.find(restorer->about.name) &&
      runs(spec, threads, [&](Case& changed) { changed.effects.set(complete_effect(*restorer, {})); }))
    remedies += std::string(remedies.empty() ? "" : ", or ") + restorers_table() + " where it strains";
  if (!remedies.empty()) budget.advice.push_back("blobs overlap too little for this flow: " + remedies);
}

/// A sharper sum.
void advise_transform(const Case& spec, int threads, Budget& budget) {
  const double sharper =
      number_of(fmt::format("{:.0e}", std::max(1e-13, 1e-3 * std::max(budget.smoothing, budget.quadrature))));
  if (sharper < spec.evaluate.tolerance &&
      runs(spec, threads, [&](Case& changed) { changed.evaluate.tolerance = sharper; }))
    budget.advice.push_back(
        fmt::format("evaluate.tolerance = {:.0e} removes the largest error at little cost", sharper));
}

}  // namespace

std::vector<std::string> higher_cutoffs(const Case& spec) {
  const int order = find_cutoff(spec.particles.cutoff).order;
  std::vector<std::string> names;
  for (const NamedCutoff& cutoff : cutoffs())
    if (cutoff.parameters.empty() && cutoff.order > order) names.emplace_back(cutoff.name);
  return names;
}

void give_advice(const Case& spec, const Scene& scene, const Better& better, int threads, Budget& budget) {
  // What makes the result better comes before what makes it cheaper.
  if (budget.dominates == "smoothing") advise_smoothing(spec, better, threads, budget);
  if (budget.dominates == "quadrature") advise_quadrature(spec, threads, budget);
  if (budget.dominates == "Gauss transform") advise_transform(spec, threads, budget);
  if (budget.dominates == "fit of samples")
    budget.advice.push_back("more samples, or another kernel, lower the largest error; no other setting does");
  if (budget.dominates == "particles left out" &&
      runs(spec, threads, [](Case& changed) { changed.particles.threshold = 0; }))
    budget.advice.push_back("particles.threshold = 0 leaves nothing out");
  advise_steps(spec, scene, threads, budget);
}

}  // namespace gaussdrift::accuracy
