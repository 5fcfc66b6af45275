#include "accuracy/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "accuracy/would_run.hpp"
#include "base/longest_side.hpp"
#include "base/number.hpp"
#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "particle/subset.hpp"
#include "reference/exact_paths.hpp"
#include "reference/reference.hpp"
#include "reference/sample.hpp"
#include "sim/carrier.hpp"
#include "sim/comparison.hpp"
#include "sim/landings.hpp"
#include "sim/outside.hpp"
#include "sim/scene.hpp"
#include "sim/stable_step.hpp"
#include "sim/stepper.hpp"
#include "sim/transform.hpp"
#include "sim/work.hpp"
#include "time/schedule.hpp"

namespace gaussdrift::accuracy {

namespace {

// The parts of a run's work that may go into telling its errors apart afterwards, and into predicting them. A tenth of
// a second is always allowed.
constexpr double share_measured = 0.09, share_predicted = 0.05, few = 2.5e6;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double rounding = 1e-14;  // no cause is told to be smaller

double extent(const Case& spec) {
  return longest_side(spec.domain.dimension, spec.domain.min, spec.domain.max);
}

/// Beyond `widths` of the widest Gaussian nothing is summed: 5 leave 1e-11 of a blob's height, 6 leave 1e-15.
double reach_of(const Cutoff& cutoff, double widths) {
  double widest = 0;
  for (const CutoffTerm& term : cutoff) widest = std::max(widest, term.width);
  return widths * widest;
}

Vector grid_point(const Lattice& lattice, std::size_t index) {
  Vector x{};
  for (int k = 0; k < lattice.dimension; ++k) {
    x[k] = lattice.coordinate(k, index % lattice.points[k]);
    index /= lattice.points[k];
  }
  return x;
}

double distance_squared(const Vector& a, const Vector& b, int dimension) {
  double square = 0;
  for (int k = 0; k < dimension; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return square;
}

struct Probe {
  std::size_t index = 0;  // on the evaluation lattice
  Vector x{};
  double exact = 0;
};

PointsView view_of(const std::array<std::vector<double>, max_dimension>& axis, int dimension) {
  PointsView view{dimension, axis[0].size(), {}};
  for (int k = 0; k < dimension; ++k) view.axis[k] = axis[k].data();
  return view;
}

std::array<std::vector<double>, max_dimension> places_of(const std::vector<Probe>& probes, int dimension) {
  std::array<std::vector<double>, max_dimension> axis;
  for (const Probe& probe : probes)
    for (int k = 0; k < dimension; ++k) axis[k].push_back(probe.x[k]);
  return axis;
}

std::vector<double> sums_at(const std::vector<Probe>& probes, const Particles& particles, const Cutoff& cutoff,
                            int threads) {
  const auto axis = places_of(probes, particles.dimension);
  return sum_blobs(particles, cutoff, view_of(axis, particles.dimension), threads);
}

/// The particles within reach of a probe, as numbers.
std::vector<std::size_t> near(const std::vector<Probe>& probes, const Particles& particles, double reach) {
  std::vector<std::size_t> found;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    Vector x{};
    for (int k = 0; k < particles.dimension; ++k) x[k] = particles.position[k][j];
    if (std::any_of(probes.begin(), probes.end(), [&](const Probe& probe) {
          return distance_squared(x, probe.x, particles.dimension) <= reach * reach;
        }))
      found.push_back(j);
  }
  return found;
}

/// The lattice points of some particles, with their weights at the start.
Particles at_start(const Particles& particles, const std::vector<std::size_t>& chosen, const Scene& scene) {
  Particles start;
  start.dimension = particles.dimension;
  for (const std::size_t j : chosen) {
    const Vector x = grid_point(scene.seeding, static_cast<std::size_t>(particles.id[j]));
    for (int k = 0; k < start.dimension; ++k) start.position[k].push_back(x[k]);
    start.id.push_back(particles.id[j]);
  }
  start.alpha.assign(chosen.size(), 0.0);
  scene.density->add(start.view(), start.alpha.data());
  const double cell = std::pow(scene.seeding.spacing, start.dimension);
  for (double& alpha : start.alpha) alpha *= cell;
  return start;
}

/// The same blobs half a spacing aside on every axis: one in each cell of the lattice that has one of `start` at a
/// corner. Outside the lattice neither density nor velocity need be defined.
Particles between(const Particles& start, const Scene& scene) {
  const Lattice& lattice = scene.seeding;
  std::vector<std::size_t> cells;  // cell i of an axis is left of lattice point i; there is one more than points
  for (const auto id : start.id)
    for (int corner = 0; corner < (1 << start.dimension); ++corner) {
      std::size_t rest = static_cast<std::size_t>(id), cell = 0, stride = 1;
      bool inside = true;
      for (int k = 0; k < start.dimension; ++k) {
        const std::size_t i = rest % lattice.points[k] + static_cast<std::size_t>(corner >> k & 1);
        inside = inside && 0 < i && i < lattice.points[k];
        cell += stride * i;
        rest /= lattice.points[k];
        stride *= lattice.points[k] + 1;
      }
      if (inside) cells.push_back(cell);
    }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  Particles moved;
  moved.dimension = start.dimension;
  for (std::size_t cell : cells) {
    for (int k = 0; k < start.dimension; ++k) {
      moved.position[k].push_back(lattice.coordinate(k, cell % (lattice.points[k] + 1)) - lattice.spacing / 2);
      cell /= lattice.points[k] + 1;
    }
    moved.id.push_back(0);
  }
  moved.alpha.assign(cells.size(), 0.0);
  scene.density->add(moved.view(), moved.alpha.data());
  const double volume = std::pow(lattice.spacing, start.dimension);
  for (double& alpha : moved.alpha) alpha *= volume;
  return moved;
}

/// NaN if some difference is NaN.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= largest)) largest = difference;
    if (std::isnan(largest)) break;
  }
  return largest;
}

