#include "effect/charge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gaussdrift {

std::string Charge::describe() const {
  return fmt::format("charges drift, X_j' += {:g} sum_k q_k (X_j - X_k)/r^{}{}, q = {}, to {:g} of sum |q|/r^{}",
                     options_.mobility, options_.dimension, options_.dimension == 2 ? " (1 - exp(-r^2/eps^2))" : "",
                     options_.own ? "h^d (" + options_.written + ") at the start" : "alpha", options_.tolerance,
                     options_.dimension - 1);
}

void Charge::begin(Particles& particles, double /*time*/) {
  if (options_.own) own_ = options_.own(particles);
  total_ = largest_rate_ = 0;
  // div E = 2 pi rho_q (2D), 4 pi rho_q (3D)
  const double rate = 2 * std::numbers::pi * (options_.dimension - 1) * std::abs(options_.mobility) / options_.cell;
  for (const double charge : charges_of(particles)) {
    total_ += charge;
    largest_rate_ = std::max(largest_rate_, rate * std::abs(charge));
  }
}

double Charge::stable_step() const {
  return largest_rate_ > 0 ? 1 / largest_rate_ : std::numeric_limits<double>::infinity();
}

std::string Charge::warning() const {
  if (options_.mobility >= 0 || largest_rate_ == 0) return "";
  return fmt::format(
      "equal charges attract each other, because effects.charge.mobility is negative. Their density grows like 1/(1 - "
      "t/tau), and from t = tau = {:.3g} on there is no solution.",
      1 / largest_rate_);
}

void Charge::add(double t, const Particles& particles, const PointsView& x, const VectorsView& u) const {
  const std::vector<double>& charges = charges_of(particles);
  if (options_.dimension == 2) {
    // The field of a Gaussian charge is the velocity of a vortex blob turned by a quarter, times 2 pi.
    const double core = std::sqrt(options_.core_radius * options_.core_radius + options_.spreading * t);
    const farfield::Points<2> turned = pairs_.vortices(x, charges, core);
    const double factor = 2 * std::numbers::pi * options_.mobility;
    for (std::size_t j = 0; j < x.count; ++j) {
      u.axis[0][j] += factor * turned(1, static_cast<Eigen::Index>(j));
      u.axis[1][j] -= factor * turned(0, static_cast<Eigen::Index>(j));
    }
  } else {
    const farfield::Points<3> field = pairs_.charges(x, charges);
    for (std::size_t j = 0; j < x.count; ++j)
      for (int k = 0; k < 3; ++k) u.axis[k][j] += options_.mobility * field(k, static_cast<Eigen::Index>(j));
  }
}

Numbers Charge::numbers() const {
  return {{"evaluations", static_cast<double>(pairs_.evaluations())},
          {"tolerance", options_.tolerance},
          {"clusters", static_cast<double>(pairs_.last_choice().clusters)},
          {"charge", total_},
          {"largest_rate", largest_rate_}};
}

}  // namespace gaussdrift
