// Derivatives as the kernels of pairs list them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "rbf/rbf.hpp"

namespace rbf::detail {

/// Place of a derivative of order 0, 1, 2 in the list of PairsJob::out.
template <int d>
std::size_t place_of(const Derivative<d>& alpha) {
  std::size_t place = 0, axes[2] = {}, found = 0;
  for (std::size_t l = 0; l < d; ++l)
    for (int i = 0; i < alpha[l]; ++i) axes[found++] = l;
  if (found == 1) place = 1 + axes[0];
  if (found == 2) {
    place = 1 + d;
    for (std::size_t l = 0; l < axes[0]; ++l) place += d - l;
    place += axes[1] - axes[0];
  }
  return place;
}

template <int d>
int order_of(const Derivative<d>& alpha) {
  return std::accumulate(alpha.begin(), alpha.end(), 0);
}

/// The highest order of a derivative among them.
template <int d>
int highest_order(const std::vector<Combination<d>>& combinations) {
  int order = 0;
  for (const Combination<d>& combination : combinations)
    for (const fgtd::Term<d>& term : combination) order = std::max(order, order_of<d>(term.derivative));
  return order;
}

}  // namespace rbf::detail
