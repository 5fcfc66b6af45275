#include "accuracy/carrying.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "accuracy/other_lattices.hpp"
#include "sim/borders/edges.hpp"
#include "sim/carrier.hpp"
#include "sim/landings.hpp"
#include "sim/stepper.hpp"
#include "sim/work.hpp"
#include "time/schedule.hpp"

namespace gaussdrift::accuracy {

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

bool carry(const Case& spec, const Scene& scene, const Carrying& how, Particles& particles) {
  if (particles.size() == 0) return true;
  if (how.exactly) {
    const ExactPaths paths =
        carry_exactly(*scene.velocity, scene.decay_rate.get(), particles, 0, spec.output.times.back(), how.paths);
    fold_positions(folding_of(spec.domain), particles);
    return paths.lost == 0;
  }
  carry_by_steps(spec, scene, particles, how.factor, how.paths.threads);
  return true;
}

double of_halved_steps(const Case& spec, const Scene& scene) {
  const int order = time::find_tableau(spec.time.method).time_order;
  return 1 / (1 - std::pow(0.5, has_smooth_paths(scene) ? order : std::min(order, 2)));
}

double rates_of_steps(const Case& spec, const Scene& scene) {
  return work_of(spec, scene, 1).transport / scene.velocity->cost();
}

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

}  // namespace gaussdrift::accuracy
