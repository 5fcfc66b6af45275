#include "sim/stable_step.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "time/stability.hpp"

namespace gaussdrift {

namespace {

constexpr std::size_t sampled_particles = 500;

using Columns = std::array<std::vector<double>, max_dimension>;

Columns velocity_at(const VelocityField& field, double t, const Columns& x, int dimension) {
  const std::size_t count = x[0].size();
  Columns u;
  PointsView points{dimension, count, {}};
  VectorsView view{dimension, count, {}};
  for (int k = 0; k < dimension; ++k) {
    u[k].assign(count, 0.0);
    points.axis[k] = x[k].data();
    view.axis[k] = u[k].data();
  }
  field.add(t, points, view);
  return u;
}

// gradient[k][i][j] = d u_k / d x_i at point j.
std::array<Columns, max_dimension> gradient_at(const VelocityField& field, double t, Columns x, int dimension,
                                               double distance) {
  std::array<Columns, max_dimension> gradient;
  for (int i = 0; i < dimension; ++i) {
    const std::vector<double> kept = x[i];
    for (double& value : x[i]) value += distance;
    const Columns right = velocity_at(field, t, x, dimension);
    for (std::size_t j = 0; j < kept.size(); ++j) x[i][j] = kept[j] - distance;
    const Columns left = velocity_at(field, t, x, dimension);
    x[i] = kept;
    for (int k = 0; k < dimension; ++k) {
      gradient[k][i].resize(kept.size());
      for (std::size_t j = 0; j < kept.size(); ++j) gradient[k][i][j] = (right[k][j] - left[k][j]) / (2 * distance);
    }
  }
  return gradient;
}

}  // namespace

StableStep estimate_stable_step(const VelocityField& velocity, const Particles& particles, const time::Tableau& tableau,
                                double length, double step, double distance) {
  StableStep result{step, ""};
  if (length <= 0 || particles.size() == 0) return result;
  const int dimension = particles.dimension;
  const std::size_t wanted = std::min(sampled_particles, particles.size());
  Columns x;
  for (std::size_t i = 0; i < wanted; ++i)
    for (int k = 0; k < dimension; ++k) x[k].push_back(particles.position[k][i * particles.size() / wanted]);

  for (const double t : {0.0, 0.5 * length, length}) {
    const auto gradient = gradient_at(velocity, t, x, dimension, distance);
    for (std::size_t j = 0; j < wanted; ++j) {
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
