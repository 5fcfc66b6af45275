// The error budget before a run: the lattice and the same lattice half a spacing aside are carried along exact paths and
// summed on the whole grid. method.md, section 10.
#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/advice.hpp"
#include "accuracy/carrying.hpp"
#include "accuracy/causes.hpp"
#include "accuracy/interpolation.hpp"
#include "accuracy/known_density.hpp"
#include "accuracy/other_lattices.hpp"
#include "accuracy/probes.hpp"
#include "base/nan.hpp"
#include "reference/sample.hpp"
#include "sim/borders/edges.hpp"
#include "sim/borders/outside.hpp"
#include "sim/landings.hpp"
#include "sim/stable_step.hpp"
#include "sim/tiled_density.hpp"
#include "sim/transform.hpp"
#include "sim/work.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double share_predicted = 0.05;  // of a run's work, for the prediction of its errors
using base::nan;
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr const char* too_much_work =
    "this would take longer than a prediction may; accuracy.budget = \"measured\" lets the run tell its errors apart";

/// Fewer of the particles, as long as the blobs still overlap.
Particles thin_enough(const Case& spec, const Scene& scene, const Particles& seeded) {
  std::size_t stride = 1;
  Particles thin = seeded;
  while (thin.size() > 3000 && static_cast<double>(stride) < 2 * spec.particles.overlap)
    thin = thinned(seeded, scene.seeding, ++stride);
  return thin.size() == 0 ? seeded : thin;
}

/// How many times longer than those of the case steps may be: as they are affordable, and as long as they stay stable.
/// Their error is scaled back.
double affordable_steps(const Case& spec, const Scene& scene, const Particles& thin) {
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  if (time::is_adaptive(tableau) || !has_smooth_paths(scene)) return 1;
  constexpr double affordable = 4e7;  // particles times steps times stages: a fifth of a second on a core
  const auto steps = static_cast<double>(total_steps(spec));
  double factor = 1;
  while (static_cast<double>(thin.size()) * steps * tableau.stages / factor > affordable &&
         2 * factor * spec.time.step < spec.output.times.back() / 16 &&
         estimate_stable_step(*scene.velocity, thin, tableau, spec.time.end, 2 * factor * spec.time.step,
                              difference_length(scene))
                 .step >= 2 * factor * spec.time.step)
    factor *= 2;
  return factor;
}

/// NaN if a path could not be followed.
double predict_time_stepping(const Case& spec, const Scene& scene, const Particles& seeded,
                             const std::vector<Probe>& places, double norm, const ExactPathsOptions& paths) {
  const bool smooth_paths = has_smooth_paths(scene);
  const Particles thin = thin_enough(spec, scene, seeded);
  const double factor = affordable_steps(spec, scene, thin);
  Particles stepped = thin, followed = thin;
  carry_by_steps(spec, scene, stepped, factor, paths.threads);
  Carrying better{.exactly = smooth_paths, .paths = paths, .factor = 0.5};
  better.paths.tolerance = 1e-13;
  if (!carry(spec, scene, better, followed)) return nan;
  double changed = largest_difference(sums_at(places, stepped, scene.cutoff, spec.domain, paths.threads),
                                      sums_at(places, followed, scene.cutoff, spec.domain, paths.threads));
  if (!smooth_paths) changed *= of_halved_steps(spec, scene);
  return at_least_rounding(changed / norm * std::pow(factor, -time::find_tableau(spec.time.method).time_order));
}

/// What a prediction will take, roughly, beside the exact density.
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
    work += smooth ? std::min(steps, 4e7) * scene.velocity->cost() + thin * sharp
                   : (3 + carryings_for_interpolation(spec)) * steps * scene.velocity->cost();
  }
  return work;
}

/// A prediction step by step. Each step returns false where the budget says why it ends there.
class Prediction {
 public:
  Prediction(const Case& spec, const Scene& scene, int threads, Causes wanted)
      : spec_(spec),
        scene_(scene),
        threads_(threads),
        wanted_(wanted),
        smooth_(has_smooth_paths(scene)),
        paths_{.tolerance = 1e-8, .length = extent(spec), .threads = threads},
        how_{.exactly = smooth_, .paths = paths_} {}

