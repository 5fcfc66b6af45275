#include "effect/vortex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gaussdrift {

std::string Vortex::describe() const {
  return fmt::format(
      "vortex blobs, X_j' += sum_k alpha_k (1 - exp(-r^2/eps^2)) / (2 pi r^2) (-dy, dx), to {:g} of sum |alpha|/(2 pi "
      "r)",
      options_.tolerance);
}

void Vortex::begin(Particles& particles, double /*time*/) {
  largest_vorticity_ = 0;
  for (const double alpha : particles.alpha)
    largest_vorticity_ = std::max(largest_vorticity_, std::abs(alpha) / options_.cell);
}

double Vortex::stable_step() const {
  return largest_vorticity_ > 0 ? 1 / largest_vorticity_ : std::numeric_limits<double>::infinity();
}

void Vortex::add(double t, const Particles& particles, const PointsView& x, const VectorsView& u) const {
  const double core = std::sqrt(options_.core_radius * options_.core_radius + options_.spreading * t);
  const farfield::Points<2> velocity = pairs_.vortices(x, particles.alpha, core);
  for (std::size_t j = 0; j < x.count; ++j)
    for (int k = 0; k < 2; ++k) u.axis[k][j] += velocity(k, static_cast<Eigen::Index>(j));
}

Numbers Vortex::numbers() const {
  return {{"evaluations", static_cast<double>(pairs_.evaluations())},
          {"tolerance", options_.tolerance},
          {"clusters", static_cast<double>(pairs_.last_choice().clusters)},
          {"largest_vorticity", largest_vorticity_}};
}

}  // namespace gaussdrift