/// At least `rounding`; NaN stays NaN.
double at_least_rounding(double error) { return error < rounding ? rounding : error; }

/// A budget with a number that could not be computed says so instead.
Budget checked(Budget budget) {
  for (const double error : {budget.time_stepping, budget.smoothing, budget.quadrature, budget.total})
    if (budget.known() && !std::isfinite(error))
      budget.not_covered = "density or velocity are not finite somewhere between the lattice points";
  return budget;
}

std::vector<double> exact_of(const std::vector<Probe>& probes) {
  std::vector<double> exact;
  for (const Probe& probe : probes) exact.push_back(probe.exact);
  return exact;
}

/// Grid points with large errors, not beside each other, and the one of the largest density.
std::vector<Probe> choose_probes(const Lattice& lattice, const std::vector<std::size_t>& points,
                                 const std::vector<double>& rho, const std::vector<double>& exact, double apart,
                                 std::size_t most) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(exact[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(rho[a] - exact[a]) > std::abs(rho[b] - exact[b]);
  });
  if (order.empty()) return {};
  // The largest density comes second: smoothing is often worst there, and nothing cancels there.
  const auto top = std::max_element(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(exact[a]) < std::abs(exact[b]);
  });
  std::rotate(order.begin() + (order.size() > 1 ? 1 : 0), top, top + 1);
  std::vector<Probe> probes;
  for (const std::size_t i : order) {
    if (probes.size() == most) break;
    const Probe probe{points[i], grid_point(lattice, points[i]), exact[i]};
    if (std::all_of(probes.begin(), probes.end(), [&](const Probe& other) {
          return distance_squared(probe.x, other.x, lattice.dimension) > apart * apart;
        }))
      probes.push_back(probe);
  }
  return probes;
}

/// A round number below x: 1, 2 or 5 times a power of ten.
double round_below(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double factor : {5., 2., 1.})
    if (factor * power <= x * (1 + 1e-9)) return factor * power;
  return power;
}