  /// `allowance`: null for any work.
  Budget run(Effort effort, Allowance* allowance) {
    budget_.not_covered = budget_not_covered(spec_);
    if (!budget_.known() || !may_look(allowance) || !seed() || !may_spend(effort, allowance) || !carry_both() ||
        !compare_with_exact() || wanted_ == Causes::lattice)
      return budget_;
    if (add_other_causes()) advise();
    return budget_;
  }

 private:
  bool too_dear() {
    budget_.not_covered = too_much_work;
    budget_.too_dear = true;
    return false;
  }
  bool not_covered(const char* reason) {
    budget_.not_covered = reason;
    return false;
  }

  /// All points are looked at when they are seeded, and again for each piece of advice.
  bool may_look(const Allowance* allowance) {
    const double seeding = static_cast<double>(scene_.seeding.size()) * scene_.density->cost();
    looking_ = (wanted_ == Causes::all ? 1.0 : 0.1) * seeding;
    return !allowance || looking_ <= allowance->left() / 4 || too_dear();
  }

  bool seed() {
    seeded_ = seed_scene(scene_, threads_, &seeding_);
    budget_.particles = seeded_.size();
    if (!is_enclosed(spec_.domain))
      budget_.not_covered = about_beyond(part_beyond(scene_.density->mass(), seeded_, scene_.seeding));
    return budget_.known();
  }

  /// Finds how many points of the exact density can be known, and whether the whole fits into what may be spent.
  bool may_spend(Effort effort, Allowance* allowance) {
    const double allowed = allowance                    ? allowance->left() - looking_
                           : effort == Effort::whatever ? infinite
                                                        : work_allowed(spec_, scene_, seeded_.size(), share_predicted);
    knowable_ = points_to_know(spec_, scene_, smooth_ ? 2048 : 128, allowed / 3, threads_);
    const double knowing = static_cast<double>(knowable_.points) * knowable_.work;
    if (allowance) {
      const double work = knowable_.points == 0
                              ? infinite
                              : knowing + work_of_prediction(spec_, scene_, seeded_, how_, allowed, wanted_);
      const bool affordable = work <= allowed;
      // A fifth of it at most has gone into finding that out.
      allowance->spent += looking_ + (affordable ? work : allowed / 5);
      return affordable || too_dear();
    }
    if (knowable_.points == 0 ||
        (effort == Effort::share_of_run &&
         static_cast<double>(seeded_.size() * 2) * 1.3 * work_of_a_path(spec_, scene_, seeded_, how_, allowed) +
                 knowing >
             allowed))
      return not_covered("it would cost more than a tenth of the run; `check` predicts it");
    return true;
  }

  /// The lattice and the one half a spacing aside, to the last output, and their sums on the grid.
  bool carry_both() {
    carried_ = seeded_;
    if (!carry(spec_, scene_, how_, carried_)) return not_covered(lost_paths);
    budget_.outside = part_outside(carried_, spec_.domain);
    budget_.not_covered = nothing_to_explain(carried_, budget_.outside, spec_.time.at(time()));
    if (!budget_.known()) return false;
    Particles aside = between(seeded_, scene_, spec_.domain);
    if (!carry(spec_, scene_, how_, aside)) return not_covered(lost_paths);
    density_ = summed(carried_, scene_.cutoff);
    aside_ = summed(aside, scene_.cutoff);
    const auto [lowest, highest] = std::minmax_element(density_.begin(), density_.end());
    budget_.lowest = *lowest, budget_.highest = *highest;
    return true;
  }

  /// Moving a lattice changes the sign of its error, but for a far smaller part. So the mean of the two sums is the
  /// integral, and half their difference is the error.
  bool compare_with_exact() {
    sample_ = sample_of_grid(scene_.evaluation, density_, knowable_.points);
    exact_density(spec_, scene_, knowable_.following, threads_)->evaluate_at(time(), sample_.points, exact_);
    norm_ = farthest([](std::size_t) { return 0.0; });
    if (!(norm_ > 0)) return not_covered(no_exact_density);
    budget_.probes = sample_.points.size();
    budget_.quadrature = at_least_rounding(largest_difference(density_, aside_) / 2 / norm_);
    budget_.smoothing =
        at_least_rounding(farthest([&](std::size_t i) { return (density_[i] + aside_[i]) / 2; }) / norm_);
    budget_.total = farthest([&](std::size_t i) { return density_[i]; }) / norm_;
    budget_.fit = fit_of_samples(scene_, seeded_, carried_, density_, time(), norm_);
    return true;
  }

