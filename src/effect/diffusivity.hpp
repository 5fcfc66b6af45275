// The coefficient of diffusion, as all methods of [effects.diffusion] see it: a number, a symmetric matrix, or a number
// of place and time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gaussdrift/case.hpp"
#include "gaussdrift/points.hpp"
#include "particle/cutoff.hpp"

namespace gaussdrift {

/// The constant coefficient that the keys D, or D_axes and D_xy, D_xz, D_yz give; empty: it is a field.
std::optional<Tensor> constant_diffusivity(const EffectSpec& effect, int dimension);

/// Its eigenvalues, ascending; their number is the dimension.
struct PrincipalValues {
  double least = 0, largest = 0;
};
PrincipalValues principal_values(const Tensor& diffusivity, int dimension);

/// "0.01" if it is the same along all axes, else "[[0.02, 0.005], [0.005, 0.01]]".
std::string words_of_tensor(const Tensor& diffusivity);

/// Throws NumericalError that names a particle where a coefficient is negative or no number.
void check_diffusivity(const PointsView& x, const double* values, const std::int64_t* id, double time);

}  // namespace gaussdrift