void find_dominating(Budget& budget) {
  const std::array<std::pair<const char*, double>, 5> causes{{{"time stepping", budget.time_stepping},
                                                              {"smoothing", budget.smoothing},
                                                              {"quadrature", budget.quadrature},
                                                              {"Gauss transform", budget.transform},
                                                              {"particles left out", budget.left_out}}};
  const auto largest =
      std::max_element(causes.begin(), causes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  budget.dominates = largest->first;
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

/// Advice that follows from the numbers, and that `run` does not refuse. `better`: the smoothing of cutoffs of higher
/// order at the same width.
void give_advice(const Case& spec, const Scene& scene, const std::vector<std::pair<std::string, double>>& better,
                 int threads, Budget& budget) {
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  const double others = std::max({budget.smoothing, budget.quadrature, budget.transform, budget.left_out});
  const auto runs = [&](const auto& change) {
    Case changed = spec;
    change(changed);
    const Domain& domain = changed.domain;
    const Lattice lattice = make_lattice(domain.dimension, domain.min, domain.max, changed.particles.per_axis);
    return static_cast<double>(lattice.size()) <= most_judged && why_refused(changed, threads).empty();
  };
  if (!time::is_adaptive(tableau) && spec.time.step > 0) {
    const double step = spec.time.step, order = tableau.time_order;
    const double now = std::max(budget.time_stepping, rounding);
    if (now < 1e-2 * others) {
      const double longest = std::min(step * std::pow(1e-2 * others / now, 1 / order), spec.time.end / 8);
      if (longest >= 2 * step)
        if (const auto longer = longer_step(spec, scene, longest, threads))
          budget.advice.push_back(fmt::format("time.step = {:g} is as accurate, with {:.0f} times fewer steps", *longer,
                                              std::floor(*longer / step + 1e-6)));
    } else if (budget.dominates == "time stepping") {
      const double shorter =
          std::max(round_below(step * std::pow(0.3 * others / now, 1 / order)), round_below(step * 1e-3));
      if (runs([&](Case& changed) { changed.time.step = shorter; }))
        budget.advice.push_back(fmt::format("time.step = {:g} makes time stepping smaller than the rest", shorter));
    }
  }
  if (budget.dominates == "smoothing") {
    for (const auto& [cutoff, smoothing] : better) {
      if (smoothing > 0.5 * budget.smoothing) continue;
      const auto use_it = [&name = cutoff](Case& changed) {
        changed.particles.cutoff = name;
        changed.particles.cutoff_arguments.clear();
      };
      if (!runs(use_it)) continue;
      budget.advice.push_back(
          fmt::format("particles.cutoff = \"{}\" lowers the smoothing to {:.2g}", cutoff, smoothing));
      break;
    }
    const int finer = 2 * spec.particles.per_axis - 1;
    if (runs([&](Case& changed) { changed.particles.per_axis = finer; }))
      budget.advice.push_back(fmt::format(
          "particles.per_axis = {} halves the width of the blobs: a smooth density's smoothing falls {} times", finer,
          1 << find_cutoff(spec.particles.cutoff).order));
  }
  if (budget.dominates == "quadrature") {
    const double wider = number_of(fmt::format("{:.3g}", 1.5 * spec.particles.overlap));
    std::string remedies;
    if (runs([&](Case& changed) { changed.particles.overlap = wider; }))
      remedies = fmt::format("particles.overlap = {:g}", wider);
    const NamedEffect* restorer = overlap_restorer();
    if (restorer && runs([&](Case& changed) { changed.effects.set(complete_effect(*restorer, {})); }))
      remedies += std::string(remedies.empty() ? "" : ", or ") + restorers_table() + " where it strains";
    if (!remedies.empty()) budget.advice.push_back("blobs overlap too little for this flow: " + remedies);
  }
  if (budget.dominates == "Gauss transform") {
    const double sharper =
        number_of(fmt::format("{:.0e}", std::max(1e-13, 1e-3 * std::max(budget.smoothing, budget.quadrature))));
    if (sharper < spec.evaluate.tolerance && runs([&](Case& changed) { changed.evaluate.tolerance = sharper; }))
      budget.advice.push_back(
          fmt::format("evaluate.tolerance = {:.0e} removes the largest error at little cost", sharper));
  }
  if (budget.dominates == "particles left out" && runs([](Case& changed) { changed.particles.threshold = 0; }))
    budget.advice.push_back("particles.threshold = 0 leaves nothing out");
}

/// Cutoffs of higher order than the case's that need no parameters, by name.
std::vector<std::string> higher_cutoffs(const Case& spec) {
  const int order = find_cutoff(spec.particles.cutoff).order;
  std::vector<std::string> names;
  for (const NamedCutoff& cutoff : cutoffs())
    if (cutoff.parameters.empty() && cutoff.order > order) names.emplace_back(cutoff.name);
  return names;
}

/// How particles are carried to the last output when causes are told apart.
struct Carrying {
  bool exactly = true;        // else by steps of the case, `factor` times as long
  ExactPathsOptions paths{};  // exactly
  double factor = 1;
};

void carry_by_steps(const Case& spec, const Scene& scene, Particles& particles, double factor, int threads) {
  Case longer = spec;
  longer.time.step *= factor;
  if (time::is_adaptive(time::find_tableau(longer.time.method))) longer.time.tolerance *= std::pow(factor, 5);
  Carrier carrier(longer, scene, threads);
  carrier.begin(particles);
  StageTimes ignored;
  double now = 0;
  std::size_t steps = 0;
  const double last = spec.output.times.back();
  for (const double to : landings(spec)) {
    if (to > last) break;
    steps += carrier.carry(particles, now, to, steps, ignored);
    now = to;
  }
}

/// False if a path could not be followed.
bool carry(const Case& spec, const Scene& scene, const Carrying& how, Particles& particles) {
  if (particles.size() == 0) return true;
  if (how.exactly)
    return carry_exactly(*scene.velocity, scene.decay_rate.get(), particles, 0, spec.output.times.back(),
                         how.paths)
               .lost == 0;
  carry_by_steps(spec, scene, particles, how.factor, how.paths.threads);
  return true;
}

/// The error of the steps is what halving them changes, times this. Past a kink a method has order 2 at most.
double of_halved_steps(const Case& spec, const Scene& scene) {
  const int order = time::find_tableau(spec.time.method).time_order;
  return 1 / (1 - std::pow(0.5, has_smooth_paths(scene) ? order : std::min(order, 2)));
}

/// What was left out of the lattice, at most, relative to the norm; where weights grow, by as much as the largest of
/// those carried did.
double bound_of_left_out(const Scene& scene, const SeedReport& report, const Particles& start, const Particles& carried,
                         double norm) {
  if (report.left_out == 0) return 0;
  double growth = 1;
  for (std::size_t j = 0; scene.decay_rate && j < carried.size(); ++j)
    if (start.alpha[j] != 0) growth = std::max(growth, std::abs(carried.alpha[j] / start.alpha[j]));
  return growth * density_left_out(scene, report) / norm;
}

double sum_of_weights(const Particles& particles) {
  double sum = 0;
  for (const double alpha : particles.alpha) sum += std::abs(alpha);
  return sum;
}

/// Without mass on the grid there is no error to explain, and no setting changes one.
std::string nothing_to_explain(const Particles& last, double outside, double time) {
  const double weight = sum_of_weights(last);
  if (weight > 0 && !is_all(outside)) return "";
  return fmt::format("at t = {:.4g} {}", time, why_nothing_is_left(outside, weight));
}

constexpr const char* too_much_work =
    "this would take longer than a prediction may; accuracy.budget = \"measured\" lets the run tell its errors apart";
constexpr const char* lost_paths = "the paths of some particles could not be followed";

using Better = std::vector<std::pair<std::string, double>>;

/// The smoothing of cutoffs of higher order, of the same width.
Better smoothing_of_others(const Case& spec, const Scene& scene, const std::vector<Probe>& probes,
                           const Particles& particles, double norm, int threads) {
  Better better;
  for (const std::string& name : higher_cutoffs(spec)) {
    const Cutoff cutoff = make_cutoff(name, particles.dimension, scene.core_radius);
    better.emplace_back(name, largest_difference(sums_at(probes, particles, cutoff, threads), exact_of(probes)) / norm);
  }
  return better;
}

/// Smoothing and quadrature at the probes: sums over the lattice (`sums`, of particles that began at `start`) and over
/// the same lattice half a spacing aside. Moving a lattice changes the sign of its error, but for a far smaller part.
/// So the mean of the two sums is the integral, and half their difference is the error.
void tell_smoothing_and_quadrature(const Case& spec, const Scene& scene, const std::vector<Probe>& probes,
                                   const Particles& start, std::vector<double> sums, double norm, const Carrying& how,
                                   Budget& budget, Better& better) {
  Particles aside = between(start, scene);
  if (!carry(spec, scene, how, aside)) {
    budget.not_covered = lost_paths;
    return;
  }
  const std::vector<double> other = sums_at(probes, aside, scene.cutoff, how.paths.threads);
  budget.quadrature = at_least_rounding(largest_difference(sums, other) / 2 / norm);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = (sums[i] + other[i]) / 2;
  budget.smoothing = at_least_rounding(largest_difference(sums, exact_of(probes)) / norm);
  better = smoothing_of_others(spec, scene, probes, aside, norm, how.paths.threads);
}

/// Every `stride`-th lattice point on each axis, weights scaled.
Particles thinned(const Particles& particles, const Lattice& lattice, std::size_t stride) {
  std::vector<std::size_t> chosen;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    auto rest = static_cast<std::size_t>(particles.id[j]);
    bool kept = true;
    for (int k = 0; k < particles.dimension; ++k) {
      kept = kept && rest % lattice.points[k] % stride == 0;
      rest /= lattice.points[k];
    }
    if (kept) chosen.push_back(j);
  }
  Particles thin = subset(particles, chosen);
  for (double& alpha : thin.alpha) alpha *= std::pow(static_cast<double>(stride), particles.dimension);
  return thin;
}

double predict_time_stepping(const Case& spec, const Scene& scene, const Particles& seeded,
                             const std::vector<Probe>& places, double norm, const ExactPathsOptions& paths) {
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  const double time = spec.output.times.back();
  const bool smooth_paths = has_smooth_paths(scene);
  std::size_t stride = 1;
  Particles thin = seeded;
  // As long as the blobs still overlap.
  while (thin.size() > 3000 && static_cast<double>(stride) < 2 * spec.particles.overlap)
    thin = thinned(seeded, scene.seeding, ++stride);
  if (thin.size() == 0) thin = seeded;
  // Longer steps if those of the case are many, as long as they stay stable; their error is scaled back.
  double factor = 1;
  constexpr double affordable = 4e7;  // particles times steps times stages: a fifth of a second on a core
  const auto steps = static_cast<double>(total_steps(spec));
  if (!time::is_adaptive(tableau) && smooth_paths)
    while (static_cast<double>(thin.size()) * steps * tableau.stages / factor > affordable &&
           2 * factor * spec.time.step < time / 16 &&
           estimate_stable_step(*scene.velocity, thin, tableau, spec.time.end,
                                2 * factor * spec.time.step, difference_length(scene))
                   .step >= 2 * factor * spec.time.step)
      factor *= 2;
  Particles stepped = thin, followed = thin;
  carry_by_steps(spec, scene, stepped, factor, paths.threads);
  Carrying better{.exactly = smooth_paths, .paths = paths, .factor = 0.5};
  better.paths.tolerance = 1e-13;
  if (!carry(spec, scene, better, followed)) return nan;
  double changed = largest_difference(sums_at(places, stepped, scene.cutoff, paths.threads),
                                      sums_at(places, followed, scene.cutoff, paths.threads));
  if (!smooth_paths) changed *= of_halved_steps(spec, scene);
  return at_least_rounding(changed / norm * std::pow(factor, -tableau.time_order));
}

/// Evaluations of the velocity of one particle in all steps.
double rates_of_steps(const Case& spec, const Scene& scene) {
  return work_of(spec, scene, 1).transport / scene.velocity->cost();
}

double work_allowed(const Case& spec, const Scene& scene, std::size_t particles, double share) {
  return std::max(few, share * work_of(spec, scene, particles).total());
}

/// The work of carrying one particle along its exact path, found with a few particles. An eighth of `allowed` may be
/// spent on that; infinite if it is not enough.
double work_of_a_path(const Case& spec, const Scene& scene, const Particles& particles, const Carrying& how,
                      double allowed) {
  if (!how.exactly) return rates_of_steps(spec, scene) * scene.velocity->cost() / how.factor;
  std::vector<std::size_t> some;
  const std::size_t wanted = std::min<std::size_t>(32, particles.size());
  for (std::size_t i = 0; i < wanted; ++i) some.push_back(i * particles.size() / wanted);
  Particles trial = at_start(particles, some, scene);
  ExactPathsOptions options = how.paths;
  constexpr double stages = 12;
  const double bound = allowed / (8 * stages * static_cast<double>(wanted) * work_of_exact_rate(scene));
  options.most_steps = static_cast<std::size_t>(std::clamp(bound, 16.0, static_cast<double>(how.paths.most_steps)));
  const ExactPaths paths =
      carry_exactly(*scene.velocity, scene.decay_rate.get(), trial, 0, spec.output.times.back(), options);
  if (options.most_steps < how.paths.most_steps && 2 * paths.lost > wanted)
    return std::numeric_limits<double>::infinity();
  return std::max(1.0, static_cast<double>(paths.rates) / static_cast<double>(wanted)) * work_of_exact_rate(scene);
}

/// How the causes are told apart at the probes after a run.
struct Telling {
  double widths = 5;       // of the Gaussian, that count as near a probe
  std::size_t stride = 1;  // of the lattice points whose exact paths tell the time stepping
  Carrying sharp{};        // of those
  Carrying moved{};        // of the lattice half a spacing aside
  std::vector<Probe> probes{};
  std::vector<std::size_t> around{};
};

/// The sharpest way whose work is allowed. Many probes come before one, and all paths at 3e-14 before some at 1e-10 or
/// by shorter steps. None if even one probe takes too much.
std::optional<Telling> choose_telling(const Case& spec, const Scene& scene, const Particles& particles,
                                      const std::vector<Probe>& places, Effort effort, const ExactPathsOptions& paths) {
  const auto overlaps = std::max<std::size_t>(1, static_cast<std::size_t>(spec.particles.overlap / 1.5));
  const bool smooth = has_smooth_paths(scene);
  const Carrying steps{.exactly = false, .paths = paths};
  Carrying halves = steps;
  halves.factor = 0.5;
  const double allowed = effort == Effort::whatever
                             ? std::numeric_limits<double>::infinity()
                             : work_allowed(spec, scene, particles.size(), share_measured) * 2 / 3;
  const double step_work = work_of_a_path(spec, scene, particles, steps, allowed);
  struct Way {
    double widths;
    std::size_t stride;
    double tolerance;  // of exact paths; 0: by steps half as long
  };
  std::vector<Way> ways{{6, 1, 3e-14}, {5, 1, 1e-10}, {5, overlaps, 1e-10}, {4, overlaps, 0}};
  if (!smooth) ways = {{6, 1, 0}, {5, 1, 0}, {4, overlaps, 0}};  // an exact path through kinks is dear
  std::vector<Telling> tellings;
  std::vector<std::array<double, 2>> work;  // of a particle near a probe; of one aside
  for (const Way& way : ways) {
    Carrying sharp = halves;
    if (way.tolerance > 0) {
      sharp = {.exactly = true, .paths = paths};
      sharp.paths.tolerance = way.tolerance;
    }
    const double exact_work = work_of_a_path(spec, scene, particles, sharp, allowed);
    tellings.push_back({way.widths, way.stride, sharp, sharp.exactly && exact_work < step_work ? sharp : steps});
    work.push_back({exact_work / std::pow(way.stride, particles.dimension), std::min(exact_work, step_work)});
  }
  for (const std::size_t least : {std::min<std::size_t>(2, places.size()), std::size_t{1}})
    for (std::size_t i = 0; i < tellings.size(); ++i) {
      Telling& telling = tellings[i];
      for (telling.probes = places; telling.probes.size() >= least; telling.probes.pop_back()) {
        telling.around = near(telling.probes, particles, reach_of(scene.cutoff, telling.widths));
        if (static_cast<double>(telling.around.size()) * (work[i][0] + work[i][1]) <= allowed) return telling;
      }
    }
  return std::nullopt;
}

std::unique_ptr<Reference> exact_density(const Case& spec, const Scene& scene, const Following& following,
                                         int threads) {
  if (spec.reference.kind == ReferenceSpec::Kind::exact) return make_reference(spec, scene, threads);
  Case traced = spec;
  traced.reference = {};
  traced.reference.kind = ReferenceSpec::Kind::characteristics;
  return make_reference(traced, scene, threads, following);
}

/// Grid points at which the exact density can be known within some work, at most `wanted`.
Affordable points_to_know(const Case& spec, const Scene& scene, std::size_t wanted, double allowed,
                          int threads) {
  if (spec.reference.kind == ReferenceSpec::Kind::exact) return {.points = wanted};
  const bool whatever = std::isinf(allowed);
  if (whatever) allowed = 2e7;  // a second: a few paths that stick to a jump would take longer than all others
  Case traced = spec;
  traced.reference = {};
  traced.reference.kind = ReferenceSpec::Kind::characteristics;
  Affordable known = affordable_paths(traced, scene, allowed, 1, threads);
  if (whatever && known.points == 0) return {.points = wanted};
  known.points = std::min(known.points, wanted);
  return known;
}

/// A failure here is not one of the run, and must not cost its results.
template <class Tell>
Budget covered_or_why(const Tell& tell) {
  try {
    return checked(tell());
  } catch (const NumericalError& error) {
    Budget budget;
    budget.not_covered = error.what();
    return budget;
  }
}

/// `allowance`: null for any work.
Budget predict(const Case& spec, const Scene& scene, Effort effort, Allowance* allowance, int threads,
               Causes causes);
Budget measure(const Case& spec, const Scene& scene, const LastFrame::Kept& last, Effort effort, int threads);

}  // namespace

