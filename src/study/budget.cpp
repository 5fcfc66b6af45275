#include "study/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "sim/exact_paths.hpp"
#include "sim/stable_step.hpp"
#include "sim/stepper.hpp"
#include "time/schedule.hpp"

namespace gaussdrift::study {

namespace {

// Of a run's own evaluations of the velocity as many may go into telling its errors apart: an exact path costs about
// four times as much an evaluation as the steps, so this is about a sixth. And a few always: a tenth of a second.
constexpr double share = 0.04, few_rates = 6e6;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double rounding = 1e-14;  // no cause is told to be smaller

double extent(const Case& description) {
  double longest = 0;
  for (int k = 0; k < description.domain.dimension; ++k)
    longest = std::max(longest, description.domain.max[k] - description.domain.min[k]);
  return longest;
}

/// Beyond this distance a blob adds less than 1e-14 of its height.
double reach_of(const Cutoff& cutoff) {
  double widest = 0;
  for (const CutoffTerm& term : cutoff) widest = std::max(widest, term.width);
  return 6 * widest;
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

/// The same blobs on a lattice twice as fine: every particle becomes 2^d, a quarter of a spacing aside.
Particles refined(const Particles& start, const Scene& scene) {
  Particles fine;
  fine.dimension = start.dimension;
  const double aside = scene.seeding.spacing / 4;
  for (std::size_t j = 0; j < start.size(); ++j)
    for (int corner = 0; corner < (1 << start.dimension); ++corner) {
      for (int k = 0; k < start.dimension; ++k)
        fine.position[k].push_back(start.position[k][j] + (corner >> k & 1 ? aside : -aside));
      fine.id.push_back(start.id[j]);
    }
  fine.alpha.assign(fine.id.size(), 0.0);
  scene.density->add(fine.view(), fine.alpha.data());
  const double cell = std::pow(scene.seeding.spacing / 2, start.dimension);
  for (double& alpha : fine.alpha) alpha *= cell;
  return fine;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
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
  // Second place for the largest density: where smoothing is worst is often there, and cancellation never is.
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
  const std::array<std::pair<const char*, double>, 4> causes{{{"time stepping", budget.time_stepping},
                                                              {"smoothing", budget.smoothing},
                                                              {"quadrature", budget.quadrature},
                                                              {"Gauss transform", budget.transform}}};
  const auto largest =
      std::max_element(causes.begin(), causes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  budget.dominates = largest->first;
}

/// What follows from the numbers. `better`: the smoothing of cutoffs of higher order at the same width.
void give_advice(const Case& description, const Scene& scene, const Particles& start,
                 const std::vector<std::pair<std::string, double>>& better, Budget& budget) {
  const time::Tableau& tableau = time::find_tableau(description.time.method);
  const double others = std::max({budget.smoothing, budget.quadrature, budget.transform});
  if (!time::is_adaptive(tableau) && description.time.step > 0) {
    const double step = description.time.step, order = tableau.time_order;
    const double now = std::max(budget.time_stepping, rounding);
    if (now < 1e-2 * others) {
      double longer = step * std::pow(1e-2 * others / now, 1 / order);
      longer = std::min(longer, description.time.end / 8);
      const double stable =
          estimate_stable_step(*scene.velocity, start, tableau, description.time.end, longer, difference_length(scene))
              .step;
      longer = round_below(std::min(longer, stable));
      if (longer >= 2 * step)
        budget.advice.push_back(fmt::format("time.step = {:g} is as accurate, with {:.0f} times fewer steps", longer,
                                            std::floor(longer / step + 1e-6)));
    } else if (budget.dominates == "time stepping") {
      const double shorter = round_below(step * std::pow(0.3 * others / now, 1 / order));
      budget.advice.push_back(
          fmt::format("time.step = {:g} makes time stepping smaller than the rest", std::max(shorter, step * 1e-3)));
    }
  }
  if (budget.dominates == "smoothing") {
    for (const auto& [cutoff, smoothing] : better) {
      if (smoothing > 0.5 * budget.smoothing) continue;
      budget.advice.push_back(
          fmt::format("particles.cutoff = \"{}\" lowers the smoothing to {:.2g}", cutoff, smoothing));
      break;
    }
    budget.advice.push_back(fmt::format(
        "particles.per_axis = {} halves the width of the blobs: a smooth density's smoothing falls {} times",
        2 * description.particles.per_axis - 1, 1 << cutoff_order(description.particles.cutoff)));
  }
  if (budget.dominates == "quadrature")
    budget.advice.push_back(fmt::format(
        "blobs overlap too little for this flow: particles.overlap = {:g}, or [effects.remesh] where it strains",
        description.particles.overlap * 1.5));
  if (budget.dominates == "Gauss transform")
    budget.advice.push_back(fmt::format("evaluate.tolerance = {:.0e} is cheap and removes what dominates",
                                        std::max(1e-13, 1e-3 * std::max(budget.smoothing, budget.quadrature))));
}

/// Cutoffs of higher order than the case's, by name.
std::vector<std::string> higher_cutoffs(const Case& description) {
  std::vector<std::string> names;
  for (const char* name : {"gauss4", "gauss6", "gauss8"})
    if (cutoff_order(name) > cutoff_order(description.particles.cutoff)) names.push_back(name);
  return names;
}

/// Smoothing and quadrature at the probes: sums with exact paths on the lattice (`coarse`) and on one twice as fine.
void tell_smoothing_and_quadrature(const Case& description, const Scene& scene, const std::vector<Probe>& probes,
                                   const Particles& start, const std::vector<double>& coarse, double time, double norm,
                                   const ExactPathsOptions& paths, Budget& budget,
                                   std::vector<std::pair<std::string, double>>& better) {
  Particles fine = refined(start, scene);
  if (carry_exactly(*scene.velocity, scene.reaction_rate.get(), fine, 0, time, paths).lost > 0) {
    budget.not_covered = "the paths of some particles could not be followed";
    return;
  }
  const std::vector<double> exact = exact_of(probes), smooth = sums_at(probes, fine, scene.cutoff, paths.threads);
  budget.quadrature = std::max(rounding, largest_difference(coarse, smooth) / norm);
  budget.smoothing = std::max(rounding, largest_difference(smooth, exact) / norm);
  for (const std::string& name : higher_cutoffs(description)) {
    const Cutoff cutoff = make_cutoff(name, start.dimension, scene.core_radius, description.particles.width_ratio);
    better.emplace_back(name, largest_difference(sums_at(probes, fine, cutoff, paths.threads), exact) / norm);
  }
}

/// Every `stride`-th lattice point on each axis, weights scaled.
Particles thinned(const Particles& particles, const Lattice& lattice, std::size_t stride) {
  Particles thin;
  thin.dimension = particles.dimension;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    auto rest = static_cast<std::size_t>(particles.id[j]);
    bool kept = true;
    for (int k = 0; k < particles.dimension; ++k) {
      kept = kept && rest % lattice.points[k] % stride == 0;
      rest /= lattice.points[k];
    }
    if (!kept) continue;
    for (int k = 0; k < particles.dimension; ++k) thin.position[k].push_back(particles.position[k][j]);
    thin.alpha.push_back(particles.alpha[j] * std::pow(static_cast<double>(stride), particles.dimension));
    thin.id.push_back(particles.id[j]);
  }
  return thin;
}

/// The paths by the steps of the case, `factor` times as long; weights stay, as their own error is of the same order.
void carry_by_steps(const Case& description, const Scene& scene, Particles& particles, double factor, int threads) {
  Case transport = description;
  transport.effects = {};
  transport.time.step *= factor;
  Carrier carrier(transport, scene, threads);
  base::StageTimes ignored;
  double now = 0;
  std::size_t steps = 0;
  const double last = description.output.times.back();
  for (const double to : landings(description)) {
    if (to > last) break;
    steps += carrier.carry(particles, now, to, steps, ignored, [](double, std::size_t) {});
    now = to;
  }
}

double predict_time_stepping(const Case& description, const Scene& scene, const Particles& seeded,
                             const std::vector<Probe>& places, double norm, const ExactPathsOptions& paths) {
  const time::Tableau& tableau = time::find_tableau(description.time.method);
  const double time = description.output.times.back();
  std::size_t stride = 1;
  Particles thin = seeded;
  // As long as the blobs still overlap.
  while (thin.size() > 3000 && static_cast<double>(stride) < 2 * description.particles.overlap)
    thin = thinned(seeded, scene.seeding, ++stride);
  if (thin.size() == 0) thin = seeded;
  // Longer steps if those of the case are many, as long as they stay stable; their error is scaled back.
  double factor = 1;
  constexpr double affordable = 4e7;  // particles times steps times stages: a fifth of a second on a core
  const auto steps = static_cast<double>(total_steps(description));
  if (!time::is_adaptive(tableau))
    while (static_cast<double>(thin.size()) * steps * tableau.stages / factor > affordable &&
           2 * factor * description.time.step < time / 16 &&
           estimate_stable_step(*scene.velocity, thin, tableau, description.time.end,
                                2 * factor * description.time.step, difference_length(scene))
                   .step >= 2 * factor * description.time.step)
      factor *= 2;
  Particles stepped = thin, followed = thin;
  carry_by_steps(description, scene, stepped, factor, paths.threads);
  ExactPathsOptions exact = paths;
  exact.tolerance = scene.velocity->is_smooth() ? 1e-13 : 1e-10;
  if (carry_exactly(*scene.velocity, nullptr, followed, 0, time, exact).lost > 0) return nan;
  const double changed = largest_difference(sums_at(places, stepped, scene.cutoff, paths.threads),
                                            sums_at(places, followed, scene.cutoff, paths.threads));
  return std::max(rounding, changed / norm * std::pow(factor, -tableau.time_order));
}

/// Evaluations of the velocity for one particle that the run's steps take.
double rates_of_run(const Case& description, std::size_t particles) {
  const time::Tableau& tableau = time::find_tableau(description.time.method);
  // Steps that are chosen are not known here; some hundred are usual.
  const double steps = time::is_adaptive(tableau) ? 200 : static_cast<double>(total_steps(description));
  return static_cast<double>(particles) * steps * tableau.stages;
}

double rates_allowed(const Case& description, const Scene& scene, std::size_t particles) {
  return std::max(share * rates_of_run(description, particles), few_rates / scene.velocity->cost());
}

/// Evaluations that an exact path takes, from a few of them.
double rates_of_a_path(const Scene& scene, const Particles& particles, double time, const ExactPathsOptions& options) {
  std::vector<std::size_t> few;
  const std::size_t wanted = std::min<std::size_t>(scene.velocity->is_smooth() ? 32 : 4, particles.size());
  for (std::size_t i = 0; i < wanted; ++i) few.push_back(i * particles.size() / wanted);
  Particles trial = at_start(particles, few, scene);
  const ExactPaths paths = carry_exactly(*scene.velocity, scene.reaction_rate.get(), trial, 0, time, options);
  return std::max(1.0, static_cast<double>(paths.rates) / static_cast<double>(wanted));
}

std::unique_ptr<Reference> exact_density(const Case& description, const Scene& scene, int threads) {
  if (description.reference.kind == ReferenceSpec::Kind::exact) return make_reference(description, scene, threads);
  Case traced = description;
  traced.reference = {};
  traced.reference.kind = ReferenceSpec::Kind::characteristics;
  return make_reference(traced, scene, threads);
}

}  // namespace

std::string budget_not_covered(const Case& description) {
  if (description.effects.diffusion)
    return "diffusion moves weight between particles; a budget covers transport and reaction";
  if (description.effects.remesh)
    return "remeshing moves weight between particles; a budget covers transport and reaction";
  if (description.output.times.empty()) return "there is no output";
  return "";
}

Budget predict_budget(const Case& description, const Scene& scene, Effort effort, int threads, Causes causes) {
  Budget budget;
  budget.not_covered = budget_not_covered(description);
  if (!budget.known()) return budget;
  const double time = description.output.times.back();
  const bool smooth_paths = scene.velocity->is_smooth();
  ExactPathsOptions paths{.tolerance = smooth_paths ? 1e-8 : 1e-6, .length = extent(description), .threads = threads};

  const Particles seeded = seed_scene(scene, threads);
  if (effort == Effort::share_of_run &&
      static_cast<double>(seeded.size()) * 2 * rates_of_a_path(scene, seeded, time, paths) >
          rates_allowed(description, scene, seeded.size())) {
    budget.not_covered = "it would cost more than a fifth of the run; `check` predicts it";
    return budget;
  }
  Particles carried = seeded;
  if (smooth_paths) {
    if (carry_exactly(*scene.velocity, scene.reaction_rate.get(), carried, 0, time, paths).lost > 0)
      budget.not_covered = "the paths of some particles could not be followed";
  } else {  // a path through kinks is dear: all by the steps of the case, only those near the probes exactly
    carry_by_steps(description, scene, carried, 1, threads);
  }
  if (!budget.known()) return budget;
  const DensityGrid density = evaluate_density(carried, scene.cutoff, scene.evaluation,
                                               {.tolerance = 1e-10, .threads = threads, .measure = false});
  const GridSample sample = sample_of_grid(scene.evaluation, density.rho, smooth_paths ? 2048 : 128);
  std::vector<double> exact, rho;
  exact_density(description, scene, threads)->evaluate_at(time, sample.points, exact);
  for (const std::size_t point : sample.points) rho.push_back(density.rho[point]);
  double norm = 0;
  for (const double value : exact)
    if (std::isfinite(value)) norm = std::max(norm, std::abs(value));
  if (!(norm > 0)) {
    budget.not_covered = "the exact density is not known, or 0, at the last output";
    return budget;
  }

  const bool flat = scene.evaluation.dimension == 2;
  std::vector<Probe> probes = choose_probes(scene.evaluation, sample.points, rho, exact, 3 * scene.core_radius,
                                            smooth_paths ? (flat ? 6 : 2) : 1);
  std::vector<std::size_t> around = near(probes, carried, reach_of(scene.cutoff));
  while (around.size() > 60'000 && probes.size() > 1) {
    probes.pop_back();
    around = near(probes, carried, reach_of(scene.cutoff));
  }
  budget.probes = probes.size();
  const Particles start = at_start(carried, around, scene);
  std::vector<double> coarse;
  if (smooth_paths) {
    for (const Probe& probe : probes) coarse.push_back(density.rho[probe.index]);
  } else {
    Particles followed = start;
    carry_exactly(*scene.velocity, scene.reaction_rate.get(), followed, 0, time, paths);
    coarse = sums_at(probes, followed, scene.cutoff, threads);
  }
  std::vector<std::pair<std::string, double>> better;
  tell_smoothing_and_quadrature(description, scene, probes, start, coarse, time, norm, paths, budget, better);
  if (!budget.known()) return budget;

  double worst = 0;
  for (std::size_t i = 0; i < rho.size(); ++i)
    if (std::isfinite(exact[i])) worst = std::max(worst, std::abs(rho[i] - exact[i]) / norm);
  budget.total = worst;
  if (causes == Causes::lattice) return budget;

  std::vector<Probe> places = probes;  // for the steps: also the sample where there is density
  for (std::size_t i = 0; i < sample.points.size() && places.size() < 200; i += smooth_paths ? 3 : 1)
    if (std::abs(rho[i]) > 1e-6 * norm)
      places.push_back({sample.points[i], grid_point(scene.evaluation, sample.points[i]), exact[i]});
  budget.time_stepping = predict_time_stepping(description, scene, seeded, places, norm, paths);
  if (std::isnan(budget.time_stepping)) {
    budget.not_covered = "the paths of some particles could not be followed";
    return budget;
  }
  budget.transform = description.evaluate.tolerance;
  budget.total = worst + budget.time_stepping + budget.transform;
  find_dominating(budget);
  give_advice(description, scene, seeded, better, budget);
  return budget;
}

void LastFrame::frame(const Frame& frame) {
  if (frame.time != last_) return;
  kept_.any = true;
  kept_.time = frame.time;
  kept_.particles = *frame.particles;
  kept_.density = *frame.density;
  if (frame.exact) kept_.exact = *frame.exact;
  kept_.numbers = frame.numbers;
}

Budget measure_budget(const Case& description, const Scene& scene, const LastFrame::Kept& last, Effort effort,
                      int threads) {
  Budget budget;
  budget.not_covered = budget_not_covered(description);
  if (budget.known() && !last.any) budget.not_covered = "there was no output";
  if (budget.known() && last.particles.size() == 0) budget.not_covered = "no particle carries weight";
  if (!budget.known()) return budget;
  const bool smooth_paths = scene.velocity->is_smooth();
  const ExactPathsOptions paths{
      .tolerance = smooth_paths ? 3e-14 : 1e-8, .length = extent(description), .threads = threads};
  const std::vector<double>& rho = last.density.rho;

  std::vector<std::size_t> points;
  std::vector<double> exact, values;
  if (last.exact) {
    points.resize(rho.size());
    std::iota(points.begin(), points.end(), std::size_t{0});
    exact = *last.exact;
    values = rho;
  } else {
    points = sample_of_grid(scene.evaluation, rho, smooth_paths ? 1024 : 64).points;
    exact_density(description, scene, threads)->evaluate_at(last.time, points, exact);
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

  std::vector<Probe> probes =
      choose_probes(scene.evaluation, points, values, exact, 3 * scene.core_radius, smooth_paths ? 6 : 1);
  const double reach = reach_of(scene.cutoff);
  std::vector<std::size_t> around = near(probes, last.particles, reach);
  if (effort == Effort::share_of_run) {
    // What is followed: the particles around a probe, and 2^d times as many between them.
    const double allowed = rates_allowed(description, scene, last.particles.size()) /
                           rates_of_a_path(scene, last.particles, last.time, paths) /
                           (1 + (1 << last.particles.dimension));
    while (static_cast<double>(around.size()) > allowed && !probes.empty()) {
      probes.pop_back();
      around = near(probes, last.particles, reach);
    }
    if (probes.empty()) {
      budget.not_covered = "it would cost more than a fifth of the run; accuracy.budget = \"measured\" measures it";
      return budget;
    }
  }
  budget.probes = probes.size();
  const Particles start = at_start(last.particles, around, scene);
  Particles followed = start, ran;
  ran.dimension = start.dimension;
  for (const std::size_t j : around) {
    for (int k = 0; k < ran.dimension; ++k) ran.position[k].push_back(last.particles.position[k][j]);
    ran.alpha.push_back(last.particles.alpha[j]);
  }
  if (carry_exactly(*scene.velocity, scene.reaction_rate.get(), followed, 0, last.time, paths).lost > 0) {
    budget.not_covered = "the paths of some particles could not be followed";
    return budget;
  }
  const std::vector<double> exactly = sums_at(probes, followed, scene.cutoff, threads);
  budget.time_stepping =
      std::max(rounding, largest_difference(sums_at(probes, ran, scene.cutoff, threads), exactly) / norm);
  std::vector<std::pair<std::string, double>> better;
  tell_smoothing_and_quadrature(description, scene, probes, start, exactly, last.time, norm, paths, budget, better);
  if (!budget.known()) return budget;
  budget.transform = last.numbers.transform_error;
  find_dominating(budget);
  give_advice(description, scene, last.particles, better, budget);
  return budget;
}

std::string to_text(const Budget& budget) {
  std::string text;
  const auto line = [&](const char* name, double value) {
    text += fmt::format("  {:<17} {:<8.2g}{}\n", name, value, budget.dominates == name ? " <- dominates" : "");
  };
  line("time stepping", budget.time_stepping);
  line("smoothing", budget.smoothing);
  line("quadrature", budget.quadrature);
  line("Gauss transform", budget.transform);
  for (const std::string& advice : budget.advice) text += fmt::format("hint   {}\n", advice);
  return text;
}

nlohmann::ordered_json to_json(const Budget& budget) {
  if (!budget.known()) return {{"not_covered", budget.not_covered}};
  return {{"time_stepping", budget.time_stepping},
          {"smoothing", budget.smoothing},
          {"quadrature", budget.quadrature},
          {"transform", budget.transform},
          {"total", budget.total},
          {"dominates", budget.dominates},
          {"probes", budget.probes},
          {"advice", budget.advice}};
}

}  // namespace gaussdrift::study
