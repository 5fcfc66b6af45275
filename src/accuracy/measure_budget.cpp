// The error budget after a run: the particles near a few probes are carried once more, exactly and from a lattice half a
// spacing aside. method.md, section 10.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "accuracy/advice.hpp"
#include "accuracy/carrying.hpp"
#include "accuracy/causes.hpp"
#include "accuracy/interpolation.hpp"
#include "accuracy/known_density.hpp"
#include "accuracy/noise.hpp"
#include "accuracy/other_lattices.hpp"
#include "accuracy/probes.hpp"
#include "particle/subset.hpp"
#include "reference/sample.hpp"
#include "sim/borders/outside.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double share_measured = 0.09;  // of a run's work, for telling its errors apart afterwards
constexpr const char* too_costly =
    "it would cost more than a tenth of the run; accuracy.budget = \"measured\" measures it";

/// Which probes there are after a run, and how the particles near them are carried.
struct ProbePlan {
  double widths = 5;       // of the Gaussian, that count as near a probe
  std::size_t stride = 1;  // of the lattice points whose exact paths show the time stepping
  Carrying sharp{};        // of those
  Carrying moved{};        // of the lattice half a spacing aside
  std::vector<Probe> probes{};
  std::vector<std::size_t> around{};
};

/// The sharpest way whose work is allowed. Many probes come before one, and all paths at 3e-14 before some at 1e-10 or
/// by shorter steps. None if even one probe takes too much.
std::optional<ProbePlan> choose_probe_plan(const Case& spec, const Scene& scene, const Particles& particles,
                                           const std::vector<Probe>& places, Effort effort,
                                           const ExactPathsOptions& paths) {
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
  std::vector<ProbePlan> plans;
  std::vector<std::array<double, 2>> work;  // of a particle near a probe; of one aside
  for (const Way& way : ways) {
    Carrying sharp = halves;
    if (way.tolerance > 0) {
      sharp = {.exactly = true, .paths = paths};
      sharp.paths.tolerance = way.tolerance;
    }
    const double exact_work = work_of_a_path(spec, scene, particles, sharp, allowed);
    plans.push_back({way.widths, way.stride, sharp, sharp.exactly && exact_work < step_work ? sharp : steps});
    const double fewer_points = carryings_for_interpolation(spec) * step_work;
    work.push_back(
        {(exact_work + fewer_points) / std::pow(way.stride, particles.dimension), std::min(exact_work, step_work)});
  }
  for (const std::size_t least : {std::min<std::size_t>(2, places.size()), std::size_t{1}})
    for (std::size_t i = 0; i < plans.size(); ++i) {
      ProbePlan& plan = plans[i];
      for (plan.probes = places; plan.probes.size() >= least; plan.probes.pop_back()) {
        plan.around = near(plan.probes, particles, reach_of(scene.cutoff, plan.widths), spec.domain);
        if (static_cast<double>(plan.around.size()) * (work[i][0] + work[i][1]) <= allowed) return plan;
      }
    }
  return std::nullopt;
}

/// The smoothing of cutoffs of higher order, of the same width.
Better smoothing_of_others(const Case& spec, const Scene& scene, const std::vector<Probe>& probes,
                           const Particles& particles, double norm, int threads) {
  Better better;
  for (const std::string& name : higher_cutoffs(spec)) {
    const Cutoff cutoff = other_cutoff(scene, name);
    better.emplace_back(
        name, largest_difference(sums_at(probes, particles, cutoff, spec.domain, threads), exact_of(probes)) / norm);
  }
  return better;
}

/// A measurement step by step. Each step returns false where the budget says why it ends there.
class Measurement {
 public:
  Measurement(const Case& spec, const Scene& scene, const LastFrame::Kept& last, Effort effort, int threads)
      : spec_(spec), scene_(scene), last_(last), effort_(effort), threads_(threads) {}