std::string budget_not_covered(const Case& spec) {
  if (const std::string reason = beyond_budgets(spec.effects, spec.domain.dimension); !reason.empty())
    return reason;
  if (spec.output.times.empty()) return "there is no output";
  return "";
}

Budget predict_budget(const Case& spec, const Scene& scene, Effort effort, int threads, Causes causes) {
  return covered_or_why([&] { return predict(spec, scene, effort, nullptr, threads, causes); });
}

Budget predict_budget(const Case& spec, const Scene& scene, Allowance& allowance, int threads, Causes causes) {
  return covered_or_why([&] { return predict(spec, scene, Effort::whatever, &allowance, threads, causes); });
}

Budget measure_budget(const Case& spec, const Scene& scene, const LastFrame::Kept& last, Effort effort,
                      int threads) {
  return covered_or_why([&] { return measure(spec, scene, last, effort, threads); });
}

namespace {

/// What predict() will take, roughly, beside the exact density.
double work_of_prediction(const Case& spec, const Scene& scene, const Particles& seeded, const Carrying& how,
                          double allowed, Causes causes) {
  const auto n = static_cast<double>(seeded.size()), d = static_cast<double>(seeded.dimension);
  const bool smooth = has_smooth_paths(scene);
  // In blocks of particles a formula takes less than half of what one alone does.
  const double together = smooth && scene.velocity->cost() <= 2 ? 0.4 : 1;
  const double path = together * work_of_a_path(spec, scene, seeded, how, allowed);
  // The step of a method of order 8 goes with the eighth root of the tolerance: 1e-12 and 1e-13 instead of 1e-8. A
  // path through kinks costs milliseconds.
  const double sharp = smooth ? 4 * path : 1e5 * work_of_exact_rate(scene);
  const double sum = (d == 2 ? 5 : 25) * (n + static_cast<double>(scene.evaluation.size()));
  double work = 2 * n * path + 2 * sum;
  if (causes == Causes::all) {
    const double thin = std::min(n, 3000 * std::pow(2, d));
    const double steps = thin * rates_of_steps(spec, scene);
    work += static_cast<double>(higher_cutoffs(spec).size()) * sum;
    work += smooth ? std::min(steps, 4e7) * scene.velocity->cost() + thin * sharp : 3 * steps * scene.velocity->cost();
  }
  return work;
}

Budget predict(const Case& spec, const Scene& scene, Effort effort, Allowance* allowance, int threads,
               Causes causes) {
  Budget budget;
  budget.not_covered = budget_not_covered(spec);
  if (!budget.known()) return budget;
  const double time = spec.output.times.back();
  const bool smooth_paths = has_smooth_paths(scene);
  const ExactPathsOptions paths{.tolerance = 1e-8, .length = extent(spec), .threads = threads};
  // A path through kinks is dear: then by the steps of the case.
  const Carrying how{.exactly = smooth_paths, .paths = paths};

  const double seeding_work = static_cast<double>(scene.seeding.size()) * scene.density->cost();
  const auto too_dear = [&](double spent) {
    budget.not_covered = too_much_work;
    budget.too_dear = true;
    allowance->spent += spent;
    return budget;
  };
  // All points are looked at here, and again for each piece of advice.
  const double looking = (causes == Causes::all ? 1.0 : 0.1) * seeding_work;
  if (allowance && looking > allowance->left() / 4) return too_dear(0);
  SeedReport seeding;
  const Particles seeded = seed_scene(scene, threads, &seeding);
  budget.particles = seeded.size();
  budget.not_covered = about_beyond(part_beyond(scene.density->mass(), seeded, scene.seeding));
  if (!budget.known()) return budget;
  const double allowed = allowance ? allowance->left() - looking
                         : effort == Effort::whatever
                             ? std::numeric_limits<double>::infinity()
                             : work_allowed(spec, scene, seeded.size(), share_predicted);
  const Affordable knowable = points_to_know(spec, scene, smooth_paths ? 2048 : 128, allowed / 3, threads);
  if (allowance) {
    // A fifth of it at most has gone into finding that out.
    if (knowable.points == 0) return too_dear(looking + allowed / 5);
    const double work = static_cast<double>(knowable.points) * knowable.work +
                        work_of_prediction(spec, scene, seeded, how, allowed, causes);
    if (!(work <= allowed)) return too_dear(looking + allowed / 5);
    allowance->spent += looking + work;
  } else if (knowable.points == 0 ||
             (effort == Effort::share_of_run &&
              static_cast<double>(seeded.size() * 2) * 1.3 * work_of_a_path(spec, scene, seeded, how, allowed) +
                      static_cast<double>(knowable.points) * knowable.work >
                  allowed)) {
    budget.not_covered = "it would cost more than a tenth of the run; `check` predicts it";
    return budget;
  }
  Particles carried = seeded;
  if (!carry(spec, scene, how, carried)) {
    budget.not_covered = lost_paths;
    return budget;
  }
  budget.outside = part_outside(carried, spec.domain);
  budget.not_covered = nothing_to_explain(carried, budget.outside, time);
  if (!budget.known()) return budget;
  Particles aside = between(seeded, scene);
  if (!carry(spec, scene, how, aside)) {
    budget.not_covered = lost_paths;
    return budget;
  }
  const auto summed = [&](const Particles& particles, const Cutoff& cutoff) {
    return evaluate_density(particles, cutoff, scene.evaluation,
                            {.tolerance = 1e-10, .threads = threads, .measure = false})
        .rho;
  };
  const std::vector<double> density = summed(carried, scene.cutoff), other = summed(aside, scene.cutoff);
  const auto [lowest, highest] = std::minmax_element(density.begin(), density.end());
  budget.lowest = *lowest, budget.highest = *highest;
  const GridSample sample = sample_of_grid(scene.evaluation, density, knowable.points);
  std::vector<double> exact;
  exact_density(spec, scene, knowable.following, threads)->evaluate_at(time, sample.points, exact);
  const auto farthest = [&](const auto& value) {  // from the exact density, over the sample
    std::vector<double> values, known;
    for (std::size_t i = 0; i < exact.size(); ++i)
      if (std::isfinite(exact[i])) {
        values.push_back(value(sample.points[i]));
        known.push_back(exact[i]);
      }
    return largest_difference(values, known);
  };
  const double norm = farthest([](std::size_t) { return 0.0; });
  if (!(norm > 0)) {
    budget.not_covered = "the exact density is not known, or 0, at the last output";
    return budget;
  }
  budget.probes = sample.points.size();
  budget.quadrature = at_least_rounding(largest_difference(density, other) / 2 / norm);
  budget.smoothing = at_least_rounding(farthest([&](std::size_t i) { return (density[i] + other[i]) / 2; }) / norm);
  const double worst = farthest([&](std::size_t i) { return density[i]; }) / norm;
  budget.total = worst;
  if (causes == Causes::lattice) return budget;

  std::vector<Probe> places;  // for the steps: where there is density
  for (std::size_t i = 0; i < sample.points.size(); ++i)
    if (std::abs(density[sample.points[i]]) > 1e-6 * norm)
      places.push_back({sample.points[i], grid_point(scene.evaluation, sample.points[i]), exact[i]});
  budget.time_stepping = predict_time_stepping(spec, scene, seeded, places, norm, paths);
  if (std::isnan(budget.time_stepping)) {
    budget.not_covered = lost_paths;
    return budget;
  }
  budget.transform = spec.evaluate.tolerance;
  budget.left_out = bound_of_left_out(scene, seeding, seeded, carried, norm);
  budget.total = worst + budget.time_stepping + budget.transform + budget.left_out;
  find_dominating(budget);
  Better better;
  for (const std::string& name : higher_cutoffs(spec)) {
    const Cutoff cutoff = make_cutoff(name, seeded.dimension, scene.core_radius);
    const std::vector<double> sharper = summed(carried, cutoff);
    better.emplace_back(name, farthest([&](std::size_t i) { return sharper[i]; }) / norm);
  }
  give_advice(spec, scene, better, threads, budget);
  return budget;
}

}  // namespace

