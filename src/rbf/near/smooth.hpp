// The sum of Gaussians at distances below the near radius, as polynomials: what the near field takes away again.
#pragma once

#include <array>
#include <vector>

#include "rbf/expansion/expansion.hpp"

namespace rbf::detail {

/// f, f' and f'' of a sum of Gaussians for 0 <= s <= radius^2, in powers of x = 2 s / radius^2 - 1.
struct Smooth {
  std::array<std::vector<double>, 3> coefficients;
};

/// @param order     of the derivatives that are wanted
/// @param accuracy  of value and derivatives, relative to the scales of the sum
/// @returns nothing, if too many powers would be needed
bool make_smooth(const Expansion& sum, double radius, int order, double accuracy, Smooth& smooth);

}  // namespace rbf::detail
