#include "sim/stable_step.hpp"

#include <cmath>

#include "field/velocity/sampled_gradients.hpp"
#include "time/stability.hpp"

namespace gaussdrift {

FlowRates sample_flow_rates(const VelocityField& velocity, const Particles& particles, double length, double distance) {
  FlowRates flow;
  for (const SampledGradient& sample : sampled_gradients(velocity, particles.view(), length, distance, &flow.jumps))
    for (const std::complex<double>& value : eigenvalues_of(sample.gradient))
      flow.rates.push_back({value, sample.place, sample.time});
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
