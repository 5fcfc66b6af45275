#include "effect/core_spreading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "effect/catalogue.hpp"
#include "effect/diffusivity.hpp"
#include "field/velocity/sampled_gradients.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

CoreSpreading::CoreSpreading(const Tensor& diffusivity, int dimension, const VelocityField& velocity, double end,
                             double distance, bool renewed)
    : diffusivity_(diffusivity),
      dimension_(dimension),
      end_(end),
      distance_(distance),
      renewed_(renewed),
      velocity_(velocity) {
  const PrincipalValues values = principal_values(diffusivity, dimension);
  coefficient_ = values.largest, least_ = values.least;
  if (!std::isfinite(4 * coefficient_ * end))
    throw InputError(
        fmt::format("with effects.diffusion.D = {:g} the blobs become too wide for a number until time.end = {:g}. "
                    "Lower one of the two.",
                    coefficient_, end));
}

std::string CoreSpreading::describe() const {
  return fmt::format("diffusion by core spreading, eps(t)^2 = eps^2 + 4 D t with D = {}",
                     words_of_tensor(diffusivity_));
}

void CoreSpreading::begin(Particles& particles, double time) { since_ = time - particles.spread / (4 * coefficient_); }

// What has spread grows like A S + S A^T in a flow with the gradient A: along S = D that is twice the strain where D is
// the same along all axes.
void CoreSpreading::look_at(const Particles& sample) {
  if (end_ <= 0) return;
  Eigen::MatrixXd along = Eigen::MatrixXd::Identity(dimension_, dimension_);
  for (int i = 0; i < dimension_ && !is_even(); ++i)
    for (int j = 0; j < dimension_; ++j)
      along(i, j) = diffusivity_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] / coefficient_;
  for (const SampledGradient& at : gradients_in_lengths(velocity_, sample.view(), end_, distance_)) {
    const Eigen::MatrixXd stretched = is_even() ? at.gradient : Eigen::MatrixXd(at.gradient * along);
    for (const std::complex<double>& rate : eigenvalues_of((stretched + stretched.transpose()) / 2))
      strain_ = std::max(strain_, std::abs(rate));
  }
}

void CoreSpreading::land(Particles& particles, double time) {
  longest_ = std::max(longest_, time - since_);
  particles.spread = 4 * coefficient_ * (time - since_);
}

std::string CoreSpreading::warning() const {
  constexpr double noticed = 0.1;
  const double length = renewed_ ? longest_ : end_;
  if (strain_ * length <= noticed) return "";
  if (!is_even())
    return fmt::format(
        "this flow turns or stretches what has diffused at the rate {:.3g}, lengths by up to exp({:.3g}) over the run. "
        "Core spreading leaves it along the axes of D. Choose method = \"random-walk\" (docs/method.md, section 8.2).",
        strain_, strain_ * end_);
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
      "keeps blobs round, so the flow does not stretch what has diffused{} (docs/method.md, section 8.2).",
      strain_, strain_ * end_,
      &velocity_.in_lengths() != &velocity_  // on a sphere, where it is the only method
          ? ""
          : fmt::format(". {} with small intervals cures that, or method = \"particle-exchange\"", restorers_table()));
}

Numbers CoreSpreading::numbers() const {
  if (is_even()) return {{"D", coefficient_}, {"largest_strain_rate", strain_}};
  return {{"largest_D", coefficient_}, {"least_D", least_}, {"largest_strain_rate", strain_}};
}

}  // namespace gaussdrift