void LastFrame::frame(const Frame& frame) {
  if (frame.time != last_) return;
  kept_.any = true;
  kept_.time = frame.time;
  kept_.particles = *frame.particles;
  kept_.density = *frame.density;
  if (frame.exact) kept_.exact = *frame.exact;
  kept_.numbers = frame.numbers;
}

namespace {

Budget measure(const Case& spec, const Scene& scene, const LastFrame::Kept& last, Effort effort, int threads) {
  Budget budget;
  budget.not_covered = budget_not_covered(spec);
  if (budget.known() && !last.any) budget.not_covered = "there was no output";
  if (budget.known() && last.particles.size() == 0) budget.not_covered = "no particle carries weight";
  budget.outside = last.numbers.outside;
  if (budget.known()) budget.not_covered = nothing_to_explain(last.particles, budget.outside, last.time);
  if (!budget.known()) return budget;
  SeedReport seeding;
  const Particles seeded = seed_scene(scene, threads, &seeding);
  budget.not_covered = about_beyond(part_beyond(scene.density->mass(), seeded, scene.seeding));
  if (!budget.known()) return budget;
  const bool smooth_paths = has_smooth_paths(scene);
  const std::vector<double>& rho = last.density.rho;

  std::vector<std::size_t> points;
  std::vector<double> exact, values;
  if (last.exact) {
    points.resize(rho.size());
    std::iota(points.begin(), points.end(), std::size_t{0});
    exact = *last.exact;
    values = rho;
  } else {
    const double allowed = effort == Effort::whatever
                               ? std::numeric_limits<double>::infinity()
                               : work_allowed(spec, scene, last.particles.size(), share_measured) / 3;
    const Affordable known = points_to_know(spec, scene, smooth_paths ? 1024 : 64, allowed, threads);
    if (known.points == 0) {
      budget.not_covered = "it would cost more than a tenth of the run; accuracy.budget = \"measured\" measures it";
      return budget;
    }
    points = sample_of_grid(scene.evaluation, rho, known.points).points;
    exact_density(spec, scene, known.following, threads)->evaluate_at(last.time, points, exact);
    for (const std::size_t point : points) values.push_back(rho[point]);
  }
  double norm = 0, worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(exact[i])) {
      norm = std::max(norm, std::abs(exact[i]));
      worst = std::max(worst, std::abs(values[i] - exact[i]));
    }
  if (!(norm > 0)) {
    budget.not_covered = "the exact density is not known, or 0, at the last output";
    return budget;
  }
  budget.total = last.numbers.error ? last.numbers.error->linf : worst / norm;

