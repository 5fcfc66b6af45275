#include "sim/work.hpp"

#include <algorithm>
#include <cmath>

#include "effect/catalogue.hpp"
#include "sim/landings.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

namespace {

/// The work of one particle's sum over all others: all pairs, or farfield with its tables if that is less. Blobs within
/// 18 widths are summed pair by pair.
double work_of_drift(const Case& spec, const Scene& scene, double particles) {
  if (spec.domain.dimension == 3) return std::min(0.04 * particles, 250.0);
  const double spread = spreading(spec.effects) * spec.time.end;
  const double width = std::sqrt(scene.core_radius * scene.core_radius + spread);
  double area = 1;
  for (int k = 0; k < 2; ++k)
    area *= spec.domain.max[static_cast<std::size_t>(k)] - spec.domain.min[static_cast<std::size_t>(k)];
  return std::min(0.09 * particles, 60 + 0.09 * particles * std::pow(18 * width, 2) / area);
}

}  // namespace

double work_of_rate(const Case& spec, const Scene& scene, std::size_t particles) {
  const auto n = static_cast<double>(particles);
  return n * (scene.velocity->cost() + (particles_interact(spec.effects) ? work_of_drift(spec, scene, n) : 0));
}

Work work_of(const Case& spec, const Scene& scene, std::size_t particles) {
  const time::Tableau& tableau = time::find_tableau(spec.time.method);
  // The number of steps that a method chooses is not known here; some hundred are usual.
  const double steps = time::is_adaptive(tableau) ? 200 : static_cast<double>(total_steps(spec));
  const auto n = static_cast<double>(particles), outputs = static_cast<double>(spec.output.times.size());
  // Measured: 0.2 us and 1 us of one core a particle or grid point in the sum of an output; 0.1 s of two cores a
  // picture, 0.4 s for the first.
  const double sum = spec.domain.dimension == 2 ? 5 : 25, picture = 5e6, first = 2e7;
  const double pictures = outputs * static_cast<double>(spec.output.images.size());
  return {steps * static_cast<double>(tableau.stages) * work_of_rate(spec, scene, particles),
          outputs * sum * (n + static_cast<double>(scene.evaluation.size())),
          pictures > 0 ? first + picture * pictures : 0};
}

double work_of_exact_rate(const Scene& scene) {
  const double divergence = scene.velocity->is_solenoidal() ? 0 : std::max(0.5, scene.velocity->cost() / 2);
  return scene.velocity->cost() + 0.3 + (scene.decay_rate ? scene.decay_rate->cost() : 0) + divergence;
}

}  // namespace gaussdrift
