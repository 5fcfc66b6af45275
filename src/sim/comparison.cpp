#include "sim/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/has_one.hpp"
#include "effect/catalogue.hpp"
#include "reference/characteristics.hpp"
#include "reference/formula.hpp"
#include "sim/borders/edges.hpp"
#include "sim/landings.hpp"
#include "sim/work.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

namespace {

std::size_t usual_most_steps(const Case& spec) { return 10'000 + total_steps(spec); }

/// Where paths come in from outside, in unfolded coordinates: a mirror at the other end shows an open face once more.
std::vector<Outflow> outflows_of(const Domain& domain) {
  std::vector<Outflow> outflows;
  const double rounding = rounding_of(domain);
  const Folding folding = folding_of(domain);
  for (const Face& face : faces_of(domain, Edge::open)) {
    const FoldedAxis& axis = folding.axis(face.axis);
    Outflow& outflow = outflows.emplace_back(Outflow{.axis = face.axis});
    const double low = domain.min[static_cast<std::size_t>(face.axis)],
                 high = domain.max[static_cast<std::size_t>(face.axis)];
    if (face.upper || axis.mirror_high) outflow.high = face.upper ? high : 2 * high - low;
    if (!face.upper || axis.mirror_low) outflow.low = face.upper ? 2 * low - high : low;
    outflow.high += rounding, outflow.low -= rounding;
  }
  return outflows;
}

/// No fluid comes from land. What slides along a coast may leave it, and how much is not known.
std::optional<NoFluid> land_of(const Scene& scene) {
  const Coast* coast = scene.coast.get();
  if (!coast) return std::nullopt;
  NoFluid land{[coast](double t, const Vector& x) { return coast->is_land(t, x); },
               [coast](double from, const Vector& a, double to, const Vector& b) {
                 return coast->crossing(from, a, to, b).has_value();
               }};
  if (coast->rule() == AtCoast::stop || coast->rule() == AtCoast::remove) land.from_there = 0;
  return land;
}

}  // namespace

std::unique_ptr<Reference> make_reference(const Case& spec, const Scene& scene, int threads,
                                          const Following& following) {
  switch (spec.reference.kind) {
    case ReferenceSpec::Kind::none:
      return nullptr;
    case ReferenceSpec::Kind::exact:
      return formula(spec.reference.rho, spec.params, scene.evaluation,
                     [clock = spec.time](double elapsed) { return clock.at(elapsed); });
    case ReferenceSpec::Kind::characteristics: {
      ScalarRate growth;
      const VelocityField* diverging = scene.velocity->is_solenoidal() ? nullptr : scene.velocity.get();
      const ScalarField* decay = scene.decay_rate.get();
      if (diverging || decay)
        growth = [diverging, decay](double t, const PointsView& x, double* values) {
          if (diverging) diverging->add_divergence(t, x, values);
          if (decay) decay->add(t, x, values);
        };
      const time::Tableau& tableau = time::find_tableau(spec.time.method);
      const bool by_steps = following.by_half_steps && !time::is_adaptive(tableau);
      return characteristics(*scene.velocity, *scene.density, growth, scene.evaluation,
                             {.tolerance = has_smooth_paths(scene) ? 1e-12 : 1e-9,  // short steps at every kink
                              .smooth = has_smooth_paths(scene),
                              .steady = scene.velocity->is_steady() && (!decay || decay->is_steady()),
                              .end = spec.time.end,
                              .most_steps = following.most_steps > 0 ? following.most_steps : usual_most_steps(spec),
                              .steps_by = by_steps ? &tableau : nullptr,
                              .step = by_steps ? spec.time.step / 2 : 0,
                              .threads = threads,
                              .outflows = outflows_of(spec.domain),
                              .no_fluid = land_of(scene),
                              .rank = following.rank,
                              .ranks = following.ranks});
    }
  }
  return nullptr;
}

Affordable affordable_paths(const Case& spec, const Scene& scene, double allowed, double outputs, int threads) {
  constexpr std::size_t least = 16, stages = 12;
  const std::size_t whole = scene.evaluation.size(), usual = usual_most_steps(spec);
  const double rate = work_of_exact_rate(scene), last = spec.output.times.back();
  outputs = std::max(outputs, 1e-9);  // an output at the start alone: no path at all
  const auto points_for = [&](double each) {
    return each > 0 ? static_cast<std::size_t>(std::min(allowed / (each * outputs), static_cast<double>(whole)))
                    : whole;
  };
  Affordable found;
  for (const std::size_t wanted : {64, 8}) {
    const std::size_t tried = std::min(wanted, whole);
    const double bound = allowed / (8 * rate * static_cast<double>(tried * stages));
    const auto most = static_cast<std::size_t>(std::clamp(bound, 16.0, static_cast<double>(usual)));
    std::vector<std::size_t> points;
    // Points are chosen by the golden ratio, because an even stride may meet only one column of the grid.
    for (std::size_t i = 0; i < tried; ++i) {
      const double along = std::fmod((static_cast<double>(i) + 0.5) * std::numbers::phi, 1.0);
      points.push_back(std::min(whole - 1, static_cast<std::size_t>(along * static_cast<double>(whole))));
    }
    std::vector<double> ignored;
    const ReferenceReport trial =
        make_reference(spec, scene, threads, {.most_steps = most})->evaluate_at(last, points, ignored);
    if (most < usual && 2 * trial.exhausted > tried) continue;
    found.work = rate * static_cast<double>(trial.rates) / static_cast<double>(tried);
    found.points = points_for(found.work);
    // No path may take many more steps than these did. A block of 256 takes the steps of its worst point; a path
    // through kinks takes its own.
    const std::size_t steps = trial.rates / (tried * stages), times = has_smooth_paths(scene) ? 16 : 4;
    found.following.most_steps = most < usual ? std::min(usual, std::max<std::size_t>(200, times * steps)) : usual;
    break;
  }
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  if (!has_smooth_paths(scene) && !time::is_adaptive(tableau) && found.points < std::min<std::size_t>(64, whole)) {
    const double steps = 2 * static_cast<double>(time::Interval(0, last, spec.time.step).steps());
    found.work = steps * tableau.stages * rate;
    found.points = points_for(found.work);
    found.following = {.by_half_steps = true};
    found.word = "followed back by steps half as long as those of the run";
  }
  if (found.points < std::min(least, whole)) found.points = 0;
  return found;
}

Comparison plan_comparison(const Case& spec, const Scene& scene, std::size_t particles, int threads) {
  const std::size_t whole = scene.evaluation.size();
  if (spec.reference.kind == ReferenceSpec::Kind::none) return {};
  if (spec.reference.points) return {.points = std::min(whole, static_cast<std::size_t>(*spec.reference.points))};
  if (spec.reference.kind != ReferenceSpec::Kind::characteristics || spec.output.times.empty() ||
      base::has_one(spec.output.images, &PictureStyle::shows_error))
    return {.points = whole};
  constexpr double share = 0.15, few = 2.5e6;
  const auto& times = spec.output.times;
  const bool shown = base::has_one(spec.output.files, &OutputFile::shows_density);
  const bool steady = scene.velocity->is_steady() && (!scene.decay_rate || scene.decay_rate->is_steady());
  // Steady: the last output goes on from the feet of those before, if all points do; else each is traced to the start.
  const double outputs = times.back() > 0 ? std::accumulate(times.begin(), times.end(), 0.0) / times.back() : 0.0;
  const double allowed = std::max(few, share * work_of(spec, scene, particles).total());
  const Affordable paths = affordable_paths(spec, scene, allowed, outputs, threads);
  Comparison plan{.points = paths.points, .following = paths.following, .word = paths.word};
  if (paths.points == 0) {
    // A number that is asked for is measured, whatever it takes.
    const bool asked = spec.accuracy.target || std::any_of(spec.checks.begin(), spec.checks.end(),
                                                           [](const CheckSpec& check) { return check.is_error(); });
    constexpr std::size_t fewest = 64;
    if (asked) return {.points = std::min(whole, fewest)};
    plan.left_out =
        "the error is not measured: following paths back from 16 grid points would take more than 15 % of the run; "
        "reference.points = 64 measures it all the same";
    return plan;
  }
  if (!has_smooth_paths(scene)) {
    plan.points = std::min<std::size_t>(plan.points, 256);
    return plan;
  }
  if (shown && paths.work * static_cast<double>(whole) * (steady ? 1.0 : outputs) <= allowed) {
    plan.points = whole;
    return plan;
  }
  constexpr std::size_t enough = 4096;
  if (!shown) plan.points = std::min(plan.points, enough);
  return plan;
}

}  // namespace gaussdrift
