#include "sim/stable_step.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "field/differences.hpp"
#include "time/stability.hpp"

namespace gaussdrift {

namespace {

constexpr std::size_t sampled_particles = 500;

}  // namespace

StableStep estimate_stable_step(const VelocityField& velocity, const Particles& particles, const time::Tableau& tableau,
                                double length, double step, double distance) {
  StableStep result{step, ""};
  if (length <= 0 || particles.size() == 0) return result;
  const int dimension = particles.dimension;
  const Columns x = sample_of(particles.view(), sampled_particles);
  const std::size_t sampled = x[0].size();

  for (const double t : {0.0, 0.5 * length, length}) {
    const auto gradient = gradient_by_differences(velocity, t, x, dimension, distance);
    for (std::size_t j = 0; j < sampled; ++j) {
      Eigen::MatrixXd matrix(dimension, dimension);
      for (int k = 0; k < dimension; ++k)
        for (int i = 0; i < dimension; ++i) matrix(k, i) = gradient[k][i][j];
      if (!matrix.allFinite()) continue;
      const auto eigenvalues = matrix.eigenvalues();
      for (Eigen::Index n = 0; n < eigenvalues.size(); ++n) {
        const std::complex<double> rate = eigenvalues(n);
        if (time::growth_of_step(tableau, rate, length, result.step) <= std::log1p(growth_allowed)) continue;
        const double limit = time::largest_stable_step(tableau, rate, length, std::log1p(growth_allowed), result.step);
        if (limit >= result.step) continue;
        result.step = limit;
        std::string place;
        for (int k = 0; k < dimension; ++k) place += fmt::format("{}{:.4g}", k ? ", " : "", x[k][j]);
        const bool turns = std::abs(rate.imag()) > std::abs(rate.real());
        result.reason = fmt::format("the velocity gradient at ({}), t = {:.4g} {} at the rate {:.4g}", place, t,
                                    turns ? "turns" : "contracts", turns ? std::abs(rate.imag()) : -rate.real());
      }
    }
  }
  return result;
}

}  // namespace gaussdrift
