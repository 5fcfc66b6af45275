// One explicit Runge-Kutta step for a state that is a flat array of numbers. method.md, section 4.
#pragma once

#include <cstddef>
#include <vector>

#include "time/tableau.hpp"

namespace gaussdrift::time {

/// Work arrays of one stepper: the stage state and the rates k_i, each as long as the state.
struct Stages {
  std::vector<double> state;
  std::vector<std::vector<double>> rates;

  Stages(const Tableau& rk, std::size_t length)
      : state(length), rates(static_cast<std::size_t>(rk.stages), std::vector<double>(length)) {}
};

/// k_i = f(t + c_i dt, y + dt sum_{l<i} a_il k_l),    y <- y + dt sum_i b_i k_i
/// rate(t, state, k) must overwrite k. y has the length of the work arrays.
template <class Rate>
void step(const Tableau& rk, double t, double dt, const Rate& rate, double* y, Stages& work) {
  const std::size_t length = work.state.size();
  double* stage = work.state.data();
  for (int i = 0; i < rk.stages; ++i) {
    bool copied = false;  // the first term reads y itself, so that no pass only copies
    for (int l = 0; l < i; ++l) {
      if (rk.a(i, l) == 0) continue;
      const double factor = dt * rk.a(i, l);
      const double* k = work.rates[static_cast<std::size_t>(l)].data();
      const double* from = copied ? stage : y;
      for (std::size_t j = 0; j < length; ++j) stage[j] = from[j] + factor * k[j];
      copied = true;
    }
    rate(t + rk.c(i) * dt, copied ? static_cast<const double*>(stage) : y,
         work.rates[static_cast<std::size_t>(i)].data());
  }
  for (int i = 0; i < rk.stages; ++i) {
    if (rk.b(i) == 0) continue;
    const double factor = dt * rk.b(i);
    const double* k = work.rates[static_cast<std::size_t>(i)].data();
    for (std::size_t j = 0; j < length; ++j) y[j] += factor * k[j];
  }
}

}  // namespace gaussdrift::time