  Budget run() {
    if (!is_covered() || !know_exact_density() || !find_total() || !choose_probes_and_paths() || !set_fit_apart() ||
        !measure_time_stepping() || !measure_smoothing_and_quadrature())
      return budget_;
    budget_.transform = last_.numbers.transform_error;
    budget_.left_out = bound_of_left_out(scene_, seeding_, seeded_, last_.particles, norm_);
    find_dominating(budget_);
    give_advice(spec_, scene_, better_, threads_, budget_);
    return budget_;
  }

 private:
  bool not_covered(const char* reason) {
    budget_.not_covered = reason;
    return false;
  }

  bool is_covered() {
    budget_.not_covered = budget_not_covered(spec_);
    if (budget_.known() && !last_.any) budget_.not_covered = "there was no output";
    if (budget_.known() && last_.particles.size() == 0) budget_.not_covered = "no particle carries weight";
    budget_.outside = last_.numbers.outside;
    if (budget_.known())
      budget_.not_covered = nothing_to_explain(last_.particles, budget_.outside, spec_.time.at(last_.time));
    if (!budget_.known()) return false;
    seeded_ = seed_scene(scene_, threads_, &seeding_);
    if (!is_enclosed(spec_.domain))
      budget_.not_covered = about_beyond(part_beyond(scene_.density->mass(), seeded_, scene_.seeding));
    return budget_.known();
  }

  /// On the whole grid if the run had it there, else at as many points as the work allows.
  bool know_exact_density() {
    const std::vector<double>& rho = last_.density.rho;
    if (last_.exact) {
      points_.resize(rho.size());
      std::iota(points_.begin(), points_.end(), std::size_t{0});
      exact_ = *last_.exact;
      values_ = rho;
      return true;
    }
    const double allowed = effort_ == Effort::whatever
                               ? std::numeric_limits<double>::infinity()
                               : work_allowed(spec_, scene_, last_.particles.size(), share_measured) / 3;
    const Affordable known = points_to_know(spec_, scene_, has_smooth_paths(scene_) ? 1024 : 64, allowed, threads_);
    if (known.points == 0) return not_covered(too_costly);
    points_ = sample_of_grid(scene_.evaluation, rho, known.points).points;
    exact_density(spec_, scene_, known.following, threads_)->evaluate_at(last_.time, points_, exact_);
    for (const std::size_t point : points_) values_.push_back(rho[point]);
    return true;
  }

  bool find_total() {
    double worst = 0;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (std::isfinite(exact_[i])) {
        norm_ = std::max(norm_, std::abs(exact_[i]));
        worst = std::max(worst, std::abs(values_[i] - exact_[i]));
      }
    if (!(norm_ > 0)) return not_covered(no_exact_density);
    budget_.total = last_.numbers.error ? last_.numbers.error->linf : worst / norm_;
    return true;
  }

  bool choose_probes_and_paths() {
    const std::vector<Probe> places =
        choose_probes(scene_.evaluation, points_, values_, exact_, 3e3 * difference_length(scene_), 6);
    const ExactPathsOptions paths{.length = extent(spec_), .threads = threads_};
    const std::optional<ProbePlan> plan = choose_probe_plan(spec_, scene_, last_.particles, places, effort_, paths);
    if (!plan) return not_covered(too_costly);
    plan_ = *plan;
    budget_.probes = plan_.probes.size();
    return true;
  }

