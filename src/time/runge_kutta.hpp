// One explicit Runge-Kutta step for a state that is a flat array of numbers. method.md, section 4.
#pragma once

#include <cstddef>
#include <vector>

#include "rows/rows.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::time {

/// Work arrays of one stepper: the stage state and the rates k_i, each as long as the state.
struct Stages {
  std::vector<double> state;
  std::vector<std::vector<double>> rates;
  std::vector<const double*> terms;  // of one sum: rates, and what multiplies them
  std::vector<double> factors;

  Stages(const Tableau& rk, std::size_t length)
      : state(length), rates(static_cast<std::size_t>(rk.stages), std::vector<double>(length)) {}
};

/// k_i = f(t + c_i dt, y + dt sum_{l<i} a_il k_l),    y <- y + dt sum_i b_i k_i
/// rate(t, state, k) must overwrite k. y has the length of the work arrays.
template <class Rate>
void step(const Tableau& rk, double t, double dt, const Rate& rate, double* y, Stages& work) {
  const std::size_t length = work.state.size();
  const rows::Combine combine = rows::kernels().combine;
  std::vector<const double*>& terms = work.terms;
  std::vector<double>& factors = work.factors;
  // Those of the first `count` rates whose weight is not 0.
  const auto gather = [&](int count, const auto& weight) {
    terms.clear(), factors.clear();
    for (int l = 0; l < count; ++l) {
      if (weight(l) == 0) continue;
      terms.push_back(work.rates[static_cast<std::size_t>(l)].data());
      factors.push_back(dt * weight(l));
    }
  };
  for (int i = 0; i < rk.stages; ++i) {
    gather(i, [&](int l) { return rk.a(i, l); });
    if (!terms.empty()) combine(work.state.data(), y, terms.data(), factors.data(), terms.size(), length);
    rate(t + rk.c(i) * dt, terms.empty() ? static_cast<const double*>(y) : work.state.data(),
         work.rates[static_cast<std::size_t>(i)].data());
  }
  gather(rk.stages, [&](int l) { return rk.b(l); });
  combine(y, y, terms.data(), factors.data(), terms.size(), length);
}

}  // namespace gaussdrift::time
