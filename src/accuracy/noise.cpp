#include "accuracy/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "accuracy/causes.hpp"
#include "base/philox.hpp"
#include "effect/catalogue.hpp"
#include "effect/diffusivity.hpp"
#include "sim/borders/edges.hpp"
#include "sim/transform.hpp"

namespace gaussdrift::accuracy {

namespace {

/// Half of the particles with the other sign, by lot.
Particles by_lot(Particles particles) {
  constexpr std::uint64_t lots = 0x6e6f697365;  // no run has this seed and these numbers
  for (std::size_t j = 0; j < particles.size(); ++j)
    if (base::two_normals(lots, static_cast<std::uint64_t>(particles.id[j]), 0)[0] < 0) particles.alpha[j] *= -1;
  return particles;
}

/// Walkers begin on a lattice. As long as they have not gone farther than a blob is wide, they are more even than lots:
/// the part of the variance of a blob at a place that chance has made by then, its square root.
double part_of_chance(const Case& spec, const Scene& scene, double elapsed) {
  for (const auto& [effect, values] : effects_of(spec.effects)) {
    if (!effect->traits.scatters.of(values, spec.domain.dimension)) continue;
    const auto constant = constant_diffusivity(values, spec.domain.dimension);
    if (!constant) return 1;  // at most
    // int (E zeta)^2 / int zeta^2 of Gaussian blobs, which become as much wider as the walkers have gone.
    const double blob = scene.core_radius * scene.core_radius;
    const PrincipalValues values_of_matrix = principal_values(*constant, spec.domain.dimension);
    double middle = 0;  // in space the three of them add up to the trace
    if (spec.domain.dimension == 3)
      middle =
          (*constant)[0][0] + (*constant)[1][1] + (*constant)[2][2] - values_of_matrix.least - values_of_matrix.largest;
    double part = 1;
    for (const double value : {values_of_matrix.least, middle, values_of_matrix.largest})
      part *= std::sqrt(blob / (blob + 4 * std::max(0.0, value) * elapsed));
    return std::sqrt(1 - part);
  }
  return 0;
}

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

bool moves_by_chance(const Case& spec) {
  const auto all = effects_of(spec.effects);
  return std::any_of(all.begin(), all.end(),
                     [&](const auto& one) { return one.first->traits.scatters.of(one.second, spec.domain.dimension); });
}

// The density of lots has the mean 0 and, at every place, the variance that the density has where each walker is
// somewhere by chance. So its largest value is one sample of the largest error that chance makes.
Budget budget_of_walk(const Case& spec, const Scene& scene, const LastFrame::Kept& last, int threads) {
  Budget budget;
  budget.only_some = true;
  if (!last.any) budget.not_covered = "there was no output";
  if (budget.known() && last.particles.size() == 0) budget.not_covered = "no particle carries weight";
  const double norm = largest_of(last.density.rho);
  if (budget.known() && !(norm > 0)) budget.not_covered = "the density is 0 at the last output";
  if (!budget.known()) return budget;
  DensityOptions options;
  options.tolerance = 1e-3;
  options.threads = threads;
  options.measure = false;
  const Cutoff blob = blob_of(scene, last.particles);
  Particles images;
  const Particles lots = by_lot(last.particles);
  const Particles& all = summed_particles(domain_of_sum(spec, last.time), lots, reach(blob, options.tolerance), images);
  const DensityGrid chance = evaluate_density(all, blob, last.density.lattice, options);
  budget.noise = part_of_chance(spec, scene, last.time) * largest_of(chance.rho) / norm;
  budget.transform = last.numbers.transform_error;
  budget.outside = last.numbers.outside;
  if (last.numbers.error && std::isfinite(last.numbers.error->linf)) {
    budget.total = last.numbers.error->linf;
    budget.others = std::max(0.0, budget.total - budget.noise);
  }
  find_dominating(budget);
  if (budget.dominates == name_of_noise)
    budget.advice.push_back(
        "particles.per_axis and particles.overlap both doubled halve the noise; method = \"particle-exchange\" or "
        "\"core-spreading\" has none");
  return budget;
}

}  // namespace gaussdrift::accuracy
