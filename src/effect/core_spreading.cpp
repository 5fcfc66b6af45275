#include "effect/core_spreading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "effect/catalogue.hpp"
#include "field/velocity/sampled_gradients.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

CoreSpreading::CoreSpreading(double coefficient, const VelocityField& velocity, double end, double distance,
                             bool renewed)
    : coefficient_(coefficient), end_(end), distance_(distance), renewed_(renewed), velocity_(velocity) {
  if (!std::isfinite(4 * coefficient * end))
    throw InputError(
        fmt::format("with effects.diffusion.D = {:g} the blobs become too wide for a number until time.end = {:g}. "
                    "Lower one of the two.",
                    coefficient, end));
}

std::string CoreSpreading::describe() const {
  return fmt::format("diffusion by core spreading, eps(t)^2 = eps^2 + 4 D t with D = {:g}", coefficient_);
}

void CoreSpreading::begin(Particles& particles, double time) { since_ = time - particles.spread / (4 * coefficient_); }

void CoreSpreading::look_at(const Particles& sample) {
  if (end_ <= 0) return;
  for (const SampledGradient& at : sampled_gradients(velocity_, sample.view(), end_, distance_))
    for (const std::complex<double>& rate : eigenvalues_of((at.gradient + at.gradient.transpose()) / 2))
      strain_ = std::max(strain_, std::abs(rate));
}

void CoreSpreading::land(Particles& particles, double time) {
  longest_ = std::max(longest_, time - since_);
  particles.spread = 4 * coefficient_ * (time - since_);
}

std::string CoreSpreading::warning() const {
  constexpr double noticed = 0.1;
  const double length = renewed_ ? longest_ : end_;
  if (strain_ * length <= noticed) return "";
  if (renewed_)
    return fmt::format(
        "this flow strains at the rate {:.3g} and stretches lengths by up to exp({:.3g}) while blobs spread until they "
        "are renewed, for up to {:.3g}. Core spreading keeps blobs round, so the flow does not stretch what has "
        "diffused "
        "in that time. Renew them more often by {}, or choose method = \"particle-exchange\" (docs/method.md, section "
        "8.2).",
        strain_, strain_ * length, length, restorers_table());
  return fmt::format(
      "this flow strains at the rate {:.3g} and stretches lengths by up to exp({:.3g}) over the run. Core spreading "
      "keeps blobs round, so the flow does not stretch what has diffused. {} with small intervals cures "
      "that, or method = \"particle-exchange\" (docs/method.md, section 8.2).",
      strain_, strain_ * end_, restorers_table());
}

Numbers CoreSpreading::numbers() const { return {{"D", coefficient_}, {"largest_strain_rate", strain_}}; }

}  // namespace gaussdrift