  /// Steps, transform, and what was left out.
  bool add_other_causes() {
    std::vector<Probe> places;  // for the steps: where there is density
    for (std::size_t i = 0; i < sample_.points.size(); ++i)
      if (std::abs(density_[sample_.points[i]]) > 1e-6 * norm_)
        places.push_back({sample_.points[i], grid_point(scene_.evaluation, sample_.points[i]), exact_[i]});
    budget_.time_stepping = predict_time_stepping(spec_, scene_, seeded_, places, norm_, paths_);
    if (std::isnan(budget_.time_stepping)) return not_covered(lost_paths);
    if (interpolates_velocity(spec_)) {
      const Particles thin = thin_enough(spec_, scene_, seeded_);
      const double error =
          interpolation_error(spec_, scene_, thin, places, affordable_steps(spec_, scene_, thin), threads_);
      if (std::isfinite(error)) budget_.interpolation = at_least_rounding(error / norm_);
    }
    budget_.transform = error_of_sums();
    budget_.left_out = bound_of_left_out(scene_, seeding_, seeded_, carried_, norm_);
    budget_.total = budget_.total + budget_.time_stepping + budget_.transform + budget_.left_out + budget_.fit;
    find_dominating(budget_);
    return true;
  }

  /// As promised, or as found where parameters by hand promise much less than they keep.
  double error_of_sums() const {
    if (!spec_.evaluate.hermite) return spec_.evaluate.tolerance;
    const DensityOptions options{
        .method = spec_.evaluate.method, .hermite = spec_.evaluate.hermite, .threads = threads_, .measure = false};
    Particles images;
    const Particles& all = summed_particles(spec_.domain, carried_, reach_of_blob(scene_.cutoff, options), images);
    const DensityGrid by_hand = evaluate_density(all, scene_.cutoff, scene_.evaluation, options);
    return at_least_rounding(largest_difference(by_hand.rho, density_) / norm_);
  }

  void advise() {
    Better better;
    for (const std::string& name : higher_cutoffs(spec_)) {
      const std::vector<double> sharper = summed(carried_, other_cutoff(scene_, name));
      better.emplace_back(name, farthest([&](std::size_t i) { return sharper[i]; }) / norm_);
    }
    give_advice(spec_, scene_, better, threads_, budget_);
  }

  double time() const { return spec_.output.times.back(); }

  /// The density of the particles on the whole grid.
  std::vector<double> summed(const Particles& particles, const Cutoff& cutoff) const {
    const DensityOptions options{.tolerance = 1e-10, .threads = threads_, .measure = false};
    Particles images;
    const Particles& all = summed_particles(spec_.domain, particles, reach_of_blob(cutoff, options), images);
    return evaluate_density(all, cutoff, scene_.evaluation, options).rho;
  }

  /// The largest difference of a value from the exact density, over the sample where that is known.
  template <class Value>
  double farthest(const Value& value) const {
    std::vector<double> values, known;
    for (std::size_t i = 0; i < exact_.size(); ++i)
      if (std::isfinite(exact_[i])) {
        values.push_back(value(sample_.points[i]));
        known.push_back(exact_[i]);
      }
    return largest_difference(values, known);
  }

  const Case& spec_;
  const Scene& scene_;
  const int threads_;
  const Causes wanted_;
  const bool smooth_;
  const ExactPathsOptions paths_;
  const Carrying how_;  // a path through kinks is dear: then by the steps of the case
  Budget budget_;
  double looking_ = 0;  // work of seeding
  SeedReport seeding_;
  Particles seeded_, carried_;
  Affordable knowable_;
  std::vector<double> density_, aside_;  // on the whole grid
  GridSample sample_;
  std::vector<double> exact_;  // at its points
  double norm_ = 0;            // largest of them
};

Budget predict(const Case& spec, const Scene& scene, Effort effort, Allowance* allowance, int threads, Causes wanted) {
  return covered_or_why([&] { return Prediction(spec, scene, threads, wanted).run(effort, allowance); });
}

}  // namespace

Budget predict_budget(const Case& spec, const Scene& scene, Effort effort, int threads, Causes wanted) {
  return predict(spec, scene, effort, nullptr, threads, wanted);
}

Budget predict_budget(const Case& spec, const Scene& scene, Allowance& allowance, int threads, Causes wanted) {
  return predict(spec, scene, Effort::whatever, &allowance, threads, wanted);
}

}  // namespace gaussdrift::accuracy
