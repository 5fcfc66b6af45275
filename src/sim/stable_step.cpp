#include "sim/stable_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "time/stability.hpp"

namespace gaussdrift {

FlowRates sample_flow_rates(const VelocityField& velocity, const Particles& particles, double length, double distance) {
  FlowRates flow;
  const int dimension = particles.dimension;
  const Columns x = sample_of(particles.view(), sampled_particles);
  for (const double t : {0.0, 0.5 * length, length}) {
    const auto gradient = gradient_by_differences(velocity, t, x, dimension, distance, &flow.jumps);
    for (std::size_t j = 0; j < x[0].size(); ++j) {
      Eigen::MatrixXd matrix(dimension, dimension);
      for (int k = 0; k < dimension; ++k)
        for (int i = 0; i < dimension; ++i) matrix(k, i) = gradient[k][i][j];
      if (!matrix.allFinite()) continue;
      FlowRate rate;
      for (int k = 0; k < dimension; ++k) rate.place[k] = x[k][j];
      rate.time = t;
      const auto eigenvalues = matrix.eigenvalues();
      for (Eigen::Index n = 0; n < eigenvalues.size(); ++n) {
        rate.value = eigenvalues(n);
        flow.rates.push_back(rate);
      }
    }
  }
  return flow;
}

StableStep longest_stable_step(const FlowRates& flow, const time::Tableau& tableau, double length, double step) {
  StableStep result{step, std::nullopt};
  if (length <= 0) return result;
  for (const FlowRate& rate : flow.rates) {
    if (time::growth_of_step(tableau, rate.value, length, result.step) <= std::log1p(growth_allowed)) continue;
    const double limit =
        time::largest_stable_step(tableau, rate.value, length, std::log1p(growth_allowed), result.step);
    if (limit >= result.step) continue;
    result = {limit, rate};
  }
  return result;
}

StableStep estimate_stable_step(const VelocityField& velocity, const Particles& particles, const time::Tableau& tableau,
                                double length, double step, double distance) {
  if (length <= 0 || particles.size() == 0) return {step, std::nullopt};
  return longest_stable_step(sample_flow_rates(velocity, particles, length, distance), tableau, length, step);
}

}  // namespace gaussdrift