  const std::vector<Probe> places = choose_probes(scene.evaluation, points, values, exact, 3 * scene.core_radius, 6);
  const ExactPathsOptions paths{.length = extent(spec), .threads = threads};
  const std::optional<Telling> chosen = choose_telling(spec, scene, last.particles, places, effort, paths);
  if (!chosen) {
    budget.not_covered = "it would cost more than a tenth of the run; accuracy.budget = \"measured\" measures it";
    return budget;
  }
  const std::vector<Probe>& probes = chosen->probes;
  budget.probes = probes.size();
  const Particles ran = subset(last.particles, chosen->around);
  const std::vector<double> by_steps = sums_at(probes, ran, scene.cutoff, threads);
  Particles ran_thin = chosen->stride > 1 ? thinned(ran, scene.seeding, chosen->stride) : ran;
  double cells = std::pow(static_cast<double>(chosen->stride), ran.dimension);
  if (ran_thin.size() == 0) {  // all of few particles lie between those that would stay
    ran_thin = ran;
    cells = 1;
  }
  std::vector<std::size_t> all(ran_thin.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Particles followed = at_start(ran_thin, all, scene);
  for (double& alpha : followed.alpha) alpha *= cells;
  if (!carry(spec, scene, chosen->sharp, followed)) {
    budget.not_covered = lost_paths;
    return budget;
  }
  std::vector<double> exactly = sums_at(probes, followed, scene.cutoff, threads);
  const std::vector<double> stepped = sums_at(probes, ran_thin, scene.cutoff, threads);
  budget.time_stepping = largest_difference(exactly, stepped) / norm;
  if (!chosen->sharp.exactly) budget.time_stepping *= of_halved_steps(spec, scene);
  budget.time_stepping = at_least_rounding(budget.time_stepping);
  for (std::size_t i = 0; i < exactly.size(); ++i) exactly[i] += by_steps[i] - stepped[i];
  Better better;
  tell_smoothing_and_quadrature(spec, scene, probes, at_start(last.particles, chosen->around, scene),
                                chosen->moved.exactly ? exactly : by_steps, norm, chosen->moved, budget, better);
  if (!budget.known()) return budget;
  budget.transform = last.numbers.transform_error;
  budget.left_out = bound_of_left_out(scene, seeding, seeded, last.particles, norm);
  find_dominating(budget);
  give_advice(spec, scene, better, threads, budget);
  return budget;
}

}  // namespace

std::string to_text(const Budget& budget) {
  std::string text;
  const auto line = [&](const char* name, double value) {
    text += fmt::format("  {:<17} {:<8.2g}{}\n", name, value, budget.dominates == name ? " <- dominates" : "");
  };
  line("time stepping", budget.time_stepping);
  line("smoothing", budget.smoothing);
  line("quadrature", budget.quadrature);
  line("Gauss transform", budget.transform);
  if (budget.left_out > 0) line("particles left out", budget.left_out);
  for (const std::string& advice : budget.advice) text += fmt::format("hint   {}\n", advice);
  return text;
}

nlohmann::ordered_json to_json(const Budget& budget) {
  if (!budget.known()) return {{"not_covered", budget.not_covered}};
  return {{"time_stepping", budget.time_stepping}, {"smoothing", budget.smoothing}, {"quadrature", budget.quadrature},
          {"transform", budget.transform},         {"left_out", budget.left_out},   {"total", budget.total},
          {"dominates", budget.dominates},         {"probes", budget.probes},       {"advice", budget.advice}};
}

}  // namespace gaussdrift::accuracy