  /// Where a formula is known of what samples are taken from, the fit's error is the difference from it. All other causes
  /// are told with the exact density of the fits.
  bool set_fit_apart() {
    if (!is_fitted(scene_)) return true;
    budget_.fit = fit_of_samples(scene_, seeded_, last_.particles, last_.density.rho, last_.time, norm_);
    if (spec_.reference.kind != ReferenceSpec::Kind::exact) return true;
    std::vector<std::size_t> places;
    for (const Probe& probe : plan_.probes) places.push_back(probe.index);
    std::vector<double> of_fits, of_formula;
    exact_density(spec_, scene_, {}, threads_)->evaluate_at(last_.time, places, of_fits);
    make_reference(spec_, scene_, threads_)->evaluate_at(last_.time, places, of_formula);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!std::isfinite(of_fits[i])) return not_covered(lost_paths);
      plan_.probes[i].exact = of_fits[i];
    }
    budget_.fit = at_least_rounding(largest_difference(of_fits, of_formula) / norm_);
    return true;
  }

  /// From the particles near the probes, or some of them: where steps have brought them, and where they belong.
  bool measure_time_stepping() {
    const Particles ran = subset(last_.particles, plan_.around);
    by_steps_ = sums_at(plan_.probes, ran, scene_.cutoff, spec_.domain, threads_);
    Particles ran_thin = plan_.stride > 1 ? thinned(ran, scene_.seeding, plan_.stride) : ran;
    double cells = std::pow(static_cast<double>(plan_.stride), ran.dimension);
    if (ran_thin.size() == 0) {  // all of few particles lie between those that would stay
      ran_thin = ran;
      cells = 1;
    }
    std::vector<std::size_t> all(ran_thin.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    Particles followed = at_start(ran_thin, all, scene_);
    for (double& alpha : followed.alpha) alpha *= cells;
    if (interpolates_velocity(spec_)) {
      const double error = interpolation_error(spec_, scene_, followed, plan_.probes, 1, threads_);
      if (std::isfinite(error)) budget_.interpolation = at_least_rounding(error / norm_);
    }
    if (!carry(spec_, scene_, plan_.sharp, followed)) return not_covered(lost_paths);
    exactly_ = sums_at(plan_.probes, followed, scene_.cutoff, spec_.domain, threads_);
    const std::vector<double> stepped = sums_at(plan_.probes, ran_thin, scene_.cutoff, spec_.domain, threads_);
    budget_.time_stepping = largest_difference(exactly_, stepped) / norm_;
    if (!plan_.sharp.exactly) budget_.time_stepping *= of_halved_steps(spec_, scene_);
    budget_.time_stepping = at_least_rounding(budget_.time_stepping);
    for (std::size_t i = 0; i < exactly_.size(); ++i) exactly_[i] += by_steps_[i] - stepped[i];
    return true;
  }

  /// From sums over the lattice and over the same lattice half a spacing aside. Moving a lattice changes the sign of
  /// its error, but for a far smaller part. So the mean of the two sums is the integral, and half their difference is
  /// the error.
  bool measure_smoothing_and_quadrature() {
    const std::vector<Probe>& probes = plan_.probes;
    std::vector<double> sums = plan_.moved.exactly ? exactly_ : by_steps_;
    Particles aside = between(at_start(last_.particles, plan_.around, scene_), scene_, spec_.domain);
    if (!carry(spec_, scene_, plan_.moved, aside)) return not_covered(lost_paths);
    const std::vector<double> other = sums_at(probes, aside, scene_.cutoff, spec_.domain, threads_);
    budget_.quadrature = at_least_rounding(largest_difference(sums, other) / 2 / norm_);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = (sums[i] + other[i]) / 2;
    budget_.smoothing = at_least_rounding(largest_difference(sums, exact_of(probes)) / norm_);
    better_ = smoothing_of_others(spec_, scene_, probes, aside, norm_, threads_);
    return true;
  }

  const Case& spec_;
  const Scene& scene_;
  const LastFrame::Kept& last_;
  const Effort effort_;
  const int threads_;
  Budget budget_;
  SeedReport seeding_;
  Particles seeded_;
  std::vector<std::size_t> points_;  // of the grid, where the exact density is known
  std::vector<double> exact_, values_;
  double norm_ = 0;
  ProbePlan plan_;
  std::vector<double> by_steps_, exactly_;  // densities at the probes of the particles near them
  Better better_;
};

}  // namespace

Budget measure_budget(const Case& spec, const Scene& scene, const LastFrame::Kept& last, Effort effort, int threads) {
  if (moves_by_chance(spec)) return budget_of_walk(spec, scene, last, threads);
  return covered_or_why([&] { return Measurement(spec, scene, last, effort, threads).run(); });
}

}  // namespace gaussdrift::accuracy
